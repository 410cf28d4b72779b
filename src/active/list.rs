//! The active list: submission order, cached where there is room (C1-C7).
//!
//! A singly linked list of [`Link`]s. A node is either a slot of the cache, which holds the
//! object set up for drawing and its own `next`, or an object in slow memory, whose `next` is in
//! this renderer's link column (C6); a slow object is set up anew on each line. Before a line is
//! drawn one walk takes out what has ended (C2), merges what becomes active, and moves slow
//! objects into slots that have become free (C5); where nothing of all that is due there is no
//! walk. Nothing but the link column is ever written to slow memory.
//!
//! What becomes active comes from buckets, object by object, so that it can be taken in ahead of
//! its line and with any number of pauses (C4): with a body when it was fetched into a slot, with
//! its link alone when it stays in slow memory. The walk does not care which.
//!
//! Each renderer has its own list, slots and column as `&mut`, so nothing here is shared and no
//! atomics are needed: the compiler refuses two renderers over one column.

use super::slot::{Member, Members, Slot, Visitor};
use crate::link::Link;
use crate::stats::CacheCounts;

/// The objects that are active on a line, for one renderer.
///
/// Every slot is in exactly one of four chains: the active list, `incoming`, `pending` or `free`;
/// `used` is the number of those that are not in `free`.
#[derive(Debug)]
pub struct ActiveList<'m, T> {
    slots: &'m mut [Slot<T>],
    /// `next` of the objects in slow memory, this renderer's column of them.
    links: &'m mut [Link],
    head: Link,
    free: Link,
    /// What has become active and is not yet merged, in order of submission.
    incoming: Link,
    /// What has been taken from a bucket that is not at its end, in order of submission.
    pending: Link,
    used: u32,
    /// Objects of `incoming` and `pending` that are in slow memory.
    waiting: u32,
    /// Objects of the active list that are in slots.
    cached: u32,
    /// Objects of the active list that are in slow memory.
    spilled: u32,
    /// No object of the active list that is in a slot ends above this line.
    first_end: i32,
    /// Something was taken out since the last [`update`](ActiveList::update).
    released: bool,
    pub(crate) counts: CacheCounts,
}

impl<'m, T: Member> ActiveList<'m, T> {
    /// An empty list over a cache and a link column, which may have any length, also 0.
    ///
    /// Slots beyond [`Link::SLOTS`] are not used.
    pub(crate) fn new(slots: &'m mut [Slot<T>], links: &'m mut [Link]) -> Self {
        let count = slots.len().min(Link::SLOTS);
        let mut list = Self {
            slots: &mut slots[..count],
            links,
            head: Link::NONE,
            free: Link::NONE,
            incoming: Link::NONE,
            pending: Link::NONE,
            used: 0,
            waiting: 0,
            cached: 0,
            spilled: 0,
            first_end: i32::MAX,
            released: false,
            counts: CacheCounts::default(),
        };
        list.clear();
        list
    }

    /// The cache.
    #[inline(always)]
    pub(crate) fn slots(&self) -> &[Slot<T>] {
        self.slots
    }

    /// How many objects the link column has room for.
    pub(crate) fn room(&self) -> usize {
        self.links.len()
    }

    /// Whether nothing is active on the line of the last [`update`](ActiveList::update).
    pub(crate) fn is_empty(&self) -> bool {
        !self.head.is_some()
    }

    /// Whether some of what is active has no slot.
    #[inline]
    pub(crate) fn has_spilled(&self) -> bool {
        self.spilled > 0
    }

