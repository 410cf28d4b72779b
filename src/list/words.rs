//! Where a list lies: a slice in flash or RAM, or a ring that is written while it is read (H12).
//!
//! The ring's words are atomics with relaxed order and its write pointer is released, so that one
//! producer and one consumer, on two cores or in an interrupt, need no lock and no `unsafe`. The
//! producer publishes whole blocks, the consumer frees whole blocks, and what does not fit is
//! handed back: STALL (K17).

use super::error::{ListError, Reason};
use core::sync::atomic::{AtomicU32, Ordering};

/// The words of a list. Positions count words; those of a ring go on modulo 2^32.
pub trait Words<'w>: Copy {
    /// The first word that is still there.
    fn first(self) -> u32;

    /// The position after the last word that is there.
    fn end(self) -> u32;

    /// The word at `at`; 0 where there is none.
    fn word(self, at: u32) -> u32;

    /// `count` words in one piece, where they lie so.
    fn slice(self, at: u32, count: u32) -> Option<&'w [u32]>;

    /// The words of a ring; `None` for a list that does not grow.
    fn room(self) -> Option<u32>;
}

impl<'w> Words<'w> for &'w [u32] {
    #[inline(always)]
    fn first(self) -> u32 {
        0
    }

    #[inline(always)]
    fn end(self) -> u32 {
        // A list of 2^30 words has 2^32 bytes: what is beyond has no offset.
        self.len().min(1 << 30) as u32
    }

    #[inline(always)]
    fn word(self, at: u32) -> u32 {
        self.get(at as usize).map_or(0, |w| u32::from_le(*w))
    }

    #[inline(always)]
    fn slice(self, at: u32, count: u32) -> Option<&'w [u32]> {
        let at = at as usize;
        self.get(at..at.checked_add(count as usize)?)
    }

    #[inline(always)]
    fn room(self) -> Option<u32> {
        None
    }
}

/// A list of bytes, in place: they must be whole words and lie at a multiple of 4.
///
/// # Errors
/// [`Reason::Alignment`]; a copy into a `[u32]` mends it.
pub fn words_of(bytes: &[u8]) -> Result<&[u32], ListError> {
    bytemuck::try_cast_slice(bytes).map_err(|_| ListError::at(0, None, Reason::Alignment))
}

/// The bytes of a file, at a multiple of 4, in flash: for [`words_of`](crate::list::words_of).
///
/// ```ignore
/// let list = words_of(include_list!("teapot.list"))?;
/// ```
/// A build script that bakes or copies lists puts them into `OUT_DIR`, and
/// `concat!(env!("OUT_DIR"), "/teapot.list")` names them; `examples/scenes` shows it.
#[macro_export]
macro_rules! include_list {
    ($file:expr) => {{
        #[repr(C, align(4))]
        struct Aligned<B: ?Sized>(B);
        static LIST: &Aligned<[u8]> = &Aligned(*include_bytes!($file));
        let bytes: &'static [u8] = &LIST.0;
        bytes
    }};
}

/// A ring of words.
#[derive(Debug)]
pub struct ListRing<'m> {
    words: &'m [AtomicU32],
    /// Words that were ever written, modulo 2^32.
    written: AtomicU32,
    /// Words that were ever freed, modulo 2^32.
    freed: AtomicU32,
}

impl<'m> ListRing<'m> {
    /// An empty ring in `memory`, of which the largest power of two is used, at most 2^30 words.
    #[must_use]
    pub fn new(memory: &'m mut [AtomicU32]) -> Self {
        let log = memory.len().checked_ilog2();
        let len = log.map_or(0, |log| 1 << log.min(30));
        let words: &'m [AtomicU32] = memory;
        Self {
            words: &words[..len],
            written: AtomicU32::new(0),
            freed: AtomicU32::new(0),
        }
    }

    /// The end for the producer and the one for the consumer.
    pub fn split(&mut self) -> (RingWriter<'_>, RingReader<'_>) {
        let ring: &ListRing<'_> = self;
        (RingWriter { ring }, RingReader { ring })
    }

    #[inline(always)]
    fn cell(&self, at: u32) -> Option<&AtomicU32> {
        self.words
            .get(at as usize & self.words.len().wrapping_sub(1))
    }
}

/// Blocks that found no room: write them again later.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct RingFull {
    /// Words that were to be written.
    pub need: u32,
    /// Words that are free.
    pub free: u32,
}

/// The producer's end of a [`ListRing`].
#[derive(Debug)]
pub struct RingWriter<'r> {
    ring: &'r ListRing<'r>,
}

