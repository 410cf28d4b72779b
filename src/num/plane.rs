//! A quantity that is linear on the screen, as a plane modulo 2^32 (DESIGN: parameters).
//!
//! `P(i, j) = at + dx i + dy j` for pixel column `i` and line `j` of guard space. The sums wrap
//! on the way; the value at a covered pixel is right because the true value fits. Nothing is
//! accumulated down the object, so any line can be evaluated alone (K5).

use super::recip;

/// A plane: value at column 0 and line 0, and the steps to the next column and line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Plane {
    /// Value at the centre of pixel (0, 0), modulo 2^32.
    pub at: i32,
    /// Step to the next column, units of the value per pixel.
    pub dx: i32,
    /// Step to the next line, units of the value per pixel.
    pub dy: i32,
}

impl Plane {
    /// The value at the centre of pixel (`column`, `line`) of guard space.
    #[inline(always)]
    #[must_use]
    pub const fn at(&self, column: i32, line: i32) -> i32 {
        self.at
            .wrapping_add(self.dx.wrapping_mul(column))
            .wrapping_add(self.dy.wrapping_mul(line))
    }
}

/// What all planes of a triangle share: its differences and the reciprocal of its area.
#[derive(Clone, Copy, Debug)]
pub struct InverseArea {
    dx1: i32,
    dy1: i32,
    dx2: i32,
    dy2: i32,
    recip: u32,
    /// The area is `a 2^exponent` with `a` in 2^31 ..< 2^32.
    exponent: i32,
    negative: bool,
    /// Bits that the larger side of the bounding box needs, in pixels.
    extent_bits: u32,
    /// First corner, 13.3.
    x0: u16,
    y0: u16,
}

impl InverseArea {
    /// From the three corners, 13.3; `None` when the area is 0.
    #[inline]
    #[must_use]
    pub fn new(p: [(u16, u16); 3]) -> Option<Self> {
        let [(x0, y0), (x1, y1), (x2, y2)] = p;
        let dx1 = i32::from(x1) - i32::from(x0);
        let dy1 = i32::from(y1) - i32::from(y0);
        let dx2 = i32::from(x2) - i32::from(x0);
        let dy2 = i32::from(y2) - i32::from(y0);
        let area = i64::from(dx1) * i64::from(dy2) - i64::from(dx2) * i64::from(dy1);
        if area == 0 {
            return None;
        }
        let size = area.unsigned_abs();
        let up = size.leading_zeros();
        let a = ((size << up) >> 32) as u32;
        let extent =
            dx1.unsigned_abs() | dx2.unsigned_abs() | dy1.unsigned_abs() | dy2.unsigned_abs();
        Some(Self {
            dx1,
            dy1,
            dx2,
            dy2,
            recip: recip(a),
            exponent: 32 - up as i32,
            negative: area < 0,
            extent_bits: 32 - (extent >> 2).leading_zeros(),
            x0,
            y0,
        })
    }

    /// The plane through `value` at the three corners (in the order given to
    /// [`new`](InverseArea::new)), values in `0 ..< 2^31`.
    ///
    /// `None` when the triangle is so thin that a plane would err by more than 2^13 units (and
    /// half a unit a pixel for the rounding of the steps): then a plane is the wrong tool, and
    /// weights have to be taken for each pixel.
    #[inline(never)]
    #[must_use]
    pub fn plane(&self, value: [i32; 3]) -> Option<Plane> {
        let d1 = i64::from(value[1]) - i64::from(value[0]);
        let d2 = i64::from(value[2]) - i64::from(value[0]);
        if d1 == 0 && d2 == 0 {
            return Some(Plane {
                at: value[0],
                dx: 0,
                dy: 0,
            });
        }
        let (dx, off_x) = self.gradient(
            d1 * i64::from(self.dy2) - d2 * i64::from(self.dy1),
            4 - (self.x0 & 7) as i32,
        )?;
        let (dy, off_y) = self.gradient(
            d2 * i64::from(self.dx1) - d1 * i64::from(self.dx2),
            4 - (self.y0 & 7) as i32,
        )?;
        let column = i32::from(self.x0 >> 3);
        let line = i32::from(self.y0 >> 3);
        let at = value[0]
            .wrapping_add(off_x)
            .wrapping_add(off_y)
            .wrapping_sub(dx.wrapping_mul(column))
            .wrapping_sub(dy.wrapping_mul(line));
        Some(Plane { at, dx, dy })
    }

