//! What has no slot, where spans meet: guests, which lie in the cells of depth while a line is drawn (X3, C5).
//!
//! A guest is set up for its line alone, and only where some of it is seen. Where there are more than the cells have
//! room for, the nearest depth of each column is kept there instead (`dense`).

use super::alone::{Alone, set_up_stray};
use super::near::{Drawing, Field, Taken, colour_free, colour_rest};
use super::renderer::{Renderer, View};
use super::rival::{Rival, Slope, thin_slope};
use super::spans::{Line, Span};
use super::thin::depth_plane;
use crate::active::next;
use crate::link::Link;
use crate::look::Look;
use crate::span::Triangle;
use crate::visible::Mask;
use core::mem::take;

/// A span of what has no slot, as it lies in the cells of depth: `CELLS` of them.
#[derive(Clone, Copy)]
pub(super) struct Guest {
    /// Its nearest depth.
    pub(super) key: u32,
    pub(super) rival: Rival,
}

/// Cells of depth that a guest takes.
pub(super) const CELLS: usize = 4;

impl Guest {
    #[inline(always)]
    pub(super) fn of(cells: &[u32], number: usize) -> Option<Self> {
        let cells = cells.get(CELLS * number..CELLS * (number + 1));
        let &[key, object, span, step] = cells? else {
            return None;
        };
        let at = key.wrapping_sub(step.wrapping_mul(object >> 16));
        let rival = Rival {
            span: Span::of(span),
            slope: Slope { at, step },
            object: object as u16,
        };
        Some(Self { key, rival })
    }

    fn of_rival(rival: Rival) -> Self {
        let [key, _] = rival.slope.range(rival.span);
        Self { key, rival }
    }

    /// Puts it into its place among so many, whose keys fall, where there are enough cells.
    #[inline(always)]
    fn insert(self, cells: &mut [u32], count: usize) {
        let mut cells = cells.get_mut(..CELLS * (count + 1)).unwrap_or_default();
        while let [before @ .., a, b, c, d] = take(&mut cells) {
            match *before {
                [.., key, object, span, step] if key < self.key => {
                    [*a, *b, *c, *d] = [key, object, span, step];
                }
                _ => {
                    [*a, *b, *c, *d] = self.cells();
                    break;
                }
            }
            cells = before;
        }
    }

    /// The column of its nearest depth stands for that at the first of all, as its key is known.
    #[inline(always)]
    fn cells(self) -> [u32; CELLS] {
        let Rival {
            span,
            slope,
            object,
        } = self.rival;
        let nearest = if slope.at(span.start) == self.key {
            span.start
        } else {
            span.end - 1
        };
        let object = nearest << 16 | u32::from(object);
        [self.key, object, span.start << 16 | span.end, slope.step]
    }
}

impl<L: Look, const WORDS: usize> Field<'_, L, WORDS> {
    /// The nearest depth of a guest; 0 where there is none.
    #[inline(always)]
    pub(super) fn guest_key(&self, at: usize) -> u32 {
        if at >= self.guests {
            return 0;
        }
        Guest::of(self.cells, at).map_or(0, |guest| guest.key)
    }

    /// Draws the guest that comes next; the key of the one after it.
    #[inline(never)]
    pub(super) fn next_guest(
        &self,
        taken: &mut Taken,
        drawing: &mut Drawing<'_>,
        out: &mut Line<'_, '_, L>,
    ) -> u32 {
        let guest = Guest::of(self.cells, taken.guests);
        taken.guests += 1;
        if let Some(guest) = guest {
            self.draw_guest(guest, *taken, drawing, out);
        }
        self.guest_key(taken.guests)
    }

    /// Draws a guest before what comes later.
    #[inline(never)]
    fn draw_guest(
        &self,
        guest: Guest,
        after: Taken,
        drawing: &mut Drawing<'_>,
        out: &mut Line<'_, '_, L>,
    ) {
        let rival = guest.rival;
        let [_, far] = rival.slope.range(rival.span);
        let Span { start, end } = rival.span;
        if drawing.mask.has_all(start, end) {
            drawing.hidden += 1;
            return;
        }
        let later = self.later(after.slots);
        if !self.meets(rival.span, far, later) && self.guest_key(after.guests) < far {
            return colour_guest::<L>(rival, None, drawing, out);
        }
        let mut taken = drawing.mask.part(start, end);
        self.hide(rival, far, after, out, &mut taken);
        if !taken.has_all(start, end) {
            colour_guest::<L>(rival, Some(&mut taken), drawing, out);
        }
    }
}

