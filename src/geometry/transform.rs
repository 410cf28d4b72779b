//! Affine maps in block fixed point: from model to world, from world to the camera (S4).
//!
//! Nine mantissas of 30 bits share one exponent, the three of the translation another. So a
//! model of any size stands anywhere, products are exact in 64 bits before they are rounded,
//! and no float is touched after set-up.

use crate::num::{Block, I2F14, shift_round};
use micromath::F32Ext;

/// An affine map `p -> linear p + offset`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Affine {
    pub(super) linear: Block<9>,
    pub(super) offset: Block<3>,
}

impl Affine {
    /// The map that changes nothing.
    pub const IDENTITY: Self = Self {
        linear: Block {
            mantissa: [1 << 29, 0, 0, 0, 1 << 29, 0, 0, 0, 1 << 29],
            exponent: 1,
        },
        offset: Block::ZERO,
    };

    /// From rows of the linear part and the offset, in world units.
    ///
    /// `None` when a number is not finite or beyond 2^96.
    #[must_use]
    pub fn from_rows(rows: [[f32; 3]; 3], offset: [f32; 3]) -> Option<Self> {
        let [a, b, c] = rows;
        Some(Self {
            linear: Block::from_f32([a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2]])?,
            offset: Block::from_f32(offset)?,
        })
    }

    /// A uniform scale followed by a translation; `None` as in [`from_rows`](Affine::from_rows).
    #[must_use]
    pub fn placed(scale: f32, offset: [f32; 3]) -> Option<Self> {
        Self::from_rows(
            [[scale, 0.0, 0.0], [0.0, scale, 0.0], [0.0, 0.0, scale]],
            offset,
        )
    }

    /// A rotation about the x axis by `angle` radians, counter-clockwise seen from its tip.
    #[must_use]
    pub fn rotation_x(angle: f32) -> Self {
        let (s, c) = sin_cos(angle);
        Self::rotation([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    }

    /// A rotation about the y axis by `angle` radians, counter-clockwise seen from its tip.
    #[must_use]
    pub fn rotation_y(angle: f32) -> Self {
        let (s, c) = sin_cos(angle);
        Self::rotation([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    }

    /// A rotation about the z axis by `angle` radians, counter-clockwise seen from its tip.
    #[must_use]
    pub fn rotation_z(angle: f32) -> Self {
        let (s, c) = sin_cos(angle);
        Self::rotation([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    }

    fn rotation(rows: [[f32; 3]; 3]) -> Self {
        Self::from_rows(rows, [0.0; 3]).unwrap_or(Self::IDENTITY)
    }

    /// The map that does `self` first and then `next`.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        let (a, b) = (&next.linear.mantissa, &self.linear.mantissa);
        let mut linear = [0i64; 9];
        for (i, value) in linear.iter_mut().enumerate() {
            let (row, column) = (i / 3 * 3, i % 3);
            for k in 0..3 {
                *value += i64::from(a[row + k]) * i64::from(b[k * 3 + column]);
            }
        }
        let moved = next.linear_times(self.offset);
        Self {
            linear: Block::new(linear, next.linear.exponent + self.linear.exponent - 30),
            offset: add(moved, next.offset),
        }
    }

    /// The linear part times a vector.
    pub(super) fn linear_times(&self, v: Block<3>) -> Block<3> {
        let m = &self.linear.mantissa;
        let mut sum = [0i64; 3];
        for (i, value) in sum.iter_mut().enumerate() {
            for k in 0..3 {
                *value += i64::from(m[i * 3 + k]) * i64::from(v.mantissa[k]);
            }
        }
        Block::new(sum, self.linear.exponent + v.exponent - 30)
    }

    /// A direction of world space seen from model space, as a unit vector.
    ///
    /// Right for rotations and uniform scales: the transpose stands in for the inverse.
    pub(super) fn direction_to_model(&self, direction: [I2F14; 3]) -> [I2F14; 3] {
        let m = &self.linear.mantissa;
        let mut v = [0i64; 3];
        for (i, value) in v.iter_mut().enumerate() {
            for k in 0..3 {
                *value += i64::from(m[k * 3 + i]) * i64::from(direction[k].to_bits());
            }
            *value >>= 14;
        }
        unit(v)
    }
}

/// The unit vector along `v` (each below 2^32 in magnitude) in Q1.14; zero stays zero.
pub(super) fn unit(v: [i64; 3]) -> [I2F14; 3] {
    let [x, y, z] = v;
    let bits = x.unsigned_abs() | y.unsigned_abs() | z.unsigned_abs();
    // 30 bits each: the sum of squares fits 62 bits, and the root has 30 of its own.
    let shift = bits.leading_zeros() as i32 - 34;
    let v = v.map(|c| shift_round(c, shift));
    let square: i64 = v.iter().map(|c| c * c).sum();
    let length = square.unsigned_abs().isqrt() as i64;
    if length == 0 {
        return [I2F14::ZERO; 3];
    }
    v.map(|c| I2F14::from_bits((((c << 15) / length + 1) >> 1) as i16))
}

fn add(a: Block<3>, b: Block<3>) -> Block<3> {
    let exponent = a.exponent.max(b.exponent);
    let mut sum = [0i64; 3];
    for (i, value) in sum.iter_mut().enumerate() {
        // 2 more bits below, so that the sum is rounded once.
        *value = shift_round(i64::from(a.mantissa[i]) << 2, a.exponent - exponent)
            + shift_round(i64::from(b.mantissa[i]) << 2, b.exponent - exponent);
    }
    Block::new(sum, exponent - 2)
}

/// Sine and cosine on the unit circle to 1e-7 (the angle itself is 0.0012 rad off at most).
///
/// micromath's polynomials give the point; a Newton step each puts it on the circle, so that a
/// rotation does not scale. Only IEEE basic operations, hence the same bits everywhere.
fn sin_cos(angle: f32) -> (f32, f32) {
    let (s, c) = (F32Ext::sin(angle), F32Ext::cos(angle));
    let scale = inverse_sqrt(s * s + c * c);
    (s * scale, c * scale)
}

/// `1 / sqrt(x)` for a positive normal `x`, to 1e-7: micromath's estimate and three Newton steps.
pub(super) fn inverse_sqrt(x: f32) -> f32 {
    let mut y = F32Ext::invsqrt(x);
    for _ in 0..3 {
        y *= 1.5 - 0.5 * x * y * y;
    }
    y
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value<const N: usize>(b: &Block<N>, i: usize) -> f64 {
        f64::from(b.mantissa[i]) * 2f64.powi(b.exponent - 30)
    }

    #[test]
    fn then_composes_like_matrices() {
        let a = Affine::from_rows(
            [[1.0, 2.0, 3.0], [0.5, -1.0, 0.25], [4.0, 0.0, 1.0]],
            [1.0, 2.0, 3.0],
        )
        .unwrap();
        let b = Affine::from_rows(
            [[0.0, 1.0, 0.0], [-2.0, 0.0, 0.0], [0.0, 0.0, 8.0]],
            [1000.0, -0.5, 0.0],
        )
        .unwrap();
        let c = a.then(&b);
        let linear = [0.5, -1.0, 0.25, -2.0, -4.0, -6.0, 32.0, 0.0, 8.0];
        for (i, want) in linear.into_iter().enumerate() {
            assert!((value(&c.linear, i) - want).abs() < 1e-7, "{i}");
        }
        for (i, want) in [1002.0, -2.5, 24.0].into_iter().enumerate() {
            assert!((value(&c.offset, i) - want).abs() < 1e-5, "{i}");
        }
        assert_eq!(a.then(&Affine::IDENTITY), a);
        assert_eq!(Affine::IDENTITY.then(&a), a);
    }

    #[test]
    fn rotations_keep_lengths() {
        for i in 0..1000 {
            let angle = i as f32 * 0.0137;
            let r = Affine::rotation_z(angle);
            let (c, s) = (value(&r.linear, 0), value(&r.linear, 3));
            assert!((c * c + s * s - 1.0).abs() < 1e-6, "{angle}");
            let want = f64::from(angle);
            assert!(
                (c - want.cos()).abs() < 0.003 && (s - want.sin()).abs() < 0.003,
                "{angle}"
            );
        }
    }

    #[test]
    fn units_have_length_one() {
        let u = unit([3 << 20, -4 << 20, 0]).map(I2F14::to_bits);
        assert_eq!(u, [9830, -13107, 0]);
        assert_eq!(unit([1, 0, 0]).map(I2F14::to_bits), [16384, 0, 0]);
        assert_eq!(unit([0; 3]).map(I2F14::to_bits), [0; 3]);
        assert_eq!(unit([-(1 << 32), 0, 0]).map(I2F14::to_bits), [-16384, 0, 0]);
    }
}
