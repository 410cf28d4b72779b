//! A line on which spans overlap, each pixel shaded once: first who is seen where, then colours
//! (X3). For pipelines whose depth is [`DepthAndId`](crate::pipeline::DepthAndId).

use super::lines::LinePass;
use crate::active::{ActiveList, Slot};
use crate::geometry::Parameters;
use crate::pipeline::{DrawableOf, Pipeline};
use crate::stats::SpanCounter;
use crate::visible::{DepthRamp, MOST_NAMES, Named, name};

impl<P: Pipeline> LinePass<'_, '_, P> {
    /// Draws all objects, if each has a name and a plane; `false` when nothing was drawn.
    #[inline(never)]
    pub(super) fn draw_deferred(&mut self, list: &ActiveList<'_, DrawableOf<P>>) -> bool {
        self.clear();
        let Some(named) = self.name_all(list) else {
            *self.dirty = true;
            self.clear();
            return false;
        };
        self.shade_named(list.slots(), named);
        true
    }

    /// Finds who has which pixel; how many spans and pixels of spans there were.
    fn name_all(&mut self, list: &ActiveList<'_, DrawableOf<P>>) -> Option<(u32, u32)> {
        let slots = list.slots();
        let (left, line) = (self.left, self.line);
        let (mut spans, mut pixels) = (0, 0);
        for (index, slot) in list.members() {
            let Parameters::Planes(plane, _) = &slot.body().parameters else {
                return None;
            };
            if index >= MOST_NAMES {
                return None;
            }
            let Some((start, end)) = self.span(slot.body()) else {
                continue;
            };
            let cells = self.cells.get_mut(start..end)?;
            let column = left + start as i32;
            let whole = |i: usize, name: u32| {
                let other = slots.get(name as usize - 1).map(|s| &s.body().parameters);
                match other {
                    Some(Parameters::Planes(plane, _)) => plane.at(column + i as i32, line) as u32,
                    _ => 0,
                }
            };
            let course = DepthRamp::of(plane, column, line);
            name::<P::Depth>(cells, course, index as u32 + 1, whole);
            spans += 1;
            pixels += (end - start) as u32;
        }
        Some((spans, pixels))
    }

    /// Shades what is named, and makes all cells farthest.
    fn shade_named(&mut self, slots: &[Slot<DrawableOf<P>>], (mut spans, mut covered): (u32, u32)) {
        let mut at = 0;
        while let Some(cell) = self.cells.get(at) {
            let name = Named::<P::Depth>::of(cell);
            let slot = slots.get((name as usize).wrapping_sub(1));
            // Nobody is here; or there is no such span, which cannot be.
            let Some((slot, (start, end))) = slot.and_then(|s| Some((s, self.span(s.body())?)))
            else {
                at += 1;
                continue;
            };
            let (Some(pixels), Some(cells)) = (
                self.pixels.get_mut(start..end),
                self.cells.get_mut(start..end),
            ) else {
                return;
            };
            let place = (self.left + start as i32, self.line);
            let named = Named::new(cells, name);
            self.brush.draw_named(slot.body(), place, pixels, named);
            (spans, covered) = (spans - 1, covered - (end - start) as u32);
            at += 1;
        }
        if P::Counter::COUNTS && spans > 0 {
            // What is hidden as a whole.
            for _ in 1..spans {
                self.brush.counter.span(0, 0, true);
            }
            self.brush.counter.span(0, covered, true);
        }
    }
}
