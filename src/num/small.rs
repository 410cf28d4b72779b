//! Planes of triangles of at most 64 x 64 pixels, in 32-bit arithmetic.
//!
//! Most triangles of a mesh are small. Then differences, areas and numerators fit 32 bits, and
//! a 15-bit reciprocal of the area is enough: its error is common to both gradients, so it acts
//! on the rise across the triangle, not on positions. No product is wider than
//! `floor(a b / 2^16)` with a 15-bit `b`, one instruction on a Cortex-M4 and two multiplications
//! on a Cortex-M0+.

use super::Plane;
use super::product::{divide_16, leading_zeros, mul_16};

/// What the planes of a small triangle share.
#[derive(Clone, Copy, Debug)]
pub struct SmallArea {
    dx1: i32,
    dy1: i32,
    dx2: i32,
    dy2: i32,
    /// From the first corner to the centre of its pixel, units of 1/8 pixel.
    sub: (i32, i32),
    /// Pixel of the first corner.
    pixel: (i32, i32),
    /// `8 / area = recip 2^-shift`, 14 to 15 bits, with the sign of the area.
    recip: i32,
    /// 1 to 26.
    shift: i32,
    /// Bits of the larger side, in pixels.
    extent_bits: u32,
}

/// A gradient before its final shift: `true value = x 2^-shift` per pixel.
#[derive(Clone, Copy, Debug)]
pub struct Gradient {
    x: i32,
    y: i32,
}

impl SmallArea {
    /// From the three corners, 13.3; `None` when the triangle is larger than 64 pixels either
    /// way, or smaller than a quarter of a pixel.
    #[inline]
    #[must_use]
    pub fn new(p: [(u16, u16); 3]) -> Option<Self> {
        let [(x0, y0), (x1, y1), (x2, y2)] = p;
        let dx1 = i32::from(x1) - i32::from(x0);
        let dy1 = i32::from(y1) - i32::from(y0);
        let dx2 = i32::from(x2) - i32::from(x0);
        let dy2 = i32::from(y2) - i32::from(y0);
        // One test for all sides: a difference in -512 ..= 511 leaves no bit above.
        let size = |d: i32| d ^ (d >> 31);
        let extent =
            size(dx1) | size(dx2) | size(dx2 - dx1) | size(dy1) | size(dy2) | size(dy2 - dy1);
        if extent > 511 {
            return None;
        }
        let area = dx1 * dy2 - dx2 * dy1;
        let size = area.unsigned_abs();
        if size < 32 {
            return None;
        }
        let up = leading_zeros(size);
        // area = a 2^(16 - up), a in 2^15 ..< 2^16, to nearest
        let a = ((size << up) >> 16).max(1 << 15);
        let recip = divide_16((1 << 30) + a / 2, a).min(0x7FFF) as i32;
        Some(Self {
            dx1,
            dy1,
            dx2,
            dy2,
            sub: (4 - i32::from(x0 & 7), 4 - i32::from(y0 & 7)),
            pixel: (i32::from(x0 >> 3), i32::from(y0 >> 3)),
            recip: if area < 0 { -recip } else { recip },
            // n 8 / area = (n recip / 2^16) 2^(16 + 3 - 30 - 16 + up)
            shift: 27 - up as i32,
            extent_bits: 32 - leading_zeros(extent as u32 >> 2),
        })
    }

    /// The doubled area, in units of 1/64 pixel.
    #[inline]
    #[must_use]
    pub fn doubled(&self) -> u64 {
        u64::from((self.dx1 * self.dy2 - self.dx2 * self.dy1).unsigned_abs())
    }

    /// The gradient of a quantity by its rises from the first corner to the others, each below
    /// 2^17 in magnitude.
    #[inline(always)]
    #[must_use]
    pub fn gradient(&self, d1: i32, d2: i32) -> Gradient {
        let times = |n: i32| mul_16(n, self.recip as i16);
        Gradient {
            x: times(d1 * self.dy2 - d2 * self.dy1),
            y: times(d2 * self.dx1 - d1 * self.dx2),
        }
    }