    /// What is active and in slots, as (slot, object) in order of submission; all there is unless
    /// some [`has_spilled`](ActiveList::has_spilled).
    #[inline(always)]
    pub(crate) fn members(&self) -> Members<'_, T> {
        Members {
            slots: self.slots,
            current: self.head,
        }
    }

    /// Gives `change` all members that are in slots, with their objects.
    pub(crate) fn change_members(&mut self, mut change: impl FnMut(u16, &mut T)) {
        let mut current = self.head;
        while current.is_some() {
            current = match self.slots.get_mut(current.slot()) {
                Some(slot) => {
                    change(slot.object, &mut slot.body);
                    slot.next
                }
                None => self.next(current),
            };
        }
    }

    /// Whether a slot is free.
    pub(crate) fn has_free(&self) -> bool {
        self.free.is_some()
    }

    /// Empties the list and the cache, and starts counting anew.
    #[cold]
    #[inline(never)]
    pub(crate) fn clear(&mut self) {
        self.head = Link::NONE;
        self.incoming = Link::NONE;
        self.pending = Link::NONE;
        self.free = Link::NONE;
        (self.used, self.waiting, self.cached, self.spilled) = (0, 0, 0, 0);
        self.first_end = i32::MAX;
        self.released = false;
        self.counts = CacheCounts::default();
        for (i, slot) in self.slots.iter_mut().enumerate().rev() {
            slot.next = self.free;
            self.free = Link::cached(i);
        }
    }

    /// Takes in the objects of a bucket, or of what is left of it, given latest first.
    #[inline]
    pub(crate) fn admit(&mut self, bucket: impl Iterator<Item = u16>) {
        let mut new = self.pending;
        for object in bucket {
            if let Some(next) = self.links.get_mut(usize::from(object)) {
                *next = new;
                new = Link::slow(object);
                self.waiting += 1;
                self.counts.admitted += 1;
                self.counts.link_writes += 1;
            }
        }
        self.pending = new;
        self.end_bucket();
    }

    /// Takes the next object of a bucket, latest first, into a free slot, where `set_up` sets it
    /// up or says that it ends before this renderer's next line.
    ///
    /// `false` when there is no free slot; then nothing was done.
    pub(crate) fn admit_fetched(
        &mut self,
        object: u16,
        set_up: impl FnOnce(&mut T) -> bool,
    ) -> bool {
        let free = self.free;
        let Some(slot) = self.slots.get_mut(free.slot()) else {
            return false;
        };
        if set_up(&mut slot.body) {
            self.free = core::mem::replace(&mut slot.next, self.pending);
            slot.object = object;
            self.pending = free;
            self.take_count();
            self.counts.fetched += 1;
        } else {
            self.counts.fetched_in_vain += 1;
        }
        true
    }

    /// All objects of the bucket have been taken.
    #[inline]
    pub(crate) fn end_bucket(&mut self) {
        let new = core::mem::take(&mut self.pending);
        self.incoming = if self.incoming.is_some() {
            self.merge(self.incoming, new)
        } else {
            new
        };
    }

    /// Merges two lists by order of submission; most often the second is empty.
    fn merge(&mut self, mut a: Link, mut b: Link) -> Link {
        let mut head = Link::NONE;
        let mut last = Link::NONE;
        while a.is_some() && b.is_some() {
            let from = if self.object(a) < self.object(b) {
                &mut a
            } else {
                &mut b
            };
            let node = *from;
            *from = self.next(node);
            if last.is_some() {
                self.set_next(last, node);
            } else {
                head = node;
            }
            last = node;
        }
        let rest = if a.is_some() { a } else { b };
        if last.is_some() {
            self.set_next(last, rest);
            head
        } else {
            rest
        }
    }

    /// The node after `node`, which is not [`Link::NONE`].
    #[inline]
    fn next(&mut self, node: Link) -> Link {
        if node.is_cached() {
            self.slots[node.slot()].next
        } else {
            self.counts.link_reads += 1;
            self.links[usize::from(node.object())]
        }
    }

    /// Lets the link that leads past `node` lead to `next`.
    #[inline]
    fn set_next(&mut self, node: Link, next: Link) {
        if !node.is_some() {
            self.head = next;
        } else if node.is_cached() {
            self.slots[node.slot()].next = next;
        } else {
            self.links[usize::from(node.object())] = next;
            self.counts.link_writes += 1;
        }
    }

    /// The object of a node, which is not [`Link::NONE`].
    #[inline]
    fn object(&self, node: Link) -> u16 {
        if node.is_cached() {
            self.slots[node.slot()].object
        } else {
            node.object()
        }
    }

    /// One more slot is in use.
    #[inline(always)]
    fn take_count(&mut self) {
        self.used += 1;
        self.counts.peak_slots = self.counts.peak_slots.max(self.used);
    }

    /// Makes the list that of `line`, to be called once for each line that is drawn: takes out
    /// what has ended, merges what has become active, and fills free slots. Whether it may have
    /// changed.
    #[inline]
    pub(crate) fn update(&mut self, line: i32, visitor: &mut impl Visitor<T>) -> bool {
        let released = core::mem::take(&mut self.released);
        // What stays is a hit, and what comes in its slot is one too.
        if self.incoming.is_some() || self.spilled > 0 || line >= self.first_end {
            // Where slots are scarce, those of what has ended have to be free first.
            if self.used + self.waiting + self.spilled > self.slots.len() as u32 {
                self.release(line);
                self.released = false;
            }
            self.merge_incoming(line, visitor);
            true
        } else {
            self.counts.hits += self.cached;
            released
        }
    }

    /// Takes out what has ended above `line`, so that its slots are free; the next
    /// [`update`](ActiveList::update) tells of it.
    pub(crate) fn release(&mut self, line: i32) {
        if line < self.first_end {
            return;
        }
        self.first_end = i32::MAX;
        let mut before = Link::NONE;
        let mut current = self.head;
        while current.is_some() {
            let after = match self.slots.get(current.slot()) {
                Some(slot) => {
                    let (end, after) = (slot.body.end(), slot.next);
                    if end <= line {
                        self.set_next(before, after);
                        self.put_back(current);
                        self.released = true;
                        current = after;
                        continue;
                    }
                    self.first_end = self.first_end.min(end);
                    after
                }
                None => self.next(current),
            };
            before = current;
            current = after;
        }
    }

    /// The walk of [`update`](ActiveList::update).
    #[inline(never)]
    fn merge_incoming(&mut self, line: i32, visitor: &mut impl Visitor<T>) {
        let mut before = Link::NONE;
        let mut current = self.head;
        let mut first_end = i32::MAX;
        // What was in its slot before this line.
        let mut hits = 0;
        loop {
            // The object that heads `incoming`.
            let coming = self.coming();
            // What stays; all locals, so that they stay in registers.
            let slots = &*self.slots;
            let is_new = loop {
                let Some(slot) = slots.get(current.slot()) else {
                    break !current.is_some() || current.object() > coming;
                };
                if slot.object > coming {
                    break true;
                }
                let end = slot.body.end();
                if end <= line {
                    break false;
                }
                first_end = first_end.min(end);
                hits += 1;
                before = current;
                current = slot.next;
            };
            if let (false, Some(slot)) = (is_new, slots.get(current.slot())) {
                // What has ended.
                let after = slot.next;
                self.set_next(before, after);
                self.put_back(current);
                current = after;
                continue;
            }
            if !is_new {
                // In slow memory, and there already.
                let object = current.object();
                let after = self.links[usize::from(object)];
                if !self.free.is_some() {
                    self.counts.link_reads += 1;
                    (before, current) = (current, after);
                    continue;
                }
                // It moves in.
                self.spilled -= 1;
                current = self.move_in(object, before, after, visitor);
                // The walk will count it once more.
                hits -= i32::from(current != after);
                continue;
            }
            if coming == NOTHING {
                break;
            }
            let node = self.incoming;
            if node.is_cached() {
                // Fetched ahead: into the list with it, and on as with any other.
                let slot = &mut self.slots[node.slot()];
                self.incoming = core::mem::replace(&mut slot.next, current);
                self.cached += 1;
                self.counts.fetched_hits += 1;
                self.set_next(before, node);
                current = node;
                continue;
            }
            self.incoming = self.links[usize::from(coming)];
            self.waiting -= 1;
            if self.free.is_some() {
                let after = current;
                current = self.move_in(coming, before, after, visitor);
                hits -= i32::from(current != after);
            } else {
                // It will be set up on each line on which it is drawn.
                self.counts.link_reads += 1;
                self.counts.spills += 1;
                self.spilled += 1;
                self.set_next(node, current);
                self.set_next(before, node);
                before = node;
            }
        }
        self.first_end = first_end;
        self.counts.hits = self.counts.hits.wrapping_add_signed(hits);
    }

    /// Sets `object` up in the first free slot and puts it between `before` and `after`; what
    /// comes after `before` now. That is `after` when the object has ended.
    #[inline]
    fn move_in(
        &mut self,
        object: u16,
        before: Link,
        after: Link,
        visitor: &mut impl Visitor<T>,
    ) -> Link {
        self.counts.misses += 1;
        let node = self.free;
        let mut now = after;
        if let Some(slot) = self.slots.get_mut(node.slot()) {
            if visitor.set_up(object, &mut slot.body) {
                self.free = core::mem::replace(&mut slot.next, after);
                slot.object = object;
                self.cached += 1;
                self.take_count();
                now = node;
            }
        }
        self.set_next(before, now);
        now
    }

    /// Frees the slot of a node that has left the list.
    #[inline]
    fn put_back(&mut self, node: Link) {
        if let Some(slot) = self.slots.get_mut(node.slot()) {
            slot.next = self.free;
            self.free = node;
            self.used -= 1;
            self.cached -= 1;
        }
    }

    /// Gives `visitor` all objects of the line of the last [`update`](ActiveList::update) in
    /// order of submission.
    ///
    /// `next` is the line that will come after: slow objects that end before it leave the list.
    /// `spare` takes objects for which there is no slot.
    pub(crate) fn visit_all(&mut self, next: i32, spare: &mut T, visitor: &mut impl Visitor<T>) {
        let mut before = Link::NONE;
        let mut current = self.head;
        while current.is_some() {
            if let Some(slot) = self.slots.get(current.slot()) {
                visitor.visit_slot(current.slot(), slot.object, &slot.body);
                before = current;
                current = slot.next;
                continue;
            }
            let object = current.object();
            let after = self.links[usize::from(object)];
            self.counts.misses += 1;
            let there = visitor.set_up(object, spare);
            if there {
                visitor.visit(object, spare);
            }
            if there && spare.end() > next {
                before = current;
            } else {
                self.spilled -= 1;
                self.set_next(before, after);
            }
            current = after;
        }
    }

    /// The first object that waits to be merged, [`NOTHING`] if none.
    #[inline]
    fn coming(&self) -> u16 {
        if self.incoming.is_some() {
            self.object(self.incoming)
        } else {
            NOTHING
        }
    }
}

/// Above every object.
const NOTHING: u16 = u16::MAX;

#[cfg(test)]
mod tests;
