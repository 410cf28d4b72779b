//! Block fixed point: some mantissas that share one exponent.
//!
//! Matrices and planes of a camera span many magnitudes; a shared power of two keeps every
//! product exact in 64 bits and needs no float.
//!
//! This is set-up, so its size counts: loops are kept rolled.

/// `N` numbers `mantissa[i] 2^(exponent - 30)`.
///
/// Normalised: the largest magnitude among the mantissas is in `2^29 ..< 2^30`, or all are 0.
/// Exponents stop at [`MOST`], far beyond what a chain of maps that is of any use can reach.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Block<const N: usize> {
    /// The mantissas, each below 2^30 in magnitude.
    pub mantissa: [i32; N],
    /// The common exponent.
    pub exponent: i32,
}

/// The largest exponent in magnitude: sums of a few of them cannot overflow.
const MOST: i32 = 1 << 24;

impl<const N: usize> Block<N> {
    /// All zero.
    pub const ZERO: Self = Self {
        mantissa: [0; N],
        exponent: -128,
    };

    /// Normalises `value[i] 2^(exponent - 30)`, rounding to nearest.
    pub fn new(value: [i64; N], exponent: i32) -> Self {
        let mut mantissa = [0; N];
        let shift = normalise(&value, &mut mantissa);
        shift.map_or(Self::ZERO, |shift| Self {
            mantissa,
            exponent: (exponent - shift).clamp(-MOST, MOST),
        })
    }

    /// Converts floats; `None` when one is not finite or beyond 2^96 in magnitude.
    pub fn from_f32(value: [f32; N]) -> Option<Self> {
        let mut mantissa = [0; N];
        let exponent = mantissas(&value, &mut mantissa);
        let made = Self { mantissa, exponent };
        (exponent <= 96).then_some(if exponent < LEAST { Self::ZERO } else { made })
    }

    /// Floats times a power of two, the largest below 2^30; `None` when one is not finite, or all are 0.
    pub fn direction(value: [f32; N]) -> Option<[i32; N]> {
        let mut mantissa = [0; N];
        let exponent = mantissas(&value, &mut mantissa);
        (exponent <= 128 && mantissa.iter().any(|m| *m != 0)).then_some(mantissa)
    }

    /// Whether all are 0.
    #[inline(always)]
    pub fn is_zero(&self) -> bool {
        self.mantissa.iter().fold(0, |bits, m| bits | m) == 0
    }

    /// The number at `i` times 2^`shift`, rounded to an integer.
    pub fn scaled(&self, i: usize, shift: i32) -> i64 {
        shift_round(i64::from(self.mantissa[i]), self.exponent - 30 + shift)
    }

    /// How many bits the integer part of the sum of all magnitudes needs at most.
    pub fn magnitude_bits(&self) -> i32 {
        let sum: u64 = self
            .mantissa
            .iter()
            .map(|m| u64::from(m.unsigned_abs()))
            .sum();
        64 - sum.leading_zeros() as i32 + self.exponent - 30
    }
}

/// Shifts all values so that they are normalised, and says by how much; `None` when all are 0.
///
/// One piece of code for blocks of all lengths: it is set-up, so its size counts.
#[inline(never)]
fn normalise(value: &[i64], mantissa: &mut [i32]) -> Option<i32> {
    let mut bits = 0u64;
    for v in value {
        super::rolled();
        bits |= v.unsigned_abs();
    }
    if bits == 0 {
        return None;
    }
    let mut shift = 30 - (64 - bits.leading_zeros() as i32);
    // Rounding may carry into one bit more.
    if shift_all(value, shift, mantissa) >> 30 != 0 {
        shift -= 1;
        shift_all(value, shift, mantissa);
    }
    Some(shift)
}

/// [`shift_round`] of all values, which fit then; says which bits their magnitudes have.
#[inline(never)]
fn shift_all(value: &[i64], shift: i32, mantissa: &mut [i32]) -> u32 {
    let mut bits = 0;
    // With a bit more below, by which it is rounded. To the right it is by 33 at most, and what is left has 32 bits: a
    // shift needs no more than two registers.
    let (up, down) = ((shift + 1).max(0), (-shift - 1).max(0));
    for (m, &v) in mantissa.iter_mut().zip(value) {
        super::rolled();
        let v = if down >= 32 { v >> 32 } else { v };
        let twice = ((v >> (down & 31)) as i32) << up;
        *m = (twice >> 1) + (twice & 1);
        bits |= m.unsigned_abs();
    }
    bits
}

/// Floats below this power of two are 0.
const LEAST: i32 = -90;

