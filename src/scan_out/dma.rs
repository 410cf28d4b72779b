//! The traits of a sink of lines, in the manner of `embedded-hal` (SPEC S5, X5).
//!
//! `embedded-hal` 1.0 has no DMA trait, so this is ours: `Error` with a `kind`, a non-exhaustive `ErrorKind`,
//! implementations for `&mut T` and for `Infallible`.
//!
//! Buffers are *moved* in and out. A guard that borrows the buffer would be unsound, because `mem::forget` of the
//! guard is safe and would leave the DMA reading memory that is someone else's by then. So every error hands
//! its buffer back too: a lost buffer could not be made again without a heap.

use core::convert::Infallible;
use core::fmt::{self, Debug, Display};
use core::task::Poll;

/// What went wrong in a sink, in terms that code above it can act on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum ErrorKind {
    /// The bus or a pin failed.
    Bus,
    /// The transfer did not finish in the time that was given.
    Timeout,
    /// Data came faster than it could be taken, or the display ran dry.
    Overrun,
    /// A call out of turn: a line without a rectangle, too many lines or too few, a start while busy.
    Sequence,
    /// A length or a rectangle that does not fit the display, the buffer or the open rectangle.
    Length,
    /// Anything else.
    Other,
}

impl Display for ErrorKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Bus => "the bus failed",
            Self::Timeout => "the transfer took too long",
            Self::Overrun => "data overran or ran dry",
            Self::Sequence => "the call came out of turn",
            Self::Length => "the length or rectangle does not fit",
            Self::Other => "an error of another kind",
        })
    }
}

impl core::error::Error for ErrorKind {}

/// An error of a sink.
pub trait Error: Debug {
    /// The kind of the error, for code that knows nothing of the sink.
    fn kind(&self) -> ErrorKind;
}

impl Error for ErrorKind {
    fn kind(&self) -> ErrorKind {
        *self
    }
}

impl Error for Infallible {
    fn kind(&self) -> ErrorKind {
        match *self {}
    }
}

/// A rectangle of the display, in pixels. The right and bottom ends are exclusive: `x + width`, `y + height`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Window {
    /// The leftmost column, 0 at the left edge of the display.
    pub x: u16,
    /// The topmost line, 0 at the top edge of the display.
    pub y: u16,
    /// Columns, at least 1 for a rectangle that is sent.
    pub width: u16,
    /// Lines, at least 1 for a rectangle that is sent.
    pub height: u16,
}

impl Window {
    /// Whether its right and bottom ends are numbers of 16 bits.
    pub(super) fn has_ends(self) -> bool {
        let ends = [(self.x, self.width), (self.y, self.height)];
        ends.iter().all(|&(at, len)| at.checked_add(len).is_some())
    }

    /// Whether it lies within so many columns and lines.
    pub(super) fn is_within(self, columns: u16, lines: u16) -> bool {
        let fits = |at: u16, len, end| at.checked_add(len).is_some_and(|last| last <= end);
        fits(self.x, self.width, columns) && fits(self.y, self.height, lines)
    }
}

/// A buffer of one or more lines that can be moved into a sink and back.
///
/// `'static`, so that a sink that is forgotten while it sends leaves the buffer where it is.
/// `static_cell` is the usual way to make one; HALs whose buffers include descriptors implement it for their own type.
pub trait LineBuf: 'static {
    /// One pixel as the display takes it, for example `[u8; 2]` for big-endian RGB565 or `u16` for native RGB565.
    type Word: Copy + 'static;

    /// The words, as many as the buffer ever holds: the length must not change.
    fn pixels(&mut self) -> &mut [Self::Word];
}

impl<W: Copy + 'static> LineBuf for &'static mut [W] {
    type Word = W;

    fn pixels(&mut self) -> &mut [W] {
        self
    }
}

