//! A small cache of texture blocks in fast memory (B5).
//!
//! Texels lie in blocks of slow memory, and a block is copied into fast memory when one of its texels is asked for. A
//! texel's place there is the lower part of its index, and beside it lies the upper part, so a hit test is one
//! comparison, and a word is right whoever put it there: two cores may read through one cache without a lock. What it
//! costs is counted, and the picture does not depend on it.
//!
//! ```
//! use scanbeam::scene::{BlockCache, Blocked, CacheWord, Texture};
//!
//! // 64 x 64 texels in slow memory, in blocks of 32 bytes; 8 of them fit the cache.
//! let layout = Blocked::of_page(32, 16);
//! let slow = [0; 64 * 64];
//! let mut fast = [const { CacheWord::new() }; 8 * 16];
//! let cache = BlockCache::new(Texture::words(&slow, 64, 64)?, layout, &mut fast)?;
//! let texture = cache.texture().keyed(0xF81F);
//! // For `Skin::texture`; then `cache.reads()` tells what was read.
//! # let _ = texture;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use super::form::Form;
use super::{Blocked, TexelWay, Texels, Texture};
use core::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// Why a cache cannot be made of what was lent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum CacheError {
    /// The number of words is not a power of two.
    NotPowerOfTwo {
        /// The number.
        have: usize,
    },
    /// Fewer words than a block has texels, or than one for each 32,768 texels.
    Words {
        /// Words of the least cache.
        needed: usize,
        /// Words lent.
        have: usize,
    },
    /// The texture is computed, or behind a cache, and does not lie in memory.
    Computed,
}

impl core::fmt::Display for CacheError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("texture cache: ")?;
        match self {
            Self::NotPowerOfTwo { have } => write!(f, "{have} is not a power of two"),
            Self::Words { needed, have } => {
                write!(f, "{needed} words are needed, there are {have}")
            }
            Self::Computed => f.write_str("computed texels do not lie in blocks"),
        }
    }
}

impl core::error::Error for CacheError {}

/// What a cache has done; each count goes on from 0 after 2^32. Of two cores that read at once, one's counts may be lost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CacheReads {
    /// Texels asked for.
    pub reads: u32,
    /// Texels asked for of another block than the one before them. Where a block is a page of memory, so often the page
    /// would change without a cache.
    pub page_changes: u32,
    /// Blocks that were copied from slow memory.
    pub misses: u32,
}

/// A texel in fast memory: 4 bytes.
#[derive(Debug, Default)]
pub struct CacheWord(
    /// The texel, and above it the upper part of its index and 1; 0 for none.
    AtomicU32,
);

impl CacheWord {
    /// Empty: zeros, so that a static takes no flash.
    #[must_use]
    pub const fn new() -> Self {
        Self(AtomicU32::new(0))
    }
}

/// Blocks of a texture in fast memory.
#[derive(Debug)]
pub struct BlockCache<'m> {
    slow: Texture<'m>,
    /// Not larger than the texture.
    block: Blocked,
    /// A power of two.
    words: &'m [CacheWord],
    reads: AtomicU32,
    page_changes: AtomicU32,
    misses: AtomicU32,
    /// The block that was read last, and 1; 0 before the first.
    last: AtomicU32,
}

/// Bits of the upper part of an index.
const UPPER: u32 = 15;

/// The count of something goes on.
fn add(count: &AtomicU32, more: u32) {
    // Not every core can add at once.
    count.store(count.load(Relaxed).wrapping_add(more), Relaxed);
}

impl<'m> BlockCache<'m> {
    /// A cache of the texels of `slow`, which lie in blocks as [`Blocked::arrange`] lays them, or in rows, of which a
    /// block of one row is a part. Empty at first. `words` is a power of two, a block or more.
    ///
    /// Of `slow` the texels and the sides count: wrap, key and levels are for [`texture`](Self::texture).
    ///
    /// # Errors
    /// See [`CacheError`].
    pub fn new(
        slow: Texture<'m>,
        layout: Blocked,
        words: &'m mut [CacheWord],
    ) -> Result<Self, CacheError> {
        if matches!(slow.form, Form::Computed(..)) {
            return Err(CacheError::Computed);
        }
        let have = words.len();
        let block = layout.within(slow.log_width() as u8, slow.log_height() as u8);
        let texels = 1usize << (slow.log_width() + slow.log_height());
        let needed = (1 << block.log_texels()).max(texels >> UPPER);
        if have < needed {
            return Err(CacheError::Words { needed, have });
        }
        if !have.is_power_of_two() {
            return Err(CacheError::NotPowerOfTwo { have });
        }
        words.fill_with(CacheWord::new);
        Ok(Self {
            slow,
            block,
            words,
            reads: AtomicU32::new(0),
            page_changes: AtomicU32::new(0),
            misses: AtomicU32::new(0),
            last: AtomicU32::new(0),
        })
    }

