//! Pixel formats of the line buffer, byte order included (K12), and how colours become pixels.
//!
//! | file | there |
//! |---|---|
//! | `paint.rs` | the pixels of a span, by the method that the pipeline chose |
//! | `course.rs` | where a span's colours come from: planes in two words, or in three channels |
//! | `ramp.rs` | packed channels in one or two registers |
//! | `lirp.rs` | LIRP between a span's ends |
//! | `words.rs` | colours straight into words of depth and colour |
//! | `texel.rs` | a texel as pixels take it |
//! | `texels.rs` | texels times the shaded colour |
//! | `detailed.rs` | texels in levels of detail |
//! | `listed.rs` | overlays of an instruction list |
//! | `blend/` | a new pixel and the one that is there become one |
//! | `compositing.rs` | whether surfaces have a finish |
//! | `dither.rs` | ordered dither, and cutting instead of rounding |
//! | `grey.rs` | 8-bit grey, and 1 bit a pixel made of it |
//! | `indexed.rs` | numbers of a palette, which may differ from line to line |
//! | `xrgb.rs` | 8 bits a channel in a 32-bit word |
//! | `overlay.rs` | runs and sprites over a finished line |
//! | `canvas.rs` | drawables of `embedded-graphics` into such |

mod blend;
#[cfg(feature = "embedded-graphics")]
mod canvas;
mod compositing;
mod course;
mod detailed;
mod dither;
mod grey;
mod indexed;
mod lirp;
mod listed;
mod overlay;
mod paint;
mod ramp;
#[cfg(test)]
mod tests;
mod texel;
mod texels;
mod words;
mod xrgb;

pub(crate) use blend::mix_pair_565;
pub use blend::{Blender, Mix, PixelAlpha};
#[cfg(feature = "embedded-graphics")]
pub use canvas::{Canvas, DrawnLines};
pub use compositing::{Blending, Compositing};
pub use detailed::DetailedTextures;
pub use dither::{Cut, CutOff, Dithered, Ordered, Ranks, Threshold};
pub use grey::{Grey8, mono_page, mono_row};
pub use indexed::{Index4, Index8, Indexed, LinePalettes, PaletteTable, expand_indices};
pub use listed::ListOverlays;
pub use overlay::{Ink, LineOverlay, Overlay, Pixels, Sprite, UnsortedSprites};
pub(crate) use paint::paint;
pub use ramp::{OneWord, Ramp, TwoWords};
pub use texel::TexelOf;
pub use texels::{TextureSource, Textures};
pub(crate) use words::paint_words;
pub use xrgb::Xrgb8888;

use crate::shade::Precision;

/// How a pixel looks in the line buffer.
pub trait PixelFormat {
    /// One pixel.
    type Word: Copy + Send + Sync + PartialEq + Default + 'static;
    /// Steps a channel above 0: 255 for 8 bits.
    const STEPS: [u16; 3];
    /// Bits a channel, which its steps tell.
    const BITS: [u32; 3] = [
        16 - Self::STEPS[0].leading_zeros(),
        16 - Self::STEPS[1].leading_zeros(),
        16 - Self::STEPS[2].leading_zeros(),
    ];

    /// What a [`Ramp`](PixelFormat::Ramp) errs.
    const PRECISION: Precision;
    /// Whether a ramp has fewer bits than the two words that it starts from.
    const CUTS: bool;

    /// A pixel from whole steps, each at most [`STEPS`](PixelFormat::STEPS).
    fn pack(steps: [u8; 3]) -> Self::Word;

    /// A pixel from two words with 16 bits a channel: red and blue, green in the upper half.
    fn pack_words(red_blue: u32, green: u32) -> Self::Word;

    /// Whether a pixel depends on its place; only [`Dithered`] formats do.
    const DITHERS: bool = false;

