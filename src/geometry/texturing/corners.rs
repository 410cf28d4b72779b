//! The corners of a triangle in texture space: 1/w, u/w and v/w with one exponent (H1, H3).
//!
//! A far triangle has a small 1/w, so all three of its 1/w, u/w and v/w are shifted up by as many
//! bits as its largest allows: an exponent for the triangle. Planes are made of the significands
//! alone; the exponent cancels in the division. Without it one texel in ten was wrong far away.

use super::place::{Budget, FRACTION, Homogeneous};

/// What a vertex has: its 1/w and its place on the texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Corner {
    /// 1/w in 1.31, above 0.
    pub depth: u32,
    /// To the right on the texture, in texels with 8 fraction bits; any number of repeats.
    pub u: i32,
    /// Down on the texture, likewise.
    pub v: i32,
}

/// How a texture goes on beyond its sides: what may be taken off places without being seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Period {
    /// It repeats every 1,024 texels, as those do whose sides divide that.
    Short,
    /// It repeats every 8,192 texels, as all do that repeat, since places do.
    #[default]
    Long,
    /// It does not: the texels at its rim, of sides of up to 1,024, go on for ever.
    Never,
}

impl Period {
    /// As two bits.
    pub(super) const fn code(self) -> u16 {
        self as u16
    }

    /// From two bits.
    pub(super) const fn of_code(code: u16) -> Self {
        match code & 3 {
            0 => Self::Short,
            1 => Self::Long,
            _ => Self::Never,
        }
    }

    /// Places along one side, 8 fraction bits, that show the same and lie as near to the first
    /// texel as can be; `None` where they are too far apart or, of what does not repeat, too far
    /// away.
    fn reduced(self, at: [i32; 3]) -> Option<[i32; 3]> {
        const REACH: i64 = (Corners::WIDEST as i64) << 8;
        const SHORT: i64 = 1024 << 8;
        let [a, b, c] = at.map(i64::from);
        let (least, most) = (a.min(b).min(c), a.max(b).max(c));
        if most - least > REACH {
            return None;
        }
        let base = match self {
            // Not below 0, as long as nothing is at 4,096 then.
            Self::Short => {
                let base = least & -SHORT;
                if most - base < REACH {
                    base
                } else {
                    base + 2 * SHORT
                }
            }
            Self::Long => ((least + most) / 2 + REACH) & -(2 * REACH),
            // Beside the texture all is rim.
            Self::Never if most <= 0 => return Some([0; 3]),
            Self::Never if least >= SHORT => return Some([SHORT as i32; 3]),
            Self::Never if least < -REACH || most >= REACH => return None,
            Self::Never => 0,
        };
        Some([a, b, c].map(|v| (v - base) as i32))
    }
}

/// A triangle's corners with a common exponent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Corners {
    /// 1/w, u/w and v/w of each corner.
    pub at: [Homogeneous; 3],
    /// How far up 1/w was shifted; down if negative.
    pub exponent: i32,
    /// u and v of each corner beyond the repeats that were taken off, 8 fraction bits.
    places: [(i32, i32); 3],
}

impl Corners {
    /// Most texels a triangle may stretch over either way, so that places do not wrap twice.
    pub const WIDEST: u32 = 4096;

    /// From the corners, on a texture of this period, of which whole ones are taken off.
    ///
    /// `None` when a depth is 0 or above 2^31, when the triangle stretches over more than
    /// [`WIDEST`](Self::WIDEST) texels, or when it lies across a texture that does not repeat and
    /// has a corner below -4,096 texels or from 4,096 on.
    #[must_use]
    pub fn new(corners: [Corner; 3], period: Period) -> Option<Self> {
        let places = reduced(corners.map(|c| [c.u, c.v]), period)?;
        // Bits of the largest u/w, v/w (texels with 8 fraction bits times 1/w) and 1/w.
        let (mut products, mut depths) = (1, 1);
        for (corner, place) in corners.iter().zip(places) {
            if corner.depth == 0 || corner.depth > 1 << 31 {
                return None;
            }
            depths = depths.max(corner.depth);
            let farthest = place.0.unsigned_abs().max(place.1.unsigned_abs());
            products = products.max(u64::from(farthest) * u64::from(corner.depth));
        }
        // q below 2^31, and products 2^(exponent - 18) too.
        let exponent =
            (depths.leading_zeros() as i32 - 1).min(products.leading_zeros() as i32 - 33 + 18);
        let scaled = |value: i64, shift: i32| -> i32 {
            if shift >= 0 {
                (value << shift) as i32
            } else {
                // Rounded to nearest, and never beyond what was asked for.
                (((value >> (-shift - 1)) + 1) >> 1).min(i64::from(i32::MAX)) as i32
            }
        };
        let mut at = [Homogeneous::default(); 3];
        for (at, (corner, place)) in at.iter_mut().zip(corners.iter().zip(places)) {
            let depth = i64::from(corner.depth);
            *at = Homogeneous {
                q: scaled(depth, exponent).max(1),
                s: scaled(i64::from(place.0) * depth, exponent - 18),
                t: scaled(i64::from(place.1) * depth, exponent - 18),
            };
        }
        Some(Self {
            at,
            exponent,
            places,
        })
    }

    /// The texture place of each corner, 8 fraction bits.
    #[must_use]
    pub fn places(&self) -> [(i32, i32); 3] {
        self.places
    }