    /// The texture that is read through the cache: it repeats, and has no key.
    #[must_use]
    pub fn texture(&self) -> Texture<'_> {
        let [width, height] = [self.slow.width(), self.slow.height()];
        // Sides of a texture are those of one.
        Texture::computed(self, width, height).unwrap_or(Texture::EMPTY)
    }

    /// What has been done so far.
    #[must_use]
    pub fn reads(&self) -> CacheReads {
        CacheReads {
            reads: self.reads.load(Relaxed),
            page_changes: self.page_changes.load(Relaxed),
            misses: self.misses.load(Relaxed),
        }
    }

    /// The index of a texel.
    #[inline(always)]
    fn index(&self, [column, row]: [u16; 2]) -> u32 {
        let across = self.slow.log_width() as u8;
        self.block.place(column.into(), row.into(), across)
    }

    /// The texel of an index.
    #[inline(always)]
    fn read(&self, index: u32) -> u16 {
        let word = self.words.get(index as usize & (self.words.len() - 1));
        let word = word.map_or(0, |word| word.0.load(Relaxed));
        if word >> 16 == self.upper(index) {
            return word as u16;
        }
        self.fetch_block(index)
    }

    /// The upper part of an index, and 1.
    #[inline(always)]
    fn upper(&self, index: u32) -> u32 {
        (index >> self.words.len().trailing_zeros()) + 1
    }

    /// Copies the block of an index; its texel.
    #[inline(never)]
    fn fetch_block(&self, index: u32) -> u16 {
        add(&self.misses, 1);
        let texels = 1u32 << self.block.log_texels();
        let first = index & !(texels - 1);
        let upper = self.upper(index) << 16;
        let from = first as usize & (self.words.len() - 1);
        let mut read = 0;
        for (index_here, word) in (first..first + texels).zip(&self.words[from..]) {
            let texel = self.slow.form.get(index_here as usize).unwrap_or_default();
            word.0.store(upper | u32::from(texel), Relaxed);
            if index_here == index {
                read = texel;
            }
        }
        read
    }
}

