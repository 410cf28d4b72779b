//! Textures of a list as values of the rooms (H7).
//!
//! A texture is made when a block first draws with a number and its palette, and stays as long as the memory is lent:
//! the same pair is found again where it is sampled and dithered alike, so a list that is played each frame makes its
//! textures once. Indices of 1, 2, 4 and 8 bits stay where they lie, and so do texels of 16 bits where the panel has
//! their order of bytes; palettes, and other texels, become words of the panel in memory that is lent. Where all are
//! opaque or transparent, a word stands for those that are transparent; else there is a mask, in a room of its own, which
//! says also which are not dithered.

use crate::list::{Lent, Missing, Pair, Reason, TexelForm, Texels, Words};
use crate::pixel::PixelFormat;
use crate::scene::{MaskTexel, Sampling, Texture, TextureError, Wrap};

/// Room for a texture that is drawn with.
#[derive(Debug)]
pub struct TextureRoom<'t> {
    kept: Option<Kept<'t>>,
    /// The one that was made before.
    before: Option<&'t Self>,
}

impl TextureRoom<'_> {
    /// Empty.
    pub const EMPTY: Self = Self {
        kept: None,
        before: None,
    };
}

/// A texture that was made.
#[derive(Debug)]
struct Kept<'t> {
    texture: Texture<'t>,
    is_translucent: bool,
    /// None of a mask, which is found by its texture.
    key: Option<Key>,
}

impl<'t> Kept<'t> {
    fn listed(&'t self) -> Listed<'t> {
        Listed {
            texture: &self.texture,
            is_translucent: self.is_translucent,
        }
    }
}

/// What tells textures apart: where texels and colours lie in memory, how they are read, and how they are drawn with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Key {
    texels: usize,
    colours: usize,
    /// Without the positions, which another list may have for others.
    pair: Pair,
    dithers: bool,
    /// The address of its code.
    sampling: Option<usize>,
}

/// A texture that is drawn with: one that was made, or the application's.
#[derive(Clone, Copy, Debug)]
pub(super) struct Listed<'t> {
    pub(super) texture: &'t Texture<'t>,
    /// Whether texels are neither opaque nor transparent.
    pub(super) is_translucent: bool,
}

/// The textures that were made, and memory for more.
#[derive(Debug)]
pub(super) struct Shelf<'t> {
    pub(super) free: &'t mut [TextureRoom<'t>],
    pub(super) last: Option<&'t TextureRoom<'t>>,
    pub(super) words: &'t mut [u16],
    pub(super) levels: &'t mut [Texture<'t>],
}

/// Where texels and colours lie, and what is made of them.
#[derive(Clone, Copy)]
struct Source<'t> {
    texels: &'t [u32],
    colours: &'t [u32],
    pair: Pair,
    /// Makes words of the panel of colours.
    word: fn([u8; 3]) -> u16,
    /// Whether some are not to be dithered where the rest is.
    dithers: bool,
    sampling: Option<Sampling>,
}

/// Texels or colours of a palette.
#[derive(Clone, Copy, Default)]
struct Made<'t> {
    /// As words of the panel; none where they are such words as they lie.
    words: Option<&'t [u16]>,
    /// The word of those that are transparent.
    key: Option<u16>,
    /// What else is said of them.
    masks: Option<&'t [u16]>,
    is_translucent: bool,
}

/// Red, green, blue and alpha, and whether it is not to be dithered.
type Colour = ([u8; 4], bool);

