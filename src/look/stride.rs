//! How far exact places of a span in perspective may be from each other.

use super::perspective::Reciprocal;
use crate::num::{leading_zeros, mul_17, mul_high, mul_high_unsigned};
use crate::scene::Budget;

/// Pixels from one exact place to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum Stride {
    /// Each pixel has its own.
    One,
    /// Every 2nd.
    Two,
    /// Every 4th.
    Four,
    /// Every 8th.
    Eight,
    /// Every 16th.
    Sixteen,
}

impl Stride {
    /// All of them, the most exact one first.
    #[cfg(test)]
    pub const ALL: [Self; 5] = [Self::One, Self::Two, Self::Four, Self::Eight, Self::Sixteen];

    /// The power of two that it is.
    #[inline(always)]
    pub const fn log(self) -> u32 {
        self as u32
    }

    /// Pixels from one exact place to the next.
    #[cfg(test)]
    #[must_use]
    pub const fn pixels(self) -> usize {
        1 << self.log()
    }

    /// The longest of at most so many steps.
    #[inline(always)]
    #[must_use]
    pub const fn within(steps: u8) -> Self {
        match steps {
            16.. => Self::Sixteen,
            8.. => Self::Eight,
            4.. => Self::Four,
            2.. => Self::Two,
            _ => Self::One,
        }
    }
}

/// Most steps from one exact place to the next.
const LONGEST: u8 = 64;

/// How many steps from one exact place to the next keep `budget` anywhere in a triangle: 1 to 64.
///
/// `least` is its least 1/w, whose step is `step`. With `K = d(u/w) - u d(1/w)`, u changes by `K / q` a pixel, and `K` is
/// extreme at a corner. The second derivative is `2 dq K / q^2`, so over `m` steps u is off from the straight way by
/// `m^2 |dq K| / (4 q^2)` at most.
#[inline(always)]
#[must_use]
pub fn reach(least: u32, step: i32, ways: [Range; 2], budget: Budget) -> u8 {
    let r = Reciprocal::of(least);
    let of = |range: &Range| {
        let turned = |place: i32| range.step.wrapping_sub(mul_high(place, step) << 2);
        let (low, high) = (turned(range.low), turned(range.high));
        (low ^ low >> 31).max(high ^ high >> 31) as u32 + 1
    };
    let most = of(&ways[0]).max(of(&ways[1]));
    let step = (step ^ step >> 31) as u32 + 1;
    if step > least >> 2 || most > least {
        return 1;
    }
    // Each by 1/w, times 2^30 and more by what the reciprocal may lack.
    let of = |value: u32| {
        let part = (mul_17(value as i32, r.mantissa) as u32) << r.shift;
        part + (part >> 14) + 1
    };
    // The product in units of 2^-19 texel, of which the budget has 2^11.
    let worst = mul_high_unsigned(of(step), of(most)) + 1;
    let twice = halvings(budget.for_curves() << 11, worst).min(12);
    ROOTS[twice as usize & 15]
}

/// How often `most` may be halved and be at least `least`, which is above 0.
#[inline(always)]
fn halvings(most: u32, least: u32) -> u32 {
    if most < least {
        return 0;
    }
    let times = leading_zeros(least) - leading_zeros(most);
    if most >> (times & 31) >= least {
        times
    } else {
        times - 1
    }
}

/// `floor(2^(i / 2))`.
static ROOTS: [u8; 16] = [1, 1, 2, 2, 4, 5, 8, 11, 16, 22, 32, 45, LONGEST, 0, 0, 0];

/// The least and the most of the places on one axis, as in [`Uv`], and the step of them over w to the next pixel.
#[derive(Clone, Copy, Debug)]
pub struct Range {
    pub low: i32,
    pub high: i32,
    pub step: i32,
}
