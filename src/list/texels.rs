//! Texels of a list, read where they lie, and which of its textures is which (H7, H12).
//!
//! A TEXTURE or PALETTE block gives a number to texels or colours; both are kept in slots that the application lends.

use super::block::{Palette, TexelForm, Texture};
use super::error::Reason;
use core::sync::atomic::{AtomicU32, Ordering};

/// Pixels or texels in the words of a list.
#[derive(Clone, Copy, Debug)]
pub struct Texels<'w> {
    words: &'w [u32],
    colours: &'w [u32],
    form: TexelForm,
}

impl<'w> Texels<'w> {
    /// Texels of a form, and the colours that those of indexed forms name.
    #[must_use]
    pub const fn new(words: &'w [u32], form: TexelForm, colours: &'w [u32]) -> Self {
        Self {
            words,
            colours,
            form,
        }
    }

    /// Red, green, blue and alpha of the texel at an index, 8 bits each. Beyond the words all bits are 0; a
    /// colour that is not there is 0 too.
    #[inline(always)]
    #[must_use]
    pub fn rgba(&self, index: u32) -> [u8; 4] {
        let (log_bits, mask) = match self.form {
            TexelForm::Index1 => (0, 1),
            TexelForm::Index2 => (1, 3),
            TexelForm::Index4 => (2, 15),
            TexelForm::Index6 => (3, 63),
            TexelForm::Index8 => (3, 255),
            TexelForm::Rgb565 => {
                let v = self.half(index);
                return [grown(v >> 11, 5), grown(v >> 5, 6), grown(v, 5), 255];
            }
            TexelForm::Rgba5551 | TexelForm::Rgbd5551 => return self.rgb555(index),
            TexelForm::Rgb888 => return self.rgb888(index),
            TexelForm::Rgba => {
                let [r, g, b, a] = self.word(index).to_le_bytes();
                return [r, g, b, grown(u32::from(a), 7)];
            }
        };
        let bit = index << log_bits & 31;
        let code = self.word(index >> (5 - log_bits)) >> bit & mask;
        let colour = self.colours.get(code as usize);
        colour.map_or([0; 4], |w| u32::from_le(*w).to_le_bytes())
    }

    /// 16 bits.
    #[inline(always)]
    fn half(&self, index: u32) -> u32 {
        self.word(index >> 1) >> (16 * (index & 1))
    }

    /// Three fields of 5 bits, and one that is alpha or says nothing of it.
    fn rgb555(&self, index: u32) -> [u8; 4] {
        let v = self.half(index);
        let alpha = match self.form {
            TexelForm::Rgba5551 => grown(v, 1),
            _ => 255,
        };
        [grown(v >> 11, 5), grown(v >> 6, 5), grown(v >> 1, 5), alpha]
    }

    /// Three bytes, which may lie in two words.
    fn rgb888(&self, index: u32) -> [u8; 4] {
        let byte = (index & 3) * 3;
        let (word, shift) = ((index >> 2) * 3 + (byte >> 2), 8 * (byte & 3));
        let low = self.word(word) >> shift;
        // The upper bytes of the next word, if they are needed; none by a shift of 32.
        let high = u64::from(self.word(word + 1)) << (32 - shift);
        let [r, g, b, _] = (low | high as u32).to_le_bytes();
        [r, g, b, 255]
    }

    /// Whether the texel at an index says that it is not to be dithered (H10): the bit D.
    #[must_use]
    pub fn is_undithered(&self, index: u32) -> bool {
        match self.form {
            TexelForm::Rgba => self.word(index) >> 31 != 0,
            TexelForm::Rgbd5551 => self.half(index) & 1 != 0,
            _ => false,
        }
    }

    #[inline(always)]
    fn word(&self, n: u32) -> u32 {
        self.words.get(n as usize).map_or(0, |w| u32::from_le(*w))
    }
}

/// A field of some bits grows to 8 by repeating its bits, top bits first.
#[inline(always)]
fn grown(v: u32, bits: u32) -> u8 {
    let v = v & ((1 << bits) - 1);
    match bits {
        1 => (v * 255) as u8,
        _ => (v << (8 - bits) | v >> (2 * bits - 8)) as u8,
    }
}

