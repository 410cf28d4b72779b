//! The ways of dividing of the laboratory, each alone, over long and over short spans (H4, H5).
//!
//! A texture of 128 x 128 into a line of 16-bit words, every pixel seen. What a span costs is the
//! call, the first and last division, and what is left over of the runs.

use crate::console::Console;
use crate::count::Counter;
use core::hint::black_box;
use scanbeam_lab::perspective::{FRACTION, Homogeneous, PerspectiveSpan, Stride, Uv};
use scenes::{TEXEL_SIDE, TEXELS_565, WIDTH};

const LONG: usize = WIDTH as usize;
const SHORT: usize = 8;
const SPANS: u32 = 60;
const LOG: u32 = TEXEL_SIDE.ilog2();

const STRIDES: [(&str, Stride); 6] = [
    ("affine", Stride::Affine),
    ("perspective_16", Stride::Sixteen),
    ("perspective_8", Stride::Eight),
    ("perspective_4", Stride::Four),
    ("perspective_2", Stride::Two),
    ("perspective_1", Stride::One),
];

/// Times all ways and prints them.
pub(crate) fn run(counter: &Counter, console: &mut Console) {
    for (name, stride) in STRIDES {
        for width in [LONG, SHORT] {
            let mut line = [0u16; LONG];
            let instructions = counter.finely(|| {
                for i in 0..SPANS {
                    draw(stride, &span(i), black_box(&mut line[..width]));
                }
            });
            let pixels = SPANS * width as u32;
            console.line(format_args!(
                "kernel name={name} pixels={pixels} spans={SPANS} instructions={instructions}"
            ));
        }
    }
}

/// A span's texels; both sides are a power of two, so that a texel is found by masks.
#[inline(never)]
fn draw(stride: Stride, span: &PerspectiveSpan, pixels: &mut [u16]) {
    span.walk(stride, pixels, |pixel, Uv { u, v }| {
        let column = (u >> FRACTION) as usize & ((1 << LOG) - 1);
        let row = (v >> (FRACTION - LOG)) as usize & ((1 << LOG) - 1) << LOG;
        *pixel = TEXELS_565[row | column];
    });
}

/// A span whose 1/w falls by half; no two are alike.
fn span(i: u32) -> PerspectiveSpan {
    let i = i as i32;
    black_box(PerspectiveSpan {
        at: Homogeneous {
            q: (1 << 30) - (i << 12),
            s: (10 << 20) + (i << 14),
            t: 30 << 20,
        },
        step: Homogeneous {
            q: -((1 << 29) / LONG as i32),
            s: 60_000 + i,
            t: 21_000 - i,
        },
    })
}
