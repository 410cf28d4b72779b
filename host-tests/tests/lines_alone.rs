//! K5, C5, H18: any line drawn alone, in any order, with any cache and in any band, has the
//! bits that it has in the whole frame.

use crate::common::{LineRooms, Rng, SceneRooms, frame, line};
use scanbeam::pipeline::parallel::Interleave;
use scanbeam::pipeline::{
    Counted, FlatDepth, FlatPainter, GouraudDepth, GouraudPainter, Instance, LineMemory,
    LineRenderer, Pipeline, Scene, WordOf,
};
use scanbeam::pixel::{Rgb565Be, Rgb888};
use scanbeam::{Affine, Camera, Cull, Faces, Light, Mesh, Screen};
use scenes::{CUBE, RIBBON, SHOTS, STRESS, Shot, TEAPOT};
use std::ops::Range;

const SLOTS: [usize; 7] = [0, 1, 2, 3, 7, 16, 64];

/// The whole frame is the same for every cache; hands it out.
fn whole<P: Pipeline>(scene: &Scene<'_, P>, name: &str) -> Vec<Vec<WordOf<P>>>
where
    WordOf<P>: std::fmt::Debug,
{
    let want = frame(scene, 256);
    for slots in SLOTS {
        same::<P>(
            &want,
            &frame(scene, slots),
            &format!("{name}, {slots} slots"),
        );
    }
    want
}

fn same<P: Pipeline>(want: &[Vec<WordOf<P>>], got: &[Vec<WordOf<P>>], name: &str)
where
    WordOf<P>: std::fmt::Debug,
{
    assert_eq!(want.len(), got.len(), "{name}");
    for (y, (want, got)) in want.iter().zip(got).enumerate() {
        same_line::<P>(want, got, &format!("{name}, line {y}"));
    }
}

fn same_line<P: Pipeline>(want: &[WordOf<P>], got: &[WordOf<P>], name: &str)
where
    WordOf<P>: std::fmt::Debug,
{
    let differs = want.iter().zip(got).position(|(w, g)| w != g);
    if let Some(x) = differs {
        panic!("{name}, column {x}: {:?} is drawn {:?}", want[x], got[x]);
    }
}

/// Draws the lines of a scene in every other way there is.
fn every_way<P: Pipeline>(scene: &Scene<'_, P>, want: &[Vec<WordOf<P>>], rng: &mut Rng, name: &str)
where
    WordOf<P>: std::fmt::Debug,
{
    let first = scene.lines().start;
    let want_line = |y: u16| &want[usize::from(y - first)];
    // In random order, by one renderer that keeps its cache.
    let mut order: Vec<u16> = scene.lines().collect();
    rng.shuffle(&mut order);
    let slots = rng.pick(&SLOTS);
    let mut rooms = LineRooms::fitting(slots, scene);
    let mut renderer = rooms.renderer();
    for &y in &order {
        let name = format!("{name}, random order, {slots} slots, line {y}");
        same_line::<P>(want_line(y), &line(&mut renderer, scene, y), &name);
    }
    // Down with gaps.
    let mut y = first;
    while scene.lines().contains(&y) {
        let name = format!("{name}, gaps, {slots} slots, line {y}");
        same_line::<P>(want_line(y), &line(&mut renderer, scene, y), &name);
        y += 1 + rng.below(9) as u16;
    }
    // Alone, by a fresh renderer in fresh memory.
    for &y in order.iter().take(24) {
        let mut rooms = LineRooms::fitting(slots, scene);
        let got = line(&mut rooms.renderer(), scene, y);
        same_line::<P>(want_line(y), &got, &format!("{name}, alone, line {y}"));
    }
    // By two or more renderers that take turns.
    for step in [2u16, 3, 5] {
        for offset in 0..step {
            let mut rooms = LineRooms::fitting(rng.pick(&SLOTS), scene);
            let mut renderer = rooms.renderer();
            let mut y = first + offset;
            let turn = Interleave::lines(step, y % step).unwrap();
            renderer.set_interleave(turn);
            while scene.lines().contains(&y) {
                let name = format!("{name}, line {y} of every {step}");
                same_line::<P>(want_line(y), &line(&mut renderer, scene, y), &name);
                y += step;
            }
        }
    }
    // Lines of others cost time, not pixels: set_interleave says so.
    let mut rooms = LineRooms::fitting(slots, scene);
    let mut renderer = rooms.renderer();
    renderer.set_interleave(Interleave::lines(4, 0).unwrap());
    for y in scene.lines() {
        let name = format!("{name}, a step of 4 that is not kept, line {y}");
        same_line::<P>(want_line(y), &line(&mut renderer, scene, y), &name);
    }
}

fn shots<P: Pipeline>()
where
    WordOf<P>: std::fmt::Debug,
{
    let mut rng = Rng::new(11);
    let mut rooms = SceneRooms::<P>::new(scenes::VERTICES, scenes::OBJECTS, 240);
    for shot in SHOTS.into_iter().chain(STRESS) {
        let mut scene = rooms.scene(Shot::screen());
        shot.build(&mut scene).unwrap();
        let want = whole(&scene, shot.name());
        every_way(&scene, &want, &mut rng, shot.name());
    }
}

#[test]
fn shots_with_gouraud_and_depth() {
    shots::<Counted<GouraudDepth<Rgb888>>>();
}

#[test]
fn shots_with_flat_and_depth() {
    shots::<FlatDepth<Rgb565Be>>();
}

#[test]
fn shots_painted_in_order() {
    shots::<GouraudPainter<Rgb565Be>>();
    shots::<FlatPainter<Rgb888>>();
}

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

    fn build<P: Pipeline>(&self, scene: &mut Scene<'_, P>, lines: Range<u16>) {
        scene.begin_band(&self.camera, lines).unwrap();
        let open = Instance {
            cull: Cull::None,
            ..Instance::default()
        };
        scene.draw(&self.mesh(), &open).unwrap();
        let lit = Instance {
            model: Affine::rotation_y(self.turn),
            light: Light::new([0.3, 0.8, 0.6], 0.2),
            ..Instance::default()
        };
        scene.draw(&TEAPOT, &lit).unwrap();
        scene.draw(&RIBBON, &lit).unwrap();
        let room = Affine::placed(4.0, [0.1, 0.0, 0.0]).unwrap();
        scene
            .draw(
                &CUBE,
                &Instance {
                    model: room,
                    ..open
                },
            )
            .unwrap();
    }
}

fn soups<P: Pipeline>()
where
    WordOf<P>: std::fmt::Debug,
{
    let mut rng = Rng::new(12);
    let mut rooms = SceneRooms::<P>::new(20_000, 10_000, 200);
    let mut band_rooms = SceneRooms::<P>::new(20_000, 10_000, 64);
    for round in 0..10 {
        let name = format!("soup {round}");
        let soup = Soup::new(&mut rng);
        let screen = Screen::new(rng.pick(&[1, 63, 160, 1201]), rng.pick(&[1, 47, 160])).unwrap();
        let height = screen.height();
        let mut scene = rooms.scene(screen);
        soup.build(&mut scene, 0..height);
        let want = whole(&scene, &name);
        every_way(&scene, &want, &mut rng, &name);
        // In bands, each with the same arenas, by one renderer.
        let mut scene = band_rooms.scene(screen);
        let mut line_rooms = LineRooms::new(rng.pick(&SLOTS), 10_000, 1201);
        let mut renderer = line_rooms.renderer();
        let mut start = 0;
        while start < height {
            let end = (start + 1 + rng.below(63) as u16).min(height);
            soup.build(&mut scene, start..end);
            for y in start..end {
                let name = format!("{name}, line {y} of the band {start}..{end}");
                let got = line(&mut renderer, &scene, y);
                same_line::<P>(&want[usize::from(y)], &got, &name);
            }
            start = end;
        }
    }
}

#[test]
fn soups_in_bands_with_depth() {
    soups::<GouraudDepth<Rgb888>>();
    soups::<FlatDepth<Rgb888>>();
}

#[test]
fn soups_in_bands_painted_in_order() {
    soups::<GouraudPainter<Rgb565Be>>();
}

/// A renderer that goes from one scene to another, line by line, mixes nothing up.
#[test]
fn a_renderer_may_change_scenes_between_lines() {
    type P = GouraudDepth<Rgb888>;
    let mut rng = Rng::new(13);
    let screen = Screen::new(96, 80).unwrap();
    let mut rooms = [(); 2].map(|()| SceneRooms::<P>::new(20_000, 10_000, 80));
    let mut scenes: Vec<_> = rooms
        .iter_mut()
        .map(|rooms| {
            let mut scene = rooms.scene(screen);
            Soup::new(&mut rng).build(&mut scene, 0..80);
            scene
        })
        .collect();
    let want: Vec<_> = scenes.iter().map(|scene| frame(scene, 16)).collect();
    let mut line_rooms = LineRooms::new(16, 10_000, 96);
    let mut renderer = line_rooms.renderer();
    for y in 0..80 {
        let which = usize::from(y % 3 == 0);
        let got = line(&mut renderer, &scenes[which], y);
        same_line::<P>(
            &want[which][usize::from(y)],
            &got,
            &format!("scene {which}, line {y}"),
        );
    }
    // What is added to a scene between two lines is on the second.
    let scene = &mut scenes[0];
    let mut renderer = line_rooms.renderer();
    line(&mut renderer, scene, 30);
    let near = Affine::placed(3.0, [0.0; 3]).unwrap();
    let added = Instance {
        model: near,
        cull: Cull::None,
        ..Instance::default()
    };
    scene.draw(&CUBE, &added).unwrap();
    let want = frame(scene, 16);
    let mut line_rooms = LineRooms::fitting(16, scene);
    // The first renderer has too few links only if there are more objects than it was given.
    let got = line(&mut renderer, scene, 31);
    same_line::<P>(&want[31], &got, "after an addition, line 31");
    let got = line(&mut line_rooms.renderer(), scene, 31);
    same_line::<P>(&want[31], &got, "after an addition, alone, line 31");
}

/// The cache's counters tell what happened: everything active is a hit, a miss or a first use.
#[test]
fn cache_counts_add_up() {
    type P = GouraudDepth<Rgb888>;
    let mut rooms = SceneRooms::<P>::new(scenes::VERTICES, scenes::OBJECTS, 240);
    let mut scene = rooms.scene(Shot::screen());
    Shot::Teapot.build(&mut scene).unwrap();
    let counts = SLOTS.map(|slots| {
        let mut line_rooms = LineRooms::<P>::fitting(slots, &scene);
        let mut renderer = line_rooms.renderer();
        for y in scene.lines() {
            line(&mut renderer, &scene, y);
        }
        let counts = renderer.cache_counts();
        assert!(counts.peak_slots as usize <= slots);
        assert!(slots > 0 || counts.hits == 0);
        counts
    });
    for pair in counts.windows(2) {
        assert!(pair[1].hits >= pair[0].hits && pair[1].misses <= pair[0].misses);
        assert!(pair[1].spills <= pair[0].spills);
        // Records may be read once more for their depth, where more objects wait for that in slots.
        assert!(pair[1].records_read() <= pair[0].records_read());
        let object_lines = |i: usize| pair[i].hits + pair[i].misses;
        assert_eq!(object_lines(0), object_lines(1));
    }
}

/// An unused cache of any length, and links and cells beyond what is needed, change nothing.
#[test]
fn more_memory_than_needed_is_not_used() {
    type P = FlatDepth<Rgb888>;
    let mut rooms = SceneRooms::<P>::new(60_000, 60_000, 8192);
    let mut scene = rooms.scene(Shot::screen());
    Shot::Cube.build(&mut scene).unwrap();
    let want = frame(&scene, 16);
    let mut slots = vec![LineRenderer::<P>::empty_slot(); 5000];
    let mut links = vec![scanbeam::Link::NONE; 70_000];
    let mut depth = vec![77; 9000];
    let mut renderer = LineRenderer::<P>::new(LineMemory {
        slots: &mut slots,
        links: &mut links,
        depth: &mut depth,
    });
    for y in scene.lines() {
        let got = line(&mut renderer, &scene, y);
        same_line::<P>(&want[usize::from(y)], &got, &format!("line {y}"));
    }
}
