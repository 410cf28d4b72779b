//! Ordered 4x4 dither to few bits a channel, and cutting instead of rounding (H10, K12).
//!
//! [`Dithered`] wraps a pixel format: planes, light and texels have 8 bits a channel then, 248 or
//! 252 steps of which 8 or 4 make one step of the output, and a pixel is `floor(value +
//! threshold)`, the threshold being that of its column and line modulo 4. What is not dithered
//! pays nothing: thresholds of other formats are never looked at, and fold away.
//!
//! The mean over an aligned 4x4 block of one colour is that colour to 1/32 of a step (green of
//! 565: 1/16) plus the rounding of its 8 bits, and no pixel is a whole step off. A threshold lies
//! a quarter of an inner step or more within the field, so planes that err by less than that can
//! neither wrap nor leave the range (P4).
//!
//! Spans are stepped by their planes as they are, whatever the interpolation chosen: to dither
//! colours that are shared by pixels would give the blocks back that it is to hide.

use super::PixelFormat;
use super::course::{Course, Wide, Words};
use super::ramp::TwoWords;
use crate::shade::{Precision, Stretch};
use crate::visible::Visible;
use core::marker::PhantomData;

/// What is added to a colour before it is cut: red and blue, and green in the upper half, 16 bits
/// a channel, in place of the half step that colours carry.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Threshold {
    red_blue: u32,
    green: u32,
}

/// The order in which pixels of a 4x4 tile take the next step, 0 to 15: line, then column.
pub trait Ranks {
    /// Pixels of low rank step up last.
    const RANKS: [[u8; 4]; 4];
}

/// The recursive order: each 2x2 block, line and diagonal has ranks from all quarters.
#[derive(Clone, Copy, Debug)]
pub struct Ordered;

impl Ranks for Ordered {
    const RANKS: [[u8; 4]; 4] = [[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]];
}

/// No pixel steps up early: what is below a step is cut off, but for a quarter of an inner step,
/// which is 1/32 of a step of 5 bits, 1/16 of 6 and 1/4 of 8.
#[derive(Clone, Copy, Debug)]
pub struct CutOff;

impl Ranks for CutOff {
    const RANKS: [[u8; 4]; 4] = [[0; 4]; 4];
}

/// The format `F`, dithered in the order `R`; see the head of the file for what it keeps to.
///
/// The tile is fixed to the picture's middle, so the pattern stays where it is whatever moves.
/// Texels whose D bit is set, and backgrounds, are rounded. A face of one colour is dithered too.
#[derive(Clone, Copy, Debug)]
pub struct Dithered<F, R = Ordered>(PhantomData<(F, R)>);

/// The format `F`, with colours cut to its steps instead of rounded.
pub type Cut<F> = Dithered<F, CutOff>;

/// Half of an inner step, of 2^16: what colours carry for rounding.
const HALF: u32 = 128;

/// Two channels in a word, whatever the sign of the lower.
const fn pair(high: u32, low: u32) -> u32 {
    (high << 16).wrapping_add(low)
}

/// Inner steps that make one step of a format with so many steps a channel.
const fn inner(steps: u16) -> u16 {
    1 << (steps.leading_zeros() - 8)
}

/// The threshold of a rank for a channel with so many steps, instead of [`HALF`].
///
/// At most 16 levels, and none nearer to another than half an inner step.
const fn channel(rank: u8, steps: u16) -> u32 {
    let step = 1 << steps.leading_zeros();
    let levels = if step / HALF < 16 { step / HALF } else { 16 };
    let level = rank as u32 * levels / 16;
    (step / levels * level + step / levels / 2).wrapping_sub(HALF)
}

impl<F: PixelFormat, R: Ranks> Dithered<F, R> {
    const INNER: [u16; 3] = [inner(F::STEPS[0]), inner(F::STEPS[1]), inner(F::STEPS[2])];

