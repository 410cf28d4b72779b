//! The four calls of semihosting that are needed here, the same on Arm and on RISC-V.

use crate::start::call;
use core::sync::atomic::{AtomicUsize, Ordering};

const OPEN: usize = 0x01;
const WRITE: usize = 0x05;
const COMMAND_LINE: usize = 0x15;
const EXIT: usize = 0x20;
/// Opens the console for writing.
const WRITE_MODE: usize = 4;
/// The reason of an exit that the program asks for.
const APPLICATION_EXIT: usize = 0x20026;

/// The open console, 0 before it is.
static CONSOLE: AtomicUsize = AtomicUsize::new(0);

/// Writes bytes to the standard output.
pub fn print(bytes: &[u8]) {
    let mut console = CONSOLE.load(Ordering::Relaxed);
    if console == 0 {
        let name = b":tt\0";
        // SAFETY: the block and what it points to live through the call, and are as it wants.
        console = unsafe { call(OPEN, &[name.as_ptr().addr(), WRITE_MODE, name.len() - 1]) };
        CONSOLE.store(console, Ordering::Relaxed);
    }
    // SAFETY: as above.
    let left = unsafe { call(WRITE, &[console, bytes.as_ptr().addr(), bytes.len()]) };
    if left != 0 {
        exit(false);
    }
}

/// The number that ends the command line.
pub fn number() -> Option<u16> {
    let mut line = [0_u8; 64];
    let block = [line.as_mut_ptr().addr(), line.len()];
    // SAFETY: as above; the block says how long the line may become.
    if unsafe { call(COMMAND_LINE, &block) } != 0 {
        return None;
    }
    let end = line.iter().position(|&byte| byte == 0)?;
    core::str::from_utf8(&line[..end]).ok()?.rsplit(' ').next()?.parse().ok()
}

/// Ends the emulator.
pub fn exit(is_good: bool) -> ! {
    loop {
        // SAFETY: as above.
        unsafe { call(EXIT, &[APPLICATION_EXIT, usize::from(!is_good)]) };
    }
}
