//! Formats of pixels, and how pixels are made: of one word of colour, or of two.
//!
//! | file | there |
//! |---|---|
//! | `format` | how a pixel looks in the line buffer: RGB565 in three orders of bytes, RGB888 |
//! | `xrgb`, `grey`, `indexed` | 32-bit words; 8 bits of grey and 1 bit made of it; numbers of a palette, which may differ from line to line |
//! | `blend`, `mix` | a new pixel and the one that is there become one: by any blend, by a mode |
//! | `mix_565`, `mix_bytes` | two pixels of 16 bits in a register; four channels of 8, or four pixels of grey |
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
pub(crate) use format::Rgb565Bytes;
pub use format::{PixelFormat, Rgb565, Rgb565Be, Rgb565Le, Rgb888};
pub use grey::{Grey8, mono_page, mono_row};
pub use indexed::{Index4, Index8, Indexed, expand_indices};
pub(crate) use mix::Mix;
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Kills: levels that are cut, or repeat the upper bits.
    #[test]
    fn levels_are_the_nearest() {
        for word in 0..=u16::MAX {
            let nearest = |step: u16, steps: u32| (u32::from(step) * 510 + steps) / (2 * steps);
            let [r, g, b] = Rgb565::to_rgb8(word).map(u32::from);
            assert_eq!((r, b), (nearest(word >> 11, 31), nearest(word & 31, 31)));
            assert_eq!(g, nearest(word >> 5 & 63, 63));
        }
    }

    /// Channels whose numbers of steps are no powers of two less one.
    struct Uneven;

    impl PixelFormat for Uneven {
        type Word = [u8; 3];
        const STEPS: [u16; 3] = [5, 9, 200];
        const MADE_OF: MadeOf = MadeOf::OneWord;

        fn pack(steps: [u8; 3]) -> [u8; 3] {
            steps
        }

        fn to_rgb8(word: [u8; 3]) -> [u8; 3] {
            [0, 1, 2].map(|i| (u16::from(word[i]) * 255 / Self::STEPS[i]) as u8)
        }

        fn widen(word: [u8; 3]) -> [u32; 2] {
            let [red, green, blue] = word.map(u32::from);
            [red << 20 | green << 4, blue << 4]
        }

        fn narrow([red_green, blue]: [u32; 2]) -> [u8; 3] {
            [red_green >> 20, red_green >> 4 & 255, blue >> 4].map(|steps| steps as u8)
        }
    }

    /// Kills: steps that begin a bit higher or lower, where their number is no power of two less one.
    #[test]
    fn steps_of_any_number_are_cut_from_a_word() {
        let field = |bits: u32, i: usize, step: u8, rest: bool| {
            let fraction = bits - 1 - Uneven::STEPS[i].ilog2();
            (u32::from(step) << fraction) | if rest { (1 << fraction) - 1 } else { 0 }
        };
        for (red, green) in (0..=5).flat_map(|red| (0..=9).map(move |green| (red, green))) {
            for (blue, rest) in (0..=200).flat_map(|blue| [(blue, false), (blue, true)]) {
                let word = field(11, 0, red, rest) << 21 | field(10, 2, blue, rest) << 11;
                let word = word | field(11, 1, green, rest);
                assert_eq!(Uneven::of_word(word), [red, green, blue]);
            }
        }
    }

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
    fn mixed<P: PixelFormat>(
        of: impl Fn([u8; 3]) -> P::Word,
        channels: impl Fn(P::Word) -> [u8; 3],
    ) {
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
