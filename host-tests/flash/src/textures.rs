//! Textures in words, of each:
//!
//! 1. its first word, by [`form`],
//! 2. the word of its holes, where it has any,
//! 3. of indices, 16 colours; where it has a mask, what that says of each,
//! 4. its levels: the sides, what [`Texels`] says, and of words what a mask says of each texel.

use crate::reader::{FlashError, Reader};
use scanbeam::pixel::{PixelFormat, Rgb565};
use scanbeam::scene::{
    BlockCache, CacheReads, CacheWord, Checker, Compressed, Gradient, Sampling, Texels, Texture,
    TextureError,
};

/// Texels in the cache of a level: 2 KB.
pub const CACHED: usize = 512;
/// Colours of a palette.
const COLOURS: usize = 16;

/// How the first word of a texture is written, beside how many levels there are.
pub mod form {
    /// Where the number of levels ends.
    pub const LEVELS: u32 = 0xFF;
    /// The nearest texel is taken of the level that fits.
    pub const LEVELLED: u32 = 1 << 8;
    /// Texels are mixed.
    pub const MIXED: u32 = 1 << 9;
    /// There is a word of holes.
    pub const KEYED: u32 = 1 << 10;
    /// A mask says how opaque texels are.
    pub const MASKED: u32 = 1 << 11;
    /// Blocks are read through a cache.
    pub const CACHED: u32 = 1 << 12;
    /// The lowest bit of the form: words of the panel are 0.
    pub const SHIFT: u32 = 16;
    /// Indices of 4 bits, the left one of a byte lowest.
    pub const INDICES: u32 = 1;
    /// How many bytes there are, and compressed blocks.
    pub const BLOCKS: u32 = 2;
    /// Squares: two words of the panel in one, and the power of two of a side.
    pub const CHECKER: u32 = 3;
    /// From a colour to another: both, and the power of two of the columns between them.
    pub const GRADIENT: u32 = 4;
}

/// How many there are of what.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TextureCounts {
    /// Textures.
    pub textures: u32,
    /// Their levels, the first of each among them.
    pub levels: u32,
    /// Levels below the first, masks, and levels below these.
    pub others: u32,
    /// Levels with a cache.
    pub caches: u32,
}

/// A texture, without its levels.
#[derive(Clone, Copy, Debug)]
pub struct Sheet<'t> {
    levels: usize,
    sampling: Option<Sampling>,
    key: Option<u16>,
    has_mask: bool,
    palette: &'t [u16],
    mask_palette: &'t [u16],
}

/// A level of a texture.
#[derive(Debug)]
pub struct Level<'t> {
    sides: [u32; 2],
    store: Store<'t>,
    mask: &'t [u16],
}

/// Texels, or what makes them.
enum Store<'t> {
    Words(&'t [u16]),
    Indices(&'t [u8]),
    Checker(Checker),
    Gradient(Gradient),
    Compressed(Compressed<'t>),
    Cached(BlockCache<'t>),
}

impl core::fmt::Debug for Store<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::Words(_) => "words",
            Self::Indices(_) => "indices",
            Self::Checker(_) => "squares",
            Self::Gradient(_) => "a gradient",
            Self::Compressed(_) => "blocks",
            Self::Cached(_) => "blocks in a cache",
        })
    }
}

/// What textures are read into: as many of each as [`TextureCounts`] says.
pub struct TextureMemory<'t> {
    /// Textures, without their levels.
    pub sheets: &'t mut [Sheet<'t>],
    /// Levels.
    pub levels: &'t mut [Level<'t>],
    /// Textures.
    pub textures: &'t mut [Texture<'t>],
    /// What textures have beside themselves.
    pub others: &'t mut [Texture<'t>],
    /// [`CACHED`] of each cache, of fast memory.
    pub cached: &'t mut [CacheWord],
}

/// Textures that were read.
#[derive(Clone, Copy, Debug)]
pub struct Textures<'t> {
    /// By their numbers.
    pub all: &'t [Texture<'t>],
    levels: &'t [Level<'t>],
}

