//! The active list: submission order, cached where there is room (C1-C3, C5-C7).
//!
//! A singly linked list of [`Link`]s. A node is either a slot of the cache, which holds the
//! object set up for drawing and its own `next`, or an object in slow memory, whose `next` is in
//! this renderer's link column (C6); a slow object is set up anew on each line. Walking a line
//! merges what becomes active, moves slow objects into slots that have become free (C5), and
//! takes out what ends (C2). Nothing but the link column is ever written to slow memory.

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

/// How the cache has done since the list was cleared (C8).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CacheCounts {
    /// Object-lines served from the cache.
    pub hits: u32,
    /// Object-lines served from slow memory after the object's first line.
    pub misses: u32,
    /// Objects that found the cache full when they became active.
    pub spills: u32,
    /// Times an object was set up from slow memory.
    pub set_ups: u32,
    /// Links written to slow memory.
    pub link_writes: u32,
    /// Links read from slow memory.
    pub link_reads: u32,
    /// Most slots in use at once.
    pub peak_slots: u32,
}

/// The objects that are active on a line, for one renderer.
#[derive(Debug)]
pub struct ActiveList<'m, T> {
    slots: &'m mut [Slot<T>],
    /// `next` of the objects in slow memory, this renderer's column of them.
    links: &'m mut [Link],
    head: Link,
    free: Link,
    /// What has become active and is not yet merged, in order of submission, linked in `links`.
    incoming: Link,
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

    /// Whether nothing is active.
    pub(crate) fn is_empty(&self) -> bool {
        !self.head.is_some() && !self.incoming.is_some()
    }

    /// Empties the list and the cache, and starts counting anew.
    pub(crate) fn clear(&mut self) {
        self.head = Link::NONE;
        self.incoming = Link::NONE;
        self.free = Link::NONE;
        self.used = 0;
        self.counts = CacheCounts::default();
        for (i, slot) in self.slots.iter_mut().enumerate().rev() {
            slot.next = self.free;
            self.free = Link::cached(i);
        }
    }

    /// Takes in the objects of a bucket, given latest first.
    #[inline]
    pub(crate) fn admit(&mut self, bucket: impl Iterator<Item = u16>) {
        let mut new = Link::NONE;
        for object in bucket {
            if let Some(next) = self.links.get_mut(usize::from(object)) {
                *next = new;
                new = Link::slow(object);
                self.counts.link_writes += 1;
            }
        }
        self.incoming = if self.incoming.is_some() {
            self.merge(self.incoming, new)
        } else {
            new
        };
    }

    /// Merges two lists of slow links.
    fn merge(&mut self, mut a: Link, mut b: Link) -> Link {
        let mut head = Link::NONE;
        let mut last = Link::NONE;
        while a.is_some() || b.is_some() {
            let from = if !b.is_some() || (a.is_some() && a.object() < b.object()) {
                &mut a
            } else {
                &mut b
            };
            let node = *from;
            *from = self.links[usize::from(node.object())];
            if last.is_some() {
                self.links[usize::from(last.object())] = node;
            } else {
                head = node;
            }
            last = node;
        }
        if last.is_some() {
            self.links[usize::from(last.object())] = Link::NONE;
        }
        head
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
        loop {
            // NONE is above every object.
            let new = self.incoming.object();
            if current.is_cached() {
                let index = current.slot();
                match self.slots.get_mut(index) {
                    Some(slot) if slot.object < new => {
                        if slot.body.end() > line {
                            hits += 1;
                            if !visitor.visit(index, slot) {
                                visitor.flush(self.slots);
                                visitor.visit(index, &mut self.slots[index]);
                            }
                        }
                        let slot = &mut self.slots[index];
                        let after = slot.next;
                        if slot.body.end() > next {
                            before = current;
                        } else {
                            released.add(slot, current, index);
                            self.set_next(before, after);
                        }
                        current = after;
                        continue;
                    }
                    None if !self.incoming.is_some() => break,
                    _ => {}
                }
            }
            let is_new = current.is_cached() || new < current.object();
            let (object, after) = if is_new {
                self.incoming = self.links[usize::from(new)];
                (new, current)
            } else {
                let object = current.object();
                self.counts.misses += 1;
                (object, self.links[usize::from(object)])
            };
            self.counts.link_reads += 1;
            self.counts.set_ups += 1;
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
                        released.add(slot, free, free.slot());
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
}

/// Slots that have become free during a walk, chained.
struct Released {
    head: Link,
    /// The slot at the other end of the chain.
    first: usize,
    count: u32,
}

impl Released {
    #[inline]
    fn add<T>(&mut self, slot: &mut Slot<T>, link: Link, index: usize) {
        if self.count == 0 {
            self.first = index;
        }
        slot.next = self.head;
        self.head = link;
        self.count += 1;
    }
}
