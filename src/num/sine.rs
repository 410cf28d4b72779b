//! Sine and cosine of any angle, in integers (S4).
//!
//! The 24 bits of an angle are multiplied by those digits of `1 / 2 pi` that lie below a whole turn, so that an angle of any
//! size is as exact as a small one. What is left of a turn beside its nearest quarter goes through two polynomials, each the
//! interpolation at Chebyshev's nodes.

use super::product::mul_high_unsigned;

/// `1 / 2 pi` in binary digits, behind 64 zeros.
const TURNS: [u32; 8] = [
    0, 0, 0x28BE60DB, 0x9391054A, 0x7F09D5F4, 0x7D4D3770, 0x36D8A566, 0x4F10E410,
];

/// `sin(x) / x` by `x^2`, in 2^-32, `x` an eighth of a turn at most and taken for 1; signs alternate. The highest power first.
const SINE: [u32; 5] = [1_327, 157_077, 10_696_157, 346_799_333, 3_373_259_426];

/// `(1 - cos(x)) / x^2`, likewise.
const COSINE: [u32; 4] = [15_213, 1_399_994, 68_093_864, 1_324_675_878];

/// Sine and cosine of an angle in radians, in units of 2^-29 and 1.1 of them off at most; those of 0 where it is not
/// finite.
pub fn sin_cos(angle: f32) -> [i32; 2] {
    let is_finite = angle.to_bits() << 1 < f32::INFINITY.to_bits() << 1;
    of_turns(if is_finite { turns(angle) } else { 0 })
}

/// The same of turns in 2^-32.
fn of_turns(turns: u32) -> [i32; 2] {
    let rest = (turns << 2) as i32;
    let eighth = rest.unsigned_abs();
    let square = mul_high_unsigned(eighth, eighth).min((1 << 30) - 1) << 2;
    let sine = (mul_high_unsigned(eighth, series(&SINE, square)) as i32 + 2) >> 2;
    let cosine = (1 << 29) - ((mul_high_unsigned(square, series(&COSINE, square)) as i32 + 4) >> 3);
    let sine = if rest < 0 { -sine } else { sine };
    match turns.wrapping_add(1 << 29) >> 30 {
        0 => [sine, cosine],
        1 => [cosine, -sine],
        2 => [-sine, -cosine],
        _ => [-cosine, sine],
    }
}

/// Turns of a finite angle, in 2^-32 and without whole ones, to nearest.
fn turns(angle: f32) -> u32 {
    let bits = angle.to_bits();
    // The angle is `mantissa 2^(first - 64)`; where that is no turn, the first digits are zeros.
    let (mantissa, exponent) = (bits & 0x7F_FFFF | 0x80_0000, bits >> 23 & 0xFF);
    let first = exponent.saturating_sub(150 - 64);
    let digits = |i: u32| {
        let word = |i: u32| TURNS.get(i as usize).copied().unwrap_or(0);
        let at = first / 32 + i;
        word(at) << (first & 31) | word(at + 1) >> 1 >> (!first & 31)
    };
    let low = (u64::from(mantissa) * u64::from(digits(1)) + (1 << 31)) >> 32;
    let turns = mantissa.wrapping_mul(digits(0)).wrapping_add(low as u32);
    let sign = (bits as i32 >> 31) as u32;
    (turns ^ sign).wrapping_sub(sign)
}

/// A polynomial whose signs alternate.
#[inline(never)]
fn series(terms: &[u32], x: u32) -> u32 {
    let next = |sum, term: &u32| term - mul_high_unsigned(sum, x);
    terms.iter().fold(0, next)
}

#[cfg(test)]
mod tests {
    use super::{of_turns, sin_cos};
    use crate::num::random::Rng;

    /// How many units of 2^-29 a sine and a cosine are off those of an angle.
    fn off([sine, cosine]: [i32; 2], angle: f64) -> f64 {
        let off = |got: i32, exact: f64| (f64::from(got) - exact * f64::from(1 << 29)).abs();
        off(sine, angle.sin()).max(off(cosine, angle.cos()))
    }

    /// Kills: digits of `1 / 2 pi` that are others, from another place or fewer, a quarter that is another, terms that are
    /// another by some units, a sign.
    #[test]
    fn angles_of_all_sizes_are_a_unit_off_at_most() {
        let mut rng = Rng(51);
        let mut most = 0f64;
        for i in 0..400_000u32 {
            // All exponents, and every place in a turn.
            let any = f32::from_bits(rng.below(u32::MAX));
            let small = (rng.below(1 << 24) as f32 / (1 << 20) as f32 - 8.0) / (1 + i % 3) as f32;
            for angle in [any, small, i as f32 * core::f32::consts::FRAC_PI_8] {
                if angle.is_finite() {
                    let off = off(sin_cos(angle), angle.into());
                    assert!(off < 1.1, "{angle:e}: {off}");
                    most = most.max(off);
                }
            }
        }
        std::println!("{most} units of 2^-29");
    }

    /// Kills: an eighth of a turn whose square is taken for 0, another quarter.
    #[test]
    fn parts_of_a_turn_are_a_unit_off_at_most() {
        for eighth in 0..8u32 {
            for beside in (0..1 << 29).step_by(4_093).chain([1, (1 << 29) - 1]) {
                let turns = (eighth << 29) + beside;
                let angle = f64::from(turns) / 4_294_967_296.0 * core::f64::consts::TAU;
                let off = off(of_turns(turns), angle);
                assert!(off < 0.8, "{turns:#x}: {off}");
            }
        }
    }

    #[test]
    fn no_angle_is_exact() {
        for angle in [
            0.0,
            -0.0,
            f32::MIN_POSITIVE,
            f32::NAN,
            f32::INFINITY,
            f32::NEG_INFINITY,
        ] {
            assert_eq!(sin_cos(angle), [0, 1 << 29], "{angle}");
        }
    }
}
