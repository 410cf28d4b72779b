//! The active list: submission order, cached where there is room (C1-C7).
//!
//! A singly linked list of [`Link`]s. A node is either a slot of the cache, which holds the
//! object set up for drawing and its own `next`, or an object in slow memory, whose `next` is in
//! this renderer's link column (C6); a slow object is set up anew on each line. Walking a line
//! merges what becomes active, moves slow objects into slots that have become free (C5), and
//! takes out what ends (C2). Nothing but the link column is ever written to slow memory.
//!
//! What becomes active comes from buckets, object by object, so that it can be taken in ahead of
//! its line and with any number of pauses (C4): with a body when it was fetched into a slot, with
//! its link alone when it stays in slow memory. The walk does not care which.
//!
//! Each renderer has its own list, slots and column as `&mut`, so nothing here is shared and no
//! atomics are needed: the compiler refuses two renderers over one column.

use super::counts::CacheCounts;
use crate::link::Link;

/// What the list has to know of an object that is set up.
pub trait Member {
    /// The first line below the object.
    fn end(&self) -> i32;
}

/// Takes the objects of a line, in order of submission.
pub trait Visitor<T> {
    /// Sets an object up from slow memory; `false` when it ends above the line.
    fn set_up(&mut self, object: u16, body: &mut T) -> bool;

    /// An object in slot `index`, which stays as it is until the walk is over; `false` to be asked
    /// again after [`flush`](Visitor::flush).
    fn visit(&mut self, index: usize, slot: &mut Slot<T>) -> bool;

    /// Makes room for more visits, with all slots at hand.
    fn flush(&mut self, slots: &[Slot<T>]);

    /// An object for which there is no slot, set up for this call alone.
    fn visit_spilled(&mut self, object: u16, body: &mut T, slots: &[Slot<T>]);
}

/// A slot of the cache.
#[derive(Clone, Copy, Debug)]
pub struct Slot<T> {
    body: T,
    /// The next node of the active list, or the next free slot.
    next: Link,
    /// Index of the object in slow memory: its place in the order of submission.
    object: u16,
}

impl<T> Slot<T> {
    /// A slot that holds `body` and is in no list.
    pub(crate) const fn new(body: T) -> Self {
        Self {
            body,
            next: Link::NONE,
            object: 0,
        }
    }

    /// The object, set up.
    #[inline(always)]
    pub(crate) const fn body(&self) -> &T {
        &self.body
    }

    /// The object, set up.
    #[inline(always)]
    pub(crate) const fn body_mut(&mut self) -> &mut T {
        &mut self.body
    }

    /// Index of the object in slow memory.
    #[inline(always)]
    pub(crate) const fn object(&self) -> u16 {
        self.object
    }
}

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

    /// Whether nothing is active, as far as whole buckets were taken in.
    pub(crate) fn is_empty(&self) -> bool {
        !self.head.is_some() && !self.incoming.is_some()
    }

    /// Whether a slot is free.
    pub(crate) fn has_free(&self) -> bool {
        self.free.is_some()
    }

    /// Empties the list and the cache, and starts counting anew.
    pub(crate) fn clear(&mut self) {
        self.head = Link::NONE;
        self.incoming = Link::NONE;
        self.pending = Link::NONE;
        self.free = Link::NONE;
        self.used = 0;
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

    /// Walks the objects of `line` in order of submission.
    ///
    /// `next` is the line that will come after: objects that end before it leave the list, and
    /// their slots are free when the walk is over. `spare` takes objects for which there is no
    /// slot.
    #[inline(always)]
    pub(crate) fn walk(
        &mut self,
        (line, next): (i32, i32),
        spare: &mut T,
        visitor: &mut impl Visitor<T>,
    ) {
        // The node whose link leads to `current`; NONE stands for the head.
        let mut before = Link::NONE;
        let mut current = self.head;
        // Slots that become free are joined to the others afterwards, so that what was visited
        // stays where it is for the whole line.
        let mut released = Released {
            head: Link::NONE,
            first: 0,
            count: 0,
        };
        let mut hits = 0;
        // The object that heads `incoming`.
        let mut coming = self.coming();
        loop {
            if current.is_cached() {
                let index = current.slot();
                match self.slots.get_mut(index) {
                    Some(slot) if slot.object < coming => {
                        let (end, after) = (slot.body.end(), slot.next);
                        if end > line {
                            hits += 1;
                            if !visitor.visit(index, slot) {
                                visitor.flush(self.slots);
                                visitor.visit(index, &mut self.slots[index]);
                            }
                        }
                        if end > next {
                            before = current;
                        } else {
                            released.add(self.slots, current);
                            self.set_next(before, after);
                        }
                        current = after;
                        continue;
                    }
                    None if coming == NOTHING => break,
                    _ => {}
                }
            }
            let is_new = current.is_cached() || coming < current.object();
            let (object, after) = if is_new {
                let node = self.incoming;
                if node.is_cached() {
                    // Fetched ahead: into the list with it, and on as with any other.
                    let slot = &mut self.slots[node.slot()];
                    self.incoming = core::mem::replace(&mut slot.next, current);
                    coming = self.coming();
                    self.counts.fetched_hits += 1;
                    self.set_next(before, node);
                    current = node;
                    continue;
                }
                let object = node.object();
                self.incoming = self.links[usize::from(object)];
                coming = self.coming();
                (object, current)
            } else {
                let object = current.object();
                (object, self.links[usize::from(object)])
            };
            self.counts.misses += 1;
            // The node that stays in the list, if any.
            let mut node = Link::NONE;
            let free = self.free;
            if let Some(slot) = self.slots.get_mut(free.slot()) {
                if visitor.set_up(object, &mut slot.body) {
                    self.free = slot.next;
                    slot.object = object;
                    self.used += 1;
                    self.counts.peak_slots = self.counts.peak_slots.max(self.used);
                    if !visitor.visit(free.slot(), slot) {
                        visitor.flush(self.slots);
                        visitor.visit(free.slot(), &mut self.slots[free.slot()]);
                    }
                    let slot = &mut self.slots[free.slot()];
                    if slot.body.end() > next {
                        slot.next = after;
                        node = free;
                    } else {
                        released.add(self.slots, free);
                    }
                }
            } else if visitor.set_up(object, spare) {
                visitor.visit_spilled(object, spare, self.slots);
                if spare.end() > next {
                    node = Link::slow(object);
                }
            }
            if node.is_some() {
                if is_new && !node.is_cached() {
                    self.counts.spills += 1;
                    self.set_next(node, after);
                }
                if is_new || node.is_cached() {
                    self.set_next(before, node);
                }
                before = node;
            } else if !is_new {
                self.set_next(before, after);
            }
            current = after;
        }
        self.counts.hits += hits;
        if released.count > 0 {
            self.slots[released.first].next = self.free;
            self.free = released.head;
            self.used -= released.count;
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

/// Slots that have become free during a walk, chained.
struct Released {
    head: Link,
    /// The slot at the other end of the chain.
    first: usize,
    count: u32,
}

impl Released {
    #[inline]
    fn add<T>(&mut self, slots: &mut [Slot<T>], link: Link) {
        if let Some(slot) = slots.get_mut(link.slot()) {
            if self.count == 0 {
                self.first = link.slot();
            }
            slot.next = self.head;
            self.head = link;
            self.count += 1;
        }
    }
}

#[cfg(test)]
mod tests;
