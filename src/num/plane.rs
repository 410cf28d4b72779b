//! A quantity that is linear on the screen, as a plane modulo 2^32 (DESIGN: parameters).
//!
//! `P(i, j) = at + dx i + dy j` for pixel column `i` and line `j` of the picture. The sums wrap
//! on the way; the value at a covered pixel is right because the true value fits. Nothing is
//! accumulated down the object, so any line can be evaluated alone (K5).
//!
//! A numerator is two sums of products of 16 bits, so that no product has 64 bits.

use super::product::{few_leading_zeros, leading_zeros, mul_high};
use super::{recip, rounded};

/// What all planes of a triangle share: the ways from its first corner to the others, and the reciprocal of its area.
#[derive(Clone, Copy, Debug)]
pub struct InverseArea {
    /// Units of 1/8 pixel across and down from the corner of the picture's first pixel.
    first: [i32; 2],
    /// From there to the second and the third corner, 16 bits with a sign.
    ways: [[i32; 2]; 2],
    /// The doubled area's reciprocal is `recip 2^(up - 62)`.
    recip: i32,
    up: u32,
    /// How many bits the steps of a plane may have.
    most: u32,
}

impl InverseArea {
    /// Of a triangle whose corners go clockwise: where the first one is, and the ways to the others, units of 1/8 pixel
    /// and below 2^15 either way; `None` when the area is 0.
    #[inline(always)]
    pub fn new(first: [i32; 2], ways: [[i32; 2]; 2]) -> Option<Self> {
        let [[dx1, dy1], [dx2, dy2]] = ways;
        let area = dx1 * dy2 - dx2 * dy1;
        if area <= 0 {
            return None;
        }
        let up = leading_zeros(area as u32);
        let [a, b, c, d] = [dx1, dy1, dx2, dy2].map(|d| d ^ (d >> 31));
        Some(Self {
            first,
            ways,
            recip: recip((area as u32) << (up & 31)).min(i32::MAX as u32) as i32,
            up,
            // 40 less those of the box in half pixels, which are taken as 9 at least, and are 13 at most.
            most: 26 + few_leading_zeros(((a | b | c | d) as u32 >> 2 | 1 << 8) << 18),
        })
    }

    /// The plane through `value` at the three corners, values in `0 ..< 2^31`: its value at the centre of the picture's first
    /// pixel, and its steps to the right and down.
    ///
    /// `None` when the triangle is so thin that a plane would err by more than 2^13 units (and
    /// half a unit a pixel for the rounding of the steps): then a plane is the wrong tool, and
    /// weights have to be taken for each pixel.
    #[inline(never)]
    pub fn plane(&self, value: [i32; 3]) -> Option<[u32; 3]> {
        let rises = [value[1] - value[0], value[2] - value[0]];
        if rises == [0; 2] {
            return Some([value[0] as u32, 0, 0]);
        }
        let [one, other] = rises.map(Halves::of);
        let [[dx1, dy1], [dx2, dy2]] = self.ways;
        let right = self.gradient(one, dy2, other, dy1);
        let down = self.gradient(other, dx1, one, dx2);
        if (right.shift | down.shift) < 0 {
            return None;
        }
        let [dx, dy] = [right, down].map(|g| rounded(g.mantissa, g.shift));
        if ((dx ^ (dx >> 31)) | (dy ^ (dy >> 31))) >> self.most != 0 {
            return None;
        }
        let [x, y] = self.first;
        let at = value[0]
            .wrapping_add(right.over(4 - (x & 7)))
            .wrapping_add(down.over(4 - (y & 7)))
            .wrapping_sub(dx.wrapping_mul(x >> 3))
            .wrapping_sub(dy.wrapping_mul(y >> 3));
        Some([at, dx, dy].map(|v| v as u32))
    }

    /// `8 (one by - other with) / area`.
    #[inline(always)]
    fn gradient(&self, one: Halves, by: i32, other: Halves, with: i32) -> Gradient {
        let high = one.high * by - other.high * with;
        let low = one.low * by - other.low * with;
        let (high, low) = (high + (low >> 16), low & 0xFFFF);
        // Both as one number of 31 bits and a sign; of small ones fewer, and no shift is by more than 30.
        let up = leading_zeros((high ^ (high >> 31)) as u32 | 1 << 11).wrapping_sub(1) & 31;
        let numerator = (high << up) | ((low << 15) >> (31 - up));
        Gradient {
            mantissa: mul_high(numerator, self.recip),
            shift: (11 + up).wrapping_sub(self.up) as i32,
        }
    }
}

/// A number with a sign in two of 16 bits with signs each.
#[derive(Clone, Copy)]
struct Halves {
    high: i32,
    low: i32,
}

impl Halves {
    #[inline(always)]
    fn of(number: i32) -> Self {
        Self {
            high: ((number >> 15) + 1) >> 1,
            low: i32::from(number as i16),
        }
    }
}

/// A step of a pixel, `mantissa 2^-shift`, the mantissa below 2^30 either way.
#[derive(Clone, Copy)]
struct Gradient {
    mantissa: i32,
    shift: i32,
}