/// A sink that takes whole lines of a rectangle, by DMA or otherwise.
///
/// The order of calls is `begin`, then for each buffer `start` and `poll` until the buffer is back, then `end`:
///
/// - [`begin`](Self::begin) opens a rectangle. Buffers are then started with its lines in order, top to bottom,
///   each holding one or more whole lines.
/// - [`poll`](Self::poll) is `Pending` while a transfer runs, gives each finished buffer back exactly once, oldest
///   first, and is `Ready(Ok(None))` when there is nothing left to give back.
/// - [`end`](Self::end) closes the rectangle.
///
/// Sinks come in three sorts, and [`Pump`](super::Pump) drives all of them alike:
///
/// | sort | `start` | `poll` | `chains` |
/// |---|---|---|---|
/// | blocking | sends before it returns | gives the buffer back at once | `false` |
/// | polled | starts the DMA | asks the DMA whether it is done | `false` |
/// | chained | queues behind the running transfer | as polled, oldest first | `true` |
///
/// # Example
///
/// A sink over the DMA of an ordinary HAL, whose transfers own channel and buffer (`hal` stands for yours):
///
/// ```
/// # mod hal {
/// #     pub struct Channel;
/// #     pub struct Transfer(&'static mut [u16]);
/// #     #[derive(Debug)] pub struct DmaError;
/// #     impl Transfer {
/// #         pub fn start(_: Channel, buf: &'static mut [u16], _words: usize) -> Self { Self(buf) }
/// #         pub fn is_done(&self) -> bool { true }
/// #         pub fn wait(self) -> (Channel, &'static mut [u16]) { (Channel, self.0) }
/// #     }
/// #     pub struct Lcd;
/// #     impl Lcd { pub fn set_window(&mut self, _: core::ops::Range<u16>, _: core::ops::Range<u16>) {} pub fn wait_idle(&mut self) {} }
/// # }
/// use core::task::Poll;
/// use scanbeam::scan_out::{ErrorKind, ScanoutDma, Window};
///
/// struct Sink { lcd: hal::Lcd, idle: Option<hal::Channel>, running: Option<hal::Transfer> }
///
/// impl ScanoutDma for Sink {
///     type Error = ErrorKind;
///     type Buf = &'static mut [u16];
///
///     fn begin(&mut self, w: Window) -> Result<(), ErrorKind> {
///         self.lcd.set_window(w.x..w.x + w.width, w.y..w.y + w.height);
///         Ok(())
///     }
///     fn start(&mut self, buf: Self::Buf, len: usize) -> Result<(), (ErrorKind, Self::Buf)> {
///         let Some(channel) = self.idle.take() else { return Err((ErrorKind::Sequence, buf)) };
///         self.running = Some(hal::Transfer::start(channel, buf, len));
///         Ok(())
///     }
///     fn poll(&mut self) -> Poll<Result<Option<Self::Buf>, ErrorKind>> {
///         let Some(transfer) = self.running.take() else { return Poll::Ready(Ok(None)) };
///         if !transfer.is_done() {
///             self.running = Some(transfer);
///             return Poll::Pending;
///         }
///         let (channel, buf) = transfer.wait();
///         self.idle = Some(channel);
///         Poll::Ready(Ok(Some(buf)))
///     }
///     fn end(&mut self) -> Result<(), ErrorKind> {
///         self.lcd.wait_idle(); // the DMA is done, the last words may still be in the bus
///         Ok(())
///     }
/// }
/// # let line: &'static mut [u16] = Box::leak(vec![7; 4].into());
/// # let mut sink = Sink { lcd: hal::Lcd, idle: Some(hal::Channel), running: None };
/// # sink.begin(Window { x: 0, y: 0, width: 4, height: 1 }).unwrap();
/// # sink.start(line, 4).unwrap();
/// # assert!(matches!(sink.poll(), Poll::Ready(Ok(Some(_)))));
/// # assert!(matches!(sink.poll(), Poll::Ready(Ok(None))));
/// # sink.end().unwrap();
/// ```
///
/// A HAL that can only send whole buffers refuses another `len` with [`ErrorKind::Length`], and is given buffers of
/// exactly one band and windows whose height is a multiple of it.
pub trait ScanoutDma {
    /// What can go wrong.
    type Error: Error;
    /// The buffer that travels.
    type Buf: LineBuf;

