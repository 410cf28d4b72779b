//! The coverage mask of a line: a bit a column (X3).
//!
//! Spans are inserted as they are found. That tells overlap before anything is compared, what nobody has
//! covered, and where the background is. The first column of a word is its top bit: a span within one
//! word, as 85 % of those of small triangles are, takes 13 instructions on a Cortex-M4.

use crate::num::{leading_zeros, rolled};
use core::hint::black_box;

/// Columns of one line, up to 1,024.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Mask([u32; 32]);

/// How much of a span a mask has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    None,
    Some,
    All,
}

/// The word that has `start .. end`, and its bits there; `None` where its last column or another word is touched. Rotations
/// need no masked shift count.
#[inline(always)]
fn one_word(start: u32, end: u32) -> Option<(usize, u32)> {
    const TOP: u32 = 0x8000_0000;
    ((start ^ end) >> 5 == 0).then(|| {
        let bits = TOP.rotate_right(start).wrapping_sub(TOP.rotate_right(end)) << 1;
        (word_of(start), bits)
    })
}

#[inline(always)]
fn word_of(column: u32) -> usize {
    (column >> 5) as usize & 31
}

/// Calls `f` with each word that `start .. end` touches, and its bits there; `end` is below 1,024.
#[inline(always)]
fn each_word(start: u32, end: u32, mut f: impl FnMut(usize, u32)) {
    let (first, last) = (word_of(start), word_of(end));
    let mut word = first;
    let mut bits = u32::MAX >> (start & 31);
    while word != last {
        rolled();
        f(word, bits);
        bits = u32::MAX;
        word = (word + 1) & 31;
    }
    f(word, bits & !(u32::MAX >> (end & 31)));
}

impl Mask {
    /// No column.
    pub(crate) const EMPTY: Self = Self([0; 32]);

    /// Empties the mask: 25 instructions on a Cortex-M4, where the library's loop takes 66.
    #[inline(never)]
    pub(crate) fn clear(&mut self) {
        // Unknown to the compiler, which would else call that loop.
        let zero = black_box(0);
        for words in self.0.chunks_exact_mut(8) {
            words.copy_from_slice(&[zero; 8]);
        }
    }

    /// Covers `start .. end`; not 0 where one of them was covered already.
    #[inline(always)]
    pub(crate) fn cover(&mut self, start: u32, end: u32) -> u32 {
        if let Some((i, bits)) = one_word(start, end) {
            let word = &mut self.0[i];
            let hit = *word & bits;
            *word |= bits;
            return hit;
        }
        self.cover_words(start, end)
    }

    #[inline(never)]
    fn cover_words(&mut self, start: u32, end: u32) -> u32 {
        let mut hit = 0;
        each_word(start, end, |word, bits| {
            hit |= self.0[word] & bits;
            self.0[word] |= bits;
        });
        hit
    }

    /// Covers `start .. end`, and in `over` those that were covered already; not 0 where one of them was.
    #[inline(always)]
    pub(crate) fn cover_over(&mut self, over: &mut Self, start: u32, end: u32) -> u32 {
        if let Some((i, bits)) = one_word(start, end) {
            let hit = self.0[i] & bits;
            self.0[i] |= bits;
            if hit != 0 {
                over.0[i] |= hit;
            }
            return hit;
        }
        self.cover_over_words(over, start, end)
    }

    #[inline(never)]
    fn cover_over_words(&mut self, over: &mut Self, start: u32, end: u32) -> u32 {
        let mut any = 0;
        each_word(start, end, |word, bits| {
            let hit = self.0[word] & bits;
            self.0[word] |= bits;
            over.0[word] |= hit;
            any |= hit;
        });
        any
    }

    /// Those of `start .. end` that the mask has, and no others: 43 instructions on a Cortex-M4, a third of what the
    /// library takes to copy a mask.
    ///
    /// The loop of `each_word`, written out: what a closure borrows would be made elsewhere, and copied.
    #[inline(never)]
    pub(crate) fn part(&self, start: u32, end: u32) -> Self {
        let mut part = Self([black_box(0); 32]);
        let (mut word, last) = (word_of(start), word_of(end));
        let mut bits = u32::MAX >> (start & 31);
        while word != last {
            rolled();
            part.0[word] = self.0[word] & bits;
            bits = u32::MAX;
            word = (word + 1) & 31;
        }
        part.0[word] = self.0[word] & bits & !(u32::MAX >> (end & 31));
        part
    }

    /// Whether the mask has any of `start .. end`.
    #[inline(always)]
    pub(crate) fn meets(&self, start: u32, end: u32) -> bool {
        if let Some((i, bits)) = one_word(start, end) {
            return self.0[i] & bits != 0;
        }
        self.meets_words(start, end)
    }

