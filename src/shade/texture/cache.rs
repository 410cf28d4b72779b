//! A small cache of texture blocks in fast memory (B5).
//!
//! One slot for each residue of a block's number, so a hit test is one comparison. Texels of a
//! blocked layout are read through it as from any [`Store`]; what it costs is counted, and the
//! picture does not depend on it.

use super::tlut::Store;
use core::cell::Cell;

/// Why a cache cannot be made of what was lent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum CacheError {
    /// The number of slots, or of texels a block, is not a power of two.
    NotPowerOfTwo {
        /// The number.
        have: usize,
    },
    /// Fewer words than slots times texels a block.
    Words {
        /// Words of all slots.
        needed: usize,
        /// Words lent.
        have: usize,
    },
}

impl core::fmt::Display for CacheError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::NotPowerOfTwo { have } => {
                write!(f, "texture cache: {have} is not a power of two")
            }
            Self::Words { needed, have } => {
                write!(
                    f,
                    "texture cache: {needed} words are needed, there are {have}"
                )
            }
        }
    }
}

impl core::error::Error for CacheError {}

/// What a cache has done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CacheReads {
    /// Texels asked for.
    pub reads: u32,
    /// Blocks that were copied from slow memory.
    pub misses: u32,
}

/// No block.
const NONE: u32 = u32::MAX;

/// Blocks of `S` in fast memory.
#[derive(Debug)]
pub struct BlockCache<'m, S: Store> {
    slow: S,
    /// The block in each slot.
    tags: &'m [Cell<u32>],
    texels: &'m [Cell<S::Texel>],
    /// Texels a block, a power of two.
    log_block: u32,
    reads: &'m Cell<CacheReads>,
}

impl<S: Store> Clone for BlockCache<'_, S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: Store> Copy for BlockCache<'_, S> {}

impl<'m, S: Store> BlockCache<'m, S> {
    /// A cache of as many slots as there are `tags`, each with a block of `block` texels, which
    /// is a block of the texture's layout. Empty at first.
    ///
    /// # Errors
    /// When a number is not a power of two, or there are too few words.
    pub fn new(
        slow: S,
        block: usize,
        tags: &'m mut [u32],
        texels: &'m mut [S::Texel],
        reads: &'m mut CacheReads,
    ) -> Result<Self, CacheError> {
        for have in [block, tags.len()] {
            if !have.is_power_of_two() {
                return Err(CacheError::NotPowerOfTwo { have });
            }
        }
        let (needed, have) = (block.saturating_mul(tags.len()), texels.len());
        if have < needed {
            return Err(CacheError::Words { needed, have });
        }
        tags.fill(NONE);
        *reads = CacheReads::default();
        Ok(Self {
            slow,
            tags: Cell::from_mut(tags).as_slice_of_cells(),
            texels: Cell::from_mut(texels).as_slice_of_cells(),
            log_block: block.trailing_zeros(),
            reads: Cell::from_mut(reads),
        })
    }

    /// What has been done so far.
    #[must_use]
    pub fn reads(&self) -> CacheReads {
        self.reads.get()
    }

    #[cold]
    #[inline(never)]
    fn load(&self, block: usize, slot: usize) {
        let (from, to) = (block << self.log_block, slot << self.log_block);
        for i in 0..1 << self.log_block {
            if let Some(texel) = self.texels.get(to + i) {
                texel.set(self.slow.fetch(from + i));
            }
        }
    }
}

impl<S: Store> Store for BlockCache<'_, S> {
    type Texel = S::Texel;

    fn count(&self) -> usize {
        self.slow.count()
    }

    #[inline(always)]
    fn fetch(&self, index: usize) -> S::Texel {
        // A store of 2^n texels wraps; block numbers must not differ for the same texel.
        let index = index & self.slow.count().wrapping_sub(1);
        let block = index >> self.log_block;
        let slot = block & (self.tags.len() - 1);
        let mut reads = self.reads.get();
        reads.reads += 1;
        if let Some(tag) = self.tags.get(slot).filter(|tag| tag.get() != block as u32) {
            reads.misses += 1;
            tag.set(block as u32);
            self.load(block, slot);
        }
        self.reads.set(reads);
        let inside = index & ((1 << self.log_block) - 1);
        match self.texels.get(slot << self.log_block | inside) {
            Some(texel) => texel.get(),
            None => self.slow.fetch(index),
        }
    }

    fn fetch_in<const N: usize>(&self) -> Option<impl Fn(usize) -> S::Texel + Copy> {
        // Always by way of the tags.
        None::<fn(usize) -> S::Texel>
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Blocked, Size, Texels, Texture, Uv, Words, Wrap};
    use super::*;
    use crate::num::random::Rng;
    use std::vec;

    #[test]
    fn a_cache_of_any_size_gives_the_same_texels() {
        let size = Size::new(64, 32).unwrap();
        let layout = Blocked::new(2, 2).unwrap();
        let words: vec::Vec<u16> = (0..2048).map(|i| (i * 31) as u16).collect();
        let plain = Texture::<_, Wrap, _>::arranged(Words(&words), size, layout).unwrap();
        for slots in [1usize, 2, 8, 128] {
            let mut tags = vec![0; slots];
            let mut texels = vec![0; 16 * slots];
            let mut reads = CacheReads::default();
            let cache =
                BlockCache::new(Words(&words), 16, &mut tags, &mut texels, &mut reads).unwrap();
            let cached = Texture::<_, Wrap, _>::arranged(cache, size, layout).unwrap();
            let mut rng = Rng(3);
            for _ in 0..5_000 {
                let place = Uv {
                    u: rng.below(u32::MAX) as i32,
                    v: rng.below(u32::MAX) as i32,
                };
                assert_eq!(cached.at(place), plain.at(place));
            }
            let done = cache.reads();
            assert_eq!(done.reads, 5_000);
            if slots == 128 {
                assert_eq!(done.misses, 128, "each block once");
            } else {
                assert!(done.misses > 2_000, "{done:?}");
            }
        }
    }

    #[test]
    fn what_does_not_fit_is_said() {
        let words = [0u8; 64];
        let mut reads = CacheReads::default();
        let mut make = |block, tags: usize, texels: usize| {
            BlockCache::new(
                Words(&words),
                block,
                &mut vec![0; tags],
                &mut vec![0; texels],
                &mut reads,
            )
            .map(|_| ())
        };
        assert_eq!(make(3, 2, 6), Err(CacheError::NotPowerOfTwo { have: 3 }));
        assert_eq!(make(4, 0, 6), Err(CacheError::NotPowerOfTwo { have: 0 }));
        assert_eq!(make(4, 2, 7), Err(CacheError::Words { needed: 8, have: 7 }));
        assert_eq!(make(4, 2, 8), Ok(()));
    }
}