    /// Four thresholds from each place of the tile on.
    const ROWS: [[Threshold; 7]; 4] = {
        let mut rows = [[Self::threshold(0); 7]; 4];
        let mut i = 0;
        while i < 28 {
            rows[i / 7][i % 7] = Self::threshold(R::RANKS[i / 7][i % 7 % 4]);
            i += 1;
        }
        rows
    };

    const fn threshold(rank: u8) -> Threshold {
        Threshold {
            red_blue: pair(channel(rank, F::STEPS[0]), channel(rank, F::STEPS[2])),
            green: channel(rank, F::STEPS[1]) << 16,
        }
    }

    /// Rounds to the nearest step.
    const NEAREST: Threshold = Threshold {
        red_blue: pair(nearest(F::STEPS[0]), nearest(F::STEPS[2])),
        green: nearest(F::STEPS[1]) << 16,
    };
}

/// Half a step of the output instead of [`HALF`].
const fn nearest(steps: u16) -> u32 {
    (1 << steps.leading_zeros() >> 1) - HALF
}

impl<F: PixelFormat, R: Ranks> PixelFormat for Dithered<F, R> {
    type Word = F::Word;
    const STEPS: [u16; 3] = [
        F::STEPS[0] * Self::INNER[0],
        F::STEPS[1] * Self::INNER[1],
        F::STEPS[2] * Self::INNER[2],
    ];
    const PRECISION: Precision = Precision { unit: 1, drift: 1 };
    const CUTS: bool = false;
    const DITHERS: bool = true;

    #[inline]
    fn pack(steps: [u8; 3]) -> F::Word {
        Self::pack_at(steps, Self::NEAREST)
    }

    #[inline(always)]
    fn pack_words(red_blue: u32, green: u32) -> F::Word {
        Self::pack_words_at(red_blue, green, Self::NEAREST)
    }

    #[inline(always)]
    fn thresholds((column, line): (u8, u8)) -> [Threshold; 4] {
        let row = &Self::ROWS[usize::from(line % 4)];
        let at = usize::from(column % 4);
        [row[at], row[at + 1], row[at + 2], row[at + 3]]
    }

    #[inline(always)]
    fn pack_at([r, g, b]: [u8; 3], threshold: Threshold) -> F::Word {
        let wide = |step: u8| u32::from(step) << 8 | HALF;
        Self::pack_words_at(pair(wide(r), wide(b)), wide(g) << 16, threshold)
    }

    #[inline(always)]
    fn pack_words_at(red_blue: u32, green: u32, threshold: Threshold) -> F::Word {
        F::pack_words(
            red_blue.wrapping_add(threshold.red_blue),
            green.wrapping_add(threshold.green),
        )
    }

    type Ramp = TwoWords;

    const HALVES: bool = F::HALVES;

    #[inline(always)]
    fn to_half(word: F::Word) -> u16 {
        F::to_half(word)
    }

    #[inline(always)]
    fn from_half(half: u16) -> F::Word {
        F::from_half(half)
    }

    #[inline(always)]
    fn fill(pixels: &mut [F::Word], word: F::Word) {
        F::fill(pixels, word);
    }

    #[inline(always)]
    fn add(a: F::Word, b: F::Word) -> F::Word {
        F::add(a, b)
    }

    fn from_rgb8(rgb: [u8; 3]) -> F::Word {
        F::from_rgb8(rgb)
    }

    fn to_rgb8(word: F::Word) -> [u8; 3] {
        F::to_rgb8(word)
    }
}

/// Writes the pixels of a span that are seen, each by its threshold.
#[inline(always)]
pub(super) fn paint<F: PixelFormat>(
    pixels: &mut [F::Word],
    stretch: Stretch,
    visible: &mut impl Visible,
) {
    match stretch {
        Stretch::Constant(steps) => flat::<F>(pixels, steps, visible),
        Stretch::Packed {
            red_blue,
            green,
            steps,
            field_step,
        } => {
            let course = Words {
                red_blue,
                green,
                steps,
                field_step,
            };
            smooth::<F, _>(pixels, course, visible);
        }
        Stretch::Channels(at, step) => smooth::<F, _>(pixels, Wide::new::<F>(at, step), visible),
    }
}

