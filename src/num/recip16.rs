//! Reciprocals of 16 bits, by one Newton step where there is no divider (H4), and the short products around them, the
//! same bits on every target.
//!
//! | what | Cortex-M4 | Cortex-M0+ |
//! |---|---|---|
//! | [`recip_16`] | one division | a table of 512 bytes, one Newton step, one correction |
//! | [`of_height`] | a table of 2 KB | the same |
//! | [`mul_recip_16`] | one multiply-add | two products |
//! | [`mul_17`] | one long product | two products |
//! | [`slope_of`] | one long product | two products |

use super::product::mul_high;
use super::short::SHORT;

/// `2^31 / d` for the middle of each 128 of `d` in 2^15 ..< 2^16, rounded.
static SEEDS: [u16; 256] = {
    let mut seeds = [0; 256];
    let mut i = 0;
    while i < 256 {
        let d = (i as u32 + 256) * 128 + 64;
        seeds[i] = (((1u32 << 31) + d / 2) / d) as u16;
        i += 1;
    }
    seeds
};

/// `floor((2^31 - 1) / n)` for `n` in 2^15 ..< 2^16; anything for other numbers.
#[inline(always)]
pub fn recip_16(n: u32) -> u32 {
    if SHORT {
        by_seed(n)
    } else {
        // The bit is there: said again, it spares the question whether this is 0.
        0x7FFF_FFFF / (n | 1 << 15)
    }
}

/// [`recip_16`] without a division.
#[inline(always)]
fn by_seed(n: u32) -> u32 {
    let seed = u32::from(SEEDS[(n >> 7) as usize & 255]);
    // The seed is 2^-9 of itself off, the step leaves one unit at most, below: all 2^15 were tried.
    let miss = (1u32 << 31).wrapping_sub(n.wrapping_mul(seed)) as i32;
    let step = (seed as i32).wrapping_mul(miss >> 8) >> 23;
    let near = seed.wrapping_add(step as u32);
    let rest = 0x7FFF_FFFFu32.wrapping_sub(n.wrapping_mul(near));
    if rest < n { near } else { near.wrapping_add(1) }
}

/// The most units of height that [`of_height`] knows.
pub const HEIGHTS: u32 = 511;

/// `floor((2^31 - 1) / height)` for a height of 1 to [`HEIGHTS`]; 0 for 0.
#[inline(always)]
pub fn of_height(height: u32) -> u32 {
    static RECIPROCAL: [u32; HEIGHTS as usize + 1] = {
        let mut table = [0; HEIGHTS as usize + 1];
        let mut i = 1;
        while i < table.len() {
            table[i] = 0x7FFF_FFFF / i as u32;
            i += 1;
        }
        table
    };
    RECIPROCAL[(height & HEIGHTS) as usize]
}

/// `floor(a b / 2^16)` modulo 2^32, for a reciprocal `b` of 2^15 ..< 2^16.
#[inline(always)]
pub const fn mul_recip_16(a: i32, b: u32) -> i32 {
    if SHORT {
        mul_16_in_pieces(a, b)
    } else {
        // As a number with a sign it is 2^16 less.
        a.wrapping_add(((a as i64 * b as i16 as i64) >> 16) as i32)
    }
}

/// [`mul_recip_16`] without a long product.
#[inline(always)]
const fn mul_16_in_pieces(a: i32, b: u32) -> i32 {
    let low = (a as u32 & 0xFFFF).wrapping_mul(b) >> 16;
    (a >> 16).wrapping_mul(b as i32).wrapping_add(low as i32)
}

/// `floor(a b / 2^17)`, `b` of 16 bits without a sign.
#[inline(always)]
pub const fn mul_17(a: i32, b: u32) -> i32 {
    if SHORT {
        mul_17_in_pieces(a, b)
    } else {
        mul_high(a, (b << 15) as i32)
    }
}

/// [`mul_17`] without a long product.
#[inline(always)]
const fn mul_17_in_pieces(a: i32, b: u32) -> i32 {
    mul_16_in_pieces(a, b) >> 1
}

/// `round(dx r / 2^12)` for `dx` of 10 bits and a sign, and `r` below 2^31.
#[inline(always)]
pub const fn slope_of(dx: i32, r: u32) -> i32 {
    if SHORT {
        slope_in_pieces(dx, r)
    } else {
        (((dx << 20) as i64 * r as i32 as i64 + 0x8000_0000) >> 32) as i32
    }
}

/// [`slope_of`] without a long product.
#[inline(always)]
const fn slope_in_pieces(dx: i32, r: u32) -> i32 {
    let (high, low) = ((r >> 12) as i32, (r & 0xFFF) as i32);
    dx.wrapping_mul(high)
        .wrapping_add(dx.wrapping_mul(low).wrapping_add(1 << 11) >> 12)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::random::Rng;

    #[test]
    fn all_reciprocals_are_floors_with_and_without_a_division() {
        for n in 1u32 << 15..1 << 16 {
            assert_eq!(by_seed(n), 0x7FFF_FFFF / n, "{n}");
            assert_eq!(recip_16(n), 0x7FFF_FFFF / n);
        }
        assert_eq!(of_height(0), 0);
        for height in 1..=HEIGHTS {
            assert_eq!(of_height(height), 0x7FFF_FFFF / height);
        }
    }

    #[test]
    fn pieces_give_the_bits_of_long_products() {
        let mut rng = Rng(11);
        for _ in 0..200_000 {
            let (a, b) = (rng.below(u32::MAX) as i32, rng.below(1 << 16));
            let exact = i64::from(a) * i64::from(b);
            assert_eq!(mul_16_in_pieces(a, b), (exact >> 16) as i32, "{a} {b}");
            let r = b | 1 << 15;
            assert_eq!(mul_recip_16(a, r), mul_16_in_pieces(a, r), "{a} {r}");
            for product in [mul_17(a, b), mul_17_in_pieces(a, b)] {
                assert_eq!(i64::from(product), exact >> 17, "{a} {b}");
            }
            let (dx, r) = (rng.below(2047) as i32 - 1023, rng.below(1 << 31));
            let exact = (i64::from(dx) * i64::from(r) + (1 << 11)) >> 12;
            for slope in [slope_of(dx, r), slope_in_pieces(dx, r)] {
                assert_eq!(i64::from(slope), exact, "{dx} {r}");
            }
        }
    }
}
