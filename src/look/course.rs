//! A colour along a span, and a span in parts of 16 pixels, at whose beginnings its colour is reckoned anew.

use super::Place;
use super::ramp::{self, Packed, Pair};
use crate::pixel::PixelFormat;

/// A colour along a span: red, green and blue with 20, 20 and 21 bits below a field's unit, their steps to the next
/// pixel, and these in one word.
#[derive(Clone, Copy)]
pub(super) struct Course {
    pub(super) value: [u32; 3],
    pub(super) step: [i32; 3],
    pub(super) packed: u32,
}

impl Course {
    /// The colour here, without a step.
    #[inline(always)]
    pub(super) fn still(&self) -> Self {
        Self {
            step: [0; 3],
            ..*self
        }
    }

    /// So many pixels on.
    #[inline(always)]
    pub(super) fn skip(&mut self, pixels: u32) {
        for (value, step) in self.value.iter_mut().zip(self.step) {
            *value = value.wrapping_add((step as u32).wrapping_mul(pixels));
        }
    }

    /// On by such a step.
    #[inline(always)]
    pub(super) fn advance(&mut self, step: [u32; 3]) {
        for (value, step) in self.value.iter_mut().zip(step) {
            *value = value.wrapping_add(step);
        }
    }

    /// Whether the colour does not step.
    #[inline(always)]
    pub(super) fn is_even(&self) -> bool {
        self.step[0] | self.step[1] | self.step[2] == 0
    }

    /// The pixel of a colour that does not step.
    #[inline(always)]
    pub(super) fn even<F: PixelFormat>(&self) -> F::Word {
        if F::MADE_OF.is_one_word() {
            return F::of_word(self.packed(0).word);
        }
        let [at, _] = self.pair(0);
        F::pack_words(at.red_blue, at.green)
    }

    /// The word of colour so many pixels on from an anchor.
    #[inline(always)]
    pub(super) fn packed(&self, off: u32) -> Packed {
        let [red, green, blue] = self.value;
        let word = red << 1 & 0xFFE0_0000 | blue >> 10 & 0x001F_F800 | green >> 20 & 0x7FF;
        Packed {
            word: word.wrapping_add(self.packed.wrapping_mul(off)),
            step: self.packed,
        }
    }

    /// The pair of words so many pixels on from an anchor, and their steps.
    #[inline(always)]
    pub(super) fn pair(&self, off: u32) -> [Pair; 2] {
        let [red, green, blue] = self.value;
        let rounded = self.step.map(|s| (s + (1 << 14)) >> 15);
        let join = |high: i32, low: i32| ((high << 16) as u32).wrapping_add(low as u32);
        let step = Pair {
            red_blue: join(rounded[0], rounded[2]),
            green: (rounded[1] << 16) as u32,
        };
        let at = Pair {
            red_blue: red << 1 & 0xFFFF_0000 | blue >> 15 & 0xFFFF,
            green: green << 1 & 0xFFFF_0000,
        };
        let on = Pair {
            red_blue: step.red_blue.wrapping_mul(off),
            green: step.green.wrapping_mul(off),
        };
        [at.plus(on), step]
    }
}

/// The last pixel at or before a place that is a multiple of 16 from its span's first one, and how many pixels lie
/// between.
#[inline(always)]
pub(super) fn anchor(place: Place) -> (Place, u32) {
    let off = place.skipped() & 15;
    let column = place.column.wrapping_sub(off);
    (Place { column, ..place }, off)
}

/// Calls `f` with each part of a run between two anchors, of which the first is `off` pixels before the run: with its
/// pixels, and how many lie between it and its anchor.
#[inline(always)]
pub(super) fn each_part<W>(run: &mut [W], mut off: u32, mut f: impl FnMut(&mut [W], u32)) {
    let mut rest = run;
    while !rest.is_empty() {
        let pixels = rest.len().min(16 - off as usize);
        let (part, after) = rest.split_at_mut(pixels);
        f(part, off);
        (rest, off) = (after, 0);
    }
}

/// [`each_part`] by colours in one word: `next` is asked for each anchor's, so many pixels on.
#[inline(always)]
pub(super) fn each_packed<F: PixelFormat>(
    run: &mut [F::Word],
    off: u32,
    mut next: impl FnMut(u32) -> Packed,
) {
    let pixels = if off == 0 { 0 } else { 16 - off as usize };
    let (first, rest) = run.split_at_mut(pixels.min(run.len()));
    if !first.is_empty() {
        ramp::fill::<F>(first, next(off));
    }
    let mut parts = rest.chunks_exact_mut(16);
    for part in parts.by_ref() {
        if let Ok(part) = <&mut [F::Word; 16]>::try_from(part) {
            ramp::fill_sixteen::<F>(part, next(0));
        }
    }
    let last = parts.into_remainder();
    if !last.is_empty() {
        ramp::fill::<F>(last, next(0));
    }
}
