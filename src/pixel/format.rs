//! How a pixel looks in the line buffer, byte order included (K12).

use super::mix::{Mix, mix_levels};
use super::mix_565::{mix_565, mix_one};
use super::mix_bytes::mix_bytes;
use super::{MadeOf, between};
use crate::num::{SHORT, of_255};

/// How a pixel looks in the line buffer, and how it is made of a colour and of other pixels.
pub trait PixelFormat {
    /// One pixel.
    type Word: bytemuck::NoUninit + Send + Sync + PartialEq + Default;
    /// Steps a channel above 0: 255 for 8 bits.
    const STEPS: [u16; 3];
    /// What a pixel is made of.
    const MADE_OF: MadeOf;

    /// A pixel from whole steps, each at most [`STEPS`](PixelFormat::STEPS).
    fn pack(steps: [u8; 3]) -> Self::Word;

    /// A pixel from two words with 16 bits a channel: red and blue, green in the upper half. They hold steps, the largest
    /// number of [`STEPS`](PixelFormat::STEPS) with its top bit at the top. Unless a format has a way of its own, these are
    /// cut to whole steps.
    #[inline(always)]
    fn pack_words(red_blue: u32, green: u32) -> Self::Word {
        let channels = [red_blue >> 16, green >> 16, red_blue & 0xFFFF];
        Self::pack([0, 1, 2].map(|i| (channels[i] >> Self::STEPS[i].leading_zeros()) as u8))
    }

    /// Sets all of `pixels` to `word`.
    #[inline]
    fn fill(pixels: &mut [Self::Word], word: Self::Word) {
        pixels.fill(word);
    }

    /// Blends `new` pixels over `old` ones, as many as both have.
    #[doc(hidden)]
    fn mix(old: &mut [Self::Word], new: &[Self::Word], mix: Mix)
    where
        Self: Sized,
    {
        mix_levels::<Self>(old, new, mix);
    }

    /// Blends one new pixel over an old one.
    #[doc(hidden)]
    #[inline(always)]
    fn mix_one(old: Self::Word, new: Self::Word, mix: Mix) -> Self::Word
    where
        Self: Sized,
    {
        let mut word = [old];
        Self::mix(&mut word, &[new], mix);
        word[0]
    }

    /// The sum of two pixels, each channel at most its full light.
    fn add(a: Self::Word, b: Self::Word) -> Self::Word {
        // Levels are off by half a level each, so what they add up to is nearest to the right
        // step of up to 7 bits, and of 8 bits they are exact.
        let (a, b) = (Self::to_rgb8(a), Self::to_rgb8(b));
        Self::from_rgb8([0, 1, 2].map(|i| a[i].saturating_add(b[i])))
    }

    /// A pixel from 8-bit levels, rounded to nearest.
    fn from_rgb8(rgb: [u8; 3]) -> Self::Word {
        Self::pack([0, 1, 2].map(|i| match Self::STEPS[i] {
            255 => rgb[i],
            steps => of_255(u32::from(rgb[i]) * u32::from(steps)) as u8,
        }))
    }

    /// The 8-bit levels a display shows for a pixel, rounded to nearest.
    fn to_rgb8(word: Self::Word) -> [u8; 3];

    /// A texel of textures for such pixels: a pixel where that has 16 bits, else a number of 5, 6 and 5 bits.
    fn texel(rgb: [u8; 3]) -> u16 {
        Rgb565::from_rgb8(rgb)
    }

    /// A pixel from a word of colour.
    #[inline(always)]
    fn of_word(word: u32) -> Self::Word {
        Self::pack_words(word & 0xFFE0_0000 | word >> 5 & 0xFFC0, word << 21)
    }

    /// Sets two pixels to words of colour.
    #[doc(hidden)]
    #[inline(always)]
    fn set_two([a, b]: [&mut Self::Word; 2], [first, second]: [u32; 2]) {
        (*a, *b) = (Self::of_word(first), Self::of_word(second));
    }

    /// The fields of a pixel, each with four bits free above it.
    fn widen(word: Self::Word) -> [u32; 2];

    /// The pixel of fields of 16 times its steps, to the nearest step, halves up.
    fn narrow(fields: [u32; 2]) -> Self::Word;

