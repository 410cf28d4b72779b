//! Start-up of one core in machine mode, semihosting by its marked `ebreak`, and a critical section
//! for a core without interrupts.

use core::arch::global_asm;

global_asm!(
    ".section .init",
    ".global _start",
    "_start:",
    ".option push",
    ".option norelax",
    "la sp, __stack_top",
    ".option pop",
    "la t0, __bss_start",
    "la t1, __bss_end",
    "1: bgeu t0, t1, 2f",
    "sw zero, 0(t0)",
    "addi t0, t0, 4",
    "j 1b",
    "2: la t0, trap",
    "csrw mtvec, t0",
    "call start",
    // The three marked instructions lie in one page and are not compressed.
    ".section .text.semihosting, \"ax\"",
    ".global semihosting_call",
    ".balign 16",
    "semihosting_call:",
    ".option push",
    ".option norvc",
    "slli x0, x0, 0x1f",
    "ebreak",
    "srai x0, x0, 7",
    ".option pop",
    "ret",
    ".balign 4",
    "trap: la sp, __stack_top",
    "call trapped",
);

unsafe extern "C" {
    fn semihosting_call(operation: usize, block: *const usize) -> usize;
}

/// A call of semihosting.
///
/// # Safety
/// The block and what it points to are as the call wants.
pub unsafe fn call(operation: usize, block: &[usize]) -> usize {
    // SAFETY: the emulator reads and writes what the caller vouches for.
    unsafe { semihosting_call(operation, block.as_ptr()) }
}

#[unsafe(no_mangle)]
extern "C" fn start() -> ! {
    crate::main()
}

#[unsafe(no_mangle)]
extern "C" fn trapped() -> ! {
    panic!("a trap")
}

struct OneCore;
critical_section::set_impl!(OneCore);

// SAFETY: there is one core, and no interrupt is ever enabled.
unsafe impl critical_section::Impl for OneCore {
    unsafe fn acquire() -> critical_section::RawRestoreState {}

    unsafe fn release((): critical_section::RawRestoreState) {}
}
