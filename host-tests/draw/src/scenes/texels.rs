//! The texels of a scene's objects, in the form that each of them says: words, a palette, compressed blocks read as they
//! are or through a cache, or computed; with holes, or with alphas in a mask.
//!
//! A texture borrows its texels, its levels and its mask, so they are made one after the other: what is in memory
//! ([`Held`]), what reads it ([`Reader`]), the levels below, the texture.

use super::Placed;
use super::store::{Held, Level, Store};
use crate::{DrawFailure, Drawn};
use scanbeam::pixel::{PixelFormat, Rgb565};
use scanbeam::scene::{BlockCache, CacheReads, CacheWord, Compressed, Texture, TextureError};

/// Texels in the cache of a level: 2 KB.
const CACHED: usize = 512;

/// What reads a level.
enum Reader<'h> {
    /// Nothing else than a texture.
    Stored,
    Compressed(Compressed<'h>),
    Cached(BlockCache<'h>),
}

impl<'h> Reader<'h> {
    /// What reads a level, through this cache if it has words.
    fn new<T: PixelFormat<Word = u16>>(
        level: &'h Level,
        key: Option<u16>,
        fast: &'h mut [CacheWord],
    ) -> Result<Self, DrawFailure> {
        let Store::Blocks(bytes) = &level.store else {
            return Ok(Self::Stored);
        };
        let [width, height] = level.sides;
        let word = |number| T::from_rgb8(Rgb565::to_rgb8(number));
        let mut blocks = Compressed::new(bytes, width, height, word).map_err(bad)?;
        if let Some(key) = key {
            blocks = blocks.keyed(key);
        }
        if fast.is_empty() {
            return Ok(Self::Compressed(blocks));
        }
        let cache = BlockCache::compressed(blocks, fast);
        let cache = cache.map_err(|error| DrawFailure::View(error.to_string()))?;
        Ok(Self::Cached(cache))
    }

    /// What its cache did.
    fn reads(&self) -> Option<CacheReads> {
        match self {
            Self::Cached(cache) => Some(cache.reads()),
            Self::Stored | Self::Compressed(_) => None,
        }
    }
}

/// Levels below a picture, and below its mask.
struct Below<'h> {
    texels: Vec<Texture<'h>>,
    mask: Vec<Texture<'h>>,
}

impl Held {
    /// What reads its levels, through caches if there are words for them.
    fn readers<'h, T: PixelFormat<Word = u16>>(
        &'h self,
        fast: &'h mut [Vec<CacheWord>],
    ) -> Result<Vec<Reader<'h>>, DrawFailure> {
        let levels = self.levels.iter().zip(fast);
        levels
            .map(|(level, fast)| Reader::new::<T>(level, self.key, fast))
            .collect()
    }

    /// A level that is read so.
    fn level<'h>(
        &'h self,
        number: usize,
        reader: &'h Reader<'h>,
    ) -> Result<Texture<'h>, TextureError> {
        let level = &self.levels[number];
        let [width, height] = level.sides;
        let texture = match (&level.store, reader) {
            (_, Reader::Compressed(blocks)) => return Ok(blocks.texture()),
            (_, Reader::Cached(cache)) => return Ok(cache.texture()),
            (Store::Words(words), _) => Texture::words(words, width, height),
            (Store::Indices(bytes), _) => Texture::index4(bytes, &self.palette, width, height),
            (Store::Checker(texels), _) => Texture::computed(texels, width, height),
            (Store::Gradient(texels), _) => Texture::computed(texels, width, height),
            // They have a reader.
            (Store::Blocks(_), Reader::Stored) => Ok(Texture::EMPTY),
        }?;
        Ok(match self.key {
            Some(key) => texture.keyed(key),
            None => texture,
        })
    }

    /// What the texels of a level say beside their colours.
    fn mask_level(&self, number: usize) -> Result<Texture<'_>, TextureError> {
        let level = &self.levels[number];
        let [width, height] = level.sides;
        match &level.store {
            Store::Indices(bytes) => Texture::index4(bytes, &self.mask_palette, width, height),
            _ => Texture::words(&level.mask, width, height),
        }
    }

    fn below<'h>(&'h self, readers: &'h [Reader<'h>]) -> Result<Below<'h>, TextureError> {
        let numbers = 1..self.levels.len();
        let texels = numbers.clone().map(|i| self.level(i, &readers[i]));
        let mask = numbers.filter(|_| self.has_mask);
        Ok(Below {
            texels: texels.collect::<Result<_, _>>()?,
            mask: mask.map(|i| self.mask_level(i)).collect::<Result<_, _>>()?,
        })
    }

    fn mask<'h>(&'h self, below: &'h Below<'h>) -> Result<Option<Texture<'h>>, TextureError> {
        if !self.has_mask {
            return Ok(None);
        }
        let mask = self.mask_level(0)?;
        Ok(Some(match self.sampling {
            Some(sampling) => mask.sampled(sampling, &below.mask)?,
            None => mask,
        }))
    }

    fn texture<'h>(
        &'h self,
        reader: &'h Reader<'h>,
        below: &'h Below<'h>,
        mask: Option<&'h Texture<'h>>,
    ) -> Result<Texture<'h>, TextureError> {
        let mut texture = self.level(0, reader)?;
        if let Some(sampling) = self.sampling {
            texture = texture.sampled(sampling, &below.texels)?;
        }
        match mask {
            Some(mask) => texture.masked(mask),
            None => Ok(texture),
        }
    }
}

