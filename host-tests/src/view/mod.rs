//! `view`: a model that turns, live, in the terminal or in a window.
//!
//! A cell of the terminal shows two pixels, one above the other, by the half block and its two
//! colours. The picture is what the crate draws for a display of that size: nothing is scaled.
//!
//! | file | there |
//! |---|---|
//! | `state.rs` | what keys change, and the view that follows; knows no terminal |
//! | `blocks.rs` | a picture as text |
//! | `terminal.rs` | the live loop, and `--frames` |
//! | `window.rs` | the same in a window, with the feature `window` |

mod blocks;
mod show;
mod state;
mod terminal;
#[cfg(feature = "window")]
mod window;

pub use blocks::half_blocks;
pub use show::{Scenery, Shown};
pub use state::{KEYS, State, Step};

use crate::args::ViewArgs;
use crate::model::Model;
use std::error::Error;

/// Shows a model.
///
/// # Errors
/// A model that cannot be read or drawn; no terminal to show it on, unless `--frames` is given.
pub fn run(args: &ViewArgs) -> Result<(), Box<dyn Error>> {
    let model = Model::load(&args.model)?;
    let scenery = Scenery::new(&model)?;
    let state = State::new(args);
    #[cfg(feature = "window")]
    if args.window {
        return window::run(&scenery, state, args.size);
    }
    match args.frames {
        Some(frames) => terminal::print(&scenery, state, args.size, frames),
        None => terminal::live(&scenery, state, args.size),
    }
}
