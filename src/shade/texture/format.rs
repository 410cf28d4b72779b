//! Texel formats, and what all of them expand to: R, G, B, A and D (H7).
//!
//! | format | word | R, G, B, A, D bits | red at |
//! |---|---|---|---|
//! | [`Rgba8871`] | `u32` | 8, 8, 8, 7, 1 | the top |
//! | [`Rgba5551`] | `u16` | 5, 5, 5, 1, 0 | the top |
//! | [`Rgbd5551`] | `u16` | 5, 5, 5, 0, 1 | the top |
//! | [`Rgb565Texel`] | `u16` | 5, 6, 5, 0, 0 | the top |
//! | [`Rgb888Texel`] | `[u8; 3]` | 8, 8, 8, 0, 0 | the first byte |
//!
//! Fields follow each other without gaps. Fewer than 8 bits grow by repeating their top bits, so
//! full stays full; a texel without A is opaque, one without D is dithered.

/// A texel, expanded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Texel {
    /// Red, green and blue, 8 bits each.
    pub rgb: [u8; 3],
    /// The blend factor A: 0 is transparent, 127 opaque.
    pub alpha: u8,
    /// The D bit: the pixel is not dithered.
    pub undithered: bool,
}

/// How a texel is stored.
pub trait TexelFormat {
    /// A stored texel.
    type Word: Copy + Default;

    /// All of what it says.
    fn expand(word: Self::Word) -> Texel;

    /// The nearest that can be stored; rounding to nearest, A from half on.
    fn pack(texel: Texel) -> Self::Word;
}

/// 32 bits: 8, 8, 8, 7 and 1.
#[derive(Clone, Copy, Debug)]
pub struct Rgba8871;

/// 16 bits: 5, 5, 5 and one of A.
#[derive(Clone, Copy, Debug)]
pub struct Rgba5551;

/// 16 bits: 5, 5, 5 and one of D.
#[derive(Clone, Copy, Debug)]
pub struct Rgbd5551;

/// 16 bits: 5, 6 and 5.
#[derive(Clone, Copy, Debug)]
pub struct Rgb565Texel;

/// 24 bits.
#[derive(Clone, Copy, Debug)]
pub struct Rgb888Texel;

/// A field of `bits` (1 to 8) that ends at bit 0, as 8 bits.
const fn widened(field: u32, bits: u32) -> u8 {
    let field = (field & ((1 << bits) - 1)) << (8 - bits);
    (field | field >> bits) as u8
}

/// 8 bits as a field of `bits`, to nearest.
const fn narrowed(level: u8, bits: u32) -> u32 {
    let most = (1 << bits) - 1;
    (level as u32 * most + 127) / 255
}

const OPAQUE: u8 = 127;

impl TexelFormat for Rgba8871 {
    type Word = u32;

    #[inline(always)]
    fn expand(word: u32) -> Texel {
        let [r, g, b, ad] = word.to_be_bytes();
        Texel {
            rgb: [r, g, b],
            alpha: ad >> 1,
            undithered: ad & 1 != 0,
        }
    }

    #[inline(always)]
    fn pack(texel: Texel) -> u32 {
        let [r, g, b] = texel.rgb;
        let ad = texel.alpha.min(OPAQUE) << 1 | u8::from(texel.undithered);
        u32::from_be_bytes([r, g, b, ad])
    }
}

/// The three 5-bit fields above bit 0.
fn expand_555(word: u16) -> [u8; 3] {
    [11, 6, 1].map(|shift| widened(u32::from(word) >> shift, 5))
}

/// Into the three 5-bit fields above bit 0.
fn pack_555([r, g, b]: [u8; 3]) -> u16 {
    (narrowed(r, 5) << 11 | narrowed(g, 5) << 6 | narrowed(b, 5) << 1) as u16
}

impl TexelFormat for Rgba5551 {
    type Word = u16;

    #[inline]
    fn expand(word: u16) -> Texel {
        Texel {
            rgb: expand_555(word),
            alpha: if word & 1 != 0 { OPAQUE } else { 0 },
            undithered: false,
        }
    }

    #[inline]
    fn pack(texel: Texel) -> u16 {
        pack_555(texel.rgb) | u16::from(texel.alpha > OPAQUE / 2)
    }
}

impl TexelFormat for Rgbd5551 {
    type Word = u16;

    #[inline]
    fn expand(word: u16) -> Texel {
        Texel {
            rgb: expand_555(word),
            alpha: OPAQUE,
            undithered: word & 1 != 0,
        }
    }

    #[inline]
    fn pack(texel: Texel) -> u16 {
        pack_555(texel.rgb) | u16::from(texel.undithered)
    }
}

impl TexelFormat for Rgb565Texel {
    type Word = u16;

    #[inline]
    fn expand(word: u16) -> Texel {
        let word = u32::from(word);
        Texel {
            rgb: [
                widened(word >> 11, 5),
                widened(word >> 5, 6),
                widened(word, 5),
            ],
            alpha: OPAQUE,
            undithered: false,
        }
    }

    #[inline]
    fn pack(texel: Texel) -> u16 {
        let [r, g, b] = texel.rgb;
        (narrowed(r, 5) << 11 | narrowed(g, 6) << 5 | narrowed(b, 5)) as u16
    }
}

impl TexelFormat for Rgb888Texel {
    type Word = [u8; 3];

    #[inline(always)]
    fn expand(word: [u8; 3]) -> Texel {
        Texel {
            rgb: word,
            alpha: OPAQUE,
            undithered: false,
        }
    }

    #[inline(always)]
    fn pack(texel: Texel) -> [u8; 3] {
        texel.rgb
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn round_trips<F: TexelFormat>(words: impl Iterator<Item = F::Word>)
    where
        F::Word: PartialEq + core::fmt::Debug,
    {
        for word in words {
            assert_eq!(F::pack(F::expand(word)), word);
        }
    }

    #[test]
    fn every_word_survives_expansion() {
        round_trips::<Rgba5551>(0..=u16::MAX);
        round_trips::<Rgbd5551>(0..=u16::MAX);
        round_trips::<Rgb565Texel>(0..=u16::MAX);
        round_trips::<Rgba8871>((0..1 << 20).map(|i: u32| i.wrapping_mul(0x9E37_79B9)));
        round_trips::<Rgb888Texel>((0..1 << 16).map(|i: u32| {
            let [a, b, c, _] = i.wrapping_mul(0x9E37_79B9).to_le_bytes();
            [a, b, c]
        }));
    }

    #[test]
    fn fields_lie_where_they_are_said_to() {
        let texel = Rgba8871::expand(0x1122_33FE);
        assert_eq!((texel.rgb, texel.alpha), ([0x11, 0x22, 0x33], 127));
        assert!(!texel.undithered && Rgba8871::expand(1).undithered);
        assert_eq!(Rgba5551::expand(0xF801).rgb, [255, 0, 0]);
        assert_eq!(Rgba5551::expand(0xF801).alpha, 127);
        assert_eq!(Rgba5551::expand(0xF800).alpha, 0);
        assert_eq!(Rgbd5551::expand(0x07C0).rgb, [0, 255, 0]);
        assert!(Rgbd5551::expand(1).undithered && !Rgbd5551::expand(0).undithered);
        assert_eq!(Rgb565Texel::expand(0x07E0).rgb, [0, 255, 0]);
        // 16 of 31 grows to 132 by repetition: 0b10000 -> 0b10000100.
        assert_eq!(Rgba5551::expand(16 << 11).rgb[0], 132);
    }
}
