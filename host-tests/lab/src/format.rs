//! Pixels of 16 and 24 bits, and channels packed into words that step from pixel to pixel (P4).
//!
//! The sum of packed steps is the packed sum, and a field is right as long as all fields below it stay in range,
//! which half a step at either end of each field guarantees.

use scanbeam::pixel::{PixelFormat, Rgb565, Rgb888};

/// Fraction bits of colours along a span: units of 2^-20 of a step of the output.
pub const FRACTION: u32 = 20;

/// What packing costs, in units of 2^-16 of a channel's range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Precision {
    /// The unit of the coarsest field: what is cut off at an anchor.
    pub unit: u32,
    /// By how much a step errs at most.
    pub drift: u32,
}

/// Packed channels and their steps; a format that needs one word leaves the other alone.
#[derive(Clone, Copy, Debug)]
pub struct Ramp {
    words: [u32; 2],
    steps: [u32; 2],
}

impl Ramp {
    /// Goes to the next pixel.
    #[inline(always)]
    pub fn step(&mut self) {
        self.words = [0, 1].map(|i| self.words[i].wrapping_add(self.steps[i]));
    }
}

/// A pixel format that methods draw.
pub trait Format: PixelFormat {
    /// Bits a channel.
    const WIDTH: [u32; 3];
    /// What a ramp errs.
    const PACKING: Precision;

    /// A ramp from 16 bits a channel, and steps with [`FRACTION`] bits.
    fn ramp(at: [u32; 3], step: [i32; 3]) -> Ramp;

    /// The pixel at which a ramp stands.
    fn pixel(ramp: &Ramp) -> Self::Word;
}

/// Steps with so many of their [`FRACTION`] bits dropped, rounded.
#[inline(always)]
fn rounded(step: [i32; 3], dropped: [u32; 3]) -> [u32; 3] {
    [0, 1, 2].map(|i| (step[i].wrapping_add(1 << dropped[i] >> 1) >> dropped[i]) as u32)
}

/// One word: red 5.6 in bits 31..21, blue 5.5 in 20..11, green 6.5 in 10..0.
impl Format for Rgb565 {
    const WIDTH: [u32; 3] = [5, 6, 5];
    /// Blue's: 5 fraction bits of 11.
    const PACKING: Precision = Precision {
        unit: 64,
        drift: 32,
    };

    #[inline(always)]
    fn ramp(at: [u32; 3], step: [i32; 3]) -> Ramp {
        let [red, green, blue] = rounded(step, [14, 15, 15]);
        let word = (at[0] & 0xFFE0) << 16 | (at[2] & 0xFFC0) << 5 | at[1] >> 5;
        let step = (red << 21).wrapping_add(blue << 11).wrapping_add(green);
        Ramp {
            words: [word, 0],
            steps: [step, 0],
        }
    }

    #[inline(always)]
    fn pixel(ramp: &Ramp) -> u16 {
        let whole = ramp.words[0] & 0xF81F_07E0;
        (whole | whole >> 16) as u16
    }
}

/// Two words: red and blue with 16 bits each, and green in the upper half.
impl Format for Rgb888 {
    const WIDTH: [u32; 3] = [8; 3];
    const PACKING: Precision = Precision { unit: 1, drift: 1 };

    #[inline(always)]
    fn ramp(at: [u32; 3], step: [i32; 3]) -> Ramp {
        let [red, green, blue] = rounded(step, [12; 3]);
        Ramp {
            words: [at[0] << 16 | at[2], at[1] << 16],
            steps: [(red << 16).wrapping_add(blue), green << 16],
        }
    }

    #[inline(always)]
    fn pixel(ramp: &Ramp) -> [u8; 3] {
        Self::pack_words(ramp.words[0], ramp.words[1])
    }
}
