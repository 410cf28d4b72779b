//! What one more triangle, active line, span or vertex costs: the difference between scenes that
//! have [`FEW`] and [`MANY`] of them and are the same otherwise.
//!
//! | unit | what is counted twice |
//! |---|---|
//! | `active_line` | a triangle that is active on a line and lies between two pixels there |
//! | `span` | one with pixels there, on a line without overlap; its active line and pixels taken off |
//! | `slotless_line` | the same of one that found no slot, its pixels taken off |
//! | `triangle_setup_small`, `_large`, `_textured` | a triangle's first line, an ordinary line of it taken off |
//! | `triangle_filed`, `triangle_culled` | a face of known vertices in pass one, from front and back |
//! | `vertex` | a lit vertex in pass one |

use super::{LINES, WIDTH};
use crate::console::Console;
use crate::count::Counter;
use crate::rooms::{LineRooms, Rooms, SceneRooms};
use core::hint::black_box;
use scanbeam::frame::FastMemory;
use scanbeam::look::Look;
use scanbeam::pixel::Rgb565Be;
use scanbeam::scene::{Budget, Skin};
use scanbeam::{Camera, Draw, Faces, Light, Mesh, Scene, Screen};
use scenes::{SmoothLook, Suite, TexturedLook};

/// Things of the smaller scene.
const FEW: usize = 8;
/// Things of the larger one.
const MANY: usize = 16;
/// Lines that are measured, from the second on: on all of them every triangle is active.
const MEASURED: u16 = 25;
/// Pixels that triangles are apart that have none.
const APART: i32 = 20;

/// Slots of the caches.
const SLOTS: u16 = 64;

