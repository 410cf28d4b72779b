//! Texture places along a span, in perspective (H3, H4, H5, K18).
//!
//! 1/w, u/w and v/w are linear on the screen and share an exponent, which therefore cancels in `u = (u/w) / (1/w)`. The
//! division is a normalised reciprocal with one Newton step. It can be made at every pixel, or at the ends of runs of
//! pixels between which u and v are taken as linear. A span's first and last pixel are exact in every way of drawing, the
//! last one but for the rounding of its run's step (2^-18 texel a pixel); so neighbours fit together.
//!
//! The renderer takes 16-bit reciprocals and the longest run that keeps a budget, also along parabolas.

use crate::reciprocal::Reciprocal;

/// Fraction bits of texel coordinates.
pub const FRACTION: u32 = 19;

/// A place on a texture, in texels with [`FRACTION`] fraction bits, modulo 8192 texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Uv {
    /// To the right.
    pub u: i32,
    /// Down.
    pub v: i32,
}

impl Uv {
    #[inline(always)]
    fn plus(self, by: Self) -> Self {
        Self {
            u: self.u.wrapping_add(by.u),
            v: self.v.wrapping_add(by.v),
        }
    }

    /// What `f` makes of the way from `from` to here.
    #[inline(always)]
    fn since(self, from: Self, f: impl Fn(i32) -> i32) -> Self {
        Self {
            u: f(self.u.wrapping_sub(from.u)),
            v: f(self.v.wrapping_sub(from.v)),
        }
    }
}

/// 1/w, u/w and v/w at a place, or their steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Homogeneous {
    /// 1/w in any unit that keeps it below 2^31; best at 2^29 to 2^30 at the nearest corner.
    pub q: i32,
    /// u in texels times `q`, times 2^-10.
    pub s: i32,
    /// v in texels times `q`, times 2^-10.
    pub t: i32,
}

impl Homogeneous {
    /// The texture place: two products with the reciprocal of 1/w. Where `q` is not above 0, which is outside of every
    /// triangle, any place.
    #[inline(always)]
    #[must_use]
    pub fn place(self) -> Uv {
        let r = Reciprocal::of(self.q as u32);
        // 2^19 u = s r 2^(shift - 61 + 10 + 19) = (s r / 2^32) 2^shift
        let of = |x: i32| high(x, r.mantissa) << r.shift;
        Uv {
            u: of(self.s),
            v: of(self.t),
        }
    }

    /// `times` steps further on.
    #[inline(always)]
    #[must_use]
    pub fn after(self, step: Self, times: i32) -> Self {
        let of = |at: i32, step: i32| at.wrapping_add(step.wrapping_mul(times));
        Self {
            q: of(self.q, step.q),
            s: of(self.s, step.s),
            t: of(self.t, step.t),
        }
    }
}

/// `floor(a b / 2^32)`.
#[inline(always)]
fn high(a: i32, b: i32) -> i32 {
    ((i64::from(a) * i64::from(b)) >> 32) as i32
}

/// How many pixels one division serves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stride {
    /// Each pixel is divided.
    One,
    /// Every 2nd pixel is; between them is the average (H5).
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

impl PerspectiveSpan {
    /// The exact place of a pixel of the span.
    #[inline(always)]
    #[must_use]
    pub fn place(&self, pixel: usize) -> Uv {
        self.at.after(self.step, pixel as i32).place()
    }

    /// Gives `each` the span's pixels in turn, with their places.
    #[inline(always)]
    pub fn walk<W>(&self, stride: Stride, pixels: &mut [W], mut each: impl FnMut(&mut W, Uv)) {
        match stride {
            Stride::One => {
                let mut at = self.at;
                for pixel in pixels {
                    each(pixel, at.place());
                    at = at.after(self.step, 1);
                }
            }
            Stride::Two => self.runs::<2, W>(pixels, &mut each),
            Stride::Four => self.runs::<4, W>(pixels, &mut each),
            Stride::Eight => self.runs::<8, W>(pixels, &mut each),
            Stride::Sixteen => self.runs::<16, W>(pixels, &mut each),
            Stride::Affine => self.affine(pixels, &mut each),
        }
    }

    /// A division every `N` pixels, a power of two up to 16, and one at the last pixel.
    #[inline(always)]
    fn runs<const N: usize, W>(&self, pixels: &mut [W], each: &mut impl FnMut(&mut W, Uv)) {
        let mut rest = pixels;
        let mut at = self.at;
        let mut from = at.place();
        while rest.len() > N {
            at = at.after(self.step, N as i32);
            let (some, more) = rest.split_at_mut(N);
            let to = at.place();
            run(
                some,
                from,
                to.since(from, |way| way >> N.trailing_zeros()),
                each,
            );
            (rest, from) = (more, to);
        }
        let last = rest.len().wrapping_sub(1);
        if last <= N {
            let to = at.after(self.step, last as i32).place();
            run(rest, from, part(from, to, last), each);
        }
    }

    /// Divisions at the first and last pixel alone, in one run.
    #[inline(always)]
    fn affine<W>(&self, pixels: &mut [W], each: &mut impl FnMut(&mut W, Uv)) {
        let Some(last) = pixels.len().checked_sub(1) else {
            return;
        };
        let (from, to) = (self.place(0), self.place(last));
        let step = if last <= 16 {
            part(from, to, last)
        } else {
            to.since(from, |way| way / last as i32)
        };
        run(pixels, from, step, each);
    }
}

/// The way of one pixel when the way between two places takes so many, at most 16; rounded down.
#[inline(always)]
fn part(from: Uv, to: Uv, pixels: usize) -> Uv {
    let n = PARTS[pixels.min(16)];
    to.since(from, |way| high(way, n).wrapping_mul(2))
}

/// Pixels along which places are linear.
#[inline(always)]
fn run<W>(pixels: &mut [W], mut at: Uv, step: Uv, each: &mut impl FnMut(&mut W, Uv)) {
    for pixel in pixels {
        each(pixel, at);
        at = at.plus(step);
    }
}
