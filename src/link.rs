//! Links of 16 bits whose range alone says where they lead (C3).
//!
//! An object in the slow arena has an index below [`Link::CACHED`]; a slot of the cache has one
//! above it. One comparison is the hit test, and to cache an object is to rewrite the link that
//! leads to it.

/// A link to an object in slow memory, to a slot of the cache, or to nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub struct Link(u16);

impl Link {
    /// The first index that is not one of slow memory: there are at most 61,440 objects.
    pub const CACHED: u16 = 0xF000;
    /// The end of a list.
    pub const NONE: Self = Self(0xFFFF);
    /// What fresh memory is filled with: zeros, so that a static takes no flash. Nothing reads a link before it is written.
    pub const EMPTY: Self = Self(0);
    /// How many slots a cache can have: 4,095.
    pub const SLOTS: usize = (0xFFFF - Self::CACHED) as usize;

    /// To the object `index` in slow memory; `index` must be below [`CACHED`](Link::CACHED).
    #[inline(always)]
    pub(crate) const fn slow(index: u16) -> Self {
        debug_assert!(index < Self::CACHED);
        Self(index)
    }

    /// To the slot `index` of the cache; `index` must be below [`SLOTS`](Link::SLOTS).
    #[inline(always)]
    pub(crate) const fn cached(index: usize) -> Self {
        debug_assert!(index < Self::SLOTS);
        Self(Self::CACHED + index as u16)
    }

    /// The object of a slow link.
    #[inline(always)]
    pub(crate) const fn object(self) -> u16 {
        self.0
    }

    /// Whether there is anything at the other end.
    #[inline(always)]
    pub(crate) const fn is_some(self) -> bool {
        self.0 != 0xFFFF
    }
}

impl Default for Link {
    fn default() -> Self {
        Self::NONE
    }
}
