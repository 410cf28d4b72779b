//! A line buffer that a DMA of bytes reads: as many bytes as its sink says.

use crate::{LINES, WIDTH};
use embedded_dma::ReadBuffer;
use scanbeam::scan_out::LineBuf;

/// Lines of pixels, lent for ever, and how many bytes of them a transfer takes.
pub struct Line {
    words: &'static mut [u16],
    /// At most two for each word.
    bytes: usize,
}

impl Line {
    /// Over words lent for ever.
    #[must_use]
    pub fn new(words: &'static mut [u16]) -> Self {
        Self { words, bytes: 0 }
    }

    /// The next transfer takes `words` words, or all when there are fewer.
    pub fn set_len(&mut self, words: usize) {
        self.bytes = 2 * words.min(self.words.len());
    }
}

/// Two buffers of as many lines as a transfer takes.
///
/// # Panics
/// The second time.
#[must_use]
pub fn lines() -> [Line; 2] {
    let room = crate::lend!(u16, 2 * LINES * WIDTH, 0);
    let (first, second) = room.split_at_mut(LINES * WIDTH);
    [Line::new(first), Line::new(second)]
}

impl LineBuf for Line {
    type Word = u16;

    fn pixels(&mut self) -> &mut [u16] {
        self.words
    }
}

// SAFETY: the words stay where they are for ever, however the `Line` is moved, `bytes` are within
// them, and whoever owns the `Line` is alone in writing them.
unsafe impl ReadBuffer for Line {
    type Word = u8;

    unsafe fn read_buffer(&self) -> (*const u8, usize) {
        (self.words.as_ptr().cast(), self.bytes)
    }
}
