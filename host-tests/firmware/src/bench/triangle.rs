//! One triangle in the ways that draw calls have: what a pixel of it costs, and a span.
//!
//! | kernel | what is drawn |
//! |---|---|
//! | `smooth` | colours that are linear between the corners |
//! | `over` | the same before another one of its size, by depth: a pixel is one of both |
//! | `filter` | the same, half of what is behind shines through |
//! | `flat` | one colour |
//! | `texel` | a texture as it is |
//! | `texel_index4`, `_compressed`, `_cached` | one of 4 bits a texel: by a palette, by blocks that are decoded in each run, and by a cache of them |
//! | `texel_lit`, `texel_tinted` | the same times grey, and times colours |
//! | `leaning_fast`, `_balanced`, `_exact` | the texture on a triangle that leans back, within 1/2, 1/4 and 1/100 texel |
//!
//! | `model` | smooth, by the hardware model |
//!
//! With `_large` the triangle is of more lines and columns than what is set up as small.

use super::{LINES, Run, SHORT, WIDEST, WIDTH};
use crate::console::Console;
use crate::count::Counter;
use crate::lend::lend;
use crate::rooms::{LineRooms, Rooms, SceneRooms};
use core::hint::black_box;
use scanbeam::frame::FastMemory;
use scanbeam::look::{Gouraud, Look};
use scanbeam::pixel::{PixelFormat, Rgb565, Rgb888};
use scanbeam::scene::{Blend, BlockCache, Budget, CacheWord, Shading, Skin, Texture};
use scanbeam::{Camera, Cull, Draw, Faces, Mesh, Screen};
use scanbeam_model::{ModelRenderer, PipeMemory};
use scenes::{PLACES_F, STONE, SmoothLook, Suite, TEXEL_SIDE_F, TexturedLook};

/// A triangle as wide and as tall as said, in pixels.
#[derive(Clone, Copy)]
struct Size {
    width: i32,
    tall: u16,
}

/// What is drawn of it.
#[derive(Clone, Copy)]
enum Way {
    Smooth,
    Over,
    Filter,
    Flat,
    Texel,
    /// Of another texture.
    Of(&'static Texture<'static>),
    Lit,
    Tinted,
    Leaning(Budget),
}

const SMOOTH: [(&str, &str, Way); 4] = [
    ("smooth_565", "smooth_565_large", Way::Smooth),
    ("over_565", "over_565_large", Way::Over),
    ("filter_565", "filter_565_large", Way::Filter),
    ("flat_565", "flat_565_large", Way::Flat),
];

const TEXTURED: [(&str, &str, Way); 6] = [
    ("texel_565", "texel_565_large", Way::Texel),
    ("texel_lit_565", "texel_lit_565_large", Way::Lit),
    ("texel_tinted_565", "texel_tinted_565_large", Way::Tinted),
    (
        "leaning_fast_565",
        "leaning_fast_565_large",
        Way::Leaning(Budget::FAST),
    ),
    (
        "leaning_balanced_565",
        "leaning_balanced_565_large",
        Way::Leaning(Budget::BALANCED),
    ),
    (
        "leaning_exact_565",
        "leaning_exact_565_large",
        Way::Leaning(Budget::EXACT),
    ),
];

/// Texels by a palette, as many as the kernel `texel` has.
static INDEXED: Texture<'static> = {
    const BYTES: usize = (TEXEL_SIDE_F * TEXEL_SIDE_F) as usize / 2;
    match Texture::index4(&[0x93; BYTES], &[0xF81F; 16], TEXEL_SIDE_F, TEXEL_SIDE_F) {
        Ok(texture) => texture,
        Err(_) => panic!("as many bytes as the sides need"),
    }
};

/// Words of a cache of two rows of blocks.
const CACHED: usize = 512;