    /// Opens a rectangle and waits until the display is ready for its first pixel.
    ///
    /// Called when no transfer runs. A rectangle that is still open is abandoned. After an `Err` none is open.
    fn begin(&mut self, window: Window) -> Result<(), Self::Error>;

    /// Starts to send the first `len` words of `buf`, which are the next whole lines of the rectangle.
    ///
    /// `len` is a multiple of the rectangle's width, at least one line and at most what the buffer holds. When the sink
    /// refuses, nothing is sent; when it fails midway, some of the lines may have been. Either way the buffer comes
    /// back with the error. A sink that does not [chain](Self::chains) is only started when `poll` has given the
    /// last buffer back.
    fn start(&mut self, buf: Self::Buf, len: usize) -> Result<(), (Self::Error, Self::Buf)>;

    /// Asks, without waiting, for the oldest buffer that is finished.
    ///
    /// - `Pending`: a transfer runs.
    /// - `Ready(Ok(Some(buf)))`: once for each started buffer, in the order of the starts.
    /// - `Ready(Ok(None))`: the sink is idle and holds no buffer.
    /// - `Ready(Err(_))`: the oldest transfer failed, which is said once. Its buffer, and those chained behind it,
    ///   whose transfers may be cancelled, come back from the next calls as `Ready(Ok(Some(buf)))`.
    fn poll(&mut self) -> Poll<Result<Option<Self::Buf>, Self::Error>>;

    /// Closes the rectangle, after every buffer is back, and waits until the bus is idle, not only the DMA.
    ///
    /// Closes it even when it returns an `Err`, for example of [`ErrorKind::Sequence`] when lines are missing.
    /// Without an open rectangle this does nothing.
    fn end(&mut self) -> Result<(), Self::Error>;

    /// Whether `start` may be called while a transfer runs. The sink then queues at least two buffers.
    fn chains(&self) -> bool {
        false
    }
}

impl<T: ScanoutDma + ?Sized> ScanoutDma for &mut T {
    type Error = T::Error;
    type Buf = T::Buf;

    fn begin(&mut self, window: Window) -> Result<(), Self::Error> {
        T::begin(self, window)
    }

    fn start(&mut self, buf: Self::Buf, len: usize) -> Result<(), (Self::Error, Self::Buf)> {
        T::start(self, buf, len)
    }

    fn poll(&mut self) -> Poll<Result<Option<Self::Buf>, Self::Error>> {
        T::poll(self)
    }

    fn end(&mut self) -> Result<(), Self::Error> {
        T::end(self)
    }

    fn chains(&self) -> bool {
        T::chains(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Refuses all that it is asked for.
    struct Refuses;

    impl ScanoutDma for Refuses {
        type Error = ErrorKind;
        type Buf = &'static mut [u16];

        fn begin(&mut self, _: Window) -> Result<(), ErrorKind> {
            Err(ErrorKind::Sequence)
        }

        fn start(&mut self, buf: Self::Buf, _: usize) -> Result<(), (ErrorKind, Self::Buf)> {
            Err((ErrorKind::Length, buf))
        }

        fn poll(&mut self) -> Poll<Result<Option<Self::Buf>, ErrorKind>> {
            Poll::Ready(Err(ErrorKind::Bus))
        }

        fn end(&mut self) -> Result<(), ErrorKind> {
            Err(ErrorKind::Other)
        }

        fn chains(&self) -> bool {
            true
        }
    }

    /// What a borrowed sink says. Kills: an answer that is not the sink's.
    fn said<D: ScanoutDma<Error = ErrorKind, Buf = &'static mut [u16]>>(mut sink: D) {
        let window = Window {
            x: 0,
            y: 0,
            width: 1,
            height: 1,
        };
        assert_eq!(sink.begin(window), Err(ErrorKind::Sequence));
        let started = sink.start(&mut [], 0).map_err(|(error, _)| error);
        assert_eq!(started, Err(ErrorKind::Length));
        assert!(matches!(sink.poll(), Poll::Ready(Err(ErrorKind::Bus))));
        assert_eq!(sink.end(), Err(ErrorKind::Other));
        assert!(sink.chains());
    }

    #[test]
    fn a_borrowed_sink_is_the_sink() {
        said(&mut Refuses);
    }
}