    /// How many bits the rise across the triangle needs at most, of the largest of some
    /// gradients, in units of 2^-`up`.
    ///
    /// A plane errs by at most 2^-13 of that; long slivers rise far more than their corners.
    #[inline(always)]
    #[must_use]
    pub fn rise_bits<const N: usize>(&self, gradients: [Gradient; N], up: i32) -> i32 {
        let all = gradients
            .iter()
            .fold(0, |all, g| all | (g.x ^ (g.x >> 31)) | (g.y ^ (g.y >> 31)));
        32 - leading_zeros(all as u32) as i32 + self.extent_bits as i32 + up - self.shift
    }

    /// The step of a gradient to the next column and line, rounded to nearest.
    #[inline(always)]
    #[must_use]
    pub fn step(&self, g: Gradient) -> (i32, i32) {
        let half = (1 << self.shift) >> 1;
        ((g.x + half) >> self.shift, (g.y + half) >> self.shift)
    }

    /// The plane of a gradient with this value at the first corner, in units of 2^-`up`.
    #[inline(always)]
    #[must_use]
    fn plane(&self, value: i32, g: Gradient, up: i32) -> Plane {
        let down = self.shift - up;
        let off = shift_by(g.x * self.sub.0 + g.y * self.sub.1, down + 3);
        self.plane_of_steps(
            value.wrapping_add(off),
            (shift_by(g.x, down), shift_by(g.y, down)),
        )
    }

    /// The plane with this value at the centre of the first corner's pixel, and these steps.
    #[inline(always)]
    #[must_use]
    pub fn plane_of_steps(&self, value: i32, (dx, dy): (i32, i32)) -> Plane {
        let at = value
            .wrapping_sub(dx.wrapping_mul(self.pixel.0))
            .wrapping_sub(dy.wrapping_mul(self.pixel.1));
        Plane { at, dx, dy }
    }

    /// The rise from the first corner to the centre of its pixel, rounded to nearest.
    #[inline(always)]
    #[must_use]
    pub fn offset(&self, g: Gradient) -> i32 {
        let down = self.shift + 3;
        (g.x * self.sub.0 + g.y * self.sub.1 + (1 << (down - 1))) >> down
    }

    /// The plane of a quantity of up to 31 bits; `None` where it would err by more than 2^13.
    ///
    /// Its differences are kept to 15 bits and a sign.
    #[inline(always)]
    #[must_use]
    pub fn wide_plane(&self, value: [i32; 3]) -> Option<Plane> {
        let d1 = value[1] - value[0];
        let d2 = value[2] - value[0];
        let size = (d1 ^ (d1 >> 31)) | (d2 ^ (d2 >> 31));
        let bits = 32 - leading_zeros(size as u32) as i32;
        let down = (bits - 15).max(0);
        let half = (1 << down) >> 1;
        let g = self.gradient((d1 + half) >> down, (d2 + half) >> down);
        (self.rise_bits([g], down) <= 26).then(|| self.plane(value[0], g, down))
    }

    /// Whether [`InverseArea::plane`](super::InverseArea::plane) surely has a plane of this
    /// quantity of up to 31 bits: it rises by less than 2^29 a pixel.
    #[inline(always)]
    #[must_use]
    pub fn is_gentle(&self, value: [i32; 3]) -> bool {
        let d1 = value[1] - value[0];
        let d2 = value[2] - value[0];
        let size = (d1 ^ (d1 >> 31)) | (d2 ^ (d2 >> 31));
        let bits = 32 - leading_zeros(size as u32) as i32;
        // The numerator has at most `bits + extent_bits + 3`, the area at least `shift + 4` behind
        // its first, and a pixel is 8 units.
        bits + self.extent_bits as i32 <= self.shift + 27
    }
}

