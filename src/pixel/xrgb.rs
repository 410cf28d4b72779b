//! Eight bits a channel in a 32-bit word, for frame buffers and parallel panels (H10).

use super::mix::Mix;
use super::mix_bytes::mix_bytes;
use super::{MadeOf, PixelFormat};

/// Red in bits 23..16, green in 15..8, blue in 7..0; the upper 8 bits are 0.
#[derive(Clone, Copy, Debug)]
pub struct Xrgb8888;

impl PixelFormat for Xrgb8888 {
    type Word = u32;
    const STEPS: [u16; 3] = [255; 3];
    const MADE_OF: MadeOf = MadeOf::TwoWords;

    #[inline(always)]
    fn pack([r, g, b]: [u8; 3]) -> u32 {
        u32::from_be_bytes([0, r, g, b])
    }

    #[inline(always)]
    fn pack_words(red_blue: u32, green: u32) -> u32 {
        red_blue >> 8 & 0x00FF_00FF | green >> 16 & 0xFF00
    }

    fn mix(old: &mut [u32], new: &[u32], mix: Mix) {
        let (old, new) = (bytemuck::cast_slice_mut(old), bytemuck::cast_slice(new));
        mix_bytes(old, new, mix);
    }

    fn to_rgb8(word: u32) -> [u8; 3] {
        let [_, r, g, b] = word.to_be_bytes();
        [r, g, b]
    }

    #[inline(always)]
    fn widen(word: u32) -> [u32; 2] {
        [word & 0xFF_00FF, word >> 8 & 0xFF]
    }

    #[inline(always)]
    fn narrow([red_blue, green]: [u32; 2]) -> u32 {
        (red_blue + 0x8_0008) >> 4 & 0xFF_00FF | (green + 8) << 4 & 0xFF00
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pixel::Rgb888;

    #[test]
    fn words_hold_what_bytes_hold() {
        for step in 0..=255u32 {
            let [r, g, b] = [step, 255 - step, step.wrapping_mul(37) & 0xFF];
            let (red_blue, green) = (r << 24 | 0x77 << 16 | b << 8 | 0x99, g << 24 | 0x5555);
            let word = Xrgb8888::pack_words(red_blue, green);
            assert_eq!(word, r << 16 | g << 8 | b);
            assert_eq!(Xrgb8888::to_rgb8(word), Rgb888::pack_words(red_blue, green));
            let rgb = [r as u8, g as u8, b as u8];
            assert_eq!(Xrgb8888::from_rgb8(rgb), word);
        }
    }
}
