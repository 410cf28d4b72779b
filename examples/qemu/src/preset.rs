//! A small firmware: the teapot by one preset, smooth with 32-bit depth, sent line by line.
//!
//! It is there to be measured: `.text` is at most 16 KB, fast RAM with both line buffers at most
//! 8,192 bytes. It prints `picture teapot` and the picture's CRC-32.
#![no_std]
#![no_main]

mod lend;
mod small;

use cortex_m_rt::entry;
use scanbeam::{GouraudDepth, Rgb565Be};
use small::{buffers, display, exit, room, say, teapot};

#[entry]
fn main() -> ! {
    let mut display = display(buffers!());
    teapot(room!(GouraudDepth<Rgb565Be>, 0), &mut display);
    say("teapot", &mut display);
    exit(true)
}