/// `value 2^-down`, rounded to nearest where it shifts right.
#[inline(always)]
#[must_use]
const fn shift_by(value: i32, down: i32) -> i32 {
    if down > 0 {
        ((value >> (down - 1)) + 1) >> 1
    } else {
        value << -down
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::random::Rng;

    #[test]
    fn planes_of_small_triangles_keep_their_bound() {
        let mut rng = Rng(3);
        let (mut made, mut refused) = (0, 0);
        for i in 0..480_000 {
            let size = [8, 40, 200, 512][i % 4];
            let range = [1 << 12, 1 << 20, 0x7FFF_0000][i / 4 % 3];
            let base = (rng.below(60_000), rng.below(60_000));
            let p = [(); 3].map(|()| {
                (
                    (base.0 + rng.below(size)) as u16,
                    (base.1 + rng.below(size)) as u16,
                )
            });
            let v = [(); 3].map(|()| rng.below(range) as i32);
            let Some(area) = SmallArea::new(p) else {
                continue;
            };
            let Some(plane) = area.wide_plane(v) else {
                refused += 1;
                continue;
            };
            made += 1;
            let f = |i: usize| (f64::from(p[i].0), f64::from(p[i].1), f64::from(v[i]));
            let ((x0, y0, v0), (x1, y1, v1), (x2, y2, v2)) = (f(0), f(1), f(2));
            let size = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0);
            let gx = ((v1 - v0) * (y2 - y0) - (v2 - v0) * (y1 - y0)) / size;
            let gy = ((x1 - x0) * (v2 - v0) - (x2 - x0) * (v1 - v0)) / size;
            for (x, y) in p {
                let (column, line) = (i32::from(x >> 3), i32::from(y >> 3));
                let exact = v0
                    + gx * (f64::from(column) * 8.0 + 4.0 - x0)
                    + gy * (f64::from(line) * 8.0 + 4.0 - y0);
                let error = f64::from(plane.at(column, line)) - exact;
                let error = error - (error / 4294967296.0).round() * 4294967296.0;
                assert!(error.abs() <= 8192.0 + 130.0, "{p:?} {v:?}: {error}");
            }
        }
        assert!(made > 200_000, "{made} made, {refused} refused");
    }

    #[test]
    fn what_is_gentle_has_a_plane() {
        use crate::num::InverseArea;
        let mut rng = Rng(8);
        let (mut gentle, mut steep, mut refused) = (0, 0, 0);
        for i in 0..480_000 {
            let size = [8, 20, 60, 511][i % 4];
            let range = [1 << 12, 1 << 20, 1 << 27, i32::MAX as u32][i / 4 % 4];
            let p = [(); 3].map(|()| (rng.below(size) as u16, rng.below(size) as u16));
            let v = [(); 3].map(|()| rng.below(range) as i32);
            let Some(area) = SmallArea::new(p) else {
                continue;
            };
            let plane = InverseArea::new(p).and_then(|area| area.plane(v));
            if area.is_gentle(v) {
                gentle += 1;
                assert!(plane.is_some(), "{p:?} {v:?}");
            } else {
                steep += 1;
                refused += u32::from(plane.is_none());
            }
        }
        assert!(
            gentle > 200_000 && steep > 10_000 && refused > 1_000,
            "{gentle} {steep} {refused}"
        );
    }

    #[test]
    fn large_and_empty_ones_are_refused() {
        assert!(SmallArea::new([(0, 0), (512, 0), (0, 8)]).is_none());
        assert!(SmallArea::new([(0, 0), (511, 0), (0, 511)]).is_some());
        assert!(SmallArea::new([(0, 0), (8, 0), (0, 4)]).is_some());
        assert!(SmallArea::new([(0, 0), (8, 0), (0, 3)]).is_none());
        assert!(SmallArea::new([(9, 9), (10, 10), (11, 11)]).is_none());
    }
}
