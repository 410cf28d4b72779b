//! Lines with many spans without a slot: the nearest depth of each column comes first, then who has it (X3, C5).
//!
//! What has no slot is walked twice, once for depths and once for colours, whatever its number is; nothing is sorted,
//! and what is hidden is not set up. Both walks go in order of submission, slots among them: of equal depths in a column
//! the one submitted last is coloured last. Where fewer cells of depth are lent than a line has columns, the line is
//! drawn in parts.

use super::alone::{Alone, set_up_stray};
use super::guests::{Stray, Walk};
use super::near::{drawn_in, number_of};
use super::renderer::Renderer;
use super::rival::{Rival, rival_of};
use super::spans::{Drawn, Line, Span, colour_run};
use crate::look::Look;
use crate::num::rolled;
use crate::visible::Mask;

/// Columns of a line that have cells, the first one's cell first.
struct Part<'a> {
    columns: Span,
    cells: &'a mut [u32],
}

impl Part<'_> {
    /// The first column of a span in a part, and the cells from there on.
    fn run_of(&mut self, span: Span) -> Option<(u32, &mut [u32])> {
        let Span { start, end } = span.within(self.columns);
        let first = self.columns.start;
        let cells = (start.checked_sub(first)? as usize)..(end.checked_sub(first)? as usize);
        Some((start, self.cells.get_mut(cells)?))
    }

    /// Keeps the depths of a rival, where they are nearer.
    #[inline(never)]
    fn deepen(&mut self, rival: Rival) {
        let Some((start, cells)) = self.run_of(rival.span) else {
            return;
        };
        let mut depth = rival.slope.at(start);
        for cell in cells {
            rolled();
            *cell = depth.max(*cell);
            depth = depth.wrapping_add(rival.slope.step);
        }
    }

    /// Calls `f` with each run of columns in which nobody is nearer than a rival; how many columns these are not.
    #[inline(always)]
    fn each_seen(&mut self, rival: Rival, mut f: impl FnMut(Span)) -> u32 {
        let Some((mut start, cells)) = self.run_of(rival.span) else {
            return 0;
        };
        let (mut depth, mut hidden) = (rival.slope.at(start), 0);
        let mut end = start;
        for &mut cell in cells {
            if cell != depth {
                if start < end {
                    f(Span { start, end });
                }
                (start, hidden) = (end + 1, hidden + 1);
            }
            depth = depth.wrapping_add(rival.slope.step);
            end += 1;
        }
        if start < end {
            f(Span { start, end });
        }
        hidden
    }
}

/// Colours a run of a span, and covers it.
#[inline(never)]
fn colour_seen_run<L: Look>(
    drawn: Drawn<'_, L::Planes>,
    span: Span,
    run: Span,
    mask: &mut Mask,
    out: &mut Line<'_, '_, L>,
) {
    mask.cover(run.start, run.end);
    colour_run::<L>(drawn, span, run, out);
}

