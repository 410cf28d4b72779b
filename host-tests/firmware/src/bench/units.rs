//! What one more triangle, active line, span or vertex costs: the difference between scenes that
//! have [`FEW`] and [`MANY`] of them and are the same otherwise.
//!
//! | unit | what is counted twice |
//! |---|---|
//! | `active_line` | a triangle that is active on a line and lies between two pixels there |
//! | `span` | one with pixels there, on a line without overlap; its active line and pixels taken off |
//! | `span_depth` | the same where depth is tested |
//! | `triangle_setup_small`, `_large` | a triangle's first line, an ordinary line of it taken off |
//! | `triangle_filed`, `triangle_culled` | a face of known vertices in pass one, from front and back |
//! | `vertex` | a lit vertex in pass one |

use super::{LINES, WIDTH};
use crate::console::Console;
use crate::count::Counter;
use crate::frames::Smooth;
use core::hint::black_box;
use scanbeam::pipeline::{
    DepthUse, Instance, LineMemory, LineRenderer, ObjectOf, Scene, SceneMemory, VertexOf,
};
use scanbeam::{Camera, Faces, Light, Link, Mesh, Screen};

/// Things of the smaller scene.
const FEW: usize = 8;
/// Things of the larger one.
const MANY: usize = 16;
/// Lines that are measured, from the second on: on all of them every triangle is active.
const MEASURED: u16 = 25;
/// Pixels that triangles are apart that have none.
const APART: i32 = 20;

/// Measures all units and prints them.
pub(super) fn run(counter: &Counter, console: &mut Console) {
    let mut print = |name: &str, count: u64, instructions: u64| {
        console.line(format_args!(
            "unit name={name} count={count} instructions={instructions}"
        ));
    };
    let more = (MANY - FEW) as u64;
    let on_lines = more * u64::from(MEASURED);
    let between = difference(|count| lines(&Stand::between(count), DepthUse::WhereNeeded, counter));
    print("active_line", on_lines, between.instructions);
    for (name, depth_use) in [
        ("span", DepthUse::WhereNeeded),
        ("span_depth", DepthUse::Always),
    ] {
        let of = |width| difference(|count| lines(&Stand::fan(count, width), depth_use, counter));
        let (narrow, wide) = (of(4), of(7));
        // A line through both, at no pixels.
        let (dx, dy) = (
            (wide.pixels - narrow.pixels) as i64,
            wide.instructions as i64 - narrow.instructions as i64,
        );
        let entry = narrow.instructions as i64 - narrow.pixels as i64 * dy / dx;
        let entry = entry - between.instructions as i64;
        print(name, on_lines, entry.max(0) as u64);
    }
    for (name, small) in [
        ("triangle_setup_small", true),
        ("triangle_setup_large", false),
    ] {
        let of = |count| {
            let stand = if small {
                Stand::fan(count, 7)
            } else {
                Stand::large(count)
            };
            set_up(&stand, counter)
        };
        print(name, more, of(MANY).saturating_sub(of(FEW)));
    }
    for (name, front) in [("triangle_filed", true), ("triangle_culled", false)] {
        let of = |count| {
            pass_one(
                &Faced {
                    count,
                    front,
                    own: false,
                },
                counter,
            )
        };
        print(name, more, of(MANY).saturating_sub(of(FEW)));
    }
    let of = |own| {
        pass_one(
            &Faced {
                count: MANY,
                front: true,
                own,
            },
            counter,
        )
    };
    print(
        "vertex",
        3 * (MANY as u64 - 1),
        of(true).saturating_sub(of(false)),
    );
}

/// Instructions, and the pixels that were drawn.
#[derive(Clone, Copy)]
struct Drawn {
    instructions: u64,
    pixels: u64,
}

/// What the larger scene has more than the smaller.
fn difference(of: impl Fn(usize) -> Drawn) -> Drawn {
    let (few, many) = (of(FEW), of(MANY));
    Drawn {
        instructions: many.instructions.saturating_sub(few.instructions),
        pixels: many.pixels.saturating_sub(few.pixels),
    }
}

