//! From front to back or by depth: the same picture, pixel by pixel (X3, M4).
//!
//! Random layers of triangles and quads: at depths of their own, at the same depth, leaning
//! towards each other, and through each other, so that some lines can be ordered and some cannot.

use crate::common::{Rng, SceneRooms};
use scanbeam::mesh::{QuadSplit, ScreenVertex};
use scanbeam::pipeline::{
    Counted, Deferred, DepthUse, FlatDepth, GouraudDepth, Instance, Interpolated, LineDepth,
    LineMemory, LineRenderer, Pipeline, QuarterRate, Scene, WordOf,
};
use scanbeam::pixel::{Rgb565Be, Rgb888};
use scanbeam::stats::SpanCounts;
use scanbeam::{Affine, Camera, Cull, Faces, Link, Mesh, Screen};

const FOCAL: f64 = 100.0;

/// How layers lie behind each other.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Layers {
    /// Each at a depth of its own, all of it.
    Apart,
    /// Some at the same depth.
    Alike,
    /// Leaning, often through each other.
    Leaning,
}

/// A quad over a part of the picture, its corners at these depths.
fn layer(rng: &mut Rng, screen: Screen, z: [f64; 4]) -> ([[i32; 3]; 4], [[u8; 3]; 4]) {
    let half = [screen.width(), screen.height()].map(|side| f64::from(side) / 2.0);
    let corner = |low: f64, high: f64, half: f64| (low * half * 1.1, high * half * 1.1);
    let whole = rng.below(3) == 0;
    let mut range = || {
        let (a, b) = (rng.signed(), rng.signed());
        if whole {
            (-1.0, 1.0)
        } else {
            (a.min(b), a.max(b))
        }
    };
    let (x, y) = (range(), range());
    let (left, right) = corner(x.0, x.1, half[0]);
    let (low, high) = corner(y.0, y.1, half[1]);
    let places = [[left, low], [right, low], [right, high], [left, high]];
    let mut positions = [[0; 3]; 4];
    for (i, place) in places.into_iter().enumerate() {
        let at = [place[0] / FOCAL * z[i], place[1] / FOCAL * z[i], -z[i]];
        // Depths are below 32 units; coordinates are given in 64ths of them.
        positions[i] = at.map(|c| (c / 64.0 * f64::from(1 << 30)) as i32);
    }
    let colours = [(); 4].map(|()| [(); 3].map(|()| rng.below(256) as u8));
    (positions, colours)
}

fn build<P: Pipeline>(scene: &mut Scene<'_, P>, layers: Layers, seed: u64) {
    let mut rng = Rng::new(seed);
    let camera = Camera::look_at(
        [0.0; 3],
        [0.0, 0.0, -1.0],
        [0.0, 1.0, 0.0],
        FOCAL as f32,
        1.0,
        60.0,
    )
    .unwrap();
    scene.begin(&camera).unwrap();
    let count = 2 + rng.below(20);
    let mut depths: Vec<f64> = (0..count).map(|i| 2.0 + f64::from(i)).collect();
    match rng.below(3) {
        0 => depths.reverse(),
        1 => rng.shuffle(&mut depths),
        _ => {}
    }
    for z in depths {
        let z = match layers {
            Layers::Apart => [z; 4],
            Layers::Alike => [(z / 3.0).ceil() * 3.0; 4],
            Layers::Leaning => {
                let (dx, dy) = (rng.signed(), rng.signed());
                [z + dx, z + dy, z - dx, z - dy]
            }
        };
        let (positions, colours) = layer(&mut rng, scene.screen(), z);
        let split = rng.pick(&[QuadSplit::Corner0To2, QuadSplit::Corner1To3]);
        let mesh = Mesh {
            positions: &positions,
            normals: &[],
            colours: &colours,
            faces: Faces::Quads(&[[0, 1, 2, 3]], split),
        };
        let instance = Instance {
            model: Affine::placed(64.0, [0.0; 3]).unwrap(),
            cull: Cull::None,
            ..Instance::default()
        };
        scene.draw(&mesh, &instance).unwrap();
    }
}

/// All lines, and what was counted.
fn draw<P: Pipeline>(
    scene: &Scene<'_, P>,
    slots: usize,
    depth_use: DepthUse,
) -> (Vec<Vec<WordOf<P>>>, SpanCounts) {
    let width = usize::from(scene.screen().width());
    let mut slots = vec![LineRenderer::<P>::empty_slot(); slots];
    let mut links = vec![Link::NONE; scene.pass_one().objects as usize];
    let mut depth = vec![P::Depth::FARTHEST; width];
    let mut renderer = LineRenderer::<P>::new(LineMemory {
        slots: &mut slots,
        links: &mut links,
        depth: &mut depth,
    });
    renderer.set_depth_use(depth_use);
    let lines = scene
        .lines()
        .map(|y| {
            let mut pixels = vec![WordOf::<P>::default(); width];
            renderer.draw_line(scene, y, &mut pixels).unwrap();
            pixels
        })
        .collect();
    (lines, renderer.take_span_counts())
}