    /// The thresholds of four pixels of a line, the first at this column and line of the picture
    /// modulo 4.
    #[inline(always)]
    fn thresholds(tile: (u8, u8)) -> [Threshold; 4] {
        let _ = tile;
        [Threshold::default(); 4]
    }

    /// A pixel from whole steps at a place with this threshold.
    #[inline(always)]
    fn pack_at(steps: [u8; 3], threshold: Threshold) -> Self::Word {
        let _ = threshold;
        Self::pack(steps)
    }

    /// A pixel from two words, as [`pack_words`](PixelFormat::pack_words), at a place with this
    /// threshold.
    #[inline(always)]
    fn pack_words_at(red_blue: u32, green: u32, threshold: Threshold) -> Self::Word {
        let _ = threshold;
        Self::pack_words(red_blue, green)
    }

    /// Three channels that step from pixel to pixel in as few registers as the format needs.
    type Ramp: Ramp<Self>;

    /// Whether a pixel has at most 16 bits, so that a word has room for its depth too (see
    /// [`DepthAndColour`](crate::pipeline::DepthAndColour)).
    const HALVES: bool = false;

    /// A pixel in 16 bits, where it has no more.
    #[inline(always)]
    fn to_half(word: Self::Word) -> u16 {
        let _ = word;
        0
    }

    /// The pixel that [`to_half`](PixelFormat::to_half) has put into 16 bits.
    #[inline(always)]
    fn from_half(half: u16) -> Self::Word {
        let _ = half;
        Self::Word::default()
    }

    /// Sets all of `pixels` to `word`.
    #[inline]
    fn fill(pixels: &mut [Self::Word], word: Self::Word) {
        pixels.fill(word);
    }

    /// Blends `new` pixels over `old` ones, as many as both have.
    fn mix(old: &mut [Self::Word], new: &[Self::Word], mix: Mix)
    where
        Self: Sized,
    {
        blend::mix_levels::<Self>(old, new, mix);
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
        let mut steps = [0; 3];
        for i in 0..3 {
            steps[i] = ((u32::from(rgb[i]) * u32::from(Self::STEPS[i]) + 127) / 255) as u8;
        }
        Self::pack(steps)
    }

    /// The 8-bit levels a display shows for a pixel, rounded to nearest.
    fn to_rgb8(word: Self::Word) -> [u8; 3];
}

/// Three bytes, red first.
#[derive(Clone, Copy, Debug)]
pub struct Rgb888;

/// Five, six and five bits as a 16-bit number, for parallel buses and frame buffers.
#[derive(Clone, Copy, Debug)]
pub struct Rgb565;

/// Five, six and five bits in a stated order of bytes in memory: the high one first if `BIG`.
#[derive(Clone, Copy, Debug)]
pub struct Rgb565Bytes<const BIG: bool>;

/// Five, six and five bits with the high byte first in memory, for SPI panels.
pub type Rgb565Be = Rgb565Bytes<true>;

/// Five, six and five bits with the low byte first in memory.
pub type Rgb565Le = Rgb565Bytes<false>;

impl<const BIG: bool> Rgb565Bytes<BIG> {
    /// A native word with its bytes in the stated order.
    #[inline(always)]
    const fn in_memory(word: u16) -> u16 {
        if BIG { word.to_be() } else { word.to_le() }
    }
}

impl PixelFormat for Rgb888 {
    type Word = [u8; 3];
    const STEPS: [u16; 3] = [255; 3];
    /// All that there is for a small triangle; of a large one, what its 16.16 has beyond 8.8.
    const PRECISION: Precision = Precision { unit: 1, drift: 1 };
    const CUTS: bool = false;

    #[inline(always)]
    fn pack(steps: [u8; 3]) -> [u8; 3] {
        steps
    }

    #[inline(always)]
    fn pack_words(red_blue: u32, green: u32) -> [u8; 3] {
        [
            (red_blue >> 24) as u8,
            (green >> 24) as u8,
            (red_blue >> 8) as u8,
        ]
    }

    type Ramp = TwoWords;

