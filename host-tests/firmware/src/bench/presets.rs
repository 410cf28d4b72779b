//! A triangle by a preset, for the kernels of methods.

use super::{LINES, WIDEST, WIDTH};
use crate::count::Counter;
use core::hint::black_box;
use scanbeam::pipeline::{
    DepthUse, Instance, LineDepth, LineMemory, LineRenderer, ObjectOf, Pipeline, Scene,
    SceneMemory, SceneVertex, WordOf,
};
use scanbeam::stats::SpanCounts;
use scanbeam::{Camera, Cull, Faces, Link, Mesh, Screen};

#[inline(never)]
pub(super) fn drawn<P: Pipeline>(at: (i32, u16), counter: &Counter) -> (u64, SpanCounts) {
    with_scene::<P, _>(at, |scene| {
        let mut slots = [(); 2].map(|()| LineRenderer::<P>::empty_slot());
        let mut depth = [P::Depth::FARTHEST; WIDTH as usize];
        let mut pixels = [WordOf::<P>::default(); WIDTH as usize];
        let mut links = [Link::NONE; 2];
        let mut renderer = LineRenderer::new(LineMemory::<P> {
            slots: &mut slots,
            links: &mut links,
            depth: &mut depth,
        });
        renderer.set_depth_use(DepthUse::Always);
        let instructions = counter.lines_finely(0..LINES, |line| {
            if line == 0 {
                // What is counted is of the lines from here on.
                renderer.take_span_counts();
            }
            renderer
                .draw_line(scene, line, black_box(&mut pixels))
                .expect("the memory suffices");
        });
        let mut counts = renderer.take_span_counts();
        // The first line's span, which is as wide as the triangle but for half a line's part.
        let first = with_first(scene, &mut pixels);
        counts.spans = counts.spans.saturating_sub(first.spans);
        counts.pixels_shaded = counts.pixels_shaded.saturating_sub(first.pixels_shaded);
        (instructions, counts)
    })
}

/// What is counted on the first line alone.
fn with_first<P: Pipeline>(scene: &Scene<'_, P>, pixels: &mut [WordOf<P>]) -> SpanCounts {
    let mut slots = [(); 2].map(|()| LineRenderer::<P>::empty_slot());
    let mut links = [Link::NONE; 2];
    let mut depth = [P::Depth::FARTHEST; WIDTH as usize];
    let mut renderer = LineRenderer::new(LineMemory::<P> {
        slots: &mut slots,
        links: &mut links,
        depth: &mut depth,
    });
    renderer
        .draw_line(scene, 0, pixels)
        .expect("the memory suffices");
    renderer.take_span_counts()
}

/// Hands a scene of one triangle to `with`.
fn with_scene<P: Pipeline, R>(
    (width, tall): (i32, u16),
    with: impl FnOnce(&Scene<'_, P>) -> R,
) -> R {
    let screen = Screen::new(WIDTH, tall).expect("the size is legal");
    let mut vertices = [SceneVertex::empty(); 4];
    let mut objects = [ObjectOf::<P>::default(); 2];
    let mut buckets = [Link::NONE; LINES as usize + 1];
    let mut scene = Scene::<P>::new(
        screen,
        SceneMemory {
            vertices: &mut vertices,
            objects: &mut objects,
            buckets: &mut buckets,
        },
    );
    // At distance 1 a focal length of 4096 pixels makes 2^-15 of a coordinate an eighth of a pixel.
    let camera = Camera::look_at(
        [0.0; 3],
        [0.0, 0.0, -1.0],
        [0.0, 1.0, 0.0],
        4096.0,
        0.5,
        2.0,
    )
    .expect("the camera is legal");
    scene.begin(&camera).expect("the buckets suffice");
    let tall = i32::from(tall);
    // An odd side moves the principal point by half a pixel, and the picture with it.
    let vertex = |x: i32, y: i32| {
        let x = 8 * x - 4 * i32::from(WIDTH);
        let y = 8 * y - 4 * tall;
        [x << 15, -(y << 15), -1 << 30]
    };
    let positions = [vertex(0, 0), vertex(width, 0), vertex(0, tall)];
    // The slope of colours is that of the widest triangle, or narrow ones would be too steep to be
    // set up as small.
    let widest = WIDEST[usize::from(tall > i32::from(LINES))];
    let [left, right]: [[i32; 3]; 2] = [[255, 0, 30], [0, 200, 60]];
    let right = [0, 1, 2].map(|i| left[i] + (right[i] - left[i]) * width / widest);
    let mesh = Mesh {
        positions: &positions,
        normals: &[],
        colours: &[left, right, [90, 255, 255]].map(|c| c.map(|level| level as u8)),
        faces: Faces::Triangles(&[[0, 1, 2]]),
    };
    let instance = Instance {
        cull: Cull::None,
        ..Instance::default()
    };
    scene.draw(&mesh, &instance).expect("the arenas suffice");
    with(&scene)
}