/// Colours what has no slot, where nobody is and but for columns that are taken.
#[inline(never)]
fn colour_guest<L: Look>(
    rival: Rival,
    taken: Option<&mut Mask>,
    drawing: &mut Drawing<'_>,
    out: &mut Line<'_, '_, L>,
) {
    let span = rival.span;
    let Some(stray) = Stray::with(span, rival.object, out.view) else {
        return;
    };
    let mut alone = Alone::empty(L::EMPTY);
    set_up_stray::<L>(&stray, &mut alone, drawing.counts, out);
    let drawn = alone.drawn();
    if let Some(taken) = taken {
        return colour_free::<L>(drawing.mask, taken, drawn, span, out);
    }
    colour_rest::<L>(drawing.mask, drawn, span, out);
}

/// A walk over what has no slot: what is next, and what was before.
pub(super) struct Walk {
    before: Link,
    at: Link,
}

impl Walk {
    pub(super) fn of(first: Link) -> Self {
        Self {
            before: Link::NONE,
            at: first,
        }
    }
}

/// A triangle without a slot that has pixels on a line.
pub(super) struct Stray<'v> {
    pub(super) triangle: Triangle<'v>,
    pub(super) object: u16,
    pub(super) span: Span,
}

/// A depth that hardly any span has.
const FARTHEST: u32 = 0xFFFF;

/// Guests that find room where fewer cells of depth are lent.
const FEW: usize = 20;

impl<L: Look, const WORDS: usize> Renderer<'_, L, WORDS> {
    /// What comes next of what has no slot and has pixels on the line; what has ended leaves the chain.
    #[inline(never)]
    pub(super) fn next_stray<'v>(
        &mut self,
        walk: &mut Walk,
        out: &Line<'_, 'v, L>,
    ) -> Option<Stray<'v>> {
        let line = out.number as i32;
        while walk.at.is_some() {
            let object = walk.at.object();
            let triangle = out.view.triangle_of(object)?;
            let (lines, after) = (triangle.lines(), next(self.links, walk.at));
            if lines.end <= line {
                self.cache.take_spilled(walk.before, after, self.links);
                walk.at = after;
                continue;
            }
            (walk.before, walk.at) = (walk.at, after);
            let stray = Stray::on_line(triangle, object, out.number);
            if stray.is_some() {
                return stray;
            }
        }
        None
    }

    /// Whether the cells may not hold all that has no slot.
    #[inline(always)]
    pub(super) fn is_dense(&self) -> bool {
        CELLS * usize::from(self.cache.spilled_count) > self.depth.len().max(FEW * CELLS)
    }

    /// Draws so many slots that are sorted, and what has no slot, of which all or those on columns where spans meet are
    /// compared; how many spans met others.
    #[inline(never)]
    pub(super) fn draw_with_guests(&mut self, slots: usize, out: &mut Line<'_, '_, L>) -> usize {
        let depth = take(&mut self.depth);
        let mut few;
        let cells = if depth.len() < FEW * CELLS {
            few = [0; FEW * CELLS];
            &mut few[..]
        } else {
            &mut *depth
        };
        let hidden = if self.dense {
            self.draw_dense(slots, cells, out)
        } else {
            let guests = self.sort_guests(cells, out);
            self.draw_field(slots, cells, guests, out)
        };
        self.depth = depth;
        hidden
    }

    /// Sorts what has no slot; how many that are.
    #[inline(never)]
    fn sort_guests(&mut self, cells: &mut [u32], out: &Line<'_, '_, L>) -> usize {
        let mut count = 0;
        let mut walk = Walk::of(self.cache.spilled);
        while let Some(stray) = self.next_stray(&mut walk, out) {
            // What meets nobody may come at any time: behind all others, and no two are compared.
            let is_compared = self.crowded || self.over.meets(stray.span.start, stray.span.end);
            let slope = if is_compared {
                stray.slope::<L>(out)
            } else {
                Slope::even(FARTHEST.saturating_sub(count as u32))
            };
            Guest::of_rival(stray.rival(slope)).insert(cells, count);
            count += 1;
        }
        if self.crowded {
            self.counts.misses += count as u32;
        }
        count
    }
}

