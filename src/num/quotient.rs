//! Quotients of 64 bits for what is done once a draw call or for few triangles: small, not fast; and those of triangles'
//! sides, of 32 bits. Processors without a divider find both by [`short`].
//!
//! The division of 64 bits that a compiler brings takes 1 KB of code.

use super::short::SHORT;
use super::{leading_zeros, short};
use core::hint::black_box;

/// `number / by`, rounded down; all ones where that has more than 32 bits.
///
/// Two digits of 16 bits, each by a division of 32 and at most two corrections.
#[inline(never)]
pub fn divide(number: u64, by: u32) -> u32 {
    if (number >> 32) as u32 >= by {
        return u32::MAX;
    }
    let up = leading_zeros(by) & 31;
    let (by, number) = (by << up, number << up);
    // Its leading bit is set: never 0.
    let (head, tail) = ((by >> 16).max(1), by & 0xFFFF);
    let (mut rest, mut low) = ((number >> 32) as u32, number as u32);
    let mut quotient = 0;
    for _ in 0..black_box(2) {
        let next = low >> 16;
        let (mut digit, mut over) = with_rest(rest, head);
        // Too large by 2 at most.
        while over >> 16 == 0 && (digit >> 16 != 0 || digit * tail > (over << 16 | next)) {
            digit = black_box(digit) - 1;
            over += head;
        }
        rest = (rest << 16 | next).wrapping_sub(digit.wrapping_mul(by));
        low <<= 16;
        quotient = quotient << 16 | digit;
    }
    quotient
}

/// `number / by` and what is left, for `by` of 2^15 to 2^16 - 1.
#[inline(always)]
fn with_rest(number: u32, by: u32) -> (u32, u32) {
    if SHORT {
        return short::divide_called(number, by);
    }
    (number / by, number % by)
}

/// [`divide`] of a number with a sign, rounded towards 0.
pub fn divide_signed(number: i64, by: u32) -> i64 {
    let quotient = i64::from(divide(number.unsigned_abs(), by));
    if number < 0 { -quotient } else { quotient }
}

/// `n / by` rounded down, for `by` of 1 to 2^15 - 1, where that has 16 bits with its sign.
#[inline(always)]
pub fn quotient_16(n: i32, by: i32) -> i32 {
    if SHORT {
        short::floor(n, by as u32).0
    } else {
        n.div_euclid(by)
    }
}

/// `dx / height` rounded down, and what is left of it in 2^-22, to nearest: of `dx` with 16 bits and a sign and a height
/// of 1 to 2,047, or of 0 and a height of up to 16 bits.
#[inline(always)]
pub fn slope_and_rest(dx: i32, height: i32) -> (i32, i32) {
    if SHORT {
        return short::slope_and_rest(dx, height as u32);
    }
    let whole = dx.div_euclid(height);
    // Of 11 bits of a rest one has no room more than 21 bits farther up: the last bit, and what is rounded, follow.
    let (rest, height) = (((dx - whole * height) as u32) << 21, height as u32);
    let (part, rest) = (rest / height, rest % height);
    let nearest = (4 * rest + height) / (2 * height);
    (whole, (2 * part + nearest) as i32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::random::Rng;

    fn word(rng: &mut Rng) -> u32 {
        let word = rng.below(1 << 16) << 16 | rng.below(1 << 16);
        word >> rng.below(32)
    }

    #[test]
    fn quotients_are_those_of_a_wide_division() {
        let mut rng = Rng(51);
        let mut whole = 0;
        for i in 0..400_000 {
            let by = [
                word(&mut rng),
                u32::MAX - rng.below(9),
                0x8000_0000 | rng.below(9),
            ][i % 3];
            let head = [word(&mut rng), by.wrapping_sub(1 + rng.below(3))][i / 3 % 2];
            let low = [word(&mut rng), u32::MAX][i / 6 % 2];
            let number = u64::from(head) << 32 | u64::from(low);
            let want = number.checked_div(by.into()).unwrap_or(u64::MAX);
            let want = u32::try_from(want).unwrap_or(u32::MAX);
            assert_eq!(divide(number, by), want, "{number} {by}");
            // Of half of it, which has room for a sign.
            if want != u32::MAX {
                let half = (number >> 1) as i64;
                assert_eq!(divide_signed(half, by), half / i64::from(by));
                assert_eq!(divide_signed(-half, by), -half / i64::from(by));
            }
            whole += u32::from(want != u32::MAX);
        }
        assert!(whole > 100_000, "{whole}");
    }
}