/// Room for the name of a texture or palette.
///
/// Bits 31..30 of the first word say which, 0 for none; see [`TextureSlots`].
#[derive(Debug, Default)]
pub struct TextureSlot {
    name: AtomicU32,
    /// Position of the texels, with the levels of detail less one in bits 31..30, or of the colours.
    at: AtomicU32,
}

impl TextureSlot {
    /// Empty.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            name: AtomicU32::new(0),
            at: AtomicU32::new(0),
        }
    }
}

/// A texture and its palette, as a number names them now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pair {
    /// Binary logarithms of width and height.
    pub log_sides: [u8; 2],
    /// Form of a texel.
    pub form: TexelForm,
    /// Levels of detail, 1 to 4.
    pub levels: u8,
    /// The edge goes on outside; else the picture repeats.
    pub clamped: bool,
    /// Position of the first texel.
    pub at: u32,
    /// Position of the first colour; 0 where the form needs none.
    pub colours: u32,
    /// How many colours there are, 1 to 256; 0 where the form needs none.
    pub count: u32,
}

impl Pair {
    /// Width and height of a level of detail, 0 for the largest.
    #[must_use]
    pub fn sides(&self, level: u8) -> [u32; 2] {
        self.log_sides
            .map(|side| 1 << (side & 15).saturating_sub(level))
    }

    /// Words of the texels of all levels above one of them.
    #[must_use]
    pub fn words_above(&self, level: u8) -> u32 {
        // Sides are at most 2^10, so there are at most 2^25 bits.
        let words = |level: u8| {
            let [width, height] = self.sides(level);
            (self.form.bits() * width * height).div_ceil(32)
        };
        (0..level).map(words).sum()
    }
}

/// A texture has a number: bits 7..0 the number, 8..11 and 12..15 the sides, 16..19 the form, 20
/// clamped, 21..28 the palette.
const TEXTURE: u32 = 1 << 30;
/// A palette has a number: bits 7..0 the number, 8..15 colours less one.
const PALETTE: u32 = 2 << 30;
/// The bit of what is clamped.
const CLAMPED: u32 = 1 << 20;
/// Bits that say what a slot is.
const KIND: u32 = 3 << 30;

/// The slots that textures are kept in: one for each number of a texture and of a palette.
#[derive(Clone, Copy, Debug, Default)]
pub struct TextureSlots<'m>(
    /// The slots.
    pub &'m [TextureSlot],
);

impl<'m> TextureSlots<'m> {
    /// Forgets everything.
    pub fn clear(self) {
        for slot in self.0 {
            slot.name.store(0, Ordering::Relaxed);
        }
    }