    fn mix(old: &mut [[u8; 3]], new: &[[u8; 3]], mix: Mix) {
        blend::mix_bytes(old.as_flattened_mut(), new.as_flattened(), mix);
    }

    fn to_rgb8(word: [u8; 3]) -> [u8; 3] {
        word
    }
}

impl PixelFormat for Rgb565 {
    type Word = u16;
    const STEPS: [u16; 3] = [31, 63, 31];
    /// Blue's: 5 fraction bits of 11.
    const PRECISION: Precision = Precision {
        unit: 64,
        drift: 32,
    };
    const CUTS: bool = true;

    #[inline(always)]
    fn pack(s: [u8; 3]) -> u16 {
        u16::from(s[0]) << 11 | u16::from(s[1]) << 5 | u16::from(s[2])
    }

    #[inline(always)]
    fn pack_words(red_blue: u32, green: u32) -> u16 {
        ((red_blue >> 16 & 0xF800) | (green >> 26) << 5 | (red_blue >> 11 & 0x1F)) as u16
    }

    type Ramp = OneWord;

    const HALVES: bool = true;

    #[inline(always)]
    fn to_half(word: u16) -> u16 {
        word
    }

    #[inline(always)]
    fn from_half(half: u16) -> u16 {
        half
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
        blend::mix_565::<false>(old, new, mix);
    }

    /// All channels at once, with room above each for its carry.
    #[inline(always)]
    fn add(a: u16, b: u16) -> u16 {
        let apart = |word: u16| (u32::from(word) << 16 | u32::from(word)) & 0x07E0_F81F;
        let sum = apart(a) + apart(b);
        // Of what has overflown all bits are set: 5 below the carry, of green one more.
        let over = sum & 0x0801_0020;
        let full = (over - (over >> 5)) | over >> 6 & 0x0020_0000;
        let sum = (sum | full) & 0x07E0_F81F;
        (sum | sum >> 16) as u16
    }

    fn to_rgb8(word: u16) -> [u8; 3] {
        let scale = |v: u16, steps: u16| {
            ((u32::from(v) * 510 + u32::from(steps)) / (2 * u32::from(steps))) as u8
        };
        [
            scale(word >> 11, 31),
            scale(word >> 5 & 63, 63),
            scale(word & 31, 31),
        ]
    }
}

impl<const BIG: bool> PixelFormat for Rgb565Bytes<BIG> {
    type Word = u16;
    const STEPS: [u16; 3] = Rgb565::STEPS;
    const PRECISION: Precision = Rgb565::PRECISION;
    const CUTS: bool = Rgb565::CUTS;

    #[inline(always)]
    fn pack(s: [u8; 3]) -> u16 {
        Self::in_memory(Rgb565::pack(s))
    }

    #[inline(always)]
    fn pack_words(red_blue: u32, green: u32) -> u16 {
        Self::in_memory(Rgb565::pack_words(red_blue, green))
    }

    type Ramp = OneWord;

    const HALVES: bool = true;

    #[inline(always)]
    fn to_half(word: u16) -> u16 {
        word
    }

    #[inline(always)]
    fn from_half(half: u16) -> u16 {
        half
    }

    #[inline(always)]
    fn fill(pixels: &mut [u16], word: u16) {
        Rgb565::fill(pixels, word);
    }

    fn mix(old: &mut [u16], new: &[u16], mix: Mix) {
        if Self::in_memory(1) == 1 {
            blend::mix_565::<false>(old, new, mix);
        } else {
            blend::mix_565::<true>(old, new, mix);
        }
    }

    #[inline(always)]
    fn add(a: u16, b: u16) -> u16 {
        Self::in_memory(Rgb565::add(Self::in_memory(a), Self::in_memory(b)))
    }

    fn to_rgb8(word: u16) -> [u8; 3] {
        // To swap the bytes, or not to, is its own inverse.
        Rgb565::to_rgb8(Self::in_memory(word))
    }
}
