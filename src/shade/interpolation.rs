//! Which method takes a span's colours from pixel to pixel (K6, K7, P3, X2).
//!
//! The choice is a type of the pipeline, without size and resolved when it is compiled; only
//! [`Auto`] chooses while it draws, once a span. How each method works, and what it costs, is
//! told where pixels are made (`composite`).

use super::quality::Quality;

/// A way to have a span's colours at its pixels. All keep every colour within its range (P4), and
/// none moves an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// The planes as they are, stepped forward: two words for a small triangle, three channels
    /// of 16.16 for others. Exact.
    Forward,
    /// As few registers as the format needs, anchored anew from the planes every 8 pixels.
    Packed8,
    /// The same, every 16 pixels.
    Packed16,
    /// One colour for 2 pixels, that between them.
    Half,
    /// One colour for 4 pixels, that of their middle.
    Quarter,
    /// One colour for the whole span, that of its middle.
    Whole,
    /// LIRP between the exact colours of the span's first and last pixel, 10 bits of W.
    Lirp10,
    /// LIRP with 12 bits of W.
    Lirp12,
    /// LIRP with 16 bits of W.
    Lirp16,
    /// LIRP with 8 bits of W, two channels a multiplication.
    LirpPacked,
}

/// What packing costs a format, in units of 2^-16 of a channel's range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Precision {
    /// The unit of the coarsest field: what is cut off at an anchor.
    pub unit: u32,
    /// By how much a step errs at most: half a unit where steps are rounded.
    pub drift: u32,
}

/// Units of 2^-16 of a channel's range that an 8-bit level has at least: 2^16 31 / (32 255).
const UNITS_A_LEVEL: u32 = 248;

/// The choice of a pipeline.
pub trait Interpolation: Copy + Default + Send + Sync {
    /// Whether there is something to choose while drawing.
    const CHOOSES: bool = false;

    /// States what the picture may be off; a fixed method does not listen.
    fn set_quality(&mut self, _: Quality) {}

    /// The method for a span of so many pixels, at least 1, in a format of this precision.
    ///
    /// `slope` is the largest step of a channel from pixel to pixel, in units of 2^-16 of its
    /// range; it is right for spans of 3 pixels and more, and not asked for shorter ones.
    fn method(&self, pixels: u32, slope: impl FnOnce() -> u32, precision: Precision) -> Method;
}

/// Types that stand for one method.
macro_rules! fixed {
    ($($(#[$doc:meta])* $name:ident => $method:ident;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        pub struct $name;

        impl Interpolation for $name {
            #[inline(always)]
            fn method(&self, _: u32, _: impl FnOnce() -> u32, _: Precision) -> Method {
                Method::$method
            }
        }
    )*};
}

fixed! {
    /// [`Method::Forward`] for all spans.
    Forward => Forward;
    /// [`Method::Packed8`] for all spans: what presets have.
    Packed8 => Packed8;
    /// [`Method::Packed16`] for all spans.
    Packed16 => Packed16;
    /// [`Method::Half`] for all spans of 3 pixels and more.
    HalfRate => Half;
    /// [`Method::Quarter`] for all spans of 3 pixels and more.
    QuarterRate => Quarter;
    /// [`Method::Lirp10`] for all spans.
    Lirp10 => Lirp10;
    /// [`Method::Lirp12`] for all spans.
    Lirp12 => Lirp12;
    /// [`Method::Lirp16`] for all spans.
    Lirp16 => Lirp16;
    /// [`Method::LirpPacked`] for all spans.
    LirpPacked => LirpPacked;
}

/// For each span the cheapest method that is proven to keep the [`Quality`] asked for.
///
/// In units of 2^-16 of a channel's range, of which a level has 248 or more: let `s` be the
/// largest step of a channel from pixel to pixel, `u` what is cut off at an anchor, and `d` what
/// a packed step errs at most. Colours are linear along a span, so
///
/// - one colour for `n` pixels, that of their middle, is off by `s (n - 1) / 2` at the outermost,
///   rounded up, as the middle may lie half a unit between two;
/// - a packed ramp, `k` steps after its anchor, lies from `u + k d` below to `k d` above: a sum of
///   fields is the sum of their values, and what is cut off at an anchor alone is cut off again
///   when the pixel is made, so it counts only when `k > 0`;
/// - half and quarter rate step by the group, and are anchored every 4 groups, so they are off by
///   both: `s / 2 + u + 3 d` and `3 s / 2 + u + 3 d`.
///
/// None of these asks for more than a comparison. Where none fits, planes are stepped as they
/// are, which adds nothing. Rates are for spans of [`LONG`](Auto::LONG) pixels and more: below,
/// packing is cheaper than to prepare them. In a format whose ramp is one word, packing is also
/// tried before half rate: on a Cortex-M4 a tested pixel takes 10.5 (16 pixels an anchor) and 13.4
/// instructions (8) against 13.9, an untested one 4.9 and 6.0 against 5.3.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Auto {
    /// Twice the units that colours may be off.
    budget: u32,
}

