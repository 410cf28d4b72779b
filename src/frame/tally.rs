//! Spans and pixels, counted (M4): what a renderer does that is [`counting`](Renderer::counting), and no other.
//!
//! A line without values is counted before it is drawn: who is seen is asked of any two spans that share columns, so
//! the figures do not hang on the order in which spans are drawn, nor on who has a slot. On a line with values each span
//! is counted as it comes, before it is drawn: its depths are compared with a copy of the cells.

use super::alone::{Alone, set_up_stray};
use super::guests::Stray;
use super::renderer::Renderer;
use super::rival::{Rival, deepen, rival_of, slope_of};
use super::ruled::{Ruled, ink_of};
use super::shadow::count_shadowed;
use super::slot::Flags;
use super::spans::{Drawn, Known, Line, Span};
use crate::active::{CacheUse, next};
use crate::look::{Look, WordOf};
use crate::num::take_first;
use crate::scene::DrawState;
use crate::stats::{SpanCounts, SpanPixels};
use crate::visible::{MOST_TESTED, Mask, test};

/// What counts, as functions: a program that names none of them does not have their code.
#[derive(Debug)]
pub(super) struct Counter<L: Look, const WORDS: usize> {
    /// A line without values, before it is drawn.
    pub(super) line: fn(&mut Renderer<'_, L, WORDS>, &Line<'_, '_, L>),
    /// A span of a line with values, before it is drawn.
    pub(super) span: CountSpan<L>,
    /// What is translucent on a line with values, of so many slots that are listed and of what has none, before the first
    /// is drawn.
    pub(super) panes: fn(&mut Renderer<'_, L, WORDS>, usize, &Line<'_, '_, L>),
    /// What has to do with shadows, before it is taken.
    pub(super) shadowed: CountShadowed<L>,
}

type PlanesOf<L> = <L as Look>::Planes;

/// The depth that the span is compared with, if it is, and whether it shares no column with another.
type CountSpan<L> =
    fn(&mut SpanCounts, Ruled<'_, PlanesOf<L>>, Option<&Known<'_>>, bool, &Line<'_, '_, L>);

/// The depth of the line, and its counts of volumes.
type CountShadowed<L> =
    fn(&mut SpanCounts, Ruled<'_, PlanesOf<L>>, &Known<'_>, &[u8], &Line<'_, '_, L>);

impl<L: Look, const WORDS: usize> Counter<L, WORDS> {
    pub(super) fn new() -> Self {
        Self {
            line: |renderer, out| renderer.count_line(out),
            span: count_span::<L>,
            panes: |renderer, slots, out| renderer.count_panes(slots, out),
            shadowed: count_shadowed::<L>,
        }
    }
}

/// Is given a span of a line without values, its object, and what says how it competes.
type OnSpan<'f> = dyn FnMut(Span, u16, &dyn Fn() -> Rival) + 'f;

impl<L: Look, const WORDS: usize> Renderer<'_, L, WORDS> {
    /// Calls `f` with each span of the line; nothing is kept of depths.
    fn each_span(&self, out: &Line<'_, '_, L>, f: &mut OnSpan<'_>) {
        for word in 0..WORDS {
            let mut used = self.cache.used[word];
            while let Some(i) = take_first(&mut used) {
                let slot = &self.cache.slots[word][i as usize & 31];
                let span = Span::of(self.cache.spans[word][i as usize & 31]);
                if span.start < span.end {
                    f(span, slot.object, &|| {
                        if !out.deep || Flags::of(slot).is_deep() {
                            return rival_of::<L>(slot, span, out);
                        }
                        let mut slot = *slot;
                        deepen::<L>(&mut slot, out.view);
                        rival_of::<L>(&slot, span, out)
                    });
                }
            }
        }
        let mut at = self.cache.spilled;
        while at.is_some() {
            if let Some(stray) = Stray::of(at.object(), out.view, out.number) {
                let rival = || stray.rival(stray.slope::<L>(out));
                f(stray.span, stray.object, &rival);
            }
            at = next(self.links, at);
        }
    }

    /// Counts the spans of a line without values.
    #[inline(never)]
    fn count_line(&mut self, out: &Line<'_, '_, L>) {
        // What it takes to find spans is not counted.
        let (counts, mut spans) = (self.counts, self.spans);
        self.find_all(out);
        self.counts = counts;
        self.each_span(out, &mut |Span { start, end }, object, rival| {
            let (all, meets) = (end - start, self.over.meets(start, end));
            let seen = if meets {
                self.seen_of(rival(), out)
            } else {
                all
            };
            let has_texels = has_texels::<L>(out.view.draws.state(object));
            let pixels = SpanPixels {
                all,
                seen,
                hidden: all - seen,
                tested: 0,
                fetched: seen * u32::from(has_texels),
            };
            spans.add_span(pixels, !meets);
        });
        self.spans = spans;
        self.covered.clear();
        self.over.clear();
    }

    /// How many pixels of a span no other is seen before.
    fn seen_of(&self, one: Rival, out: &Line<'_, '_, L>) -> u32 {
        let mut hidden = Mask::EMPTY;
        self.each_span(out, &mut |span, _, other| {
            if span.meets(one.span) {
                other().hide(&one, &mut hidden);
            }
        });
        let Span { start, end } = one.span;
        end - start - hidden.count(start, end)
    }

    /// Counts what is translucent on a line that is drawn by depth: all else is drawn, and none of it changes depths.
    #[inline(never)]
    fn count_panes(&mut self, slots: usize, out: &Line<'_, '_, L>) {
        let first = usize::from(self.nearest);
        for k in first..first + slots {
            let Some((slot, span)) = self.cache.at(self.number_at(k)) else {
                return;
            };
            let Some(state) = out.view.state_of(slot) else {
                continue;
            };
            let (drawn, span) = (Drawn::of(slot), Span::of(span));
            let slope = slope_of::<L>(slot, span, out);
            let known = Known::new(slope, self.depth, &mut self.written);
            let ruled = Ruled { drawn, span, state };
            count_span::<L>(&mut self.spans, ruled, Some(&known), false, out);
        }
        let mut alone = Alone::empty(L::EMPTY);
        let mut at = self.first_spilled();
        while let Some(found) = self.spilled_of(at, out.view, &|state| state.is_translucent()) {
            if let Some(stray) = self.spilled_stray(found.at, out) {
                // What it takes to count is not counted.
                set_up_stray::<L>(&stray, &mut alone, &mut CacheUse::default(), out);
                let (drawn, span, state) = (alone.drawn(), stray.span, found.state);
                let known = Known::new(stray.slope::<L>(out), self.depth, &mut self.written);
                let ruled = Ruled { drawn, span, state };
                count_span::<L>(&mut self.spans, ruled, Some(&known), false, out);
            }
            at = self.after(found.at);
        }
    }
}

/// Whether texels are read for pixels of a call.
pub(super) fn has_texels<L: Look>(state: Option<&DrawState<'_>>) -> bool {
    L::TEXTURED && state.is_some_and(|state| state.texture.is_some())
}

/// Counts a span of a line with values, before it is drawn.
#[inline(never)]
fn count_span<L: Look>(
    counts: &mut SpanCounts,
    ruled: Ruled<'_, L::Planes>,
    known: Option<&Known<'_>>,
    is_alone: bool,
    out: &Line<'_, '_, L>,
) {
    let Ruled { drawn, state, .. } = ruled;
    let mut pixels = SpanPixels::default();
    // A slot without values is compared by no state of its own.
    let has_texels = has_texels::<L>(out.view.draws.state(drawn.object));
    each_part(ruled, out, &mut |first, part| {
        let asked = u32::MAX << (32 - part) & opaque_of::<L>(ruled, first, part, out);
        let mut seen = asked;
        if let Some(known) = known {
            let mut cells = cells_at(known, first);
            let cells = cells.get_mut(..part as usize).unwrap_or_default();
            seen &= test(cells, known.slope.at(first), known.slope.step, state.depth);
            pixels.tested += asked.count_ones();
        }
        pixels.all += part;
        pixels.seen += seen.count_ones();
        pixels.hidden += (asked & !seen).count_ones();
        if has_texels {
            pixels.fetched += match state.holes {
                Some(_) => part,
                None => seen.count_ones(),
            };
        }
    });
    counts.add_span(pixels, is_alone && known.is_none());
}

/// Calls `f` with the first column of each part of at most 32 pixels that the scissor keeps, and their number.
pub(super) fn each_part<L: Look>(
    ruled: Ruled<'_, L::Planes>,
    out: &Line<'_, '_, L>,
    f: &mut dyn FnMut(u32, u32),
) {
    let Span { start, end } = ruled.span;
    for run in ruled.state.cut(out.number, start..end) {
        for first in (run.start..run.end).step_by(MOST_TESTED) {
            f(first, (run.end - first).min(MOST_TESTED as u32));
        }
    }
}

/// A bit for each of some pixels that is not a hole of the texture, the first the top one; of a shorter run the lower bits
/// say nothing.
pub(super) fn opaque_of<L: Look>(
    ruled: Ruled<'_, L::Planes>,
    first: u32,
    pixels: u32,
    out: &Line<'_, '_, L>,
) -> u32 {
    if !L::TEXTURED || ruled.state.holes.is_none() {
        return u32::MAX;
    }
    let mut others = None;
    let ink = ink_of::<L>(ruled, &mut others, out);
    let at = ruled.span.place(first, out.number);
    let mut colours = [WordOf::<L>::default(); MOST_TESTED];
    let colours = colours.get_mut(..pixels as usize).unwrap_or_default();
    let draws = out.view.draws.states;
    L::fill_opaque(ink.fill, ink.planes, at, draws, false, colours)
}

/// A copy of the depths that are there from a column on; what nobody has written is farthest away.
pub(super) fn cells_at(known: &Known<'_>, first: u32) -> [u32; MOST_TESTED] {
    let mut copy = [0; MOST_TESTED];
    let cells = known.cells.get(first as usize..).unwrap_or_default();
    for ((to, from), column) in copy.iter_mut().zip(cells).zip(first..) {
        if known.written.meets(column, column + 1) {
            *to = *from;
        }
    }
    copy
}
