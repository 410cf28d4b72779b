//! Quotients and roots of 64 bits for what is done once a draw call or for few triangles: small, not fast.
//!
//! The division of 64 bits that a compiler brings takes 1 KB of code, and core's root of as many another.

use super::leading_zeros;
use core::hint::black_box;

/// `number / by`, rounded down; all ones where that has more than 32 bits.
///
/// Two digits of 16 bits, each by a division of 32 and at most two corrections.
#[inline(never)]
#[must_use]
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
        let mut digit = rest / head;
        let mut over = rest - digit * head;
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

/// [`divide`] of a number with a sign, rounded towards 0.
#[must_use]
pub fn divide_signed(number: i64, by: u32) -> i64 {
    let quotient = i64::from(divide(number.unsigned_abs(), by));
    if number < 0 { -quotient } else { quotient }
}

/// The root of a square, rounded down.
#[inline(never)]
#[must_use]
pub fn root(square: u64) -> u32 {
    if square == 0 {
        return 0;
    }
    // The upper word has its leading bit in one of the first two places, after an even shift.
    let high = (square >> 32) as u32;
    let zeros = if high == 0 {
        32 + leading_zeros(square as u32)
    } else {
        leading_zeros(high)
    };
    let up = zeros & !1;
    let square = square << up;
    // The upper word's root, bit by bit; what is left is at most twice that. Not straight code: the loop's length is
    // not known.
    let (mut left, mut head, mut bit) = ((square >> 32) as u32, 0u32, black_box(1u32 << 30));
    while bit != 0 {
        let tried = head + bit;
        head >>= 1;
        if left >= tried {
            left -= tried;
            head += bit;
        }
        bit >>= 2;
    }
    // 16 bits more by one division, at most one too large.
    let next = (square as u32) >> 17;
    let root = (head << 16).saturating_add((left << 15 | next) / head.max(1));
    let is_beyond = u64::from(root) * u64::from(root) > square;
    (root - u32::from(is_beyond)) >> (up / 2)
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

    #[test]
    fn roots_are_rounded_down() {
        let mut rng = Rng(52);
        let hold = |square: u64| assert_eq!(u64::from(root(square)), square.isqrt(), "{square}");
        for square in [0, 1, 2, 3, 4, u64::MAX, u64::MAX - 1, 1 << 62, 1 << 63] {
            hold(square);
        }
        for _ in 0..200_000 {
            let whole = u64::from(word(&mut rng));
            let square = whole * whole;
            // About the steps, and in between.
            hold(square);
            hold(square.saturating_sub(1));
            hold(square.saturating_add(2 * whole));
            hold(u64::from(word(&mut rng)) << 32 | u64::from(word(&mut rng)));
        }
    }
}
