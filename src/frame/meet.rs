//! Where spans meet.

use super::guests::{Stray, Walk};
use super::renderer::Renderer;
use super::spans::{Line, Span, columns_of};
use crate::look::Look;
use crate::num::take_first;

impl<L: Look, const WORDS: usize> Renderer<'_, L, WORDS> {
    /// The columns of all spans, with a slot or without, and those in which two meet.
    #[inline(always)]
    pub(super) fn find_all(&mut self, out: &Line<'_, '_, L>) {
        if self.cache.spilled.is_some() {
            let mut walk = Walk::of(self.cache.spilled);
            while let Some(stray) = self.next_stray(&mut walk, out) {
                self.add_stray(&stray);
            }
        }
        self.find_slots(out);
    }

    /// Adds the columns of what has no slot.
    #[inline(always)]
    pub(super) fn add_stray(&mut self, stray: &Stray<'_>) {
        let Span { start, end } = stray.span;
        self.counts.misses += 1;
        self.covered.cover_over(&mut self.over, start, end);
    }

    /// The columns of all slots' spans.
    #[inline(never)]
    pub(super) fn find_slots(&mut self, out: &Line<'_, '_, L>) {
        for word in 0..WORDS {
            let (slots, spans) = (&self.cache.slots[word], &mut self.cache.spans[word]);
            let mut used = self.cache.used[word];
            while let Some(i) = take_first(&mut used) {
                let i = i as usize & 31;
                let Span { start, end } = columns_of::<L>(&slots[i], out);
                spans[i] = start << 16 | end;
                if start < end {
                    self.covered.cover_over(&mut self.over, start, end);
                }
            }
        }
    }
}
