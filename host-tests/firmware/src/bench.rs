//! What things cost, by instructions.
//!
//! | file | there |
//! |---|---|
//! | `lines.rs` | each line of a scene (X8), and pass one |
//! | `units.rs` | an active line, a span's entry, a triangle's set-up, a vertex |
//! | `growth.rs` | spheres of 72 to 20,000 triangles |
//!
//! Here are the kernels of the accuracy report, each alone, over long and over short spans: two equations
//! for what a pixel and what a span costs.
//!
//! All but LIRP are what the line renderer runs: a right triangle of [`LINES`] lines that is alone
//! on the picture, drawn once it is set up. What a span costs is then all that is not the pixels:
//! the line's entry, the active list, the edges, the planes' values.

mod growth;
mod lines;
mod methods;
mod units;

use crate::console::Console;
use crate::count::Counter;
use crate::rooms::Rooms;
use core::hint::black_box;
use scanbeam::pipeline::{
    Counted, DepthUse, FlatDepth, FlatPainter, GouraudDepth, GouraudPainter, Instance, LineDepth,
    LineMemory, LineRenderer, ObjectOf, Pipeline, Scene, SceneMemory, SceneVertex, WordOf, Worded,
};
use scanbeam::pixel::{Rgb565, Rgb888};
use scanbeam::stats::SpanCounts;
use scanbeam::{Camera, Cull, Faces, Link, Mesh, Screen};
use scanbeam_model::{
    ModelRenderer, PipeMemory, SPAN_BITS, SpanWeight, divided_weight, lirp, round_to_8, widen,
};

/// Lines of a triangle. The first sets it up, and is not counted.
const LINES: u16 = 63;
/// Pixels of a line.
const WIDTH: u16 = 320;
/// Widest spans of a small triangle, and of any.
const WIDEST: [i32; 2] = [63, 320];
/// Widest spans where they are to be short.
const SHORT: i32 = 8;

/// Measures everything and prints it.
pub(crate) fn run(counter: &Counter, console: &mut Console, rooms: &mut Rooms) {
    kernels(counter, console);
    units::run(counter, console);
    lines::run(counter, console, rooms);
    growth::run(counter, console, rooms);
}

/// Times all kernels and prints them.
fn kernels(counter: &Counter, console: &mut Console) {
    let mut print = |name: &str, (instructions, counts): (u64, SpanCounts)| {
        console.line(format_args!(
            "kernel name={name} pixels={} spans={} instructions={instructions}",
            counts.pixels_shaded, counts.spans
        ));
    };
    // A triangle of 64 lines is no small one: one line more than is drawn makes it that.
    for (small, tall) in [(true, LINES), (false, LINES + 1)] {
        for width in [WIDEST[usize::from(!small)], SHORT] {
            let at = (width, tall);
            let name = |a, b| if small { a } else { b };
            print(
                name("packed_565", "packed_565_large"),
                planes::<GouraudPainter<Rgb565>>(at, counter),
            );
            print(
                name("packed_888", "packed_888_large"),
                planes::<GouraudPainter<Rgb888>>(at, counter),
            );
            print(
                name("packed_565_depth", "packed_565_large_depth"),
                planes::<GouraudDepth<Rgb565>>(at, counter),
            );
            // What it takes to read the line out of the words is in it.
            print(
                name("word_565", "word_565_large"),
                planes::<Worded<GouraudDepth<Rgb565>>>(at, counter),
            );
            print(
                name("flat_565_small", "flat_565"),
                planes::<FlatPainter<Rgb565>>(at, counter),
            );
            if !small {
                print("flat_565_depth", planes::<FlatDepth<Rgb565>>(at, counter));
                print(
                    "word_flat_565",
                    planes::<Worded<FlatDepth<Rgb565>>>(at, counter),
                );
                print("model_565", model(at, counter));
            }
        }
    }
    for width in [WIDEST[1], SHORT] {
        print("model_lirp_10", blend::<10>(width as u16, counter));
        print("model_lirp_12", blend::<12>(width as u16, counter));
        print("model_lirp_16", blend::<16>(width as u16, counter));
    }
    methods::run(counter, console);
}

/// A right triangle as wide and as tall as said, in pixels, and what is counted on it.
fn planes<P: Pipeline<Counter = ()>>(at: (i32, u16), counter: &Counter) -> (u64, SpanCounts) {
    let instructions = drawn::<P>(at, counter).0;
    (instructions, drawn::<Counted<P>>(at, counter).1)
}

#[inline(never)]
fn drawn<P: Pipeline>(at: (i32, u16), counter: &Counter) -> (u64, SpanCounts) {
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

/// The hardware model on the same triangle; the pixels are those of the fast path.
#[inline(never)]
fn model(at: (i32, u16), counter: &Counter) -> (u64, SpanCounts) {
    let counts = drawn::<Counted<GouraudPainter<Rgb565>>>(at, counter).1;
    let instructions = with_scene::<GouraudPainter<Rgb565>, _>(at, |scene| {
        let mut memory = [[0; WIDTH as usize]; 4];
        let [z0, z1, c0, c1] = &mut memory;
        let mut renderer = ModelRenderer::new(PipeMemory {
            z: [z0, z1],
            rgb: [c0, c1],
        });
        let mut pixels = [0; WIDTH as usize];
        counter.lines_finely(0..LINES, |line| {
            renderer
                .draw_line(scene, line, 0, black_box(&mut pixels))
                .expect("the memory suffices");
        })
    });
    (instructions, counts)
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

/// Spans by LIRP with `N` bits of W: by the circuit of W(X) for 10, by division for more.
#[inline(never)]
fn blend<const N: u32>(width: u16, counter: &Counter) -> (u64, SpanCounts) {
    let mut line = [[0u8; 3]; WIDTH as usize];
    let instructions = counter.finely(|| {
        for _ in 0..LINES {
            let pixels = black_box(&mut line[..usize::from(width)]);
            blend_span::<N>(pixels, black_box([[250, 10, 128], [3, 200, 90]]));
        }
    });
    let counts = SpanCounts {
        spans: LINES.into(),
        pixels_shaded: u32::from(LINES) * u32::from(width),
        ..SpanCounts::default()
    };
    (instructions, counts)
}

#[inline(never)]
fn blend_span<const N: u32>(pixels: &mut [[u8; 3]], ends: [[u8; 3]; 2]) {
    let [a, b] = ends.map(|end| end.map(|level| i64::from(widen(level.into(), 8, 10))));
    let length = 8 * pixels.len() as u16;
    let circuit = SpanWeight::new(length);
    for (pixel, distance) in pixels.iter_mut().zip((4..).step_by(8)) {
        let w = if N == SPAN_BITS {
            circuit.at(distance).into()
        } else {
            divided_weight(distance, length, N)
        };
        *pixel = [0, 1, 2].map(|i| round_to_8(lirp(a[i], b[i], w, N) as u16));
    }
}
