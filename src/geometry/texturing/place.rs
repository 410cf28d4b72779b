//! Places on a texture, their homogeneous form, and how far they may be off (H3, X2).

use crate::num::{Reciprocal, mul_high};

/// Fraction bits of texel coordinates.
pub const FRACTION: u32 = 19;

/// A place on a texture, in texels with [`FRACTION`] fraction bits; (0, 0) is the upper left
/// corner of the first texel. Modulo 8192 texels, which every texture's size divides.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Uv {
    /// To the right.
    pub u: i32,
    /// Down.
    pub v: i32,
}

impl Uv {
    /// The place that is `by` further on, modulo 8192 texels.
    #[inline(always)]
    #[must_use]
    pub const fn plus(self, by: Self) -> Self {
        Self {
            u: self.u.wrapping_add(by.u),
            v: self.v.wrapping_add(by.v),
        }
    }

    /// The way from `from` to here, modulo 8192 texels.
    #[inline(always)]
    #[must_use]
    pub const fn minus(self, from: Self) -> Self {
        Self {
            u: self.u.wrapping_sub(from.u),
            v: self.v.wrapping_sub(from.v),
        }
    }

    /// The texel, rounded down: column and row, -4096 to 4095.
    #[inline(always)]
    #[must_use]
    pub const fn texel(self) -> (i32, i32) {
        (self.u >> FRACTION, self.v >> FRACTION)
    }
}

/// 1/w, u/w and v/w at a place, or their steps, in one triangle's exponent.
///
/// | field | format |
/// |---|---|
/// | `q` | 1/w in any unit that keeps it below 2^31; best at 2^29 to 2^30 at the nearest corner |
/// | `s`, `t` | u and v in texels times `q`, times 2^-10 |
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Homogeneous {
    /// 1/w.
    pub q: i32,
    /// u/w.
    pub s: i32,
    /// v/w.
    pub t: i32,
}

impl Homogeneous {
    /// The texture place: two products with the reciprocal of 1/w.
    ///
    /// Error: below `2^-18.9` of u and v, and what the fields' own rounding makes:
    /// `2^10 / q` texels for one unit of `s`. Where `q` is not above 0, which is outside of every
    /// triangle, any place.
    #[inline(always)]
    #[must_use]
    pub fn place(self) -> Uv {
        let r = Reciprocal::of(self.q as u32);
        // 2^19 u = s r 2^(shift - 61 + 10 + 19) = (s r / 2^32) 2^shift
        Uv {
            u: mul_high(self.s, r.mantissa) << r.shift,
            v: mul_high(self.t, r.mantissa) << r.shift,
        }
    }

    /// The value `pixels` further on; `self` is the step.
    #[inline(always)]
    #[must_use]
    pub const fn times(self, pixels: i32) -> Self {
        Self {
            q: self.q.wrapping_mul(pixels),
            s: self.s.wrapping_mul(pixels),
            t: self.t.wrapping_mul(pixels),
        }
    }

    /// The sum, modulo 2^32.
    #[inline(always)]
    #[must_use]
    pub const fn plus(self, by: Self) -> Self {
        Self {
            q: self.q.wrapping_add(by.q),
            s: self.s.wrapping_add(by.s),
            t: self.t.wrapping_add(by.t),
        }
    }
}

/// How much a texture place may be off, in texels with [`FRACTION`] fraction bits.
///
/// What the fixed point itself adds, 1/16 texel at most within the limits of [`Quality`], is part of
/// it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Budget(u32);

/// What the caller wants, each with the budget that is kept.
///
/// It is kept in pictures of up to 320 x 240 pixels where a triangle's nearest corner is up to 300
/// times as near as its farthest, and it stretches over up to 3,000 texels. What fixed point adds
/// grows with that ratio and with the pixels that a triangle is wide: at 1:12,000 it may be a texel
/// more, at 1:65,536 eight; and in triangles to the rim of guard space, 4,096 pixels from the middle,
/// an eighth of a texel at 1:1,000. A finer mesh has none of that.
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
    pub(crate) const fn for_curves(self) -> u64 {
        self.0.saturating_sub(RESERVE) as u64
    }

    /// Whether a way of `way` with 1/w from `low` to `high` (above 0) may be taken as straight.
    #[inline]
    pub(crate) fn allows_straight(self, way: u32, (low, high): (u32, u32)) -> bool {
        // |du| |dq| <= 4 min q budget; 31 + 31 and 31 + 30 bits
        u64::from(way) * u64::from(high - low) <= 4 * u64::from(low) * self.for_curves()
            && self.for_curves() > 0
    }
}
