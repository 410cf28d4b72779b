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
use super::texture::Sides;
use super::{Blocked, Compressed, TexelWay, Texels, Texture};
use core::ops::Range;
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
    /// The texture is computed, or behind a cache, and does not lie in memory. What is compressed has
    /// [a constructor](BlockCache::compressed) of its own.
    Computed,
    /// Texels to be loaded lie beyond the sides of the texture.
    Outside {
        /// The first column or row that is not there.
        side: u32,
        /// The column or row that the range ends before.
        end: u32,
    },
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
            Self::Outside { side, end } => {
                write!(f, "there are {side} columns or rows, not {end}")
            }
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
    /// Blocks that were copied from slow memory because a texel of them was asked for.
    pub misses: u32,
    /// Blocks that were copied ahead, by [`load`](BlockCache::load).
    pub loaded: u32,
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

    /// Puts a texel there, below the upper part of its index and 1.
    #[inline(always)]
    pub(super) fn set(&self, upper: u32, texel: u16) {
        self.0.store(upper << 16 | u32::from(texel), Relaxed);
    }
}

/// Decodes the block of an index: `Compressed::load`.
type Load<'m> = fn(&Compressed<'m>, u32, Blocked, u32, &[CacheWord]) -> u16;

/// Where blocks come from.
#[derive(Debug)]
enum Slow<'m> {
    /// Words or indices, in blocks as the cache has them.
    Stored(Form<'m>),
    /// What has to be decoded, and by which code: a program that names no such texture does not have it.
    Compressed(Compressed<'m>, Load<'m>),
}

