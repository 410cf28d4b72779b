//! K5, C5, H18: any line drawn alone, in any order, with any cache and in any band, has the
//! bits that it has in the whole frame.

use crate::common::Rng;
use crate::hot::cover::{L, Picture};
use crate::hot::ways::{Lines, SLOTS};
use crate::hot::{LineRooms, SceneRooms, Smooth, WordOf, frame, line};
use scanbeam::frame::{FastMemory, Memory, Renderer};
use scanbeam::look::{Gouraud, Look};
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scene::{Draw, Scene};
use scanbeam::{Affine, Camera, Cull, Faces, Light, Link, Mesh, Screen};
use scenes::{CUBE, RIBBON, TEAPOT};
use std::ops::Range;

/// A scene of triangles of any size and of meshes, to be begun whole or in bands.
struct Soup {
    camera: Camera,
    positions: Vec<[i32; 3]>,
    colours: Vec<[u8; 3]>,
    faces: Vec<[u16; 3]>,
    turn: f32,
}

impl Soup {
    fn new(rng: &mut Rng) -> Self {
        let mut positions = Vec::new();
        let mut colours = Vec::new();
        let mut faces = Vec::new();
        for _ in 0..rng.pick(&[5, 60, 400]) {
            let size = rng.pick(&[0.02, 0.2, 2.0]);
            let centre = [(); 3].map(|()| rng.signed());
            let from = positions.len() as u16;
            for _ in 0..3 {
                positions.push(centre.map(|c| {
                    let v = (c + size * rng.signed()).clamp(-1.99, 1.99);
                    (v * f64::from(1 << 30)) as i32
                }));
                colours.push([(); 3].map(|()| rng.below(256) as u8));
            }
            faces.push([from, from + 1, from + 2]);
        }
        let eye = [(); 3].map(|()| 2.5 * rng.signed() as f32);
        let at = [(); 3].map(|()| 0.3 * rng.signed() as f32 + 0.01);
        let focal = rng.pick(&[30.0, 120.0, 700.0]);
        let near = rng.pick(&[0.01, 0.1, 1.0]);
        Self {
            camera: Camera::look_at(eye, at, [0.1, 1.0, 0.2], focal, near, 20.0).unwrap(),
            positions,
            colours,
            faces,
            turn: rng.signed() as f32 * 3.0,
        }
    }

    fn mesh(&self) -> Mesh<'_, i32> {
        Mesh {
            positions: &self.positions,
            normals: &[],
            colours: &self.colours,
            faces: Faces::Triangles(&self.faces),
        }
    }

    fn build<L: Look>(&self, scene: &mut Scene<'_, '_, L>, lines: Range<u16>) {
        scene.begin_lines(&self.camera, lines).unwrap();
        let open = Draw {
            cull: Cull::None,
            ..Draw::new(self.mesh())
        };
        scene.draw(&open).unwrap();
        for mesh in [TEAPOT, RIBBON] {
            let lit = Draw {
                model: Affine::rotation_y(self.turn),
                light: Light::new([0.3, 0.8, 0.6], 0.2),
                ..Draw::new(mesh)
            };
            scene.draw(&lit).unwrap();
        }
        let room = Draw {
            model: Affine::placed(4.0, [0.1, 0.0, 0.0]).unwrap(),
            cull: Cull::None,
            ..Draw::new(CUBE)
        };
        scene.draw(&room).unwrap();
    }
}

fn rooms(lines: u16) -> SceneRooms {
    SceneRooms::new(20_000, 10_000, lines.into(), 4)
}

fn soups<L: Smooth>(seed: u64, depth: bool)
where
    WordOf<L>: std::fmt::Debug,
{
    let mut rng = Rng::new(seed);
    let (mut whole_rooms, mut band_rooms) = (rooms(200), rooms(64));
    let background = L::Format::from_rgb8([9, 40, 80]);
    for round in 0..4 {
        let name = format!("soup {round}");
        let soup = Soup::new(&mut rng);
        let screen = Screen::new(rng.pick(&[1, 63, 160, 1001]), rng.pick(&[1, 47, 160])).unwrap();
        let height = screen.height();
        let mut scene = whole_rooms.scene::<L>(screen);
        soup.build(&mut scene, 0..height);
        let lines = Lines {
            scene: &scene,
            depth,
            background,
        };
        let want = lines.whole(&name);
        lines.every_way(&want, &mut rng, &name);
        in_bands::<L>(&soup, (&mut band_rooms, screen), &mut rng, depth, &want);
    }
}

