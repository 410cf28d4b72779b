//! Scan-out: finished lines leave for the display while the next ones are drawn (SPEC S5, K12, X5).
//!
//! Four things live here, and none of them knows what a triangle is:
//!
//! - [`ScanoutDma`], the trait of anything that takes lines: a DMA channel, a display on a bus, a mock.
//! - [`Pump`], which holds the two line buffers and swaps them, so that one is filled while the other is sent.
//! - [`ShownLines`], which knows what the display shows, so that lines which stay are not sent (X4).
//! - [`SpiSink`], a blocking sink for the common SPI panels, over `embedded-hal` 1.0.
//!
//! ```text
//!   renderer --line()/line_done()--> Pump --start(buf, len)--> ScanoutDma --> bus
//!                                     ^                            |
//!                                     +---- poll() -> Some(buf) ---+
//! ```

mod changed;
mod dma;
mod pump;
mod spi;

pub use changed::{LineWord, ShownLines};
pub use dma::{Error, ErrorKind, ErrorType, LineBuf, ScanoutDma, Window};
pub use pump::{PUMP_BUFFERS, Pump, ScanError, ScanStats};
pub use spi::{SpiSink, SpiSinkError};
