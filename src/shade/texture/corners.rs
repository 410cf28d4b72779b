//! The corners of a triangle in texture space: 1/w, u/w and v/w with one exponent (H1, H3).
//!
//! A far triangle has a small 1/w, so all three of its 1/w, u/w and v/w are shifted up by as many
//! bits as its largest allows: an exponent for the triangle. Planes are made of the significands
//! alone; the exponent cancels in the division. Without it one texel in ten was wrong far away.

use super::perspective::Homogeneous;
use super::select::Budget;
use super::{FRACTION, LevelEnds};

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

/// A triangle's corners with a common exponent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Corners {
    /// 1/w, u/w and v/w of each corner, not negative.
    pub at: [Homogeneous; 3],
    /// How far up 1/w was shifted; down if negative.
    pub exponent: i32,
    /// u and v of each corner beyond the repeats that were taken off, 8 fraction bits.
    places: [(u32, u32); 3],
}

impl Corners {
    /// Most texels a triangle may stretch over either way, so that places do not wrap twice.
    pub const WIDEST: u32 = 4096;

    /// From the corners, on a texture whose sides divide `period` texels (a power of two up to
    /// 1024): whole periods are taken off, as far as no corner gets below 0.
    ///
    /// `None` when a depth is 0 or above 2^31, or the triangle stretches over more than
    /// [`WIDEST`](Self::WIDEST) texels.
    #[must_use]
    pub fn new(corners: [Corner; 3], period: u32) -> Option<Self> {
        let period = i64::from(period.clamp(1, 1024).next_power_of_two()) << 8;
        let base = |get: fn(&Corner) -> i32| {
            let least = corners.iter().map(get).min().unwrap_or(0);
            i64::from(least) & -period
        };
        let (base_u, base_v) = (base(|c| c.u), base(|c| c.v));
        let places = corners.map(|c| {
            (
                (i64::from(c.u) - base_u) as u64,
                (i64::from(c.v) - base_v) as u64,
            )
        });
        let widest = u64::from(Self::WIDEST) << 8;
        if places.iter().any(|p| p.0.max(p.1) >= widest) {
            return None;
        }
        // Bits of the largest u/w, v/w (texels with 8 fraction bits times 1/w) and 1/w.
        let (mut products, mut depths) = (1, 1);
        for (corner, place) in corners.iter().zip(places) {
            if corner.depth == 0 || corner.depth > 1 << 31 {
                return None;
            }
            depths = depths.max(corner.depth);
            products = products.max(place.0.max(place.1) * u64::from(corner.depth));
        }
        // q below 2^31, and products 2^(exponent - 18) too.
        let exponent =
            (depths.leading_zeros() as i32 - 1).min(products.leading_zeros() as i32 - 33 + 18);
        let scaled = |value: u64, shift: i32| -> i32 {
            if shift >= 0 {
                (value << shift) as i32
            } else {
                // Rounded to nearest, and never beyond what was asked for.
                (((value >> (-shift - 1)) + 1) >> 1).min(i32::MAX as u64) as i32
            }
        };
        let mut at = [Homogeneous::default(); 3];
        for (at, (corner, place)) in at.iter_mut().zip(corners.iter().zip(places)) {
            let depth = u64::from(corner.depth);
            *at = Homogeneous {
                q: scaled(depth, exponent).max(1),
                s: scaled(place.0 * depth, exponent - 18),
                t: scaled(place.1 * depth, exponent - 18),
            };
        }
        Some(Self {
            at,
            exponent,
            places: places.map(|(u, v)| (u as u32, v as u32)),
        })
    }

    /// The texture place of each corner, 8 fraction bits.
    #[must_use]
    pub fn places(&self) -> [(u32, u32); 3] {
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
        let span = |get: fn((u32, u32)) -> u32| {
            let p = p.map(get);
            p[0].max(p[1]).max(p[2]) - p[0].min(p[1]).min(p[2])
        };
        let way = span(|p| p.0).max(span(|p| p.1));
        let range = self.range();
        // 1/w constant: straight whatever the budget.
        range.0 == range.1 || budget.allows_straight(way << (FRACTION - 8), range)
    }

    /// From which 1/w on down the coarser levels of detail are right; `area` is the triangle's
    /// doubled area on the screen, in units of 1/64 pixel.
    #[must_use]
    pub fn levels(&self, area: u64) -> LevelEnds {
        let p = self.places.map(|(u, v)| (i64::from(u), i64::from(v)));
        let d = |i: usize| (p[i].0 - p[0].0, p[i].1 - p[0].1);
        let (a, b) = (d(1), d(2));
        let texels = (a.0 * b.1 - a.1 * b.0).unsigned_abs();
        LevelEnds::new(texels, area, self.at.map(|at| at.q as u32))
    }
}
