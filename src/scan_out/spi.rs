//! A blocking sink for SPI panels that speak MIPI DCS: ILI9341, ST7789 and their kin (SPEC S5, X5).
//!
//! `embedded-hal` has no DMA, but every HAL has its `SpiDevice`, so this is what works everywhere. The window is set
//! once per rectangle, then only pixels go out. Pixels are words already in the order of the wire
//! (`N = 2`: big-endian RGB565, `N = 3`: RGB888), so a line is sent as the bytes that it is, without a copy.
//! Initialisation (orientation, pixel format, sleep out) is the display driver's, for example `mipidsi`, before.

use core::fmt::{self, Debug, Display};
use core::task::Poll;

use embedded_hal::digital::{self, OutputPin};
use embedded_hal::spi::{self, SpiDevice};

use super::dma::{Error, ErrorKind, ErrorType, ScanoutDma, Window};

/// Column address set: first and last column, inclusive.
const CASET: u8 = 0x2A;
/// Page (line) address set: first and last line, inclusive.
const RASET: u8 = 0x2B;
/// Memory write: pixels follow, until the next command.
const RAMWR: u8 = 0x2C;

/// What goes wrong on an SPI panel. `S` is the bus's error, `P` that of the data/command pin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum SpiSinkError<S, P> {
    /// The bus or chip select failed.
    Spi(S),
    /// The data/command pin failed.
    Pin(P),
    /// Pixels without a window, more of them while a buffer waits to be polled, or `end` with lines missing.
    Sequence,
    /// An empty window, one that ends beyond 65535, or pixels that are not whole lines of what is left of it.
    Length,
}

impl<S: spi::Error, P: digital::Error> Error for SpiSinkError<S, P> {
    fn kind(&self) -> ErrorKind {
        match self {
            Self::Spi(error) => match error.kind() {
                spi::ErrorKind::Overrun => ErrorKind::Overrun,
                _ => ErrorKind::Bus,
            },
            Self::Pin(_) => ErrorKind::Bus,
            Self::Sequence => ErrorKind::Sequence,
            Self::Length => ErrorKind::Length,
        }
    }
}

impl<S: spi::Error, P: digital::Error> Display for SpiSinkError<S, P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Spi(error) => write!(f, "SPI: {}", error.kind()),
            Self::Pin(error) => write!(f, "data/command pin: {:?}", error.kind()),
            Self::Sequence | Self::Length => Display::fmt(&self.kind(), f),
        }
    }
}

impl<S: spi::Error, P: digital::Error> core::error::Error for SpiSinkError<S, P> {}

/// An SPI panel with a data/command pin, written in `start` before it returns. A pixel is a word `W`
/// whose bytes in memory are in the order of the wire, such as those of `Rgb565Be` and `Rgb888`.
///
/// Chip select may go up between lines: the panels stay in memory write until the next command.
#[derive(Debug)]
pub struct SpiSink<SPI, DC, W: 'static> {
    spi: SPI,
    dc: DC,
    /// Columns and lines to add to each window, for panels smaller than their controller's memory.
    offset: (u16, u16),
    /// The open window's width; 0 when none is open.
    width: u16,
    /// Pixels of the open window that were not sent yet, a multiple of `width`. 65535 squared fits.
    left: u32,
    /// The buffer that was sent, until it is polled.
    sent: Option<&'static mut [W]>,
}

impl<SPI, DC, W: 'static> SpiSink<SPI, DC, W> {
    /// A sink over a panel that is initialised already. `dc` is low for commands and high for data.
    pub fn new(spi: SPI, dc: DC) -> Self {
        Self {
            spi,
            dc,
            offset: (0, 0),
            width: 0,
            left: 0,
            sent: None,
        }
    }

    /// Where the panel's left top pixel is in its controller's memory, in columns and lines.
    #[must_use]
    pub fn with_offset(mut self, columns: u16, lines: u16) -> Self {
        self.offset = (columns, lines);
        self
    }

    /// Gives bus and pin back. A buffer that was sent but not polled is leaked.
    pub fn release(self) -> (SPI, DC) {
        (self.spi, self.dc)
    }
}

