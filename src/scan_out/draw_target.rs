//! Any display that `embedded-graphics` can draw on, as a sink: correct, and slower (SPEC S5, feature
//! `embedded-graphics`).
//!
//! A `DrawTarget` takes colours from an iterator, one by one, so each pixel is converted and most drivers convert
//! it back. Where the driver has raw lines, use those: `MipidsiLines` and `SpiPanel` send bytes as they are.

use core::fmt::{self, Debug, Display};
use core::marker::PhantomData;

use embedded_graphics_core::draw_target::DrawTarget;
use embedded_graphics_core::geometry::{Point, Size};
use embedded_graphics_core::primitives::Rectangle;

use super::dma::{Error, ErrorKind, Window};
use super::writer::LineWriter;

/// What goes wrong on a draw target. `E` is its own error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum DrawTargetError<E> {
    /// The target failed.
    Target(E),
    /// The rectangle is not on the target, which would leave it out without a word.
    Window,
}

impl<E: Debug> Error for DrawTargetError<E> {
    fn kind(&self) -> ErrorKind {
        match self {
            Self::Target(_) => ErrorKind::Bus,
            Self::Window => ErrorKind::Length,
        }
    }
}

impl<E: Debug> Display for DrawTargetError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Target(error) => write!(f, "draw target: {error:?}"),
            Self::Window => f.write_str("the rectangle is not on the draw target"),
        }
    }
}

impl<E: Debug> core::error::Error for DrawTargetError<E> {}

/// A `DrawTarget` as a writer of lines. Column and line 0 are its point (0, 0).
///
/// It owns the target: `embedded-graphics` has no `DrawTarget` for `&mut T`. A target that is lent needs a type of your own
/// around the reference, which hands its calls on.
///
/// ```
/// # struct Screen;
/// # impl embedded_graphics_core::geometry::OriginDimensions for Screen {
/// #     fn size(&self) -> embedded_graphics_core::geometry::Size { (320, 240).into() }
/// # }
/// # impl embedded_graphics_core::draw_target::DrawTarget for Screen {
/// #     type Color = Rgb565;
/// #     type Error = core::convert::Infallible;
/// #     fn draw_iter<I>(&mut self, _: I) -> Result<(), Self::Error> { Ok(()) }
/// # }
/// # let screen = Screen;
/// use embedded_graphics_core::pixelcolor::{Rgb565, raw::RawU16};
/// use scanbeam::scan_out::{Blocking, DrawTargetLines, Pump};
///
/// # fn buffer() -> &'static mut [u16] { Box::leak(Box::new([0; 320])) }
/// // Words of the pixel format `Rgb565`.
/// let lines = DrawTargetLines::new(screen, |word: u16| Rgb565::from(RawU16::new(word)));
/// let pump = Pump::new(Blocking::over(lines), [buffer(), buffer()]);
/// ```
#[derive(Debug)]
pub struct DrawTargetLines<T, F, W> {
    target: T,
    colour: F,
    word: PhantomData<fn() -> W>,
}

impl<T: DrawTarget, F: FnMut(W) -> T::Color, W: Copy + 'static> DrawTargetLines<T, F, W> {
    /// A target, and what makes its colours of words.
    pub const fn new(target: T, colour: F) -> Self {
        Self {
            target,
            colour,
            word: PhantomData,
        }
    }

    /// The target.
    pub const fn target(&self) -> &T {
        &self.target
    }

    /// The target, for example to draw on it between frames.
    pub const fn target_mut(&mut self) -> &mut T {
        &mut self.target
    }
}

/// The rectangle in terms of `embedded-graphics`.
fn rectangle(window: Window) -> Rectangle {
    let corner = Point::new(window.x.into(), window.y.into());
    Rectangle::new(corner, Size::new(window.width.into(), window.height.into()))
}

impl<T, F, W> LineWriter for DrawTargetLines<T, F, W>
where
    T: DrawTarget<Error: Debug>,
    F: FnMut(W) -> T::Color,
    W: Copy + 'static,
{
    type Error = DrawTargetError<T::Error>;
    type Word = W;

    fn open(&mut self, window: Window) -> Result<(), Self::Error> {
        let area = rectangle(window);
        let is_inside = self.target.bounding_box().intersection(&area) == area;
        is_inside.then_some(()).ok_or(DrawTargetError::Window)
    }

    fn write(&mut self, lines: Window, words: &[W]) -> Result<(), Self::Error> {
        let colours = words.iter().map(|&word| (self.colour)(word));
        self.target
            .fill_contiguous(&rectangle(lines), colours)
            .map_err(DrawTargetError::Target)
    }
}
