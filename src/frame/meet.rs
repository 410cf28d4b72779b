//! Where spans meet.

use super::guests::Walk;
use super::renderer::Renderer;
use super::spans::{Line, Span, columns_of};
use crate::look::Look;
use crate::num::take_first;

impl<L: Look, const WORDS: usize> Renderer<'_, L, WORDS> {
    /// The columns of all spans, with a slot or without; whether two meet. Those without a slot that are compared count as
    /// if they met.
    pub(super) fn find_all(
        &mut self,
        out: &Line<'_, '_, L>,
        compares: impl Fn(u16) -> bool,
    ) -> bool {
        let mut met = false;
        if self.cache.spilled.is_some() {
            let mut walk = Walk::of(self.cache.spilled);
            while let Some(stray) = self.next_stray(&mut walk, out) {
                let Span { start, end } = stray.span;
                self.counts.misses += 1;
                met |= self.covered.cover_over(&mut self.over, start, end);
                if compares(stray.object) {
                    self.over.cover(start, end);
                }
            }
        }
        for word in 0..WORDS {
            let (slots, spans) = (&self.cache.slots[word], &mut self.cache.spans[word]);
            let mut used = self.cache.used[word];
            while used != 0 {
                let i = take_first(&mut used) as usize & 31;
                let Span { start, end } = columns_of::<L>(&slots[i], out);
                spans[i] = start << 16 | end;
                if start < end {
                    met |= self.covered.cover_over(&mut self.over, start, end);
                }
            }
        }
        met
    }
}