impl Gradient {
    /// The way over so many units of 1/8 pixel, up to 4.
    #[inline(always)]
    fn over(self, units: i32) -> i32 {
        rounded((self.mantissa >> 3) * units, self.shift)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::random::Rng;

    /// The exact value of the plane at a pixel centre.
    fn exact(p: [[i32; 2]; 3], v: [i32; 3], column: i32, line: i32) -> f64 {
        let f = |i: usize| (f64::from(p[i][0]), f64::from(p[i][1]), f64::from(v[i]));
        let ((x0, y0, v0), (x1, y1, v1), (x2, y2, v2)) = (f(0), f(1), f(2));
        let area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0);
        let gx = ((v1 - v0) * (y2 - y0) - (v2 - v0) * (y1 - y0)) / area;
        let gy = ((x1 - x0) * (v2 - v0) - (x2 - x0) * (v1 - v0)) / area;
        v0 + gx * (f64::from(column) * 8.0 + 4.0 - x0) + gy * (f64::from(line) * 8.0 + 4.0 - y0)
    }

    /// Of corners that go clockwise.
    fn inverse(p: [[i32; 2]; 3]) -> Option<InverseArea> {
        let way = |i: usize| [p[i][0] - p[0][0], p[i][1] - p[0][1]];
        InverseArea::new(p[0], [way(1), way(2)])
    }

    fn clockwise([a, b, c]: [[i32; 2]; 3]) -> [[i32; 2]; 3] {
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        if area < 0 { [a, c, b] } else { [a, b, c] }
    }

    fn at([at, dx, dy]: [u32; 3], [column, line]: [i32; 2]) -> i32 {
        let way = (dx as i32).wrapping_mul(column);
        let way = way.wrapping_add((dy as i32).wrapping_mul(line));
        (at as i32).wrapping_add(way)
    }

    /// Kills: shares of an area with fewer bits, steps that may have one bit more, and a place of the first corner that is
    /// looked at but for its pixel.
    #[test]
    fn planes_keep_their_bound_at_every_corner_pixel() {
        let mut rng = Rng(7);
        let (mut refused, mut made, mut most) = (0, 0, 0f64);
        for i in 0..200_000 {
            let size = [16, 200, 2560, 32_767][i % 4];
            let range = [1 << 24, 0x7FFF_FFFF][i / 4 % 2];
            let mut below = |most: u32| rng.below(most) as i32;
            let base = [(); 2].map(|()| below(65_536 - size) - 32_768);
            let p = clockwise([(); 3].map(|()| base.map(|c| c + below(size))));
            let v = [(); 3].map(|()| below(range));
            let Some(inverse) = inverse(p) else {
                continue;
            };
            let Some(plane) = inverse.plane(v) else {
                refused += 1;
                continue;
            };
            made += 1;
            for corner in p {
                let [column, line] = corner.map(|c| c >> 3);
                let error = f64::from(at(plane, [column, line])) - exact(p, v, column, line);
                // Modulo 2^32, since a pixel beside a corner may lie outside the range.
                let error = error - (error / 4294967296.0).round() * 4294967296.0;
                let error = error.abs() - f64::from(size) / 8.0;
                assert!(error <= 8194.0, "{p:?} {v:?}: {error}");
                most = most.max(error);
            }
        }
        std::println!("{most} units, {refused} refused");
        assert!(made > 100_000, "{made} made, {refused} refused");
    }

    /// Kills: a box whose sides are not all looked at, or that may be twice or half as steep.
    #[test]
    fn steep_planes_are_refused_in_large_boxes_alone() {
        // A step of 2^29 or of 3/4 of it to the right or down, and the box once wide, once high, once both.
        let planes = |p, value| inverse(p).unwrap().plane(value);
        let (steep, steeper) = (3 << 24, 1 << 26);
        for (far, steep, is_made) in [
            (10_000, steeper, false),
            (10_000, steep, false),
            (8_000, steep, true),
            (4_000, steeper, true),
        ] {
            for (p, value) in [
                ([[0, 0], [far, 0], [far, 1]], [0, 0, steep]),
                ([[0, 0], [far, far], [0, 1]], [0, 0, steep]),
                ([[0, 0], [1, far], [0, far]], [0, steep, 0]),
            ] {
                assert_eq!(planes(p, value).is_some(), is_made, "{p:?}");
            }
        }
    }

    /// Kills: numerators with fewer bits.
    #[test]
    fn steps_are_exact_to_a_unit() {
        let mut rng = Rng(8);
        let mut worst = 0f64;
        for _ in 0..100_000 {
            let mut corner = || [rng.below(2560) as i32, rng.below(1920) as i32];
            let p = clockwise([corner(), corner(), corner()]);
            let v = [(); 3].map(|()| rng.below(1 << 31) as i32);
            let Some([_, dx, _]) = inverse(p).and_then(|inverse| inverse.plane(v)) else {
                continue;
            };
            let step = exact(p, v, 1, 0) - exact(p, v, 0, 0);
            worst = worst.max((f64::from(dx as i32) - step).abs());
        }
        assert!((1.2..=1.7).contains(&worst), "{worst}");
    }

    #[test]
    fn a_constant_is_exact() {
        let inverse = |p| inverse(p).map(|inverse| inverse.plane([77; 3]));
        assert_eq!(
            inverse([[0, 0], [32_767, 1], [0, 9]]),
            Some(Some([77, 0, 0]))
        );
        assert_eq!(inverse([[5, 5], [6, 6], [7, 7]]), None);
    }
}
