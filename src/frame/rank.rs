//! The order in which a line with values is drawn (P1).
//!
//! By priority no depth is kept: what is higher is drawn over what is lower, and among equal ones what was submitted
//! later over what was before.

use super::near::{insert, place};
use super::renderer::{Renderer, View};
use super::spans::{Line, Span};
use super::spilled::{Found, Spilled};
use crate::active::CacheSlot;
use crate::look::Look;
use crate::num::take_first;
use crate::scene::DrawState;

/// Inserts a key among the first `count`, which rise.
#[inline(never)]
pub(super) fn insert_rising(keys: &mut [u32], count: usize, key: u32) {
    insert(keys, count, key, |other| other < key);
}

/// The priority of what is in a slot, if the scene is drawn by it.
fn rank_of<T>(view: &View<'_>, slot: &CacheSlot<T>) -> u32 {
    let state = view.ranked.then(|| view.state_of(slot)).flatten();
    state.map_or(0, |state| state.priority.into())
}

impl<L: Look, const WORDS: usize> Renderer<'_, L, WORDS> {
    /// Draws all spans that do not wait, in slots by their bits, from the lowest priority on, or in order of submission, what
    /// has no slot between the others.
    pub(super) fn draw_in_order(&mut self, waiting: [u32; WORDS], out: &mut Line<'_, '_, L>) {
        let count = self.lowest_first(waiting, out.view);
        let at = |keys: &[[u32; 32]; WORDS], k: usize| {
            let keys = keys.as_flattened().get(..count);
            keys.and_then(|keys| keys.get(k)).copied()
        };
        let (mut k, mut level) = (0, Some(0));
        while let Some(rank) = level {
            let mut slow = self.next_alone(self.first_spilled(), rank, out.view);
            while let Some(key) = at(&self.cache.order, k).filter(|key| key >> 24 == rank) {
                let object = key >> 8 & 0xFFFF;
                while let Some(found) = slow.filter(|found| found.at.object() < object) {
                    self.draw_alone(found, out);
                    slow = self.next_alone(self.after(found.at), rank, out.view);
                }
                self.draw_slot(key as usize & 0xFF, out);
                k += 1;
            }
            while let Some(found) = slow {
                self.draw_alone(found, out);
                slow = self.next_alone(self.after(found.at), rank, out.view);
            }
            let fast = at(&self.cache.order, k).map(|key| key >> 24);
            level = self.level_above(rank, fast, out.view);
        }
    }

    /// Sorts the slots with a span, but for some, from the lowest priority on; how many there are.
    fn lowest_first(&mut self, waiting: [u32; WORDS], view: &View<'_>) -> usize {
        let mut count = 0;
        for (word, waiting) in waiting.into_iter().enumerate() {
            let mut used = self.cache.used[word] & !waiting;
            while used != 0 {
                let i = take_first(&mut used) as usize & 31;
                let span = Span::of(self.cache.spans[word][i]);
                if span.start < span.end {
                    // Its priority, the number of the object, and its own.
                    let slot = &self.cache.slots[word][i];
                    let key = place(rank_of(view, slot), slot.object) | (word * 32 + i) as u32;
                    insert_rising(self.cache.order.as_flattened_mut(), count, key);
                    count += 1;
                }
            }
        }
        count
    }

    /// What has no slot and this priority, has pixels on the line and does not wait, from `at` on.
    #[inline(never)]
    fn next_alone<'v>(&self, at: Spilled, rank: u32, view: &View<'v>) -> Option<Found<'v>> {
        let is_next = |state: &DrawState<'_>| {
            let waits = state.waits() && (self.met || state.is_in_vain());
            !waits && (!view.ranked || u32::from(state.priority) == rank)
        };
        self.spilled_of(at, view, is_next)
    }

    /// The lowest priority above another; `fast` is that of what is in slots.
    fn level_above(&self, rank: u32, fast: Option<u32>, view: &View<'_>) -> Option<u32> {
        if !view.ranked {
            return fast;
        }
        let (mut level, mut at) = (fast, self.first_spilled());
        while at.is_some() {
            if let Some(state) = self.state_at(at, view) {
                let here = u32::from(state.priority);
                if here > rank && level.is_none_or(|level| here < level) {
                    level = Some(here);
                }
            }
            at = self.after(at);
        }
        level
    }
}