/// The ways of 4 bits a texel.
fn four_bits() -> [(&'static str, &'static str, Way); 3] {
    let words = lend!(".slow", CacheWord, CACHED, CacheWord::new());
    let cache = BlockCache::compressed(STONE, words).expect("a cache of two rows of blocks");
    let rooms = lend!(".slow", Option<BlockCache<'static>>, 1, None);
    let cache = rooms.first_mut().expect("one is lent").insert(cache);
    let textures = lend!(".slow", Texture<'static>, 2, STONE.texture());
    textures[1] = cache.texture();
    let [alone, cached] = &*textures else {
        panic!("two are lent")
    };
    [
        (
            "texel_index4_565",
            "texel_index4_565_large",
            Way::Of(&INDEXED),
        ),
        (
            "texel_compressed_565",
            "texel_compressed_565_large",
            Way::Of(alone),
        ),
        (
            "texel_cached_565",
            "texel_cached_565_large",
            Way::Of(cached),
        ),
    ]
}

/// Times all ways and prints them.
pub(super) fn run(counter: &Counter, console: &mut Console, rooms: &mut Rooms) {
    let four_bits = four_bits();
    // A triangle of 64 lines is no small one: one line more than is drawn makes it that.
    for (is_small, tall) in [(true, LINES), (false, LINES + 1)] {
        for width in [WIDEST[usize::from(!is_small)], SHORT] {
            let size = Size { width, tall };
            let name = |small, large| if is_small { small } else { large };
            let (scene, lines) = (&mut rooms.scene, &mut rooms.lines);
            for (small, large, way) in SMOOTH {
                let cache = &mut *rooms.caches.smooth;
                drawn::<SmoothLook>(way, size, counter, scene, lines, cache)
                    .print(name(small, large), console);
            }
            for (small, large, way) in TEXTURED.into_iter().chain(four_bits) {
                let cache = &mut *rooms.caches.textured;
                drawn::<TexturedLook>(way, size, counter, scene, lines, cache)
                    .print(name(small, large), console);
            }
            let mut cache = FastMemory::<Gouraud<Rgb888>>::new();
            drawn(Way::Smooth, size, counter, scene, lines, &mut cache)
                .print(name("smooth_888", "smooth_888_large"), console);
            if !is_small {
                model(size, counter, scene).print("model_565", console);
            }
        }
    }
}

/// Times smooth triangles as wide as those that the laboratory's methods are timed on, one twice as wide as the other,
/// and prints them under the names that those have.
pub(super) fn run_beside_methods(counter: &Counter, console: &mut Console, rooms: &mut Rooms) {
    for (large, tall, widest) in [("", LINES, WIDEST[0]), ("_large", LINES + 1, WIDEST[1])] {
        for width in [widest, widest / 2] {
            let size = Size { width, tall };
            let (scene, lines) = (&mut rooms.scene, &mut rooms.lines);
            for (way, depth) in [(Way::Smooth, ""), (Way::Over, "_depth")] {
                let mut cache = FastMemory::<Gouraud<Rgb565>>::new();
                drawn(way, size, counter, scene, lines, &mut cache)
                    .print(format_args!("renderer_565{large}{depth}"), console);
            }
            let mut cache = FastMemory::<Gouraud<Rgb888>>::new();
            drawn(Way::Smooth, size, counter, scene, lines, &mut cache)
                .print(format_args!("renderer_888{large}"), console);
        }
    }
}

/// Draws a triangle, and counts all lines but the first.
#[inline(never)]
fn drawn<L: Look<Pixel: PixelFormat<Word: Default + PartialEq>>>(
    way: Way,
    size: Size,
    counter: &Counter,
    scene: &mut SceneRooms,
    lines: &mut LineRooms,
    cache: &mut FastMemory<L>,
) -> Run {
    let screen = Screen::new(WIDTH, size.tall).expect("the size is legal");
    let mut scene = scene.sized::<L>(screen);
    scene.begin(&camera()).expect("a bin for each line");
    let triangle = Triangle::new(way, size);
    scene.draw(&triangle.call(way)).expect("the rooms suffice");
    if matches!(way, Way::Over) {
        let behind = Triangle {
            positions: triangle.positions.map(|p| p.map(|c| c / 4 * 5)),
            ..triangle
        };
        scene.draw(&behind.call(way)).expect("the rooms suffice");
    }
    let mut renderer = lines.renderer(cache);
    let nothing = Default::default();
    let mut pixels = [nothing; WIDTH as usize];
    let mut shown = Shown::default();
    for line in 0..LINES {
        let done = renderer.draw_line(&scene, line, &mut pixels, nothing);
        done.expect("the rooms suffice");
        shown.line(line, &pixels, nothing);
    }
    let instructions = counter.lines_finely(0..LINES, |line| {
        let done = renderer.draw_line(&scene, line, black_box(&mut pixels), nothing);
        done.expect("the rooms suffice");
    });
    shown.run(instructions)
}

/// The hardware model on the same triangle.
#[inline(never)]
fn model(size: Size, counter: &Counter, scene: &mut SceneRooms) -> Run {
    let screen = Screen::new(WIDTH, size.tall).expect("the size is legal");
    let mut scene = scene.sized::<SmoothLook>(screen);
    scene.begin(&camera()).expect("a bin for each line");
    let triangle = Triangle::new(Way::Smooth, size);
    let done = scene.draw(&triangle.call(Way::Smooth));
    done.expect("the rooms suffice");
    let mut memory = [[0; WIDTH as usize]; 4];
    let [z0, z1, c0, c1] = &mut memory;
    let mut renderer = ModelRenderer::new(PipeMemory {
        z: [z0, z1],
        rgb: [c0, c1],
    });
    let mut pixels = [0; WIDTH as usize];
    let mut shown = Shown::default();
    for line in 0..LINES {
        let done = renderer.draw_line(&scene, line, 0, &mut pixels);
        done.expect("the rooms suffice");
        shown.line(line, &pixels, 0);
    }
    let instructions = counter.lines_finely(0..LINES, |line| {
        let done = renderer.draw_line(&scene, line, 0, black_box(&mut pixels));
        done.expect("the rooms suffice");
    });
    shown.run(instructions)
}

/// What lines but the first show.
#[derive(Default)]
struct Shown {
    spans: u32,
    pixels: u32,
}

impl Shown {
    fn line<W: PartialEq>(&mut self, line: u16, pixels: &[W], nothing: W) {
        let seen = pixels.iter().filter(|pixel| **pixel != nothing).count() as u32;
        if line > 0 {
            self.spans += u32::from(seen > 0);
            self.pixels += seen;
        }
    }

    fn run(self, instructions: u64) -> Run {
        Run {
            instructions,
            spans: self.spans,
            pixels: self.pixels,
        }
    }
}

/// Looks along -z: at distance 1 a focal length of 4096 pixels makes 2^-15 of a coordinate an
/// eighth of a pixel.
fn camera() -> Camera {
    let (eye, at, up) = ([0.0; 3], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
    Camera::look_at(eye, at, up, 4096.0, 0.5, 2.0).expect("the camera is legal")
}

/// A right triangle.
#[derive(Clone, Copy)]
struct Triangle {
    positions: [[i32; 3]; 3],
    colours: [[u8; 3]; 3],
    places: [[i32; 2]; 3],
}

impl Triangle {
    fn new(way: Way, Size { width, tall }: Size) -> Self {
        let widest = WIDEST[usize::from(tall > LINES)];
        let tall = i32::from(tall);
        // An odd side moves the principal point by half a pixel, and the picture with it.
        let vertex = |x: i32, y: i32| {
            let x = 8 * x - 4 * i32::from(WIDTH);
            let y = 8 * y - 4 * tall;
            [x << 15, -(y << 15), -1 << 30]
        };
        let mut positions = [vertex(0, 0), vertex(width, 0), vertex(0, tall)];
        if matches!(way, Way::Leaning(_)) {
            for position in positions.iter_mut().skip(1) {
                *position = position.map(|c| c / 2 * 3);
            }
        }
        // The slope of colours and texels is that of the widest triangle: narrow ones would be too steep to be set up
        // as small.
        let [left, right]: [[i32; 3]; 2] = match way {
            Way::Lit => [[250; 3], [40; 3]],
            _ => [[255, 0, 30], [0, 200, 60]],
        };
        let right = [0, 1, 2].map(|i| left[i] + (right[i] - left[i]) * width / widest);
        let below = if matches!(way, Way::Lit) {
            [120; 3]
        } else {
            [90, 255, 255]
        };
        let [corner, far, _] = [PLACES_F[3], PLACES_F[2], PLACES_F[0]];
        Self {
            positions,
            colours: [left, right, below].map(|c| c.map(|level| level as u8)),
            places: [
                corner,
                [far[0] * width / widest, far[1]],
                [0, i32::from(LINES) * 256],
            ],
        }
    }

    fn call(&self, way: Way) -> Draw<'_, 'static, i32> {
        let is_tinted = !matches!(way, Way::Texel | Way::Of(_) | Way::Leaning(_));
        let mesh = Mesh {
            positions: &self.positions,
            normals: &[],
            colours: if is_tinted { &self.colours } else { &[] },
            faces: Faces::Triangles(&[[0, 1, 2]]),
        };
        let budget = match way {
            Way::Texel | Way::Of(_) | Way::Lit | Way::Tinted => Some(Budget::BALANCED),
            Way::Leaning(budget) => Some(budget),
            _ => None,
        };
        let texture = match way {
            Way::Of(texture) => Some(texture),
            _ => Suite::F.texture(),
        };
        let skin = |budget| {
            Some(Skin {
                texture: texture?,
                places: &self.places,
                budget,
            })
        };
        Draw {
            cull: Cull::None,
            shading: match way {
                Way::Flat => Shading::Flat,
                _ => Shading::Smooth,
            },
            blend: matches!(way, Way::Filter).then(|| Blend::filter(128)),
            texture: budget.and_then(skin),
            ..Draw::new(mesh)
        }
    }
}
