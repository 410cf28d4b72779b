//! Depth formats, each alone: 1/w stepped along a span, encoded, compared, kept where it is nearer
//! (H1, H2).
//!
//! Names: `depth_` and the format. A third of the pixels is hidden, so both ways through the
//! comparison are taken. No colour is written: what differs is the format.

use crate::console::Console;
use crate::count::Counter;
use core::hint::black_box;
use scanbeam::pipeline::BlockFix16;
use scenes::WIDTH;

const LONG: usize = WIDTH as usize;
const SHORT: usize = 8;
const SPANS: u32 = 60;
/// 1/w of the nearest, 31 fraction bits.
const NEAR: u32 = 1 << 30;

/// 1/w of a span's first pixel, and what each next one has less.
#[derive(Clone, Copy)]
struct Slope {
    first: u32,
    step: u32,
}

/// Times all formats and prints them.
pub(crate) fn run(counter: &Counter, console: &mut Console) {
    let range = black_box(BlockFix16::range_of(NEAR));
    time("depth_16", fixed_16, counter, console);
    time("depth_22", fixed_22, counter, console);
    time(
        "depth_block_fix",
        |line: &mut [u16], slope| block_fix(line, slope, range),
        counter,
        console,
    );
    time("depth_32", fixed_32, counter, console);
    time("depth_linear", linear, counter, console);
}

fn time<W: Copy + Default>(
    name: &str,
    kernel: impl Fn(&mut [W], Slope),
    counter: &Counter,
    console: &mut Console,
) {
    for width in [LONG, SHORT] {
        let mut line = [W::default(); LONG];
        let instructions = counter.instructions(|| {
            for i in 0..SPANS {
                kernel(black_box(&mut line[..width]), black_box(slope(i)));
            }
        });
        let pixels = SPANS * width as u32;
        console.line(format_args!(
            "kernel name={name} pixels={pixels} spans={SPANS} instructions={instructions}"
        ));
    }
}

/// Of each three spans the first two are nearer than all before, and the third is behind them.
fn slope(i: u32) -> Slope {
    let nearer = if i % 3 == 2 { i - 2 } else { i };
    Slope {
        first: NEAR / 2 + (nearer << 20),
        step: NEAR / 4 / LONG as u32,
    }
}

/// What all formats share: steps along the line, and keeps what is not behind.
#[inline(always)]
fn each<W: Copy>(line: &mut [W], slope: Slope, mut test: impl FnMut(u32, W) -> Option<W>) {
    let mut q = slope.first;
    for cell in line {
        if let Some(kept) = test(q, *cell) {
            *cell = kept;
        }
        q = q.wrapping_sub(slope.step);
    }
}

#[inline(never)]
fn fixed_16(line: &mut [u16], slope: Slope) {
    each(line, slope, |q, kept| {
        let depth = (q >> 15) as u16;
        (depth >= kept).then_some(depth)
    });
}

/// The lower 10 bits of the word name the object.
#[inline(never)]
fn fixed_22(line: &mut [u32], slope: Slope) {
    each(line, slope, |q, kept| {
        let word = q & !1023 | 1023;
        (word >= kept).then_some(word)
    });
}

#[inline(never)]
fn block_fix(line: &mut [u16], slope: Slope, range: u32) {
    each(line, slope, |q, kept| {
        let depth = BlockFix16::new(q, range);
        let nearer = depth.covers(BlockFix16::from_bits(kept));
        nearer.then_some(depth.to_bits())
    });
}

#[inline(never)]
fn fixed_32(line: &mut [u32], slope: Slope) {
    each(line, slope, |q, kept| (q >= kept).then_some(q));
}

/// Even steps of w up to 128, 25 fraction bits; it is not linear on the screen, so each pixel divides.
#[inline(never)]
fn linear(line: &mut [u32], slope: Slope) {
    each(line, slope, |q, kept| {
        let w = (1 << 56) / u64::from(q);
        let depth = !(w as u32);
        (depth >= kept).then_some(depth)
    });
}