    #[inline(never)]
    fn meets_words(&self, start: u32, end: u32) -> bool {
        let mut any = 0;
        each_word(start, end, |word, bits| any |= self.0[word] & bits);
        any != 0
    }

    /// How much of `start .. end` was covered; all of it is now. Where it was some, `new` gets each column
    /// that was not.
    #[inline(always)]
    pub(crate) fn cover_part(&mut self, start: u32, end: u32, new: impl FnMut(usize)) -> Part {
        let part = self.cover_new(start, end);
        if part == Part::Some {
            self.cover_rest(start, end, new);
        }
        part
    }

    /// Covers what is not covered of `start .. end`; `new` gets each column of it.
    #[inline(never)]
    fn cover_rest(&mut self, start: u32, end: u32, mut new: impl FnMut(usize)) {
        each_word(start, end, |word, bits| {
            let mut fresh = bits & !self.0[word];
            while fresh != 0 {
                rolled();
                let first = leading_zeros(fresh);
                fresh &= !(0x8000_0000 >> (first & 31));
                new(word * 32 + first as usize);
            }
            self.0[word] |= bits;
        });
    }

    /// How much of `start .. end` was covered; where none was, all of it is now.
    #[inline(always)]
    pub(crate) fn cover_new(&mut self, start: u32, end: u32) -> Part {
        if let Some((i, bits)) = one_word(start, end) {
            let word = &mut self.0[i];
            let old = *word & bits;
            if old == 0 {
                *word |= bits;
                return Part::None;
            }
            return if old == bits { Part::All } else { Part::Some };
        }
        self.cover_new_words(start, end)
    }

    /// The same of more words than one; most often of two.
    #[inline(never)]
    fn cover_new_words(&mut self, start: u32, end: u32) -> Part {
        let (first, last) = (word_of(start), word_of(end));
        if last == first + 1 {
            let (left, right) = (u32::MAX >> (start & 31), !(u32::MAX >> (end & 31)));
            let there = [self.0[first] & left, self.0[last] & right];
            if there[0] | there[1] == 0 {
                self.0[first] |= left;
                self.0[last] |= right;
                return Part::None;
            }
            let all = there == [left, right];
            return if all { Part::All } else { Part::Some };
        }
        let (mut any, mut lack) = (0, 0);
        each_word(start, end, |word, bits| {
            any |= self.0[word] & bits;
            lack |= bits & !self.0[word];
        });
        match (any, lack) {
            (0, _) => {
                each_word(start, end, |word, bits| self.0[word] |= bits);
                Part::None
            }
            (_, 0) => Part::All,
            _ => Part::Some,
        }
    }

    /// Whether the mask has all of `start .. end`.
    #[inline(never)]
    pub(crate) fn has_all(&self, start: u32, end: u32) -> bool {
        let mut lack = 0;
        each_word(start, end, |word, bits| lack |= bits & !self.0[word]);
        lack == 0
    }

    /// Whether the mask has the first `width` columns, of 32 and more: told soon where it lacks one of these.
    #[inline(always)]
    pub(crate) fn is_full(&self, width: u32) -> bool {
        self.0[0] == u32::MAX && self.has_all(0, width)
    }

    /// How many of `start .. end` the mask has.
    pub(crate) fn count(&self, start: u32, end: u32) -> u32 {
        let mut count = 0;
        each_word(start, end, |word, bits| {
            count += (bits & self.0[word]).count_ones();
        });
        count
    }

    /// Calls `run` with each run of the first `width` columns that is not covered, from left to right; then the
    /// mask is empty.
    #[inline(always)]
    pub(crate) fn take_free(&mut self, width: u32, mut run: impl FnMut(u32, u32)) {
        const COVERED: u32 = u32::MAX;
        // Where the run that is open began, if one is.
        let mut from = COVERED;
        // A word whose columns are all like the one before them.
        let mut like = u32::MAX;
        let mut base = 0;
        let words = width.div_ceil(32) as usize;
        for word in self.0.get_mut(..words).unwrap_or_default() {
            let bits = core::mem::take(word);
            if bits != like {
                // Columns that differ from the one before them.
                let mut ends = bits ^ (bits >> 1 | like << 31);
                like = (bits & 1).wrapping_neg();
                while ends != 0 {
                    let first = leading_zeros(ends);
                    ends &= !(0x8000_0000 >> (first & 31));
                    let column = (base + first).min(width);
                    if from == COVERED {
                        from = column;
                    } else {
                        if from < column {
                            run(from, column);
                        }
                        from = COVERED;
                    }
                }
            }
            base += 32;
        }
        if from < width {
            run(from, width);
        }
    }

    /// Calls `run` with each run of the first `width` columns that is covered, likewise.
    pub(crate) fn take_covered(&mut self, width: u32, run: impl FnMut(u32, u32)) {
        for word in &mut self.0 {
            *word = !*word;
        }
        self.take_free(width, run);
        self.clear();
    }

