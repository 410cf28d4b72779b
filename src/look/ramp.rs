//! The loops over pixels (B).
//!
//! Runs of up to 16 pixels are straight code, entered behind a jump by length as far from its end as there are pixels:
//! 4 instructions a pixel on a Cortex-M4, 5 where the bytes are swapped, and some 20 for the call; longer ones go in
//! chunks of 8 without an end test, 5 a pixel. `black_box`, once a chunk, keeps loops from being unrolled and their
//! steps from being multiplied out.

use crate::pixel::PixelFormat;
use core::hint::black_box;

/// A colour in one word that steps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Packed {
    pub(super) word: u32,
    pub(super) step: u32,
}

/// A colour with 16 bits a channel, or its step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Pair {
    /// Red above blue. Of a step, the sum `(red << 16) + blue` of numbers with signs.
    pub red_blue: u32,
    /// Green above 0.
    pub green: u32,
}

impl Pair {
    /// The masks of red and of blue: their bits that a word of colour has.
    pub(super) const FIELDS: [u32; 2] = [0xFFE0_0000, 0xFFC0];

    /// The upper bits of the fields, in one word of colour. The masks are always [`FIELDS`](Self::FIELDS): who hides them
    /// from the compiler keeps them in registers.
    #[inline(always)]
    pub(super) fn word(self, [red, blue]: [u32; 2]) -> u32 {
        self.red_blue & red | (self.red_blue & blue) << 5 | self.green >> 21
    }

    /// The pixel of the colour.
    #[inline(always)]
    pub(super) fn pixel<F: PixelFormat>(self) -> F::Word {
        F::pack_words(self.red_blue, self.green)
    }

    #[inline(always)]
    pub(super) const fn new(red_blue: u32, green: u32) -> Self {
        Self { red_blue, green }
    }

    /// Of red, green and blue; of a step these have signs.
    #[inline(always)]
    pub(super) const fn of([red, green, blue]: [i32; 3]) -> Self {
        let red_blue = ((red << 16) as u32).wrapping_add(blue as u32);
        Self::new(red_blue, (green << 16) as u32)
    }

    /// Red, green and blue of a step.
    #[inline(always)]
    pub(super) const fn parts(self) -> [i32; 3] {
        let blue = self.red_blue as i16 as i32;
        let red = self.red_blue.wrapping_sub(blue as u32) as i32 >> 16;
        [red, self.green as i32 >> 16, blue]
    }

    /// Whether a step is none.
    #[inline(always)]
    pub(super) const fn is_none(self) -> bool {
        self.red_blue | self.green == 0
    }

    /// The colour that is `step` further on.
    #[inline(always)]
    pub(super) const fn plus(self, step: Self) -> Self {
        let red_blue = self.red_blue.wrapping_add(step.red_blue);
        let green = self.green.wrapping_add(step.green);
        Self { red_blue, green }
    }

    /// The colour that is `step` back.
    #[inline(always)]
    pub(super) const fn minus(self, step: Self) -> Self {
        let red_blue = self.red_blue.wrapping_sub(step.red_blue);
        let green = self.green.wrapping_sub(step.green);
        Self { red_blue, green }
    }

    /// So many times this step.
    #[inline(always)]
    pub(super) const fn times(self, pixels: u32) -> Self {
        let red_blue = self.red_blue.wrapping_mul(pixels);
        let green = self.green.wrapping_mul(pixels);
        Self { red_blue, green }
    }
}

/// Adds so many steps to what has three parts.
#[inline(always)]
pub(super) fn go_on(value: &mut [u32; 3], step: [u32; 3], steps: u32) {
    for (value, step) in value.iter_mut().zip(step) {
        *value = value.wrapping_add(step.wrapping_mul(steps));
    }
}

/// A jump into straight code: to the label of a number, where what stands there is done and then all that stands
/// after it.
macro_rules! fall {
    ($put:ident, $to:ident: $([$label:lifetime $k:literal])*) => {
        fall!($put, { match $to { $($k => break $label,)* _ => return } } $([$label $k])*)
    };
    ($put:ident, $jump:block) => { $jump };
    ($put:ident, $jump:block [$label:lifetime $k:literal] $($rest:tt)*) => {
        fall!($put, { $label: { $jump } $put($k); } $($rest)*)
    };
}

