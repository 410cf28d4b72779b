//! A triangle in a slot of the cache: 64 bytes with smooth colours.

use crate::active::CacheSlot;
use crate::look::Fill;
use crate::span::{Sides, Way};

/// A triangle, set up.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Active<P> {
    pub(super) sides: Sides,
    pub(super) planes: P,
    /// Depth at the picture's first pixel, its steps across and down.
    pub(super) depth: [u32; 3],
}

/// What is known of a triangle in one byte: how it is coloured, how its sides are evaluated, whether it has
/// no plane of depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Flags(pub(super) u8);

/// How many draw calls began up to that of an object in a slot; 0 where nobody has asked, or they are more than 255.
#[inline(always)]
pub(super) fn begun_of<T>(slot: &CacheSlot<T>) -> u8 {
    (slot.known >> 8) as u8
}

impl Flags {
    const VALUES: u8 = 1 << 2;
    const WAY: u32 = 3;
    const NO_DEPTH: u8 = 1 << 6;
    const DEEP: u8 = 1 << 7;

    #[inline(always)]
    pub(super) fn new(fill: Fill, way: Way) -> Self {
        Self(fill as u8 | way.0 << Self::WAY)
    }

    /// Those of what is in a slot.
    #[inline(always)]
    pub(super) fn of<T>(slot: &CacheSlot<T>) -> Self {
        Self(slot.known as u8)
    }

    /// Keeps them in the slot.
    #[inline(always)]
    pub(super) fn keep<T>(self, slot: &mut CacheSlot<T>) {
        slot.known = slot.known & 0xFF00 | u16::from(self.0);
    }

    /// Whether the triangle is drawn in the commonest way.
    #[inline(always)]
    pub(super) fn is_plain(self) -> bool {
        const { assert!(Fill::Plain as u8 == 0) };
        self.0 & (3 | Way::INDIRECT << Self::WAY) == 0
    }

    #[inline(always)]
    pub(super) fn fill(self) -> Fill {
        match self.0 & 3 {
            0 => Fill::Plain,
            1 => Fill::Small,
            2 => Fill::Wide,
            _ => Fill::Thin,
        }
    }

    #[inline(always)]
    pub(super) fn way(self) -> Way {
        Way(self.0 >> Self::WAY & Way::BITS)
    }

    /// Whether its look alone does not colour it: it is thin, or its draw call has values.
    #[inline(always)]
    pub(super) fn is_other(self) -> bool {
        self.0 & (Self::VALUES | 3) >= 3
    }

    /// Whether its look alone colours it, in the commonest way.
    #[inline(always)]
    pub(super) fn is_coloured_plainly(self) -> bool {
        self.0 & (Self::VALUES | 3) == 0
    }

    /// Whether the draw call has values that few have.
    #[inline(always)]
    pub(super) fn has_values(self) -> bool {
        self.0 & Self::VALUES != 0
    }

    pub(super) fn with_values(self) -> Self {
        Self(self.0 | Self::VALUES)
    }

    pub(super) fn with_fill(self, fill: Fill) -> Self {
        Self(self.0 & !3 | fill as u8)
    }

    /// Whether columns need no look at the picture's border, and depth has a plane that is known.
    #[inline(always)]
    pub(super) fn is_usual(self) -> bool {
        self.0 & (Way::INDIRECT << Self::WAY | Self::NO_DEPTH | Self::DEEP) == Self::DEEP
    }

    /// Whether depth has to be found on each line.
    #[inline(always)]
    pub(super) fn lacks_depth(self) -> bool {
        self.0 & Self::NO_DEPTH != 0
    }

    /// Whether the plane of depth is known, or that there is none.
    #[inline(always)]
    pub(super) fn is_deep(self) -> bool {
        self.0 & Self::DEEP != 0
    }

    /// The same with a plane of depth, or without.
    #[inline(always)]
    pub(super) fn with_depth(self, lacks: bool) -> Self {
        let bit = if lacks { Self::NO_DEPTH } else { 0 };
        Self(self.0 & !Self::NO_DEPTH | bit | Self::DEEP)
    }
}
