//! How two pixels become one, by modes that formats have a fast way for (K11, P5).
//!
//! Alpha is rounded to 5 bits for formats of 5 and 6 bits a channel, to 8 for those of 8; what
//! follows is rounded to nearest (half: down). So a channel is off by less than one step beyond
//! ideal rounding, and alpha 0 and 255 are exact.

use super::PixelFormat;
use crate::num::of_255;

/// A blend that formats have a fast way for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mix {
    /// `old + (new - old) alpha`.
    Filter(u8),
    /// Half of each, rounded down.
    Half,
    /// `old + new alpha`, at most full.
    Add(u8),
    /// `old - new alpha`, at least 0.
    Subtract(u8),
}

impl Mix {
    /// On 8-bit levels; `a b / 255` is rounded to nearest.
    #[must_use]
    pub fn of_levels(self, old: u8, new: u8) -> u8 {
        let times = |level: u8, alpha: u8| u32::from(level) * u32::from(alpha);
        let part = |alpha| of_255(times(new, alpha)) as u8;
        match self {
            Self::Filter(alpha) => of_255(times(old, 255 - alpha) + times(new, alpha)) as u8,
            Self::Half => ((u16::from(old) + u16::from(new)) / 2) as u8,
            Self::Add(alpha) => old.saturating_add(part(alpha)),
            Self::Subtract(alpha) => old.saturating_sub(part(alpha)),
        }
    }
}

/// The mean of every field of a word, rounded down; `low` has the low bit of each.
#[inline(always)]
pub(super) const fn half(old: u32, new: u32, low: u32) -> u32 {
    (old & new) + ((old ^ new) & !low) / 2
}

/// Blends `new` pixels over `old` ones by their 8-bit levels.
pub(super) fn mix_levels<F: PixelFormat>(old: &mut [F::Word], new: &[F::Word], mix: Mix) {
    for (old, &new) in old.iter_mut().zip(new) {
        let (o, n) = (F::to_rgb8(*old), F::to_rgb8(new));
        *old = F::from_rgb8([0, 1, 2].map(|i| mix.of_levels(o[i], n[i])));
    }
}

#[cfg(test)]
mod tests;
