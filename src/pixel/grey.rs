//! Eight-bit grey, and one bit a pixel made of finished grey lines: for e-paper and OLED (K12).
//!
//! Grey is a pixel format: a byte a pixel, `(77 R + 150 G + 29 B + 128) >> 8`, the weights of the
//! eye (ITU-R BT.601) in 2^-8. One bit is not: a pixel would share its byte with seven others
//! that spans are drawn over. So lines are drawn in grey and packed when they are sent, by rows
//! ([`mono_row`], e-paper and most memory LCDs) or by pages of 8 lines ([`mono_page`], SSD1306
//! and its like). A transfer of 8 lines has what a page needs.

use super::mix::Mix;
use super::mix_bytes::mix_bytes;
use super::{MadeOf, PixelFormat};

/// One byte, 0 black to 255 white.
#[derive(Clone, Copy, Debug)]
pub struct Grey8;

/// Weights of red, green and blue; their sum is 256.
const WEIGHTS: [u32; 3] = [77, 150, 29];

impl PixelFormat for Grey8 {
    type Word = u8;
    const STEPS: [u16; 3] = [255; 3];
    const MADE_OF: MadeOf = MadeOf::TwoWords;

    #[inline(always)]
    fn pack(steps: [u8; 3]) -> u8 {
        let [r, g, b] = steps.map(u32::from);
        // At most 255 as all three are.
        ((WEIGHTS[0] * r + WEIGHTS[1] * g + WEIGHTS[2] * b + 128) >> 8) as u8
    }

    #[inline(always)]
    fn add(a: u8, b: u8) -> u8 {
        a.saturating_add(b)
    }

    fn mix(old: &mut [u8], new: &[u8], mix: Mix) {
        mix_bytes(old, new, mix);
    }

    fn to_rgb8(word: u8) -> [u8; 3] {
        [word; 3]
    }

    #[inline(always)]
    fn widen(word: u8) -> [u32; 2] {
        [word.into(), 0]
    }

    #[inline(always)]
    fn narrow([grey, _]: [u32; 2]) -> u8 {
        ((grey + 8) >> 4) as u8
    }
}

/// The levels above which pixels of an 8x8 tile are white, by line and column: 64 of them, 4
/// apart, in the recursive order.
const LEVELS: [[u8; 8]; 8] = {
    let mut levels = [[0; 8]; 8];
    let mut i = 0;
    while i < 64 {
        let (x, y) = (i % 8, i / 8);
        // The bits of `x ^ y` and `y` interleaved, lowest first.
        let (mut rank, mut bit) = (0, 0);
        while bit < 3 {
            rank = rank << 2 | ((x ^ y) >> bit & 1) << 1 | y >> bit & 1;
            bit += 1;
        }
        levels[y][x] = (4 * rank + 1) as u8;
        i += 1;
    }
    levels
};

/// Whether the pixel at this column and line is white: level 0 never is, 255 always.
#[inline(always)]
fn is_white(grey: u8, column: usize, line: u16) -> bool {
    grey > LEVELS[usize::from(line % 8)][column % 8]
}

/// Packs `line` of a picture in grey, 8 pixels a byte, the leftmost in the highest bit; 1 is
/// white. Dithered with 64 levels in tiles of 8x8.
///
/// Pixels beyond `out`, and bits of `out` beyond the line, are left out: the latter become 0.
pub fn mono_row(grey: &[u8], line: u16, out: &mut [u8]) {
    out.fill(0);
    for (byte, eight) in out.iter_mut().zip(grey.chunks(8)) {
        for (column, grey) in eight.iter().enumerate() {
            *byte |= u8::from(is_white(*grey, column, line)) << (7 - column);
        }
    }
}

