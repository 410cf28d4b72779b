//! A Cortex-M in QEMU: words and files come and go by semihosting, what things cost is counted in
//! instructions, and a heap lies in external RAM.
//!
//! The counter and the console are those of `host-tests/firmware`.

use crate::Failure;
use alloc::{borrow::ToOwned, format, string::String, vec, vec::Vec};
use core::fmt::Arguments;
use core::mem::MaybeUninit;
use core::str;
// Supplies the critical-section implementation too, which the heap asks for.
use cortex_m::Peripherals;
use cortex_m_semihosting::{nr, syscall};
use embedded_alloc::TlsfHeap;

#[path = "../../../firmware/src/console.rs"]
mod console;
#[path = "../../../firmware/src/count.rs"]
mod count;

use console::Console;
use count::Counter;

/// Enough for a scene's text, its tables, a picture and its depth.
const HEAP_BYTES: usize = 12 << 20;

#[unsafe(link_section = ".slow")]
static mut HEAP_ROOM: [MaybeUninit<u8>; HEAP_BYTES] = [MaybeUninit::uninit(); HEAP_BYTES];

#[global_allocator]
static HEAP: TlsfHeap = TlsfHeap::empty();

/// Ends a program: QEMU's exit code is 0 for `Ok`, and an error is printed.
pub fn end(result: Result<(), Failure>) -> ! {
    if let Err(error) = &result {
        Console::open().line(format_args!("failed: {error}"));
    }
    console::exit(result.is_ok())
}

/// A file's bytes.
///
/// # Errors
/// When it cannot be read.
pub fn read(file: &str) -> Result<Vec<u8>, Failure> {
    let handle = open(file, nr::open::R_BINARY)?;
    // SAFETY: the handle is open.
    let mut bytes = vec![0; unsafe { syscall!(FLEN, handle) }];
    // SAFETY: the handle is open, and the block is all ours.
    let missing = unsafe { syscall!(READ, handle, bytes.as_mut_ptr(), bytes.len()) };
    close(handle);
    if missing == 0 {
        Ok(bytes)
    } else {
        Err(format!("{file}: it ends early").into())
    }
}

/// Writes a file.
pub(crate) fn write(file: &str, bytes: &[u8]) -> Result<(), Failure> {
    let handle = open(file, nr::open::W_TRUNC_BINARY)?;
    // SAFETY: the handle is open, and the block is only read.
    let missing = unsafe { syscall!(WRITE, handle, bytes.as_ptr(), bytes.len()) };
    close(handle);
    if missing == 0 {
        Ok(())
    } else {
        Err(format!("{file}: it cannot be written whole").into())
    }
}

/// A file of the host, below the folder that QEMU runs in.
fn open(file: &str, mode: usize) -> Result<usize, Failure> {
    let name = format!("{file}\0");
    // SAFETY: the name ends with a zero and lives until the call returns.
    let handle = unsafe { syscall!(OPEN, name.as_ptr(), mode, file.len()) };
    if handle == usize::MAX {
        return Err(format!("{file}: it cannot be opened").into());
    }
    Ok(handle)
}

fn close(handle: usize) {
    // SAFETY: the handle is open, and not used again.
    unsafe { syscall!(CLOSE, handle) };
}

/// The counter and the console.
pub(crate) struct Machine {
    console: Console,
    counter: Counter,
}

impl Machine {
    /// Sets up the heap, and a counter that is held against loops of known length.
    pub(crate) fn start() -> Result<Self, Failure> {
        let peripherals = Peripherals::take().ok_or("the machine was started before")?;
        // SAFETY: this is reached once, as the line above says, and nothing else names the room.
        unsafe { HEAP.init((&raw mut HEAP_ROOM).addr(), HEAP_BYTES) };
        let mut counter = Counter::start(peripherals.SYST);
        for check in count::check(&mut counter) {
            if !check.holds() {
                let (name, counted, expected) = (check.name, check.counted, check.expected);
                return Err(format!("{name}: {counted} counted, not {expected}").into());
            }
        }
        Ok(Self {
            console: Console::open(),
            counter,
        })
    }

    /// The program's words, without its name.
    pub(crate) fn words(&self) -> Result<Vec<String>, Failure> {
        let mut line = [0u8; 256];
        let mut block = [line.as_mut_ptr() as usize, line.len()];
        // SAFETY: the block names a room and its size; the call sets both to what it filled.
        let failed = unsafe {
            cortex_m_semihosting::syscall1(nr::GET_CMDLINE, (&raw mut block) as usize) != 0
        };
        let said = line.get(..block[1]).filter(|_| !failed);
        let said = str::from_utf8(said.ok_or("there are no words, or too many")?)?;
        let words = said.trim_end_matches('\0').split_whitespace();
        Ok(words.skip(1).map(ToOwned::to_owned).collect())
    }

    /// The instructions that `work` executes.
    pub(crate) fn cost(&self, work: impl FnOnce()) -> f64 {
        self.counter.instructions(work) as f64
    }

    pub(crate) fn say(&mut self, text: Arguments<'_>) {
        self.console.line(text);
    }
}
