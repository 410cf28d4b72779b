//! Affine maps in block fixed point: from model to world, from world to the camera (S4).
//!
//! Nine mantissas of 30 bits share one exponent, the three of the translation another. So a
//! model of any size stands anywhere, products are exact in 64 bits before they are rounded,
//! and floats are but taken apart: none is reckoned with, so that all targets have the same bits.

use crate::num::{Block, I2F14, divide_signed, inverse_root, mul_wide, shift_round, sin_cos};

/// An affine map `p -> linear p + offset`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Affine {
    pub(super) linear: Block<9>,
    pub(super) offset: Block<3>,
}

impl Affine {
    /// The map that changes nothing.
    pub const IDENTITY: Self = Self::rotation([1 << 29, 0, 0, 0, 1 << 29, 0, 0, 0, 1 << 29]);

    /// From rows of the linear part and the offset, in world units.
    ///
    /// `None` when a number is not finite or beyond 2^96.
    #[must_use]
    pub fn from_rows(rows: [[f32; 3]; 3], offset: [f32; 3]) -> Option<Self> {
        Some(Self {
            linear: Block::from_f32(bytemuck::cast::<_, [f32; 9]>(rows))?,
            offset: Block::from_f32(offset)?,
        })
    }

    /// A uniform scale followed by a translation; `None` as in [`from_rows`](Affine::from_rows).
    #[must_use]
    pub fn placed(scale: f32, offset: [f32; 3]) -> Option<Self> {
        let rows = [[scale, 0.0, 0.0], [0.0, scale, 0.0], [0.0, 0.0, scale]];
        Self::from_rows(rows, offset)
    }

    /// A rotation about the x axis by `angle` radians, counter-clockwise seen from its tip: any
    /// finite angle, each entry 2^-28 off at most. By what is not finite, the identity.
    #[must_use]
    pub fn rotation_x(angle: f32) -> Self {
        let [s, c] = sin_cos(angle);
        Self::rotation([1 << 29, 0, 0, 0, c, -s, 0, s, c])
    }

    /// A rotation about the y axis by `angle` radians, counter-clockwise seen from its tip: any
    /// finite angle, each entry 2^-28 off at most. By what is not finite, the identity.
    #[must_use]
    pub fn rotation_y(angle: f32) -> Self {
        let [s, c] = sin_cos(angle);
        Self::rotation([c, 0, s, 0, 1 << 29, 0, -s, 0, c])
    }

    /// A rotation about the z axis by `angle` radians, counter-clockwise seen from its tip: any
    /// finite angle, each entry 2^-28 off at most. By what is not finite, the identity.
    #[must_use]
    pub fn rotation_z(angle: f32) -> Self {
        let [s, c] = sin_cos(angle);
        Self::rotation([c, -s, 0, s, c, 0, 0, 0, 1 << 29])
    }

    /// Of entries in 2^-29.
    const fn rotation(mantissa: [i32; 9]) -> Self {
        Self {
            linear: Block {
                mantissa,
                exponent: 1,
            },
            offset: Block::ZERO,
        }
    }

