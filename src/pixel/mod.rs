//! Formats of pixels, and how pixels are made: of one word of colour, or of two.
//!
//! | file | there |
//! |---|---|
//! | `format` | how a pixel looks in the line buffer: RGB565 in three orders of bytes, RGB888 |
//! | `xrgb`, `grey`, `indexed` | 32-bit words; 8 bits of grey and 1 bit made of it; numbers of a palette, which may differ from line to line |
//! | `blend`, `mix` | a new pixel and the one that is there become one: by any blend, by a mode |
//! | `mix_565`, `mix_bytes` | two pixels of 16 bits in a register; four channels of 8 |
//! | `between` | lines and columns doubled |
//! | `ordered` | the order of a 4 x 4 dither |
//!
//! A vertex's colour is one word: red in bits 31..21, blue in 20..11, green in 10..0, steps of the output and
//! the fraction bits that are left. Where the output has 16 bits, that word can step from pixel to pixel
//! as it is: two logical operations, a store and an addition a pixel.

mod between;
mod blend;
mod format;
mod grey;
mod indexed;
mod mix;
mod mix_565;
mod mix_bytes;
mod ordered;
mod xrgb;

pub(crate) use blend::{blend, blend_each};
pub use format::{PixelFormat, Rgb565, Rgb565Be, Rgb565Bytes, Rgb565Le, Rgb888};
pub use grey::{Grey8, mono_page, mono_row};
pub use indexed::{Index4, Index8, Indexed, LinePalettes, PaletteTable, expand_indices};
pub use mix::Mix;
pub(crate) use ordered::threshold;
pub use xrgb::Xrgb8888;

/// What pixels of a format are made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MadeOf {
    /// One word of colour, which keeps enough of it over 25 pixels.
    OneWord,
    /// Two words of colour.
    TwoWords,
    /// Red alone, which is a number of a palette: no two pixels have one between them.
    Index,
}

impl MadeOf {
    #[inline(always)]
    pub(crate) const fn is_one_word(self) -> bool {
        matches!(self, Self::OneWord)
    }
}

/// How a pixel is made of a colour, and of other pixels.
pub trait Pixel: PixelFormat {
    /// What a pixel is made of.
    const MADE_OF: MadeOf;

