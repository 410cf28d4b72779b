//! The two scanlines of a unit, and the DMA that empties one while the other fills (K12).

use super::token::StartDma;

/// A word of a scanline: 40 bits. Of the Z unit 32 bits of depth over 8 of shadow count, of the
/// compositing unit alpha, red, green and blue of 10 bits each.
pub type Word40 = u64;

/// The bits of a word.
pub(super) const WORD: Word40 = (1 << 40) - 1;

/// A DMA on its way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Running {
    /// The pixel that is next.
    next: usize,
    /// The pixel after the last.
    end: usize,
    set_up: StartDma,
}

/// What the DMA does in a clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Read {
    /// Pixel of the segment.
    pub(super) x: u16,
    pub(super) word: Word40,
    pub(super) round: bool,
}

/// Two scanlines of words: the stage works on the front one, the DMA on the back one.
#[derive(Debug)]
pub struct LineBuffers<'m> {
    front: &'m mut [Word40],
    back: &'m mut [Word40],
    write_register: Word40,
    running: Option<Running>,
}

impl<'m> LineBuffers<'m> {
    /// Two lines of memory. The shorter one says how many pixels there are; pixels beyond are
    /// not kept.
    #[must_use]
    pub fn new([front, back]: [&'m mut [Word40]; 2]) -> Self {
        let len = front.len().min(back.len());
        Self {
            front: &mut front[..len],
            back: &mut back[..len],
            write_register: 0,
            running: None,
        }
    }

    /// Pixels of a line.
    #[must_use]
    pub fn len(&self) -> usize {
        self.front.len()
    }

    /// Whether there is no room at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.front.is_empty()
    }

    /// The word of pixel `x` of the line that is being rendered.
    #[inline]
    pub(super) fn word(&mut self, x: u16) -> Option<&mut Word40> {
        self.front.get_mut(usize::from(x))
    }

    pub(super) fn load_write_register(&mut self, value: Word40) {
        self.write_register = value & WORD;
    }

    /// Whether a DMA is on its way.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.running.is_some()
    }

    /// Starts a DMA over the back buffer; the one before must be over.
    pub(super) fn start(&mut self, set_up: StartDma) {
        debug_assert!(!self.is_busy());
        let next = usize::from(set_up.start).min(self.len());
        let end = (next + usize::from(set_up.length)).min(self.len());
        self.running = (next < end).then_some(Running { next, end, set_up });
    }

    /// One clock: a word is read, and written over.
    #[inline]
    pub(super) fn clock(&mut self) -> Option<Read> {
        let running = self.running.as_mut()?;
        let (x, set_up) = (running.next, running.set_up);
        running.next += 1;
        if running.next == running.end {
            self.running = None;
        }
        let cell = self.back.get_mut(x)?;
        let word = *cell;
        if set_up.write_enable {
            *cell = self.write_register;
        }
        set_up.scanout_enable.then_some(Read {
            x: x as u16,
            word,
            round: set_up.round,
        })
    }

    /// Swaps the lines; no DMA must be on its way.
    pub(super) fn swap(&mut self) {
        debug_assert!(!self.is_busy());
        core::mem::swap(&mut self.front, &mut self.back);
    }
}
