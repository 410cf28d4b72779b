//! Panels that `mipidsi` 0.10 has set up: the window by its API, the pixels as raw lines (SPEC S5, feature `mipidsi`).
//!
//! `mipidsi` knows some twenty controllers, with their orientations and offsets, but takes pixels from an iterator. With
//! no pixels it only sets the window, so that is what it is asked for, and the bytes of a line then go over
//! the same bus as they are. Bus and pin are lent to both, through [`MipidsiWire`].

use core::cell::RefCell;
use core::iter;
use core::marker::PhantomData;

use ::mipidsi::Display;
use ::mipidsi::interface::{Interface, InterfaceKind, InterfacePixelFormat};
use ::mipidsi::models::Model;
use embedded_graphics_core::geometry::OriginDimensions;
use embedded_hal::digital::OutputPin;
use embedded_hal::spi::SpiDevice;
use heapless::Vec;

use super::dma::Window;
use super::spi::{PanelError, Wire};
use super::writer::LineWriter;

/// Bytes that `mipidsi`'s own drawing collects before it sends them. Scan-out sends lines instead.
const CHUNK: usize = 48;

/// A bus and a data/command pin, which `mipidsi` and the sink use in turn.
///
/// ```
/// # use core::convert::Infallible;
/// # use embedded_hal::{delay::DelayNs, digital, spi};
/// # struct Spi; struct Pin; struct Delay;
/// # impl spi::ErrorType for Spi { type Error = Infallible; }
/// # impl spi::SpiDevice for Spi { fn transaction(&mut self, _: &mut [spi::Operation<'_, u8>]) -> Result<(), Infallible> { Ok(()) } }
/// # impl digital::ErrorType for Pin { type Error = Infallible; }
/// # impl digital::OutputPin for Pin { fn set_low(&mut self) -> Result<(), Infallible> { Ok(()) } fn set_high(&mut self) -> Result<(), Infallible> { Ok(()) } }
/// # impl DelayNs for Delay { fn delay_ns(&mut self, _: u32) {} }
/// # let (spi, dc, mut delay) = (Spi, Pin, Delay);
/// use mipidsi::{Builder, models::ILI9341Rgb565};
/// use scanbeam::scan_out::{Blocking, MipidsiLines, MipidsiWire, Pump};
///
/// let wire = MipidsiWire::new(spi, dc);
/// let display = Builder::new(ILI9341Rgb565, &wire).init(&mut delay).expect("the panel answers");
/// // Words of the pixel format `Rgb565Be`, 8 lines a transfer.
/// # fn buffer() -> &'static mut [u16] { Box::leak(vec![0; 240 * 8].into()) }
/// let lines = MipidsiLines::<_, _, _, _, u16>::new(display, &wire);
/// let pump = Pump::new(Blocking::over(lines), [buffer(), buffer()]);
/// ```
#[derive(Debug)]
pub struct MipidsiWire<SPI, DC>(RefCell<Wire<SPI, DC>>);

impl<SPI, DC> MipidsiWire<SPI, DC> {
    /// `dc` is low for commands and high for data.
    pub const fn new(spi: SPI, dc: DC) -> Self {
        Self(RefCell::new(Wire { spi, dc }))
    }

    /// Gives bus and pin back.
    pub fn release(self) -> (SPI, DC) {
        let wire = self.0.into_inner();
        (wire.spi, wire.dc)
    }
}

/// Each call borrows the wire for itself alone, and calls nothing that could borrow it again.
impl<SPI: SpiDevice, DC: OutputPin> Interface for &MipidsiWire<SPI, DC> {
    type Word = u8;
    type Error = PanelError<SPI::Error, DC::Error>;

    const KIND: InterfaceKind = InterfaceKind::Serial4Line;

    fn send_command(&mut self, command: u8, args: &[u8]) -> Result<(), Self::Error> {
        self.0.borrow_mut().command(command, args)
    }

    fn send_pixels<const N: usize>(
        &mut self,
        pixels: impl IntoIterator<Item = [u8; N]>,
    ) -> Result<(), Self::Error> {
        let mut bytes = pixels.into_iter().flatten();
        loop {
            let chunk: Vec<u8, CHUNK> = bytes.by_ref().take(CHUNK).collect();
            if chunk.is_empty() {
                return Ok(());
            }
            self.0.borrow_mut().data(&chunk)?;
        }
    }

    fn send_repeated_pixel<const N: usize>(
        &mut self,
        pixel: [u8; N],
        count: u32,
    ) -> Result<(), Self::Error> {
        self.send_pixels((0..count).map(|_| pixel))
    }
}

/// A display of `mipidsi` as a writer of lines: see [`MipidsiWire`] for how it is made. Words are in the order of the bus,
/// for example those of `Rgb565Be`.
pub struct MipidsiLines<'w, SPI: SpiDevice, DC: OutputPin, M, RST, W>
where
    M: Model<ColorFormat: InterfacePixelFormat<u8>>,
    RST: OutputPin,
{
    display: Display<&'w MipidsiWire<SPI, DC>, M, RST>,
    wire: &'w MipidsiWire<SPI, DC>,
    word: PhantomData<fn() -> W>,
}

impl<'w, SPI, DC, M, RST, W> MipidsiLines<'w, SPI, DC, M, RST, W>
where
    SPI: SpiDevice,
    DC: OutputPin,
    M: Model<ColorFormat: InterfacePixelFormat<u8>>,
    RST: OutputPin,
{
    /// A display that is set up, and the wire that it was made with.
    pub const fn new(
        display: Display<&'w MipidsiWire<SPI, DC>, M, RST>,
        wire: &'w MipidsiWire<SPI, DC>,
    ) -> Self {
        Self {
            display,
            wire,
            word: PhantomData,
        }
    }

    /// The display, for sleep, orientation and its own drawing between frames.
    pub const fn display_mut(&mut self) -> &mut Display<&'w MipidsiWire<SPI, DC>, M, RST> {
        &mut self.display
    }
}

impl<SPI, DC, M, RST, W> LineWriter for MipidsiLines<'_, SPI, DC, M, RST, W>
where
    SPI: SpiDevice,
    DC: OutputPin,
    M: Model<ColorFormat: InterfacePixelFormat<u8>>,
    RST: OutputPin,
    W: bytemuck::NoUninit + 'static,
{
    type Error = PanelError<SPI::Error, DC::Error>;
    type Word = W;

    /// `mipidsi` adds offsets without a check, so the window must be on the display.
    fn open(&mut self, window: Window) -> Result<(), Self::Error> {
        let size = self.display.size();
        let last = |start: u16, len: u16, end: u32| {
            let last = start.checked_add(len.checked_sub(1)?)?;
            (u32::from(last) < end).then_some(last)
        };
        let right = last(window.x, window.width, size.width).ok_or(PanelError::Window)?;
        let bottom = last(window.y, window.height, size.height).ok_or(PanelError::Window)?;
        self.display
            .set_pixels(window.x, window.y, right, bottom, iter::empty())
    }

    fn write(&mut self, _: Window, words: &[W]) -> Result<(), Self::Error> {
        self.wire.0.borrow_mut().data(bytemuck::cast_slice(words))
    }
}
