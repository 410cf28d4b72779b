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

    /// Whether it has to be set up again for `line`, having been drawn on `last` before.
    fn stale(&self, last: i32, line: i32) -> bool;
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
    /// The first line that a fetched object, which was not walked yet, was made for.
    made_for: i32,
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
            made_for: i32::MAX,
            counts: CacheCounts::default(),
        };
        list.clear();
        list
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
        self.made_for = i32::MAX;
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

    /// Takes the next object of a bucket, latest first, into a free slot; `body` is its set-up for
    /// `line`.
    ///
    /// Without a free slot it is left in slow memory.
    pub(crate) fn admit_fetched(&mut self, object: u16, line: i32, body: T) {
        self.made_for = self.made_for.min(line);
        let next = self.pending;
        if let Some(node) = self.take_slot(object, body, next) {
            self.pending = node;
            self.counts.fetched += 1;
        } else if let Some(link) = self.links.get_mut(usize::from(object)) {
            *link = next;
            self.pending = Link::slow(object);
            self.counts.link_writes += 1;
            self.counts.admitted += 1;
        }
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

    /// Fills a free slot, if there is one.
    #[inline(always)]
    fn take_slot(&mut self, object: u16, body: T, next: Link) -> Option<Link> {
        if !self.free.is_some() {
            return None;
        }
        let node = self.free;
        let slot = &mut self.slots[node.slot()];
        self.free = slot.next;
        *slot = Slot { body, next, object };
        self.used += 1;
        self.counts.peak_slots = self.counts.peak_slots.max(self.used);
        Some(node)
    }

    /// Walks the objects of `line` in order of submission.
    ///
    /// `last` is the line walked before and `next` the line that will come after: objects that
    /// end at or above `next` leave the list, and their slots are free at once, so no line
    /// between `line` and `next` can be walked any more. `make` sets an object up from slow
    /// memory; `visit` draws it.
    #[inline]
    pub(crate) fn walk(
        &mut self,
        (last, line, next): (i32, i32, i32),
        mut make: impl FnMut(u16) -> Option<T>,
        mut visit: impl FnMut(u16, &T),
    ) {
        // The node whose link leads to `current`; NONE stands for the head.
        let mut before = Link::NONE;
        let mut current = self.head;
        // The object that heads `incoming`; read once for each that comes in.
        let mut coming = self.coming();
        // The line before which `current` was good for the last time.
        let mut since = last;
        loop {
            let is_new = match coming {
                Some(object) => !current.is_some() || object < self.object(current),
                None => false,
            };
            if !is_new && current.is_cached() {
                if !current.is_some() {
                    break;
                }
                let index = current.slot();
                let slot = &mut self.slots[index];
                if slot.body.end() > line {
                    if slot.body.stale(since, line) {
                        if let Some(body) = make(slot.object) {
                            slot.body = body;
                            self.counts.set_ups += 1;
                        }
                    }
                    visit(slot.object, &slot.body);
                    self.counts.hits += 1;
                }
                since = last;
                let after = slot.next;
                if slot.body.end() > next {
                    before = current;
                } else {
                    slot.next = self.free;
                    self.free = current;
                    self.used -= 1;
                    self.set_next(before, after);
                }
                current = after;
                continue;
            }
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
                    since = self.made_for;
                    continue;
                }
                self.incoming = self.links[usize::from(node.object())];
                coming = self.coming();
                (node.object(), current)
            } else {
                let object = current.object();
                (object, self.links[usize::from(object)])
            };
            self.counts.misses += 1;
            let kept = match make(object) {
                Some(body) => {
                    if body.end() > line {
                        visit(object, &body);
                    }
                    (body.end() > next).then_some(body)
                }
                None => None,
            };
            let node = match kept {
                Some(body) => match self.take_slot(object, body, after) {
                    Some(node) => {
                        self.set_next(before, node);
                        node
                    }
                    None => {
                        let node = Link::slow(object);
                        if is_new {
                            self.counts.spills += 1;
                            self.set_next(node, after);
                            self.set_next(before, node);
                        }
                        node
                    }
                },
                None => {
                    if !is_new {
                        self.set_next(before, after);
                    }
                    before
                }
            };
            before = node;
            current = after;
        }
        self.made_for = i32::MAX;
    }

    /// The first object that waits to be merged.
    #[inline]
    fn coming(&self) -> Option<u16> {
        self.incoming.is_some().then(|| self.object(self.incoming))
    }
}

#[cfg(test)]
mod tests;
