//! Turns the teapot on a core alone, without a board: RISC-V and Cortex-M33 in QEMU.
//!
//! What a panel would get is printed by semihosting, as `host-tests/boards/wire.mjs` says: the
//! pin's level, then bytes in hex. `scanbeam boards` judges it as it does a board's.
#![no_std]
#![no_main]

mod semihosting;

#[cfg_attr(target_arch = "arm", path = "arm.rs")]
#[cfg_attr(target_arch = "riscv32", path = "riscv.rs")]
mod start;

use core::convert::Infallible;
use core::task::Poll;
use embedded_hal::digital::{self, OutputPin};
use scanbeam::scan_out::{ErrorKind, Pump, ScanoutDma, Window};
use spinner::{LINES, Spinner, WIDTH, lend, panel};

/// Bytes that are printed at once.
const CHUNK: usize = 1024;

/// A wire that ends in text.
struct Panel {
    dc: Pin,
    sent: Option<&'static mut [u16]>,
}

/// The data/command pin.
struct Pin(bool);

impl digital::ErrorType for Pin {
    type Error = Infallible;
}

impl OutputPin for Pin {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.0 = false;
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.0 = true;
        Ok(())
    }
}

/// Prints bytes that arrive with the pin so.
fn arrive(level: bool, bytes: &[u8]) {
    const DIGITS: &[u8; 16] = b"0123456789abcdef";
    for chunk in bytes.chunks(CHUNK) {
        let mut line = [0; 2 * CHUNK];
        for (pair, byte) in line.chunks_exact_mut(2).zip(chunk) {
            pair[0] = DIGITS[usize::from(byte >> 4)];
            pair[1] = DIGITS[usize::from(byte & 15)];
        }
        semihosting::print(if level { b"data 1 " } else { b"data 0 " });
        semihosting::print(&line[..2 * chunk.len()]);
        semihosting::print(b"\n");
    }
}

impl Panel {
    fn command(&mut self, command: (u8, &[u8])) -> Result<(), ErrorKind> {
        let mut codes = true; // the code comes first, with the pin low
        panel::command(&mut self.dc, ErrorKind::Bus, command, |bytes| {
            arrive(!core::mem::take(&mut codes), bytes);
            Ok(())
        })
    }
}

impl ScanoutDma for Panel {
    type Error = ErrorKind;
    type Buf = &'static mut [u16];

    fn begin(&mut self, window: Window) -> Result<(), ErrorKind> {
        panel::open(window, |command| self.command(command))
    }

    fn start(&mut self, line: Self::Buf, len: usize) -> Result<(), (ErrorKind, Self::Buf)> {
        for words in line[..len].chunks(CHUNK / 2) {
            let mut bytes = [0; CHUNK];
            for (pair, word) in bytes.chunks_exact_mut(2).zip(words) {
                pair.copy_from_slice(&word.to_ne_bytes());
            }
            arrive(self.dc.0, &bytes[..2 * words.len()]);
        }
        self.sent = Some(line);
        Ok(())
    }

    fn poll(&mut self) -> Poll<Result<Option<Self::Buf>, ErrorKind>> {
        Poll::Ready(Ok(self.sent.take()))
    }

    fn end(&mut self) -> Result<(), ErrorKind> {
        Ok(())
    }
}

/// Draws as many frames as the command line says, and opens one more.
fn main() -> ! {
    let frames = semihosting::number().expect("the command line has the number of frames");
    let mut panel = Panel { dc: Pin(true), sent: None };
    panel::set_up(|command| panel.command(command), |_| ()).expect("printing does not fail");
    let buffers = [lend!(u16, LINES * WIDTH, 0), lend!(u16, LINES * WIDTH, 0)];
    let (mut pump, mut spinner) = (Pump::new(panel, buffers), Spinner::new());
    for _ in 0..frames {
        spinner.frame(&mut pump).expect("printing does not fail");
    }
    let whole = Window { x: 0, y: 0, width: WIDTH as u16, height: spinner::HEIGHT as u16 };
    pump.sink_mut().begin(whole).expect("printing does not fail");
    semihosting::print(b"end frames\n");
    semihosting::exit(true)
}

#[panic_handler]
fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
    semihosting::print(b"end panic");
    if let Some(text) = info.message().as_str() {
        semihosting::print(b": ");
        semihosting::print(text.as_bytes());
    }
    semihosting::print(b"\n");
    semihosting::exit(false)
}
