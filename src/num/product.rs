//! Products and quotients in the form that the target does best (S4).
//!
//! Where a processor has long products (Cortex-M3 and above), each is one or two instructions;
//! where it has none, [`short`](super::short) has the same bits in pieces.

use super::short::{self, SHORT};

/// `floor(a b / 2^32)`: SMULL, or SMMUL, on a Cortex-M4.
#[inline(always)]
pub const fn mul_high(a: i32, b: i32) -> i32 {
    if SHORT {
        short::high(a, b)
    } else {
        ((a as i64 * b as i64) >> 32) as i32
    }
}

/// `floor(a b / 2^32)` without signs.
#[inline(always)]
pub const fn mul_high_unsigned(a: u32, b: u32) -> u32 {
    if SHORT {
        short::high_unsigned(a, b)
    } else {
        ((a as u64 * b as u64) >> 32) as u32
    }
}

/// `a b`: SMULL; where there is none, by a call that takes half of what the compiler's own does.
#[cfg_attr(short_multiply, inline(never))]
#[cfg_attr(not(short_multiply), inline(always))]
pub const fn mul_wide(a: i32, b: i32) -> i64 {
    if SHORT {
        short::wide(a, b)
    } else {
        a as i64 * b as i64
    }
}

/// `floor(a b / 2^16)` modulo 2^32: SMULWB on a Cortex-M4.
#[inline(always)]
pub const fn mul_16(a: i32, b: i16) -> i32 {
    if SHORT {
        short::by_16(a, b)
    } else {
        ((a as i64 * b as i64) >> 16) as i32
    }
}

/// A product of two bytes by 255, to nearest. Of a sum of two such products, what is beyond 255 may be one off, but stays
/// beyond. Where a processor has no division, one by a constant is a call too.
#[inline(always)]
pub const fn of_255(product: u32) -> u32 {
    ((product + 127) * 0x8081) >> 23
}

/// Zero bits above the topmost one, 32 for 0; where no instruction counts them, by a call.
#[cfg_attr(short_multiply, inline(never))]
#[cfg_attr(not(short_multiply), inline(always))]
pub fn leading_zeros(x: u32) -> u32 {
    leading_zeros_here(x)
}

/// [`leading_zeros`] of a number that mostly has few: below 6 they are found in half the time, others take a little more.
#[cfg_attr(short_multiply, inline(never))]
#[cfg_attr(not(short_multiply), inline(always))]
pub fn few_leading_zeros(x: u32) -> u32 {
    if SHORT {
        short::few_zeros(x).unwrap_or_else(|| leading_zeros(x))
    } else {
        x.leading_zeros()
    }
}

/// [`leading_zeros`] without a call: some 40 bytes more, for what is asked of every small triangle.
#[inline(always)]
pub fn leading_zeros_here(x: u32) -> u32 {
    if SHORT {
        short::leading_zeros(x)
    } else {
        x.leading_zeros()
    }
}

#[cfg(test)]
mod tests {
    use super::of_255;

    /// Kills: a factor that is one more or less, and a half that is not added.
    #[test]
    fn sums_of_two_products_of_bytes_are_divided_by_255() {
        for sum in 0..=2 * 255 * 255 {
            assert_eq!(of_255(sum).min(256), ((sum + 127) / 255).min(256), "{sum}");
        }
    }
}
