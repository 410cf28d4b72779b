//! `view`: a model that turns, live, in the terminal or in a window.
//!
//! A cell of the terminal shows two pixels, one above the other, by the half block and its two
//! colours. The picture is what the crate draws for a display of that size: nothing is scaled.
//! Texels are rounded to 5, 6 and 5 bits.
//!
//! | file | there |
//! |---|---|
//! | `state.rs` | what keys change, and the view that follows; knows no terminal |
//! | `blocks.rs` | a picture as text |
//! | `screen.rs` | what stands on the terminal, and which of its lines change |
//! | `terminal.rs` | the live loop, and `--frames` |
//! | `window.rs` | the same in a window, with the feature `window` |

mod blocks;
pub mod screen;
mod show;
mod state;
mod terminal;
#[cfg(feature = "window")]
mod window;

pub use blocks::{Colours, half_blocks, nearest};
pub use show::{Scenery, Shown};
pub use state::{KEYS, State, Step};

use crate::args::{ViewArgs, is_scene};
use crate::draw::DrawFailure;
use crate::model::{Model, obj_text};
use crate::scene_file::Loaded;
use std::error::Error;
use std::path::Path;

/// Shows a model, or the teapot where none is named.
///
/// # Errors
/// A model that cannot be read or drawn; no terminal to show it on, unless `--frames` is given.
pub fn run(args: &ViewArgs) -> Result<(), Box<dyn Error>> {
    if let Some(file) = args.model.as_ref().filter(|file| is_scene(file)) {
        return run_scene(args, file);
    }
    let file = args.model.as_deref().unwrap_or(Path::new("teapot.obj"));
    let model = match &args.model {
        Some(_) => Model::load(file)?,
        None => {
            let text = obj_text(&scenes::TEAPOT).ok_or("a mesh of triangles")?;
            Model::from_obj_text(&text, file)?
        }
    };
    let scenery = Scenery::new(&model).map_err(|error| error.named(file))?;
    let state = State::new(args);
    show_named(args, &scenery, state)?;
    // Last: a terminal shows its own screen until then.
    model.print_warnings();
    for note in scenery.notes() {
        tell!("note: {note}");
    }
    Ok(())
}

/// Shows a scene, from its camera at first.
fn run_scene(args: &ViewArgs, file: &Path) -> Result<(), Box<dyn Error>> {
    let loaded = Loaded::load(file)?;
    let named = |failure: DrawFailure| format!("{}: {failure}", file.display());
    let scenery = Scenery::of_scene(&loaded).map_err(named)?;
    let state = State::of_scene(args, &loaded.scene);
    show_named(args, &scenery, state)?;
    for note in scenery.notes() {
        tell!("note: {note}");
    }
    Ok(())
}

/// Shows it; what cannot be drawn is named by its file.
fn show_named(args: &ViewArgs, scenery: &Scenery<'_>, state: State) -> Result<(), Box<dyn Error>> {
    show(args, scenery, state).map_err(|error| -> Box<dyn Error> {
        match (error.downcast::<DrawFailure>(), &args.model) {
            (Ok(failure), Some(file)) => format!("{}: {failure}", file.display()).into(),
            (Ok(failure), None) => failure.to_string().into(),
            (Err(error), _) => error,
        }
    })
}

fn show(args: &ViewArgs, scenery: &Scenery<'_>, state: State) -> Result<(), Box<dyn Error>> {
    #[cfg(feature = "window")]
    if args.window {
        return window::run(scenery, state, args.size);
    }
    match args.frames {
        Some(frames) => terminal::print(scenery, state, args.size, args.colours, frames),
        None => terminal::live(scenery, state, args.size, args.colours),
    }
}
