//! Texture places along a span, in perspective (H3, H4, H5, K18).
//!
//! 1/w, u/w and v/w are linear on the screen and share the triangle's exponent, which therefore
//! cancels in `u = (u/w) / (1/w)`. The division is a normalised reciprocal with one Newton step.
//! It can be made at every pixel, or at the ends of runs of pixels between which u and v are
//! taken as linear. A span's first and last pixel are exact in every way of drawing, the last one
//! but for the rounding of its run's step (2^-18 texel a pixel); so neighbours fit together.
//!
//! Instructions on a Cortex-M4 (rustc 1.95, `bench_texture` of `host-tests/firmware`), spans of 320
//! pixels, texel fetched and stored; a span takes 75 to 130 more.
//!
//! | [`Stride`] | divisions | a square of 128 | of any size |
//! |---|---|---|---|
//! | `Affine` | 2 a span | 6.3 a pixel, 7.6 with a table | |
//! | `Sixteen` | 1 every 16 pixels | 8.5 | 11.6 |
//! | `Eight` | 1 every 8 pixels | 11.4 | |
//! | `Four` | 1 every 4 pixels | 16.3 | |
//! | `Two` | 1 every 2nd pixel, the average between (H5) | 22.8 | |
//! | `One` | 1 a pixel | 23.0, 25.5 with a table | 33.0 |
//!
//! `Two` is there for H5, and for processors without a product of 64 bits; on a Cortex-M4 the
//! shorter code of `One` makes up for its second division.

use super::{Homogeneous, Texels, Uv};
use crate::num::mul_high;

/// How many pixels one division serves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Stride {
    /// Each pixel is divided.
    One,
    /// Every 2nd pixel is; between them is the average.
    Two,
    /// Linear over 4 pixels.
    Four,
    /// Linear over 8 pixels.
    Eight,
    /// Linear over 16 pixels.
    Sixteen,
    /// Linear over the whole span.
    Affine,
}

impl Stride {
    /// All of them, the most exact one first.
    pub const ALL: [Self; 6] = [
        Self::One,
        Self::Two,
        Self::Four,
        Self::Eight,
        Self::Sixteen,
        Self::Affine,
    ];

    /// Pixels from one division to the next; 0 for [`Affine`](Stride::Affine).
    #[must_use]
    pub const fn pixels(self) -> u32 {
        match self {
            Self::One => 1,
            Self::Two => 2,
            Self::Four => 4,
            Self::Eight => 8,
            Self::Sixteen => 16,
            Self::Affine => 0,
        }
    }
}

/// Where a span begins in texture space, and its step to the next pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct PerspectiveSpan {
    /// At the first pixel's centre.
    pub at: Homogeneous,
    /// To the next pixel.
    pub step: Homogeneous,
}

/// `2^31 / n`, rounded down, for runs that end early.
static PARTS: [i32; 17] = {
    let mut parts = [i32::MAX; 17];
    parts[0] = 0;
    let mut n = 2;
    while n < 17 {
        parts[n] = ((1u32 << 31) / n as u32) as i32;
        n += 1;
    }
    parts
};

/// The way of one pixel when `way` takes `pixels` of them, at most 16; rounded down.
#[inline(always)]
fn part(way: Uv, pixels: usize) -> Uv {
    let n = PARTS[pixels.min(16)];
    let of = |x: i32| mul_high(x, n).wrapping_mul(2);
    Uv {
        u: of(way.u),
        v: of(way.v),
    }
}

impl PerspectiveSpan {
    /// The exact place of pixel `pixel` of the span.
    #[inline(always)]
    #[must_use]
    pub fn place(&self, pixel: i32) -> Uv {
        self.at.plus(self.step.times(pixel)).place()
    }

    /// Gives `paint` the span's pixels in runs of at most `stride` pixels.
    #[inline(always)]
    pub fn walk<W>(self, stride: Stride, pixels: &mut [W], paint: &mut impl PaintRun<W>) {
        match stride {
            Stride::One => self.exact(pixels, paint),
            Stride::Two => self.runs::<2, W>(pixels, paint),
            Stride::Four => self.runs::<4, W>(pixels, paint),
            Stride::Eight => self.runs::<8, W>(pixels, paint),
            Stride::Sixteen => self.runs::<16, W>(pixels, paint),
            Stride::Affine => self.affine(pixels, paint),
        }
    }

    /// Gives each pixel of the span its texel, all of them seen.
    #[inline(always)]
    pub fn draw<T: Texels, W>(
        self,
        stride: Stride,
        texels: &T,
        pixels: &mut [W],
        each: impl FnMut(&mut W, T::Texel),
    ) {
        self.walk(stride, pixels, &mut AllSeen { texels, each });
    }

    /// [`walk`](Self::walk) with a division at each pixel.
    #[inline(always)]
    pub fn exact<W>(self, pixels: &mut [W], paint: &mut impl PaintRun<W>) {
        let mut at = self.at;
        for pixel in pixels {
            paint.one(pixel, at.place());
            at = at.plus(self.step);
        }
    }

    /// [`walk`](Self::walk) with a division every `N` pixels, a power of two up to 16, and one at
    /// the last pixel.
    #[inline(always)]
    pub fn runs<const N: usize, W>(self, pixels: &mut [W], paint: &mut impl PaintRun<W>) {
        let mut rest = pixels;
        let mut at = self.at;
        let ahead = self.step.times(N as i32);
        let mut from = at.place();
        while rest.len() > N {
            at = at.plus(ahead);
            let (run, more) = rest.split_at_mut(N);
            let to = at.place();
            let way = to.minus(from);
            let step = Uv {
                u: way.u >> N.trailing_zeros(),
                v: way.v >> N.trailing_zeros(),
            };
            paint.run(run, from, step);
            (rest, from) = (more, to);
        }
        let last = rest.len().wrapping_sub(1);
        if last <= N {
            let to = at.plus(self.step.times(last as i32)).place();
            paint.run(rest, from, part(to.minus(from), last));
        }
    }

    /// [`walk`](Self::walk) with divisions at the first and last pixel alone, in one run.
    #[inline(always)]
    pub fn affine<W>(self, pixels: &mut [W], paint: &mut impl PaintRun<W>) {
        let Some(last) = pixels.len().checked_sub(1) else {
            return;
        };
        let from = self.at.place();
        let way = self.place(last as i32).minus(from);
        let step = if last <= 16 {
            part(way, last)
        } else {
            // True divisions, two a span, which is long.
            let n = last as i32;
            Uv {
                u: way.u / n,
                v: way.v / n,
            }
        };
        paint.run(pixels, from, step);
    }
}

/// Takes a span's pixels in runs along which texture places are linear.
pub trait PaintRun<W> {
    /// The next pixels of the span: the first at `from` on the texture, the next a `step` further.
    fn run(&mut self, pixels: &mut [W], from: Uv, step: Uv);

    /// The next pixel of the span alone.
    #[inline(always)]
    fn one(&mut self, pixel: &mut W, at: Uv) {
        self.run(core::slice::from_mut(pixel), at, Uv::default());
    }
}

/// Every pixel gets its texel.
#[derive(Debug)]
pub struct AllSeen<'t, T, F> {
    /// What is drawn.
    pub texels: &'t T,
    /// What is done with a pixel and its texel.
    pub each: F,
}

impl<T: Texels, W, F: FnMut(&mut W, T::Texel)> PaintRun<W> for AllSeen<'_, T, F> {
    #[inline(always)]
    fn run(&mut self, pixels: &mut [W], from: Uv, step: Uv) {
        self.texels.run(pixels, from, step, &mut self.each);
    }
}