/// Colours a run: short ones in straight code from the last pixel to the first. One copy for all: it needs no register
/// that a caller keeps.
#[inline(never)]
pub(super) fn fill<F: PixelFormat>(run: &mut [F::Word], ramp: Packed) {
    // None, which wraps, is as rare as more than 16.
    let last = (run.len() as u32).wrapping_sub(1);
    if last >= 16 {
        return fill_long::<F>(run, ramp);
    }
    let way = ramp.step.wrapping_mul(last);
    let mut word = ramp.word.wrapping_add(way);
    let mut put = |k: usize| {
        if let Some(pixel) = run.get_mut(k) {
            *pixel = F::of_word(word);
        }
        word = word.wrapping_sub(ramp.step);
    };
    fall!(put, last: ['p 15] ['o 14] ['n 13] ['m 12] ['l 11] ['k 10] ['j 9] ['i 8] ['h 7] ['g 6] ['f 5] ['e 4] ['d 3]
        ['c 2] ['b 1] ['a 0]);
}

/// Colours 16 pixels, as [`fill`] does, without a jump: code of a loop, but where there are 8 registers.
#[cfg_attr(short_multiply, inline(never))]
#[cfg_attr(not(short_multiply), inline(always))]
pub(super) fn fill_sixteen<F: PixelFormat>(run: &mut [F::Word; 16], mut ramp: Packed) {
    fill_chunk::<F, 16>(run, &mut ramp);
}

/// Colours a run of any length, which may be of one colour.
#[inline(never)]
fn fill_long<F: PixelFormat>(run: &mut [F::Word], mut ramp: Packed) {
    if ramp.step == 0 {
        return fill_even::<F>(run, F::of_word(ramp.word));
    }
    let step = ramp.step;
    let mut chunks = run.chunks_exact_mut(8);
    for chunk in chunks.by_ref() {
        ramp.step = black_box(step);
        if let Ok(chunk) = <&mut [F::Word; 8]>::try_from(chunk) {
            fill_chunk::<F, 8>(chunk, &mut ramp);
        }
    }
    let rest = chunks.into_remainder();
    if !rest.is_empty() {
        fill::<F>(rest, Packed { step, ..ramp });
    }
}

/// A run of one colour: one copy of the loop.
#[inline(never)]
pub(crate) fn fill_even<F: PixelFormat>(run: &mut [F::Word], word: F::Word) {
    F::fill(run, word);
}

/// Colours an even number of pixels in straight code.
#[inline(always)]
fn fill_chunk<F: PixelFormat, const N: usize>(run: &mut [F::Word; N], ramp: &mut Packed) {
    for two in run.chunks_exact_mut(2) {
        let next = ramp.word.wrapping_add(ramp.step);
        if let [a, b] = two {
            F::set_two([a, b], [ramp.word, next]);
        }
        ramp.word = next.wrapping_add(ramp.step);
    }
}

/// Colours a run by a pair, pixel by pixel.
#[inline(never)]
pub(super) fn fill_pair<F: PixelFormat>(run: &mut [F::Word], mut at: Pair, step: Pair) {
    for pixel in run {
        *pixel = at.pixel::<F>();
        at = at.plus(step);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::random::Rng;
    use crate::pixel::{Rgb565, Rgb565Be, Rgb888};

    /// Runs of any length and alignment, of colours that step or do not, with nothing beside them.
    fn runs_are_pixels_one_by_one<F: PixelFormat<Word: PartialEq + core::fmt::Debug>>() {
        let mut rng = Rng(21);
        for round in 0..2000 {
            let (from, pixels) = (rng.below(3) as usize, round % 45);
            let step = if round % 7 == 0 { 0 } else { rng.bits() };
            let ramp = Packed {
                word: rng.bits(),
                step,
            };
            let beside = F::from_rgb8([1, 200, 3]);
            let mut line = [beside; 50];
            fill::<F>(&mut line[from..from + pixels], ramp);
            for (i, &got) in line.iter().enumerate() {
                let k = i.wrapping_sub(from);
                let word = ramp.word.wrapping_add(step.wrapping_mul(k as u32));
                let want = if k < pixels { F::of_word(word) } else { beside };
                assert_eq!(got, want, "{i} of {from} and {pixels}");
            }
        }
    }

    #[test]
    fn straight_code_and_loops_give_the_pixels_of_their_words() {
        runs_are_pixels_one_by_one::<Rgb565>();
        runs_are_pixels_one_by_one::<Rgb565Be>();
        runs_are_pixels_one_by_one::<Rgb888>();
    }
}
