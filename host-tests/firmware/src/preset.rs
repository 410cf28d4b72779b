//! A small firmware: the teapot by one preset, smooth with 32-bit depth, sent line by line.
//!
//! It is there to be measured: `firmware --sizes` prints what it takes, and `budgets` fails where its
//! `.text` is above the limit in `host-tests/figures/budgets.txt`. It prints `picture teapot` and the
//! picture's CRC-32. With a feature it is the same firmware by another preset, so that the presets
//! can be compared.
#![no_std]
#![no_main]

mod lend;
mod preset_room;
mod small;

use cortex_m_rt::entry;
use preset_room::{room, teapot};
use scanbeam::pipeline::DepthCell;
use small::{buffers, display, exit, say};

#[cfg(not(feature = "sized"))]
type Look = scanbeam::pipeline::GouraudDepth<scanbeam::pixel::Rgb565Be>;

macro_rules! looks {
    ($($feature:literal, $name:literal, $look:ty;)*) => {
        $(
            #[cfg(feature = $feature)]
            type Look = $look;
        )*
    };
}
scenes::sized!(looks);

#[entry]
fn main() -> ! {
    let mut display = display(buffers!());
    teapot(room!(Look, <CellOf<Look>>::FARTHEST), &mut display);
    say("teapot", &mut display);
    exit(true)
}
