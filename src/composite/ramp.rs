//! Colours into pixels, span by span.
//!
//! Three channels run in one or two registers: the sum of packed steps is the packed sum, and a
//! field is right as long as all fields below it stay in range, which half a step at either end
//! of each field guarantees (see `Colour`). One register has few fraction bits, so it is
//! anchored anew every [`RUN`] pixels from the two words with 16 bits a channel.

use super::PixelFormat;
use crate::shade::Stretch;
use crate::visible::Visible;

/// Pixels between two anchors of a single word.
///
/// A field of 5 + 6 (blue 5 + 5) bits whose step is rounded drifts by 2^-7 (2^-6) steps a
/// pixel: 1/8 of a step over 8 pixels of blue.
pub(super) const RUN: usize = 8;

/// Writes the pixels of a span that are seen; returns how many were.
#[inline(always)]
pub(crate) fn paint<F: PixelFormat>(
    pixels: &mut [F::Word],
    stretch: Stretch,
    mut visible: impl Visible,
) -> u32 {
    let mut seen = 0;
    match stretch {
        Stretch::Constant(steps) => {
            let word = F::pack(steps);
            if all_seen(&visible) {
                F::fill(pixels, word);
                return pixels.len() as u32;
            }
            visible.each(pixels, |pixel, shown| {
                if shown {
                    *pixel = word;
                    seen += 1;
                }
            });
        }
        Stretch::Packed {
            mut red_blue,
            mut green,
            steps,
            field_step,
        } => {
            let mut rest = pixels;
            if all_seen(&visible) {
                let count = rest.len() as u32;
                if rest.len() > RUN {
                    long::<F>(rest, (red_blue, green), steps, field_step);
                } else {
                    short::<F>(rest, F::ramp(red_blue, green, steps, field_step));
                }
                return count;
            }
            while rest.len() > RUN {
                let (run, more) = rest.split_at_mut(RUN);
                let ramp = F::ramp(red_blue, green, steps, field_step);
                seen += walk::<F>(run, ramp, &mut visible);
                rest = more;
                red_blue = red_blue.wrapping_add(steps.0.wrapping_mul(RUN as i32));
                green = green.wrapping_add(steps.1.wrapping_mul(RUN as i32));
            }
            let ramp = F::ramp(red_blue, green, steps, field_step);
            seen += walk::<F>(rest, ramp, &mut visible);
        }
        Stretch::Channels([mut r, mut g, mut b], step) => {
            visible.each(pixels, |pixel, shown| {
                if shown {
                    *pixel = F::pack([(r >> 16) as u8, (g >> 16) as u8, (b >> 16) as u8]);
                    seen += 1;
                }
                r = r.wrapping_add(step[0]);
                g = g.wrapping_add(step[1]);
                b = b.wrapping_add(step[2]);
            });
        }
    }
    seen
}

/// Whether nobody has to be asked.
#[inline(always)]
const fn all_seen<V: Visible>(_: &V) -> bool {
    V::ALL
}

/// More than [`RUN`] pixels. Apart, so that short spans find their registers free.
#[inline(never)]
fn long<F: PixelFormat>(
    mut rest: &mut [F::Word],
    (mut red_blue, mut green): (i32, i32),
    steps: (i32, i32),
    field_step: i32,
) {
    while rest.len() > RUN {
        let (run, more) = rest.split_at_mut(RUN);
        short::<F>(run, F::ramp(red_blue, green, steps, field_step));
        rest = more;
        red_blue = red_blue.wrapping_add(steps.0.wrapping_mul(RUN as i32));
        green = green.wrapping_add(steps.1.wrapping_mul(RUN as i32));
    }
    short::<F>(rest, F::ramp(red_blue, green, steps, field_step));
}

/// All of at most [`RUN`] pixels, in straight code without a loop: most spans are short.
#[inline(always)]
fn short<F: PixelFormat>(run: &mut [F::Word], mut ramp: F::Ramp) {
    let mut next = || {
        let word = F::ramp_pixel(&ramp);
        F::ramp_step(&mut ramp);
        word
    };
    match run {
        [a] => *a = next(),
        [a, b] => (*a, *b) = (next(), next()),
        [a, b, c] => (*a, *b, *c) = (next(), next(), next()),
        [a, b, c, d] => (*a, *b, *c, *d) = (next(), next(), next(), next()),
        [a, b, c, d, e] => {
            (*a, *b, *c, *d, *e) = (next(), next(), next(), next(), next());
        }
        [a, b, c, d, e, f] => {
            (*a, *b, *c, *d, *e, *f) = (next(), next(), next(), next(), next(), next());
        }
        [a, b, c, d, e, f, g] => {
            (*a, *b, *c, *d, *e, *f, *g) = (next(), next(), next(), next(), next(), next(), next());
        }
        [a, b, c, d, e, f, g, h] => {
            (*a, *b, *c, *d, *e, *f, *g, *h) = (
                next(),
                next(),
                next(),
                next(),
                next(),
                next(),
                next(),
                next(),
            );
        }
        _ => {}
    }
}

/// The pixels between two anchors.
#[inline(always)]
fn walk<F: PixelFormat>(run: &mut [F::Word], mut ramp: F::Ramp, visible: &mut impl Visible) -> u32 {
    let mut seen = 0;
    visible.each(run, |pixel, shown| {
        if shown {
            *pixel = F::ramp_pixel(&ramp);
            seen += 1;
        }
        F::ramp_step(&mut ramp);
    });
    seen
}

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

    /// The upper 8 bits of red, green and blue.
    #[inline(always)]
    pub(super) fn top(&self) -> [u8; 3] {
        [
            (self.red_blue >> 24) as u8,
            (self.green >> 24) as u8,
            (self.red_blue >> 8) as u8,
        ]
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
