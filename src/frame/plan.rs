//! An order that lasts while no triangle begins or ends (X3, P1).
//!
//! Where no two triangles in slots have ranges of depth that meet, or there is no depth, the order of a line is that of
//! the lines to come: each is drawn where nobody has been before, nothing is compared or sorted, and a line that is full
//! ends there.

use super::near::number_of;
use super::renderer::{Renderer, View};
use super::spans::{Drawn, Line, colour_run, columns_of};
use super::thin::MARGIN;
use crate::look::Look;
use core::hint::black_box;

impl<L: Look, const WORDS: usize> Renderer<'_, L, WORDS> {
    /// Colours spans in the order of the last line, where nobody has been before, up to a line that is full; whether
    /// it is.
    #[inline(never)]
    pub(super) fn draw_as_before(&mut self, out: &mut Line<'_, '_, L>) -> bool {
        let mut left = out.pixels.len() as u32;
        for k in 0..usize::from(self.nearest) {
            let number = self.number_at(k);
            let slot = &self.cache.slots.as_flattened()[number];
            let span = columns_of::<L>(slot, out);
            if span.start >= span.end {
                continue;
            }
            let drawn = Drawn::of(slot);
            let mut rest = span;
            while let Some(run) = rest.take_run(&mut self.covered) {
                left -= run.end - run.start;
                colour_run::<L>(drawn, span, run, out);
            }
            if left == 0 {
                self.covered.clear();
                return true;
            }
        }
        false
    }

    /// The slot that is so many places from the front.
    #[inline(always)]
    pub(super) fn number_at(&self, at: usize) -> usize {
        let key = self.cache.order.as_flattened().get(at).copied();
        number_of::<WORDS>(key.unwrap_or_default())
    }

    /// Whether of the slots in order each lies behind all before it, but for a neighbour just before it.
    #[inline(never)]
    pub(super) fn lasts(&self, out: &Line<'_, '_, L>) -> bool {
        if !out.deep {
            return true;
        }
        // The farthest depth of all but the last one, and of that.
        let (mut farthest, mut front) = (u32::MAX, u32::MAX);
        let mut before = 0;
        for k in 0..usize::from(self.nearest) {
            let slot = &self.cache.slots.as_flattened()[self.number_at(k)];
            let Some(triangle) = out.view.triangle_of(slot.object) else {
                return false;
            };
            let [a, b, c] = triangle.vertex.map(|v| v.depth);
            // Planes are raised by a margin, and err by less.
            let limit = a.max(b).max(c) + 2 * MARGIN;
            let meets = front < limit && !is_one_surface(out.view, before, slot.object);
            if farthest < limit || meets {
                return false;
            }
            farthest = farthest.min(front);
            (front, before) = (a.min(b).min(c), slot.object);
        }
        true
    }
}

/// Whether two triangles share a side and lie on either side of it, so that no pixel has both.
fn is_one_surface(view: &View<'_>, a: u16, b: u16) -> bool {
    let object = |number: u16| view.objects.get(usize::from(number));
    let (Some(a), Some(b)) = (object(a), object(b)) else {
        return false;
    };
    // Both go clockwise: a side that they share is walked either way.
    let sides = |c: [u16; 3]| [(c[0], c[1]), (c[1], c[2]), (c[2], c[0])];
    let others = sides(b.corner);
    // Nine comparisons, in a loop.
    black_box(&sides(a.corner)[..])
        .iter()
        .any(|&(from, to)| others.contains(&(to, from)))
}
