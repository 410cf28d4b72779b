//! Where the colours of a span come from: the values of an object's planes, and their steps.

use super::{PixelFormat, Ramp};
use crate::visible::Visible;

/// Bits that a channel has beyond a field of a vertex's colour, of 16 (see `GouraudLevels`).
const BELOW_FIELD: [u32; 3] = [5, 5, 6];

/// Colours of a span at the present place, and the way on. All sums wrap; the colours at covered
/// pixels and between them are right.
pub(super) trait Course: Copy {
    /// Whether two words are all that there is.
    const WORDS: bool;

    /// Red and blue, and green in the upper half, 16 bits a channel; what is below is cut off.
    fn words(&self) -> (u32, u32);

    /// Red, green and blue, 16 bits a channel, in the lower halves.
    #[inline(always)]
    fn channels(&self) -> [u32; 3] {
        let (red_blue, green) = self.words();
        [red_blue >> 16, green >> 16, red_blue & 0xFFFF]
    }

    /// Goes on by whole pixels.
    fn advance(&mut self, pixels: u32);

    /// Goes on by halves of a pixel, on a span of at least 3 pixels.
    fn advance_halves(&mut self, halves: u32);

    /// A packed ramp from here, whose steps are those of one pixel.
    fn ramp<F: PixelFormat>(&self) -> F::Ramp;

    /// From the same place on in steps of several pixels, on a span of at least 3.
    fn coarse(&self, pixels: u32) -> Self;

    /// All pixels by the steps as they are.
    fn forward<F: PixelFormat>(&self, pixels: &mut [F::Word], visible: &mut impl Visible);

    /// Whether a packed ramp over so many pixels is left to [`forward`](Course::forward).
    ///
    /// A ramp that has all bits of its two words is these words. Three channels are packed where
    /// a span is longer than those of small triangles, tested or not: the bits are the same.
    #[inline(always)]
    fn is_its_ramp<F: PixelFormat>(count: usize) -> bool {
        if Self::WORDS { !F::CUTS } else { count <= 64 }
    }

    /// The largest step of a channel, units of 2^-16 of its range, rounded up; on a span of at
    /// least 3 pixels.
    fn slope(&self) -> u32;
}

/// Of a small triangle: two words.
#[derive(Clone, Copy, Debug)]
pub(super) struct Words {
    pub(super) red_blue: i32,
    pub(super) green: i32,
    pub(super) steps: (i32, i32),
    pub(super) field_step: i32,
}

impl Words {
    /// The steps of red, green and blue.
    #[inline(always)]
    fn step(&self) -> [i32; 3] {
        apart(self.steps)
    }
}

/// The steps of red, green and blue from two words. A step of two fields is ambiguous where the
/// lower one is half its range or more, which no span of 3 pixels has room for.
#[inline(always)]
pub(super) fn apart((red_blue, green): (i32, i32)) -> [i32; 3] {
    let blue = i32::from(red_blue as i16);
    [red_blue.wrapping_sub(blue) >> 16, green >> 16, blue]
}

/// Two steps in one word.
#[inline(always)]
fn pair(high: i32, low: i32) -> i32 {
    (high << 16).wrapping_add(low)
}

/// The fields of a vertex's colour from steps with so many bits more, rounded.
#[inline(always)]
fn fields(step: [i32; 3], more: [u32; 3]) -> i32 {
    let field = |i: usize| step[i].wrapping_add(1 << more[i] >> 1) >> more[i];
    (field(0) << 21)
        .wrapping_add(field(2) << 11)
        .wrapping_add(field(1))
}

impl Course for Words {
    const WORDS: bool = true;

    #[inline(always)]
    fn words(&self) -> (u32, u32) {
        (self.red_blue as u32, self.green as u32)
    }

    #[inline(always)]
    fn advance(&mut self, pixels: u32) {
        let on = |at: i32, step: i32| at.wrapping_add(step.wrapping_mul(pixels as i32));
        self.red_blue = on(self.red_blue, self.steps.0);
        self.green = on(self.green, self.steps.1);
    }