impl<L: Look, const WORDS: usize> Renderer<'_, L, WORDS> {
    /// Draws so many slots that are in order of submission, the last one first, and all that has no slot; how many spans
    /// met others.
    #[inline(never)]
    pub(super) fn draw_dense(
        &mut self,
        slots: usize,
        cells: &mut [u32],
        out: &mut Line<'_, '_, L>,
    ) -> usize {
        let (mut start, mut hidden) = (0, 0);
        let width = out.pixels.len();
        while start < width {
            let end = width.min(start + cells.len());
            let Some(cells) = cells.get_mut(..end - start) else {
                break;
            };
            cells.fill(0);
            let mut part = Part {
                columns: Span::new(start as u32, end as u32),
                cells,
            };
            self.find_nearest(slots, &mut part, out);
            hidden += self.colour_nearest(slots, &mut part, out);
            start = end;
        }
        hidden
    }

    /// The nearest depth of each column.
    fn find_nearest(&mut self, slots: usize, part: &mut Part<'_>, out: &mut Line<'_, '_, L>) {
        for k in 0..slots {
            if let Some(rival) = self.rival_at(k, out) {
                part.deepen(rival);
            }
        }
        let mut walk = Walk::of(self.cache.spilled);
        let mut guests = 0;
        while let Some(stray) = self.next_stray(&mut walk, out) {
            guests += 1;
            if stray.span.meets(part.columns) {
                part.deepen(stray.rival(stray.slope::<L>(out)));
            }
        }
        if self.crowded && part.columns.start == 0 {
            self.counts.misses += guests;
        }
    }

    /// Colours who is nearest, in order of submission; how many spans are not seen whole.
    fn colour_nearest(
        &mut self,
        mut slots: usize,
        part: &mut Part<'_>,
        out: &mut Line<'_, '_, L>,
    ) -> usize {
        let mut hidden = 0;
        let mut walk = Walk::of(self.cache.spilled);
        loop {
            let stray = self.next_stray(&mut walk, out);
            let until = stray.as_ref().map_or(u16::MAX, |stray| stray.object);
            while let Some(k) = slots.checked_sub(1) {
                let rival = self.rival_at(k, out);
                if rival.is_some_and(|rival| rival.object > until) {
                    break;
                }
                slots = k;
                if let Some(rival) = rival {
                    hidden += usize::from(self.colour_seen(k, rival, part, out));
                }
            }
            let Some(stray) = stray else {
                return hidden;
            };
            if stray.span.meets(part.columns) {
                hidden += usize::from(self.colour_stray(&stray, part, out));
            }
        }
    }

    /// The span of the slot that is so many places from the front; `None` where it has no columns.
    #[inline(never)]
    fn rival_at(&self, at: usize, out: &Line<'_, '_, L>) -> Option<Rival> {
        let number = number_of::<WORDS>(*self.cache.order.as_flattened().get(at)?);
        let span = Span::of(self.cache.spans.as_flattened()[number]);
        let slot = &self.cache.slots.as_flattened()[number];
        (span.start < span.end).then(|| rival_of::<L>(slot, span, out))
    }

    /// Colours what is seen of the slot at a place; whether that is not all.
    #[inline(never)]
    fn colour_seen(
        &mut self,
        at: usize,
        rival: Rival,
        part: &mut Part<'_>,
        out: &mut Line<'_, '_, L>,
    ) -> bool {
        let drawn = Drawn::of(&self.cache.slots.as_flattened()[self.number_at(at)]);
        let mask = drawn_in(self.crowded, &mut self.covered, &mut self.written);
        part.each_seen(rival, |run| {
            colour_seen_run::<L>(drawn, rival.span, run, mask, out);
        }) > 0
    }

    /// The same of what has no slot, which is set up where it is seen.
    #[inline(never)]
    fn colour_stray(
        &mut self,
        stray: &Stray<'_>,
        part: &mut Part<'_>,
        out: &mut Line<'_, '_, L>,
    ) -> bool {
        let rival = stray.rival(stray.slope::<L>(out));
        let mask = drawn_in(self.crowded, &mut self.covered, &mut self.written);
        let counts = &mut self.counts;
        let mut alone = None;
        part.each_seen(rival, |run| {
            if alone.is_none() {
                let alone = alone.insert(Alone::empty(L::EMPTY));
                set_up_stray::<L>(stray, alone, counts, out);
            }
            if let Some(alone) = &alone {
                colour_seen_run::<L>(alone.drawn(), rival.span, run, mask, out);
            }
        }) > 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::rival::Slope;
    use crate::num::random::Rng;
    use std::vec::Vec;

    /// Kills: columns of a depth that is one unit farther are seen too; the last run of columns is left out.
    #[test]
    fn columns_are_seen_in_which_nobody_is_nearer() {
        let mut rng = Rng(7);
        let (mut shared, mut outside) = (0, 0);
        for _ in 0..2_000 {
            let first = rng.below(50);
            let mut cells = [0; 40];
            let mut part = Part {
                columns: Span {
                    start: first,
                    end: first + 40,
                },
                cells: &mut cells,
            };
            let rivals: Vec<Rival> = (0..5)
                .map(|object| {
                    let start = rng.below(90);
                    let (end, at) = (start + 1 + rng.below(30), 1_000 + rng.below(4));
                    let step = rng.below(3).wrapping_sub(1);
                    Rival {
                        span: Span { start, end },
                        slope: Slope { at, step },
                        object,
                    }
                })
                .collect();
            for &rival in &rivals {
                part.deepen(rival);
            }
            let is_at = |r: &Rival, c: u32| r.span.start <= c && c < r.span.end;
            for rival in &rivals {
                let columns = (first..first + 40).filter(|&c| is_at(rival, c));
                let (want, behind): (Vec<u32>, Vec<u32>) = columns.partition(|&c| {
                    let others = rivals.iter().filter(|r| is_at(r, c));
                    let nearest = others.map(|r| r.slope.at(c)).max();
                    nearest == Some(rival.slope.at(c))
                });
                let mut got = Vec::new();
                let hidden = part.each_seen(*rival, |run| got.extend(run.start..run.end));
                assert_eq!((&got, hidden as usize), (&want, behind.len()));
                shared += usize::from(!want.is_empty() && !behind.is_empty());
                outside += usize::from(want.is_empty() && behind.is_empty());
            }
        }
        assert!(shared > 1_000 && outside > 1_000, "{shared}, {outside}");
    }
}
