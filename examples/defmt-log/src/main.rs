//! Logs by defmt what the crate says: each frame at trace level, then its outcome. The second of
//! three frames meets a display that fails at line 80, the third is whole again.
#![no_std]
#![no_main]

use core::panic::PanicInfo;
use cortex_m as _; // its critical section
use defmt_semihosting as _;
use scanbeam::scan_out::{Blocking, ErrorKind, LineWriter, Pump, Window};
use spinner::{LINES, Spinner, WIDTH, lend};

/// A display that shows nothing, and may fail at a line.
struct Glass {
    fails_at: Option<u16>,
}

impl LineWriter for Glass {
    type Error = ErrorKind;
    type Word = u16;

    fn open(&mut self, _: Window) -> Result<(), ErrorKind> {
        Ok(())
    }

    fn write(&mut self, lines: Window, _: &[u16]) -> Result<(), ErrorKind> {
        let reached = |line| (lines.y..lines.y + lines.height).contains(&line);
        if self.fails_at.take_if(|line| reached(*line)).is_some() {
            return Err(ErrorKind::Bus);
        }
        Ok(())
    }
}

#[cortex_m_rt::entry]
fn main() -> ! {
    let mut spinner = Spinner::new();
    let buffers = [lend!(u16, LINES * WIDTH, 0), lend!(u16, LINES * WIDTH, 0)];
    let mut pump = Pump::new(Blocking::over(Glass { fails_at: None }), buffers);
    for fails_at in [None, Some(80), None] {
        pump.sink_mut().writer_mut().fails_at = fails_at;
        match spinner.frame(&mut pump) {
            Ok(stats) => defmt::info!("sent {} bytes", stats.scan_out.bytes_sent),
            Err(error) => defmt::error!("{}", error),
        }
    }
    semihosting::process::exit(0)
}

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    semihosting::process::exit(1)
}
