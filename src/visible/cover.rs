//! Which pixels of a line are covered: a bit each, for drawing from front to back (X3).
//!
//! The bits are kept in the first cells of the depth line, which has no depths then: 10 of 320.

use super::{DepthCell, LineDepth, Visible};
use core::marker::PhantomData;

/// How much of a span was covered before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Covered {
    /// Nothing: all of it is seen.
    Nothing,
    /// Some pixels.
    Some,
    /// All: it is hidden.
    All,
}

/// The bits of a line.
pub struct Cover<'c, D: LineDepth> {
    words: &'c mut [D::Cell],
    /// Pixels that are not covered.
    free: usize,
    depth: PhantomData<D>,
}

/// The bits of word `index` that belong to the pixels from `start` to before `end`.
#[inline(always)]
const fn bits(index: usize, start: usize, end: usize) -> u32 {
    let first = 32 * index;
    let low = if start > first {
        u32::MAX << (start - first)
    } else {
        u32::MAX
    };
    let high = if end < first + 32 {
        (1 << (end - first)) - 1
    } else {
        u32::MAX
    };
    low & high
}

impl<'c, D: LineDepth> Cover<'c, D> {
    /// How many cells the bits of `width` pixels take.
    pub const fn cells(width: usize) -> usize {
        width.div_ceil(32)
    }

    /// A line of `width` pixels, none of which is covered. The cells are at their farthest, and
    /// as many as [`cells`](Cover::cells) says.
    pub fn new(words: &'c mut [D::Cell], width: usize) -> Self {
        Self {
            words,
            free: width,
            depth: PhantomData,
        }
    }

    /// Whether every pixel is covered.
    pub fn is_full(&self) -> bool {
        self.free == 0
    }

    /// How much is covered of the pixels from `start` to before `end`, which is above it. Where
    /// it is nothing, all of them are covered from now on.
    #[inline]
    pub fn look(&mut self, start: usize, end: usize) -> Covered {
        let (mut covered, mut free) = (0, 0);
        let words = start / 32..end.div_ceil(32);
        for index in words.clone() {
            let Some(word) = self.words.get(index) else {
                return Covered::All;
            };
            let (word, bits) = (word.number(), bits(index, start, end));
            covered |= word & bits;
            free |= !word & bits;
        }
        if covered != 0 {
            return if free == 0 {
                Covered::All
            } else {
                Covered::Some
            };
        }
        for index in words {
            if let Some(cell) = self.words.get_mut(index) {
                cell.set_number(cell.number() | bits(index, start, end));
            }
        }
        self.free -= end - start;
        Covered::Nothing
    }

    /// The pixels from `start` on, one after the other; those that are not covered are seen, and
    /// are covered from then on.
    pub fn masked(&mut self, start: usize) -> Masked<'_, 'c, D> {
        Masked {
            cover: self,
            at: start,
            seen: 0,
        }
    }

    /// Puts the cells back to their farthest.
    pub fn wipe(self) {
        for cell in self.words {
            *cell = D::FARTHEST;
        }
    }
}

/// Pixels of which some are covered.
pub struct Masked<'a, 'c, D: LineDepth> {
    cover: &'a mut Cover<'c, D>,
    at: usize,
    seen: u32,
}

impl<D: LineDepth> Masked<'_, '_, D> {
    /// How many pixels were seen.
    pub fn seen(&self) -> u32 {
        self.seen
    }

    /// Whether the next pixel is seen.
    #[inline(always)]
    pub fn next(&mut self) -> bool {
        let bit = 1 << (self.at % 32);
        let mut shown = false;
        if let Some(cell) = self.cover.words.get_mut(self.at / 32) {
            let word = cell.number();
            shown = word & bit == 0;
            cell.set_number(word | bit);
        }
        self.seen += u32::from(shown);
        self.cover.free -= usize::from(shown);
        self.at += 1;
        shown
    }
}

impl<D: LineDepth> Visible for Masked<'_, '_, D> {
    #[inline(always)]
    fn each<W>(&mut self, pixels: &mut [W], mut each: impl FnMut(&mut W, bool)) {
        for pixel in pixels {
            each(pixel, self.next());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Depth32;
    use super::*;
    use std::vec;

    #[test]
    fn bits_are_those_of_a_line_of_flags() {
        let mut seed = 9u32;
        let mut below = |n: usize| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as usize % n
        };
        let mut full = 0;
        for _ in 0..2000 {
            let width = 1 + below(200);
            let mut cells = vec![0; Cover::<Depth32>::cells(width)];
            let mut cover = Cover::<Depth32>::new(&mut cells, width);
            let mut flags = vec![false; width];
            for _ in 0..12 {
                let start = below(width);
                let end = start + 1 + below(width - start);
                let span = &mut flags[start..end];
                let expected = match span.iter().filter(|f| **f).count() {
                    0 => Covered::Nothing,
                    n if n == span.len() => Covered::All,
                    _ => Covered::Some,
                };
                assert_eq!(cover.look(start, end), expected);
                if expected == Covered::Some {
                    let mut masked = cover.masked(start);
                    let mut seen = 0;
                    masked.each(span, |flag, shown| {
                        assert_eq!(shown, !*flag);
                        seen += u32::from(shown);
                    });
                    assert_eq!(masked.seen(), seen);
                }
                span.fill(true);
                let free = flags.iter().filter(|f| !**f).count();
                assert_eq!((cover.free, cover.is_full()), (free, free == 0));
                full += usize::from(free == 0);
            }
            cover.wipe();
            assert!(cells.iter().all(|cell| *cell == 0));
        }
        assert!(full > 1000);
    }
}
