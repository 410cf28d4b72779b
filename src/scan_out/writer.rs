//! Sinks that are busy until a line is written, from two or three functions each (SPEC S5, X5).
//!
//! A panel on a bus without DMA, a driver of somebody else, memory that a controller scans: none of them holds a
//! buffer while the next line is drawn. So [`LineWriter`] is all that they implement, and [`Blocking`] makes a
//! [`ScanoutDma`] of it: it counts the lines, refuses what is out of turn and gives the buffer back. Nothing
//! overlaps; drawing and sending take turns.

use core::fmt::{self, Display};
use core::task::Poll;

use super::dma::{Error, ErrorKind, LineBuf, ScanoutDma, Window};

/// Takes lines and is done with them when it returns.
pub trait LineWriter {
    /// What can go wrong.
    type Error: Error;
    /// One pixel, as the display takes it.
    type Word: Copy + 'static;

    /// Opens a rectangle of at least one pixel, and waits until the display is ready for the first.
    ///
    /// # Errors
    /// When the display has no such rectangle or fails.
    fn open(&mut self, window: Window) -> Result<(), Self::Error>;

    /// Writes the next whole lines of the rectangle: `lines` says where they are, `words` has its width times
    /// its height.
    ///
    /// # Errors
    /// When the display fails. Some of the lines may have been written.
    fn write(&mut self, lines: Window, words: &[Self::Word]) -> Result<(), Self::Error>;

    /// Closes the rectangle. `whole` says that each of its lines was written.
    ///
    /// # Errors
    /// When the display fails. The rectangle is closed all the same.
    fn close(&mut self, whole: bool) -> Result<(), Self::Error> {
        let _ = whole;
        Ok(())
    }
}

impl<T: LineWriter + ?Sized> LineWriter for &mut T {
    type Error = T::Error;
    type Word = T::Word;

    fn open(&mut self, window: Window) -> Result<(), Self::Error> {
        T::open(self, window)
    }

    fn write(&mut self, lines: Window, words: &[Self::Word]) -> Result<(), Self::Error> {
        T::write(self, lines, words)
    }

    fn close(&mut self, whole: bool) -> Result<(), Self::Error> {
        T::close(self, whole)
    }
}

/// What goes wrong in a [`Blocking`] sink.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum BlockingError<E> {
    /// The writer failed.
    Writer(E),
    /// Lines without a rectangle, more of them while a buffer waits to be polled, or `end` with lines missing.
    Sequence,
    /// An empty rectangle, or words that are not whole lines of what is left of it.
    Length,
}

impl<E: Error> Error for BlockingError<E> {
    fn kind(&self) -> ErrorKind {
        match self {
            Self::Writer(error) => error.kind(),
            Self::Sequence => ErrorKind::Sequence,
            Self::Length => ErrorKind::Length,
        }
    }
}

impl<E: Error> Display for BlockingError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Display::fmt(&self.kind(), f)
    }
}

impl<E: Error> core::error::Error for BlockingError<E> {}

/// A [`ScanoutDma`] that writes in `start` and gives the buffer back with the next `poll`.
#[derive(Debug)]
pub struct Blocking<T, B> {
    writer: T,
    /// What is left of the open rectangle; no lines when it is complete.
    left: Option<Window>,
    /// The buffer that was written, until it is polled.
    written: Option<B>,
}

impl<T, B> Blocking<T, B> {
    /// A sink over a writer without an open rectangle.
    pub const fn over(writer: T) -> Self {
        Self {
            writer,
            left: None,
            written: None,
        }
    }

    /// The writer.
    pub const fn writer(&self) -> &T {
        &self.writer
    }

    /// The writer, for settings between frames.
    pub const fn writer_mut(&mut self) -> &mut T {
        &mut self.writer
    }

    /// Gives the writer back. A buffer that was written but not polled is dropped.
    pub fn into_writer(self) -> T {
        self.writer
    }
}

impl<T: LineWriter, B: LineBuf<Word = T::Word>> Blocking<T, B> {
    /// Writes `words` when they are whole lines of what is left.
    fn send(&mut self, words: Option<&[T::Word]>) -> Result<(), BlockingError<T::Error>> {
        let Some(left) = self.left.filter(|_| self.written.is_none()) else {
            return Err(BlockingError::Sequence);
        };
        let words = words.ok_or(BlockingError::Length)?;
        let lines = whole_lines(words.len(), left).ok_or(BlockingError::Length)?;
        self.writer
            .write(lines, words)
            .map_err(BlockingError::Writer)?;
        self.left = Some(Window {
            y: left.y.saturating_add(lines.height),
            height: left.height.saturating_sub(lines.height),
            ..left
        });
        Ok(())
    }
}

/// The top lines of `left` that `words` words are; `None` when they are not whole, none or too many.
fn whole_lines(words: usize, left: Window) -> Option<Window> {
    let width = usize::from(left.width);
    let is_whole = |height: &usize| *height > 0 && height * width == words;
    let height = words.checked_div(width).filter(is_whole)?;
    let height = u16::try_from(height).ok().filter(|&n| n <= left.height)?;
    Some(Window { height, ..left })
}

impl<T: LineWriter, B: LineBuf<Word = T::Word>> ScanoutDma for Blocking<T, B> {
    type Error = BlockingError<T::Error>;
    type Buf = B;

    fn begin(&mut self, window: Window) -> Result<(), Self::Error> {
        self.left = None;
        if window.width == 0 || window.height == 0 {
            return Err(BlockingError::Length);
        }
        self.writer.open(window).map_err(BlockingError::Writer)?;
        self.left = Some(window);
        Ok(())
    }

    fn start(&mut self, mut buf: B, len: usize) -> Result<(), (Self::Error, B)> {
        match self.send(buf.pixels().get(..len)) {
            Ok(()) => {
                self.written = Some(buf);
                Ok(())
            }
            Err(error) => Err((error, buf)),
        }
    }

    fn poll(&mut self) -> Poll<Result<Option<B>, Self::Error>> {
        Poll::Ready(Ok(self.written.take()))
    }

    fn end(&mut self) -> Result<(), Self::Error> {
        let Some(left) = self.left.take() else {
            return Ok(());
        };
        let whole = left.height == 0;
        self.writer.close(whole).map_err(BlockingError::Writer)?;
        whole.then_some(()).ok_or(BlockingError::Sequence)
    }
}
