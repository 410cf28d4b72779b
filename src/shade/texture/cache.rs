//! A small cache of texture blocks in fast memory (B5).
//!
//! One slot for each residue of a block's number, so a hit test is one comparison. Texels of a
//! blocked layout are read through it as from any [`Store`]; what it costs is counted, and the
//! picture does not depend on it. Neighbours mostly lie in one block: a run keeps the slot of the
//! last texel at hand, and adds up its reads at its end.
//!
//! Scene B of the firmware without light takes 4.92 million instructions on a Cortex-M4 through 32
//! blocks of 32 bytes, 3.48 from a square of 128 texels a side in one piece.
//!
//! A pipeline reads its textures through a cache where their store is one:
//!
//! ```
//! use scanbeam::pipeline::texture::{
//!     BlockCache, Blocked, CacheReads, Size, Texture, Textures, Words, Wrap,
//! };
//! use scanbeam::pipeline::{Pipeline, TexturedDepth};
//! use scanbeam::pixel::Rgb565Be;
//!
//! type Cached<'t> = Texture<BlockCache<'t, Words<'t, u16>>, Wrap, Blocked>;
//! type Look<'t> = TexturedDepth<'t, Rgb565Be, Cached<'t>>;
//!
//! // 64 x 64 texels in slow memory, in blocks of 32 bytes; 8 of them fit the cache.
//! let size = Size::new(64, 64).unwrap();
//! let layout = Blocked::of_page(32, 16);
//! let slow = [0u16; 64 * 64];
//! let (mut tags, mut texels) = ([0; 8], [0; 8 * 16]);
//! let mut reads = CacheReads::default();
//! let cache = BlockCache::new(Words(&slow[..]), 16, &mut tags, &mut texels, &mut reads).unwrap();
//! let textures = [Cached::arranged(cache, size, layout).unwrap()];
//! // For `Scene::<Look>::set_textures`; `cache.reads()` tells what was read.
//! let lent: <Look<'_> as Pipeline>::Textures = Textures(&textures);
//! ```
//!
//! One core alone may read through a cache, so a scene of such textures cannot be shared:
//!
//! ```compile_fail,E0277
//! use scanbeam::pipeline::texture::{BlockCache, Blocked, Texture, Words, Wrap};
//! use scanbeam::pipeline::TexturedDepth;
//! use scanbeam::pixel::Rgb565Be;
//! use scanbeam::pipeline::Scene;
//!
//! type Cached<'t> = Texture<BlockCache<'t, Words<'t, u16>>, Wrap, Blocked>;
//! fn shared<T: Sync>() {}
//! shared::<Scene<'static, TexturedDepth<'static, Rgb565Be, Cached<'static>>>>();
//! ```

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

/// What a cache has done; each count goes on from 0 after 2^32.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CacheReads {
    /// Texels asked for.
    pub reads: u32,
    /// Texels asked for of another block than the one before them. Where a block is a page of
    /// memory, so often the page would change without a cache.
    pub page_changes: u32,
    /// Blocks that were copied from slow memory.
    pub misses: u32,
    /// The block that was read last, and 1; 0 before the first.
    last: u32,
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

    /// The number of the block that holds a texel, below [`NONE`].
    #[inline(always)]
    fn block(&self, index: usize) -> u32 {
        (index >> self.log_block) as u32
    }

    /// The slot of a block.
    #[inline(always)]
    fn slot(&self, block: u32) -> usize {
        block as usize & (self.tags.len() - 1)
    }

    /// The index of a texel within its block.
    #[inline(always)]
    fn inside(&self, index: usize) -> usize {
        index & ((1 << self.log_block) - 1)
    }

    /// The index of a texel. A store of 2^n texels wraps; block numbers must not differ for the
    /// same texel.
    #[inline(always)]
    fn wrapped(&self, index: usize) -> usize {
        index & self.slow.count().wrapping_sub(1)
    }

    /// Tag and texels of the slot that a block belongs to.
    #[inline(always)]
    fn at(&self, block: u32) -> (&'m Cell<u32>, &'m [Cell<S::Texel>]) {
        let slot = self.slot(block);
        let from = slot << self.log_block;
        let texels = self.texels.get(from..from + (1 << self.log_block));
        (&self.tags[slot], texels.unwrap_or_default())
    }

    /// Goes on to another block than that of the read before, copied if it is not here; its tag
    /// and texels.
    #[inline(never)]
    fn turn(&self, block: u32) -> (&'m Cell<u32>, &'m [Cell<S::Texel>]) {
        let (tag, texels) = self.at(block);
        let mut reads = self.reads.get();
        reads.page_changes = reads.page_changes.wrapping_add(1);
        reads.last = block.wrapping_add(1);
        if tag.get() != block {
            reads.misses = reads.misses.wrapping_add(1);
            tag.set(block);
            let from = (block as usize) << self.log_block;
            for (index, texel) in (from..).zip(texels) {
                texel.set(self.slow.fetch(index));
            }
        }
        self.reads.set(reads);
        (tag, texels)
    }
}

/// The reads of a run: the slot of the last one is at hand.
struct Run<'c, 'm, S: Store> {
    cache: &'c BlockCache<'m, S>,
    tag: &'m Cell<u32>,
    /// The block of the tag.
    texels: &'m [Cell<S::Texel>],
    reads: u32,
}

impl<'c, 'm, S: Store> Run<'c, 'm, S> {
    #[inline(always)]
    fn new(cache: &'c BlockCache<'m, S>) -> Self {
        // Before the first read all slots are empty, and none is taken for that of a block.
        let (tag, texels) = cache.at(cache.reads.get().last.wrapping_sub(1));
        Self {
            cache,
            tag,
            texels,
            reads: 0,
        }
    }

    /// The texel at an index. The tag is looked at each time, as somebody else may have read through
    /// the same cache meanwhile.
    #[inline(always)]
    fn read(&mut self, index: usize) -> S::Texel {
        let index = self.cache.wrapped(index);
        let block = self.cache.block(index);
        if self.tag.get() != block {
            (self.tag, self.texels) = self.cache.turn(block);
        }
        self.reads = self.reads.wrapping_add(1);
        match self.texels.get(self.cache.inside(index)) {
            Some(texel) => texel.get(),
            None => self.cache.slow.fetch(index),
        }
    }
}

impl<S: Store> Drop for Run<'_, '_, S> {
    #[inline(always)]
    fn drop(&mut self) {
        let mut reads = self.cache.reads.get();
        reads.reads = reads.reads.wrapping_add(self.reads);
        self.cache.reads.set(reads);
    }
}

impl<S: Store> Store for BlockCache<'_, S> {
    type Texel = S::Texel;
    const LONG: bool = true;

    fn count(&self) -> usize {
        self.slow.count()
    }

    #[inline(always)]
    fn fetch(&self, index: usize) -> S::Texel {
        let index = self.wrapped(index);
        let block = self.block(index);
        // The block that was read last is in its slot.
        if self.reads.get().last != block.wrapping_add(1) {
            self.turn(block);
        }
        let mut reads = self.reads.get();
        reads.reads = reads.reads.wrapping_add(1);
        self.reads.set(reads);
        let at = self.slot(block) << self.log_block | self.inside(index);
        match self.texels.get(at) {
            Some(texel) => texel.get(),
            None => self.slow.fetch(index),
        }
    }

    #[inline(always)]
    fn reader(&self) -> impl FnMut(usize) -> S::Texel {
        let mut run = Run::new(self);
        move |index| run.read(index)
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
            // 128 blocks, at random: some 127 of 128 reads go to another one.
            assert!((4_900..5_000).contains(&done.page_changes), "{done:?}");
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