impl RingWriter<'_> {
    /// Free words.
    #[must_use]
    pub fn free(&self) -> u32 {
        let written = self.ring.written.load(Ordering::Relaxed);
        let used = written.wrapping_sub(self.ring.freed.load(Ordering::Acquire));
        self.ring.words.len() as u32 - used
    }

    /// Appends whole blocks; they can be read at once, all together.
    ///
    /// # Errors
    /// When there is too little room; then nothing was written.
    pub fn append(&mut self, blocks: &[u32]) -> Result<(), RingFull> {
        let free = self.free();
        let need = u32::try_from(blocks.len()).unwrap_or(u32::MAX);
        if need > free {
            return Err(RingFull { need, free });
        }
        let mut at = self.ring.written.load(Ordering::Relaxed);
        for word in blocks {
            if let Some(cell) = self.ring.cell(at) {
                cell.store(*word, Ordering::Relaxed);
            }
            at = at.wrapping_add(1);
        }
        self.ring.written.store(at, Ordering::Release);
        Ok(())
    }
}

/// The consumer's end of a [`ListRing`].
#[derive(Debug)]
pub struct RingReader<'r> {
    ring: &'r ListRing<'r>,
}

impl<'r> RingReader<'r> {
    /// What is there now, and what comes while it is read.
    #[must_use]
    pub fn words(&self) -> RingWords<'r> {
        RingWords { ring: self.ring }
    }

    /// Gives the words before `position` back to the producer; a position that is not between
    /// the two pointers frees nothing.
    pub fn free_to(&mut self, position: u32) {
        let freed = self.ring.freed.load(Ordering::Relaxed);
        let written = self.ring.written.load(Ordering::Acquire);
        if position.wrapping_sub(freed) <= written.wrapping_sub(freed) {
            self.ring.freed.store(position, Ordering::Release);
        }
    }
}

/// The words of a ring, as [`Words`].
#[derive(Clone, Copy, Debug)]
pub struct RingWords<'r> {
    ring: &'r ListRing<'r>,
}

impl<'r> Words<'r> for RingWords<'r> {
    fn first(self) -> u32 {
        self.ring.freed.load(Ordering::Relaxed)
    }

    fn end(self) -> u32 {
        self.ring.written.load(Ordering::Acquire)
    }

    #[inline]
    fn word(self, at: u32) -> u32 {
        self.ring
            .cell(at)
            .map_or(0, |c| u32::from_le(c.load(Ordering::Relaxed)))
    }

    fn slice(self, _: u32, _: u32) -> Option<&'r [u32]> {
        None
    }

    fn room(self) -> Option<u32> {
        Some(self.ring.words.len() as u32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ring_hands_over_every_word_once() {
        let mut memory = [const { AtomicU32::new(0) }; 11];
        let mut ring = ListRing::new(&mut memory);
        let (mut writer, mut reader) = ring.split();
        assert_eq!(writer.free(), 8);
        let (mut next, mut read) = (0u32, 0u32);
        for round in 0..1000u32 {
            let want = 1 + round % 5;
            let block: std::vec::Vec<u32> = (next..next + want).map(u32::to_le).collect();
            match writer.append(&block) {
                Ok(()) => next += want,
                Err(full) => {
                    assert!(full.need > full.free);
                    let words = reader.words();
                    while read != words.end() {
                        assert_eq!(words.word(read), read);
                        read += 1;
                    }
                    reader.free_to(read);
                }
            }
        }
        assert!(next > 1000);
        let free = writer.free();
        reader.free_to(read + 9);
        assert_eq!(writer.free(), free, "beyond the write pointer");
    }

    #[test]
    fn a_slice_has_an_end() {
        let list: &[u32] = &[1u32.to_le(), 2u32.to_le()];
        assert_eq!((list.word(1), list.word(2), list.end()), (2, 0, 2));
        assert_eq!(list.slice(1, 2), None);
        assert!(list.slice(2, 0).is_some_and(<[u32]>::is_empty));
        let bytes: &[u8] = bytemuck::cast_slice(list);
        assert_eq!(words_of(bytes), Ok(list));
        let refused = Err(ListError {
            offset: 0,
            block: None,
            reason: Reason::Alignment,
        });
        assert_eq!([&bytes[..7], &bytes[1..5]].map(words_of), [refused; 2]);
        let empty = ListRing::new(&mut []);
        assert_eq!(RingWriter { ring: &empty }.free(), 0);
        assert_eq!(RingWords { ring: &empty }.word(3), 0);
    }
}