impl<'t> Shelf<'t> {
    /// The texture of a pair, whose draw calls are dithered or not.
    ///
    /// # Errors
    /// [`Reason::Missing`] and [`Reason::Lent`].
    pub(super) fn texture<F: PixelFormat>(
        &mut self,
        words: impl Words<'t>,
        pair: Pair,
        dithers: bool,
        sampling: Option<Sampling>,
    ) -> Result<Listed<'t>, Reason> {
        let in_place = |at, count| {
            let slice = words.slice(at, count);
            let readable = slice.filter(|_| cfg!(target_endian = "little"));
            readable.ok_or(Reason::Missing(Missing::TexelsInPieces))
        };
        let source = Source {
            texels: in_place(pair.at, pair.words_above(pair.levels))?,
            colours: match pair.count {
                0 => &[],
                count => in_place(pair.colours, count)?,
            },
            pair,
            word: F::texel,
            // Others do not say what is not dithered.
            dithers: dithers && matches!(pair.form, TexelForm::Rgba | TexelForm::Rgbd5551),
            sampling,
        };
        let key = Some(source.key());
        let rooms = core::iter::successors(self.last, |room| room.before);
        let mut known = rooms.filter_map(|room| room.kept.as_ref());
        if let Some(kept) = known.find(|kept| kept.key == key) {
            return Ok(kept.listed());
        }
        self.fits(1, source, 0)?;
        let (texture, is_translucent) = self.make(source)?;
        self.keep(Kept {
            texture,
            is_translucent,
            key,
        })
    }

    /// Whether there is room for so many textures of so many words each, with their levels of detail.
    fn fits(&self, textures: usize, source: Source<'t>, words: usize) -> Result<(), Reason> {
        let needs = [
            (self.free.len(), 1, Lent::Textures),
            (self.words.len(), words, Lent::Texels),
            (self.levels.len(), source.coarser(), Lent::Levels),
        ];
        let lacks = needs.iter().find(|(have, need, _)| *have < textures * need);
        lacks.map_or(Ok(()), |(_, _, lent)| Err(Reason::Lent(*lent)))
    }

    /// Keeps a texture in a room.
    fn keep(&mut self, kept: Kept<'t>) -> Result<Listed<'t>, Reason> {
        let full = Reason::Lent(Lent::Textures);
        let (room, free) = core::mem::take(&mut self.free)
            .split_first_mut()
            .ok_or(full)?;
        self.free = free;
        *room = TextureRoom {
            kept: Some(kept),
            before: self.last,
        };
        let room: &'t TextureRoom<'t> = room;
        self.last = Some(room);
        room.kept.as_ref().map(Kept::listed).ok_or(full)
    }

    /// Makes a texture, with its levels of detail and its mask, if it has one; whether texels are neither opaque nor
    /// transparent.
    fn make(&mut self, source: Source<'t>) -> Result<(Texture<'t>, bool), Reason> {
        let made = match source.pair.form.is_indexed() {
            true => self.write(source, |n| source.entry(n))?,
            false if source.is_native() => Made::default(),
            false => self.write(source, |n| source.texel(n))?,
        };
        let texture = self.levelled(source, made.words)?;
        let texture = made.key.map_or(texture, |key| texture.keyed(key));
        let Some(masks) = made.masks else {
            return Ok((texture, false));
        };
        let mask = Kept {
            texture: self.levelled(source, Some(masks))?,
            is_translucent: false,
            key: None,
        };
        let mask = self.keep(mask)?.texture;
        // Both are made alike.
        Ok((texture.masked(mask).unwrap_or(texture), made.is_translucent))
    }

    /// A texture of these words, with its levels of detail.
    fn levelled(
        &mut self,
        source: Source<'t>,
        words: Option<&'t [u16]>,
    ) -> Result<Texture<'t>, Reason> {
        let wrap = match source.pair.clamped {
            true => Wrap::Clamp,
            false => Wrap::Repeat,
        };
        // Sides and lengths are those that the block was checked for.
        let lacks = Reason::Lent(Lent::Texels);
        let level = |level| source.level(level, words).map_err(|_| lacks);
        let made = level(0)?.wrapping(wrap);
        let taken = take(&mut self.levels, source.coarser());
        for (number, slot) in (1..).zip(taken.iter_mut()) {
            *slot = level(number)?;
        }
        let default = (!taken.is_empty()).then_some(Sampling::NEAREST);
        // Each level has half the sides of the one above it.
        let sampled = |sampling| made.sampled(sampling, taken).unwrap_or(made);
        Ok(source.sampling.or(default).map_or(made, sampled))
    }

    /// Writes the colours of a source by their numbers. Memory is taken once there is enough for all that comes of them.
    fn write(
        &mut self,
        source: Source<'t>,
        of: impl Fn(u32) -> Colour,
    ) -> Result<Made<'t>, Reason> {
        let count = source.count();
        self.fits(1, source, count)?;
        let words = self.words.get_mut(..count).unwrap_or_default();
        let (mut has_holes, mut is_translucent, mut is_dithered) = (false, false, true);
        for (n, slot) in (0..).zip(words.iter_mut()) {
            let ([r, g, b, alpha], undithered) = of(n);
            has_holes |= alpha == 0;
            is_translucent |= !matches!(alpha, 0 | 255);
            is_dithered &= !undithered;
            *slot = (source.word)([r, g, b]);
        }
        let is_hole = |n: u32| of(n).0[3] == 0;
        let has_key = has_holes && !is_translucent;
        let key = has_key.then(|| unused(words, is_hole)).flatten();
        is_translucent |= has_holes && key.is_none();
        if let Some(key) = key {
            for (n, slot) in (0..).zip(words.iter_mut()) {
                if is_hole(n) {
                    *slot = key;
                }
            }
        }
        let has_masks = is_translucent || source.dithers && !is_dithered;
        self.fits(1 + usize::from(has_masks), source, count)?;
        Ok(Made {
            words: Some(take(&mut self.words, count)),
            key,
            masks: has_masks.then(|| self.masks(count, of)),
            is_translucent,
        })
    }

    /// What is said of so many colours.
    fn masks(&mut self, count: usize, of: impl Fn(u32) -> Colour) -> &'t [u16] {
        let masks = take(&mut self.words, count);
        for (n, slot) in (0..).zip(masks.iter_mut()) {
            let ([.., alpha], undithered) = of(n);
            let texel = MaskTexel::alpha(alpha);
            *slot = match undithered {
                true => texel.undithered().word(),
                false => texel.word(),
            };
        }
        masks
    }
}

