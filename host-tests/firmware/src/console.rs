//! Lines to the host over semihosting, and the way out.
//!
//! Every semihosting call stops the machine, so a line is collected and sent in one write. The
//! host stops QEMU when the exit call comes, with 0 or 1 as its own exit code.

use core::{
    fmt::{self, Write},
    panic::PanicInfo,
};

use cortex_m_rt::{ExceptionFrame, exception};
use cortex_m_semihosting::{
    debug::{self, EXIT_FAILURE, EXIT_SUCCESS},
    hio::{self, HostStream},
};
use heapless::Vec;

/// Lines of up to this many bytes are one write; longer ones take several.
const LINE_BYTES: usize = 256;

/// The host's standard output.
pub(crate) struct Console {
    host: HostStream,
    line: Vec<u8, LINE_BYTES>,
}

impl Console {
    /// Opens the host's standard output; stops with failure if the host has none.
    pub(crate) fn open() -> Self {
        match hio::hstdout() {
            Ok(host) => Self {
                host,
                line: Vec::new(),
            },
            Err(_) => exit(false),
        }
    }

    /// Sends one line; the newline is added here.
    pub(crate) fn line(&mut self, text: fmt::Arguments<'_>) {
        if self.write_fmt(text).is_err() || self.write_str("\n").is_err() || self.flush().is_err() {
            exit(false);
        }
    }

    fn flush(&mut self) -> fmt::Result {
        let sent = self.host.write_all(&self.line);
        self.line.clear();
        sent.map_err(|_| fmt::Error)
    }
}

impl Write for Console {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for &byte in text.as_bytes() {
            if self.line.is_full() {
                self.flush()?;
            }
            self.line.push(byte).map_err(|_| fmt::Error)?;
        }
        Ok(())
    }
}

/// Ends the run; the host sees exit code 0 for `success` and 1 otherwise.
pub(crate) fn exit(success: bool) -> ! {
    debug::exit(if success { EXIT_SUCCESS } else { EXIT_FAILURE });
    // Only without a host that listens.
    loop {
        cortex_m::asm::wfi();
    }
}

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    cortex_m::interrupt::disable();
    Console::open().line(format_args!("panic {info}"));
    exit(false)
}

// SAFETY: nothing of the interrupted program is touched; the handler prints and never returns.
#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    Console::open().line(format_args!(
        "fault pc={:08x} lr={:08x}",
        frame.pc(),
        frame.lr()
    ));
    exit(false)
}
