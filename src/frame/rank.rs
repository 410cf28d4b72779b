//! The order in which a line with values is drawn (P1).
//!
//! By priority no depth is kept: what is higher is drawn over what is lower, and among equal ones what was submitted
//! later over what was before.

use super::near::{number_of, place};
use super::renderer::{Renderer, View};
use super::spans::Line;
use super::spilled::{Found, Spilled};
use crate::active::CacheSlot;
use crate::look::Look;
use crate::scene::DrawState;

/// The priority of what is in a slot, if the scene is drawn by it.
fn rank_of<T>(view: &View<'_>, slot: &CacheSlot<T>) -> u32 {
    let state = view.ranked.then(|| view.state_of(slot)).flatten();
    state.map_or(0, |state| state.priority.into())
}

impl<L: Look, const WORDS: usize> Renderer<'_, L, WORDS> {
    /// Draws all spans that do not wait, in slots by their bits, from the lowest priority on, or in order of submission, what
    /// has no slot between the others.
    pub(super) fn draw_in_order(&mut self, waiting: [u32; WORDS], out: &mut Line<'_, '_, L>) {
        let mut left = self.highest_first(waiting, out.view);
        let mut level = Some(0);
        while let Some(rank) = level {
            let mut slow = self.next_alone(self.first_spilled(), rank, out.view);
            let fast = loop {
                let keys = self.cache.order.as_flattened();
                let last = keys.get(left.wrapping_sub(1)).copied();
                let key = last.filter(|key| key >> 24 == rank);
                let object = key.map_or(u32::MAX, |key| key >> 8 & 0xFFFF);
                while let Some(found) = slow.filter(|found| found.at.object() < object) {
                    self.draw_alone(found, out);
                    slow = self.next_alone(self.after(found.at), rank, out.view);
                }
                let Some(key) = key else {
                    break last.map(|key| key >> 24);
                };
                self.draw_slot(key, out);
                left -= 1;
            };
            level = self.level_above(rank, fast, out.view);
        }
    }

    /// Sorts all slots but for some, from the highest priority on, and among equal ones from the last on; how many there are.
    fn highest_first(&mut self, waiting: [u32; WORDS], view: &View<'_>) -> usize {
        for (word, waiting) in waiting.into_iter().enumerate() {
            self.cache.listed[word] = self.cache.used[word] & !waiting;
        }
        self.sort_by(|renderer, key| {
            let number = number_of::<WORDS>(key);
            let slot = &renderer.cache.slots.as_flattened()[number];
            place(rank_of(view, slot), slot.object) | number as u32
        })
    }

    /// What has no slot and this priority, has pixels on the line and does not wait, from `at` on.
    fn next_alone<'v>(&self, at: Spilled, rank: u32, view: &View<'v>) -> Option<Found<'v>> {
        let is_next = |state: &DrawState<'_>| {
            let waits = state.waits() && (self.met || state.is_in_vain());
            !waits && (!view.ranked || u32::from(state.priority) == rank)
        };
        self.spilled_of(at, view, &is_next)
    }

    /// The lowest priority above another; `fast` is that of what is in slots.
    fn level_above(&self, rank: u32, fast: Option<u32>, view: &View<'_>) -> Option<u32> {
        if !view.ranked {
            return fast;
        }
        let (mut level, mut at) = (fast, self.first_spilled());
        while let Some(found) = self.spilled_of(at, view, &|state| {
            let here = u32::from(state.priority);
            here > rank && level.is_none_or(|level| here < level)
        }) {
            level = Some(found.state.priority.into());
            at = self.after(found.at);
        }
        level
    }
}