    /// The first slot whose name satisfies `is`.
    fn find(self, is: impl Fn(u32) -> bool) -> Option<&'m TextureSlot> {
        let mut slots = self.0.iter();
        slots.find(|slot| is(slot.name.load(Ordering::Relaxed)))
    }

    /// The slot of a kind with a number.
    fn numbered(self, kind: u32, number: u8) -> Option<&'m TextureSlot> {
        self.find(|name| name & (KIND | 0xFF) == kind | u32::from(number))
    }

    fn define(self, name: u32, at: u32) -> bool {
        let known = self.numbered(name & KIND, name as u8);
        let slot = known.or_else(|| self.find(|name| name == 0));
        if let Some(slot) = slot {
            slot.at.store(at, Ordering::Relaxed);
            slot.name.store(name, Ordering::Relaxed);
        }
        slot.is_some()
    }

    /// Gives a texture its number; `false` where no slot is free.
    #[must_use]
    pub fn texture(self, t: &Texture) -> bool {
        let name = TEXTURE
            | u32::from(t.number)
            | u32::from(t.log_width) << 8
            | u32::from(t.log_height) << 12
            | (t.form as u32) << 16
            | u32::from(t.clamped) << 20
            | u32::from(t.palette) << 21;
        // Lists have less than 2^30 words.
        self.define(name, t.at | u32::from(t.levels.saturating_sub(1)) << 30)
    }

    /// Gives a palette its number; `false` where no slot is free.
    #[must_use]
    pub fn palette(self, p: &Palette) -> bool {
        let less = u32::from(p.count.saturating_sub(1).min(255));
        self.define(PALETTE | u32::from(p.number) | less << 8, p.at)
    }

    /// Position and number of the colours of a palette, 1 to 256.
    #[must_use]
    pub fn colours(self, number: u8) -> Option<(u32, u32)> {
        let palette = self.numbered(PALETTE, number)?;
        let count = (palette.name.load(Ordering::Relaxed) >> 8 & 0xFF) + 1;
        Some((palette.at.load(Ordering::Relaxed), count))
    }

    /// The same of the palette that a form takes; no colours where it takes none.
    pub(crate) fn colours_of(self, form: TexelForm, palette: u8) -> Option<(u32, u32)> {
        match form.is_indexed() {
            true => self.colours(palette),
            false => Some((0, 0)),
        }
    }

    /// Whether there is the texture of a number, and its palette.
    #[must_use]
    pub fn has(self, number: u8) -> bool {
        self.pair(number).is_ok()
    }

    /// The texture of a number, and its palette.
    ///
    /// # Errors
    /// [`Reason::NoTexture`] and [`Reason::NoPalette`].
    pub(crate) fn pair(self, number: u8) -> Result<Pair, Reason> {
        let texture = self.numbered(TEXTURE, number);
        let texture = texture.ok_or(Reason::NoTexture(number))?;
        let name = texture.name.load(Ordering::Relaxed);
        let form = form_of_code(name >> 16 & 15);
        let colours = self.colours_of(form, (name >> 21) as u8);
        let (colours, count) = colours.ok_or(Reason::NoPalette(number))?;
        let at = texture.at.load(Ordering::Relaxed);
        let [width, height] = [(name >> 8) as u8 & 15, (name >> 12) as u8 & 15];
        Ok(Pair {
            // Below one texel there is no level.
            levels: (at >> 30).min(width.max(height).into()) as u8 + 1,
            log_sides: [width, height],
            form,
            clamped: name & CLAMPED != 0,
            at: at & (u32::MAX >> 2),
            colours,
            count,
        })
    }
}