/// So many of the lent, which are there.
fn take<'t, T>(lent: &mut &'t mut [T], count: usize) -> &'t mut [T] {
    let parts = core::mem::take(lent).split_at_mut_checked(count);
    let (taken, rest) = parts.unwrap_or_default();
    *lent = rest;
    taken
}

impl<'t> Source<'t> {
    /// The words of a level's texels.
    fn words_of(&self, level: u8) -> &'t [u32] {
        let [from, to] = [level, level + 1].map(|l| self.pair.words_above(l) as usize);
        self.texels.get(from..to).unwrap_or_default()
    }

    /// How many levels there are below the first.
    fn coarser(&self) -> usize {
        usize::from(self.pair.levels.saturating_sub(1))
    }

    /// Texels of all levels above one of them.
    fn texels_above(&self, level: u8) -> usize {
        let texels = |level| {
            let [width, height] = self.pair.sides(level);
            (width * height) as usize
        };
        (0..level).map(texels).sum()
    }

    /// A level: its texels as they lie in the list with a palette, or in words that were made of all of them, or as they
    /// are.
    fn level(&self, level: u8, words: Option<&'t [u16]>) -> Result<Texture<'t>, TextureError> {
        let [width, height] = self.pair.sides(level);
        let bytes: &'t [u8] = bytemuck::cast_slice(self.words_of(level));
        let colours = words.unwrap_or_default();
        let count = (width * height) as usize;
        match (self.pair.form, words) {
            (TexelForm::Index1, _) => Texture::index1(bytes, colours, width, height),
            (TexelForm::Index2, _) => Texture::index2(bytes, colours, width, height),
            (TexelForm::Index4, _) => Texture::index4(bytes, colours, width, height),
            (form, _) if form.is_indexed() => Texture::index8(bytes, colours, width, height),
            (_, words) => {
                let from = match words {
                    Some(words) => words.get(self.texels_above(level)..).unwrap_or_default(),
                    None => bytemuck::cast_slice(self.words_of(level)),
                };
                Texture::words(from.get(..count).unwrap_or_default(), width, height)
            }
        }
    }

    /// How many colours are written.
    fn count(&self) -> usize {
        match self.pair.form.is_indexed() {
            true => 1 << self.pair.form.bits(),
            false => self.texels_above(self.pair.levels),
        }
    }

    /// A colour of the palette by its number. What the list's does not have is black.
    fn entry(&self, n: u32) -> Colour {
        let code = match self.pair.form {
            // Two bits of a byte mean nothing.
            TexelForm::Index6 => n & 63,
            _ => n,
        };
        let colour = self.colours.get(code as usize);
        let rgba = colour.map_or([0, 0, 0, 255], |w| u32::from_le(*w).to_le_bytes());
        (rgba, false)
    }

    /// A texel by its number, those of the first level first.
    fn texel(&self, mut n: u32) -> Colour {
        let mut level = 0;
        let texels = loop {
            let [width, height] = self.pair.sides(level);
            if n < width * height || level == self.pair.levels {
                break Texels::new(self.words_of(level), self.pair.form, &[]);
            }
            (n, level) = (n - width * height, level + 1);
        };
        (texels.rgba(n), texels.is_undithered(n))
    }

    /// What tells it from others.
    fn key(&self) -> Key {
        Key {
            texels: self.texels.as_ptr().addr(),
            colours: self.colours.as_ptr().addr(),
            pair: Pair {
                at: 0,
                colours: 0,
                ..self.pair
            },
            dithers: self.dithers,
            sampling: self.sampling.map(|sampling| sampling.draw as usize),
        }
    }

    /// Whether its texels are words of the panel as they lie.
    fn is_native(&self) -> bool {
        let words = [([255, 0, 0], 0xF800), ([0, 255, 0], 0x07E0), ([0, 0, 8], 1)];
        let is_alike = words.iter().all(|&(rgb, word)| (self.word)(rgb) == word);
        is_alike && self.pair.form == TexelForm::Rgb565
    }
}