    /// A line that is sent of a picture with half as many lines and columns: from the drawn line
    /// that it lies in and the one on its other side, for
    /// [`send_doubled`](crate::scan_out::send_doubled).
    fn mix_lines(near: &[Self::Word], far: &[Self::Word], sent: &mut [Self::Word])
    where
        Self: Sized,
    {
        between::mix::<Self>(near, far, sent);
    }
}

/// Three bytes, red first.
#[derive(Clone, Copy, Debug)]
pub struct Rgb888;

/// Five, six and five bits with their bytes in memory in the order of the processor, or in a stated one.
#[derive(Clone, Copy, Debug)]
pub struct Rgb565Bytes<const ORDER: u8>;

/// Five, six and five bits as a 16-bit number, for parallel buses and frame buffers.
pub type Rgb565 = Rgb565Bytes<0>;

/// Five, six and five bits with the high byte first in memory, for SPI panels.
pub type Rgb565Be = Rgb565Bytes<BIG>;

/// Five, six and five bits with the low byte first in memory.
pub type Rgb565Le = Rgb565Bytes<LITTLE>;

/// Orders that are stated.
const BIG: u8 = 1;
const LITTLE: u8 = 2;

impl<const ORDER: u8> Rgb565Bytes<ORDER> {
    /// Whether that is the order of the processor.
    const IS_NATIVE: bool = ORDER
        != if cfg!(target_endian = "big") {
            LITTLE
        } else {
            BIG
        };

    /// A native word with its bytes in that order, and back.
    #[inline(always)]
    pub(crate) const fn in_memory(word: u16) -> u16 {
        if Self::IS_NATIVE {
            word
        } else {
            word.swap_bytes()
        }
    }
}

/// Repeats three bytes.
fn fill_bytes(bytes: &mut [u8], three: [u8; 3]) {
    for (byte, level) in bytes.iter_mut().zip(three.iter().cycle()) {
        *byte = *level;
    }
}

impl PixelFormat for Rgb888 {
    type Word = [u8; 3];
    const STEPS: [u16; 3] = [255; 3];
    const MADE_OF: MadeOf = MadeOf::TwoWords;

    #[inline(always)]
    fn pack(steps: [u8; 3]) -> [u8; 3] {
        steps
    }

    #[inline(always)]
    fn pack_words(red_blue: u32, green: u32) -> [u8; 3] {
        [red_blue >> 24, green >> 24, red_blue >> 8].map(|level| level as u8)
    }

    /// Four pixels at a time, which are three words, where there are enough of them.
    #[inline]
    fn fill(pixels: &mut [[u8; 3]], mut word: [u8; 3]) {
        if pixels.len() < 16 {
            return pixels.fill(word);
        }
        let bytes = pixels.as_flattened_mut();
        let (before, words, after) = bytemuck::pod_align_to_mut::<u8, [u32; 3]>(bytes);
        fill_bytes(before, word);
        word.rotate_left(before.len() % 3);
        words.fill(bytemuck::cast([word; 4]));
        fill_bytes(after, word);
    }

    fn mix(old: &mut [[u8; 3]], new: &[[u8; 3]], mix: Mix) {
        mix_bytes(old.as_flattened_mut(), new.as_flattened(), mix);
    }

    fn to_rgb8(word: [u8; 3]) -> [u8; 3] {
        word
    }

    #[inline(always)]
    fn widen([red, green, blue]: [u8; 3]) -> [u32; 2] {
        [u32::from(red) << 16 | u32::from(blue), green.into()]
    }

    #[inline(always)]
    fn narrow([red_blue, green]: [u32; 2]) -> [u8; 3] {
        let (red_blue, green) = (red_blue + 0x8_0008, green + 8);
        [red_blue >> 20, green >> 4, red_blue >> 4].map(|level| level as u8)
    }
}

impl<const ORDER: u8> PixelFormat for Rgb565Bytes<ORDER> {
    type Word = u16;
    const STEPS: [u16; 3] = [31, 63, 31];
    const MADE_OF: MadeOf = MadeOf::OneWord;

    #[inline(always)]
    fn pack(s: [u8; 3]) -> u16 {
        Self::in_memory(u16::from(s[0]) << 11 | u16::from(s[1]) << 5 | u16::from(s[2]))
    }

