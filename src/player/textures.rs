//! Textures of a list as values of the rooms (H7).
//!
//! A texture is made when a block first draws with a number and its palette, and stays as long as the memory is lent:
//! the same pair is found again, so a list that is played each frame makes its textures once. Indices of 1, 2, 4 and
//! 8 bits stay where they lie, and so do texels of 16 bits where the panel has their order of bytes; palettes, and
//! other texels, become words of the panel in memory that is lent.

use crate::composite::{PixelFormat, Rgb565};
use crate::list::{Lent, Missing, Pair, Reason, TexelForm, Texels, Words};
use crate::scene::{Sampling, Texture, TextureError, Wrap};

/// Room for a texture that is drawn with.
#[derive(Debug)]
pub struct TextureRoom<'t> {
    made: Option<Texture<'t>>,
    key: Key,
    /// The one that was made before.
    before: Option<&'t Self>,
}

impl TextureRoom<'_> {
    /// Empty.
    pub const EMPTY: Self = Self {
        made: None,
        key: Key {
            texels: 0,
            colours: 0,
            count: 0,
            form: TexelForm::Index1,
            log_sides: [0; 2],
            clamped: false,
        },
        before: None,
    };
}

/// What tells textures apart: where texels and colours lie in memory, and how they are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Key {
    texels: usize,
    colours: usize,
    count: u32,
    form: TexelForm,
    log_sides: [u8; 2],
    clamped: bool,
}

/// A texture that is to be drawn with.
#[derive(Clone, Copy)]
pub(super) struct Asked {
    pub(super) pair: Pair,
    /// Whether its draw calls are dithered.
    pub(super) dithers: bool,
    pub(super) sampling: Option<Sampling>,
}

/// The textures that were made, and memory for more.
#[derive(Debug)]
pub(super) struct Shelf<'t> {
    free: &'t mut [TextureRoom<'t>],
    last: Option<&'t TextureRoom<'t>>,
    words: &'t mut [u16],
}

/// Where texels and colours lie.
#[derive(Clone, Copy)]
struct Source<'t> {
    texels: &'t [u32],
    colours: &'t [u32],
    pair: Pair,
}

/// How colours become words of the panel.
#[derive(Clone, Copy)]
struct Panel {
    word: fn([u8; 3]) -> u16,
    dithers: bool,
}

/// A texel, or a colour of a palette.
#[derive(Clone, Copy)]
struct Colour {
    /// Red, green, blue and alpha.
    rgba: [u8; 4],
    /// Whether it is not to be dithered.
    undithered: bool,
}

