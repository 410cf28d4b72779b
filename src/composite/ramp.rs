//! Three channels in one or two registers.
//!
//! The sum of packed steps is the packed sum, and a field is right as long as all fields below it
//! stay in range, which half a step at either end of each field guarantees (see `Colour`). One
//! register has few fraction bits, so it is anchored anew every 8 or 16 pixels from the two words
//! with 16 bits a channel: a field of 5 + 6 (blue 5 + 5) bits whose step is rounded drifts by 2^-7
//! (2^-6) steps a pixel, 1/8 of a step over 8 pixels of blue.

use super::{PixelFormat, Rgb565, Rgb565Bytes};

/// Three channels that step from pixel to pixel, for the format `F`.
pub trait Ramp<F: PixelFormat + ?Sized> {
    /// From two words with 16 bits a channel (red and blue, green in the upper half), their steps,
    /// and the packed step in the fields of a vertex's colour.
    fn new(red_blue: i32, green: i32, steps: (i32, i32), field_step: i32) -> Self;

    /// The pixel at which it stands.
    fn pixel(&self) -> F::Word;

    /// Goes to the next pixel.
    fn step(&mut self);
}

/// Two words and their steps, 16 bits a channel: for formats of 8 bits a channel.
#[derive(Clone, Copy, Debug)]
pub struct TwoWords {
    red_blue: i32,
    green: i32,
    steps: (i32, i32),
}

impl<F: PixelFormat + ?Sized> Ramp<F> for TwoWords {
    #[inline(always)]
    fn new(red_blue: i32, green: i32, steps: (i32, i32), _: i32) -> Self {
        Self {
            red_blue,
            green,
            steps,
        }
    }

    #[inline(always)]
    fn pixel(&self) -> F::Word {
        F::pack_words(self.red_blue as u32, self.green as u32)
    }

    #[inline(always)]
    fn step(&mut self) {
        self.red_blue = self.red_blue.wrapping_add(self.steps.0);
        self.green = self.green.wrapping_add(self.steps.1);
    }
}

/// One word, red 5.6 in bits 31..21, blue 5.5 in 20..11, green 6.5 in 10..0, and its step: for
/// formats of 5, 6 and 5 bits.
#[derive(Clone, Copy, Debug)]
pub struct OneWord {
    word: u32,
    step: u32,
}

impl Ramp<Rgb565> for OneWord {
    #[inline(always)]
    fn new(red_blue: i32, green: i32, _: (i32, i32), field_step: i32) -> Self {
        let (rb, g) = (red_blue as u32, green as u32);
        Self {
            word: (rb & 0xFFE0_0000) | (rb & 0xFFC0) << 5 | g >> 21,
            step: field_step as u32,
        }
    }

    #[inline(always)]
    fn pixel(&self) -> u16 {
        let whole = self.word & 0xF81F_07E0;
        (whole | whole >> 16) as u16
    }

    #[inline(always)]
    fn step(&mut self) {
        self.word = self.word.wrapping_add(self.step);
    }
}

impl<const BIG: bool> Ramp<Rgb565Bytes<BIG>> for OneWord {
    #[inline(always)]
    fn new(red_blue: i32, green: i32, steps: (i32, i32), field_step: i32) -> Self {
        <Self as Ramp<Rgb565>>::new(red_blue, green, steps, field_step)
    }

    /// Swapping costs one instruction.
    #[inline(always)]
    fn pixel(&self) -> u16 {
        if Rgb565Bytes::<BIG>::in_memory(1) == 1 {
            return <Self as Ramp<Rgb565>>::pixel(self);
        }
        let whole = (self.word & 0xF81F_07E0).swap_bytes();
        (whole | whole >> 16) as u16
    }

    #[inline(always)]
    fn step(&mut self) {
        <Self as Ramp<Rgb565>>::step(self);
    }
}
