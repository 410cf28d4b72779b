//! The object cache: slots in fast memory, found by sets, and when each changes (C1, C2, C3, C7).
//!
//! What is active is a bit of a set, so nothing is walked to be found; the line on which a slot changes
//! next (a side turns, or the triangle ends) is a chain a line in a ring of 64, so nothing is asked on the
//! lines between. What found no slot is a chain in slow memory by number, through the renderer's own column of
//! links; a link that leads to a slot lies in a range of its own, so one comparison tells a hit.

use crate::link::Link;
use crate::num::{bit, take_first};

/// A slot: what is kept of an object, and when it changes.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Slot<T> {
    pub(crate) item: T,
    /// The object's number.
    pub(crate) object: u16,
    /// The line of the next change.
    pub(crate) event: u16,
    /// The line after the last.
    pub(crate) end: u16,
    /// The next slot that changes on a line of the same place in the ring.
    next: u8,
    /// What the owner of the slots wants to know of an object.
    pub(crate) flags: u8,
}

/// No slot.
const NONE: u8 = 0xFF;
/// Lines of the ring. What changes farther down goes around.
const RING: usize = 64;

/// `32 WORDS` slots and what finds them, to be placed in the fastest memory there is.
#[derive(Debug)]
#[repr(C)]
pub struct Cache<T, const WORDS: usize> {
    /// Slots that hold an object.
    pub(crate) used: [u32; WORDS],
    /// Of these, those that are drawn in the commonest way.
    pub(crate) plain: [u32; WORDS],
    /// Of these, those whose depth is known.
    pub(crate) deep: [u32; WORDS],
    /// The columns of each slot on this line: the first in the upper half, the one after the last below.
    pub(crate) spans: [[u32; 32]; WORDS],
    /// Slots of spans that meet others, as a set.
    pub(crate) listed: [u32; WORDS],
    /// The same, and all slots, from the nearest on or by number of object.
    pub(crate) order: [[u32; 32]; WORDS],
    /// The farthest depth of each slot's span on this line.
    pub(crate) far: [[u32; 32]; WORDS],
    ring: [u8; RING],
    /// The first object that found no slot.
    pub(crate) spilled: Link,
    /// How many slots may be used.
    limit: u16,
    /// The last, so that all else lies within the reach of one instruction.
    pub(crate) slots: [[Slot<T>; 32]; WORDS],
}

/// What the cache has done since it was cleared (C8).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CacheUse {
    /// Objects that found a slot when they began.
    pub hits: u32,
    /// Objects that found none.
    pub spilled: u32,
    /// Of these, those that found one later.
    pub moved_in: u32,
    /// Lines of objects that were drawn from slow memory.
    pub misses: u32,
    /// Set-ups: of slots, and of objects without one, once a line.
    pub set_ups: u32,
    /// The most slots in use at a time.
    pub peak: u32,
    /// Triangles that stretch over 4,096 texels or more, and are drawn without their texture.
    pub untextured: u32,
}

impl<T: Copy, const WORDS: usize> Cache<T, WORDS> {
    /// A cache of empty slots.
    #[must_use]
    pub(crate) const fn with(item: T) -> Self {
        let slot = Slot {
            item,
            object: 0,
            event: 0,
            end: 0,
            next: NONE,
            flags: 0,
        };
        const { assert!(32 * WORDS < NONE as usize, "at most 224 slots") };
        Self {
            slots: [[slot; 32]; WORDS],
            used: [0; WORDS],
            plain: [0; WORDS],
            deep: [0; WORDS],
            spans: [[0; 32]; WORDS],
            listed: [0; WORDS],
            order: [[0; 32]; WORDS],
            far: [[0; 32]; WORDS],
            ring: [NONE; RING],
            spilled: Link::NONE,
            limit: 32 * WORDS as u16,
        }
    }

    /// Uses no more than so many slots. The picture is the same.
    pub fn set_limit(&mut self, slots: u16) {
        self.limit = slots.min(32 * WORDS as u16);
        self.clear();
    }