/// A word that none of these is but for holes: 1,024 are looked for at once, of which a palette cannot have all.
fn unused(words: &[u16], is_hole: impl Fn(u32) -> bool) -> Option<u16> {
    (0..64u16).find_map(|part| {
        let mut seen = [0u32; 32];
        for (n, word) in (0..).zip(words) {
            if word >> 10 == part && !is_hole(n) {
                seen[usize::from(word >> 5 & 31)] |= 1 << (word & 31);
            }
        }
        let (row, bits) = (0..).zip(seen).find(|(_, bits)| *bits != u32::MAX)?;
        Some(part << 10 | row << 5 | bits.trailing_ones() as u16)
    })
}

#[cfg(test)]
mod tests {
    use super::unused;
    use std::vec::Vec;

    /// Kills: words of other parts that are taken for those of the part that is looked at, holes that take a word,
    /// and a word that is there.
    #[test]
    fn a_word_of_holes_is_that_of_nothing_else() {
        let part = |part: u16| (0..1024).map(move |low| part << 10 | low);
        let second: Vec<u16> = part(1).collect();
        assert_eq!(unused(&second, |_| false), Some(0));
        let first: Vec<u16> = part(0).collect();
        assert_eq!(unused(&first, |_| false), Some(1024));
        for hole in [0, 31, 32, 777, 1023] {
            let word = unused(&first, |n| n == hole);
            assert_eq!(word.map(u32::from), Some(hole));
        }
        let all: Vec<u16> = (0..=u16::MAX).collect();
        assert_eq!(unused(&all, |_| false), None);
        assert_eq!(unused(&all, |n| n == 40_000), Some(40_000));
    }
}
