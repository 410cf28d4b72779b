//! The order in which a line is drawn, kept while nothing begins or ends (X3, P1).
//!
//! Where spans are wide, and no two triangles on the line have ranges of depth that meet, they are drawn from the
//! nearest on, each where nobody has been before: no depth is compared, and a line that is full ends there. Whether
//! that is so is found out once, on the first line that keeps the triangles of the one before.

use super::renderer::{Renderer, View};
use crate::look::Look;
use crate::num::take_first;

/// How the next line is drawn, if it has the triangles of the last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Plan {
    /// Nobody has asked: triangles have begun or ended on the last line.
    Changed,
    /// In order of submission, by depth where spans meet.
    BySubmission,
    /// So many slots from the nearest on.
    NearFirst(u16),
}

/// Pixels that the spans of a line have at least, on average, for the order to be worth finding.
const WIDE: u32 = 16;
/// What depths of two planes may err together: ranges that are nearer to each other are taken to meet.
const APART: u32 = 1 << 15;

impl<L: Look, const WORDS: usize> Renderer<'_, L, WORDS> {
    /// Finds the plan for lines to come, after a line on which spans met.
    #[inline(never)]
    pub(super) fn find_plan(&mut self, view: &View<'_>) {
        if self.plan != Plan::Changed || self.depth.is_empty() || self.cache.spilled.is_some() {
            return;
        }
        if self.changed {
            return;
        }
        self.plan = match self.near_first(view) {
            Some(slots) => Plan::NearFirst(slots),
            None => Plan::BySubmission,
        };
    }

    /// Sorts the slots in use by their nearest depth; how many there are, if no two ranges meet.
    fn near_first(&mut self, view: &View<'_>) -> Option<u16> {
        let (mut count, mut pixels) = (0usize, 0);
        for word in 0..WORDS {
            let mut used = self.cache.used[word];
            while used != 0 {
                let i = take_first(&mut used) as usize & 31;
                let span = self.cache.spans[word][i];
                pixels += (span & 0xFFFF).saturating_sub(span >> 16);
                count += 1;
            }
        }
        if pixels < WIDE * count as u32 {
            return None;
        }
        count = 0;
        self.nearest = 0;
        self.ordered = 0;
        for word in 0..WORDS {
            let mut used = self.cache.used[word];
            while used != 0 {
                let number = word as u32 * 32 + take_first(&mut used);
                // What is nearer comes first: keys fall.
                let key = self.range(view, number)?[1] & !0xFF | number;
                let mut at = count;
                let keys = self.cache.order.as_flattened_mut();
                while at > 0 && *keys.get(at - 1)? < key {
                    *keys.get_mut(at)? = *keys.get(at - 1)?;
                    at -= 1;
                }
                *keys.get_mut(at)? = key;
                count += 1;
            }
        }
        self.is_sorted(view, count).then_some(count as u16)
    }

    /// Whether of the first so many slots in order each lies behind all before it, but for a neighbour just
    /// before it.
    fn is_sorted(&self, view: &View<'_>, count: usize) -> bool {
        let keys = self
            .cache
            .order
            .as_flattened()
            .get(..count)
            .unwrap_or_default();
        // The farthest depth of all but the last one.
        let mut farthest = u32::MAX;
        for pair in keys.windows(2) {
            let pair = [pair[0] & 0xFF, pair[1] & 0xFF];
            let (Some(front), Some(back)) = (self.range(view, pair[0]), self.range(view, pair[1]))
            else {
                return false;
            };
            let limit = back[1].saturating_add(APART);
            if farthest < limit || front[0] < limit && !self.is_one_surface(view, pair) {
                return false;
            }
            farthest = farthest.min(front[0]);
        }
        true
    }

    /// The farthest and the nearest depth of a triangle in a slot.
    fn range(&self, view: &View<'_>, number: u32) -> Option<[u32; 2]> {
        let slot = &self.cache.slots.get(number as usize >> 5)?[number as usize & 31];
        let [a, b, c] = view.triangle_of(slot.object)?.vertex.map(|v| v.depth);
        Some([a.min(b).min(c), a.max(b).max(c)])
    }

    /// Whether two triangles share a side and lie on either side of it, so that no pixel has both.
    fn is_one_surface(&self, view: &View<'_>, pair: [u32; 2]) -> bool {
        let object = |number: u32| {
            let slot = &self.cache.slots.get(number as usize >> 5)?[number as usize & 31];
            view.objects.get(usize::from(slot.object))
        };
        let (Some(a), Some(b)) = (object(pair[0]), object(pair[1])) else {
            return false;
        };
        // Both go clockwise: a side that they share is walked either way.
        let sides = |c: [u16; 3]| [(c[0], c[1]), (c[1], c[2]), (c[2], c[0])];
        let others = sides(b.corner);
        sides(a.corner)
            .iter()
            .any(|&(from, to)| others.contains(&(to, from)))
    }
}