    /// A pixel from a word of colour.
    #[inline(always)]
    fn of_word(word: u32) -> Self::Word {
        Self::pack_words(word & 0xFFE0_0000 | word >> 5 & 0xFFC0, word << 21)
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

/// A pixel in both halves of a word: the upper bits of the three fields, each at its place in one half or the other.
#[inline(always)]
fn twice_565(word: u32) -> u32 {
    let fields = word & 0xF81F_07E0;
    fields | fields.rotate_right(16)
}

impl Pixel for Rgb565 {
    const MADE_OF: MadeOf = MadeOf::OneWord;

    #[inline(always)]
    fn of_word(word: u32) -> u16 {
        twice_565(word) as u16
    }

    #[inline(always)]
    fn widen(word: u16) -> [u32; 2] {
        between::widen_565(word)
    }

    #[inline(always)]
    fn narrow(fields: [u32; 2]) -> u16 {
        between::narrow_565(fields)
    }
}

impl<const BIG: bool> Pixel for Rgb565Bytes<BIG> {
    const MADE_OF: MadeOf = MadeOf::OneWord;

    #[inline(always)]
    fn of_word(word: u32) -> u16 {
        let twice = twice_565(word);
        let is_native = BIG == cfg!(target_endian = "big");
        // Of a pixel that is there twice, the bytes between are its own swapped.
        (if is_native { twice } else { twice >> 8 }) as u16
    }

    #[inline(always)]
    fn widen(word: u16) -> [u32; 2] {
        between::widen_565(if BIG {
            u16::from_be(word)
        } else {
            u16::from_le(word)
        })
    }

    #[inline(always)]
    fn narrow(fields: [u32; 2]) -> u16 {
        let word = between::narrow_565(fields);
        if BIG { word.to_be() } else { word.to_le() }
    }
}

impl Pixel for Rgb888 {
    const MADE_OF: MadeOf = MadeOf::TwoWords;

    #[inline(always)]
    fn widen([red, green, blue]: [u8; 3]) -> [u32; 2] {
        [u32::from(red) << 16 | u32::from(blue), green.into()]
    }

    #[inline(always)]
    fn narrow([red_blue, green]: [u32; 2]) -> [u8; 3] {
        let (red_blue, green) = (red_blue + 0x8_0008, green + 8);
        [
            (red_blue >> 20) as u8,
            (green >> 4) as u8,
            (red_blue >> 4) as u8,
        ]
    }
}

impl Pixel for Xrgb8888 {
    const MADE_OF: MadeOf = MadeOf::TwoWords;

    #[inline(always)]
    fn widen(word: u32) -> [u32; 2] {
        [word & 0xFF_00FF, word >> 8 & 0xFF]
    }

    #[inline(always)]
    fn narrow([red_blue, green]: [u32; 2]) -> u32 {
        (red_blue + 0x8_0008) >> 4 & 0xFF_00FF | (green + 8) << 4 & 0xFF00
    }
}

impl Pixel for Grey8 {
    const MADE_OF: MadeOf = MadeOf::TwoWords;

    #[inline(always)]
    fn widen(word: u8) -> [u32; 2] {
        [word.into(), 0]
    }

    #[inline(always)]
    fn narrow([grey, _]: [u32; 2]) -> u8 {
        ((grey + 8) >> 4) as u8
    }
}

/// Numbers are not mixed: of doubled lines and columns each pixel is the nearest one.
impl<const N: usize> Pixel for Indexed<N> {
    const MADE_OF: MadeOf = MadeOf::Index;

    #[inline(always)]
    fn widen(word: u8) -> [u32; 2] {
        [word.into(), 0]
    }

    #[inline(always)]
    fn narrow([index, _]: [u32; 2]) -> u8 {
        (index >> 4) as u8
    }

    fn mix_lines(near: &[u8], _: &[u8], sent: &mut [u8]) {
        for (pair, index) in sent.chunks_mut(2).zip(near) {
            pair.fill(*index);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_give_the_pixels_of_pairs() {
        for i in 0..200_000u32 {
            let word = i.wrapping_mul(0x9E37_79B9);
            let (red, blue, green) = (word >> 21, word >> 11 & 0x3FF, word & 0x7FF);
            let want = red >> 6 << 11 | green >> 5 << 5 | blue >> 5;
            assert_eq!(u32::from(Rgb565::of_word(word)), want);
            let pair = (red << 21 | blue << 6, green << 21);
            assert_eq!(Rgb565::of_word(word), Rgb565::pack_words(pair.0, pair.1));
            assert_eq!(Rgb888::of_word(word), Rgb888::pack_words(pair.0, pair.1));
            let big = Rgb565Be::of_word(word);
            assert_eq!(big.to_ne_bytes(), Rgb565::of_word(word).to_be_bytes());
            let little = Rgb565Le::of_word(word);
            assert_eq!(little.to_ne_bytes(), Rgb565::of_word(word).to_le_bytes());
        }
    }

    /// Two pixels as parts of 16, channel by channel: what `narrow` says.
    fn mixed<P: Pixel>(of: impl Fn([u8; 3]) -> P::Word, channels: impl Fn(P::Word) -> [u8; 3]) {
        for i in 0..50_000u32 {
            let bytes = |n: u32| {
                i.wrapping_mul(0x9E37_79B9)
                    .wrapping_add(n)
                    .rotate_left(n)
                    .to_le_bytes()
            };
            let ([a0, a1, a2, k], [b0, b1, b2, _]) = (bytes(0), bytes(11));
            let (a, b, k) = (of([a0, a1, a2]), of([b0, b1, b2]), u32::from(k) % 17);
            let fields = [0, 1].map(|n| P::widen(a)[n] * k + P::widen(b)[n] * (16 - k));
            let want = [0, 1, 2].map(|n| {
                let [a, b] = [channels(a)[n], channels(b)[n]].map(u32::from);
                ((a * k + b * (16 - k) + 8) / 16) as u8
            });
            assert_eq!(channels(P::narrow(fields)), want, "{i} {k}");
        }
    }

    /// Kills: channels that run into one another, and rounding down.
    #[test]
    fn channels_are_mixed_to_the_nearest_step() {
        mixed::<Rgb888>(|rgb| rgb, |word| word);
        let xrgb = |[red, green, blue]: [u8; 3]| u32::from_be_bytes([0, red, green, blue]);
        mixed::<Xrgb8888>(xrgb, |word| {
            let [_, red, green, blue] = word.to_be_bytes();
            [red, green, blue]
        });
        mixed::<Grey8>(|[grey, _, _]| grey, |word| [word; 3]);
    }
}
