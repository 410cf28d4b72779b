//! The firmware of `small.rs` with every look at once, and with the code for values that few draw calls have and for shadows.
//!
//! It is there to be measured: `budgets` fails where its `.text` is above the limit in
//! `host-tests/figures/budgets.txt`. One look draws what any of them draws: which it is, each draw call says. It prints
//! a line `picture` for each way.
#![no_std]
#![no_main]

mod display;
mod lend;
mod room;

use cortex_m_rt::entry;
use display::{Display, buffers, display, exit, say};
use lend::lend;
use room::{Room, VERTICES, room, send};
use scanbeam::scene::DrawState;
use scanbeam::{Renderer, Scene};
use scenes::{Shot, ShotError, Suite, TexturedPhongLook, WIDTH, lamplit_teapot, teapot_lamps};

#[entry]
fn main() -> ! {
    let mut display = display(buffers!());
    let counts = lend!(".fast", u8, WIDTH as usize, 0);
    let Ok(lamps) = teapot_lamps() else {
        exit(false)
    };
    let mut room = room!(TexturedPhongLook, VERTICES, textured);
    let teapot = Suite::Teapot;
    show(&mut room, counts, teapot, &mut display, |scene| {
        teapot.build(scene)
    });
    say("teapot_untextured", &mut display);
    show(&mut room, counts, Suite::B, &mut display, |scene| {
        Suite::B.build(scene)
    });
    say("b", &mut display);
    show(&mut room, counts, teapot, &mut display, |scene| {
        lamplit_teapot(&lamps, scene)
    });
    say("teapot_lamplit", &mut display);
    exit(true)
}

/// Sends the scene that `build` makes, over the background of one of the suite.
fn show<'t>(
    room: &mut Room<TexturedPhongLook>,
    counts: &mut [u8],
    suite: Suite,
    display: &mut Display,
    build: impl FnOnce(&mut Scene<'_, 't, TexturedPhongLook>) -> Result<(), ShotError>,
) {
    let mut draws = [DrawState::EMPTY];
    let (memory, lines) = room.lend(&mut draws);
    let mut scene = Scene::new(Shot::screen(), memory);
    let built = build(&mut scene);
    let renderer = Renderer::with_shadows(lines, counts);
    send(built, &scene, renderer, suite.background(), display);
}
