//! Affine maps in block fixed point: from model to world, from world to the camera (S4).
//!
//! Nine mantissas of 30 bits share one exponent, the three of the translation another. So a
//! model of any size stands anywhere, products are exact in 64 bits before they are rounded,
//! and no float is touched after set-up.

use crate::num::{Block, I2F14, shift_round, shift_round_inline};
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

    /// A rotation about the x axis by `angle` radians, counter-clockwise seen from its tip: any
    /// finite angle, to 0.0012 rad of its remainder. By what is not finite, the identity.
    #[must_use]
    pub fn rotation_x(angle: f32) -> Self {
        let (s, c) = sin_cos(angle);
        Self::rotation([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    }

    /// A rotation about the y axis by `angle` radians, counter-clockwise seen from its tip: any
    /// finite angle, to 0.0012 rad of its remainder. By what is not finite, the identity.
    #[must_use]
    pub fn rotation_y(angle: f32) -> Self {
        let (s, c) = sin_cos(angle);
        Self::rotation([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    }

    /// A rotation about the z axis by `angle` radians, counter-clockwise seen from its tip: any
    /// finite angle, to 0.0012 rad of its remainder. By what is not finite, the identity.
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
        let b = &self.linear.mantissa;
        let mut linear = [0i64; 9];
        for column in 0..3 {
            let times = times(
                &next.linear.mantissa,
                [b[column], b[3 + column], b[6 + column]],
            );
            for (row, value) in times.into_iter().enumerate() {
                linear[3 * row + column] = value;
            }
        }
        let moved = next.linear_times(self.offset);
        Self {
            linear: Block::new(linear, next.linear.exponent + self.linear.exponent - 30),
            offset: add(moved, next.offset),
        }
    }

    /// The nearest thing to this map that keeps lengths and angles: its first row made a unit
    /// vector, the second at a right angle to it, the third from both. The offset stays; scale
    /// goes; a map that mirrors still does. `None` when the first two rows are zero or within
    /// 2^-20 of parallel.
    ///
    /// A rotation that is turned a little each frame by [`then`](Affine::then) drifts: the
    /// `f32` rows of each turn are off by up to 2^-22, always the same way for the same turn, so
    /// after a million frames it may have grown or shrunk by several per cent. This takes the
    /// drift out (M3): each entry of the linear part times its transpose is within 2^-26 of the
    /// identity. Integers alone, 4 square roots: once a frame, or every hundred, is enough.
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
        let beside = |v: [i64; 3]| {
            let along = dot_q30(v, x);
            [0, 1, 2].map(|i| v[i] - shift_round(along * x[i], -30))
        };
        let y = beside(unit_q30(row(1))?);
        if y.iter().all(|c| c.abs() < 1 << 10) {
            return None;
        }
        // A second time: what was left over may have few bits.
        let y = unit_q30(beside(unit_q30(y)?))?;
        let mut z =
            [(1, 2), (2, 0), (0, 1)].map(|(i, k)| shift_round(x[i] * y[k] - x[k] * y[i], -30));
        if dot_q30(unit_q30(row(2)).unwrap_or(z), z) < 0 {
            z = z.map(|c| -c);
        }
        let [x, y, z] = [x, y, z];
        let linear = [x[0], x[1], x[2], y[0], y[1], y[2], z[0], z[1], z[2]];
        Some(Self {
            linear: Block::new(linear, 0),
            offset: self.offset,
        })
    }

    /// The linear part times a vector.
    pub(super) fn linear_times(&self, v: Block<3>) -> Block<3> {
        let sum = times(&self.linear.mantissa, v.mantissa);
        Block::new(sum, self.linear.exponent + v.exponent - 30)
    }

    /// A direction of world space seen from model space, as a unit vector.
    ///
    /// Right for rotations and uniform scales: the transpose stands in for the inverse.
    pub(super) fn direction_to_model(&self, direction: [I2F14; 3]) -> [I2F14; 3] {
        unit(self.transposed_times(direction))
    }

    /// The same in Q1.30, 2^-28 off at most; zero where there is no direction.
    pub(super) fn direction_to_model_q30(&self, direction: [I2F14; 3]) -> [i32; 3] {
        unit_q30(self.transposed_times(direction)).map_or([0; 3], |v| v.map(|c| c as i32))
    }

    /// The transpose of the linear part times a direction, of any length below 2^32.
    #[inline(always)]
    fn transposed_times(&self, direction: [I2F14; 3]) -> [i64; 3] {
        let m = &self.linear.mantissa;
        let mut v = [0i64; 3];
        for (i, value) in v.iter_mut().enumerate() {
            for k in 0..3 {
                *value += i64::from(m[k * 3 + i]) * i64::from(direction[k].to_bits());
            }
            *value >>= 14;
        }
        v
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
        unit_q30(self.turned(direction)).map_or([0; 3], |v| v.map(|c| c as i32))
    }

    /// The point that this map takes to the origin; where it has no inverse, the origin.
    ///
    /// Right for rotations and uniform scales, as above.
    pub(super) fn origin_in_model(&self) -> Block<3> {
        let m = self.linear.mantissa.map(i64::from);
        let o = self.offset.mantissa.map(i64::from);
        let along = [0, 1, 2].map(|i| m[i] * o[0] + m[3 + i] * o[1] + m[6 + i] * o[2]);
        // The scale squared: the mean of the rows, times 3.
        let square: i64 = m.iter().map(|c| c * c / 4).sum();
        let (along, square) = (Block::new(along, 0), Block::new([square], 0));
        let divisor = i64::from(square.mantissa[0]);
        if divisor == 0 {
            return Block::ZERO;
        }
        // 12 / 4 of the scale squared is 3 of them.
        let ratio = along
            .mantissa
            .map(|c| ((-3 * i64::from(c)) << 30) / (4 * divisor));
        let exponent =
            along.exponent - square.exponent + self.offset.exponent - self.linear.exponent;
        Block::new(ratio, exponent)
    }
}

/// The unit vector along `v` (each below 2^32 in magnitude) in Q1.14, each within 2^-15, negative
/// ones within 2^-14; zero stays zero.
pub(super) fn unit(v: [i64; 3]) -> [I2F14; 3] {
    let (v, length) = with_length(v);
    if length == 0 {
        return [I2F14::ZERO; 3];
    }
    v.map(|c| I2F14::from_bits((((c << 15) / length + 1) >> 1) as i16))
}

/// `v` (each below 2^32 in magnitude) with 30 bits in its largest, and its length then.
fn with_length(v: [i64; 3]) -> ([i64; 3], i64) {
    let [x, y, z] = v;
    let bits = x.unsigned_abs() | y.unsigned_abs() | z.unsigned_abs();
    // 30 bits each: the sum of squares fits 62 bits, and the root has 30 of its own.
    let shift = bits.leading_zeros() as i32 - 34;
    let v = v.map(|c| shift_round_inline(c, shift));
    let square: i64 = v.iter().map(|c| c * c).sum();
    (v, square.unsigned_abs().isqrt() as i64)
}

/// The unit vector along `v` in Q1.30, 2^-28 off at most; `None` for zero.
fn unit_q30(v: [i64; 3]) -> Option<[i64; 3]> {
    let (v, length) = with_length(v);
    (length != 0).then(|| v.map(|c| ((c << 31).div_euclid(length) + 1) >> 1))
}

/// The scalar product of two vectors in Q1.30 of length up to 1.
fn dot_q30(a: [i64; 3], b: [i64; 3]) -> i64 {
    shift_round(a[0] * b[0] + a[1] * b[1] + a[2] * b[2], -30)
}

/// A matrix, row by row, times a vector.
#[inline(never)]
fn times(m: &[i32; 9], v: [i32; 3]) -> [i64; 3] {
    let wide = |i: usize, k: usize| i64::from(m[3 * i + k]) * i64::from(v[k]);
    [0, 1, 2].map(|i| wide(i, 0) + wide(i, 1) + wide(i, 2))
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

/// Sine and cosine on the unit circle to 1e-7 (the angle itself is 0.0012 rad off at most); those
/// of 0 where the angle is not finite.
///
/// micromath's polynomials give the point; a Newton step each puts it on the circle, so that a
/// rotation does not scale. Only IEEE basic operations, hence the same bits everywhere.
fn sin_cos(angle: f32) -> (f32, f32) {
    if !angle.is_finite() {
        return (0.0, 1.0);
    }
    let angle = if angle.abs() < WHOLE_TURNS {
        angle
    } else {
        remainder(angle)
    };
    let (s, c) = (F32Ext::sin(angle), F32Ext::cos(angle));
    let scale = inverse_sqrt(s * s + c * c);
    (s * scale, c * scale)
}

/// Angles from here on lose their whole turns before micromath sees them, which takes them off in
/// floats itself.
const WHOLE_TURNS: f32 = 64.0;

/// `1 / 2 pi` as a fraction of binary digits, behind 32 zeros.
const TURNS: [u32; 7] = [
    0,
    0x28BE_60DB,
    0x9391_054A,
    0x7F09_D5F4,
    0x7D4D_3770,
    0x36D8_A566,
    0x4F10_E410,
];

/// A finite angle of at least [`WHOLE_TURNS`] without its whole turns, -pi to pi, to 2^-23 of that.
///
/// The 24 bits of the angle are multiplied by those 64 digits of `1 / 2 pi` that lie below a whole
/// turn and above 2^-40 of one; what is above makes whole turns, and wraps.
fn remainder(angle: f32) -> f32 {
    let bits = angle.to_bits();
    // The angle is `mantissa 2^exponent`, the exponent -17 to 104.
    let mantissa = u64::from(bits & 0x7F_FFFF | 0x80_0000);
    let exponent = (bits >> 23 & 0xFF) as i32 - 150;
    let first = (exponent + 32) as u32;
    let word = |i: u32| u64::from(TURNS.get((first / 32 + i) as usize).copied().unwrap_or(0));
    let high = word(0) << 32 | word(1);
    let digits = match first % 32 {
        0 => high,
        up => high << up | word(2) >> (32 - up),
    };
    // Turns in 2^-64, modulo one turn; of the 32 bits above, the sign says which half.
    let turns = (mantissa.wrapping_mul(digits) >> 32) as i32;
    let turns = if angle < 0.0 {
        -(turns as f32)
    } else {
        turns as f32
    };
    turns * (core::f32::consts::TAU / (1u64 << 32) as f32)
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
    use crate::num::random::Rng;

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

    /// Against `f64`, which has the remainder of a turn of such angles from 1,100 bits of pi.
    #[test]
    fn rotations_by_any_angle_are_rotations() {
        let mut rng = Rng(11);
        let mut worst = 0f64;
        for i in 0..200_000 {
            let bits = if i % 2 == 0 {
                rng.bits()
            } else {
                // About 1 to 2^30.
                (rng.bits() & 0x80FF_FFFF) + ((120 + rng.bits() % 32) << 23)
            };
            let angle = f32::from_bits(bits);
            let turned = Affine::rotation_z(angle);
            if !angle.is_finite() {
                assert_eq!(turned, Affine::IDENTITY);
                continue;
            }
            let (c, s) = (value(&turned.linear, 0), value(&turned.linear, 3));
            assert!((c * c + s * s - 1.0).abs() < 1e-6, "{angle:e}");
            let (want_s, want_c) = f64::from(angle).sin_cos();
            let off = (s * want_c - c * want_s)
                .atan2(c * want_c + s * want_s)
                .abs();
            assert!(off < 0.0012, "{angle:e}: {off}");
            worst = worst.max(off);
        }
        std::println!("angles of any size: {worst:.5} rad off at most");
        for angle in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            assert_eq!(Affine::rotation_x(angle), Affine::IDENTITY);
            assert_eq!(Affine::rotation_y(angle), Affine::IDENTITY);
            assert_eq!(Affine::rotation_z(angle), Affine::IDENTITY);
        }
    }

    /// The linear part in f64, row by row.
    fn rows(map: &Affine) -> [[f64; 3]; 3] {
        [0, 1, 2].map(|i| [0, 1, 2].map(|k| value(&map.linear, 3 * i + k)))
    }

    fn product(a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
        [0, 1, 2].map(|i| [0, 1, 2].map(|k| (0..3).map(|j| a[i][j] * b[j][k]).sum()))
    }

    fn apart(a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]) -> f64 {
        let pairs = a.as_flattened().iter().zip(b.as_flattened());
        pairs.fold(0.0, |worst: f64, (a, b)| worst.max((a - b).abs()))
    }

    const IDENTITY: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

    /// How far the rows are from unit vectors at right angles.
    fn skew(m: &[[f64; 3]; 3]) -> f64 {
        let transposed = [0, 1, 2].map(|i| [0, 1, 2].map(|k| m[k][i]));
        apart(&product(m, &transposed), &IDENTITY)
    }

    fn determinant([a, b, c]: &[[f64; 3]; 3]) -> f64 {
        a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    }

    /// M3, a million turns of a thousandth of a radian, the same ones over and over, which is
    /// the worst case: errors of a step add up.
    ///
    /// Bounds. A product rounds each entry by 2^-30 at most, so after n steps a chain is within
    /// 3 n 2^-30 of the exact product of its own steps, times what these have grown to. A step's
    /// rows are 24-bit floats, scaled by a Newton root good to 2^-22: its skew is below 2^-20,
    /// and adds up to n 2^-20. With `orthonormalised` the skew is below 2^-26 at any time, and
    /// between two calls that are k steps apart below 2^-26 + k 2^-20.
    #[test]
    fn a_million_turns_drift_within_their_bounds() {
        const TURNS: u32 = 1_000_000;
        let turns = [
            Affine::rotation_y(0.001),
            Affine::rotation_x(-0.0007),
            Affine::rotation_z(0.0013),
        ];
        for turn in &turns {
            assert!(skew(&rows(turn)) < 2f64.powi(-20));
        }
        let cases: [&[Affine]; 2] = [&turns[..1], &turns];
        for steps in cases {
            let (mut plain, mut kept, mut seldom) = ([Affine::IDENTITY; 3]).into();
            let mut exact = IDENTITY;
            let (mut worst_kept, mut worst_seldom) = (0f64, 0f64);
            for (n, step) in (1..=TURNS).zip(steps.iter().cycle()) {
                plain = plain.then(step);
                exact = product(&rows(step), &exact);
                kept = kept.then(step).orthonormalised().unwrap();
                seldom = seldom.then(step);
                worst_kept = worst_kept.max(skew(&rows(&kept)));
                worst_seldom = worst_seldom.max(skew(&rows(&seldom)));
                if n % 100 == 0 {
                    seldom = seldom.orthonormalised().unwrap();
                }
            }
            let growth = determinant(&exact).abs().max(1.0);
            let error = apart(&rows(&plain), &exact);
            let drift = skew(&rows(&plain));
            std::println!(
                "{} kinds of turn: chain {error:.2e} from the product of its steps; skew without \
                 {drift:.2e}, determinant {:.6}; with, each step {worst_kept:.2e}, every 100 \
                 {worst_seldom:.2e}, determinant 1 {:+.1e}",
                steps.len(),
                determinant(&rows(&plain)),
                determinant(&rows(&kept)) - 1.0,
            );
            let turns = f64::from(TURNS);
            assert!(error <= 3.0 * turns * 2f64.powi(-30) * growth, "{error}");
            assert!(drift <= turns * 2f64.powi(-20), "{drift}");
            assert!(worst_kept <= 2f64.powi(-26), "{worst_kept}");
            assert!(worst_seldom <= 2f64.powi(-26) + 100.0 * 2f64.powi(-20));
            assert!((determinant(&rows(&kept)) - 1.0).abs() <= 2f64.powi(-25));
        }
    }

    /// Any map: the result keeps lengths and angles and its first row's direction, and mirrors
    /// where the map does; or the rows are too near to a line.
    #[test]
    fn any_map_can_be_made_orthonormal_unless_its_rows_are_parallel() {
        let mut rng = Rng(5);
        let mut made = 0;
        for i in 0..100_000 {
            let thin = [1.0, 1e-2, 1e-4, 1e-6][i % 4];
            let size = [1.0f32, 1e20, 1e-20][i / 4 % 3];
            let a = [(); 3].map(|()| rng.signed());
            let b = a.map(|c| c + thin * rng.signed());
            let c = [(); 3].map(|()| rng.signed());
            let map = Affine::from_rows([a, b, c].map(|r| r.map(|v| v * size)), [1.0, 2.0, 3.0]);
            let map = map.unwrap();
            let m = rows(&map);
            // The sine of the angle between the first two rows.
            let length = |v: [f64; 3]| v.iter().map(|c| c * c).sum::<f64>().sqrt();
            let [a, b] = [m[0], m[1]].map(|r| r.map(|c| c / length(r)));
            let across = [(1, 2), (2, 0), (0, 1)].map(|(i, k)| a[i] * b[k] - a[k] * b[i]);
            let Some(unit) = map.orthonormalised() else {
                assert!(length(across) < 2f64.powi(-19), "{map:?}");
                continue;
            };
            made += 1;
            let u = rows(&unit);
            assert!(skew(&u) <= 2f64.powi(-26), "{map:?}: {u:?}");
            assert_eq!(unit.offset, map.offset);
            let scaled = m.map(|r| r.map(|v| v / f64::from(size)));
            let d = determinant(&scaled);
            // Of a flat map the sign is a matter of rounding.
            assert!(
                d.abs() < 1e-6 || (d < 0.0) == (determinant(&u) < 0.0),
                "{d}"
            );
            for k in 0..3 {
                assert!((a[k] - u[0][k]).abs() < 2f64.powi(-27), "{map:?}");
            }
        }
        assert!(made > 70_000, "{made}");
        for rows in [[[0.0f32; 3]; 3], [[1.0, 0.0, 0.0]; 3]] {
            let map = Affine::from_rows(rows, [0.0; 3]).unwrap();
            assert_eq!(map.orthonormalised(), None);
        }
    }

    /// M3: matrices at the ends of their range. A chain of n maps errs by at most 3 n 2^-30 of
    /// the product of their norms (largest row sums), whatever their magnitudes.
    #[test]
    fn chains_of_any_magnitude_keep_their_bound() {
        let mut rng = Rng(9);
        for _ in 0..20_000 {
            let mut chain = Affine::IDENTITY;
            let (mut exact, mut norm) = (IDENTITY, 1.0);
            for n in 1..=8 {
                let power = f64::from(rng.bits() % 180) - 85.0;
                let map =
                    [(); 3].map(|()| [(); 3].map(|()| rng.signed() * 2f64.powf(power) as f32));
                let offset = [(); 3].map(|()| rng.signed());
                let map = Affine::from_rows(map, offset).unwrap();
                chain = chain.then(&map);
                let m = rows(&map);
                exact = product(&m, &exact);
                let sums = m.map(|r| r.iter().map(|v| v.abs()).sum::<f64>());
                norm *= sums.into_iter().fold(0.0, f64::max);
                let error = apart(&rows(&chain), &exact) / norm;
                assert!(error <= 3.0 * f64::from(n) * 2f64.powi(-30), "{n}: {error}");
            }
        }
    }

    /// Exponents stop where nothing can be seen any more, and never overflow.
    #[test]
    fn maps_may_be_squared_for_ever() {
        for scale in [2f32.powi(90), 2f32.powi(-85), 0.0, -1.0] {
            let mut map = Affine::placed(scale, [1e28, -1e28, 1e-25]).unwrap();
            for _ in 0..100 {
                map = map.then(&map);
            }
            let _ = map.orthonormalised();
        }
    }

    /// What is not finite is refused, and so is nothing else up to 2^96.
    #[test]
    fn any_floats_are_a_map_or_refused() {
        let mut rng = Rng(3);
        let mut refused = 0;
        for i in 0..500_000 {
            let mut v = [0f32; 12];
            for v in &mut v {
                *v = rng.signed();
            }
            let bits = match i % 5 {
                0 => 0x7F80_0000 | rng.bits() & 0x807F_FFFF,
                1 => rng.bits() & 0x807F_FFFF,
                2 => 0x7F80_0000,
                _ => rng.bits(),
            };
            let odd = f32::from_bits(bits);
            v[rng.bits() as usize % 12] = odd;
            let map = Affine::from_rows(
                [[v[0], v[1], v[2]], [v[3], v[4], v[5]], [v[6], v[7], v[8]]],
                [v[9], v[10], v[11]],
            );
            assert_eq!(map.is_some(), odd.abs() < 2f32.powi(96), "{odd:e}");
            refused += u32::from(map.is_none());
            if let Some(map) = map {
                let _ = map.then(&map).then(&map).orthonormalised();
            }
        }
        assert!(refused > 200_000, "{refused}");
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
