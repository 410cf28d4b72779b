//! The texels of a scene's objects, in the form that each of them says, as words that `scene_flash` reads: words of
//! pixels, a palette, compressed blocks read as they are or through a cache, or computed; with holes, or with alphas in a
//! mask.

use super::Placed;
use super::store::{Held, Level, Store};
use crate::scene_file::Item;
use crate::words::Words;
use crate::{DrawFailure, Drawn, FilterArg, TextureSet};
use scanbeam::pixel::PixelFormat;
use scanbeam::scene::{CacheReads, CacheWord, Texture};
use scene_flash::{CACHED, Reader, Sheet, TextureCounts, TextureMemory, Textures, form};

/// The textures of objects in words.
#[derive(Default)]
pub(crate) struct TextureWords {
    pub(crate) words: Words,
    pub(crate) counts: TextureCounts,
    /// The number of the first one of each object.
    pub(crate) first: Vec<u32>,
}

impl TextureWords {
    /// Those of all objects, whose texels are pixels of the format `T`.
    ///
    /// # Errors
    /// Pictures that cannot be had in the form that is asked for.
    pub(crate) fn of<'i, T: PixelFormat<Word = u16>>(
        objects: impl Iterator<Item = (&'i Item, &'i TextureSet)>,
    ) -> Result<Self, DrawFailure> {
        let mut all = Self::default();
        for (number, (item, set)) in objects.enumerate() {
            all.first.push(all.counts.textures);
            for image in set.images() {
                let held = Held::new::<T>(item, image);
                let held =
                    held.map_err(|why| DrawFailure::View(format!("object {number}: {why}")))?;
                all.texture(&held);
            }
        }
        Ok(all)
    }

    fn texture(&mut self, held: &Held) {
        let flag = |is: bool, bit: u32| if is { bit } else { 0 };
        let levels = held.levels.len() as u32;
        let is_mixed = held.filter == Some(FilterArg::Bilinear);
        let stored = held.levels.first().map_or(0, |level| match level.store {
            Store::Words(_) => 0,
            Store::Indices(_) => form::INDICES,
            Store::Blocks(_) => form::BLOCKS,
            Store::Checker(_) => form::CHECKER,
            Store::Gradient(_) => form::GRADIENT,
        });
        self.words.push(
            levels
                | flag(held.filter.is_some(), form::LEVELLED)
                | flag(is_mixed, form::MIXED)
                | flag(held.key.is_some(), form::KEYED)
                | flag(held.has_mask, form::MASKED)
                | flag(held.is_cached, form::CACHED)
                | stored << form::SHIFT,
        );
        held.key
            .iter()
            .for_each(|key| self.words.push((*key).into()));
        if stored == form::INDICES {
            self.words.halves(held.palette.iter().copied());
            let masks = held.mask_palette.iter().filter(|_| held.has_mask);
            self.words.halves(masks.copied());
        }
        held.levels.iter().for_each(|level| self.level(level));
        let below = levels.saturating_sub(1);
        self.counts.textures += 1;
        self.counts.levels += levels;
        self.counts.others += below + if held.has_mask { 1 + below } else { 0 };
        self.counts.caches += if held.is_cached { levels } else { 0 };
    }

    fn level(&mut self, level: &Level) {
        let words = &mut self.words;
        let [width, height] = level.sides;
        words.push(width | height << 16);
        match &level.store {
            Store::Words(texels) => words.halves(texels.iter().copied()),
            Store::Indices(bytes) => words.bytes(bytes.iter().copied()),
            Store::Blocks(bytes) => {
                words.push(bytes.len() as u32);
                words.bytes(bytes.iter().copied());
            }
            Store::Checker(squares) => {
                words.halves(squares.colours.into_iter());
                words.push(squares.log_side.into());
            }
            Store::Gradient(gradient) => {
                words.colour(gradient.from);
                words.colour(gradient.to);
                words.push(gradient.log_length.into());
            }
        }
        words.halves(level.mask.iter().copied());
    }
}

/// Draws with the textures of all parts, whose texels are pixels of the format `T`.
///
/// # Errors
/// Those of `draw`, and of pictures that cannot be had in the form that is asked for.
pub(super) fn with_textures<T: PixelFormat<Word = u16>>(
    parts: &[Placed<'_>],
    draw: impl FnOnce(&[&[Texture<'_>]]) -> Result<Drawn, DrawFailure>,
) -> Result<Drawn, DrawFailure> {
    let objects = parts.iter().map(|part| (part.item, part.textures));
    let laid = TextureWords::of::<T>(objects)?;
    let counts = laid.counts;
    let mut cached: Vec<CacheWord> = (0..CACHED * counts.caches as usize)
        .map(|_| CacheWord::new())
        .collect();
    let mut levels: Vec<_> = (0..counts.levels)
        .map(|_| scene_flash::Level::EMPTY)
        .collect();
    let lent = TextureMemory {
        sheets: &mut vec![Sheet::EMPTY; counts.textures as usize],
        levels: &mut levels,
        textures: &mut vec![Texture::EMPTY; counts.textures as usize],
        others: &mut vec![Texture::EMPTY; counts.others as usize],
        cached: &mut cached,
    };
    let textures = Textures::read::<T>(&mut Reader::new(laid.words.all(), 0), lent);
    let textures = textures.map_err(|error| DrawFailure::View(error.to_string()))?;
    let ends = laid.first.iter().skip(1).copied().chain([counts.textures]);
    let of = |(first, end): (&u32, u32)| &textures.all[*first as usize..end as usize];
    let by_object: Vec<&[Texture<'_>]> = laid.first.iter().zip(ends).map(of).collect();
    let mut drawn = draw(&by_object)?;
    drawn.texels = textures.reads().reduce(sum);
    Ok(drawn)
}

/// What two caches did.
fn sum(a: CacheReads, b: CacheReads) -> CacheReads {
    CacheReads {
        reads: a.reads.wrapping_add(b.reads),
        page_changes: a.page_changes.wrapping_add(b.page_changes),
        misses: a.misses.wrapping_add(b.misses),
        loaded: a.loaded.wrapping_add(b.loaded),
    }
}
