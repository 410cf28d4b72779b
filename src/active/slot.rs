//! Slots of the object cache, and what the active list wants of what is in them.

use crate::link::Link;

/// What the list has to know of an object that is set up.
pub trait Member {
    /// The first line below the object.
    fn end(&self) -> i32;
}

/// Sets objects up from slow memory, and takes them one after the other.
pub trait Visitor<T> {
    /// Sets an object up for the line and all below; `false` when it ends above.
    fn set_up(&mut self, object: u16, body: &mut T) -> bool;

    /// An object of the line.
    fn visit(&mut self, object: u16, body: &T);

    /// The same, and in which slot it is.
    #[inline(always)]
    fn visit_slot(&mut self, _slot: usize, object: u16, body: &T) {
        self.visit(object, body);
    }
}

/// A slot of the cache.
#[derive(Clone, Copy, Debug)]
pub struct Slot<T> {
    pub(super) body: T,
    /// The next node of the active list, or the next free slot.
    pub(super) next: Link,
    /// Index of the object in slow memory: its place in the order of submission.
    pub(super) object: u16,
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

    /// Index of the object in slow memory.
    #[inline(always)]
    pub(crate) const fn object(&self) -> u16 {
        self.object
    }
}

/// What is active and in slots: see [`super::ActiveList::members`].
#[derive(Clone, Debug)]
pub(crate) struct Members<'s, T> {
    pub(super) slots: &'s [Slot<T>],
    pub(super) current: Link,
}

impl<'s, T> Iterator for Members<'s, T> {
    type Item = (usize, &'s Slot<T>);

    #[inline(always)]
    fn next(&mut self) -> Option<Self::Item> {
        let index = self.current.slot();
        let slot = self.slots.get(index)?;
        self.current = slot.next;
        Some((index, slot))
    }
}
