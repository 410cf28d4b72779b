//! Depth formats, each alone: 1/w stepped along a span, encoded, compared, kept where it is nearer
//! (H1, H2).
//!
//! Names: `depth_` and the format. A third of the pixels is hidden, so both ways through the
//! comparison are taken. No colour is written: what differs is the format.

use crate::console::Console;
use crate::count::Counter;
use core::hint::black_box;
use scanbeam_lab::DepthMethod;
use scanbeam_lab::depth::{Depths, bits_16, bits_22, bits_32, block_fix, even_w};
use scenes::WIDTH;

const LONG: usize = WIDTH as usize;
const SHORT: usize = 8;
const SPANS: u32 = 60;
/// 1/w of the nearest, 31 fraction bits.
const NEAR: u32 = 1 << 30;

/// Times all formats and prints them.
pub(crate) fn run(counter: &Counter, console: &mut Console) {
    let range = black_box(DepthMethod::BlockFix.range(NEAR));
    time("depth_16", bits_16, counter, console);
    time(
        "depth_22",
        |line: &mut [u32], depths| bits_22(line, depths, 7),
        counter,
        console,
    );
    time(
        "depth_block_fix",
        |line: &mut [u16], depths| block_fix(line, depths, range),
        counter,
        console,
    );
    time("depth_32", bits_32, counter, console);
    time("depth_linear", even_w, counter, console);
}

fn time<W: Copy + Default>(
    name: &str,
    kernel: impl Fn(&mut [W], Depths),
    counter: &Counter,
    console: &mut Console,
) {
    for width in [LONG, SHORT] {
        let mut line = [W::default(); LONG];
        let instructions = counter.instructions(|| {
            for i in 0..SPANS {
                kernel(black_box(&mut line[..width]), black_box(depths(i)));
            }
        });
        let pixels = SPANS * width as u32;
        console.line(format_args!(
            "kernel name={name} pixels={pixels} spans={SPANS} instructions={instructions}"
        ));
    }
}

/// Of each three spans the first two are nearer than all before, and the third is behind them.
fn depths(i: u32) -> Depths {
    let nearer = if i % 3 == 2 { i - 2 } else { i };
    Depths {
        at: NEAR / 2 + (nearer << 20),
        step: 0u32.wrapping_sub(NEAR / 4 / LONG as u32),
    }
}
