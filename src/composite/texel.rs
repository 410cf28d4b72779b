//! Texels as pixels of a format.

use super::PixelFormat;
use crate::shade::texture::Texel;

/// A texel that can become pixels of a format: [`Texel`], or a word of the format itself.
pub trait TexelOf<F: PixelFormat>: Copy {
    /// The pixel in full light.
    fn word(self) -> F::Word;

    /// The 8-bit levels.
    fn levels(self) -> [u8; 3];

    /// The alpha, 255 for 1.
    #[inline(always)]
    fn alpha(self) -> u8 {
        255
    }

    /// Whether it is added where a finish says so (ForceAdditive, K11).
    #[inline(always)]
    fn is_additive(self) -> bool {
        false
    }

    /// Whether the pixel is not dithered, by its D bit or as it is a word of the format already.
    #[inline(always)]
    fn undithered(self) -> bool {
        true
    }
}

impl<F: PixelFormat> TexelOf<F> for Texel {
    #[inline]
    fn word(self) -> F::Word {
        F::from_rgb8(self.rgb)
    }

    #[inline]
    fn levels(self) -> [u8; 3] {
        self.rgb
    }

    /// 127 of A is 1.
    #[inline]
    fn alpha(self) -> u8 {
        let alpha = self.alpha.min(127);
        alpha << 1 | alpha >> 6
    }

    #[inline]
    fn is_additive(self) -> bool {
        self.undithered
    }

    #[inline(always)]
    fn undithered(self) -> bool {
        self.undithered
    }
}

impl<F: PixelFormat<Word = u16>> TexelOf<F> for u16 {
    #[inline(always)]
    fn word(self) -> u16 {
        self
    }

    #[inline]
    fn levels(self) -> [u8; 3] {
        F::to_rgb8(self)
    }
}

impl<F: PixelFormat<Word = [u8; 3]>> TexelOf<F> for [u8; 3] {
    #[inline(always)]
    fn word(self) -> [u8; 3] {
        self
    }

    #[inline]
    fn levels(self) -> [u8; 3] {
        self
    }
}