impl Texels for BlockCache<'_> {
    fn texel(&self, column: u16, row: u16) -> u16 {
        let index = self.index([column, row]);
        let block = (index >> self.block.log_texels()) + 1;
        add(&self.reads, 1);
        if self.last.load(Relaxed) != block {
            add(&self.page_changes, 1);
            self.last.store(block, Relaxed);
        }
        self.read(index)
    }

    fn fetch(&self, run: &mut [u16], way: TexelWay) {
        let (mut last, mut changes) = (self.last.load(Relaxed), 0);
        add(&self.reads, run.len() as u32);
        for (pixel, place) in run.iter_mut().zip(way) {
            let index = self.index(place);
            let block = (index >> self.block.log_texels()) + 1;
            changes += u32::from(block != last);
            last = block;
            *pixel = self.read(index);
        }
        self.last.store(last, Relaxed);
        add(&self.page_changes, changes);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::random::Rng;
    use std::vec;
    use std::vec::Vec;

    /// Texels of 64 x 32, all different, in rows and in the blocks of a layout.
    fn texels(layout: Blocked) -> [Vec<u16>; 2] {
        let rows: Vec<u16> = (0..2048).map(|i| (i * 31) as u16).collect();
        let mut blocks = rows.clone();
        layout.arrange([64, 32], &rows, &mut blocks).unwrap();
        [rows, blocks]
    }

    fn words(count: usize) -> Vec<CacheWord> {
        (0..count).map(|_| CacheWord::new()).collect()
    }

    /// Against a model that follows every read.
    ///
    /// Kills: no upper part of the index, one without the 1, a word's place by the block alone, a block that is copied
    /// from its middle on, counts that are not added up.
    #[test]
    fn a_cache_of_any_size_gives_the_same_texels_and_counts_what_it_does() {
        for (log_w, log_h) in [(2, 2), (4, 0), (0, 0), (5, 5)] {
            let layout = Blocked::new(log_w, log_h).unwrap();
            let [rows, blocks] = texels(layout);
            let block = 1usize << (log_w + log_h);
            for slots in [1usize, 2, 8, 2048 / block] {
                // What another cache has left there.
                let mut fast = words(slots * block);
                fast.fill_with(|| CacheWord(AtomicU32::new(1 << 16 | 0xBAD)));
                let slow = Texture::words(&blocks, 64, 32).unwrap();
                let cache = BlockCache::new(slow, layout, &mut fast).unwrap();
                let (mut held, mut last) = (vec![usize::MAX; slots], usize::MAX);
                let (mut rng, mut want) = (Rng(3), CacheReads::default());
                for i in 0..5_000 {
                    let at = [rng.below(64), rng.below(32)].map(|n| n as u16);
                    let number = usize::from(at[1] >> log_h << (6 - log_w) | at[0] >> log_w);
                    want.reads += 1;
                    want.page_changes += u32::from(number != last);
                    want.misses += u32::from(held[number % slots] != number);
                    (held[number % slots], last) = (number, number);
                    let texel = usize::from(at[1]) << 6 | usize::from(at[0]);
                    if i % 2 == 0 {
                        assert_eq!(cache.texel(at[0], at[1]), rows[texel]);
                    } else {
                        let mut pixel = [0];
                        let turn = |n: u16, log: u32| [u32::from(n) << (32 - log), 0];
                        let way = TexelWay::new(turn(at[0], 6), turn(at[1], 5), [6, 5]);
                        cache.fetch(&mut pixel, way);
                        assert_eq!(pixel[0], rows[texel]);
                    }
                    assert_eq!(cache.reads(), want, "{slots} of {block}");
                }
            }
        }
    }

    /// Indices in slow memory are words in fast memory; the largest texture has the least cache.
    #[test]
    fn any_form_and_size_is_read() {
        let bytes: Vec<u8> = (0..1 << 20).map(|i| (i * 7 % 251) as u8).collect();
        let palette: Vec<u16> = (0..256).map(|i| 0x8000 | (i * 3)).collect();
        let slow = Texture::index8(&bytes, &palette, 1024, 1024).unwrap();
        let layout = Blocked::new(4, 0).unwrap();
        let mut fast = words(32);
        let cache = BlockCache::new(slow, layout, &mut fast).unwrap();
        let mut rng = Rng(4);
        for _ in 0..20_000 {
            let [column, row] = [(); 2].map(|()| rng.below(1024));
            let want = palette[usize::from(bytes[(row << 10 | column) as usize])];
            assert_eq!(cache.texel(column as u16, row as u16), want);
        }
    }

    #[test]
    fn what_does_not_fit_is_said() {
        let (texels, layout) = (vec![0; 1 << 20], Blocked::new(2, 2).unwrap());
        let make = |side: u32, count: usize| {
            let mut fast = words(count);
            let slow = Texture::words(&texels, side, side).unwrap();
            BlockCache::new(slow, layout, &mut fast).err()
        };
        assert_eq!(make(64, 48), Some(CacheError::NotPowerOfTwo { have: 48 }));
        let words_error = |needed, have| Some(CacheError::Words { needed, have });
        assert_eq!(make(64, 0), words_error(16, 0));
        assert_eq!(make(64, 8), words_error(16, 8));
        assert_eq!(make(1024, 16), words_error(32, 16));
        // A block is not larger than its texture.
        assert_eq!((make(64, 16), make(2, 4), make(1, 1)), (None, None, None));
        let mut fast = [words(16), words(16)];
        let [first, second] = &mut fast;
        let slow = Texture::words(&texels, 64, 64).unwrap();
        let cache = BlockCache::new(slow, layout, first).unwrap();
        let twice = BlockCache::new(cache.texture(), layout, second);
        assert_eq!(twice.err(), Some(CacheError::Computed));
    }

    /// A slot as two cores leave it that copy two blocks there at once: each word is of either block.
    ///
    /// Kills: a tag for each block in place of one for each word.
    #[test]
    fn words_of_two_blocks_in_one_slot_are_told_apart() {
        let layout = Blocked::new(2, 2).unwrap();
        let [rows, blocks] = texels(layout);
        let slow = Texture::words(&blocks, 64, 32).unwrap();
        // One slot: blocks 0 and 1 are both kept there.
        for mixed in 0..1u32 << 16 {
            if mixed.count_ones() != 1 && mixed % 97 != 0 {
                continue;
            }
            let mut fast = words(16);
            let cache = BlockCache::new(slow, layout, &mut fast).unwrap();
            let words_after = |column: u16| {
                let _ = cache.texel(column, 0);
                let words = cache.words.iter().map(|word| word.0.load(Relaxed));
                words.collect::<Vec<_>>()
            };
            let [first, second] = [words_after(0), words_after(4)];
            for column in [0, 1, 5, 4] {
                for (i, word) in cache.words.iter().enumerate() {
                    let of = [&first, &second][(mixed >> i & 1) as usize];
                    word.0.store(of[i], Relaxed);
                }
                let want = rows[usize::from(column)];
                assert_eq!(cache.texel(column, 0), want, "{mixed:x}");
            }
        }
    }

    /// Two cores at once: each has its texels, whoever copied them.
    #[test]
    fn two_cores_read_through_one_cache() {
        let layout = Blocked::new(2, 2).unwrap();
        let [rows, blocks] = texels(layout);
        let mut fast = words(32);
        let slow = Texture::words(&blocks, 64, 32).unwrap();
        let cache = BlockCache::new(slow, layout, &mut fast).unwrap();
        std::thread::scope(|scope| {
            for seed in [1, 2] {
                let (cache, rows) = (&cache, &rows);
                scope.spawn(move || {
                    let mut rng = Rng(seed);
                    for _ in 0..200_000 {
                        let [column, row] = [rng.below(64), rng.below(32)];
                        let want = rows[(row << 6 | column) as usize];
                        assert_eq!(cache.texel(column as u16, row as u16), want);
                    }
                });
            }
        });
    }
}