/// In bands, each with the same arenas, by one renderer.
fn in_bands<L: Smooth>(
    soup: &Soup,
    (rooms, screen): (&mut SceneRooms, Screen),
    rng: &mut Rng,
    depth: bool,
    want: &Picture<WordOf<L>>,
) where
    WordOf<L>: std::fmt::Debug,
{
    let mut scene = rooms.scene::<L>(screen);
    let mut lines = LineRooms::fitting(&scene, rng.pick(&SLOTS), depth);
    lines.links.resize(10_000, Link::NONE);
    let mut renderer = lines.renderer();
    let mut start = 0;
    while start < screen.height() {
        let end = (start + 1 + rng.below(63) as u16).min(screen.height());
        soup.build(&mut scene, start..end);
        for y in start..end {
            let got = line(&mut renderer, &scene, y, L::Format::from_rgb8([9, 40, 80]));
            assert!(
                got == want[usize::from(y)],
                "line {y} of the band {start}..{end}, depth {depth}"
            );
        }
        start = end;
    }
}

#[test]
fn soups_in_bands_with_depth() {
    soups::<L>(12, true);
    soups::<Gouraud<Rgb565Be>>(14, true);
}

#[test]
fn soups_in_bands_painted_in_order() {
    soups::<L>(12, false);
    soups::<Gouraud<Rgb565Be>>(14, false);
}

/// A teapot of some 1,000 triangles that face the eye.
fn teapot<'m>(rooms: &'m mut SceneRooms) -> Scene<'m, 'static, L> {
    let mut scene = rooms.scene::<L>(Screen::new(160, 120).unwrap());
    let (eye, up) = ([0.0, 1.2, 2.6], [0.0, 1.0, 0.0]);
    let camera = Camera::look_at(eye, [0.0; 3], up, 100.0, 0.1, 9.0);
    scene.begin(&camera.unwrap()).unwrap();
    scene.draw(&Draw::new(TEAPOT)).unwrap();
    scene
}

/// The cache's counters tell what happened: everything that begins finds a slot or does not, and with more slots fewer
/// do not.
#[test]
fn cache_counts_add_up() {
    let mut rooms = rooms(240);
    let scene = teapot(&mut rooms);
    let counts = SLOTS.map(|slots| {
        let mut lines = LineRooms::fitting(&scene, slots, true);
        let mut renderer = lines.renderer();
        for y in scene.lines() {
            line(&mut renderer, &scene, y, [0; 3]);
        }
        let counts = renderer.counts();
        assert!(counts.peak <= u32::from(slots));
        assert!(slots > 0 || counts.hits + counts.moved_in == 0);
        assert_eq!((counts.hits + counts.spilled) as usize, scene.objects());
        assert!(counts.moved_in <= counts.spilled);
        counts
    });
    for pair in counts.windows(2) {
        assert!(pair[1].hits >= pair[0].hits, "{pair:?}");
        assert!(pair[1].misses <= pair[0].misses, "{pair:?}");
    }
    let [none, .., all] = counts;
    assert!(none.misses > 500 && all.misses == 0, "{none:?} {all:?}");
    assert!(none.set_ups > all.set_ups, "{none:?} {all:?}");
}

/// Links and cells beyond what is needed, a cache of the most slots, and whatever is in them, change nothing.
#[test]
fn more_memory_than_needed_is_not_used() {
    let mut rooms = rooms(1_016);
    let scene = teapot(&mut rooms);
    let want = frame(&scene, 16, true, [0; 3]);
    let mut cache = Box::new(FastMemory::<L, 7>::new());
    let mut links = vec![Link::NONE; 70_000];
    let mut depth = vec![77; 9_000];
    let mut renderer = Renderer::new(Memory {
        cache: &mut cache,
        links: &mut links,
        depth: &mut depth,
    });
    for y in scene.lines() {
        let mut pixels = vec![[1; 3]; 160];
        renderer.draw_line(&scene, y, &mut pixels, [0; 3]).unwrap();
        assert!(pixels == want[usize::from(y)], "line {y}");
    }
    assert!(
        links[scene.objects()..]
            .iter()
            .all(|&link| link == Link::NONE)
    );
    assert!(depth[160..].iter().all(|&cell| cell == 77));
}