/// Draws random layers both ways: how many frames, and how many needed no depth at all.
fn compare<P: Pipeline>(layers: Layers, seeds: std::ops::Range<u64>) -> (u32, u32)
where
    WordOf<P>: std::fmt::Debug,
{
    let (mut frames, mut without, mut saved) = (0, 0, 0);
    for seed in seeds {
        let mut rng = Rng::new(seed + 77);
        let size = rng.pick(&[(64, 40), (33, 20), (320, 30), (5, 9), (1, 4)]);
        let screen = Screen::new(size.0, size.1).unwrap();
        let mut rooms = SceneRooms::<Counted<P>>::new(400, 200, 64);
        let mut scene = rooms.scene(screen);
        build(&mut scene, layers, seed);
        let slots = rng.pick(&[100, 100, 20, 3]);
        let (by_depth, counts) = draw(&scene, slots, DepthUse::Always);
        let (fast, fewer) = draw(&scene, slots, DepthUse::WhereNeeded);
        assert!(by_depth == fast, "{layers:?}, seed {seed}, {slots} slots");
        assert_eq!(
            fewer.pixels_shaded + fewer.pixels_hidden,
            counts.pixels_shaded + counts.pixels_hidden,
            "{layers:?}, seed {seed}: every covered pixel is counted once"
        );
        assert_eq!(fewer.spans, counts.spans, "{layers:?}, seed {seed}");
        // Front to back no pixel is drawn twice.
        assert!(fewer.pixels_shaded <= counts.pixels_shaded);
        // And those who do not count get the same.
        let mut rooms = SceneRooms::<P>::new(400, 200, 64);
        let mut scene = rooms.scene(screen);
        build(&mut scene, layers, seed);
        assert!(draw(&scene, slots, DepthUse::WhereNeeded).0 == by_depth);
        // And where shading waits for depth: no pixel is shaded twice, however it is drawn.
        let mut rooms = SceneRooms::<Counted<Deferred<P>>>::new(400, 200, 64);
        let mut scene = rooms.scene(screen);
        build(&mut scene, layers, seed);
        for depth_use in [DepthUse::Always, DepthUse::WhereNeeded] {
            let (deferred, less) = draw(&scene, slots, depth_use);
            let what = format!("{layers:?}, seed {seed}, {slots} slots, {depth_use:?}");
            assert!(deferred == by_depth, "{what}");
            assert_eq!(
                (less.spans, less.pixels_shaded + less.pixels_hidden),
                (counts.spans, counts.pixels_shaded + counts.pixels_hidden),
                "{what}"
            );
            assert!(less.pixels_shaded <= counts.pixels_shaded, "{what}");
            saved += counts.pixels_shaded - less.pixels_shaded;
        }
        frames += 1;
        without += u32::from(fewer.depth_tests == 0 && slots == 100);
    }
    assert!(saved > 0, "{layers:?}: nothing was hidden in time");
    (frames, without)
}

#[test]
fn layers_apart_need_no_depth() {
    type P = GouraudDepth<Rgb565Be>;
    // Half of the frames have slots for all; triangles too thin for planes keep some from it.
    let (frames, without) = compare::<P>(Layers::Apart, 0..300);
    assert!(without > frames / 4, "{without} of {frames}");
    compare::<FlatDepth<Rgb888>>(Layers::Apart, 300..400);
    compare::<Interpolated<P, QuarterRate>>(Layers::Apart, 400..500);
}

#[test]
fn of_layers_at_the_same_depth_the_last_is_seen() {
    let (frames, without) = compare::<GouraudDepth<Rgb888>>(Layers::Alike, 0..300);
    assert!(without > frames / 4, "{without} of {frames}");
    compare::<FlatDepth<Rgb565Be>>(Layers::Alike, 300..400);
}

#[test]
fn leaning_layers_are_ordered_where_they_can_be() {
    let (frames, without) = compare::<GouraudDepth<Rgb565Be>>(Layers::Leaning, 0..600);
    assert!(without > 0 && without < frames, "{without} of {frames}");
}

/// A triangle of the screen whose corners have these depths.
fn leaf(rng: &mut Rng, screen: Screen, depths: [u32; 3]) -> [ScreenVertex; 3] {
    let colour = [(); 3].map(|()| rng.below(256) as u8);
    depths.map(|depth| ScreenVertex {
        x: rng.below(8 * u32::from(screen.width())) as i16,
        y: rng.below(8 * u32::from(screen.height())) as i16,
        depth,
        colour,
    })
}

/// Two triangles of which one ends where the other begins, but for one unit of depth: their planes
/// are rounded, so that at a pixel the farther may have come out nearer. Such are compared.
#[test]
fn depths_that_all_but_touch_are_compared() {
    type P = FlatDepth<Rgb888>;
    let mut rng = Rng::new(52);
    let screen = Screen::new(2048, 24).unwrap();
    let mut seen = 0;
    for round in 0..400 {
        let edge = (1 + rng.below(60_000)) << 15;
        let mut away = || {
            let bits = rng.below(31);
            rng.below(1 << bits)
        };
        let front = [
            edge,
            edge.saturating_add(away()),
            edge.saturating_add(away()),
        ];
        let front = front.map(|depth| depth.min(1 << 31));
        let back = [edge - 1, (edge - 1).saturating_sub(away()), edge - 1];
        let mut leaves = [front, back].map(|depths| leaf(&mut rng, screen, depths));
        // They meet where they all but touch.
        (leaves[1][0].x, leaves[1][0].y) = (leaves[0][0].x, leaves[0][0].y);
        if rng.below(2) == 0 {
            leaves.reverse();
        }
        let mut rooms = SceneRooms::<Counted<P>>::new(8, 4, 24);
        let mut scene = rooms.scene(screen);
        let (ahead, up) = ([0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
        let camera = Camera::look_at([0.0; 3], ahead, up, 100.0, 1.0, 60.0);
        scene.begin(&camera.unwrap()).unwrap();
        for leaf in &leaves {
            scene
                .draw_screen(leaf, &[[0, 1, 2]], (), Cull::None)
                .unwrap();
        }
        let (by_depth, counts) = draw(&scene, 4, DepthUse::Always);
        let (fast, _) = draw(&scene, 4, DepthUse::WhereNeeded);
        assert!(by_depth == fast, "round {round}: {leaves:?}");
        seen += u32::from(counts.pixels_hidden > 0);
    }
    assert!(seen > 50, "{seen} of 400 pairs overlap");
}