/// One colour: four pixels, again and again.
#[inline(never)]
fn flat<F: PixelFormat>(pixels: &mut [F::Word], steps: [u8; 3], visible: &mut impl Visible) {
    let words = F::thresholds(visible.tile()).map(|threshold| F::pack_at(steps, threshold));
    let mut fours = pixels.chunks_exact_mut(4);
    for four in fours.by_ref().filter_map(|four| four.try_into().ok()) {
        let four: &mut [F::Word; 4] = four;
        let mut next = words.iter();
        visible.block(four, |pixel, shown| {
            if let (Some(word), true) = (next.next(), shown) {
                *pixel = *word;
            }
        });
    }
    let mut next = words.iter();
    visible.each(fours.into_remainder(), |pixel, shown| {
        if let (Some(word), true) = (next.next(), shown) {
            *pixel = *word;
        }
    });
}

/// Colours stepped from pixel to pixel.
#[inline(never)]
fn smooth<F: PixelFormat, C: Course>(
    pixels: &mut [F::Word],
    mut course: C,
    visible: &mut impl Visible,
) {
    let thresholds = F::thresholds(visible.tile());
    let mut next = |pixel: &mut F::Word, shown: bool, threshold: Threshold| {
        if shown {
            let (red_blue, green) = course.words();
            *pixel = F::pack_words_at(red_blue, green, threshold);
        }
        course.advance(1);
    };
    let mut fours = pixels.chunks_exact_mut(4);
    for four in fours.by_ref().filter_map(|four| four.try_into().ok()) {
        let four: &mut [F::Word; 4] = four;
        let mut place = 0;
        visible.block(four, |pixel, shown| {
            next(pixel, shown, thresholds[place % 4]);
            place += 1;
        });
    }
    let mut place = 0;
    visible.each(fours.into_remainder(), |pixel, shown| {
        next(pixel, shown, thresholds[place % 4]);
        place += 1;
    });
}

#[cfg(test)]
mod tests {
    use super::super::{Rgb565, Rgb888};
    use super::*;
    use crate::visible::{Everywhere, Placed};
    use std::{vec, vec::Vec};

    /// Columns and lines of a block, drawn from `from` on.
    fn block<F: PixelFormat>(stretch: Stretch, from: i32, pixels: usize) -> Vec<Vec<F::Word>> {
        (0..4)
            .map(|line| {
                let mut row = vec![F::Word::default(); pixels];
                let mut everywhere = Everywhere;
                paint::<F>(
                    &mut row,
                    stretch,
                    &mut Placed::new(&mut everywhere, from, line),
                );
                row
            })
            .collect()
    }

    fn channels(word: u16) -> [f64; 3] {
        [word >> 11, word >> 5 & 63, word & 31].map(f64::from)
    }

    type Fine = Dithered<Rgb565>;

    #[test]
    fn the_mean_of_a_tile_is_the_colour_and_no_pixel_a_step_off() {
        // Exhaustive over inner steps of one channel at a time, from every column.
        for step in 0..=252u8 {
            let steps = [step.min(248), step, 248 - step.min(248)];
            for from in 0..4 {
                let rows = block::<Fine>(Stretch::Constant(steps), from, 4);
                for i in 0..3 {
                    let exact = f64::from(steps[i]) / f64::from(Fine::STEPS[i] / Rgb565::STEPS[i]);
                    let all = rows.iter().flatten().map(|word| channels(*word)[i]);
                    assert!(
                        all.clone().all(|got| (got - exact).abs() < 1.0),
                        "{steps:?}"
                    );
                    let mean = all.sum::<f64>() / 16.0;
                    // The thresholds are fine enough that inner steps come out exactly.
                    assert!((mean - exact).abs() < 1e-9, "{steps:?}: {mean} {exact}");
                }
            }
        }
    }