impl<'t> Sheet<'t> {
    /// One for memory that is to be lent.
    pub const EMPTY: Self = Self {
        levels: 0,
        sampling: None,
        key: None,
        has_mask: false,
        palette: &[],
        mask_palette: &[],
    };

    /// The texture of these levels.
    fn texture(
        &self,
        levels: &'t [Level<'t>],
        others: &mut &'t mut [Texture<'t>],
    ) -> Result<Texture<'t>, FlashError> {
        let [first, below @ ..] = levels else {
            return Err(FlashError::Lent);
        };
        let texture = first.texture(self);
        let texture = self.sampled(texture, below, others, |level| level.texture(self))?;
        if !self.has_mask {
            return Ok(texture);
        }
        let mask = first.masks(self);
        let mask = self.sampled(mask, below, others, |level| level.masks(self))?;
        let own = take(others, 1)?;
        own.fill(mask);
        let own = own.first().ok_or(FlashError::Lent)?;
        Ok(texture.masked(own)?)
    }

    /// A first level with those below it.
    fn sampled(
        &self,
        first: Result<Texture<'t>, TextureError>,
        below: &'t [Level<'t>],
        others: &mut &'t mut [Texture<'t>],
        of: impl Fn(&'t Level<'t>) -> Result<Texture<'t>, TextureError>,
    ) -> Result<Texture<'t>, FlashError> {
        let own = take(others, below.len())?;
        for (slot, level) in own.iter_mut().zip(below) {
            *slot = of(level)?;
        }
        Ok(match self.sampling {
            Some(sampling) => first?.sampled(sampling, own)?,
            None => first?,
        })
    }
}

/// The first of what is lent.
fn take<'t, T>(lent: &mut &'t mut [T], count: usize) -> Result<&'t mut [T], FlashError> {
    let (own, rest) = core::mem::take(lent)
        .split_at_mut_checked(count)
        .ok_or(FlashError::Lent)?;
    *lent = rest;
    Ok(own)
}

impl<'t> Level<'t> {
    /// One for memory that is to be lent.
    pub const EMPTY: Self = Self {
        sides: [0; 2],
        store: Store::Words(&[]),
        mask: &[],
    };

    fn texture(&'t self, sheet: &Sheet<'t>) -> Result<Texture<'t>, TextureError> {
        let [width, height] = self.sides;
        let computed = |texels: &'t dyn Texels| Texture::computed(texels, width, height);
        let texture = match &self.store {
            Store::Compressed(blocks) => return Ok(blocks.texture()),
            Store::Cached(cache) => return Ok(cache.texture()),
            Store::Words(words) => Texture::words(words, width, height),
            Store::Indices(bytes) => Texture::index4(bytes, sheet.palette, width, height),
            Store::Checker(texels) => computed(texels),
            Store::Gradient(texels) => computed(texels),
        }?;
        Ok(match sheet.key {
            Some(key) => texture.keyed(key),
            None => texture,
        })
    }

    /// What the texels say beside their colours.
    fn masks(&'t self, sheet: &Sheet<'t>) -> Result<Texture<'t>, TextureError> {
        let [width, height] = self.sides;
        match &self.store {
            Store::Indices(bytes) => Texture::index4(bytes, sheet.mask_palette, width, height),
            _ => Texture::words(self.mask, width, height),
        }
    }

    fn read<T: PixelFormat<Word = u16>>(
        reader: &mut Reader<'t>,
        (first, sheet): (u32, &Sheet<'t>),
        cached: &mut &'t mut [CacheWord],
    ) -> Result<Self, FlashError> {
        let sides = reader.halves()?.map(u32::from);
        let texels = sides[0] as usize * sides[1] as usize;
        let store = match first >> form::SHIFT {
            0 => Store::Words(reader.table(texels)?),
            form::INDICES => Store::Indices(reader.table(texels.div_ceil(2))?),
            form::BLOCKS => {
                let bytes = reader.word()? as usize;
                let [width, height] = sides;
                let word = |number| T::from_rgb8(Rgb565::to_rgb8(number));
                let mut blocks = Compressed::new(reader.table(bytes)?, width, height, word)?;
                if let Some(key) = sheet.key {
                    blocks = blocks.keyed(key);
                }
                match first & form::CACHED {
                    0 => Store::Compressed(blocks),
                    _ => {
                        let cache = BlockCache::compressed(blocks, take(cached, CACHED)?);
                        Store::Cached(cache.map_err(|_| reader.bad())?)
                    }
                }
            }
            form::CHECKER => Store::Checker(Checker {
                colours: reader.halves()?,
                log_side: reader.word()? as u8,
            }),
            form::GRADIENT => Store::Gradient(Gradient {
                from: colour(reader)?,
                to: colour(reader)?,
                log_length: reader.word()? as u8,
                word: T::from_rgb8,
            }),
            _ => return Err(reader.bad()),
        };
        let has_words = sheet.has_mask && matches!(store, Store::Words(_));
        let mask = reader.table(if has_words { texels } else { 0 })?;
        Ok(Self { sides, store, mask })
    }
}

