//! A sink that is memory: two whole frames, one scanned by a display controller while the other is filled (SPEC S5).
//!
//! For LTDC, for VGA by a state machine, for whatever shows a picture that lies in RAM. Lines are copied into the
//! frame that is not shown, and the frames change places in a vertical blank and at no other time, so no picture
//! is ever torn. Who has room for one frame only has no need of this crate's line buffers; who has none feeds the
//! panel line by line, see [`feed_line`](super::feed_line).
//!
//! A frame that failed is never shown. A rectangle that is a part of the display first takes over the rest from the
//! frame that is shown: right, but it copies a frame, so lines and runs that stay are better sent than left out here.

use core::fmt::{self, Display};
use core::sync::atomic::{AtomicBool, Ordering};

use super::dma::{Error, ErrorKind, Window};
use super::writer::LineWriter;

/// What the sink and the interrupt of the vertical blank share. Loads and stores alone: it works on any core.
#[derive(Debug, Default)]
pub struct SwapFlag {
    /// Whether the second frame is the one to show next. Written by the sink.
    asked: AtomicBool,
    /// Whether the second frame is the one that is shown. Written by the interrupt.
    shown: AtomicBool,
}

impl SwapFlag {
    /// The first frame is shown.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            asked: AtomicBool::new(false),
            shown: AtomicBool::new(false),
        }
    }

    /// To be called in each vertical blank, by one interrupt: the frame to scan from now on, 0 or 1.
    pub fn vertical_blank(&self) -> usize {
        let asked = self.asked.load(Ordering::Acquire);
        self.shown.store(asked, Ordering::Release);
        asked.into()
    }

    /// Whether a frame is complete but not shown yet.
    pub fn is_pending(&self) -> bool {
        self.asked.load(Ordering::Acquire) != self.shown.load(Ordering::Acquire)
    }

    /// The frame that the display shows, 0 or 1.
    pub fn shown(&self) -> usize {
        self.shown.load(Ordering::Acquire).into()
    }

    /// Asks for the frame that is not shown.
    fn ask(&self) {
        let other = !self.shown.load(Ordering::Acquire);
        self.asked.store(other, Ordering::Release);
    }
}

/// Why a picture in memory could not be filled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum FrameBufferError {
    /// The picture takes more words than there are.
    Words {
        /// How many it takes.
        needed: usize,
        /// How many were lent.
        have: usize,
    },
    /// The rectangle is not in the picture.
    Window,
    /// No vertical blank came within the polls that were set.
    NoBlank,
}

impl Error for FrameBufferError {
    fn kind(&self) -> ErrorKind {
        match self {
            Self::Words { .. } | Self::Window => ErrorKind::Length,
            Self::NoBlank => ErrorKind::Timeout,
        }
    }
}

impl Display for FrameBufferError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Words { needed, have } => {
                write!(f, "the picture takes {needed} words, there are {have}")
            }
            Self::Window => f.write_str("the rectangle is not in the picture"),
            Self::NoBlank => f.write_str("no vertical blank came"),
        }
    }
}

impl core::error::Error for FrameBufferError {}

/// Two frames of `width` x `height` words, filled in turn, as a writer of lines. The buffers of the pump lie anywhere: they
/// are copied.
///
/// ```
/// use scanbeam::scan_out::{Blocking, FrameBuffer, Pump, SwapFlag, Window};
///
/// static SWAP: SwapFlag = SwapFlag::new(); // the interrupt calls SWAP.vertical_blank()
/// let (mut first, mut second) = ([0u16; 6], [0; 6]);
/// let frames = FrameBuffer::new([&mut first, &mut second], 3, 2, &SWAP);
/// # fn line() -> &'static mut [u16] { Box::leak(Box::new([0; 3])) }
/// let mut pump = Pump::new(Blocking::over(frames), [line(), line()]);
/// pump.begin(Window { x: 0, y: 0, width: 3, height: 2 }, 1)?;
/// for y in 1..=2 {
///     pump.line()?.fill(y);
///     pump.line_done()?;
/// }
/// pump.finish()?; // asks for the swap
/// assert_eq!(pump.sink().writer().shown(), [0; 6]);
/// assert_eq!(SWAP.vertical_blank(), 1);
/// assert_eq!(pump.sink().writer().shown(), [1, 1, 1, 2, 2, 2]);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct FrameBuffer<'f, W> {
    frames: [&'f mut [W]; 2],
    width: u16,
    height: u16,
    flag: &'f SwapFlag,
    max_polls: Option<u32>,
}

