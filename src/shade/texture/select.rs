//! Which way of drawing a span keeps an error budget (X2).
//!
//! Between two pixels with 1/w of `q0` and `q1`, u is `(q0 u0 + t (q1 u1 - q0 u0)) / q` with
//! `q = q0 + t (q1 - q0)`, `t` from 0 to 1. It is off from the straight line `u0 + t (u1 - u0)` by
//! ```text
//! (u1 - u0) (q1 - q0) t (1 - t) / q      at most    |du| |dq| / (4 min q)
//! ```
//! since `t (1 - t)` is at most 1/4. For a whole triangle the straight form is the mean of the
//! corners' u with weights, the true one that with weights times q; their difference is the
//! weighted covariance of u and q over the mean of q, and a covariance is at most a quarter of the
//! product of the two ranges. So the same expression bounds a triangle, with the ranges of its
//! corners in place of `du` and `dq`.
//!
//! In a span of `length` steps with the bound `e` for the whole, a part of `n` steps has
//! `dq n / length`, and a `du` of at most `n / length max q / min q` of the whole's: its rate
//! is `C / q²` with one C for the span, and `du = C length / (q0 q1)`. So its error is at most
//! `e (n / length)² max q / min q`.

use super::perspective::{Homogeneous, PerspectiveSpan, Stride};
use super::{FRACTION, Uv};

/// How much a texture place may be off, in texels with [`FRACTION`] fraction bits.
///
/// What the fixed point itself adds, 1/16 texel at most, is part of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Budget(u32);

/// What the caller wants, each with the budget that is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Default)]
pub enum Quality {
    /// 1/2 texel.
    Fast,
    /// 1/4 texel: a texel is wrong only within that distance of its neighbour.
    #[default]
    Balanced,
    /// A division at each pixel.
    Exact,
}

impl Quality {
    /// The budget that is kept.
    #[must_use]
    pub const fn budget(self) -> Budget {
        match self {
            Self::Fast => Budget::texels(1, 2),
            Self::Balanced => Budget::texels(1, 4),
            Self::Exact => Budget::EXACT,
        }
    }
}

/// What fixed point may add to the error of linear runs.
const RESERVE: u32 = 1 << (FRACTION - 4);

impl Budget {
    /// A division at each pixel.
    pub const EXACT: Self = Self(0);

    /// `part / of` texels; of 0 parts, and of all, at most 1024 texels.
    #[must_use]
    pub const fn texels(part: u32, of: u32) -> Self {
        let of = if of == 0 { 1 } else { of };
        let units = ((part as u64) << FRACTION) / of as u64;
        Self(if units > 1024 << FRACTION {
            1024 << FRACTION
        } else {
            units as u32
        })
    }

    /// The budget, in texels with [`FRACTION`] fraction bits.
    #[must_use]
    pub const fn units(self) -> u32 {
        self.0
    }

    /// What is left for taking a curve as straight.
    const fn for_curves(self) -> u64 {
        self.0.saturating_sub(RESERVE) as u64
    }

    /// Whether a way of `way` with 1/w from `low` to `high` (above 0) may be taken as straight.
    #[inline]
    pub(super) fn allows_straight(self, way: u32, (low, high): (u32, u32)) -> bool {
        // |du| |dq| <= 4 min q budget; 31 + 31 and 31 + 30 bits
        u64::from(way) * u64::from(high - low) <= 4 * u64::from(low) * self.for_curves()
            && self.for_curves() > 0
    }

    /// How a span of `pixels` pixels (at most 8193) is drawn: the fewest divisions that keep the
    /// budget.
    ///
    /// Two divisions and some products; a triangle that may be drawn [affine as a
    /// whole](super::Corners::straight) need not ask.
    #[inline]
    #[must_use]
    pub fn stride(self, span: &PerspectiveSpan, pixels: usize) -> Stride {
        let Some(steps) = pixels.checked_sub(1).filter(|&steps| steps > 0) else {
            return Stride::One;
        };
        if self.for_curves() == 0 {
            return Stride::One;
        }
        let last = span.at.plus(span.step.times(steps as i32));
        let way = furthest(span.at.place(), last.place());
        self.stride_between(span.at, last, way, steps as u32)
    }

    /// [`stride`](Self::stride) from what is known at the ends.
    #[inline]
    fn stride_between(self, a: Homogeneous, b: Homogeneous, way: u32, steps: u32) -> Stride {
        let (low, high) = (a.q.min(b.q).max(1) as u32, a.q.max(b.q).max(1) as u32);
        if self.allows_straight(way, (low, high)) {
            return Stride::Affine;
        }
        // Rounded up.
        let whole = (u64::from(way) * u64::from(high - low)).div_ceil(4 * u64::from(low));
        // n² whole high / (low steps²) <= budget; the ratio is rounded up, 8 fraction bits.
        let ratio = (u64::from(high) << 8) / u64::from(low) + 1;
        // What saturates is beyond any budget, which is below 2^56 with 8 more fraction bits.
        let worst = whole.saturating_mul(ratio);
        let steps = u64::from(steps.min(1 << 13));
        let may = self.for_curves() * steps * steps;
        for stride in [Stride::Sixteen, Stride::Eight, Stride::Four, Stride::Two] {
            let n = u64::from(stride.pixels());
            if worst.saturating_mul(n * n) >> 8 < may {
                return stride;
            }
        }
        Stride::One
    }
}

/// The longer of the ways in u and in v.
fn furthest(a: Uv, b: Uv) -> u32 {
    let way = b.minus(a);
    way.u.unsigned_abs().max(way.v.unsigned_abs())
}
