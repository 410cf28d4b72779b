//! Status events: what happened while a list ran or a frame was drawn (H14).
//!
//! An event comes as a [`Notice`], which says where, to a
//! closure. It may wake a task, or [raise](EventFlags::raise) a flag of [`EventFlags`], which an interrupt or another
//! core can read.
//! Flags are one `AtomicBool` each and need no compare-and-swap, so that a Cortex-M0+ has them.

use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};

/// A kind of event.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Event {
    /// At least one pixel was given a colour.
    PixelRendered,
    /// A triangle crossed the near, far or guard planes and was cut.
    Clipped,
    /// A pixel passed its depth comparison.
    DepthPassed,
    /// A pixel lost its depth comparison.
    DepthFailed,
    /// The list has ended, or the reader has met the writer.
    ListEnd,
    /// The list asks for an interrupt; the notice's value is the vector, 0 to 255.
    Interrupt,
    /// The list waits to be started again.
    Paused,
    /// What stands before has to be drawn before the list goes on.
    Sync,
    /// A block, or a feature that a block asks for, that the pipeline does not have.
    Unimplemented,
    /// The list reached for what is not its own: master state, another window, other memory.
    AccessViolation,
    /// A block is malformed; the list has stopped.
    Malformed,
    /// An arena or the list's memory was full; the notice's value is how many faces were lost.
    Full,
    /// Triangles are drawn without their texture, as they stretch over more of its texels than they
    /// may; the notice's value is how many.
    Untextured,
}

impl Event {
    /// All kinds, in the order of their bits.
    pub const ALL: [Self; 13] = [
        Self::PixelRendered,
        Self::Clipped,
        Self::DepthPassed,
        Self::DepthFailed,
        Self::ListEnd,
        Self::Interrupt,
        Self::Paused,
        Self::Sync,
        Self::Unimplemented,
        Self::AccessViolation,
        Self::Malformed,
        Self::Full,
        Self::Untextured,
    ];
}

/// A set of kinds: bit `n` for the `n`th of [`Event::ALL`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct EventSet(u32);

impl EventSet {
    /// No kind.
    pub const NONE: Self = Self(0);
    /// Every kind.
    pub const ALL: Self = Self((1 << Event::ALL.len()) - 1);

    /// Those kinds that are told.
    pub(crate) fn of<const N: usize>(told: [(Event, bool); N]) -> Self {
        let told = told.into_iter().filter(|(_, is_told)| *is_told);
        told.fold(Self::NONE, |set, (event, _)| set.with(event))
    }

    /// The set with `event`.
    #[must_use]
    pub const fn with(self, event: Event) -> Self {
        Self(self.0 | 1 << event as u32)
    }

    /// The set without `event`.
    #[must_use]
    pub const fn without(self, event: Event) -> Self {
        Self(self.0 & !(1 << event as u32))
    }

    /// The kinds of both.
    #[must_use]
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Whether `event` is in it.
    #[must_use]
    pub const fn has(self, event: Event) -> bool {
        self.0 >> event as u32 & 1 != 0
    }

    /// Whether it is empty.
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// The kinds in it, in the order of [`Event::ALL`].
    pub fn iter(self) -> impl Iterator<Item = Event> {
        Event::ALL.into_iter().filter(move |e| self.has(*e))
    }
}

/// An event and where it came from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Notice {
    /// What happened.
    pub event: Event,
    /// Byte offset of the block in its list; in a ring, modulo 2^32. 0 where no list is at work.
    pub offset: u32,
    /// What [`Event`] says of its value, else 0.
    pub value: u32,
}

/// Events as flags, each with an enable; one side raises them, one other takes them.
#[derive(Debug)]
pub struct EventFlags {
    raised: [AtomicBool; Event::ALL.len()],
    enabled: AtomicU32,
}

impl EventFlags {
    /// Nothing raised; the kinds of `enabled` can be.
    #[must_use]
    pub const fn new(enabled: EventSet) -> Self {
        Self {
            raised: [const { AtomicBool::new(false) }; Event::ALL.len()],
            enabled: AtomicU32::new(enabled.0),
        }
    }

    /// Lets the kinds of `enabled` through from now on, and no other.
    pub fn enable(&self, enabled: EventSet) {
        self.enabled.store(enabled.0, Ordering::Release);
    }

    /// Raises a flag, where its kind is enabled.
    pub fn raise(&self, event: Event) {
        if EventSet(self.enabled.load(Ordering::Acquire)).has(event) {
            self.raised[event as usize].store(true, Ordering::Release);
        }
    }

    /// The flags that are raised, and lowers them. What is raised again meanwhile is in this set
    /// or in the next: act after taking.
    pub fn take(&self) -> EventSet {
        let mut set = EventSet::NONE;
        for (event, flag) in Event::ALL.into_iter().zip(&self.raised) {
            if flag.load(Ordering::Acquire) {
                flag.store(false, Ordering::Release);
                set = set.with(event);
            }
        }
        set
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_and_bits_agree() {
        for (n, event) in Event::ALL.into_iter().enumerate() {
            assert_eq!(event as usize, n);
            let one = EventSet::NONE.with(event);
            assert_eq!(one.0, 1 << n);
            assert!(one.iter().eq([event]));
            assert!(EventSet::ALL.has(event) && !EventSet::ALL.without(event).has(event));
        }
        assert!(EventSet::NONE.is_empty() && EventSet::NONE.iter().next().is_none());
        assert!(EventSet::ALL.iter().eq(Event::ALL));
    }

    #[test]
    fn flags_are_raised_where_enabled_and_taken_once() {
        let flags = EventFlags::new(EventSet::NONE.with(Event::ListEnd).with(Event::Full));
        flags.raise(Event::ListEnd);
        flags.raise(Event::Sync);
        assert!(flags.take().iter().eq([Event::ListEnd]));
        assert!(flags.take().is_empty());
        flags.enable(EventSet::ALL);
        flags.raise(Event::Sync);
        flags.raise(Event::Sync);
        assert!(flags.take().iter().eq([Event::Sync]));
    }
}