/// Measures all units and prints them.
pub(super) fn run(counter: &Counter, console: &mut Console, rooms: &mut Rooms) {
    let mut print = |name: &str, count: u64, instructions: u64| {
        console.line(format_args!(
            "unit name={name} count={count} instructions={instructions}"
        ));
    };
    let more = (MANY - FEW) as u64;
    let on_lines = more * u64::from(MEASURED);
    let mut bench = Bench { counter, rooms };
    let between = difference(|count| bench.lines(&Stand::between(count)));
    print("active_line", on_lines, between.instructions);
    for (name, slots) in [("span", SLOTS), ("slotless_line", 0)] {
        bench.rooms.caches.smooth.set_limit(slots);
        let mut of = |width| difference(|count| bench.lines(&Stand::fan(count, width)));
        let (narrow, wide) = (of(4), of(7));
        // A line through both, at no pixels.
        let (dx, dy) = (
            (wide.pixels - narrow.pixels) as i64,
            wide.instructions as i64 - narrow.instructions as i64,
        );
        let entry = narrow.instructions as i64 - narrow.pixels as i64 * dy / dx;
        let known = if slots > 0 { between.instructions } else { 0 };
        print(name, on_lines, (entry - known as i64).max(0) as u64);
    }
    bench.rooms.caches.smooth.set_limit(SLOTS);
    let set_up = |of: &mut dyn FnMut(usize) -> u64| of(MANY).saturating_sub(of(FEW));
    let small = set_up(&mut |count| bench.set_up(&Stand::fan(count, 7)));
    print("triangle_setup_small", more, small);
    let large = set_up(&mut |count| bench.set_up(&Stand::large(count)));
    print("triangle_setup_large", more, large);
    let textured = set_up(&mut |count| bench.set_up_textured(&Stand::fan(count, 7)));
    print("triangle_setup_textured", more, textured);
    for (name, front) in [("triangle_filed", true), ("triangle_culled", false)] {
        let mut of = |count| {
            bench.pass_one(&Faced {
                count,
                front,
                own: false,
            })
        };
        print(name, more, of(MANY).saturating_sub(of(FEW)));
    }
    let mut of = |own| {
        bench.pass_one(&Faced {
            count: MANY,
            front: true,
            own,
        })
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
fn difference(mut of: impl FnMut(usize) -> Drawn) -> Drawn {
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

    /// Draws them into `scene`, with the texture of scene F where that is asked.
    fn draw<L: Look>(&self, is_textured: bool, scene: &mut Scene<'_, 'static, L>) {
        scene.begin(&camera()).expect("a bin for each line");
        let mesh = Mesh {
            positions: self.corners.as_flattened(),
            normals: &[],
            colours: &COLOURS,
            faces: Faces::Triangles(&FACES[..self.count]),
        };
        let skin = |texture| Skin {
            texture,
            places: &PLACES,
            budget: Budget::BALANCED,
        };
        let call = Draw {
            texture: Suite::F.texture().filter(|_| is_textured).map(skin),
            ..Draw::new(mesh)
        };
        scene.draw(&call).expect("the rooms suffice");
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

/// Places of corners on the texture.
const PLACES: [[i32; 2]; 3 * MANY] = {
    let mut places = [[0; 2]; 3 * MANY];
    let mut i = 0;
    while i < MANY {
        places[3 * i + 1] = [2_000, 12_000];
        places[3 * i + 2] = [1_800, 0];
        i += 1;
    }
    places
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

/// What units are measured with.
struct Bench<'b> {
    counter: &'b Counter,
    rooms: &'b mut Rooms,
}

/// The size of the picture.
fn screen() -> Screen {
    Screen::new(WIDTH, LINES).expect("the size is legal")
}

/// Faces that lie on each other, as pass one sees them.
struct Faced {
    count: usize,
    /// Counter-clockwise.
    front: bool,
    /// Each has vertices of its own; else all have the first one's.
    own: bool,
}

impl Bench<'_> {
    /// What all [`MEASURED`] lines cost, and how many pixels they have.
    #[inline(never)]
    fn lines(&mut self, stand: &Stand) -> Drawn {
        let mut scene = self.rooms.scene.sized::<SmoothLook>(screen());
        stand.draw(false, &mut scene);
        let mut renderer = self.rooms.lines.renderer(self.rooms.caches.smooth);
        let mut pixels = [0; WIDTH as usize];
        let mut drawn = 0;
        for line in 0..=MEASURED {
            let done = renderer.draw_line(&scene, line, black_box(&mut pixels), 0);
            done.expect("the rooms suffice");
            if line > 0 {
                drawn += pixels.iter().filter(|pixel| **pixel != 0).count() as u64;
            }
        }
        let mut timed = |last| {
            self.counter.finely(|| {
                renderer.restart();
                for line in 0..=last {
                    let done = renderer.draw_line(&scene, line, black_box(&mut pixels), 0);
                    done.expect("the rooms suffice");
                }
            })
        };
        Drawn {
            instructions: timed(MEASURED) - timed(0),
            pixels: drawn,
        }
    }

    /// What the first line costs beyond the one after it.
    fn set_up(&mut self, stand: &Stand) -> u64 {
        let Rooms {
            scene,
            lines,
            caches,
            ..
        } = &mut *self.rooms;
        first_line::<SmoothLook>(stand, false, self.counter, scene, lines, caches.smooth)
    }

    /// The same with a texture.
    fn set_up_textured(&mut self, stand: &Stand) -> u64 {
        let Rooms {
            scene,
            lines,
            caches,
            ..
        } = &mut *self.rooms;
        first_line::<TexturedLook>(stand, true, self.counter, scene, lines, caches.textured)
    }

    /// What pass one costs.
    #[inline(never)]
    fn pass_one(&mut self, faced: &Faced) -> u64 {
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
        let call = Draw {
            light: Light::new([0.5, 0.7, 0.8], 0.15),
            ..Draw::new(mesh)
        };
        let mut scene = self.rooms.scene.sized::<SmoothLook>(screen());
        self.counter.finely(|| {
            scene.begin(&camera()).expect("a bin for each line");
            let done = scene.draw(black_box(&call));
            done.expect("the rooms suffice");
        })
    }
}

/// What the first line of some triangles costs beyond the one after it.
#[inline(never)]
fn first_line<L: Look<Pixel = Rgb565Be>>(
    stand: &Stand,
    is_textured: bool,
    counter: &Counter,
    scene: &mut SceneRooms,
    lines: &mut LineRooms,
    cache: &mut FastMemory<L>,
) -> u64 {
    let mut scene = scene.sized::<L>(screen());
    stand.draw(is_textured, &mut scene);
    let mut renderer = lines.renderer(cache);
    let mut pixels = [0; WIDTH as usize];
    let mut timed = |last| {
        counter.finely(|| {
            renderer.restart();
            for line in 0..=last {
                let done = renderer.draw_line(&scene, line, black_box(&mut pixels), 0);
                done.expect("the rooms suffice");
            }
        })
    };
    let (one, two) = (timed(0), timed(1));
    one - (two - one)
}
