//! Formats of pixels, and pixels as the new hot path makes them: of one word of colour, or of two.
//!
//! A vertex's colour is one word: red in bits 31..21, blue in 20..11, green in 10..0, steps of the output and
//! the fraction bits that are left. Where the output has 16 bits, that word can step from pixel to pixel
//! as it is: two logical operations, a store and an addition a pixel.

mod blend;

pub(crate) use blend::blend;

pub use crate::composite::{
    Cut, CutOff, Dithered, Grey8, Index4, Index8, Indexed, LinePalettes, OneWord, Ordered,
    PaletteTable, PixelFormat, Pixels, Ramp, Ranks, Rgb565, Rgb565Be, Rgb565Bytes, Rgb565Le,
    Rgb888, Threshold, TwoWords, Xrgb8888, expand_indices, mono_page, mono_row,
};

/// How a pixel is made of a colour.
pub trait Pixel: PixelFormat {
    /// Whether a word of colour keeps enough of it over 25 pixels.
    const PACKED: bool;

    /// A pixel from a word of colour.
    #[inline(always)]
    fn of_word(word: u32) -> Self::Word {
        Self::pack_words(word & 0xFFE0_0000 | word >> 5 & 0xFFC0, word << 21)
    }

    /// Two pixels from two words of colour.
    #[inline(always)]
    fn of_words(words: [u32; 2]) -> [Self::Word; 2] {
        words.map(Self::of_word)
    }
}

/// The upper bits of the three fields, each at its place in one half of the word or the other.
#[inline(always)]
fn to_565(word: u32) -> u16 {
    let fields = word & 0xF81F_07E0;
    (fields | fields >> 16) as u16
}

/// Two pixels in one word, the first in the lower half: red and blue are in the upper half of a word of colour,
/// green is in the lower one.
#[inline(always)]
fn pair_565([first, second]: [u32; 2]) -> u32 {
    const GREEN: u32 = 0x07E0_07E0;
    let upper = first >> 16 | second & 0xFFFF_0000;
    let lower = first & 0xFFFF | second << 16;
    upper & !GREEN | lower & GREEN
}

/// Both halves of a word with their bytes swapped: one instruction for two pixels, where it is two for each alone.
#[inline(always)]
fn swapped_halves(word: u32) -> u32 {
    word.swap_bytes().rotate_left(16)
}

#[inline(always)]
fn halves(word: u32) -> [u16; 2] {
    [word as u16, (word >> 16) as u16]
}

impl Pixel for Rgb565 {
    const PACKED: bool = true;

    #[inline(always)]
    fn of_word(word: u32) -> u16 {
        to_565(word)
    }

    #[inline(always)]
    fn of_words(words: [u32; 2]) -> [u16; 2] {
        halves(pair_565(words))
    }
}

impl<const BIG: bool> Pixel for Rgb565Bytes<BIG> {
    const PACKED: bool = true;

    #[inline(always)]
    fn of_word(word: u32) -> u16 {
        let word = to_565(word);
        if BIG { word.to_be() } else { word.to_le() }
    }

    #[inline(always)]
    fn of_words(words: [u32; 2]) -> [u16; 2] {
        let pair = pair_565(words);
        if BIG == cfg!(target_endian = "big") {
            halves(pair)
        } else {
            halves(swapped_halves(pair))
        }
    }
}

impl Pixel for Rgb888 {
    const PACKED: bool = false;
}

impl Pixel for Xrgb8888 {
    const PACKED: bool = false;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_and_pairs_give_the_same_pixels() {
        for i in 0..200_000u32 {
            let word = i.wrapping_mul(0x9E37_79B9);
            let (red, blue, green) = (word >> 21, word >> 11 & 0x3FF, word & 0x7FF);
            let want = red >> 6 << 11 | green >> 5 << 5 | blue >> 5;
            assert_eq!(u32::from(Rgb565::of_word(word)), want);
            let pair = (red << 21 | blue << 6, green << 21);
            assert_eq!(Rgb565::of_word(word), Rgb565::pack_words(pair.0, pair.1));
            assert_eq!(Rgb888::of_word(word), Rgb888::pack_words(pair.0, pair.1));
            let big = crate::composite::Rgb565Be::of_word(word);
            assert_eq!(big.to_ne_bytes(), Rgb565::of_word(word).to_be_bytes());
            let two = [word, word.rotate_left(7) ^ i];
            assert_eq!(Rgb565::of_words(two), two.map(Rgb565::of_word));
            assert_eq!(Rgb888::of_words(two), two.map(Rgb888::of_word));
            let swapped = two.map(crate::composite::Rgb565Be::of_word);
            assert_eq!(crate::composite::Rgb565Be::of_words(two), swapped);
        }
    }
}