    #[test]
    fn slopes_keep_to_the_bound() {
        let mut seed = 1u64;
        let mut below = |n: u64| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (seed >> 33) % n
        };
        for _ in 0..20_000 {
            let pixels = 1 + below(64) as usize;
            let (mut at, mut step) = ([0; 3], [0; 3]);
            for i in 0..3 {
                let range = i64::from(Fine::STEPS[i]) << 16;
                let (a, b) = (
                    below(range as u64 + 1) as i64,
                    below(range as u64 + 1) as i64,
                );
                at[i] = a as i32 + (1 << 15);
                step[i] = ((b - a) / (pixels as i64 - 1).max(1)) as i32;
            }
            let from = below(4) as i32;
            let rows = block::<Fine>(Stretch::Channels(at, step), from, pixels);
            for i in 0..3 {
                let parts = f64::from(Fine::STEPS[i] / Rgb565::STEPS[i]) * 65536.0;
                for x in 0..pixels {
                    let units = i64::from(at[i]) - (1 << 15) + i64::from(step[i]) * x as i64;
                    let exact = units as f64 / parts;
                    let got: Vec<f64> = rows.iter().map(|row| channels(row[x])[i]).collect();
                    // What is cut of 16 bits counts as well.
                    assert!(
                        got.iter()
                            .all(|got| (got - exact).abs() < 1.0 + 1.0 / 512.0)
                    );
                    assert!(
                        got.iter()
                            .all(|got| (0.0..=f64::from(Rgb565::STEPS[i])).contains(got))
                    );
                }
            }
        }
    }

    #[test]
    fn even_colours_between_steps_have_the_right_mean() {
        for units in (0..248 << 16).step_by(977) {
            let at = [units + (1 << 15); 3];
            let rows = block::<Fine>(Stretch::Channels(at, [0; 3]), 0, 4);
            for (i, bound) in [(0, 1.0 / 32.0), (1, 1.0 / 16.0), (2, 1.0 / 32.0)] {
                let parts = f64::from(Fine::STEPS[i] / Rgb565::STEPS[i]) * 65536.0;
                let exact = f64::from(units) / parts;
                let mean = rows.iter().flatten().map(|w| channels(*w)[i]).sum::<f64>() / 16.0;
                assert!(
                    (mean - exact).abs() <= bound + 1.0 / 512.0,
                    "{units}: {mean} {exact}"
                );
            }
        }
    }

    #[test]
    fn a_span_cut_in_two_has_the_same_pixels() {
        let stretch = |x: i32| Stretch::Channels([40_000 + 9_000 * x; 3], [9_000; 3]);
        let whole = block::<Fine>(stretch(0), 5, 40);
        for cut in 1..40 {
            let left = block::<Fine>(stretch(0), 5, cut);
            let right = block::<Fine>(stretch(cut as i32), 5 + cut as i32, 40 - cut);
            for line in 0..4 {
                assert_eq!([&left[line][..], &right[line]].concat(), whole[line]);
            }
        }
    }

    #[test]
    fn cutting_goes_down_and_rounding_to_nearest() {
        type Down = Cut<Rgb565>;
        for step in 0..=248u8 {
            let down = block::<Down>(Stretch::Constant([step; 3]), 0, 4);
            let all: Vec<u16> = down.concat();
            assert!(all.iter().all(|word| *word == all[0]));
            assert_eq!(channels(all[0])[0], f64::from(step / 8));
            assert_eq!(channels(all[0])[1], f64::from(step / 4));
            assert_eq!(
                channels(Down::pack([step; 3]))[0],
                f64::from((step + 4) / 8)
            );
        }
        // Eight bits are cut as well: what is below a level is gone, not rounded.
        let at = [(7 << 16) + (1 << 15) + 48_000; 3];
        let row = block::<Cut<Rgb888>>(Stretch::Channels(at, [0; 3]), 0, 1);
        assert_eq!(row[0][0], [7; 3]);
    }
}