/// Packs up to 8 lines of `width` grey pixels each, the first of them `line` of the picture, into
/// one page: a byte a column, the uppermost line in the lowest bit; 1 is white. Dithered as
/// [`mono_row`].
///
/// Columns beyond `out`, and lines beyond the eighth, are left out; lines that `grey` does not
/// have are black.
pub fn mono_page(grey: &[u8], width: usize, line: u16, out: &mut [u8]) {
    let count = width.min(out.len());
    let out = &mut out[..count];
    out.fill(0);
    for (row, bit) in grey.chunks_exact(width.max(1)).zip(0..8) {
        let line = line.wrapping_add(bit);
        for (column, (byte, grey)) in out.iter_mut().zip(row).enumerate() {
            *byte |= u8::from(is_white(*grey, column, line)) << bit;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::{vec, vec::Vec};

    #[test]
    fn grey_is_the_weighted_mean() {
        let mut worst = 0.0f64;
        for r in (0..=255u8).step_by(5) {
            for g in (0..=255u8).step_by(3) {
                for b in 0..=255u8 {
                    let exact = 0.299 * f64::from(r) + 0.587 * f64::from(g) + 0.114 * f64::from(b);
                    worst = worst.max((f64::from(Grey8::pack([r, g, b])) - exact).abs());
                    let rb = u32::from(r) << 24 | u32::from(b) << 8 | 0x00AA_00BB;
                    let word = Grey8::pack_words(rb, u32::from(g) << 24 | 0x12_3456);
                    assert_eq!(word, Grey8::pack([r, g, b]));
                }
            }
        }
        // Half a level of rounding, and 255 (77 / 256 - 0.299) of the weights.
        assert!(worst < 0.5 + 0.4541, "{worst}");
        for level in 0..=255 {
            assert_eq!(Grey8::from_rgb8([level; 3]), level);
        }
    }

    /// Kills: bytes beyond a line that keep what they were, and columns that a page of none has.
    #[test]
    fn what_is_beyond_a_line_is_as_it_is_said() {
        let mut out = [0xFF; 3];
        mono_row(&[0; 8], 0, &mut out);
        assert_eq!(out, [0; 3]);
        let mut out = [0x5A; 2];
        mono_page(&[255; 9], 0, 0, &mut out);
        assert_eq!(out, [0x5A; 2]);
    }

    #[test]
    fn a_tile_has_as_many_white_pixels_as_its_grey_asks() {
        for grey in 0..=255u8 {
            let white: u32 = (0..8)
                .map(|line| {
                    let mut out = [0];
                    mono_row(&[grey; 8], line, &mut out);
                    out[0].count_ones()
                })
                .sum();
            let exact = f64::from(grey) * 64.0 / 255.0;
            assert!((f64::from(white) - exact).abs() <= 1.0, "{grey}: {white}");
        }
        assert_eq!(
            LEVELS
                .as_flattened()
                .iter()
                .collect::<std::collections::BTreeSet<_>>()
                .len(),
            64
        );
    }

    #[test]
    fn rows_and_pages_hold_the_same_pixels() {
        let mut seed = 7u32;
        for (width, lines) in [(128, 8), (13, 8), (1, 3), (250, 5)] {
            let grey: Vec<u8> = (0..width * lines)
                .map(|_| {
                    seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    (seed >> 24) as u8
                })
                .collect();
            let first = 16;
            let mut page = vec![0xFF; width];
            mono_page(&grey, width, first, &mut page);
            for (y, row) in grey.chunks(width).enumerate() {
                let mut bytes = vec![0xFF; width.div_ceil(8)];
                mono_row(row, first + y as u16, &mut bytes);
                for x in 0..width {
                    let in_row = bytes[x / 8] >> (7 - x % 8) & 1;
                    assert_eq!(in_row, page[x] >> y & 1, "{x} {y}");
                }
                // Nothing beyond the last column.
                let over = 8 * bytes.len() - width;
                assert_eq!(bytes[bytes.len() - 1] & ((1 << over) - 1), 0);
            }
            assert!(page.iter().all(|byte| u32::from(*byte) >> lines == 0));
        }
    }

    #[test]
    fn any_lengths_do() {
        let mut out = [0xFF; 4];
        mono_row(&[], 0, &mut out);
        mono_row(&[255; 100], 9, &mut out);
        assert_eq!(out, [0xFF; 4]);
        mono_page(&[255; 100], 0, 0, &mut out);
        mono_page(&[255; 30], 3, u16::MAX - 2, &mut out);
        mono_page(&[], 9, 0, &mut []);
    }
}
