//! The reciprocal of the perspective division: normalised, one Newton step, no divide (H4).
//!
//! A number is shifted until its top bit is set; the 8 bits below choose a seed `r`, the reciprocal of the middle of that
//! 256th. One Newton step gives `r (2 - x r) = 2 r - r² x`. The table keeps `2 r` and `r²`, so the step is one
//! multiply-subtract, and half of the step's largest miss is added in advance, as Newton's method errs to one side.
//! The relative error is below 2^-18.9.

/// `mantissa 2^(shift - 61)` is the reciprocal of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Reciprocal {
    /// `2^29` to `2^30`, each within 2^12.
    pub(crate) mantissa: i32,
    /// How far the number was shifted up, 0 to 31.
    pub(crate) shift: u32,
}

/// `2 r - r²` in 2.30, then `r²` in 1.31.
static STEPS: [[i32; 256]; 2] = steps();

const fn steps() -> [[i32; 256]; 2] {
    let (mut starts, mut squares) = ([0; 256], [0; 256]);
    let mut i = 0;
    while i < 256 {
        // The middle of the 256th, 1 to 2 in units of 1/512.
        let middle = 513 + 2 * i as u128;
        let twice = ((1024u128 << 32) / middle) >> 2;
        let square = (1u128 << (31 + 18)) / (middle * middle);
        // r^3 / 2^19: half of what Newton's step misses at the ends of the 256th.
        let half = ((1u128 << (30 + 27)) / (middle * middle * middle)) >> 19;
        starts[i] = (twice + half) as i32 - square as i32;
        squares[i] = square as i32;
        i += 1;
    }
    [starts, squares]
}

impl Reciprocal {
    /// The reciprocal of `x`; of 0 that of 1.
    #[inline(always)]
    pub(crate) fn of(x: u32) -> Self {
        let x = x | 1;
        let shift = x.leading_zeros();
        let top = x << shift;
        let part = (top >> 23 & 0xFF) as usize;
        // As a signed number the normalised one is 2^32 less: `square` less in the product's upper word, which the table
        // has taken off already.
        let (start, square) = (STEPS[0][part], STEPS[1][part]);
        let product = i64::from(square) * i64::from(top as i32);
        let mantissa = ((i64::from(start) << 32).wrapping_sub(product) >> 32) as i32;
        Self { mantissa, shift }
    }
}

#[cfg(test)]
mod tests {
    use super::Reciprocal;

    /// Without the Newton step's product the worst is 2^-9; with a seed off by one place 2^-14.
    #[test]
    fn relative_error_is_bounded() {
        let mut worst = 0f64;
        let mut check = |x: u32| {
            let r = Reciprocal::of(x);
            let got = f64::from(r.mantissa) * 2f64.powi(r.shift as i32 - 61);
            worst = worst.max((got * f64::from(x) - 1.0).abs());
        };
        // Both ends and some places of each 256th, at every shift that keeps it odd.
        for i in 0..256u32 {
            for part in 0..=64u32 {
                let top = 1 << 31 | i << 23 | (part << 17).min((1 << 23) - 1);
                for down in 0..8 {
                    check(top >> down | 1);
                }
            }
        }
        (1..200_000).step_by(2).for_each(check);
        assert!(worst < 2f64.powf(-18.9), "2^{}", worst.log2());
        assert!(worst > 2f64.powf(-19.1), "2^{}", worst.log2());
    }
}