/// A colour in a word.
pub(crate) fn colour(reader: &mut Reader<'_>) -> Result<[u8; 3], FlashError> {
    let [r, g, b, _] = reader.word()?.to_le_bytes();
    Ok([r, g, b])
}

impl<'t> Textures<'t> {
    /// Textures whose computed and compressed texels become words of the format `T`, which all others have.
    ///
    /// # Errors
    /// When words cannot be, or less is lent than they need.
    pub fn read<T: PixelFormat<Word = u16>>(
        reader: &mut Reader<'t>,
        lent: TextureMemory<'t>,
    ) -> Result<Self, FlashError> {
        let (mut free, mut cached) = (lent.levels.iter_mut(), lent.cached);
        for slot in lent.sheets.iter_mut() {
            let first = reader.word()?;
            *slot = sheet(reader, first)?;
            for _ in 0..slot.levels {
                let level = free.next().ok_or(FlashError::Lent)?;
                *level = Level::read::<T>(reader, (first, slot), &mut cached)?;
            }
        }
        let levels: &'t [Level<'t>] = lent.levels;
        let (mut rest, mut others) = (levels, lent.others);
        for (slot, sheet) in lent.textures.iter_mut().zip(lent.sheets) {
            let own = rest.split_at_checked(sheet.levels);
            let (own, after) = own.ok_or(FlashError::Lent)?;
            rest = after;
            *slot = sheet.texture(own, &mut others)?;
        }
        Ok(Self {
            all: lent.textures,
            levels,
        })
    }

    /// What each cache did.
    pub fn reads(&self) -> impl Iterator<Item = CacheReads> {
        self.levels.iter().filter_map(|level| match &level.store {
            Store::Cached(cache) => Some(cache.reads()),
            _ => None,
        })
    }
}

/// A texture, in front of its levels.
fn sheet<'t>(reader: &mut Reader<'t>, first: u32) -> Result<Sheet<'t>, FlashError> {
    let has = |bit: u32| first & bit != 0;
    let key = match has(form::KEYED) {
        true => Some(reader.word()? as u16),
        false => None,
    };
    let (has_palette, has_mask) = (first >> form::SHIFT == form::INDICES, has(form::MASKED));
    let colours = |is: bool| if is { COLOURS } else { 0 };
    Ok(Sheet {
        levels: (first & form::LEVELS) as usize,
        sampling: match (has(form::MIXED), has(form::LEVELLED)) {
            (true, _) => Some(Sampling::LINEAR),
            (false, true) => Some(Sampling::NEAREST),
            (false, false) => None,
        },
        key,
        has_mask,
        palette: reader.table(colours(has_palette))?,
        mask_palette: reader.table(colours(has_palette && has_mask))?,
    })
}
