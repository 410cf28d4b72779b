//! Which method takes a span's colours from pixel to pixel (K6, K7, P3, X2).

use crate::format::Precision;

/// A way to have a span's colours at its pixels. All keep every colour within its range (P4), and none moves an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// A channel a register, stepped forward. Exact.
    Plane,
    /// As few registers as the format needs, anchored anew every 8 pixels.
    Packed8,
    /// The same, every 16 pixels.
    Packed16,
    /// One colour for 2 pixels, that between them.
    Half,
    /// One colour for 4 pixels, that of their middle.
    Quarter,
    /// One colour for the whole span, that of its middle.
    Whole,
    /// LIRP between the exact colours of the first and the last pixel, with so many bits of W: 10, 12 or 16; others
    /// count as 16.
    Lirp(u32),
    /// LIRP with 8 bits of W, two channels a multiplication.
    LirpPacked,
    /// For each span the cheapest of the others, LIRP left out, that is proven to be off by no more than so many 8-bit
    /// levels, with 8 fraction bits.
    Within(u16),
}

/// Units of 2^-16 of a channel's range that an 8-bit level has at least: 2^16 31 / (32 255).
const UNITS_A_LEVEL: u32 = 248;

/// Pixels of a span from which on one colour for several pays.
const LONG: u32 = 16;

impl Method {
    /// Within 4 levels: what moves hides it.
    pub const FAST: Self = Self::Within(4 << 8);
    /// Within 1.5 levels: less than a step of 16-bit colour.
    pub const BALANCED: Self = Self::Within(3 << 7);
    /// Nothing beyond rounding.
    pub const EXACT: Self = Self::Within(0);

    /// What [`Within`](Self::Within) takes for a span of so many pixels, at least 1; any other method itself.
    ///
    /// In units of 2^-16 of a channel's range: let `slope` be the largest step of a channel from pixel to pixel, `u`
    /// what is cut off at an anchor, and `d` what a packed step errs at most. Colours are linear along a span, so
    ///
    /// - one colour for `n` pixels, that of their middle, is off by `slope (n - 1) / 2` at the outermost, rounded up, as
    ///   the middle may lie half a unit between two;
    /// - a packed ramp, `k` steps after its anchor, lies from `u + k d` below to `k d` above;
    /// - half and quarter rate step by the group, and are anchored every 4 groups, so they are off by both.
    ///
    /// Where none fits, planes are stepped as they are. On a Cortex-M4 one colour for 2 pixels is dearer than packing.
    #[inline(always)]
    #[must_use]
    pub fn of_span(self, pixels: u32, slope: impl FnOnce() -> u32, packing: Precision) -> Self {
        let Self::Within(levels) = self else {
            return self;
        };
        // Twice the units.
        let budget = (u32::from(levels) * (2 * UNITS_A_LEVEL)) >> 8;
        let Precision { unit, drift } = packing;
        let after = |steps: u32| 2 * (unit + steps.min(pixels - 1) * drift);
        if pixels > 2 {
            // At most 2^16 and 2^13: no product leaves 32 bits.
            let slope = slope();
            if even(slope.wrapping_mul(pixels - 1)) <= budget {
                return Self::Whole;
            }
            if pixels >= LONG {
                if even(3 * slope) + after(3) <= budget {
                    return Self::Quarter;
                }
                let packs = after(7) <= budget;
                if !packs && even(slope) + after(3) <= budget {
                    return Self::Half;
                }
            }
        }
        if after(15) <= budget {
            Self::Packed16
        } else if after(7) <= budget {
            Self::Packed8
        } else {
            Self::Plane
        }
    }
}

/// The next even number, unless it is one.
#[inline(always)]
const fn even(number: u32) -> u32 {
    (number + 1) & !1
}