impl Auto {
    /// Pixels from which on a rate pays.
    pub const LONG: u32 = 16;

    /// For a quality.
    #[must_use]
    pub const fn new(quality: Quality) -> Self {
        Self {
            budget: (quality.levels.to_bits() as u32 * (2 * UNITS_A_LEVEL)) >> 8,
        }
    }
}

impl Default for Auto {
    fn default() -> Self {
        Self::new(Quality::default())
    }
}

impl Interpolation for Auto {
    const CHOOSES: bool = true;

    fn set_quality(&mut self, quality: Quality) {
        *self = Self::new(quality);
    }

    #[inline(always)]
    fn method(&self, pixels: u32, slope: impl FnOnce() -> u32, precision: Precision) -> Method {
        let Precision { unit, drift } = precision;
        let after = |steps: u32| 2 * (unit + steps.min(pixels - 1) * drift);
        if pixels > 2 {
            // At most 2^16 and 2^13: no product leaves 32 bits.
            let slope = slope();
            if even(slope * (pixels - 1)) <= self.budget {
                return Method::Whole;
            }
            if pixels >= Self::LONG {
                if even(3 * slope) + after(3) <= self.budget {
                    return Method::Quarter;
                }
                let one_word = unit > 1;
                let packs = one_word && after(7) <= self.budget;
                if !packs && even(slope) + after(3) <= self.budget {
                    return Method::Half;
                }
            }
        }
        if after(15) <= self.budget {
            Method::Packed16
        } else if after(7) <= self.budget {
            Method::Packed8
        } else {
            Method::Forward
        }
    }
}

/// The next even number, unless it is one.
#[inline(always)]
const fn even(number: u32) -> u32 {
    (number + 1) & !1
}

#[cfg(test)]
mod tests {
    use super::*;
    use fixed::types::U8F8;

    /// From cheap to dear, by what they cost a pixel with depth: where a ramp is one word, and
    /// where it is two.
    const RANKS: [[Method; 6]; 2] = [
        [
            Method::Whole,
            Method::Quarter,
            Method::Packed16,
            Method::Packed8,
            Method::Half,
            Method::Forward,
        ],
        [
            Method::Whole,
            Method::Quarter,
            Method::Half,
            Method::Packed16,
            Method::Packed8,
            Method::Forward,
        ],
    ];

    #[test]
    fn a_looser_budget_never_takes_a_dearer_method() {
        let precisions = [(0, 0), (1, 1), (64, 32)].map(|(unit, drift)| Precision { unit, drift });
        let mut taken = [0; RANKS[0].len()];
        for precision in precisions {
            let ranks = RANKS[usize::from(precision.unit <= 1)];
            let rank = |m| ranks.iter().position(|r| *r == m).unwrap();
            for pixels in [1, 2, 3, 7, 8, 9, 15, 16, 17, 64, 319, 8192] {
                for slope in [
                    0, 1, 5, 30, 60, 100, 150, 200, 248, 400, 700, 2000, 30_000, 65_000,
                ] {
                    let slope: u32 = slope;
                    if u64::from(slope) * u64::from(pixels - 1) > 1 << 16 && pixels > 2 {
                        continue;
                    }
                    let mut last = ranks.len();
                    for bits in 0..2048u16 {
                        let quality = Quality {
                            levels: U8F8::from_bits(bits),
                            ..Quality::exact()
                        };
                        let method = Auto::new(quality).method(pixels, || slope, precision);
                        let now = rank(method);
                        assert!(now <= last, "{bits} {pixels} {slope} {precision:?}");
                        last = now;
                        taken[now] += 1;
                    }
                }
            }
        }
        assert!(taken.iter().all(|&count| count > 1000), "{taken:?}");
    }

    #[test]
    fn exact_is_exact() {
        let exact = Auto::new(Quality::exact());
        let precision = Precision {
            unit: 64,
            drift: 32,
        };
        assert_eq!(exact.method(40, || 1, precision), Method::Forward);
        assert_eq!(exact.method(40, || 0, precision), Method::Whole);
        assert_eq!(exact.method(1, || 9, precision), Method::Forward);
    }
}
