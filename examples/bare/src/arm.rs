//! Start-up by cortex-m-rt, and semihosting by `bkpt`.

use core::arch::asm;
use cortex_m as _; // its critical section

/// A call of semihosting.
///
/// # Safety
/// The block and what it points to are as the call wants.
pub unsafe fn call(operation: usize, block: &[usize]) -> usize {
    let result;
    // SAFETY: the emulator reads and writes what the caller vouches for.
    unsafe { asm!("bkpt 0xab", inlateout("r0") operation => result, in("r1") block.as_ptr()) };
    result
}

#[cortex_m_rt::entry]
fn entry() -> ! {
    crate::main()
}
