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

use super::perspective::{PerspectiveSpan, Stride};
use super::{Budget, Homogeneous, Uv};

impl Budget {
    /// How a span of `pixels` pixels (at most 8193) is drawn: the fewest divisions that keep the
    /// budget.
    ///
    /// Three divisions of 32 bits and some products; a triangle that may be drawn [affine as a
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
        // To 16 bits of the lower end, each time to the side that finds more error: 32-bit divisions
        // suffice, where those of 64 bits were most of what a span cost to choose for.
        let shift = (16 - low.leading_zeros() as i32).max(0) as u32;
        let small = low >> shift;
        let product = u64::from(way) * u64::from(high - low);
        let whole = quotient(product >> shift, small);
        // The ratio of 1/w, 8 fraction bits; from 1:256 on there is a division at each pixel.
        let large = (high >> shift) + 1;
        let (Some(whole), 0) = (whole, large >> 24) else {
            return Stride::One;
        };
        let whole = whole / 4 + 1;
        let ratio = (large << 8) / small + 1;
        let worst = u64::from(whole) * u64::from(ratio);
        let steps = u64::from(steps.min(1 << 13));
        let may = self.for_curves() * steps * steps;
        // n² whole high / (low steps²) <= budget
        for (stride, bits) in [
            (Stride::Sixteen, 0),
            (Stride::Eight, 2),
            (Stride::Four, 4),
            (Stride::Two, 6),
        ] {
            if worst >> bits < may {
                return stride;
            }
        }
        Stride::One
    }
}

/// `part / whole` rounded down, if it has 32 bits; `whole` below 2^16 and above 0.
#[inline]
fn quotient(part: u64, whole: u32) -> Option<u32> {
    let (upper, lower) = ((part >> 32) as u32, part as u32);
    (upper < whole).then(|| {
        let first = upper << 16 | lower >> 16;
        let second = ((first % whole) << 16) | (lower & 0xFFFF);
        ((first / whole) << 16) | (second / whole)
    })
}

/// The longer of the ways in u and in v.
fn furthest(a: Uv, b: Uv) -> u32 {
    let way = b.minus(a);
    way.u.unsigned_abs().max(way.v.unsigned_abs())
}

#[cfg(test)]
mod tests {
    use super::super::Quality;
    use super::*;
    use crate::num::random::Rng;

    #[test]
    fn quotients_are_those_of_64_bits() {
        let mut rng = Rng(1);
        for i in 0..200_000 {
            let part = u64::from(rng.bits()) << 32 | u64::from(rng.bits());
            let whole = (rng.bits() >> 16 >> (i % 16)).max(1);
            let part = part >> (i % 64);
            let want = u32::try_from(part / u64::from(whole)).ok();
            assert_eq!(quotient(part, whole), want, "{part} / {whole}");
        }
    }

    /// Pixels from one division to the next by the same bound, with nothing rounded.
    fn exact(budget: Budget, (low, high): (u32, u32), way: u32, steps: u32) -> u32 {
        let [low, high, way] = [low, high, way].map(f64::from);
        let worst = way * (high - low) / (4.0 * low) * high / low / f64::from(steps).powi(2);
        let strides = [16u32, 8, 4, 2];
        let fits = |n: &u32| worst * f64::from(n * n) <= budget.for_curves() as f64;
        strides.into_iter().find(fits).unwrap_or(1)
    }

    #[test]
    fn the_choice_is_that_of_exact_numbers_or_safer() {
        let mut rng = Rng(2);
        let (mut chosen, mut dearer) = (0, 0);
        for i in 0..200_000 {
            let high = (rng.bits() >> 1 >> (i % 8)).max(2);
            let low = ((f64::from(high) / 100f64.powf(rng.unit())) as u32).max(1);
            let (way, steps) = (rng.bits() >> (i % 18 + 2), 1 + rng.below(1024));
            let budget = [Quality::Fast, Quality::Balanced][i % 2].budget();
            let q = |q: u32| Homogeneous {
                q: q as i32,
                s: 0,
                t: 0,
            };
            let stride = budget.stride_between(q(high), q(low), way, steps);
            if stride == Stride::Affine {
                continue;
            }
            let (got, want) = (stride.pixels(), exact(budget, (low, high), way, steps));
            assert!(
                got <= want,
                "{got} where {want} is allowed: {low} {high} {way}"
            );
            chosen += u32::from(want > 1);
            dearer += u32::from(got < want);
        }
        // What is rounded decides for one in a hundred at most.
        assert!(
            chosen > 20_000 && dearer * 100 < chosen,
            "{dearer} of {chosen}"
        );
    }
}
