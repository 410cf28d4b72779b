//! How the cost of a frame grows with its triangles: spheres of 72 to 20,000 triangles at one size
//! on the picture, with few slots and with as many as a cache can have.

use crate::console::Console;
use crate::count::Counter;
use crate::lend::lend;
use crate::rooms::Rooms;
use core::hint::black_box;
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::{Renderer, Scene};
use scenes::{HEIGHT, MOST_SLOTS, OCTASPHERES, Octasphere, SmoothLook, WIDTH};

/// Slots where there are few.
const FEW: u16 = 64;

/// Draws all spheres and prints what they cost.
pub(super) fn run(counter: &Counter, console: &mut Console, rooms: &mut Rooms) {
    let positions = lend!(".slow", [i16; 3], Octasphere::MOST_VERTICES, [0; 3]);
    let faces = lend!(".slow", [u16; 3], Octasphere::MOST_FACES, [0; 3]);
    for parts in OCTASPHERES {
        let sphere = Octasphere::new(parts, positions, faces).expect("the rooms suffice");
        let mut scene = rooms.scene.scene();
        let pass_one = counter.finely(|| sphere.draw(&mut scene).expect("the rooms suffice"));
        let (few, wide) = (&mut *rooms.caches.smooth, &mut *rooms.caches.wide);
        let few = pass_two(counter, &scene, &mut rooms.lines.renderer(few));
        let most = pass_two(counter, &scene, &mut rooms.lines.renderer(wide));
        for (slots, pass_two) in [(FEW, few), (MOST_SLOTS, most)] {
            console.line(format_args!(
                "growth slots={slots} triangles={} objects={} pass_one={pass_one} pass_two={pass_two}",
                sphere.triangles(),
                scene.objects(),
            ));
        }
    }
}

/// What all lines cost.
#[inline(never)]
fn pass_two<const WORDS: usize>(
    counter: &Counter,
    scene: &Scene<'_, '_, SmoothLook>,
    renderer: &mut Renderer<'_, SmoothLook, WORDS>,
) -> u64 {
    let background = Rgb565Be::from_rgb8([0; 3]);
    let mut pixels = [background; WIDTH as usize];
    counter.finely(|| {
        renderer.restart();
        for line in 0..HEIGHT {
            let done = renderer.draw_line(scene, line, black_box(&mut pixels), background);
            done.expect("the rooms suffice");
        }
    })
}
