//! Pixels that are numbers of a palette, and palettes that may differ from line to line (H18).
//!
//! A line is drawn as indices, a byte a pixel, and becomes colours when it is handed on: one load
//! more a pixel, and a line buffer of a byte a pixel instead of two or three. So a palette costs the
//! scene nothing, and a sky of 240 colours is one entry that changes from line to line.
//!
//! The index of a pixel is what red is in other formats. A face of the flat colour
//! [`Indexed::colour`] has that index; in light it has a smaller one, so a palette that holds ramps
//! is lit, and colours between vertices run along the palette.

use super::PixelFormat;

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
    /// Where an index begins in 32 bits.
    const SHIFT: u32 = 32 - Self::SIZE.ilog2();

    /// The 8-bit levels that a mesh is given for this index, which wraps at `N`.
    #[must_use]
    pub const fn colour(index: u8) -> [u8; 3] {
        [Self::level(index); 3]
    }

    /// An index as a level, 255 for the last.
    const fn level(index: u8) -> u8 {
        let most = Self::SIZE - 1;
        (((index as usize & most) * 255 + most / 2) / most) as u8
    }
}

impl<const N: usize> PixelFormat for Indexed<N> {
    type Word = u8;
    const STEPS: [u16; 3] = [(Self::SIZE - 1) as u16; 3];

    #[inline(always)]
    fn pack(steps: [u8; 3]) -> u8 {
        steps[0]
    }

    #[inline(always)]
    fn pack_words(red_blue: u32, _: u32) -> u8 {
        (red_blue >> Self::SHIFT) as u8
    }

    /// The sum of the indices, at most the last.
    #[inline(always)]
    fn add(a: u8, b: u8) -> u8 {
        (u16::from(a) + u16::from(b)).min(Self::STEPS[0]) as u8
    }

    fn to_rgb8(word: u8) -> [u8; 3] {
        Self::colour(word)
    }
}

/// Which palette a line of the picture has: `N` pixels of a display whose words are `W`.
///
/// One palette by itself is that of all lines; [`PaletteTable`] chooses among several, and a type of
/// your own may change entries as it goes. Lines are asked for in the order in which they are
/// drawn.
pub trait LinePalettes<W, const N: usize> {
    /// The palette of `line`, 0 at the picture's top.
    fn palette(&mut self, line: u16) -> &[W; N];
}

impl<W, const N: usize> LinePalettes<W, N> for &[W; N] {
    #[inline(always)]
    fn palette(&mut self, _: u16) -> &[W; N] {
        self
    }
}

impl<W, const N: usize, L: LinePalettes<W, N> + ?Sized> LinePalettes<W, N> for &mut L {
    #[inline]
    fn palette(&mut self, line: u16) -> &[W; N] {
        L::palette(self, line)
    }
}

/// Several palettes, and which of them each line has.
#[derive(Clone, Copy, Debug)]
pub struct PaletteTable<'p, W, const N: usize> {
    first: &'p [W; N],
    palettes: &'p [[W; N]],
    of_line: &'p [u8],
}

impl<'p, W, const N: usize> PaletteTable<'p, W, N> {
    /// The number of a palette for each line from the top; lines below have that of the last one,
    /// or number 0.
    ///
    /// `None` when there are no palettes, or a number is of none of them.
    #[must_use]
    pub fn new(palettes: &'p [[W; N]], of_line: &'p [u8]) -> Option<Self> {
        let exists = |number: &u8| usize::from(*number) < palettes.len();
        let first = palettes.first()?;
        of_line.iter().all(exists).then_some(Self {
            first,
            palettes,
            of_line,
        })
    }
}

impl<W, const N: usize> LinePalettes<W, N> for PaletteTable<'_, W, N> {
    #[inline]
    fn palette(&mut self, line: u16) -> &[W; N] {
        let number = self.of_line.get(usize::from(line));
        let number = number.or(self.of_line.last()).copied().unwrap_or(0);
        self.palettes.get(usize::from(number)).unwrap_or(self.first)
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
    use crate::num::random::Rng;
    use crate::pixel::{Rgb565, Rgb565Be, Rgb888};
    use std::{vec, vec::Vec};

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
    fn lines_are_expanded_by_their_own_palette() {
        let mut rng = Rng(5);
        let mut palettes = [[[0u8; 3]; 256]; 3];
        for level in palettes.as_flattened_mut().as_flattened_mut() {
            *level = rng.below(256) as u8;
        }
        let of_line: Vec<u8> = (0..40).map(|_| rng.below(3) as u8).collect();
        let mut table = PaletteTable::new(&palettes, &of_line).unwrap();
        for line in 0..60u16 {
            let indices: Vec<u8> = (0..97).map(|_| rng.below(256) as u8).collect();
            let number = of_line[usize::from(line).min(39)];
            let colour = |i: &u8| palettes[usize::from(number)][usize::from(*i)];
            let expected: Vec<_> = indices.iter().map(colour).collect();
            let mut out = vec![[0; 3]; 97];
            expand_indices(&indices, table.palette(line), &mut out);
            assert_eq!(out, expected);
        }
        assert!(PaletteTable::new(&palettes, &[0, 3]).is_none());
        assert!(PaletteTable::<u16, 16>::new(&[], &[]).is_none());
        let one = &palettes[1];
        assert_eq!((&mut &*one).palette(9), one);
        let mut none = PaletteTable::new(&palettes[2..], &[]).unwrap();
        assert_eq!(none.palette(7), &palettes[2]);
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
