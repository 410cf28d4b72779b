//! Blends: a new colour and the one that is there become one (K11, H8, P5).
//!
//! | file | there |
//! |---|---|
//! | `packed.rs` | 5, 6 and 5 bits, two pixels in a register |
//! | `bytes.rs` | 8 bits a channel, four channels in a register |
//! | here | any format, by its 8-bit levels; factors and write masks |
//!
//! Alpha is rounded to 5 bits for formats of 5 and 6 bits a channel, to 8 for those of 8; what
//! follows is rounded to nearest (half: down). So a channel is off by less than one step beyond
//! ideal rounding, and alpha 0 and 255 are exact.

mod bytes;
mod packed;
#[cfg(test)]
mod tests;

pub(super) use bytes::mix_bytes;
pub(super) use packed::mix_565;
pub(crate) use packed::mix_pair_565;

use super::PixelFormat;
use crate::geometry::{Blend, Factor, Finish};

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
        match self {
            Self::Filter(alpha) => {
                let (a, o, n) = (u32::from(alpha), u32::from(old), u32::from(new));
                (((255 - a) * o + a * n + 127) / 255) as u8
            }
            Self::Half => ((u16::from(old) + u16::from(new)) / 2) as u8,
            Self::Add(alpha) => old.saturating_add(times(new, alpha)),
            Self::Subtract(alpha) => old.saturating_sub(times(new, alpha)),
        }
    }
}

/// A level times a factor of 255, rounded to nearest.
#[inline]
fn times(level: u8, factor: u8) -> u8 {
    ((u32::from(level) * u32::from(factor) + 127) / 255) as u8
}

/// Blends `new` pixels over `old` ones by their 8-bit levels.
pub(super) fn mix_levels<F: PixelFormat>(old: &mut [F::Word], new: &[F::Word], mix: Mix) {
    for (old, &new) in old.iter_mut().zip(new) {
        let (o, n) = (F::to_rgb8(*old), F::to_rgb8(new));
        *old = F::from_rgb8([0, 1, 2].map(|i| mix.of_levels(o[i], n[i])));
    }
}

/// Alphas of a pixel beside those of its finish.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelAlpha {
    /// The surface's, 255 for 1.
    pub surface: u8,
    /// The texel's, 255 for 1.
    pub texel: u8,
    /// ForceAdditive: the pixel is added, whatever the blend is (K11).
    pub additive: bool,
}

impl PixelAlpha {
    /// Opaque.
    pub const OPAQUE: Self = Self {
        surface: 255,
        texel: 255,
        additive: false,
    };
}

/// How the pixels of a span are blended.
#[derive(Clone, Copy, Debug)]
pub struct Blender<'m> {
    finish: &'m Finish,
}

impl<'m> Blender<'m> {
    /// As a finish says.
    #[inline]
    #[must_use]
    pub const fn new(finish: &'m Finish) -> Self {
        Self { finish }
    }

    /// The fast way at this alpha, if there is one.
    #[inline]
    fn mix(&self, alpha: u8) -> Option<Mix> {
        match self.finish.blend {
            _ if self.finish.channels != Finish::RGB => None,
            Blend::Filter => Some(Mix::Filter(alpha)),
            Blend::Half => Some(Mix::Half),
            Blend::Add => Some(Mix::Add(alpha)),
            Blend::Subtract => Some(Mix::Subtract(alpha)),
            Blend::Replace | Blend::Factors { .. } => None,
        }
    }

    /// Blends `new` pixels, as many as there are, over `old` ones, all with the alpha of the
    /// finish.
    #[inline]
    pub fn blend<F: PixelFormat>(&self, old: &mut [F::Word], new: &[F::Word]) {
        let replaces = self.finish.blend == Blend::Replace;
        match self.mix(self.finish.alpha) {
            Some(mix) => F::mix(old, new, mix),
            None if replaces && self.finish.channels == Finish::RGB => {
                for (old, &new) in old.iter_mut().zip(new) {
                    *old = new;
                }
            }
            None => {
                let alpha = PixelAlpha {
                    surface: self.finish.alpha,
                    ..PixelAlpha::OPAQUE
                };
                for (old, &new) in old.iter_mut().zip(new) {
                    *old = self.pixel::<F>(*old, new, alpha);
                }
            }
        }
    }

    /// One pixel over another, with alphas of its own.
    #[inline(never)]
    #[must_use]
    pub fn pixel<F: PixelFormat>(&self, old: F::Word, new: F::Word, alpha: PixelAlpha) -> F::Word {
        let both = times(alpha.surface, alpha.texel);
        let mut word = [old];
        match (self.finish.blend, self.mix(both)) {
            _ if alpha.additive => F::mix(&mut word, &[new], Mix::Add(both)),
            (_, Some(mix)) => F::mix(&mut word, &[new], mix),
            (Blend::Replace, None) => word[0] = new,
            (Blend::Filter, None) => F::mix(&mut word, &[new], Mix::Filter(both)),
            (Blend::Half, None) => F::mix(&mut word, &[new], Mix::Half),
            (Blend::Add, None) => F::mix(&mut word, &[new], Mix::Add(both)),
            (Blend::Subtract, None) => F::mix(&mut word, &[new], Mix::Subtract(both)),
            (
                Blend::Factors {
                    source,
                    destination,
                },
                None,
            ) => {
                let (o, n) = (F::to_rgb8(old), F::to_rgb8(new));
                word[0] = F::from_rgb8([0, 1, 2].map(|i| {
                    let s = u32::from(n[i]) * u32::from(factor(source, alpha, o[i]));
                    let d = u32::from(o[i]) * u32::from(factor(destination, alpha, o[i]));
                    ((s + d + 127) / 255).min(255) as u8
                }));
            }
        }
        if self.finish.channels == Finish::RGB {
            return word[0];
        }
        let (o, n) = (F::to_rgb8(old), F::to_rgb8(word[0]));
        F::from_rgb8([0, 1, 2].map(|i| {
            let writes = self.finish.channels >> i & 1 != 0;
            if writes { n[i] } else { o[i] }
        }))
    }
}

/// A factor where `old` is the level that is there.
fn factor(factor: Factor, alpha: PixelAlpha, old: u8) -> u8 {
    match factor {
        Factor::Constant(value) => value,
        Factor::SourceAlpha => alpha.surface,
        Factor::InverseSourceAlpha => 255 - alpha.surface,
        Factor::TextureAlpha => alpha.texel,
        Factor::InverseTextureAlpha => 255 - alpha.texel,
        Factor::Destination => old,
        Factor::InverseDestination => 255 - old,
    }
}
