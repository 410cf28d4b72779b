//! A reciprocal from one 32-bit divide and one Newton step.
//!
//! 64-bit division is a library call of some hundred instructions on every Cortex-M; this is
//! one `UDIV` and two widening products, and only 32-bit results are kept.

use super::product::mul_high;
use super::short::{self, SHORT};

/// `2^62 / a` for a normalised `a` (top bit set), in `2^30 ..= 2^31`.
///
/// The result is never above the true quotient by more than one unit and never below it by more
/// than four: a relative error of at most 2^-28.
#[inline]
pub const fn recip(a: u32) -> u32 {
    if SHORT {
        let (seed, rest) = short::divide(0xFFFF_FFFF, a >> 16);
        return short::newton(a, seed, rest);
    }
    // 2^48 / a to 16 bits: relative error within -2^-16 and +2^-15.
    let seed = 0xFFFF_FFFF / (a >> 16 | 1 << 15);
    // Within 2^33, so that an eighth of it has 32 bits.
    let miss = (1i64 << 48) - (a as u64 * seed as u64) as i64;
    // One Newton step: seed (1 + miss / 2^48), in 2^62 / a; the neglected square is 2^-30.
    let step = mul_high((seed << 1) as i32, (miss >> 3) as i32);
    (seed << 14).wrapping_add(step as u32)
}

#[cfg(test)]
mod tests {
    use super::{recip, short};
    use crate::num::random::Rng;

    #[test]
    fn short_products_give_the_same() {
        let mut rng = Rng(45);
        let some = (0..400_000).map(|_| 1 << 31 | rng.below(1 << 31));
        let uppers = (1u32 << 15..1 << 16).flat_map(|u| [u << 16, u << 16 | 0xFFFF]);
        for a in some.chain(uppers) {
            let (seed, rest) = short::divide(0xFFFF_FFFF, a >> 16);
            assert_eq!(short::newton(a, seed, rest), recip(a), "{a:#x}");
        }
    }

    #[test]
    fn stays_within_its_bound() {
        let mut a = 1u64 << 31;
        while a < 1 << 32 {
            for a in [a, a + 0xFFFF, a + 0x7FFF, (1 << 32) - 1] {
                let a = a.min((1 << 32) - 1);
                let exact = ((1u64 << 62) / a) as i64;
                let error = i64::from(recip(a as u32)) - exact;
                assert!((-4..=1).contains(&error), "a = {a:#x}: {error}");
            }
            a += 0x1_0000;
        }
    }
}
