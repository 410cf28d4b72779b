//! All that the laboratory draws, as one number: the same on every target (X1).

use crate::colours::Colours;
use crate::depth::{DepthMethod, Depths, resolve, words};
use crate::format::Format;
use crate::kept::{ColourPlanes, Kept, Span};
use crate::lines::{Triangle, draw_line};
use crate::method::Method;
use crate::perspective::{Homogeneous, PerspectiveSpan, Stride};
use scanbeam::pixel::{Rgb565, Rgb888};

/// What [`bits`] must be.
pub const BITS: u32 = 0x8303_6625;

/// Pixels of a line.
const WIDTH: usize = 61;

/// Every method.
pub(crate) const METHODS: [Method; 13] = [
    Method::Plane,
    Method::Packed8,
    Method::Packed16,
    Method::Half,
    Method::Quarter,
    Method::Whole,
    Method::Lirp(10),
    Method::Lirp(12),
    Method::Lirp(16),
    Method::LirpPacked,
    Method::FAST,
    Method::BALANCED,
    Method::EXACT,
];

/// Every depth.
const DEPTHS: [DepthMethod; 6] = [
    DepthMethod::Bits16,
    DepthMethod::Bits22,
    DepthMethod::BlockFix,
    DepthMethod::Bits32,
    DepthMethod::Linear,
    DepthMethod::Word,
];

/// Every way of dividing.
pub(crate) const STRIDES: [Stride; 6] = [
    Stride::One,
    Stride::Two,
    Stride::Four,
    Stride::Eight,
    Stride::Sixteen,
    Stride::Affine,
];

/// Three triangles through each other.
const TRIANGLES: [Triangle; 3] = [
    Triangle {
        place: [[-37, 3], [470, 90], [12, 203]],
        depth: [1 << 30, 1 << 27, 0x3123_4567],
        colour: [[255, 0, 30], [0, 200, 60], [90, 255, 255]],
    },
    Triangle {
        place: [[301, -11], [33, 60], [460, 199]],
        depth: [0x7000_0000, 1 << 26, 0x2888_0001],
        colour: [[1, 2, 3], [250, 254, 255], [128, 7, 99]],
    },
    Triangle {
        place: [[200, 0], [210, 201], [250, 203]],
        depth: [1 << 29; 3],
        colour: [[77, 66, 255]; 3],
    },
];

/// A checksum by 32 bits of FNV-1a.
struct Sum(u32);

impl Sum {
    fn add(&mut self, word: u32) {
        for byte in word.to_le_bytes() {
            self.0 = (self.0 ^ u32::from(byte)).wrapping_mul(0x0100_0193);
        }
    }
}

/// Draws by every method, every depth and every way of dividing; the checksum of it all.
#[must_use]
pub fn bits() -> u32 {
    let mut sum = Sum(0x811C_9DC5);
    for (i, method) in METHODS.into_iter().enumerate() {
        let how = (method, DEPTHS[i % DEPTHS.len()]);
        lines::<Rgb565>(how, &mut sum);
        lines::<Rgb888>(how, &mut sum);
    }
    for stride in STRIDES {
        for pixels in [1, 2, 15, 16, 17, WIDTH] {
            places(stride, pixels, &mut sum);
        }
    }
    for every in [1, 3] {
        TRIANGLES.iter().for_each(|t| kept(t, every, &mut sum));
    }
    let (mut cells, mut pixels) = ([0; WIDTH], [0; WIDTH]);
    for (at, step) in [(1 << 30, 1 << 20), (0x4100_0000, 0), (1 << 25, 1 << 25)] {
        let colours = Colours {
            at: [1 << 20, 1 << 25, 3 << 20],
            step: [1 << 18, -(1 << 18), 99_999],
        };
        words(&mut cells, Depths { at, step }, &colours);
    }
    resolve(&mut cells, &mut pixels);
    pixels.into_iter().for_each(|pixel| sum.add(pixel.into()));
    sum.0
}

fn lines<F: Format>(how: (Method, DepthMethod), sum: &mut Sum) {
    let mut cells = [0; WIDTH];
    for line in [0, 7, 12, 25] {
        let mut pixels = [F::Word::default(); WIDTH];
        draw_line::<F>(how, TRIANGLES, line, &mut pixels, &mut cells);
        for pixel in pixels {
            let [red, green, blue] = F::to_rgb8(pixel);
            sum.add(u32::from_le_bytes([red, green, blue, 0]));
        }
        cells.into_iter().for_each(|cell| sum.add(cell));
    }
}

fn kept(triangle: &Triangle, every: u16, sum: &mut Sum) {
    let (planes, mut kept) = (ColourPlanes::new::<Rgb565>(triangle), Kept::new(every));
    for line in 0..30 {
        if let Some(span) = Span::of(triangle, line) {
            let Colours { at, step } = kept.of_span::<Rgb565>(&planes, &span);
            at.into_iter()
                .chain(step)
                .for_each(|value| sum.add(value as u32));
        }
    }
}

fn places(stride: Stride, pixels: usize, sum: &mut Sum) {
    let span = PerspectiveSpan {
        at: Homogeneous {
            q: 1 << 30,
            s: 10 << 20,
            t: 30 << 20,
        },
        step: Homogeneous {
            q: -(1 << 24),
            s: 600_000,
            t: -210_000,
        },
    };
    let mut line = [0u8; WIDTH];
    span.walk(stride, &mut line[..pixels], |_, place| {
        sum.add(place.u as u32);
        sum.add(place.v as u32);
    });
}

#[cfg(test)]
mod tests {
    /// What the firmware must have too; dies of any bit that a method, a depth or a place has otherwise.
    #[test]
    fn bits_are_those_that_are_recorded() {
        assert_eq!(super::bits(), super::BITS, "{:#010X}", super::bits());
    }
}
