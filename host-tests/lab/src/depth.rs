//! What is kept of 1/w, and lines of it (H2, K8). Nearer or equal is seen.

use crate::colours::Colours;
use crate::format::Format;
use scanbeam::pixel::Rgb565;
use scanbeam_model::BlockFix16;

/// A way to keep 1/w.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthMethod {
    /// 16 bits.
    Bits16,
    /// 22 bits, in a word whose other 10 may name the object.
    Bits22,
    /// 16 bits of block-fix 1/w: 2 say which of four ranges, 14 divide it evenly.
    BlockFix,
    /// All 31 bits.
    Bits32,
    /// Even steps of w up to 128, 25 fraction bits, for 1/w of 1 at 2^31; it is not linear on the screen, so each pixel
    /// divides.
    Linear,
    /// 16 bits, in a word above the pixel's own 16: one comparison and one store a pixel. What is seen is what
    /// [`Bits16`](Self::Bits16) shows; [`words`] is how it is drawn.
    Word,
}

/// 1/w along a span.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Depths {
    /// At the first pixel, 1 to 2^31 - 1.
    pub at: u32,
    /// To the next pixel, modulo 2^32.
    pub step: u32,
}

impl DepthMethod {
    /// The range of a triangle whose nearest corner has this 1/w, where the method has ranges.
    #[must_use]
    pub fn range(self, nearest: u32) -> u32 {
        match self {
            Self::BlockFix => BlockFix16::range_of(nearest),
            _ => 0,
        }
    }

    /// What is compared of 1/w in a triangle of this range: the nearer of two has no smaller one.
    #[must_use]
    pub fn key(self, depth: u32, range: u32) -> u32 {
        match self {
            Self::Bits16 | Self::Word => depth >> 15,
            Self::Bits22 => depth >> 9,
            Self::BlockFix => BlockFix16::new(depth, range).key(),
            Self::Bits32 => depth,
            Self::Linear => linear(depth),
        }
    }
}

/// All ones less w with 25 fraction bits.
#[inline(always)]
fn linear(depth: u32) -> u32 {
    !((1 << 56) / u64::from(depth.max(1 << 24))) as u32
}

/// What all lines share: steps along, and keeps what is not behind.
#[inline(always)]
fn each<W: Copy>(line: &mut [W], depths: Depths, mut test: impl FnMut(u32, W) -> Option<W>) {
    let mut at = depths.at;
    for cell in line {
        if let Some(kept) = test(at, *cell) {
            *cell = kept;
        }
        at = at.wrapping_add(depths.step);
    }
}

/// A line of [`DepthMethod::Bits16`].
#[inline(never)]
pub fn bits_16(line: &mut [u16], depths: Depths) {
    each(line, depths, |at, kept| {
        let depth = (at >> 15) as u16;
        (depth >= kept).then_some(depth)
    });
}

/// A line of [`DepthMethod::Bits22`], by an object of this number, below 1,024.
#[inline(never)]
pub fn bits_22(line: &mut [u32], depths: Depths, object: u32) {
    each(line, depths, |at, kept| {
        let word = at << 1 | 1023;
        (word >= kept).then_some(word & !1023 | object)
    });
}

/// A line of [`DepthMethod::BlockFix`], by a triangle of this range.
#[inline(never)]
pub fn block_fix(line: &mut [u16], depths: Depths, range: u32) {
    each(line, depths, |at, kept| {
        let depth = BlockFix16::new(at, range);
        let nearer = depth.covers(BlockFix16::from_bits(kept));
        nearer.then_some(depth.to_bits())
    });
}

/// A line of [`DepthMethod::Bits32`].
#[inline(never)]
pub fn bits_32(line: &mut [u32], depths: Depths) {
    each(line, depths, |at, kept| (at >= kept).then_some(at));
}

/// A line of [`DepthMethod::Linear`].
#[inline(never)]
pub fn even_w(line: &mut [u32], depths: Depths) {
    each(line, depths, |at, kept| {
        let depth = linear(at);
        (depth >= kept).then_some(depth)
    });
}

/// A line of [`DepthMethod::Word`]: depth above the pixel, whose colours are packed and anchored anew every 8 pixels.
///
/// What is compared has all lower bits set: where 16 bits of depth are the same, what is submitted later wins.
#[inline(never)]
pub fn words(line: &mut [u32], depths: Depths, colours: &Colours) {
    let (mut at, step) = (depths.at << 1, depths.step << 1);
    let mut from = *colours;
    for run in line.chunks_mut(8) {
        let mut ramp = from.ramp::<Rgb565>();
        for cell in run {
            if at | 0xFFFF >= *cell {
                *cell = at & 0xFFFF_0000 | u32::from(Rgb565::pixel(&ramp));
            }
            at = at.wrapping_add(step);
            ramp.step();
        }
        from = from.after(8);
    }
}

/// Takes the pixels out of a line of words, which become farthest; where nobody is, `pixels` stay.
#[inline(never)]
pub fn resolve(words: &mut [u32], pixels: &mut [u16]) {
    for (word, pixel) in words.iter_mut().zip(pixels) {
        if *word != 0 {
            *pixel = *word as u16;
        }
        *word = 0;
    }
}