    /// Smallest and largest 1/w of the corners.
    fn range(&self) -> (u32, u32) {
        let q = self.at.map(|at| at.q as u32);
        (q[0].min(q[1]).min(q[2]), q[0].max(q[1]).max(q[2]))
    }

    /// Whether u and v may be taken as linear on the screen over the whole triangle: then no
    /// span of it needs a division.
    #[must_use]
    pub fn straight(&self, budget: Budget) -> bool {
        let p = self.places;
        let span = |get: fn((i32, i32)) -> i32| {
            let p = p.map(get);
            let (least, most) = (p[0].min(p[1]).min(p[2]), p[0].max(p[1]).max(p[2]));
            // Planes hold what is -4,096 to 4,095 texels away, and rises that rounding leaves there.
            let held = least >= -WIDEST && most < WIDEST && most - least < WIDEST - 256;
            held.then_some((most - least) as u32)
        };
        let (Some(u), Some(v)) = (span(|p| p.0), span(|p| p.1)) else {
            return false;
        };
        let range = self.range();
        // 1/w constant: straight whatever the budget.
        range.0 == range.1 || budget.allows_straight(u.max(v) << (FRACTION - 8), range)
    }
}

/// [`Corners::WIDEST`] with 8 fraction bits.
const WIDEST: i32 = (Corners::WIDEST << 8) as i32;

/// Places of corners with whole periods taken off, along both sides; `None` as in
/// [`Corners::new`].
#[inline]
pub(super) fn reduced(places: [[i32; 2]; 3], period: Period) -> Option<[(i32, i32); 3]> {
    let along = |axis: usize| period.reduced(places.map(|p| p[axis]));
    let (u, v) = (along(0)?, along(1)?);
    Some([(u[0], v[0]), (u[1], v[1]), (u[2], v[2])])
}

/// Whether some triangle of a mesh with these places may be too wide or too far away for
/// [`Corners`]: `false` where none can be.
pub(super) fn may_be_refused(places: &[[i32; 2]], period: Period) -> bool {
    // Most meshes lie within half of that either way, which is quickly seen.
    let half = |v: i32| v.wrapping_add(WIDEST / 2) as u32;
    let all = places
        .iter()
        .fold(0, |all, p| all | half(p[0]) | half(p[1]));
    if all < WIDEST as u32 {
        return false;
    }
    let (mut least, mut most) = ([i32::MAX; 2], [i32::MIN; 2]);
    for place in places {
        for i in 0..2 {
            least[i] = least[i].min(place[i]);
            most[i] = most[i].max(place[i]);
        }
    }
    (0..2).any(|i| {
        let apart = i64::from(most[i]) - i64::from(least[i]);
        let beyond = least[i] < -WIDEST || most[i] >= WIDEST;
        apart > i64::from(WIDEST) || (period == Period::Never && beyond)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::random::Rng;

    /// What an address takes of a place, for each period: 1,024 texels that repeat, 8,192 that do,
    /// and 64 with a rim.
    fn shown(period: Period, place: i64) -> i64 {
        match period {
            Period::Short => place.rem_euclid(1024 << 8),
            Period::Long => place.rem_euclid(8192 << 8),
            Period::Never => place.clamp(0, (64 << 8) - 1),
        }
    }

    /// Random triangles at random places: where they are kept, what is taken off is not seen at
    /// any corner, and all differences stay unless all is rim; 4,096 texels are always kept of
    /// what repeats.
    #[test]
    fn what_is_taken_off_is_not_seen() {
        let mut rng = Rng(17);
        let (mut kept, mut refused) = (0, 0);
        for i in 0..300_000 {
            let period = [Period::Short, Period::Long, Period::Never][i % 3];
            let start = match rng.below(3) {
                0 => rng.bits() as i32 >> 2,
                1 => (rng.bits() as i32) >> 10,
                _ => (rng.below(4096) as i32 - 2048) << 8,
            };
            let way = [300, 1 << 14, 4000 << 8, 4096 << 8, 4097 << 8][i / 3 % 5];
            let mut at = [(); 3].map(|()| start + rng.below(way + 1) as i32);
            if rng.below(2) == 0 {
                (at[0], at[2]) = (start, start + way as i32);
            }
            let apart = at.iter().max().unwrap() - at.iter().min().unwrap();
            let Some(found) = period.reduced(at) else {
                refused += 1;
                assert!(apart > 4096 << 8 || period == Period::Never, "{at:?}");
                assert!(may_be_refused(&at.map(|c| [c, 0]), period));
                assert!(may_be_refused(&at.map(|c| [0, c]), period));
                continue;
            };
            kept += 1;
            assert!(apart <= 4096 << 8, "{at:?}");
            for k in 0..3 {
                let (was, is) = (i64::from(at[k]), i64::from(found[k]));
                assert_eq!(
                    shown(period, was),
                    shown(period, is),
                    "{period:?} {at:?} {found:?}"
                );
                let rim = period == Period::Never && found == [found[0]; 3];
                assert!(
                    rim || at[k] - at[0] == found[k] - found[0],
                    "{at:?} {found:?}"
                );
                assert!(found[k].abs() <= 6144 << 8, "{found:?}");
            }
        }
        assert!(kept > 200_000 && refused > 20_000, "{kept}, {refused}");
    }
}
