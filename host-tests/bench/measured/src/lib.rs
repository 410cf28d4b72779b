//! How a renderer is run to be measured, the same for ours and for its peers, and the same on the
//! host as on a Cortex-M in QEMU: a program takes the words `WHAT... FRAMES [PICTURE]`.
//!
//! Everybody does the same work: from the model's vertices to a finished RGB565 picture of 320 x 240
//! pixels, clears, transform, light, culling and depth test included. Meshes are made ready once, in
//! the form that a renderer wants, and that is not counted.
//!
//! | file | there |
//! |---|---|
//! | `host.rs` | words, files and the clock of this machine |
//! | `board.rs` | the same over semihosting, with a heap, and counted instructions for the clock |
#![cfg_attr(target_os = "none", no_std)]

extern crate alloc;

#[cfg_attr(target_os = "none", path = "board.rs")]
#[cfg_attr(not(target_os = "none"), path = "host.rs")]
mod machine;

use alloc::{boxed::Box, string::String, vec::Vec};
use core::error::Error;

#[cfg(target_os = "none")]
pub use machine::end;
pub use machine::read;
use machine::{Machine, write};

/// What went wrong.
pub type Failure = Box<dyn Error>;

/// A renderer with a scene made ready.
pub trait Renderer {
    /// Draws a frame.
    fn frame(&mut self);
    /// The last frame in RGB565, line by line; it may be drawn again.
    fn picture(&mut self) -> Vec<u16>;
}

/// Makes a renderer ready; it takes the words that say which, and with what scene.
pub type Make = fn(&mut dyn Iterator<Item = String>) -> Result<Box<dyn Renderer>, Failure>;

/// Draws as many frames as the words say, and prints the least of their costs: milliseconds on the
/// host, instructions on a board. Whatever else a machine does only adds to it. A file that is
/// named gets the picture, two bytes a pixel, the low one first.
///
/// # Errors
/// When the words are not understood, or a file cannot be read or written.
pub fn run(make: Make) -> Result<(), Failure> {
    let mut machine = Machine::start()?;
    let mut words = machine.words()?.into_iter();
    let mut renderer = make(&mut words)?;
    let frames: u32 = words.next().ok_or("how many frames?")?.parse()?;
    let costs = (0..frames).map(|_| machine.cost(|| renderer.frame()));
    if let Some(least) = costs.min_by(f64::total_cmp) {
        machine.say(format_args!("{least:.6}"));
    }
    if let Some(file) = words.next() {
        if frames == 0 {
            renderer.frame();
        }
        let bytes: Vec<u8> = renderer
            .picture()
            .into_iter()
            .flat_map(u16::to_le_bytes)
            .collect();
        write(&file, &bytes)?;
    }
    Ok(())
}

/// The program's start, on either machine; `$make` is a [`Make`].
#[macro_export]
macro_rules! program {
    ($make:path) => {
        #[cfg(not(target_os = "none"))]
        fn main() -> Result<(), $crate::Failure> {
            $crate::run($make)
        }

        #[cfg(target_os = "none")]
        #[unsafe(export_name = "main")]
        extern "C" fn main() -> ! {
            $crate::end($crate::run($make))
        }
    };
}