    /// The map that does `self` first and then `next`.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        let b = &self.linear.mantissa;
        let mut linear = [0i64; 9];
        for column in 0..3 {
            let from = [b[column], b[3 + column], b[6 + column]];
            let times = times(&next.linear.mantissa, from);
            for (row, value) in times.into_iter().enumerate() {
                linear[3 * row + column] = value;
            }
        }
        // What turns or scales alone moves nothing.
        let offset = if self.offset.is_zero() {
            next.offset
        } else {
            add(next.linear_times(self.offset), next.offset)
        };
        Self {
            linear: Block::new(linear, next.linear.exponent + self.linear.exponent - 30),
            offset,
        }
    }

    /// The nearest thing to this map that keeps lengths and angles: its first row made a unit
    /// vector, the second at a right angle to it, the third from both. The offset stays; scale
    /// goes; a map that mirrors still does. `None` when the first two rows are zero or within
    /// 2^-20 of parallel.
    ///
    /// A rotation that is turned a little each frame by [`then`](Affine::then) drifts: the
    /// rows of each turn are off by up to 2^-28, always the same way for the same turn, so
    /// after a million frames it may have grown or shrunk by some thousandths. This takes the
    /// drift out (M3): each entry of the linear part times its transpose is within 2^-26 of the
    /// identity. 5 roots: once a frame, or every hundred, is enough.
    /// ```
    /// # use scanbeam::Affine;
    /// let (mut turned, step) = (Affine::IDENTITY, Affine::rotation_y(0.01));
    /// for _ in 0..1000 {
    ///     turned = turned.then(&step).orthonormalised().unwrap_or(turned);
    /// }
    /// ```
    #[must_use]
    pub fn orthonormalised(&self) -> Option<Self> {
        let m = &self.linear.mantissa;
        let row = |i: usize| [m[3 * i], m[3 * i + 1], m[3 * i + 2]].map(i64::from);
        let x = unit_q30(row(0))?;
        let beside = |v: [i32; 3]| {
            let along = dot_q30(v, x);
            [0, 1, 2].map(|i| i64::from(v[i]) - shift_round(along * i64::from(x[i]), -30))
        };
        let y = beside(unit_q30(row(1))?);
        if y.iter().all(|c| c.abs() < 1 << 10) {
            return None;
        }
        // A second time: what was left over may have few bits.
        let y = unit_q30(beside(unit_q30(y)?))?;
        let mut z = cross(x, y);
        if dot_q30(unit_q30(row(2)).unwrap_or(z), z) < 0 {
            z = z.map(|c| -c);
        }
        Some(Self {
            offset: self.offset,
            ..Self::of_units([x, y, z])
        })
    }

    /// Of rows in Q30.
    #[inline(never)]
    pub(super) fn of_units(rows: [[i32; 3]; 3]) -> Self {
        let linear = bytemuck::cast::<_, [i32; 9]>(rows).map(i64::from);
        Self {
            linear: Block::new(linear, 0),
            offset: Block::ZERO,
        }
    }

    /// The first two rows of the nearest turn, in Q1.14; zeros where there is none.
    pub(crate) fn rows_q14(&self) -> [[i32; 3]; 2] {
        let turn = self.orthonormalised();
        let linear = turn.map_or(Block::ZERO, |turn| turn.linear);
        [0, 3].map(|row| [0, 1, 2].map(|i| linear.scaled(row + i, 14) as i32))
    }

    /// The linear part times a vector.
    pub(super) fn linear_times(&self, v: Block<3>) -> Block<3> {
        let sum = times(&self.linear.mantissa, v.mantissa);
        Block::new(sum, self.linear.exponent + v.exponent - 30)
    }

    /// A direction of world space seen from model space, as a unit vector.
    ///
    /// Right for rotations and uniform scales: the transpose stands in for the inverse.
    #[inline(never)]
    pub(super) fn direction_to_model(&self, direction: [I2F14; 3]) -> [I2F14; 3] {
        unit(self.transposed_times(direction))
    }

    /// The transpose of the linear part times a direction, of any length below 2^32.
    pub(super) fn transposed_times(&self, direction: [I2F14; 3]) -> [i64; 3] {
        let v = direction.map(|c| i32::from(c.to_bits()));
        self.dots_with_columns(v).map(|c| c >> 14)
    }

    /// The transpose of the linear part times a vector.
    #[inline(never)]
    fn dots_with_columns(&self, v: [i32; 3]) -> [i64; 3] {
        let m = &self.linear.mantissa;
        [0, 1, 2].map(|i| dot([m[i], m[3 + i], m[6 + i]], v))
    }

    /// The linear part times a direction.
    #[inline]
    pub(super) fn turned(&self, direction: [I2F14; 3]) -> [i64; 3] {
        let v = direction.map(|c| i32::from(c.to_bits()));
        times(&self.linear.mantissa, v).map(|c| c >> 14)
    }

    /// A direction of model space seen from where the map leads, a unit vector in Q1.30, 2^-28
    /// off at most; zero where there is no direction.
    pub(super) fn direction_from_model_q30(&self, direction: [I2F14; 3]) -> [i32; 3] {
        unit_q30(self.turned(direction)).unwrap_or_default()
    }

    /// The point that this map takes to the origin; where it has no inverse, the origin.
    ///
    /// Right for rotations and uniform scales, as above.
    pub(super) fn origin_in_model(&self) -> Block<3> {
        let m = &self.linear.mantissa;
        let along = self.dots_with_columns(self.offset.mantissa);
        // The scale squared: the mean of the rows, times 3.
        let square: i64 = m.iter().map(|&c| mul_wide(c, c) / 4).sum();
        let (along, square) = (Block::new(along, 0), Block::new([square], 0));
        // No square is below 0.
        let divisor = square.mantissa[0] as u32;
        if divisor == 0 {
            return Block::ZERO;
        }
        // 12 / 4 of the scale squared is 3 of them. Below 2^31: the divisor has 30 bits, and what is divided up to 60.
        let ratio = |c: i32| divide_signed((-3 * i64::from(c)) << 28, divisor);
        let exponent = along.exponent + self.offset.exponent;
        let exponent = exponent - square.exponent - self.linear.exponent;
        Block::new(along.mantissa.map(ratio), exponent)
    }
}

