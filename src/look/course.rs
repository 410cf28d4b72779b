//! A colour along a span, and a span in parts of 16 pixels, at whose beginnings its colour is reckoned anew.

use super::ramp::{self, Packed, Pair};
use crate::num::rolled;
use crate::pixel::PixelFormat;
use core::hint::black_box;

/// A colour along a span: red, green and blue with 20, 20 and 21 bits below a field's unit, their steps to the next
/// pixel, and these in one word.
#[derive(Clone, Copy)]
pub(super) struct Course {
    pub(super) value: [u32; 3],
    pub(super) step: [i32; 3],
    pub(super) packed: u32,
}

impl Course {
    /// So many pixels on.
    #[inline(always)]
    pub(super) fn skip(&mut self, pixels: u32) {
        ramp::go_on(&mut self.value, self.step.map(|step| step as u32), pixels);
    }

    /// Whether the colour does not step.
    #[inline(always)]
    pub(super) fn is_even(&self) -> bool {
        self.step[0] | self.step[1] | self.step[2] == 0
    }

    /// The colour in two words.
    #[inline(always)]
    pub(super) fn pair(&self) -> Pair {
        let [red, green, blue] = self.value;
        let red_blue = red << 1 & 0xFFFF_0000 | blue >> 15 & 0xFFFF;
        Pair::new(red_blue, green << 1 & 0xFFFF_0000)
    }

    /// The step of `2^log` pixels in two words, rounded.
    #[inline(always)]
    pub(super) fn pair_step(&self, log: u32) -> Pair {
        let rounded = |step: i32| (step << log).wrapping_add(1 << 14) >> 15;
        Pair::of(self.step.map(rounded))
    }

    /// Whether the first of so many pixels and the last keep so much of 2^16 from either end of a channel, and what steps
    /// that are rounded take: 8 in 16 pixels.
    #[inline(always)]
    pub(super) fn keeps(&self, room: [i32; 3], pixels: u32) -> bool {
        let least = room.map(|room| room as u32 + 8);
        let mut last = *self;
        last.skip(pixels.wrapping_sub(1));
        let is_within = |value: u32, least: u32| {
            (value >> 15 & 0xFFFF).wrapping_sub(least) <= 0xFFFF - 2 * least
        };
        let keeps =
            |i: usize| is_within(self.value[i], least[i]) & is_within(last.value[i], least[i]);
        keeps(0) & keeps(1) & keeps(2)
    }

    /// Hands `f` a run that begins so many pixels behind the span's first one, in parts up to each 16th pixel of the span,
    /// with the pair of words at the first of each and their steps.
    #[inline(always)]
    pub(super) fn each_part<W>(
        mut self,
        run: &mut [W],
        skipped: u32,
        mut f: impl FnMut(&mut [W], [Pair; 2]),
    ) {
        self.skip(skipped & !15);
        let (mut rest, mut off) = (run, skipped & 15);
        while !rest.is_empty() {
            let pixels = rest.len().min(16 - off as usize);
            let (part, after) = rest.split_at_mut(pixels);
            let step = self.pair_step(0);
            f(part, [self.pair().plus(step.times(off)), step]);
            self.skip(16);
            (rest, off) = (after, 0);
        }
    }

    /// The colour in parts of 16 pixels, from its span's first pixel on, so many parts further.
    #[inline(always)]
    pub(super) fn in_parts(&self, further: u32) -> InParts {
        let (mut at, mut sixteen) = (self.pair(), self.pair_step(4));
        // Green has the lower half for itself.
        (at.green, sixteen.green) = (self.value[1] << 1, (self.step[1] << 5) as u32);
        InParts::new(at.plus(sixteen.times(further)), sixteen, self.packed)
    }
}

/// A colour at an anchor, its step to the next anchor, and to the next pixel in one word.
///
/// The first two are pairs in one number each, green above red and blue: of two numbers, which the compiler sees through,
/// it would also step the one that is shifted, and run out of registers.
#[derive(Clone, Copy)]
pub(super) struct InParts {
    at: u64,
    sixteen: u64,
    step: u32,
}

impl InParts {
    #[inline(always)]
    pub(super) fn new(at: Pair, mut sixteen: Pair, step: u32) -> Self {
        // Red and blue that go down carry one into green at each step: green steps by one less.
        sixteen.green = sixteen.green.wrapping_sub(sixteen.red_blue >> 31);
        let [at, sixteen] =
            [at, sixteen].map(|pair| u64::from(pair.green) << 32 | u64::from(pair.red_blue));
        Self { at, sixteen, step }
    }

    /// The colour so many pixels behind an anchor, and on to the next one.
    #[inline(always)]
    fn next(&mut self, off: u32, fields: [u32; 2]) -> Packed {
        let Self { at, sixteen, step } = *self;
        self.at = at.wrapping_add(sixteen);
        let word = Pair::new(at as u32, (at >> 32) as u32).word(fields);
        let word = word.wrapping_add(step.wrapping_mul(off));
        Packed { word, step }
    }

    /// Colours a run that begins so many pixels behind an anchor.
    #[inline(always)]
    pub(super) fn fill<F: PixelFormat>(mut self, run: &mut [F::Word], off: u32) {
        if run.len() > 16 - off as usize {
            return self.fill_long::<F>(run, off);
        }
        ramp::fill::<F>(run, self.next(off, Pair::FIELDS));
    }

    /// The same of more than one part.
    #[inline(never)]
    pub(super) fn fill_long<F: PixelFormat>(&self, run: &mut [F::Word], off: u32) {
        // Masks that the compiler knows would be made anew for each part.
        let (mut parts, fields) = (*self, black_box(Pair::FIELDS));
        let pixels = (off.wrapping_neg() & 15) as usize;
        let (first, rest) = run.split_at_mut(pixels.min(run.len()));
        if !first.is_empty() {
            ramp::fill::<F>(first, parts.next(off, fields));
        }
        let mut sixteens = rest.chunks_exact_mut(16);
        for part in sixteens.by_ref() {
            rolled();
            if let Ok(part) = <&mut [F::Word; 16]>::try_from(part) {
                ramp::fill_sixteen::<F>(part, parts.next(0, fields));
            }
        }
        let last = sixteens.into_remainder();
        if !last.is_empty() {
            ramp::fill::<F>(last, parts.next(0, fields));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::random::Rng;

    /// Kills: a step down that carries into green, and parts that are not those of two words.
    #[test]
    fn joined_words_go_on_as_two() {
        let mut rng = Rng(5);
        for _ in 0..2000 {
            let channel = |rng: &mut Rng| (0x8000 + rng.bits() % 0x4000, rng.bits() % 0x201);
            let (red, blue) = (channel(&mut rng), channel(&mut rng));
            let (green, down) = (rng.bits() >> 1, rng.bits() & 3);
            let way = |step: u32, bit: u32| (step ^ bit.wrapping_neg()).wrapping_add(bit);
            let mut at = Pair {
                red_blue: red.0 << 16 | blue.0,
                green,
            };
            let sixteen = Pair {
                red_blue: (way(red.1, down & 1) << 16).wrapping_add(way(blue.1, down >> 1)),
                green: way(rng.bits() % 0x100_0000, rng.bits() & 1),
            };
            let mut parts = InParts::new(at, sixteen, 3);
            for _ in 0..20 {
                let word = at.word(Pair::FIELDS).wrapping_add(6);
                assert_eq!(parts.next(2, Pair::FIELDS).word, word);
                assert_eq!((parts.at >> 32) as u32, at.plus(sixteen).green);
                at = at.plus(sixteen);
            }
        }
    }
}