    #[inline(always)]
    fn pack_words(red_blue: u32, green: u32) -> u16 {
        let word = (red_blue >> 16 & 0xF800) | (green >> 26) << 5 | (red_blue >> 11 & 0x1F);
        Self::in_memory(word as u16)
    }

    /// Sixteen pixels a step: 0.4 instructions a pixel on a Cortex-M4, where one a store takes
    /// 1.8.
    #[inline]
    fn fill(pixels: &mut [u16], word: u16) {
        let (head, pairs, tail) = bytemuck::pod_align_to_mut::<u16, u32>(pixels);
        head.fill(word);
        let pair = u32::from(word) << 16 | u32::from(word);
        let mut runs = pairs.chunks_exact_mut(8);
        for run in &mut runs {
            run.copy_from_slice(&[pair; 8]);
        }
        runs.into_remainder().fill(pair);
        tail.fill(word);
    }

    fn mix(old: &mut [u16], new: &[u16], mix: Mix) {
        let order = |pair| match Self::IS_NATIVE {
            true => pair,
            false => swapped_halves(pair),
        };
        mix_565(old, new, order, mix);
    }

    #[inline(always)]
    fn mix_one(old: u16, new: u16, mix: Mix) -> u16 {
        let [old, new] = [old, new].map(Self::in_memory);
        Self::in_memory(mix_one(old, new, mix))
    }

    /// All channels at once, with room above each for its carry.
    #[inline(always)]
    fn add(a: u16, b: u16) -> u16 {
        let sum = Self::widen(a)[0] + Self::widen(b)[0];
        // Of what has overflown all bits are set: 5 below the carry, of green one more.
        let over = sum & 0x0801_0020;
        let full = (over - (over >> 5)) | over >> 6 & 0x0020_0000;
        Self::in_memory(between::joined_565((sum | full) & between::FIELDS_565))
    }

    fn texel(rgb: [u8; 3]) -> u16 {
        Self::from_rgb8(rgb)
    }

    fn to_rgb8(word: u16) -> [u8; 3] {
        // To swap the bytes, or not to, is its own inverse.
        let word = Self::in_memory(word);
        let [r, g, b] = [word >> 11, word >> 5 & 63, word & 31];
        // Exact, without a division.
        [r * 527 + 23, g * 259 + 33, b * 527 + 23].map(|level| (level >> 6) as u8)
    }

    #[inline(always)]
    fn of_word(word: u32) -> u16 {
        // The upper bits of the three fields, each at its place in one half or the other.
        let fields = word & between::FIELDS_565.rotate_left(16);
        let pixel = match (Self::IS_NATIVE, SHORT) {
            (true, _) => fields | fields >> 16,
            (false, true) => swapped_halves(fields | fields >> 16),
            // Of a pixel that is there twice, the bytes between are its own swapped: here no instruction of their own.
            (false, false) => (fields | fields.rotate_right(16)) >> 8,
        };
        pixel as u16
    }

    #[inline(always)]
    fn set_two([a, b]: [&mut u16; 2], words: [u32; 2]) {
        if Self::IS_NATIVE || SHORT {
            (*a, *b) = (Self::of_word(words[0]), Self::of_word(words[1]));
            return;
        }
        // A product puts both halves of a word in the upper one. Of a rotation the compiler would keep each field
        // apart, and put it in its half alone.
        let fields = between::FIELDS_565.rotate_left(16);
        let [first, second] = words.map(|word| (word & fields).wrapping_mul(0x1_0001));
        let both = swapped_halves(second & 0xFFFF_0000 | first >> 16);
        (*a, *b) = (both as u16, (both >> 16) as u16);
    }

    #[inline(always)]
    fn widen(word: u16) -> [u32; 2] {
        [between::apart_565(Self::in_memory(word)), 0]
    }

    #[inline(always)]
    fn narrow([wide, _]: [u32; 2]) -> u16 {
        /// Half a step of each field.
        const HALVES: u32 = 8 << 21 | 8 << 11 | 8;
        let fields = (wide + HALVES) >> 4 & between::FIELDS_565;
        Self::in_memory(between::joined_565(fields))
    }
}

/// Both halves of a word with their bytes swapped: one instruction for two pixels, where it is two for each alone.
#[inline(always)]
fn swapped_halves(word: u32) -> u32 {
    word.swap_bytes().rotate_left(16)
}
