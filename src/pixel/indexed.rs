//! Pixels that are numbers of a palette, and palettes that may differ from line to line (H18).
//!
//! A line is drawn as indices, a byte a pixel, and becomes colours when it is handed on: one load
//! more a pixel, and a line buffer of a byte a pixel instead of two or three. So a palette costs the
//! scene nothing, and a sky of 240 colours is one entry that changes from line to line.
//!
//! The index of a pixel is what red is in other formats. A face of the flat colour
//! [`Indexed::colour`] has that index; in light it has a smaller one, so a palette that holds ramps
//! is lit, and colours between vertices run along the palette.

use super::{MadeOf, PixelFormat};

/// A pixel is one of `N` colours, a power of two from 2 to 256.
#[derive(Clone, Copy, Debug)]
pub struct Indexed<const N: usize>;

/// Eight bits: 256 colours.
pub type Index8 = Indexed<256>;

/// Four bits, in a byte of their own: 16 colours, so that a palette for each line is small.
pub type Index4 = Indexed<16>;

impl<const N: usize> Indexed<N> {
    const SIZE: usize = {
        assert!(N.is_power_of_two() && N >= 2 && N <= 256);
        N
    };

    /// The 8-bit levels that a mesh is given for this index, which wraps at `N`.
    #[must_use]
    pub const fn colour(index: u8) -> [u8; 3] {
        // 255 for the last.
        let most = Self::SIZE - 1;
        [(((index as usize & most) * 255 + most / 2) / most) as u8; 3]
    }
}

impl<const N: usize> PixelFormat for Indexed<N> {
    type Word = u8;
    const STEPS: [u16; 3] = [(Self::SIZE - 1) as u16; 3];
    const MADE_OF: MadeOf = MadeOf::Index;

    #[inline(always)]
    fn pack(steps: [u8; 3]) -> u8 {
        steps[0]
    }

    /// The sum of the indices, at most the last.
    #[inline(always)]
    fn add(a: u8, b: u8) -> u8 {
        (u16::from(a) + u16::from(b)).min(Self::STEPS[0]) as u8
    }

    fn to_rgb8(word: u8) -> [u8; 3] {
        Self::colour(word)
    }

    #[inline(always)]
    fn widen(word: u8) -> [u32; 2] {
        [word.into(), 0]
    }

    #[inline(always)]
    fn narrow([index, _]: [u32; 2]) -> u8 {
        (index >> 4) as u8
    }

    /// Numbers are not mixed: of doubled lines and columns each pixel is the nearest one.
    fn mix_lines(near: &[u8], _: &[u8], sent: &mut [u8]) {
        for (pair, index) in sent.chunks_mut(2).zip(near) {
            pair.fill(*index);
        }
    }
}

/// Indices into colours, as many as both slices have; an index wraps at `N`. A palette of no colours
/// does not compile.
///
/// ```compile_fail
/// scanbeam::pixel::expand_indices::<u16, 0>(&[1], &[], &mut [0]);
/// ```
#[inline]
pub fn expand_indices<W: Copy, const N: usize>(indices: &[u8], palette: &[W; N], out: &mut [W]) {
    const {
        assert!(N > 0, "a palette has colours");
    }
    for (pixel, index) in out.iter_mut().zip(indices) {
        // Of 256 entries, or a power of two, no check is left.
        *pixel = palette[usize::from(*index) % N];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Colour, Scale};
    use crate::pixel::{Rgb565, Rgb565Be, Rgb888};

    fn all_indices<const N: usize>() {
        let scale = Scale::new(Indexed::<N>::STEPS);
        for index in 0..N {
            let index = index as u8;
            let rgb = Indexed::<N>::colour(index);
            // As faces have it, as vertices have it, and as levels.
            let steps = Colour::from_rgb8(rgb, &scale).steps(&scale);
            assert_eq!(Indexed::<N>::pack(steps), index);
            assert_eq!(Indexed::<N>::from_rgb8(rgb), index);
            assert_eq!(Indexed::<N>::from_rgb8(Indexed::<N>::to_rgb8(index)), index);
            // Kills: a number that is made of another channel, fields of another unit.
            assert_eq!(Indexed::<N>::pack([index, 0, 0]), index);
            let fields = Indexed::<N>::widen(index).map(|field| 16 * field);
            assert_eq!(Indexed::<N>::narrow(fields), index);
            let bits = N.ilog2();
            for low in [0, (1u32 << (32 - bits)) - 1] {
                let word = u32::from(index) << (32 - bits) | low;
                assert_eq!(Indexed::<N>::pack_words(word, 0x1234_5678), index);
            }
        }
        for a in 0..N {
            for b in 0..N {
                let sum = (a + b).min(N - 1) as u8;
                assert_eq!(Indexed::<N>::add(a as u8, b as u8), sum);
            }
        }
    }

    #[test]
    fn every_index_has_a_colour_that_gives_it_back() {
        all_indices::<256>();
        all_indices::<16>();
        all_indices::<2>();
        all_indices::<64>();
    }

    #[test]
    fn bytes_are_those_of_the_format() {
        let red = [255, 0, 0];
        let mut out = [0u16; 3];
        let mut palette = [0; 16];
        palette[9] = Rgb565Be::from_rgb8(red);
        // An index wraps: 25 is 9.
        expand_indices(&[9, 25, 3], &palette, &mut out);
        assert_eq!(out[0].to_ne_bytes(), [0xF8, 0]);
        assert_eq!((out[1], out[2]), (out[0], 0));
        palette[9] = Rgb565::from_rgb8(red);
        expand_indices(&[9, 25, 3], &palette, &mut out[..1]);
        assert_eq!((out[0], out[1].to_ne_bytes()), (0xF800, [0xF8, 0]));
        let mut wide = [[7; 3]; 2];
        expand_indices(&[1], &[[0; 3], Rgb888::from_rgb8(red)], &mut wide);
        assert_eq!(wide, [red, [7; 3]]);
    }
}
