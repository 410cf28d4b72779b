//! How the cost of a frame grows with its triangles: spheres of 72 to 20,000 triangles at one size
//! on the picture, with few slots and with a slot for everything.

use crate::console::Console;
use crate::count::Counter;
use crate::frames::Smooth;
use crate::lend::lend;
use crate::rooms::Rooms;
use core::hint::black_box;
use scanbeam::Link;
use scanbeam::pipeline::{LineMemory, LineRenderer, ObjectOf, Scene, SceneMemory, VertexOf};
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scenes::{HEIGHT, MOST_SLOTS, OCTASPHERES, Octasphere, Shot, WIDTH};

/// Slots where there are few.
const FEW: usize = 64;

/// Draws all spheres and prints what they cost.
pub(super) fn run(counter: &Counter, console: &mut Console, rooms: &mut Rooms) {
    let positions = lend!(".slow", [i16; 3], Octasphere::MOST_VERTICES, [0; 3]);
    let faces = lend!(".slow", [u16; 3], Octasphere::MOST_FACES, [0; 3]);
    let vertices = lend!(
        ".slow",
        VertexOf<Smooth>,
        Octasphere::MOST_VERTICES,
        VertexOf::<Smooth>::empty()
    );
    let objects = lend!(
        ".slow",
        ObjectOf<Smooth>,
        Octasphere::MOST_FACES,
        ObjectOf::<Smooth>::default()
    );
    let links = lend!(".slow", Link, Octasphere::MOST_FACES, Link::NONE);
    let mut buckets = [Link::NONE; HEIGHT as usize];
    let screen = Shot::screen();
    for parts in OCTASPHERES {
        let sphere = Octasphere::new(parts, positions, faces).expect("the rooms suffice");
        let mut scene = Scene::<Smooth>::new(
            screen,
            SceneMemory {
                vertices,
                objects,
                buckets: &mut buckets,
            },
        );
        let mut build = || sphere.draw(&mut scene).expect("the rooms suffice");
        let pass_one = counter.finely(&mut build);
        for slots in [FEW, MOST_SLOTS] {
            let mut renderer = LineRenderer::new(LineMemory {
                slots: &mut rooms.second.slots[..slots],
                links,
                depth: rooms.smooth.depth,
            });
            let mut pixels = [0; WIDTH as usize];
            let background = Rgb565Be::from_rgb8([0; 3]);
            let pass_two = counter.finely(|| {
                renderer.restart();
                for line in 0..HEIGHT {
                    Rgb565Be::fill(&mut pixels, background);
                    let done = renderer.draw_line(&scene, line, black_box(&mut pixels));
                    done.expect("the rooms suffice");
                }
            });
            console.line(format_args!(
                "growth slots={slots} triangles={} objects={} pass_one={pass_one} pass_two={pass_two}",
                sphere.triangles(),
                scene.pass_one().objects,
            ));
        }
    }
}
