//! What the small programs share: a display, a picture of the teapot, and the way out, without
//! formatting and without messages, so that `.text` is what drawing takes.

// Supplies the critical-section implementation, also where nothing else names it.
use cortex_m as _;

use core::convert::Infallible;
use core::panic::PanicInfo;
use core::sync::atomic::{AtomicU16, Ordering};
use core::task::Poll;
use cortex_m_semihosting::{debug, hio};
use scanbeam::scan_out::{Pump, ScanoutDma, Window};

/// The two line buffers, one line each.
macro_rules! buffers {
    () => {{
        use crate::lend::lend;
        use scenes::WIDTH;
        let one: &'static mut [u16] = lend!(".dma", u16, WIDTH as usize, 0);
        let two: &'static mut [u16] = lend!(".dma", u16, WIDTH as usize, 0);
        [one, two]
    }};
}
pub(crate) use buffers;

/// A pump to a display, and back.
pub(crate) type Display = Pump<Wire>;

/// A display on two line buffers.
pub(crate) fn display(buffers: [&'static mut [u16]; 2]) -> Display {
    Pump::new(
        Wire {
            crc: !0,
            sent: None,
        },
        buffers,
    )
}

/// Says what has been sent since the last time: `picture NAME CRC`.
pub(crate) fn say(name: &str, display: &mut Display) {
    let Ok(mut host) = hio::hstdout() else {
        exit(false)
    };
    let crc = !core::mem::replace(&mut display.sink_mut().crc, !0);
    let mut digits = [0; 9];
    digits[8] = b'\n';
    for (i, digit) in digits[..8].iter_mut().enumerate() {
        *digit = b"0123456789abcdef"[(crc >> (28 - 4 * i) & 15) as usize];
    }
    for text in [b"picture ", name.as_bytes(), b" ", &digits] {
        if host.write_all(text).is_err() {
            exit(false);
        }
    }
}

/// Where a display would be: each word goes to a register, and into a checksum.
pub(crate) struct Wire {
    /// CRC-32 as PNG has it, not yet inverted.
    crc: u32,
    sent: Option<&'static mut [u16]>,
}

static REGISTER: AtomicU16 = AtomicU16::new(0);

impl ScanoutDma for Wire {
    type Error = Infallible;
    type Buf = &'static mut [u16];

    fn begin(&mut self, _: Window) -> Result<(), Infallible> {
        Ok(())
    }

    fn start(&mut self, line: Self::Buf, len: usize) -> Result<(), (Infallible, Self::Buf)> {
        for &word in line.iter().take(len) {
            REGISTER.store(word, Ordering::Relaxed);
            for byte in word.to_ne_bytes() {
                self.crc ^= u32::from(byte);
                for _ in 0..8 {
                    self.crc = self.crc >> 1 ^ (0xEDB8_8320 & (self.crc & 1).wrapping_neg());
                }
            }
        }
        self.sent = Some(line);
        Ok(())
    }

    fn poll(&mut self) -> Poll<Result<Option<Self::Buf>, Infallible>> {
        Poll::Ready(Ok(self.sent.take()))
    }

    fn end(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

/// Ends the run with exit code 0 or 1.
pub(crate) fn exit(success: bool) -> ! {
    debug::exit(if success {
        debug::EXIT_SUCCESS
    } else {
        debug::EXIT_FAILURE
    });
    loop {
        cortex_m::asm::wfi();
    }
}

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    exit(false)
}
