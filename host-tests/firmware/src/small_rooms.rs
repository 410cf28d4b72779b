//! A small firmware in the rooms `scene`, `look` and `frame`: the teapot with smooth colours and depth, sent line by
//! line; with the feature `rooms-textured` a sphere whose texture is lit.
//!
//! It is there to be measured: `budgets` fails where its `.text` is above the limit in
//! `host-tests/figures/budgets.txt`. It prints `picture NAME` and the picture's CRC-32.
#![no_std]
#![no_main]

mod lend;
mod small;

use cortex_m_rt::entry;
use lend::lend;
use scanbeam::Link;
use scanbeam::frame::{FastMemory, Memory as LineMemory, Renderer, draw_frame};
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scene::{DrawState, Memory, Object, Scene, TexturePlace, Vertex};
use scenes::{HEIGHT, Shot, Suite, WIDTH};
use small::{OBJECTS, VERTICES, buffers, display, exit, say};

#[cfg(not(feature = "rooms-textured"))]
type Look = scenes::LeanLook;
#[cfg(feature = "rooms-textured")]
type Look = scenes::LeanTextured;

#[cfg(not(feature = "rooms-textured"))]
const SHOWN: (&str, Suite, usize) = ("teapot", Suite::Teapot, 0);
#[cfg(feature = "rooms-textured")]
const SHOWN: (&str, Suite, usize) = ("b", Suite::B, VERTICES);

#[entry]
fn main() -> ! {
    const EMPTY: FastMemory<Look> = FastMemory::new();
    const PLACES: usize = SHOWN.2;
    let (name, suite, _) = SHOWN;
    let mut display = display(buffers!());
    let memory = Memory {
        vertices: lend!(".slow", Vertex, VERTICES, Vertex::EMPTY),
        places: lend!(".slow", TexturePlace, PLACES, TexturePlace::EMPTY),
        objects: lend!(".slow", Object, OBJECTS, Object::EMPTY),
        bins: lend!(".slow", u16, HEIGHT as usize, 0),
        draws: lend!(".slow", DrawState<'static>, 1, DrawState::EMPTY),
    };
    let mut scene = Scene::<Look>::new(Shot::screen(), memory);
    let cache: &'static mut [FastMemory<Look>] = lend!(".fast", FastMemory<Look>, 1, EMPTY);
    let Some(cache) = cache.first_mut() else {
        exit(false)
    };
    let mut renderer = Renderer::plain(LineMemory {
        cache,
        links: lend!(".slow", Link, OBJECTS, Link::EMPTY),
        depth: lend!(".fast", u32, WIDTH as usize, 0),
    });
    let background = Rgb565Be::from_rgb8(suite.background());
    let built = suite.build(&mut scene);
    let drawn = draw_frame(&scene, &mut renderer, &mut display, background, 1);
    if built.is_err() || drawn.is_err() {
        exit(false);
    }
    say(name, &mut display);
    exit(true)
}