/// Triangles side by side, all active on every line that is measured.
struct Stand {
    corners: [[[i32; 3]; 3]; MANY],
    count: usize,
}

impl Stand {
    /// A fan without gaps, each triangle so many pixels wide at the top.
    fn fan(count: usize, width: i32) -> Self {
        let mut corners = [[[0; 3]; 3]; MANY];
        let (width, apex) = (8 * width, 4 * width * MANY as i32);
        for (i, corners) in (0..).zip(&mut corners) {
            let (left, right) = (width * i, width * (i + 1));
            *corners = [(left, 0), (apex, 8 * i32::from(LINES)), (right, 0)].map(place);
        }
        Self { corners, count }
    }

    /// With a pixel on line 0, and from there to line 52 between two columns of pixel centres.
    fn between(count: usize) -> Self {
        let mut corners = [[[0; 3]; 3]; MANY];
        for (i, corners) in (0..).zip(&mut corners) {
            let left = 8 * APART * i + 13;
            *corners = [(left, -52), (left, 428), (left + 8, -52)].map(place);
        }
        Self { corners, count }
    }

    /// Triangles of more lines and columns than small ones have, beside the picture but for their tips.
    fn large(count: usize) -> Self {
        let mut corners = [[[0; 3]; 3]; MANY];
        for (i, triangle) in (0..).zip(&mut corners) {
            let (left, right) = (8 * (400 + i), 8 * (500 + i));
            *triangle = [(left, 0), (8 * 300, 8 * i32::from(LINES)), (right, 0)].map(place);
        }
        Self { corners, count }
    }

    /// Draws them into `scene`.
    fn draw(&self, scene: &mut Scene<'_, Smooth>) {
        scene.begin(&camera()).expect("the buckets suffice");
        let mesh = Mesh {
            positions: self.corners.as_flattened(),
            normals: &[],
            colours: &COLOURS,
            faces: Faces::Triangles(&FACES[..self.count]),
        };
        scene
            .draw(&mesh, &Instance::default())
            .expect("the arenas suffice");
    }
}

/// Corner colours, differing within a triangle.
const COLOURS: [[u8; 3]; 3 * MANY] = {
    let mut colours = [[255, 0, 30]; 3 * MANY];
    let mut i = 0;
    while i < MANY {
        colours[3 * i + 1] = [0, 200, 60];
        colours[3 * i + 2] = [90, 255, 255];
        i += 1;
    }
    colours
};

/// Triangles of three vertices each.
const FACES: [[u16; 3]; MANY] = {
    let mut faces = [[0; 3]; MANY];
    let mut i = 0;
    while i < MANY as u16 {
        faces[i as usize] = [3 * i, 3 * i + 1, 3 * i + 2];
        i += 1;
    }
    faces
};

