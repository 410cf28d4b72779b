//! Colours along a span: values at a pixel, and what each next one has more (P3).

use crate::format::{FRACTION, Format, Ramp};

/// Red, green and blue in steps of the output with [`FRACTION`] bits, half a step included, so that cutting off
/// rounds. Sums wrap; at pixels of the span, and between them, they are right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Colours {
    /// At the first pixel.
    pub at: [i32; 3],
    /// To the next pixel.
    pub step: [i32; 3],
}

impl Colours {
    /// So many pixels further on.
    #[inline(always)]
    #[must_use]
    pub fn after(self, pixels: u32) -> Self {
        self.plus(pixels, 0)
    }

    /// So many halves of a pixel further on.
    #[inline(always)]
    #[must_use]
    pub fn after_halves(self, halves: u32) -> Self {
        self.plus(halves, 1)
    }

    #[inline(always)]
    fn plus(self, times: u32, shift: u32) -> Self {
        let at = [0, 1, 2].map(|i| {
            let way = self.step[i].wrapping_mul(times as i32) >> shift;
            self.at[i].wrapping_add(way)
        });
        Self { at, ..self }
    }

    /// Whether no channel leaves its range within so many pixels, at least 1, where none has left it at the first.
    #[inline(always)]
    #[must_use]
    pub fn stay<F: Format>(&self, pixels: u32) -> bool {
        (0..3).all(|i| {
            let last = i64::from(self.at[i]) + i64::from(self.step[i]) * i64::from(pixels - 1);
            (0..i64::from(F::STEPS[i] + 1) << FRACTION).contains(&last)
        })
    }

    /// From the same place on in steps of several pixels.
    #[inline(always)]
    #[must_use]
    pub fn coarse(self, pixels: u32) -> Self {
        let step = self.step.map(|step| step.wrapping_mul(pixels as i32));
        Self { step, ..self }
    }

    /// 16 bits a channel of what is here.
    #[inline(always)]
    #[must_use]
    pub fn channels<F: Format>(&self) -> [u32; 3] {
        [0, 1, 2].map(|i| self.at[i] as u32 >> (F::WIDTH[i] + FRACTION - 16) & 0xFFFF)
    }

    /// The pixel here.
    #[inline(always)]
    #[must_use]
    pub fn pixel<F: Format>(&self) -> F::Word {
        F::pack(self.at.map(|at| (at >> FRACTION) as u8))
    }

    /// A packed ramp from here on.
    #[inline(always)]
    #[must_use]
    pub fn ramp<F: Format>(&self) -> Ramp {
        F::ramp(self.channels::<F>(), self.step)
    }

    /// The largest step of a channel, in units of 2^-16 of its range, rounded up.
    #[inline(always)]
    #[must_use]
    pub fn slope<F: Format>(&self) -> u32 {
        let of = |i: usize| {
            let below = F::WIDTH[i] + FRACTION - 16;
            (self.step[i].unsigned_abs() + (1 << below) - 1) >> below
        };
        of(0).max(of(1)).max(of(2))
    }
}