/// Floats as mantissas with a common exponent, which is returned: the largest has a leading bit, so they are normalised as
/// they are. No float is reckoned with: few processors have them, and all have the same bits.
#[inline(never)]
fn mantissas(value: &[f32], mantissa: &mut [i32]) -> i32 {
    let mut largest = 1;
    for v in value {
        super::rolled();
        largest = largest.max(v.to_bits() << 1 >> 24);
        if largest == 0xFF {
            break;
        }
    }
    for (m, v) in mantissa.iter_mut().zip(value) {
        super::rolled();
        let bits = v.to_bits();
        let exponent = bits >> 23 & 0xFF;
        // The smallest have no leading bit.
        let leading = exponent.min(1) << 23;
        let down = (largest - exponent.max(1)).min(31);
        let magnitude = ((bits & 0x7F_FFFF | leading) << 6 >> down) as i32;
        let sign = bits as i32 >> 31;
        *m = (magnitude ^ sign) - sign;
    }
    largest as i32 - 126
}

/// `value 2^shift`, rounded to nearest (half up) where it shifts right.
///
/// Shifts left saturate, so a number that does not fit keeps its sign. Out of line, for set-up:
/// shifts of 64 bits by a variable take a dozen instructions each.
#[inline(never)]
pub const fn shift_round(value: i64, shift: i32) -> i64 {
    if shift >= 0 {
        if value == 0 {
            0
        } else if shift >= 63 || value.unsigned_abs() > (i64::MAX as u64) >> shift {
            if value < 0 { i64::MIN } else { i64::MAX }
        } else {
            value << shift
        }
    } else if shift < -63 {
        0
    } else {
        // The half is added after the first part of the shift, so that it cannot overflow.
        ((value >> (-shift - 1)) + 1) >> 1
    }
}

/// `value 2^-shift`, rounded to nearest, half up; a shift is by 31 at most.
#[inline(always)]
pub const fn rounded(value: i32, shift: i32) -> i32 {
    // The bit below is that of twice the value.
    (value >> (shift & 31)) + ((value << 1) >> (shift & 31) & 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floats_come_in_exactly() {
        let b = Block::from_f32([1.0, -0.375, 1000.0]).unwrap();
        for (i, v) in [1.0f64, -0.375, 1000.0].into_iter().enumerate() {
            let got = f64::from(b.mantissa[i]) * 2f64.powi(b.exponent - 30);
            assert_eq!(got, v);
        }
        assert!(b.mantissa[2] >= 1 << 29 && b.mantissa[2] < 1 << 30);
        assert_eq!(Block::from_f32([f32::NAN]), None);
        assert_eq!(Block::from_f32([f32::INFINITY]), None);
        assert_eq!(Block::from_f32([0.0, -0.0]), Some(Block::ZERO));
    }

    #[test]
    fn shifts_round_and_saturate() {
        assert_eq!(shift_round(5, -1), 3);
        assert_eq!(shift_round(-5, -1), -2);
        assert_eq!(shift_round(3, 2), 12);
        assert_eq!(shift_round(i64::MAX, -62), 2);
        assert_eq!(shift_round(-3, 70), i64::MIN);
        assert_eq!(shift_round(3, -70), 0);
        // Kills: a shift that is taken for one beyond all bits, and one that is not.
        assert_eq!(shift_round(i64::MAX, -63), 1);
        assert_eq!([i64::MAX, i64::MIN].map(|v| shift_round(v, -64)), [0; 2]);
        // Kills: a shift of none or of all, and a bit that is not the next one below.
        for value in [0, 1, -1, 6, 7, -6, -7, i32::MAX, i32::MIN, 0x5555_5555] {
            for shift in 0..=31 {
                let want = shift_round(value.into(), -shift) as i32;
                assert_eq!(rounded(value, shift), want, "{value} {shift}");
            }
        }
        let b = Block::new([i64::MAX, -1], 0);
        assert_eq!(b.mantissa, [1 << 29, 0]);
        let b = Block::new([(1 << 30) - 1], 0);
        assert!(b.mantissa[0] < 1 << 30);
        // Kills: each way of shifting by another count, and rounding of what has 31 bits.
        for places in 30..=62 {
            let (most, least) = ((1i64 << places) - 1, -(1i64 << places));
            let half = 1i64 << (places - 30) >> 1;
            for v in [most, least, most / 3, least / 7] {
                let b = Block::new([v, (1 << places) - half], 0);
                let all =
                    [v, (1 << places) - half].map(|v| shift_round(v, b.exponent.wrapping_neg()));
                assert_eq!(b.mantissa.map(i64::from), all, "{v} of {places}");
            }
        }
    }
}