impl<SPI: SpiDevice, DC: OutputPin, W: bytemuck::NoUninit + 'static> SpiSink<SPI, DC, W> {
    /// Sends a command and leaves the pin at data.
    fn command(
        &mut self,
        command: u8,
        data: &[u8],
    ) -> Result<(), SpiSinkError<SPI::Error, DC::Error>> {
        self.dc.set_low().map_err(SpiSinkError::Pin)?;
        self.spi.write(&[command]).map_err(SpiSinkError::Spi)?;
        self.dc.set_high().map_err(SpiSinkError::Pin)?;
        if data.is_empty() {
            return Ok(());
        }
        self.spi.write(data).map_err(SpiSinkError::Spi)
    }

    /// Writes `words` when they are whole lines of what is left of the window.
    fn send(&mut self, words: Option<&[W]>) -> Result<(), SpiSinkError<SPI::Error, DC::Error>> {
        if self.width == 0 || self.sent.is_some() {
            return Err(SpiSinkError::Sequence);
        }
        let words = words.ok_or(SpiSinkError::Length)?;
        let len = u32::try_from(words.len()).map_err(|_| SpiSinkError::Length)?;
        if len == 0 || !len.is_multiple_of(u32::from(self.width)) || len > self.left {
            return Err(SpiSinkError::Length);
        }
        self.spi
            .write(bytemuck::cast_slice(words))
            .map_err(SpiSinkError::Spi)?;
        self.left -= len;
        Ok(())
    }
}

/// First and last of `len` columns or lines, big-endian. `None` when there are none or the last is beyond 65535.
fn span_bytes(start: u16, len: u16, offset: u16) -> Option<[u8; 4]> {
    let first = start.checked_add(offset)?;
    let last = first.checked_add(len.checked_sub(1)?)?;
    let ([a, b], [c, d]) = (first.to_be_bytes(), last.to_be_bytes());
    Some([a, b, c, d])
}

impl<SPI: SpiDevice, DC: OutputPin, W: bytemuck::NoUninit + 'static> ErrorType
    for SpiSink<SPI, DC, W>
{
    type Error = SpiSinkError<SPI::Error, DC::Error>;
}

impl<SPI: SpiDevice, DC: OutputPin, W: bytemuck::NoUninit + 'static> ScanoutDma
    for SpiSink<SPI, DC, W>
{
    type Buf = &'static mut [W];

    fn begin(&mut self, window: Window) -> Result<(), Self::Error> {
        self.width = 0;
        self.left = 0;
        let columns =
            span_bytes(window.x, window.width, self.offset.0).ok_or(SpiSinkError::Length)?;
        let lines =
            span_bytes(window.y, window.height, self.offset.1).ok_or(SpiSinkError::Length)?;
        self.command(CASET, &columns)?;
        self.command(RASET, &lines)?;
        self.command(RAMWR, &[])?;
        self.width = window.width;
        self.left = u32::from(window.width) * u32::from(window.height);
        Ok(())
    }

    fn start(&mut self, buf: Self::Buf, len: usize) -> Result<(), (Self::Error, Self::Buf)> {
        match self.send(buf.get(..len)) {
            Ok(()) => {
                self.sent = Some(buf);
                Ok(())
            }
            Err(error) => Err((error, buf)),
        }
    }

    fn poll(&mut self) -> Poll<Result<Option<Self::Buf>, Self::Error>> {
        Poll::Ready(Ok(self.sent.take()))
    }

    /// `SpiDevice` flushes before it returns, so the bus is idle already.
    fn end(&mut self) -> Result<(), Self::Error> {
        let missing = self.left > 0;
        self.width = 0;
        self.left = 0;
        if missing {
            Err(SpiSinkError::Sequence)
        } else {
            Ok(())
        }
    }
}
