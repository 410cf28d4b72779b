//! Which level of detail is right where (H6).
//!
//! Within a triangle the texture's area under a pixel is `D q^-3` with one constant D and the 1/w
//! q, since it is a projective map. So three limits of 1/w are found once a triangle, and a span
//! compares. A level is taken where its texels are at least `1 / sqrt 2` pixels wide on average and
//! the next one's more than `sqrt 2`; so a texture that is magnified is always taken whole. A
//! triangle that is drawn without divisions has one level.

use super::corners::Corners;
use crate::num::{exp2, log2};
use core::fmt::Debug;

/// How many levels there are, the texture itself among them.
pub const LEVELS: usize = 4;

/// What an object keeps so that a span knows its levels of detail: `()` for none, then the whole
/// texture is taken everywhere, or [`LevelEnds`].
pub trait Detail: Copy + Debug + PartialEq + Send + Sync + 'static {
    /// The whole texture everywhere.
    const FULL: Self;

    /// For a triangle with these corners, which covers `area` (doubled, units of 1/64 pixel) and is
    /// drawn with u and v linear on the screen if `straight`.
    fn new(corners: &Corners, straight: bool, area: u64) -> Self;

    /// The limits.
    fn ends(&self) -> &LevelEnds;
}

impl Detail for () {
    const FULL: Self = ();

    #[inline(always)]
    fn new(_: &Corners, _: bool, _: u64) -> Self {}

    #[inline(always)]
    fn ends(&self) -> &LevelEnds {
        const { &LevelEnds::FULL }
    }
}

impl Detail for LevelEnds {
    const FULL: Self = Self::FULL;

    #[inline(never)]
    fn new(corners: &Corners, straight: bool, area: u64) -> Self {
        if straight {
            corners.level(area)
        } else {
            corners.levels(area)
        }
    }

    #[inline(always)]
    fn ends(&self) -> &LevelEnds {
        self
    }
}

/// At which 1/w each coarser level begins, in the triangle's exponent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct LevelEnds([u32; LEVELS - 1]);

impl LevelEnds {
    /// The full texture everywhere.
    pub const FULL: Self = Self([0; LEVELS - 1]);

    /// From a triangle's doubled areas on the texture (units of 2^-16 texel) and on the screen
    /// (units of 2^-6 pixel), and 1/w of its corners.
    #[must_use]
    pub fn new(texels: u64, pixels: u64, q: [u32; 3]) -> Self {
        if texels == 0 || pixels == 0 {
            return Self::FULL;
        }
        // The ratio of the areas is D / (q0 q1 q2). D q^-3 = 2 4^(level - 1), by logarithms.
        let product: i32 = q.iter().map(|&q| log2(u64::from(q.max(1)))).sum();
        let constant = log2(texels) - log2(pixels) - (10 << 8) + product;
        Self(core::array::from_fn(|i| {
            exp2((constant - ((2 * i as i32 + 1) << 8)).div_euclid(3))
        }))
    }

    /// One level everywhere, 0 to 3, for triangles that are drawn without 1/w: that of their
    /// [`level`](Self::level) at 0.
    ///
    /// From doubled areas as in [`new`](Self::new).
    #[must_use]
    pub fn constant(texels: u64, pixels: u64) -> Self {
        if texels == 0 || pixels == 0 {
            return Self::FULL;
        }
        let ratio = log2(texels) - log2(pixels) - (10 << 8);
        Self(core::array::from_fn(|i| {
            u32::from(ratio >= (2 * i as i32 + 1) << 8)
        }))
    }

    /// How many of `pixels` pixels (at least 1), with 1/w of `q` at the first and a step of `step`,
    /// have the same level as the first.
    #[inline]
    #[must_use]
    pub fn same(&self, q: u32, step: i32, pixels: usize) -> usize {
        let level = self.level(q) as usize;
        // Steps up to the limit that is ahead.
        let steps = if step < 0 {
            let Some(end) = self.0.get(level) else {
                return pixels;
            };
            q.wrapping_sub(*end) / step.unsigned_abs()
        } else {
            let Some(end) = level.checked_sub(1).and_then(|level| self.0.get(level)) else {
                return pixels;
            };
            if step == 0 {
                return pixels;
            }
            end.wrapping_sub(q).wrapping_sub(1) / step.unsigned_abs()
        };
        pixels.min(steps.saturating_add(1) as usize)
    }