impl<'t> Shelf<'t> {
    pub(super) fn new(rooms: &'t mut [TextureRoom<'t>], words: &'t mut [u16]) -> Self {
        Self {
            free: rooms,
            last: None,
            words,
        }
    }

    /// The texture that is asked for.
    ///
    /// # Errors
    /// [`Reason::Missing`] and [`Reason::Lent`].
    pub(super) fn texture<F: PixelFormat>(
        &mut self,
        words: impl Words<'t>,
        Asked {
            pair,
            dithers,
            sampling,
        }: Asked,
    ) -> Result<&'t Texture<'t>, Reason> {
        let in_place = |at, count| {
            let slice = words.slice(at, count);
            let readable = slice.filter(|_| cfg!(target_endian = "little"));
            readable.ok_or(Reason::Missing(Missing::TexelsInPieces))
        };
        let source = Source {
            texels: in_place(pair.at, pair.words())?,
            colours: match pair.count {
                0 => &[],
                count => in_place(pair.colours, count)?,
            },
            pair,
        };
        let key = source.key();
        let mut known = self.last;
        while let Some(room) = known {
            if let (true, Some(made)) = (room.key == key, &room.made) {
                return Ok(made);
            }
            known = room.before;
        }
        if self.free.is_empty() {
            return Err(Reason::Lent(Lent::Textures));
        }
        let mut made = self.make::<F>(source, dithers)?;
        if let Some(sampling) = sampling {
            // Without levels there is none of other sides.
            made = made.sampled(sampling, &[]).unwrap_or(made);
        }
        let full = Reason::Lent(Lent::Textures);
        let (room, free) = core::mem::take(&mut self.free)
            .split_first_mut()
            .ok_or(full)?;
        self.free = free;
        *room = TextureRoom {
            made: Some(made),
            key,
            before: self.last,
        };
        let room: &'t TextureRoom<'t> = room;
        self.last = Some(room);
        room.made.as_ref().ok_or(full)
    }

    /// Makes a texture.
    fn make<F: PixelFormat>(
        &mut self,
        source: Source<'t>,
        dithers: bool,
    ) -> Result<Texture<'t>, Reason> {
        let panel = Panel {
            // Pixels of more than 16 bits are made of texels that are numbers.
            word: |rgb| match F::HALVES {
                true => F::to_half(F::from_rgb8(rgb)),
                false => Rgb565::from_rgb8(rgb),
            },
            dithers,
        };
        let mut key = None;
        let made = match source.pair.form.is_indexed() {
            true => self.indexed(source, panel, &mut key)?,
            false => self.direct(source, panel, &mut key)?,
        };
        let wrap = match source.pair.clamped {
            true => Wrap::Clamp,
            false => Wrap::Repeat,
        };
        // Sides and lengths are those that the block was checked for.
        let made = made.map_err(|_| Reason::Lent(Lent::Texels))?;
        Ok(match key {
            Some(key) => made.keyed(key).wrapping(wrap),
            None => made.wrapping(wrap),
        })
    }

    /// One whose texels name colours of a palette.
    fn indexed(
        &mut self,
        source: Source<'t>,
        panel: Panel,
        key: &mut Option<u16>,
    ) -> Result<Result<Texture<'t>, TextureError>, Reason> {
        let bytes: &'t [u8] = bytemuck::cast_slice(source.texels);
        let [width, height] = source.pair.sides();
        let mut palette = |count| self.palette(panel, source.colours, count, key);
        Ok(match source.pair.form {
            TexelForm::Index1 => Texture::index1(bytes, palette(2)?, width, height),
            TexelForm::Index2 => Texture::index2(bytes, palette(4)?, width, height),
            TexelForm::Index4 => Texture::index4(bytes, palette(16)?, width, height),
            TexelForm::Index6 => {
                // Two bits of a byte mean nothing.
                let palette = palette(64)?;
                let all = self.take(256)?;
                for (slot, colour) in all.iter_mut().zip(palette.iter().cycle()) {
                    *slot = *colour;
                }
                Texture::index8(bytes, all, width, height)
            }
            _ => Texture::index8(bytes, palette(256)?, width, height),
        })
    }

    /// One whose texels are colours.
    fn direct(
        &mut self,
        source: Source<'t>,
        panel: Panel,
        key: &mut Option<u16>,
    ) -> Result<Result<Texture<'t>, TextureError>, Reason> {
        let [width, height] = source.pair.sides();
        if source.pair.form == TexelForm::Rgb565 && panel.is_native() {
            let words = bytemuck::cast_slice(source.texels);
            return Ok(Texture::words(words, width, height));
        }
        let words = self.take((width * height) as usize)?;
        let all = Texels::new(source.texels, source.pair.form, &[]);
        *key = panel.write(words, |n| Colour {
            rgba: all.rgba(n),
            undithered: all.is_undithered(n),
        })?;
        Ok(Texture::words(words, width, height))
    }

    /// So many words of the lent memory.
    fn take(&mut self, count: usize) -> Result<&'t mut [u16], Reason> {
        let words = core::mem::take(&mut self.words);
        if words.len() < count {
            self.words = words;
            return Err(Reason::Lent(Lent::Texels));
        }
        let (taken, rest) = words.split_at_mut(count);
        self.words = rest;
        Ok(taken)
    }

    /// So many colours as words of the panel, and the word of those that are transparent. What the palette does not
    /// have is black.
    fn palette(
        &mut self,
        panel: Panel,
        colours: &[u32],
        count: usize,
        key: &mut Option<u16>,
    ) -> Result<&'t [u16], Reason> {
        let words = self.take(count)?;
        *key = panel.write(words, |n| {
            let colour = colours.get(n as usize);
            Colour {
                rgba: colour.map_or([0, 0, 0, 255], |w| u32::from_le(*w).to_le_bytes()),
                undithered: false,
            }
        })?;
        Ok(words)
    }
}

impl Source<'_> {
    fn key(&self) -> Key {
        Key {
            texels: self.texels.as_ptr().addr(),
            colours: self.colours.as_ptr().addr(),
            count: self.pair.count,
            form: self.pair.form,
            log_sides: self.pair.log_sides,
            clamped: self.pair.clamped,
        }
    }
}

impl Panel {
    /// Whether its words are those of a list's texels of 16 bits.
    fn is_native(self) -> bool {
        [([255, 0, 0], 0xF800), ([0, 255, 0], 0x07E0), ([0, 0, 8], 1)]
            .into_iter()
            .all(|(rgb, word)| (self.word)(rgb) == word)
    }

    /// Writes colours by their numbers; the word of those that are transparent.
    fn write(self, words: &mut [u16], of: impl Fn(u32) -> Colour) -> Result<Option<u16>, Reason> {
        let mut holes = false;
        for (n, slot) in (0..).zip(words.iter_mut()) {
            let colour = of(n);
            let [r, g, b, alpha] = colour.rgba;
            match alpha {
                0 => holes = true,
                255 if colour.undithered && self.dithers => {
                    return Err(Reason::Missing(Missing::Undithered));
                }
                255 => {}
                _ => return Err(Reason::Missing(Missing::Alpha)),
            }
            *slot = (self.word)([r, g, b]);
        }
        if !holes {
            return Ok(None);
        }
        let is_hole = |n: u32| of(n).rgba[3] == 0;
        let key = unused(words, is_hole).ok_or(Reason::Missing(Missing::Alpha))?;
        for (n, slot) in (0..).zip(words.iter_mut()) {
            if is_hole(n) {
                *slot = key;
            }
        }
        Ok(Some(key))
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
