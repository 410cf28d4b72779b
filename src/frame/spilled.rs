//! What has no slot, on lines with values (C5, H15).
//!
//! Such a line walks over the chain several times: to find columns, to draw, for each light, and for what is translucent.
//! The first time columns and draw calls are found, and those of the chain's first objects kept, in the words that have
//! slots' farthest depths on other lines. Of the others they are found again.

use super::guests::{Stray, Walk};
use super::renderer::{Renderer, View};
use super::spans::{Line, Span};
use crate::active::next;
use crate::link::Link;
use crate::look::Look;
use crate::scene::DrawState;

/// A place in the chain, and its number there.
#[derive(Clone, Copy)]
pub(super) struct Spilled {
    at: Link,
    number: u16,
}

impl Spilled {
    /// Whether it is not behind the last.
    #[inline(always)]
    pub(super) fn is_some(self) -> bool {
        self.at.is_some()
    }

    /// The object; `u32::MAX` behind the last.
    #[inline(always)]
    pub(super) fn object(self) -> u32 {
        if self.is_some() {
            self.at.object().into()
        } else {
            u32::MAX
        }
    }
}

/// What the walk has found: a place in the chain, and the state of its draw call.
#[derive(Clone, Copy)]
pub(super) struct Found<'v> {
    pub(super) at: Spilled,
    pub(super) state: &'v DrawState<'v>,
}

/// The columns of a span, and how many draw calls began up to its own: 0 where they are too many to be kept.
fn kept(Span { start, end }: Span, begun: usize) -> u32 {
    start << 21 | end << 10 | if begun < 1 << 10 { begun as u32 } else { 0 }
}

fn span_of(kept: u32) -> Span {
    Span::new(kept >> 21, kept >> 10 & 0x7FF)
}

impl<L: Look, const WORDS: usize> Renderer<'_, L, WORDS> {
    /// Adds the columns of all that has no slot, and keeps them; what is compared counts as if it met others.
    #[inline(never)]
    pub(super) fn keep_strays(&mut self, out: &Line<'_, '_, L>) {
        self.cache.far.as_flattened_mut().fill(0);
        let mut walk = Walk::of(self.cache.spilled);
        let mut before = None;
        while let Some(stray) = self.next_stray(&mut walk, out) {
            // What lies between them has no pixels here; what has ended has left the chain.
            let mut at = before.map_or_else(|| self.first_spilled(), |at| self.after(at));
            while at.object() < u32::from(stray.object) {
                at = self.after(at);
            }
            before = Some(at);
            self.add_stray(&stray);
            let Span { start, end } = stray.span;
            let begun = out.view.draws.begun(stray.object);
            let state = out.view.draws.states.get(begun.wrapping_sub(1));
            if out.deep && state.is_some_and(DrawState::compares) {
                self.over.cover(start, end);
            }
            let places = self.cache.far.as_flattened_mut();
            if let Some(place) = places.get_mut(usize::from(at.number)) {
                *place = kept(stray.span, begun);
            }
        }
    }

    /// The first of what has no slot.
    pub(super) fn first_spilled(&self) -> Spilled {
        Spilled {
            at: self.cache.spilled,
            number: 0,
        }
    }

    /// The next of it.
    #[inline(always)]
    pub(super) fn after(&self, Spilled { at, number }: Spilled) -> Spilled {
        Spilled {
            at: next(self.links, at),
            number: number.wrapping_add(1),
        }
    }

    /// The first from `at` on whose draw call is such, and that is not known to have no pixels on the line.
    #[inline(never)]
    pub(super) fn spilled_of<'v>(
        &self,
        mut at: Spilled,
        view: &View<'v>,
        is_such: &dyn Fn(&DrawState<'_>) -> bool,
    ) -> Option<Found<'v>> {
        while at.is_some() {
            let begun = self.begun(at, view);
            at = match view.draws.states.get(begun.wrapping_sub(1)) {
                Some(state) if is_such(state) => return Some(Found { at, state }),
                Some(_) => self.behind_call(at, begun, view),
                None => self.after(at),
            };
        }
        None
    }

    /// The first behind those of its draw call, up to which so many have begun.
    fn behind_call(&self, mut at: Spilled, begun: usize, view: &View<'_>) -> Spilled {
        let next = view.draws.states.get(begun);
        let end = next.map_or(u32::MAX, |next| next.first.into());
        loop {
            at = self.after(at);
            if at.object() >= end {
                return at;
            }
        }
    }

    #[inline(always)]
    fn kept(&self, spilled: Spilled) -> Option<u32> {
        let kept = self.cache.far.as_flattened();
        kept.get(usize::from(spilled.number)).copied()
    }

    /// How many draw calls began up to its own; 0 where it is known to have no pixels on the line.
    fn begun(&self, spilled: Spilled, view: &View<'_>) -> usize {
        match self.kept(spilled) {
            Some(0) => 0,
            Some(kept) if kept & 0x3FF != 0 => (kept & 0x3FF) as usize,
            _ => view.draws.begun(spilled.at.object()),
        }
    }

    /// Its triangle and columns; `None` where it has no pixels on the line.
    #[inline(never)]
    pub(super) fn spilled_stray<'v>(
        &self,
        spilled: Spilled,
        out: &Line<'_, 'v, L>,
    ) -> Option<Stray<'v>> {
        let object = spilled.at.object();
        let Some(kept) = self.kept(spilled) else {
            return Stray::of(object, out.view, out.number);
        };
        let span = span_of(kept);
        (span.start < span.end)
            .then(|| Stray::with(span, object, out.view))
            .flatten()
    }
}

#[cfg(test)]
mod tests {
    use super::{kept, span_of};
    use crate::frame::spans::Span;

    /// Kills: a field that lies in another, and a number that is too large and kept all the same.
    #[test]
    fn what_is_kept_comes_back() {
        for (start, end, begun) in [(0, 1, 1), (1023, 1024, 1023), (5, 1016, 1024), (7, 8, 0)] {
            let word = kept(Span { start, end }, begun);
            let span = span_of(word);
            assert_eq!((span.start, span.end), (start, end));
            assert_eq!(word & 0x3FF, if begun < 1024 { begun as u32 } else { 0 });
        }
    }
}
