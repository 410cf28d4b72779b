//! The weights of interpolation: down an edge and along a span (K5, K6).

use super::lirp::{EDGE_BITS, SPAN_BITS};

/// `W = (Y - Ytop) / (Ybottom - Ytop)` to 12 bits, rounded down; all ones at the bottom (K5).
///
/// `down` is `Y - Ytop` and `height` is `Ybottom - Ytop`, in the same unit, `down <= height`.
/// A subtract-and-shift divider, one bit a step; the quotient 1, which 12 bits do not hold,
/// comes out as all ones by itself, and so does anything over 0.
#[inline]
#[must_use]
pub const fn vertical_weight(down: u16, height: u16) -> u16 {
    let height = height as u32;
    let (mut rest, mut quotient) = (down as u32, 0u32);
    let mut bit = 0;
    while bit < EDGE_BITS {
        rest <<= 1;
        quotient <<= 1;
        if rest >= height {
            rest -= height;
            quotient |= 1;
        }
        bit += 1;
    }
    quotient as u16
}

/// `distance / length` to `bits` bits by the processor's own divider, rounded down; all ones at
/// the far end: what [`vertical_weight`] gives for 12 bits, for any width up to 16.
///
/// No circuit of the model has it. It is here to say what a wider W along a span would buy.
#[inline]
#[must_use]
pub const fn divided_weight(distance: u16, length: u16, bits: u32) -> u32 {
    let ones = (1 << bits) - 1;
    match ((distance as u32) << bits).checked_div(length as u32) {
        Some(weight) if weight < ones => weight,
        _ => ones,
    }
}

/// The circuit of K6 for one span: `W(X) = (X - Xleft) / (Xright - Xleft)` to 10 bits.
///
/// The leading zeros that the span's length has, its reciprocal has not: both factors are
/// shifted left by their number, and a 12 by 12 bit multiplier does where 26 by 16 bits would be
/// needed. Cutting the length to 12 bits makes the weight larger, cutting the distance makes it
/// smaller, so the two errors oppose each other. Only spans of more than 512 pixels are cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SpanWeight {
    /// Places that both factors are shifted by: the length's leading zeros, 14 at most.
    normalise: u32,
    /// The normalised length's inverse, 12 bits: 2^23 over its upper 12 bits, to nearest.
    ///
    /// Where those 12 bits are a power of two so is the inverse: it is one bit too long, and
    /// the multiplier is a mere shift. The same holds for length 1, whose 15 zeros count as 14.
    inverse: u32,
}

impl SpanWeight {
    /// For spans of this length in units of 1/8 pixel. Of length 0 all weights are 0.
    #[inline]
    #[must_use]
    pub const fn new(length: u16) -> Self {
        let zeros = length.leading_zeros();
        let normalise = if zeros > 14 { 14 } else { zeros };
        let upper = ((length as u32) << normalise) >> 4;
        let inverse = match ((1u32 << 23) + upper / 2).checked_div(upper) {
            Some(inverse) => inverse,
            None => 0,
        };
        Self { normalise, inverse }
    }

    /// The weight at `distance` right of the span's left end, in units of 1/8 pixel; rounded to
    /// nearest, all ones from the right end on.
    ///
    /// Off the true weight by at most 1.08 units of the tenth bit, by 0.74 up to 512 pixels; 0
    /// and all ones at the ends.
    #[inline]
    #[must_use]
    pub const fn at(self, distance: u16) -> u16 {
        let distance = ((distance as u32) << self.normalise) >> 4;
        let product = distance as u64 * self.inverse as u64;
        let weight = (product + (1 << 12)) >> 13;
        let ones = (1 << SPAN_BITS) - 1;
        if weight > ones {
            ones as u16
        } else {
            weight as u16
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::println;

    #[test]
    fn the_divider_is_a_division() {
        for height in (1..=u16::MAX).step_by(37).chain([1, 2, 3, u16::MAX]) {
            for i in 0..=64u32 {
                let down = (u32::from(height) * i / 64) as u16;
                let exact = (u32::from(down) << 12) / u32::from(height);
                let circuit = u32::from(vertical_weight(down, height));
                assert_eq!(circuit, exact.min(4095), "{down} / {height}");
                assert_eq!(circuit, divided_weight(down, height, 12));
            }
        }
        assert_eq!(vertical_weight(0, 0), 4095);
        assert_eq!(divided_weight(0, 0, 12), 4095);
        assert_eq!(divided_weight(u16::MAX, u16::MAX, 16), 0xFFFF);
        assert_eq!(divided_weight(1, 2, 16), 0x8000);
    }

    #[test]
    fn both_ends_of_every_length_are_exact() {
        for length in 1..=u16::MAX {
            let weight = SpanWeight::new(length);
            assert_eq!(weight.at(0), 0, "{length}");
            assert_eq!(weight.at(length), 1023, "{length}");
        }
        assert_eq!(SpanWeight::new(0).at(0), 0);
        assert_eq!(SpanWeight::new(1).at(u16::MAX), 1023);
    }

    /// All 2^31 of them, with no gaps: some ten seconds.
    #[test]
    fn every_length_keeps_its_ten_bits_at_every_distance() {
        let mut worst = [0.0f64; 2];
        for length in 1..=u16::MAX {
            let weight = SpanWeight::new(length);
            let scale = 1024.0 / f64::from(length);
            let (mut largest, mut last) = (0.0f64, 0);
            for distance in 0..=length {
                let code = weight.at(distance);
                assert!(code >= last, "{length} at {distance}");
                last = code;
                // All ones stand for 1.
                let exact = (scale * f64::from(distance)).min(1023.0);
                largest = largest.max((f64::from(code) - exact).abs());
            }
            let long = usize::from(length >= 4096);
            worst[long] = worst[long].max(largest);
        }
        println!(
            "W(X), units of the tenth bit: {:.4} up to 512 pixels, {:.4} beyond",
            worst[0], worst[1]
        );
        assert!(worst[0] <= 0.74 && worst[1] <= 1.08, "{worst:?}");
        assert!(worst[0] > 0.7 && worst[1] > 1.0, "the bounds are loose");
    }
}