impl<'v> Stray<'v> {
    /// What has no slot, by its number; `None` where it has no pixels on the line, or has ended.
    #[inline(never)]
    pub(super) fn of(object: u16, view: &View<'v>, line: u32) -> Option<Self> {
        let triangle = view.triangle_of(object)?;
        if triangle.lines().end <= line as i32 {
            return None;
        }
        Self::on_line(triangle, object, line)
    }

    /// The same where its columns are known.
    #[inline(always)]
    pub(super) fn with(span: Span, object: u16, view: &View<'v>) -> Option<Self> {
        Some(Self {
            triangle: view.triangle_of(object)?,
            object,
            span,
        })
    }

    #[inline(always)]
    fn on_line(triangle: Triangle<'v>, object: u16, line: u32) -> Option<Self> {
        let way = triangle.way();
        let sides = triangle.sides(way, line as i32, triangle.lines().turn);
        let (start, end) = sides.columns(way, line, triangle.frame);
        let span = Span { start, end };
        (start < end).then_some(Self {
            triangle,
            object,
            span,
        })
    }

    /// As one of those that compete for columns.
    pub(super) fn rival(&self, slope: Slope) -> Rival {
        Rival {
            span: self.span,
            slope,
            object: self.object,
        }
    }

    /// Its depth, or what stands for it.
    pub(super) fn slope<L: Look>(&self, out: &Line<'_, '_, L>) -> Slope {
        if !out.deep {
            return Slope::of_place(out.view, self.object);
        }
        self.slope_by(depth_plane(&self.triangle), out)
    }

    /// The same of a plane of depth, if it has one.
    #[inline(always)]
    pub(super) fn slope_by<L: Look>(
        &self,
        plane: Option<[u32; 3]>,
        out: &Line<'_, '_, L>,
    ) -> Slope {
        match plane {
            Some(plane) => Slope::of_plane(plane, out.number),
            None => thin_slope(self.object, self.span, out.view, out.number),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lies_in_cells_comes_back() {
        let rival = Rival {
            span: Span {
                start: 3,
                end: 1016,
            },
            slope: Slope {
                at: 0x8123_4567,
                step: 0xFFFF_FF00,
            },
            object: 61_439,
        };
        let key = rival.slope.at(1015);
        let guest = Guest { key, rival };
        let mut cells = [0; 3 * CELLS - 1];
        cells[0] = key;
        guest.insert(&mut cells, 1);
        let back = Guest::of(&cells, 1).unwrap();
        assert_eq!((back.key, back.rival.object), (key, 61_439));
        let Slope { at, step } = back.rival.slope;
        assert_eq!((at, step), (rival.slope.at, rival.slope.step));
        assert_eq!((back.rival.span.start, back.rival.span.end), (3, 1016));
        guest.insert(&mut cells, 2);
        assert!(Guest::of(&cells, 2).is_none());
        assert_eq!(cells[..CELLS], [key, 0, 0, 0]);
        assert_eq!(cells[2 * CELLS..], [0; CELLS - 1]);
    }
}