/// Looks along -z: at distance 1 a focal length of 4096 pixels makes 2^-15 of a coordinate an
/// eighth of a pixel.
fn camera() -> Camera {
    let (eye, at, up) = ([0.0; 3], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
    Camera::look_at(eye, at, up, 4096.0, 0.5, 2.0).expect("the camera is legal")
}

/// Where a vertex is that shows at a place of the picture, in eighths of a pixel.
fn place((x, y): (i32, i32)) -> [i32; 3] {
    let x = x - 4 * i32::from(WIDTH);
    let y = y - 4 * i32::from(LINES);
    [x << 15, -(y << 15), -1 << 30]
}

/// Lends memory for a scene of a few triangles.
fn with_scene<R>(with: impl FnOnce(&mut Scene<'_, Smooth>) -> R) -> R {
    let mut vertices = [VertexOf::<Smooth>::empty(); 3 * MANY];
    let mut objects = [ObjectOf::<Smooth>::default(); MANY];
    let mut buckets = [Link::NONE; LINES as usize];
    let memory = SceneMemory {
        vertices: &mut vertices,
        objects: &mut objects,
        buckets: &mut buckets,
    };
    let screen = Screen::new(WIDTH, LINES).expect("the size is legal");
    with(&mut Scene::new(screen, memory))
}

/// Lends memory for a renderer that tests depth where it has to, or always.
fn with_renderer<R>(
    depth_use: DepthUse,
    with: impl FnOnce(&mut LineRenderer<'_, Smooth>) -> R,
) -> R {
    let mut slots = [(); MANY].map(|()| LineRenderer::<Smooth>::empty_slot());
    let mut links = [Link::NONE; MANY];
    let mut depth = [0; WIDTH as usize];
    let mut renderer = LineRenderer::new(LineMemory {
        slots: &mut slots,
        links: &mut links,
        depth: &mut depth,
    });
    renderer.set_depth_use(depth_use);
    with(&mut renderer)
}

/// What all [`MEASURED`] lines cost, and how many pixels they have.
#[inline(never)]
fn lines(stand: &Stand, depth_use: DepthUse, counter: &Counter) -> Drawn {
    with_scene(|scene| {
        stand.draw(scene);
        with_renderer(depth_use, |renderer| {
            let mut pixels = [0; WIDTH as usize];
            let mut all = |first: u16, last: u16, drawn: &mut u64| {
                for line in first..=last {
                    pixels.fill(0);
                    let done = renderer.draw_line(scene, line, black_box(&mut pixels));
                    done.expect("the memory suffices");
                    *drawn += pixels.iter().filter(|pixel| **pixel != 0).count() as u64;
                }
            };
            let mut drawn = 0;
            all(0, 0, &mut 0);
            all(1, MEASURED, &mut drawn);
            let timed = |renderer: &mut LineRenderer<'_, Smooth>, pixels: &mut [u16], last| {
                counter.finely(|| {
                    renderer.restart();
                    for line in 0..=last {
                        let done = renderer.draw_line(scene, line, black_box(pixels));
                        done.expect("the memory suffices");
                    }
                })
            };
            let with_first = timed(renderer, &mut pixels, MEASURED);
            Drawn {
                instructions: with_first - timed(renderer, &mut pixels, 0),
                pixels: drawn,
            }
        })
    })
}

/// What the first line costs beyond the one after it.
#[inline(never)]
fn set_up(stand: &Stand, counter: &Counter) -> u64 {
    with_scene(|scene| {
        stand.draw(scene);
        with_renderer(DepthUse::WhereNeeded, |renderer| {
            let mut pixels = [0; WIDTH as usize];
            let mut timed = |last| {
                counter.finely(|| {
                    renderer.restart();
                    for line in 0..=last {
                        let done = renderer.draw_line(scene, line, black_box(&mut pixels));
                        done.expect("the memory suffices");
                    }
                })
            };
            let (one, two) = (timed(0), timed(1));
            one - (two - one)
        })
    })
}

/// Faces that lie on each other, as pass one sees them.
struct Faced {
    count: usize,
    /// Counter-clockwise.
    front: bool,
    /// Each has vertices of its own; else all have the first one's.
    own: bool,
}

/// What pass one costs.
#[inline(never)]
fn pass_one(faced: &Faced, counter: &Counter) -> u64 {
    const NORMALS: [[i16; 3]; 3 * MANY] = [[4_000, 9_000, 13_000]; 3 * MANY];
    let corners = [[(80, 0), (80, 8 * i32::from(LINES)), (480, 0)].map(place); MANY];
    let vertices = if faced.own { 3 * faced.count } else { 3 };
    let faces = [(); MANY].map(|()| [0, 1, 2]);
    let mut faces = if faced.own { FACES } else { faces };
    if !faced.front {
        for face in &mut faces {
            face.swap(0, 1);
        }
    }
    let mesh = Mesh {
        positions: &corners.as_flattened()[..vertices],
        normals: &NORMALS[..vertices],
        colours: &COLOURS[..vertices],
        faces: Faces::Triangles(&faces[..faced.count]),
    };
    let instance = Instance {
        light: Light::new([0.5, 0.7, 0.8], 0.15),
        ..Instance::default()
    };
    with_scene(|scene| {
        counter.finely(|| {
            scene.begin(&camera()).expect("the buckets suffice");
            let done = scene.draw(black_box(&mesh), &instance);
            done.expect("the arenas suffice");
        })
    })
}