/// Of a code that was put somewhere as that of a form.
pub(super) fn form_of_code(code: u32) -> TexelForm {
    *TexelForm::ALL
        .get(code as usize)
        .unwrap_or(&TexelForm::Rgba)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec;
    use std::vec::Vec;

    /// What a field of some bits stands for, in steps of 255, to nearest.
    fn level(field: u32, bits: u32) -> f64 {
        f64::from(field) * 255.0 / f64::from((1u32 << bits) - 1)
    }

    /// The field that a level is nearest to.
    fn field(level: u8, bits: u32) -> u32 {
        (f64::from(level) * f64::from((1u32 << bits) - 1) / 255.0).round() as u32
    }

    /// Fields of a texel from its top: how many bits each has; red, green, blue, alpha and D by number.
    fn layout(form: TexelForm) -> &'static [(usize, u32)] {
        match form {
            TexelForm::Rgb565 => &[(0, 5), (1, 6), (2, 5)],
            TexelForm::Rgb888 => &[(2, 8), (1, 8), (0, 8)],
            TexelForm::Rgba => &[(4, 1), (3, 7), (2, 8), (1, 8), (0, 8)],
            TexelForm::Rgba5551 => &[(0, 5), (1, 5), (2, 5), (3, 1)],
            TexelForm::Rgbd5551 => &[(0, 5), (1, 5), (2, 5), (4, 1)],
            _ => &[],
        }
    }

    /// Texels of some bits one behind the other, lowest bits first.
    fn packed(values: &[u32], bits: u32) -> Vec<u32> {
        let mut bytes = vec![0u8; values.len() * bits as usize / 8];
        for (bytes, value) in bytes.chunks_mut(bits as usize / 8).zip(values) {
            bytes.copy_from_slice(&value.to_le_bytes()[..bytes.len()]);
        }
        let word = |b: &[u8]| u32::from_ne_bytes([0, 1, 2, 3].map(|i| *b.get(i).unwrap_or(&0)));
        bytes.chunks(4).map(word).collect()
    }

    /// Kills: a number of a texel that is none, and is taken for another's.
    #[test]
    fn what_is_beyond_all_words_is_no_texel() {
        let (words, mut colours) = ([u32::MAX; 4], [u32::MAX; 256]);
        colours[0] = 0;
        for form in [
            TexelForm::Index1,
            TexelForm::Index2,
            TexelForm::Index4,
            TexelForm::Index6,
            TexelForm::Index8,
            TexelForm::Rgb888,
        ] {
            let texels = Texels::new(&words, form, &colours);
            assert_eq!(texels.rgba(1)[..3], [255; 3]);
            // Three times the last is 2^32 and 2.
            for index in [1 << 20, 1 << 28, 1 << 29, 1 << 30, 1 << 31, 0x5555_5556] {
                let rgba = texels.rgba(index);
                assert_eq!(rgba[..3], [0; 3], "{form:?} {index}");
            }
        }
    }

    /// Each field is within a step of what it stands for, and no two words are the same texel (H7).
    ///
    /// Kills: a field that is a bit further down, zeros below those that grow, the wrong half of a word, alpha of 5551 that is
    /// not full, D of the wrong end, three bytes from the wrong word.
    #[test]
    fn every_word_survives_expansion() {
        let turned = |i: u32| i.wrapping_mul(0x9E37_79B9).rotate_left(i & 31);
        let forms = [
            TexelForm::Rgb565,
            TexelForm::Rgb888,
            TexelForm::Rgba,
            TexelForm::Rgba5551,
            TexelForm::Rgbd5551,
        ];
        for form in forms {
            let bits = form.bits();
            // All of 16 bits; of more, all bytes in each place beside any others.
            let mut values: Vec<u32> = match bits {
                16 => (0..1 << 16).collect(),
                _ => (0..1 << 16).map(turned).collect(),
            };
            for byte in (0..bits).step_by(8) {
                let swept = |v: u32| turned(v) & !(255 << byte) | v << byte;
                values.extend((0..256).map(swept));
            }
            let keep = |v: &mut u32| *v &= u32::MAX >> (32 - bits);
            values.iter_mut().for_each(keep);
            let words = packed(&values, bits);
            let texels = Texels::new(&words, form, &[]);
            for (i, &value) in (0..).zip(&values) {
                let rgba = texels.rgba(i);
                let (mut top, mut again) = (bits, 0);
                let mut said = [false; 5];
                for &(which, size) in layout(form) {
                    top -= size;
                    let stored = value >> top & ((1 << size) - 1);
                    said[which] = true;
                    let read = match which {
                        4 => u32::from(texels.is_undithered(i)),
                        _ => {
                            let off = f64::from(rgba[which]) - level(stored, size);
                            assert!(off.abs() < 1.0, "{form:?} {value:x}: {rgba:?}");
                            field(rgba[which], size)
                        }
                    };
                    again |= read << top;
                }
                assert_eq!((again, top), (value, 0), "{form:?} {value:x}: {rgba:?}");
                assert!(said[3] || rgba[3] == 255, "opaque");
                assert!(said[4] || !texels.is_undithered(i), "dithered");
            }
        }
    }

    /// Kills: an index of the texel beside.
    #[test]
    fn every_index_names_its_colour() {
        for (form, bits, each) in [
            (TexelForm::Index1, 1, 1),
            (TexelForm::Index2, 2, 2),
            (TexelForm::Index4, 4, 4),
            (TexelForm::Index6, 6, 8),
            (TexelForm::Index8, 8, 8),
        ] {
            let codes: Vec<u32> = (0..512u32)
                .map(|i| (i * 37 + i / 7) % (1 << bits))
                .collect();
            let mut words = vec![0; 512 * each / 32];
            for (i, code) in codes.iter().enumerate() {
                words[i * each / 32] |= (code << (i * each % 32)).to_le();
            }
            let colours: Vec<u32> = (0..1u32 << bits)
                .map(|i| 0x0102_0304u32.wrapping_mul(i).to_le())
                .collect();
            let texels = Texels::new(&words, form, &colours);
            for (i, code) in (0..).zip(codes) {
                let want = 0x0102_0304u32.wrapping_mul(code).to_le_bytes();
                assert_eq!(texels.rgba(i), want, "{form:?} {i}");
                assert!(!texels.is_undithered(i));
            }
            // No such colour, no such texel.
            let few = Texels::new(&words, form, &colours[..1]);
            assert!((0..512).any(|i| few.rgba(i) == [0; 4]));
            assert_eq!(texels.rgba(512), colours[0].to_le_bytes());
        }
    }
}
