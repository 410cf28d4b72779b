//! How far exact places of a span in perspective may be from each other (H4, H5, X2).

use super::perspective::Reciprocal;
use crate::num::{few_leading_zeros, mul_17, mul_high, mul_high_unsigned};
use crate::scene::Budget;

/// Pixels from one exact place to the next, as a power of two: 16 at most, and at most so many steps.
#[inline(always)]
#[must_use]
pub const fn stride_within(steps: u8) -> u32 {
    match steps {
        16.. => 4,
        8.. => 3,
        4.. => 2,
        2.. => 1,
        _ => 0,
    }
}

/// Most steps from one exact place to the next.
const LONGEST: u8 = 64;

/// How many steps from one exact place to the next keep a budget: 1 to 64.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reach {
    /// Where the way between them is taken as straight.
    pub line: u8,
    /// Where it is taken as a parabola, which takes [`ARC_RESERVE`] of the budget for fixed point; 1 to 3 where no
    /// parabola keeps it.
    pub arc: u8,
}

impl Reach {
    /// Where every pixel has a place of its own.
    pub const NONE: Self = Self { line: 1, arc: 0 };
}

/// What fixed point may add to places of a parabola, in texels with 8 fraction bits: 1/8 texel.
const ARC_RESERVE: u32 = 32;

/// The reach anywhere in a triangle, or in a span, for a texture of `2^log` texels a side.
///
/// The least 1/w is `least`, whose step is `step`. With `K = d(u/w) - u d(1/w)`, u changes by `K / q` a pixel, and `K` is
/// extreme at a corner. The second derivative is `2 dq K / q^2`, so over `m` steps u is off from the straight way by
/// `m^2 |dq K| / (4 q^2)` at most, and from the parabola through both ends and the middle by 0.193 `m |dq| / q` of that.
#[inline(never)]
#[must_use]
pub fn reach(least: u32, step: i32, ways: [Range; 2], budget: Budget, log: u32) -> Reach {
    let r = Reciprocal::of(least);
    let of = |range: &Range| {
        let turned = |place: i32| range.step.wrapping_sub(mul_high(place, step) << 2);
        let (low, high) = (turned(range.low), turned(range.high));
        (low ^ low >> 31).max(high ^ high >> 31) as u32 + 1
    };
    let most = of(&ways[0]).max(of(&ways[1]));
    let step = (step ^ step >> 31) as u32 + 1;
    if step > least >> 2 || most > least {
        return Reach::NONE;
    }
    // Each by 1/w, times 2^30 and more by what the reciprocal may lack.
    let of = |value: u32| {
        let part = (mul_17(value as i32, r.mantissa) as u32) << r.shift;
        part + (part >> 14) + 1
    };
    // The product in units of 2^-19 texel, of which the budget has 2^11.
    let slant = of(step);
    let worst = mul_high_unsigned(slant, of(most)) + 1;
    let line = halvings(budget.for_curves() << 11, worst).min(12);
    // Another 1/w: in units of 2^-29 texel, of which the budget has 2^21.
    let worst = mul_high_unsigned(worst.min(1 << 19) << 12, slant) + 1;
    let left = budget.texels().clamp(ARC_RESERVE, 400) - ARC_RESERVE;
    let arc = halvings((left * 5) << 21, worst).min(18);
    let arc = CUBE_ROOTS[arc as usize & 31].min(LONGEST_ARC[log as usize & 15]);
    Reach {
        line: ROOTS[line as usize & 15],
        arc: if arc < 4 { 0 } else { arc },
    }
}

/// How often `most` may be halved and be at least `least`, which is above 0.
#[inline(always)]
fn halvings(most: u32, least: u32) -> u32 {
    if most < least {
        return 0;
    }
    let times = few_leading_zeros(least) - few_leading_zeros(most);
    times - u32::from(most >> (times & 31) < least)
}

/// `floor(2^(i / 2))`.
static ROOTS: [u8; 16] = [1, 1, 2, 2, 4, 5, 8, 11, 16, 22, 32, 45, LONGEST, 0, 0, 0];

/// `floor(2^(i / 3))`.
static CUBE_ROOTS: [u8; 32] = [
    1, 1, 1, 2, 2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 25, 32, 40, 50, LONGEST, 0, 0, 0, 0, 0, 0, 0, 0,
    0, 0, 0, 0, 0,
];

/// The longest arc by the power of two of a texture's side. A place in one word has `16 - log` fraction bits; its second
/// difference is off by half of the last, so `n` steps are off by `n^2 / 16` of it in the middle, and steps by `n / 4`.
static LONGEST_ARC: [u8; 16] = [0, 0, 0, 0, 0, 58, 41, 28, 19, 0, 0, 0, 0, 0, 0, 0];

/// The least and the most of the places on one axis, as in [`Uv`], and the step of them over w to the next pixel.
#[derive(Clone, Copy, Debug)]
pub struct Range {
    pub low: i32,
    pub high: i32,
    pub step: i32,
}