    /// Forgets all objects.
    pub(crate) fn clear(&mut self) {
        self.used = [0; WORDS];
        self.plain = [0; WORDS];
        self.deep = [0; WORDS];
        self.ring = [NONE; RING];
        self.spilled = Link::NONE;
    }

    /// Whether no object is active.
    #[inline(always)]
    pub(crate) fn is_empty(&self) -> bool {
        self.used.iter().all(|&word| word == 0) && !self.spilled.is_some()
    }

    /// How many slots are in use.
    pub(crate) fn in_use(&self) -> u32 {
        self.used.iter().map(|word| word.count_ones()).sum()
    }

    /// A slot that is free.
    #[inline(always)]
    pub(crate) fn free(&self) -> Option<usize> {
        for (word, &used) in self.used.iter().enumerate() {
            let mut free = !used;
            if free != 0 {
                let slot = word * 32 + take_first(&mut free) as usize;
                return (slot < usize::from(self.limit)).then_some(slot);
            }
        }
        None
    }

    /// The slot of a number; there is one for each number below `32 WORDS`.
    #[inline(always)]
    pub(crate) fn slot(&mut self, slot: usize) -> Option<&mut Slot<T>> {
        Some(&mut self.slots.get_mut(slot >> 5)?[slot & 31])
    }

    /// Says that a slot is in use from now on, and when it changes.
    #[inline(always)]
    pub(crate) fn keep(&mut self, slot: usize, plain: bool, event: u16) {
        let word = slot >> 5;
        let one = bit(slot as u32);
        if let (Some(used), Some(set), Some(deep)) = (
            self.used.get_mut(word),
            self.plain.get_mut(word),
            self.deep.get_mut(word),
        ) {
            *used |= one;
            *deep &= !one;
            if plain {
                *set |= one;
            }
        }
        self.await_event(slot, event);
    }

    /// Chains a slot to those that change on a line.
    #[inline(always)]
    pub(crate) fn await_event(&mut self, slot: usize, event: u16) {
        let head = core::mem::replace(&mut self.ring[usize::from(event) % RING], slot as u8);
        if let Some(slot) = self.slot(slot) {
            slot.event = event;
            slot.next = head;
        }
    }

    /// Frees a slot.
    #[inline(always)]
    pub(crate) fn free_slot(&mut self, slot: usize) {
        let word = slot >> 5;
        let one = bit(slot as u32);
        for set in [&mut self.used, &mut self.plain] {
            if let Some(word) = set.get_mut(word) {
                *word &= !one;
            }
        }
    }

    /// The slots that change on `line`: the first of them, to go on with [`after`](Cache::after).
    #[inline(always)]
    pub(crate) fn events(&mut self, line: u16) -> u8 {
        core::mem::replace(&mut self.ring[usize::from(line) % RING], NONE)
    }

    /// The slot after another in a chain of events; `None` where the chain has ended.
    #[inline(always)]
    pub(crate) fn after(&self, slot: u8) -> Option<u8> {
        Some(self.slots.get(usize::from(slot >> 5))?[usize::from(slot & 31)].next)
    }

    /// Puts an object that found no slot into its place among the others.
    #[inline(never)]
    pub(crate) fn spill(&mut self, object: u16, links: &mut [Link]) {
        let new = Link::slow(object);
        let (mut before, mut at) = (Link::NONE, self.spilled);
        while at.is_some() && at.object() < object {
            before = at;
            at = next(links, at);
        }
        if let Some(link) = links.get_mut(usize::from(object)) {
            *link = at;
        }
        self.relink(before, new, links);
    }

    /// Lets what comes after `before`, or first, be `to`.
    #[inline(always)]
    pub(crate) fn relink(&mut self, before: Link, to: Link, links: &mut [Link]) {
        if !before.is_some() {
            self.spilled = to;
        } else if let Some(link) = links.get_mut(usize::from(before.object())) {
            *link = to;
        }
    }
}

/// The object after another among those that found no slot.
#[inline(always)]
pub(crate) fn next(links: &[Link], at: Link) -> Link {
    links
        .get(usize::from(at.object()))
        .copied()
        .unwrap_or(Link::NONE)
}
