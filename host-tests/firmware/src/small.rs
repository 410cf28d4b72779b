//! A small firmware with one look: the teapot with smooth colours and depth, sent line by line; by features with flat
//! faces, with light at each pixel, or a sphere whose texture is lit, and with the code for values that few draw calls
//! have.
//!
//! It is there to be measured: `firmware --sizes` prints what it takes, and `budgets` fails where its `.text` is above
//! the limit in `host-tests/figures/budgets.txt`. It prints `picture NAME` and the picture's CRC-32.
#![no_std]
#![no_main]

mod display;
mod lend;
mod room;

use cortex_m_rt::entry;
use display::{buffers, display, exit, say};
use room::{VERTICES, room, send};
use scanbeam::scene::DrawState;
use scanbeam::{Renderer, Scene};
use scenes::Suite;

#[cfg(not(any(feature = "textured", feature = "phong")))]
type Look = scenes::SmoothLook;
#[cfg(feature = "textured")]
type Look = scenes::TexturedLook;
#[cfg(feature = "phong")]
type Look = scenes::PhongLook;

/// What the picture is called, and the scene of the suite.
#[cfg(not(any(feature = "flat", feature = "textured", feature = "phong")))]
const SHOWN: (&str, Suite) = ("teapot", Suite::Teapot);
#[cfg(feature = "flat")]
const SHOWN: (&str, Suite) = ("teapot_flat", Suite::Teapot);
#[cfg(feature = "textured")]
const SHOWN: (&str, Suite) = ("b", Suite::B);
#[cfg(feature = "phong")]
const SHOWN: (&str, Suite) = ("teapot_lamplit", Suite::Teapot);

/// A face of one colour takes three vertices.
const MORE: usize = if cfg!(feature = "flat") {
    3 * room::OBJECTS
} else {
    0
};

#[entry]
fn main() -> ! {
    let (name, suite) = SHOWN;
    let mut display = display(buffers!());
    #[cfg(not(feature = "textured"))]
    let mut room = room!(Look, VERTICES + MORE);
    #[cfg(feature = "textured")]
    let mut room = room!(Look, VERTICES + MORE, textured);
    #[cfg(feature = "phong")]
    let Ok(lamps) = scenes::teapot_lamps() else {
        exit(false)
    };
    let mut draws = [DrawState::EMPTY];
    let (memory, lines) = room.lend(&mut draws);
    let mut scene = Scene::<Look>::new(scenes::Shot::screen(), memory);
    #[cfg(not(any(feature = "flat", feature = "phong")))]
    let built = suite.build(&mut scene);
    #[cfg(feature = "flat")]
    let built = suite.build_shaded(scanbeam::scene::Shading::Flat, &mut scene);
    #[cfg(feature = "phong")]
    let built = scenes::lamplit_teapot(&lamps, &mut scene);
    #[cfg(not(feature = "values"))]
    let renderer = Renderer::plain(lines);
    #[cfg(feature = "values")]
    let renderer = Renderer::new(lines);
    send(built, &scene, renderer, suite.background(), &mut display);
    say(name, &mut display);
    exit(true)
}