    /// Covers the first run of `start .. end` that is not covered: its first column, and that after its last in the lower
    /// half. 0 where there is none. `end` is below 1,024.
    #[inline(never)]
    pub(crate) fn take_run(&mut self, start: u32, end: u32) -> u32 {
        let last = word_of(end);
        let mut at = word_of(start);
        let mut bits = u32::MAX >> (start & 31);
        let mut free = bits & !self.0[at];
        while free == 0 && at < last {
            rolled();
            at += 1;
            free = !self.0[at];
        }
        let first = at as u32 * 32 + leading_zeros(free);
        if first >= end {
            return 0;
        }
        bits = u32::MAX >> (first & 31);
        let mut taken = bits & self.0[at];
        while taken == 0 && at < last {
            rolled();
            self.0[at] |= bits;
            bits = u32::MAX;
            at += 1;
            taken = self.0[at];
        }
        let after = (at as u32 * 32 + leading_zeros(taken)).min(end);
        self.0[at] |= bits & !(u32::MAX >> (after & 31));
        first << 16 | after
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::random::Rng;
    use std::vec::Vec;

    #[test]
    fn masks_do_what_columns_one_by_one_do() {
        let mut rng = Rng(3);
        for round in 0..20_000 {
            let mut plain = [false; 1023];
            let (mut mask, mut over, mut part, mut free) =
                (Mask::EMPTY, Mask::EMPTY, Mask::EMPTY, Mask::EMPTY);
            let mut whole = Mask::EMPTY;
            for _ in 0..1 + round % 12 {
                let size = [8, 40, 1022][round % 3];
                let start = rng.below(1022);
                let end = (start + 1 + rng.below(size)).min(1023);
                let columns = start as usize..end as usize;
                let old: Vec<usize> = columns.clone().filter(|&c| !plain[c]).collect();
                let hits = columns.len() - old.len();
                assert_eq!(mask.meets(start, end), hits > 0);
                let mut other = mask;
                assert_eq!(mask.has_all(start, end), old.is_empty());
                let full = plain.iter().position(|&taken| !taken).unwrap_or(1023);
                for width in [32, full, full + 1].map(|width| width.clamp(32, 1023)) {
                    assert_eq!(mask.is_full(width as u32), full >= width);
                }
                assert_eq!(mask.count(start, end) as usize, hits);
                assert_eq!(other.cover(start, end) != 0, hits > 0);
                let mut twice = Mask::EMPTY;
                assert_eq!({ mask }.cover_over(&mut twice, start, end) != 0, hits > 0);
                assert_eq!(twice.count(0, 1023) as usize, hits);
                assert_eq!(mask.cover_over(&mut over, start, end) != 0, hits > 0);
                assert_eq!(mask, other);
                let mut new = Vec::new();
                let how = part.cover_part(start, end, |c| new.push(c));
                let want = match (hits, old.len()) {
                    (0, _) => Part::None,
                    (_, 0) => Part::All,
                    _ => Part::Some,
                };
                assert_eq!(how, want);
                if how == Part::Some {
                    assert_eq!(new, old);
                }
                assert_eq!(part, mask);
                let was = whole;
                assert_eq!(whole.cover_new(start, end), want);
                let is_new = want == Part::None;
                assert_eq!(whole, if is_new { mask } else { was });
                whole = mask;
                let mut runs = Vec::new();
                let mut at = start;
                while at < end {
                    let run = free.take_run(at, end);
                    if run == 0 {
                        break;
                    }
                    let (a, b) = (run >> 16, run & 0xFFFF);
                    assert!(a < b && runs.last().is_none_or(|&(_, end)| end < a));
                    runs.push((a, b));
                    at = b;
                }
                let taken: Vec<usize> = runs
                    .iter()
                    .flat_map(|&(a, b)| a as usize..b as usize)
                    .collect();
                assert_eq!(taken, old);
                assert_eq!(free, mask);
                plain[columns].fill(true);
            }
            for (c, covered) in plain.iter().enumerate() {
                assert_eq!(mask.meets(c as u32, c as u32 + 1), *covered);
            }
            let width = [320, 1016, 1 + rng.below(1016)][round % 3];
            let mut open = Vec::new();
            let mut last = None;
            mask.take_free(width, |a, b| {
                assert!(a < b && last.is_none_or(|end| end < a), "{a} {b}");
                last = Some(b);
                open.extend(a as usize..b as usize);
            });
            let want: Vec<usize> = (0..width as usize).filter(|&c| !plain[c]).collect();
            assert_eq!(open, want);
            part.take_free(1023, |_, _| {});
            assert_eq!(part, Mask::EMPTY);
            over.clear();
            assert_eq!(over, Mask::EMPTY);
            if width > 992 {
                assert_eq!(mask, Mask::EMPTY);
            }
        }
    }
}
