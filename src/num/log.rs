//! Logarithms to the base of 2, for ratios that need not be exact (H6).

/// The logarithm of a number above 0, 8 fraction bits, within 3 of 2^-8.
pub fn log2(x: u64) -> i32 {
    let whole = 63 - x.leading_zeros() as i32;
    let part = ((x << x.leading_zeros() >> 55) & 0xFF) as i32;
    // log2(1 + f) is above f by about 0.344 f (1 - f).
    (whole << 8) + part + ((part * (256 - part) * 88) >> 16)
}

/// 2 to the power of a number with 8 fraction bits; 0 below 2^0, the largest above 2^32.
pub fn exp2(log: i32) -> u32 {
    if log < 0 {
        return 0;
    }
    let part = log & 0xFF;
    let part = (256 + part - ((part * (256 - part) * 88) >> 16)) as u64;
    u32::try_from(part << (log >> 8).min(32) >> 8).unwrap_or(u32::MAX)
}
