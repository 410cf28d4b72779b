//! Lines with draw calls that have values few have (H9, H15, K11).
//!
//! Values are looked at once a span, and only where a call of the scene has any: other lines and other scenes know
//! nothing of them. A dither alone is none of these: its spans are sorted as others are, and what colours them asks
//! whether they are dithered. On such a line the background comes first. With depth, what is opaque is drawn in order of
//! submission, compared where spans meet or where values compare, then what has to do with shadows (see `shadow`), then
//! what is translucent (see `translucent`). Without depth all is drawn in order of submission.

use super::alone::{Alone, set_up_stray};
use super::guests::Stray;
use super::near::number_of;
use super::renderer::{Renderer, View};
use super::rival::{deepen, slope_of};
use super::ruled::{Ruled, draw_ruled};
use super::slot::{Flags, begun_of};
use super::spans::{Drawn, Known, Line, Span, colour, columns_of};
use super::spilled::Found;
use crate::active::next;
use crate::look::{Fill, Look, WordOf, fill_even};
use crate::num::{bit, take_first};
use crate::scene::DrawState;

impl<L: Look, const WORDS: usize> Renderer<'_, L, WORDS> {
    /// Draws a line over a background, if a draw call on it has values that few have.
    #[inline(never)]
    pub(super) fn draw_values(&mut self, out: &mut Line<'_, '_, L>, background: WordOf<L>) -> bool {
        if self.changed {
            self.mark_values(out.view);
        }
        if !out.view.ruled || !self.is_ruled(out) {
            return false;
        }
        fill_even::<L::Pixel>(out.pixels, background);
        if self.cache.spilled.is_some() {
            self.keep_strays(out);
        }
        self.find_slots(out);
        // Where this is so, `over` says where depth is compared.
        (self.met, self.lasting) = (out.deep, false);
        let mut waiting = [0; WORDS];
        if self.met {
            waiting = self.find_compared(out);
        } else if let Some(hide) = self.shadows {
            hide(self, out);
        }
        self.draw_in_order(waiting, out);
        if self.met {
            if let Some(draw) = self.shadows {
                draw(self, out);
            }
            self.draw_translucent(out);
        }
        self.covered.clear();
        self.over.clear();
        self.written.clear();
        self.met = false;
        true
    }

    /// Marks the slots whose draw calls have values, each once. Nobody asks where they are filled, which is nearly always
    /// in a scene without any.
    fn mark_values(&mut self, view: &View<'_>) {
        for word in 0..WORDS {
            let mut used = self.cache.used[word];
            while let Some(i) = take_first(&mut used) {
                let slot = &mut self.cache.slots[word][i as usize & 31];
                if begun_of(slot) != 0 || Flags::of(slot).has_values() {
                    continue;
                }
                let begun = u8::try_from(view.draws.begun(slot.object)).unwrap_or(0);
                slot.known |= u16::from(begun) << 8;
                let Some(state) = view.state_of(slot).filter(|state| state.has_values()) else {
                    continue;
                };
                let mut flags = Flags::of(slot).with_values();
                if state.dithers && flags.fill() == Fill::Plain {
                    let triangle = view.triangle_of(slot.object);
                    let finer =
                        triangle.and_then(|t| L::set_up_dithered(&t, &mut slot.item.planes));
                    flags = finer.map_or(flags, |fill| flags.with_fill(fill));
                }
                flags.keep(slot);
                self.cache.plain[word] &= !bit(i);
            }
        }
    }

    /// Takes the next slot of a word that has values and pixels on the line out of a set.
    #[inline(always)]
    pub(super) fn next_with_values(&self, word: usize, set: &mut u32) -> Option<u32> {
        while let Some(i) = take_first(set) {
            let flags = Flags::of(&self.cache.slots[word][i as usize & 31]);
            let span = Span::of(self.cache.spans[word][i as usize & 31]);
            if flags.has_values() && span.start < span.end {
                return Some(i);
            }
        }
        None
    }

    /// Whether a draw call with pixels on this line has values by which lines are drawn.
    fn is_ruled(&self, out: &Line<'_, '_, L>) -> bool {
        let rules = |state: Option<&DrawState<'_>>| state.is_some_and(DrawState::rules);
        for word in 0..WORDS {
            let mut others = self.cache.used[word] & !self.cache.plain[word];
            while let Some(i) = take_first(&mut others) {
                let slot = &self.cache.slots[word][i as usize & 31];
                if Flags::of(slot).has_values() && rules(out.view.state_of(slot)) {
                    let Span { start, end } = columns_of::<L>(slot, out);
                    if start < end {
                        return true;
                    }
                }
            }
        }
        let mut at = self.cache.spilled;
        while at.is_some() {
            let object = at.object();
            if rules(out.view.draws.state(object))
                && Stray::of(object, out.view, out.number).is_some()
            {
                return true;
            }
            at = next(self.links, at);
        }
        false
    }

    /// Adds the columns of spans in slots that compare to those where spans meet; a bit for each slot that waits.
    fn find_compared(&mut self, out: &Line<'_, '_, L>) -> [u32; WORDS] {
        let mut waiting = [0; WORDS];
        for (word, waiting) in waiting.iter_mut().enumerate() {
            let mut used = self.cache.used[word] & !self.cache.plain[word];
            while let Some(i) = self.next_with_values(word, &mut used) {
                let state = out.view.state_of(&self.cache.slots[word][i as usize & 31]);
                if let Some(state) = state.filter(|state| state.compares()) {
                    let span = Span::of(self.cache.spans[word][i as usize & 31]);
                    self.over.cover(span.start, span.end);
                    *waiting |= if state.waits() { bit(i) } else { 0 };
                }
            }
        }
        waiting
    }

    /// Draws the span of the slot of a key, if it has one.
    #[inline(never)]
    pub(super) fn draw_slot(&mut self, key: u32, out: &mut Line<'_, '_, L>) {
        let number = number_of::<WORDS>(key);
        let span = Span::of(self.cache.spans.as_flattened()[number]);
        let slot = &mut self.cache.slots.as_flattened_mut()[number];
        if span.start >= span.end {
            return;
        }
        let is_compared = self.met && self.over.meets(span.start, span.end);
        let has_values = Flags::of(slot).has_values();
        let state = has_values.then(|| out.view.state_of(slot)).flatten();
        let state = state.unwrap_or(&DrawState::EMPTY);
        if is_compared {
            deepen::<L>(slot, out.view);
        }
        let drawn = Drawn::of(slot);
        let ruled = Ruled { drawn, span, state };
        let known = is_compared.then(|| {
            let slope = slope_of::<L>(slot, span, out);
            Known::new(slope, self.depth, &mut self.written)
        });
        if let Some(counter) = &self.counter {
            let is_alone = !self.over.meets(span.start, span.end);
            (counter.span)(&mut self.spans, ruled, known.as_ref(), is_alone, out);
        }
        if !has_values && !is_compared {
            return colour::<L>(drawn, span, out);
        }
        draw_ruled::<L>(ruled, span, out, known);
    }

    /// Draws a span without a slot.
    #[inline(never)]
    pub(super) fn draw_alone(&mut self, found: Found<'_>, out: &mut Line<'_, '_, L>) {
        let state = found.state;
        let Some(stray) = self.spilled_stray(found.at, out) else {
            return;
        };
        let mut alone = Alone::empty(L::EMPTY);
        set_up_stray::<L>(&stray, &mut alone, &mut self.counts, out);
        let (drawn, span) = (alone.drawn(), stray.span);
        let ruled = Ruled { drawn, span, state };
        let is_compared = self.met && self.over.meets(span.start, span.end);
        let known =
            is_compared.then(|| Known::new(stray.slope::<L>(out), self.depth, &mut self.written));
        if let Some(counter) = &self.counter {
            let is_alone = !self.over.meets(span.start, span.end);
            (counter.span)(&mut self.spans, ruled, known.as_ref(), is_alone, out);
        }
        draw_ruled::<L>(ruled, span, out, known);
    }
}