/// Blocks of a texture in fast memory.
#[derive(Debug)]
pub struct BlockCache<'m> {
    slow: Slow<'m>,
    /// Those of the texture.
    sides: Sides,
    /// Not larger than the texture.
    block: Blocked,
    /// A power of two.
    words: &'m [CacheWord],
    reads: AtomicU32,
    page_changes: AtomicU32,
    misses: AtomicU32,
    loaded: AtomicU32,
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
        Self::of(Slow::Stored(slow.form), slow.sides, layout, words)
    }

    /// A cache of a compressed texture, whose blocks of 4 x 4 texels are decoded once for all that are read of them. Empty
    /// at first. `words` is a power of two, 16 or more, less for smaller textures.
    ///
    /// # Errors
    /// See [`CacheError`].
    pub fn compressed(
        slow: Compressed<'m>,
        words: &'m mut [CacheWord],
    ) -> Result<Self, CacheError> {
        let sides = slow.sides;
        let slow = Slow::Compressed(slow, Compressed::load);
        Self::of(slow, sides, Blocked::COMPRESSED, words)
    }

    fn of(
        slow: Slow<'m>,
        sides: Sides,
        layout: Blocked,
        words: &'m mut [CacheWord],
    ) -> Result<Self, CacheError> {
        let have = words.len();
        let block = layout.within(sides);
        let needed = (1 << block.log_texels()).max(sides.texels() >> UPPER);
        if have < needed {
            return Err(CacheError::Words { needed, have });
        }
        if !have.is_power_of_two() {
            return Err(CacheError::NotPowerOfTwo { have });
        }
        words.fill_with(CacheWord::new);
        Ok(Self {
            slow,
            sides,
            block,
            words,
            reads: AtomicU32::new(0),
            page_changes: AtomicU32::new(0),
            misses: AtomicU32::new(0),
            loaded: AtomicU32::new(0),
            last: AtomicU32::new(0),
        })
    }

    /// The texture that is read through the cache: it repeats, and has no key but that of what is compressed.
    #[must_use]
    pub fn texture(&self) -> Texture<'_> {
        if let Slow::Compressed(slow, _) = &self.slow {
            return slow.dressed(self);
        }
        Texture::asked(self, self.sides)
    }

    /// Copies blocks ahead of their use, those with a texel in these columns and rows that are not there, row by row of
    /// blocks: `most` of them, and how many these were. So texels that the next lines show are there when they are drawn,
    /// and the time for it is taken where there is some.
    ///
    /// It may be asked again, and goes on where it stopped; 0 says that all are there. Of two blocks that have the same
    /// place in the cache the later one stays: a rectangle of whole rows of blocks has none, as long as the cache is as
    /// large as it.
    ///
    /// # Errors
    /// [`CacheError::Outside`] where a range ends beyond the texture; nothing is copied then.
    pub fn load(
        &self,
        columns: Range<u32>,
        rows: Range<u32>,
        most: u32,
    ) -> Result<u32, CacheError> {
        let [across, down] = [self.sides.log_width, self.sides.log_height];
        for (end, side) in [(columns.end, 1 << across), (rows.end, 1 << down)] {
            if end > side {
                return Err(CacheError::Outside { side, end });
            }
        }
        let [width, height] = [self.block.width(), self.block.height()];
        let mut loaded = 0;
        if columns.is_empty() || rows.is_empty() {
            return Ok(loaded);
        }
        let (left, top) = (columns.start & !(width - 1), rows.start & !(height - 1));
        for row in (top..rows.end).step_by(height as usize) {
            for column in (left..columns.end).step_by(width as usize) {
                let first = self.block.place(column, row, across);
                if self.held(first, self.upper(first)).is_none() {
                    if loaded == most {
                        return Ok(loaded);
                    }
                    self.fill(first, &self.loaded);
                    loaded += 1;
                }
            }
        }
        Ok(loaded)
    }

    /// What has been done so far.
    #[must_use]
    pub fn reads(&self) -> CacheReads {
        CacheReads {
            reads: self.reads.load(Relaxed),
            page_changes: self.page_changes.load(Relaxed),
            misses: self.misses.load(Relaxed),
            loaded: self.loaded.load(Relaxed),
        }
    }

    /// What stands above the texel of an index where it is held: the upper part of the index, and 1.
    #[inline(always)]
    fn upper(&self, index: u32) -> u32 {
        (index >> self.words.len().trailing_zeros()) + 1
    }

    /// The texel of an index, if it is there.
    #[inline(always)]
    fn held(&self, index: u32, upper: u32) -> Option<u16> {
        let word = self.words.get(index as usize & (self.words.len() - 1));
        let word = word.map_or(0, |word| word.0.load(Relaxed));
        (word >> 16 == upper).then_some(word as u16)
    }

    /// Copies the block of an index, and counts it; its texel.
    #[inline(never)]
    fn fill(&self, index: u32, counter: &AtomicU32) -> u16 {
        add(counter, 1);
        let texels = 1u32 << self.block.log_texels();
        let first = index & !(texels - 1);
        let upper = self.upper(index);
        let from = first as usize & (self.words.len() - 1);
        let words = self.words.get(from..from + texels as usize);
        let words = words.unwrap_or_default();
        // Its texel as it was read: in the cache another core may have put another block over it.
        match &self.slow {
            Slow::Compressed(slow, load) => load(slow, index, self.block, upper, words),
            Slow::Stored(Form::Words(slow)) => {
                let block = slow.get(first as usize..).unwrap_or_default();
                for (word, &texel) in words.iter().zip(block) {
                    word.set(upper, texel);
                }
                slow.get(index as usize).copied().unwrap_or_default()
            }
            Slow::Stored(form) => {
                let mut own = 0;
                for (at, word) in (first..).zip(words) {
                    let texel = form.get(at as usize).unwrap_or_default();
                    word.set(upper, texel);
                    if at == index {
                        own = texel;
                    }
                }
                own
            }
        }
    }

    /// The texels of a run, in blocks of this layout, that of the cache. The upper part is found once a block: for each
    /// texel that would take 7 instructions more.
    #[inline(always)]
    fn walk(&self, layout: Blocked, run: &mut [u16], way: TexelWay) {
        add(&self.reads, run.len() as u32);
        let across = self.sides.log_width;
        let (mut last, mut changes) = (self.last.load(Relaxed), 0);
        let mut upper = 0;
        for (pixel, [column, row]) in run.iter_mut().zip(way) {
            let index = layout.place(column.into(), row.into(), across);
            let block = (index >> layout.log_texels()) + 1;
            if block != last || upper == 0 {
                changes += u32::from(block != last);
                (last, upper) = (block, self.upper(index));
            }
            let held = self.held(index, upper);
            *pixel = held.unwrap_or_else(|| self.fill(index, &self.misses));
        }
        self.last.store(last, Relaxed);
        add(&self.page_changes, changes);
    }
}

impl Texels for BlockCache<'_> {
    fn texel(&self, column: u16, row: u16) -> u16 {
        let index = (self.block).place(column.into(), row.into(), self.sides.log_width);
        let block = (index >> self.block.log_texels()) + 1;
        add(&self.reads, 1);
        if self.last.load(Relaxed) != block {
            add(&self.page_changes, 1);
            self.last.store(block, Relaxed);
        }
        let held = self.held(index, self.upper(index));
        held.unwrap_or_else(|| self.fill(index, &self.misses))
    }

    fn fetch(&self, run: &mut [u16], way: TexelWay) {
        // Where shifts are known a texel takes 40 instructions and not 50.
        if self.block == Blocked::COMPRESSED {
            self.walk(Blocked::COMPRESSED, run, way);
        } else {
            self.walk(self.block, run, way);
        }
    }
}

#[cfg(test)]
mod tests;
