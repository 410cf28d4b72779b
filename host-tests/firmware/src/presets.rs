//! The firmware of `preset.rs` with everything that draws: all four presets and the hardware model.
//!
//! It is there to be measured: `budgets` fails where its `.text` is above the limit in
//! `host-tests/figures/budgets.txt`. It prints a line `picture` for each.
#![no_std]
#![no_main]

mod lend;
mod preset_room;
mod small;

use cortex_m_rt::entry;
use lend::lend;
use preset_room::{Room, room, teapot};
use scanbeam::pipeline::{
    FlatDepth, FlatPainter, GouraudDepth, GouraudPainter, Scene, SceneMemory,
};
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam_model::{ModelRenderer, PipeMemory, draw_model_frame};
use scenes::{Shot, WIDTH};
use small::{Display, buffers, display, exit, say};

#[entry]
fn main() -> ! {
    let mut display = display(buffers!());
    teapot(room!(GouraudDepth<Rgb565Be>, 0), &mut display);
    say("teapot", &mut display);
    teapot(room!(FlatDepth<Rgb565Be>, 0), &mut display);
    say("teapot_flat", &mut display);
    teapot(room!(GouraudPainter<Rgb565Be>, ()), &mut display);
    say("teapot_painter", &mut display);
    teapot(room!(FlatPainter<Rgb565Be>, ()), &mut display);
    say("teapot_flat_painter", &mut display);
    model(room!(GouraudDepth<Rgb565Be>, 0), &mut display);
    say("teapot_model", &mut display);
    exit(true)
}

/// The teapot by the hardware model.
fn model(room: Room<GouraudDepth<Rgb565Be>>, display: &mut Display) {
    let memory = SceneMemory::<GouraudDepth<Rgb565Be>> {
        vertices: room.vertices,
        objects: room.objects,
        buckets: room.buckets,
    };
    let mut scene = Scene::new(Shot::screen(), memory);
    let mut renderer = ModelRenderer::new(PipeMemory {
        z: [
            lend!(".slow", u64, WIDTH as usize, 0),
            lend!(".slow", u64, WIDTH as usize, 0),
        ],
        rgb: [
            lend!(".slow", u64, WIDTH as usize, 0),
            lend!(".slow", u64, WIDTH as usize, 0),
        ],
    });
    let background = Rgb565Be::from_rgb8(Shot::Teapot.background());
    let built = scenes::teapot(&mut scene);
    let drawn = draw_model_frame(&scene, &mut renderer, display, background, 1);
    if built.is_err() || drawn.is_err() {
        exit(false);
    }
}