    /// Step per pixel, and the step over `sub` units of 1/8 pixel, of `numerator / area`.
    #[inline(never)]
    fn gradient(&self, numerator: i64, sub: i32) -> Option<(i32, i32)> {
        // |numerator| < 2^50: keep 31 significant bits.
        let down = 33u32.saturating_sub(numerator.unsigned_abs().leading_zeros());
        let n = numerator >> down;
        let product = n * i64::from(self.recip);
        let product = if self.negative { -product } else { product };
        // numerator / area = product 2^(down - 62 - exponent) per unit, 8 units a pixel. The area is at least 1, so
        // the exponent is at least -31, and this is always a shift down.
        let shift = 62 + self.exponent - down as i32 - 3;
        let step = shift_down(product, shift);
        let bits = 64 - step.unsigned_abs().leading_zeros();
        if bits + self.extent_bits > 41 || bits > 30 {
            return None;
        }
        let off = shift_down((product >> 3) * i64::from(sub), shift);
        Some((step as i32, off as i32))
    }
}

/// `value 2^-shift` for a shift of 1 to 63, rounded to nearest, half up.
#[inline(always)]
fn shift_down(value: i64, shift: i32) -> i64 {
    let before = (shift - 1).clamp(0, 62);
    ((value >> before) + 1) >> 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::random::Rng;

    /// The exact value of the plane at a pixel centre.
    fn exact(p: [(u16, u16); 3], v: [i32; 3], column: i32, line: i32) -> f64 {
        let f = |i: usize| (f64::from(p[i].0), f64::from(p[i].1), f64::from(v[i]));
        let ((x0, y0, v0), (x1, y1, v1), (x2, y2, v2)) = (f(0), f(1), f(2));
        let area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0);
        let gx = ((v1 - v0) * (y2 - y0) - (v2 - v0) * (y1 - y0)) / area;
        let gy = ((x1 - x0) * (v2 - v0) - (x2 - x0) * (v1 - v0)) / area;
        v0 + gx * (f64::from(column) * 8.0 + 4.0 - x0) + gy * (f64::from(line) * 8.0 + 4.0 - y0)
    }

    #[test]
    fn planes_keep_their_bound_at_every_corner_pixel() {
        let mut rng = Rng(7);
        let mut refused = 0;
        let mut made = 0;
        for i in 0..200_000 {
            let size = [16, 200, 2560, 65_535][i % 4];
            let range = [1 << 24, 0x7FFF_FFFF][i / 4 % 2];
            let base = (rng.below(65_536 - size), rng.below(65_536 - size));
            let p = [(); 3].map(|()| {
                (
                    (base.0 + rng.below(size)) as u16,
                    (base.1 + rng.below(size)) as u16,
                )
            });
            let v = [(); 3].map(|()| rng.below(range) as i32);
            let Some(inverse) = InverseArea::new(p) else {
                continue;
            };
            let Some(plane) = inverse.plane(v) else {
                refused += 1;
                continue;
            };
            made += 1;
            for (x, y) in p {
                let (column, line) = (i32::from(x >> 3), i32::from(y >> 3));
                let error = f64::from(plane.at(column, line)) - exact(p, v, column, line);
                // Modulo 2^32, since a pixel beside a corner may lie outside the range.
                let error = error - (error / 4294967296.0).round() * 4294967296.0;
                let bound = 8194.0 + f64::from(size) / 8.0;
                assert!(error.abs() <= bound, "{p:?} {v:?}: {error}");
            }
        }
        assert!(made > 100_000, "{made} made, {refused} refused");
    }

    /// Kills: a box whose sides are not all looked at.
    #[test]
    fn steep_planes_are_refused_in_large_boxes_alone() {
        // A step of 2^29 to the right or down, and the box once wide, once high, once both.
        let steep = 1 << 26;
        let planes = |p, value| InverseArea::new(p).unwrap().plane(value);
        for (far, is_made) in [(20_000, false), (8_000, true)] {
            for (p, value) in [
                ([(0, 0), (far, 0), (far, 1)], [0, 0, steep]),
                ([(0, 0), (far, far), (0, 1)], [0, 0, steep]),
                ([(0, 0), (1, far), (0, far)], [0, steep, 0]),
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
            let mut corner = || (rng.below(2560) as u16, rng.below(1920) as u16);
            let p = [corner(), corner(), corner()];
            let v = [(); 3].map(|()| rng.below(1 << 31) as i32);
            let Some(plane) = InverseArea::new(p).and_then(|inverse| inverse.plane(v)) else {
                continue;
            };
            let step = exact(p, v, 1, 0) - exact(p, v, 0, 0);
            worst = worst.max((f64::from(plane.dx) - step).abs());
        }
        assert!((1.2..=1.7).contains(&worst), "{worst}");
    }

    #[test]
    fn a_constant_is_exact() {
        let inverse = InverseArea::new([(0, 0), (65_535, 1), (0, 9)]).unwrap();
        assert_eq!(
            inverse.plane([77; 3]),
            Some(Plane {
                at: 77,
                dx: 0,
                dy: 0
            })
        );
        assert!(InverseArea::new([(5, 5), (6, 6), (7, 7)]).is_none());
    }
}