impl<'f, W: Copy + 'static> FrameBuffer<'f, W> {
    /// Two frames, each of `width * height` words or more, the lines one after the other. `flag` shows one of them.
    pub fn new(frames: [&'f mut [W]; 2], width: u16, height: u16, flag: &'f SwapFlag) -> Self {
        Self {
            frames,
            width,
            height,
            flag,
            max_polls: None,
        }
    }

    /// How often a rectangle asks for the swap of the last one before it gives up with
    /// [`NoBlank`](FrameBufferError::NoBlank); for ever when `None`, which is how it starts.
    #[must_use]
    pub fn with_max_polls(mut self, max_polls: Option<u32>) -> Self {
        self.max_polls = max_polls;
        self
    }

    /// The frame that the display shows.
    #[must_use]
    pub fn shown(&self) -> &[W] {
        self.frames[self.flag.shown()]
    }

    /// The frame that is shown and the one that is filled. Called when no swap is pending.
    fn front_and_back(&mut self) -> (&[W], &mut [W]) {
        let [first, second] = &mut self.frames;
        if self.flag.shown() == 0 {
            (first, second)
        } else {
            (second, first)
        }
    }
}

impl<W: Copy + 'static> LineWriter for FrameBuffer<'_, W> {
    type Error = FrameBufferError;
    type Word = W;

    /// Waits for the vertical blank that the last rectangle asked for: until then its frame is not free.
    fn open(&mut self, window: Window) -> Result<(), FrameBufferError> {
        let needed = usize::from(self.width) * usize::from(self.height);
        let have = self.frames[0].len().min(self.frames[1].len());
        if have < needed {
            return Err(FrameBufferError::Words { needed, have });
        }
        if !window.is_within(self.width, self.height) {
            return Err(FrameBufferError::Window);
        }
        let mut polls = 0_u32;
        while self.flag.is_pending() {
            if self.max_polls.is_some_and(|max| polls >= max) {
                return Err(FrameBufferError::NoBlank);
            }
            polls = polls.saturating_add(1);
            core::hint::spin_loop();
        }
        if window.width < self.width || window.height < self.height {
            let (front, back) = self.front_and_back();
            for (back, front) in back.iter_mut().zip(front).take(needed) {
                *back = *front;
            }
        }
        Ok(())
    }

    fn write(&mut self, lines: Window, words: &[W]) -> Result<(), FrameBufferError> {
        let stride = usize::from(self.width);
        let (_, back) = self.front_and_back();
        let rows = back
            .chunks_exact_mut(stride.max(1))
            .skip(usize::from(lines.y))
            .take(usize::from(lines.height));
        let width = usize::from(lines.width);
        for (row, line) in rows.zip(words.chunks_exact(width.max(1))) {
            row.get_mut(usize::from(lines.x)..)
                .and_then(|row| row.get_mut(..width))
                .ok_or(FrameBufferError::Window)?
                .copy_from_slice(line);
        }
        Ok(())
    }

    fn close(&mut self, whole: bool) -> Result<(), FrameBufferError> {
        if whole {
            self.flag.ask();
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::{thread, time::Duration};

    const ALL: Window = Window {
        x: 0,
        y: 0,
        width: 2,
        height: 1,
    };

    /// Kills: polls that end although none were said, or before as many as were said.
    #[test]
    fn a_rectangle_waits_for_the_swap_as_long_as_it_may() {
        let flag = SwapFlag::new();
        let (mut first, mut second) = ([0u16; 2], [0; 2]);
        let mut frames = FrameBuffer::new([&mut first, &mut second], 2, 1, &flag);
        for max_polls in [None, Some(u32::MAX)] {
            frames = frames.with_max_polls(max_polls);
            flag.ask();
            thread::scope(|scope| {
                scope.spawn(|| {
                    thread::sleep(Duration::from_millis(10));
                    flag.vertical_blank();
                });
                assert_eq!(frames.open(ALL), Ok(()));
            });
            assert!(!flag.is_pending());
        }
        flag.ask();
        let mut hasty = frames.with_max_polls(Some(3));
        assert_eq!(hasty.open(ALL), Err(FrameBufferError::NoBlank));
        flag.vertical_blank();
        assert_eq!(hasty.open(ALL), Ok(()));
    }
}