/// The unit vector along `v` (each below 2^62 in magnitude) in Q1.14, each 0.501 of its units off at most; zero stays
/// zero. Flat faces and normals at pixels ask for each of them.
pub(super) fn unit(v: [i64; 3]) -> [I2F14; 3] {
    near_unit_q30(v).map(|c| I2F14::from_bits((((c >> 15) + 1) >> 1) as i16))
}

/// The unit vector along `v`, likewise, in Q1.30, 2^-28 off at most; `None` for zero.
#[inline(never)]
pub(super) fn unit_q30(v: [i64; 3]) -> Option<[i32; 3]> {
    let near = near_unit_q30(v);
    let square: i64 = near.iter().map(|&c| mul_wide(c, c)).sum();
    // Half of what it lacks, of its length.
    let lacks = ((1 << 60) - square + (1 << 30)) >> 31;
    let mended = |c: i32| c + ((i64::from(c) * lacks + (1 << 29)) >> 30) as i32;
    (square != 0).then(|| near.map(mended))
}

/// About [`unit_q30`], its length 2^-27 off; zero stays zero.
#[inline(never)]
fn near_unit_q30(v: [i64; 3]) -> [i32; 3] {
    let [x, y, z] = v.map(i64::unsigned_abs);
    // The largest gets 30 bits, so its square 58 at least.
    let up = (x | y | z).leading_zeros() - 2;
    let v = v.map(|c| ((c << up) >> 32) as i32);
    let square = v.iter().map(|&c| mul_wide(c, c)).sum::<i64>() >> 30;
    let (root, half) = inverse_root((square as u32).max(1 << 28));
    v.map(|c| ((((i64::from(c) * i64::from(root)) >> (30 - half)) + 1) >> 1) as i32)
}

/// The scalar product of two vectors in Q1.30 of length up to 1.
fn dot_q30(a: [i32; 3], b: [i32; 3]) -> i64 {
    shift_round(dot(a, b), -30)
}

/// The scalar product.
pub(super) fn dot(a: [i32; 3], b: [i32; 3]) -> i64 {
    let [x, y, z] = [0, 1, 2].map(|i| mul_wide(a[i], b[i]));
    x + y + z
}

/// The cross product of such, likewise.
#[inline(never)]
pub(super) fn cross(a: [i32; 3], b: [i32; 3]) -> [i32; 3] {
    wide_cross(a, b).map(|c| ((c + (1 << 29)) >> 30) as i32)
}

/// The cross product.
#[inline(always)]
pub(super) fn wide_cross(a: [i32; 3], b: [i32; 3]) -> [i64; 3] {
    let part = |i: usize, k: usize| mul_wide(a[i], b[k]) - mul_wide(a[k], b[i]);
    [part(1, 2), part(2, 0), part(0, 1)]
}

/// A matrix, row by row, times a vector.
#[inline(never)]
fn times(m: &[i32; 9], v: [i32; 3]) -> [i64; 3] {
    [0, 1, 2].map(|i| dot([m[3 * i], m[3 * i + 1], m[3 * i + 2]], v))
}

/// The sum of two vectors, rounded once.
pub(super) fn add(a: Block<3>, b: Block<3>) -> Block<3> {
    let exponent = a.exponent.max(b.exponent);
    let mut sum = [0i64; 3];
    for part in [a, b] {
        add_to(&mut sum, &part.mantissa, part.exponent - exponent);
    }
    Block::new(sum, exponent - 2)
}

/// Adds numbers times a power of two, with 2 more bits below, so that a sum is rounded once. It knows no length, so that
/// it is not unrolled.
#[inline(never)]
fn add_to(sum: &mut [i64], mantissa: &[i32], shift: i32) {
    for (value, &m) in sum.iter_mut().zip(mantissa) {
        *value += shift_round(i64::from(m) << 2, shift);
    }
}

#[cfg(test)]
mod tests;