    #[inline(always)]
    fn advance_halves(&mut self, halves: u32) {
        let [r, g, b] = self.step().map(|s| s.wrapping_mul(halves as i32) >> 1);
        self.red_blue = self.red_blue.wrapping_add(pair(r, b));
        self.green = self.green.wrapping_add(g << 16);
    }

    #[inline(always)]
    fn ramp<F: PixelFormat>(&self) -> F::Ramp {
        F::Ramp::new(self.red_blue, self.green, self.steps, self.field_step)
    }

    #[inline(always)]
    fn coarse(&self, pixels: u32) -> Self {
        let step = self.step().map(|s| s.wrapping_mul(pixels as i32));
        Self {
            steps: (
                self.steps.0.wrapping_mul(pixels as i32),
                self.steps.1.wrapping_mul(pixels as i32),
            ),
            field_step: fields(step, BELOW_FIELD),
            ..*self
        }
    }

    #[inline(never)]
    fn forward<F: PixelFormat>(&self, pixels: &mut [F::Word], visible: &mut impl Visible) {
        let mut at = *self;
        visible.each(pixels, |pixel, shown| {
            if shown {
                *pixel = F::pack_words(at.red_blue as u32, at.green as u32);
            }
            at.advance(1);
        });
    }

    #[inline(always)]
    fn slope(&self) -> u32 {
        let [r, g, b] = self.step().map(i32::unsigned_abs);
        r.max(g).max(b)
    }
}

/// Of a large triangle: three channels of 16.16, in a format with these steps a channel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wide {
    pub(super) at: [i32; 3],
    pub(super) step: [i32; 3],
    /// Bits of a channel of the output: so many bits a channel has beyond 16.
    bits: [u32; 3],
}

impl Wide {
    #[inline(always)]
    pub(super) fn new<F: PixelFormat>(at: [i32; 3], step: [i32; 3]) -> Self {
        Self {
            at,
            step,
            bits: F::BITS,
        }
    }
}

impl Course for Wide {
    const WORDS: bool = false;

    #[inline(always)]
    fn words(&self) -> (u32, u32) {
        let [r, g, b] = [0, 1, 2].map(|i| (self.at[i] as u32) >> self.bits[i]);
        (r << 16 | (b & 0xFFFF), g << 16)
    }

    #[inline(always)]
    fn advance(&mut self, pixels: u32) {
        for i in 0..3 {
            self.at[i] = self.at[i].wrapping_add(self.step[i].wrapping_mul(pixels as i32));
        }
    }

    #[inline(always)]
    fn advance_halves(&mut self, halves: u32) {
        for i in 0..3 {
            self.at[i] = self.at[i].wrapping_add(self.step[i].wrapping_mul(halves as i32) >> 1);
        }
    }

    #[inline(always)]
    fn ramp<F: PixelFormat>(&self) -> F::Ramp {
        let (red_blue, green) = self.words();
        let [r, g, b] =
            [0, 1, 2].map(|i| self.step[i].wrapping_add(1 << self.bits[i] >> 1) >> self.bits[i]);
        let more = [0, 1, 2].map(|i| self.bits[i] + BELOW_FIELD[i]);
        F::Ramp::new(
            red_blue as i32,
            green as i32,
            (pair(r, b), g << 16),
            fields(self.step, more),
        )
    }

    #[inline(always)]
    fn coarse(&self, pixels: u32) -> Self {
        Self {
            step: self.step.map(|s| s.wrapping_mul(pixels as i32)),
            ..*self
        }
    }

    #[inline(never)]
    fn forward<F: PixelFormat>(&self, pixels: &mut [F::Word], visible: &mut impl Visible) {
        let mut at = *self;
        visible.each(pixels, |pixel, shown| {
            if shown {
                *pixel = F::pack(at.at.map(|at| (at >> 16) as u8));
            }
            at.advance(1);
        });
    }

    #[inline(always)]
    fn slope(&self) -> u32 {
        let up = |i: usize| (self.step[i].unsigned_abs() + (1 << self.bits[i]) - 1) >> self.bits[i];
        up(0).max(up(1)).max(up(2))
    }
}
