//! Scan-out: finished lines leave for the display while the next ones are drawn (SPEC S5, K12, X5).
//!
//! None of what lives here knows what a triangle is:
//!
//! - [`ScanoutDma`], the trait of anything that takes lines: a DMA channel, a display on a bus, a mock.
//! - [`Pump`], which holds the two line buffers and swaps them, so that one is filled while the other is sent.
//! - [`ShownLines`] and [`ShownRuns`], which know what the display shows, so that lines, or runs of pixels
//!   within them, which stay are not sent (X4).
//! - [`LineWriter`] and [`Blocking`], which make a sink of two or three functions that block.
//! - [`send_doubled`], which sends four pixels for each that is drawn, interpolated between.
//! - [`feed_line`] and [`ContinuousPanel`], for panels that read on their own clock.
//!
//! | writer | for | feature |
//! |---|---|---|
//! | [`SpiPanel`] | SPI panels with MIPI commands, over `embedded-hal` 1.0 | |
//! | [`FrameBuffer`] | frames in memory that a controller scans, swapped without tearing | |
//! | [`BlockFrame`] | a picture in memory in blocks, to be read as a texture or turned | |
//! | `MipidsiLines` | panels that `mipidsi` 0.10 has set up | `mipidsi` |
//! | `DrawTargetLines` | any `DrawTarget` of `embedded-graphics` | `embedded-graphics` |
//! | [`SpiPanel`], with an `AsyncPump` | SPI panels over `embedded-hal-async` | `async` |
//!
//! ```text
//!   renderer --line()/line_done()--> Pump --start(buf, len)--> ScanoutDma --> bus
//!                                     ^                            |
//!                                     +---- poll() -> Some(buf) ---+
//! ```

#[cfg(feature = "async")]
mod async_out;
mod blocked;
mod changed;
mod continuous;
mod dma;
mod doubled;
#[cfg(feature = "embedded-graphics")]
mod draw_target;
mod frame_buffer;
#[cfg(feature = "mipidsi")]
mod mipidsi;
mod pump;
mod shown_runs;
mod spi;
mod writer;

#[cfg(feature = "async")]
pub use async_out::{AsyncLineWriter, AsyncPump};
pub use blocked::BlockFrame;
pub use changed::ShownLines;
pub use continuous::{ContinuousPanel, Fed, FeedStats, feed_line};
pub use dma::{Error, ErrorKind, LineBuf, ScanoutDma, Window};
pub use doubled::send_doubled;
#[cfg(feature = "embedded-graphics")]
pub use draw_target::{DrawTargetError, DrawTargetLines};
pub use frame_buffer::{FrameBuffer, FrameBufferError, SwapFlag};
#[cfg(feature = "mipidsi")]
pub use mipidsi::{MipidsiLines, MipidsiWire};
pub use pump::{Pump, RunFrame, ScanError, ScanStats};
pub use shown_runs::ShownRuns;
pub use spi::{PanelError, SpiPanel};
pub use writer::{Blocking, BlockingError, LineWriter};
