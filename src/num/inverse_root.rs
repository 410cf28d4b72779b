//! One over a square root, for vectors that are to be unit length (K10).
//!
//! A table of 256 bytes gives 7 bits, and two Newton steps of two products each double them twice:
//! no division and no loop, the same for all values.

use super::product::{few_leading_zeros, mul_high_unsigned};

/// `2^15 / sqrt(x)` for the upper byte of a normalised number, from 0x40 on, to nearest; nothing below, so that any
/// byte has a place.
static SEEDS: [u8; 256] = {
    let mut seeds = [0; 256];
    let mut i = 64;
    while i < 256 {
        // In the middle of what has this byte: sqrt((2 i + 1) / 512) is in 1/2 ..< 1.
        let root = ((2 * i as u64 + 1) << 39).isqrt();
        // 2^7 / sqrt, 2^7 ..= 2^8: the upper end is kept below.
        let seed = ((1u64 << 31) + root / 2) / root;
        seeds[i] = if seed > 255 { 255 } else { seed as u8 };
        i += 1;
    }
    seeds
};

/// One over the square root of a positive number, as a mantissa and a power of two:
/// `1 / sqrt(x) = mantissa 2^(half - 46)`, the mantissa in `2^30 ..= 2^31` and `half` in 0..=15.
///
/// Its relative error is below 2^-27. For 0 it is that of 1.
#[inline]
pub fn inverse_root(x: u32) -> (u32, u32) {
    let x = if x == 0 { 1 } else { x };
    let up = few_leading_zeros(x) & 0x1E;
    let x = x << up;
    // X = x / 2^32 in 1/4 ..< 1, and y = 2^30 / sqrt(X).
    let mut y = (SEEDS[(x >> 24) as usize] as u32) << 23;
    for _ in 0..2 {
        // y (3 - X y^2) / 2
        let square = mul_high_unsigned(y, y);
        let off = (3 << 28) - mul_high_unsigned(x, square);
        y = mul_high_unsigned(y, off) << 3 | y.wrapping_mul(off) >> 29;
    }
    (y, up / 2)
}

#[cfg(test)]
mod tests {
    use super::inverse_root;

    fn error(x: u32) -> f64 {
        let (mantissa, half) = inverse_root(x);
        let got = f64::from(mantissa) * (f64::from(half) - 46.0).exp2();
        got * f64::from(x).sqrt() - 1.0
    }

    #[test]
    fn stays_within_its_bound() {
        let mut worst = 0.0f64;
        // All seeds with 4,096 values each, and all small numbers.
        for i in 0..(192u32 << 12) {
            worst = worst.max(error((1 << 30) + (i << 12) + (i & 0xFFF)).abs());
        }
        for x in 1..100_000 {
            worst = worst.max(error(x).abs());
            worst = worst.max(error(u32::MAX - x).abs());
        }
        std::println!("relative error {worst:.2e}");
        assert!(worst < 2f64.powi(-27));
        assert_eq!(inverse_root(0), inverse_root(1));
    }
}
