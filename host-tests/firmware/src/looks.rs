//! The firmware of `small.rs` with every look, and with the code for values that few draw calls have and for shadows.
//!
//! It is there to be measured: `budgets` fails where its `.text` is above the limit in
//! `host-tests/figures/budgets.txt`. It prints a line `picture` for each look.
#![no_std]
#![no_main]

mod display;
mod lend;
mod room;

use cortex_m_rt::entry;
use display::{Display, buffers, display, exit, say};
use lend::lend;
use room::{Room, VERTICES, room, send};
use scanbeam::light::PixelLamps;
use scanbeam::look::Look;
use scanbeam::pixel::Rgb565Be;
use scanbeam::scene::DrawState;
use scanbeam::{Renderer, Scene};
use scenes::{
    PhongLook, Shot, ShotError, SmoothLook, Suite, TexturedLook, TexturedPhongLook, WIDTH,
    lamplit_teapot, teapot_lamps,
};

#[entry]
fn main() -> ! {
    let mut display = display(buffers!());
    let counts = lend!(".fast", u8, WIDTH as usize, 0);
    let Ok(lamps) = teapot_lamps() else {
        exit(false)
    };
    let teapot = Suite::Teapot;
    let mut room = room!(SmoothLook, VERTICES);
    show(&mut room, counts, teapot, &mut display, |scene| {
        teapot.build(scene)
    });
    say("teapot", &mut display);
    let mut room = room!(TexturedLook, VERTICES, textured);
    show(&mut room, counts, Suite::B, &mut display, |scene| {
        Suite::B.build(scene)
    });
    say("b", &mut display);
    lit::<PhongLook>(
        &mut room!(PhongLook, VERTICES),
        counts,
        &lamps,
        &mut display,
    );
    lit::<TexturedPhongLook>(
        &mut room!(TexturedPhongLook, VERTICES),
        counts,
        &lamps,
        &mut display,
    );
    exit(true)
}

/// The teapot with light at each pixel.
fn lit<L: Look<Pixel = Rgb565Be> + 'static>(
    room: &mut Room<L>,
    counts: &mut [u8],
    lamps: &Option<PixelLamps>,
    display: &mut Display,
) {
    show(room, counts, Suite::Teapot, display, |scene| {
        lamplit_teapot(lamps, scene)
    });
    say("teapot_lamplit", display);
}

/// Sends the scene that `build` makes, over the background of one of the suite.
fn show<'t, L: Look<Pixel = Rgb565Be> + 'static>(
    room: &mut Room<L>,
    counts: &mut [u8],
    suite: Suite,
    display: &mut Display,
    build: impl FnOnce(&mut Scene<'_, 't, L>) -> Result<(), ShotError>,
) {
    let mut draws = [DrawState::EMPTY];
    let (memory, lines) = room.lend(&mut draws);
    let mut scene = Scene::<L>::new(Shot::screen(), memory);
    let built = build(&mut scene);
    let renderer = Renderer::with_shadows(lines, counts);
    send(built, &scene, renderer, suite.background(), display);
}