/// What a texture is refused by.
fn bad(error: TextureError) -> DrawFailure {
    DrawFailure::View(error.to_string())
}

/// Draws with the textures of all parts, whose texels are pixels of the format `T`.
///
/// # Errors
/// Those of `draw`, and of pictures that cannot be had in the form that is asked for.
pub(super) fn with_textures<T: PixelFormat<Word = u16>>(
    parts: &[Placed<'_>],
    draw: impl FnOnce(&[Vec<Texture<'_>>]) -> Result<Drawn, DrawFailure>,
) -> Result<Drawn, DrawFailure> {
    let mut held: Vec<(usize, Held)> = Vec::new();
    for (number, part) in parts.iter().enumerate() {
        for image in part.textures.images() {
            let made = Held::new::<T>(part.item, image);
            let made = made.map_err(|why| DrawFailure::View(format!("object {number}: {why}")))?;
            held.push((number, made));
        }
    }
    let words = |is_cached: bool| {
        let count = if is_cached { CACHED } else { 0 };
        (0..count).map(|_| CacheWord::new()).collect::<Vec<_>>()
    };
    let mut fast: Vec<Vec<Vec<CacheWord>>> = (held.iter())
        .map(|(_, held)| held.levels.iter().map(|_| words(held.is_cached)).collect())
        .collect();
    let readers: Vec<Vec<Reader<'_>>> = (held.iter().zip(&mut fast))
        .map(|((_, held), fast)| held.readers::<T>(fast))
        .collect::<Result<_, _>>()?;
    let below: Vec<Below<'_>> = (held.iter().zip(&readers))
        .map(|((_, held), readers)| held.below(readers).map_err(bad))
        .collect::<Result<_, _>>()?;
    let masks: Vec<Option<Texture<'_>>> = (held.iter().zip(&below))
        .map(|((_, held), below)| held.mask(below).map_err(bad))
        .collect::<Result<_, _>>()?;
    let mut textures: Vec<Vec<Texture<'_>>> = parts.iter().map(|_| Vec::new()).collect();
    for (i, (part, held)) in held.iter().enumerate() {
        let texture = held.texture(&readers[i][0], &below[i], masks[i].as_ref());
        textures[*part].push(texture.map_err(bad)?);
    }
    let mut drawn = draw(&textures)?;
    drawn.texels = readers
        .iter()
        .flatten()
        .filter_map(Reader::reads)
        .reduce(sum);
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