    /// The level where 1/w is `q`: 0 to 3, coarser as 1/w falls.
    #[inline(always)]
    #[must_use]
    pub const fn level(&self, q: u32) -> u32 {
        let [a, b, c] = self.0;
        (q < a) as u32 + (q < b) as u32 + (q < c) as u32
    }
}

impl Corners {
    /// From which 1/w on down the coarser levels of detail are right; `area` is the triangle's
    /// doubled area on the screen, in units of 1/64 pixel.
    #[must_use]
    pub fn levels(&self, area: u64) -> LevelEnds {
        LevelEnds::new(self.doubled(), area, self.at.map(|at| at.q as u32))
    }

    /// The one level of detail for all of the triangle, whose area is as in
    /// [`levels`](Self::levels).
    #[must_use]
    pub fn level(&self, area: u64) -> LevelEnds {
        LevelEnds::constant(self.doubled(), area)
    }

    /// The triangle's doubled area on the texture, in units of 2^-16 texel.
    fn doubled(&self) -> u64 {
        let p = self.places().map(|(u, v)| (i64::from(u), i64::from(v)));
        let d = |i: usize| (p[i].0 - p[0].0, p[i].1 - p[0].1);
        let (a, b) = (d(1), d(2));
        (a.0 * b.1 - a.1 * b.0).unsigned_abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Runs of one level are what asking at each pixel says, whatever way 1/w goes.
    #[test]
    fn runs_of_a_level_are_those_of_its_pixels() {
        let mut state = 3u64;
        let mut below = |n: u32| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (((state >> 32) * u64::from(n)) >> 32) as u32
        };
        let mut cuts = 0;
        for _ in 0..40_000 {
            let q = [1 + below(1 << 30), 1 + below(1 << 30), 1 + below(1 << 20)];
            let ends = LevelEnds::new(
                u64::from(1 + below(1 << 31)) << below(12),
                u64::from(1 + below(1 << 22)),
                q,
            );
            assert!(ends.0.is_sorted_by(|a, b| a >= b), "{ends:?}");
            let pixels = 1 + below(40) as usize;
            let step = (i64::from(q[1]) - i64::from(q[0])) / pixels as i64;
            let at = |i: usize| (i64::from(q[0]) + step * i as i64) as u32;
            let mut pixel = 0;
            while pixel < pixels {
                let count = ends.same(at(pixel), step as i32, pixels - pixel);
                assert!(count >= 1 && count <= pixels - pixel);
                let level = ends.level(at(pixel));
                for i in pixel..pixel + count {
                    assert_eq!(ends.level(at(i)), level);
                }
                pixel += count;
                if pixel < pixels {
                    assert_ne!(ends.level(at(pixel)), level, "the run is as long as can be");
                    cuts += 1;
                }
            }
        }
        assert!(cuts > 2_000, "{cuts}");
    }

    /// A limit that a pixel meets exactly is the finer level's, whichever way 1/w goes.
    #[test]
    fn runs_end_exactly_at_a_limit() {
        let ends = LevelEnds([100, 0, 0]);
        assert_eq!((ends.level(100), ends.level(99)), (0, 1));
        assert_eq!(ends.same(90, 5, 10), 2);
        assert_eq!(ends.same(89, 5, 10), 3);
        assert_eq!(ends.same(99, 1, 10), 1);
        assert_eq!(ends.same(110, -5, 10), 3);
        assert_eq!(ends.same(111, -5, 10), 3);
        assert_eq!(ends.same(99, 0, 10), 10);
    }

    #[test]
    fn constant_levels_are_those_of_the_ratio() {
        // Doubled areas of a square of texels (2^-16) and of pixels (2^-6).
        for (texels, level) in [
            (1, 0),
            (15, 0),
            (17, 1),
            (62, 1),
            (66, 2),
            (250, 2),
            (262, 3),
            (9999, 3),
        ] {
            let ends = LevelEnds::constant(texels << 16, 8 << 6);
            assert_eq!(ends.level(0), level, "{texels} texels on 8 pixels");
        }
        assert_eq!(LevelEnds::constant(0, 9).level(0), 0);
        assert_eq!(LevelEnds::constant(9, 0).level(0), 0);
    }
}
