//! A writer for SPI panels that speak MIPI DCS: ILI9341, ST7789 and their kin (SPEC S5, X5).
//!
//! `embedded-hal` has no DMA, but every HAL has its `SpiDevice`, so this is what works everywhere. The window is set
//! once per rectangle, then only pixels go out. Pixels are words already in the order of the wire
//! (`N = 2`: big-endian RGB565, `N = 3`: RGB888), so a line is sent as the bytes that it is, without a copy.
//! Initialisation (orientation, pixel format, sleep out) is the display driver's: for one that is `mipidsi`'s,
//! `MipidsiLines` takes its window too.

use core::fmt::{self, Debug, Display};
use core::marker::PhantomData;

use embedded_hal::digital::{self, OutputPin};
use embedded_hal::spi::{self, SpiDevice};

use super::dma::{Error, ErrorKind, Window};
use super::writer::LineWriter;

/// Column address set: first and last column, inclusive.
const CASET: u8 = 0x2A;
/// Page (line) address set: first and last line, inclusive.
const RASET: u8 = 0x2B;
/// Memory write: pixels follow, until the next command.
pub(super) const RAMWR: u8 = 0x2C;

/// What goes wrong between here and an SPI panel. `S` is the bus's error, `P` that of the data/command pin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum PanelError<S, P> {
    /// The bus or chip select failed.
    Spi(S),
    /// The data/command pin failed.
    Pin(P),
    /// The window is not on the display, or ends beyond column or line 65535.
    Window,
}

impl<S: spi::Error, P: digital::Error> Error for PanelError<S, P> {
    fn kind(&self) -> ErrorKind {
        match self {
            Self::Spi(error) => match error.kind() {
                spi::ErrorKind::Overrun => ErrorKind::Overrun,
                _ => ErrorKind::Bus,
            },
            Self::Pin(_) => ErrorKind::Bus,
            Self::Window => ErrorKind::Length,
        }
    }
}

impl<S: spi::Error, P: digital::Error> Display for PanelError<S, P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Spi(error) => write!(f, "SPI: {}", error.kind()),
            Self::Pin(error) => write!(f, "data/command pin: {:?}", error.kind()),
            Self::Window => Display::fmt(&self.kind(), f),
        }
    }
}

impl<S: spi::Error, P: digital::Error> core::error::Error for PanelError<S, P> {}

/// A bus and its data/command pin, low for commands and high for data.
#[derive(Debug)]
pub(super) struct Wire<SPI, DC> {
    pub(super) spi: SPI,
    pub(super) dc: DC,
}

impl<SPI: SpiDevice, DC: OutputPin> Wire<SPI, DC> {
    /// Sends a command and leaves the pin at data.
    pub(super) fn command(
        &mut self,
        command: u8,
        data: &[u8],
    ) -> Result<(), PanelError<SPI::Error, DC::Error>> {
        self.dc.set_low().map_err(PanelError::Pin)?;
        self.spi.write(&[command]).map_err(PanelError::Spi)?;
        self.dc.set_high().map_err(PanelError::Pin)?;
        if data.is_empty() {
            return Ok(());
        }
        self.data(data)
    }

    /// Sends data of the last command.
    pub(super) fn data(&mut self, bytes: &[u8]) -> Result<(), PanelError<SPI::Error, DC::Error>> {
        self.spi.write(bytes).map_err(PanelError::Spi)
    }
}

/// The two commands that set a window, which is so many columns and lines further in the controller's memory.
/// `None` when it is empty or ends beyond 65535.
pub(super) fn window_commands(
    window: Window,
    [right, down]: [u16; 2],
) -> Option<[(u8, [u8; 4]); 2]> {
    Some([
        (CASET, ends(window.x, window.width, right)?),
        (RASET, ends(window.y, window.height, down)?),
    ])
}

/// First and last of `len` columns or lines, big-endian.
fn ends(start: u16, len: u16, offset: u16) -> Option<[u8; 4]> {
    let first = start.checked_add(offset)?;
    let last = first.checked_add(len.checked_sub(1)?)?;
    let ([a, b], [c, d]) = (first.to_be_bytes(), last.to_be_bytes());
    Some([a, b, c, d])
}

/// An SPI panel with a data/command pin, as a writer of lines: of any word `W` whose bytes in memory are in the order of
/// the wire, such as those of `Rgb565Be` and `Rgb888`.
///
/// Over a bus of `embedded-hal` it is a [`LineWriter`], for [`Blocking`](super::Blocking); over one of `embedded-hal-async`,
/// whose HAL has the DMA, an `AsyncLineWriter`. Chip select may go up between lines: the panels stay in memory write until
/// the next command.
#[derive(Debug)]
pub struct SpiPanel<SPI, DC, W> {
    pub(super) wire: Wire<SPI, DC>,
    /// Columns and lines to add to each window, for panels smaller than their controller's memory.
    pub(super) offset: [u16; 2],
    word: PhantomData<fn() -> W>,
}

impl<SPI, DC, W> SpiPanel<SPI, DC, W> {
    /// A panel that is initialised already. `dc` is low for commands and high for data.
    pub const fn new(spi: SPI, dc: DC) -> Self {
        Self {
            wire: Wire { spi, dc },
            offset: [0; 2],
            word: PhantomData,
        }
    }

    /// Where the panel's left top pixel is in its controller's memory, in columns and lines.
    #[must_use]
    pub const fn with_offset(mut self, columns: u16, lines: u16) -> Self {
        self.offset = [columns, lines];
        self
    }

    /// Gives bus and pin back.
    pub fn release(self) -> (SPI, DC) {
        (self.wire.spi, self.wire.dc)
    }
}

/// `SpiDevice` flushes before it returns, so there is nothing to wait for at the end.
impl<SPI: SpiDevice, DC: OutputPin, W: bytemuck::NoUninit + 'static> LineWriter
    for SpiPanel<SPI, DC, W>
{
    type Error = PanelError<SPI::Error, DC::Error>;
    type Word = W;

    fn open(&mut self, window: Window) -> Result<(), Self::Error> {
        let commands = window_commands(window, self.offset).ok_or(PanelError::Window)?;
        for (command, data) in commands {
            self.wire.command(command, &data)?;
        }
        self.wire.command(RAMWR, &[])
    }

    fn write(&mut self, _: Window, words: &[W]) -> Result<(), Self::Error> {
        self.wire.data(bytemuck::cast_slice(words))
    }
}
