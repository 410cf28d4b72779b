//! Three channels in one or two registers.
//!
//! The sum of packed steps is the packed sum, and a field is right as long as all fields below it
//! stay in range, which half a step at either end of each field guarantees (see `Colour`). One
//! register has few fraction bits, so it is anchored anew every 8 or 16 pixels from the two words
//! with 16 bits a channel: a field of 5 + 6 (blue 5 + 5) bits whose step is rounded drifts by 2^-7
//! (2^-6) steps a pixel, 1/8 of a step over 8 pixels of blue.

/// Two words and their steps, 16 bits a channel: for formats of 8 bits a channel.
#[derive(Clone, Copy, Debug)]
pub struct TwoWords {
    red_blue: i32,
    green: i32,
    steps: (i32, i32),
}

impl TwoWords {
    #[inline(always)]
    pub(super) fn new(red_blue: i32, green: i32, steps: (i32, i32)) -> Self {
        Self {
            red_blue,
            green,
            steps,
        }
    }

    /// The words.
    #[inline(always)]
    pub(super) fn words(&self) -> (u32, u32) {
        (self.red_blue as u32, self.green as u32)
    }

    #[inline(always)]
    pub(super) fn step(&mut self) {
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

impl OneWord {
    #[inline(always)]
    pub(super) fn new(red_blue: i32, green: i32, field_step: i32) -> Self {
        let (rb, g) = (red_blue as u32, green as u32);
        Self {
            word: (rb & 0xFFE0_0000) | (rb & 0xFFC0) << 5 | g >> 21,
            step: field_step as u32,
        }
    }

    /// The pixel, 5, 6 and 5 bits.
    #[inline(always)]
    pub(super) fn rgb565(&self) -> u16 {
        let whole = self.word & 0xF81F_07E0;
        (whole | whole >> 16) as u16
    }

    /// The same with its bytes swapped, at the cost of one instruction.
    #[inline(always)]
    pub(super) fn rgb565_swapped(&self) -> u16 {
        let whole = (self.word & 0xF81F_07E0).swap_bytes();
        (whole | whole >> 16) as u16
    }

    #[inline(always)]
    pub(super) fn step(&mut self) {
        self.word = self.word.wrapping_add(self.step);
    }
}
