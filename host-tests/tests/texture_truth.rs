//! Texture places of draw calls, in parts of texels, against `f64` (H1, H3, K18, X2): shared edges, the near plane, and a
//! ground plane that rolls.
//!
//! Corners of the first and the fourth lie on the grid of the screen, so what they cover is known
//! exactly, and no pixel has to be left out.

use crate::common::Rng;
use host_tests::model::{Model, ModelVertex};
use host_tests::places::{Shown, places};
use host_tests::reference::{
    NO_OBJECT, Options, Reference, TextureMap, Textures, View, render_textured,
};
use scanbeam::scene::Budget;

/// Texels a side.
const SIDE: u32 = 128;
const BUDGETS: [(Budget, f64); 3] = [
    (Budget::EXACT, 1.0),
    (Budget::BALANCED, 0.25),
    (Budget::FAST, 0.5),
];

/// The eye at (0, 0, 0) looks along -z; a focal length of half the height.
fn view(width: u32, height: u32) -> View {
    View {
        width,
        height,
        eye: [0.0; 3],
        at: [0.0, 0.0, -1.0],
        fov: 90.0,
        ..View::default()
    }
}

/// A corner that is seen at a place of the screen, in pixels, at distance `w`.
fn seen_at(view: &View, [x, y]: [f64; 2], w: f64, uv: [f64; 2]) -> ModelVertex {
    let half = f64::from(view.height) / 2.0;
    vertex(
        [
            (x - f64::from(view.width) / 2.0) / half * w,
            (half - y) / half * w,
            -w,
        ],
        uv,
    )
}

fn vertex(position: [f64; 3], uv: [f64; 2]) -> ModelVertex {
    ModelVertex {
        position,
        normal: [0.0, 0.0, 1.0],
        colour: [1.0; 3],
        uv,
    }
}

fn model(vertices: Vec<ModelVertex>, triangles: Vec<[u32; 3]>) -> Model {
    Model {
        triangle_materials: vec![None; triangles.len()],
        vertices,
        triangles,
        ..Model::default()
    }
}

fn truth(model: &Model, map: &TextureMap, view: &View, snapped: bool) -> Reference {
    let of_triangle = vec![Some(0); model.triangles.len()];
    let textures = Textures {
        maps: std::slice::from_ref(map),
        of_triangle: &of_triangle,
    };
    let options = Options {
        steps_per_pixel: snapped.then_some(8.0),
    };
    render_textured(model, textures, view, options).unwrap()
}

fn white() -> TextureMap {
    TextureMap::made(SIDE, SIDE, |_, _| [255.0; 3])
}

fn farther(off: [f64; 2]) -> f64 {
    off[0].abs().max(off[1].abs())
}

/// How many texels lie between a pixel and the next ones of its own triangle, in both directions.
fn texels_a_pixel(reference: &Reference, at: usize) -> Option<f64> {
    let width = reference.width as usize;
    let step = |to: Option<usize>| {
        let to = to.filter(|to| reference.object.get(*to) == Some(&reference.object[at]))?;
        let (a, b) = (reference.place[at], reference.place[to]);
        Some((a[0] - b[0]).abs().max((a[1] - b[1]).abs()))
    };
    let left = step((!at.is_multiple_of(width)).then(|| at - 1));
    let right = step((at % width + 1 < width).then_some(at + 1));
    let up = step(at.checked_sub(width));
    let down = step(Some(at + width));
    let larger = |a: Option<f64>, b: Option<f64>| {
        a.into_iter()
            .chain(b)
            .fold(None, |m: Option<f64>, x| Some(m.map_or(x, |m| m.max(x))))
    };
    Some(larger(left, right)? + larger(up, down)?)
}

/// A mesh of `n` squares a side whose inner corners are moved at random, each with a distance and a
/// place of its own.
fn crumpled(rng: &mut Rng, n: usize, view: &View) -> Model {
    let cell = f64::from(view.height) / n as f64;
    let mut vertices = Vec::new();
    for j in 0..=n {
        for i in 0..=n {
            let moved = |rng: &mut Rng, k: usize| {
                let inner = k > 0 && k < n;
                let by = if inner { rng.between(-0.4, 0.4) } else { 0.0 };
                ((k as f64 + by) * cell * 8.0).round() / 8.0
            };
            let at = [moved(rng, i), moved(rng, j)];
            let w = rng.between(0.0, 1.0).mul_add(2.3, 0.0).exp();
            let uv = [i, j].map(|k| (k as f64 + rng.between(-0.3, 0.3)) / n as f64 * 2.0);
            vertices.push(seen_at(view, at, w, uv));
        }
    }
    let mut triangles = Vec::new();
    for j in 0..n as u32 {
        for i in 0..n as u32 {
            let at = j * (n as u32 + 1) + i;
            let [a, b, c, d] = [at, at + 1, at + n as u32 + 2, at + n as u32 + 1];
            if rng.unit() < 0.5 {
                triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                triangles.extend([[b, c, d], [b, d, a]]);
            }
        }
    }
    model(vertices, triangles)
}

#[test]
fn meshes_have_no_crack_and_no_seam() {
    let view = view(128, 128);
    for (budget, most) in BUDGETS {
        let mut rng = Rng::new(11);
        let (mut pixels, mut beside, mut wrong, mut worst) = (0, 0, 0, [0.0f64; 2]);
        for n in [3, 6, 12, 24] {
            for _ in 0..3 {
                let model = crumpled(&mut rng, n, &view);
                let reference = truth(&model, &white(), &view, true);
                let drawn = places(&model, SIDE, budget, &view).unwrap();
                for (at, shown) in drawn.iter().enumerate() {
                    // The mesh fills the picture.
                    assert_ne!(reference.object[at], NO_OBJECT);
                    let off = shown.off(reference.place[at]).expect("no crack is seen");
                    let own = reference.object[at];
                    let beside_edge = [1, 128].iter().any(|by| {
                        let next = reference.object.get(at + by);
                        next.is_some_and(|next| *next != own)
                    });
                    pixels += 1;
                    beside += u32::from(beside_edge);
                    wrong += u32::from(!shown.is_texel_of(reference.place[at]));
                    let worst = &mut worst[usize::from(beside_edge)];
                    *worst = worst.max(farther(off));
                }
            }
        }
        let share = 100.0 * f64::from(wrong) / f64::from(pixels);
        println!(
            "{budget:?}: {pixels} pixels, {beside} at shared edges, {share:.3} % another texel, \
             off by {:.4} texels inside and {:.4} at edges",
            worst[0], worst[1]
        );
        assert!(beside > 10_000, "{beside}");
        assert!(worst[0].max(worst[1]) <= most, "{budget:?}: {worst:?}");
        assert!(budget != Budget::EXACT || share <= 0.3, "{share} %");
    }
}

/// How far the places of pixels are off, in texels, and how many texels lie between them and the
/// next ones; of those of which an edge is far.
fn inside(model: &Model, budget: Budget, view: &View, snapped: bool) -> Vec<([f64; 2], f64)> {
    let reference = truth(model, &white(), view, snapped);
    let drawn = places(model, SIDE, budget, view).unwrap();
    let pixel = |(at, shown): (usize, &Shown)| {
        let edge = reference.near_edge[at] || reference.object[at] == NO_OBJECT;
        let slope = (!edge).then(|| texels_a_pixel(&reference, at))??;
        Some((shown.off(reference.place[at]).expect("it is drawn"), slope))
    };
    drawn.iter().enumerate().filter_map(pixel).collect()
}

/// What the grid of the screen may move a corner that is cut, against the reference's: a step.
const STEP: f64 = 1.0 / 8.0;

#[test]
fn what_the_near_plane_cuts_keeps_its_places() {
    let view = View {
        near: 0.5,
        ..view(128, 128)
    };
    for (budget, most) in BUDGETS {
        let mut rng = Rng::new(12);
        let (mut pixels, mut worst) = (0, 0.0f64);
        for _ in 0..150 {
            let mut vertices = Vec::new();
            while vertices.len() < 3 {
                let z = rng.between(-6.0, 4.0);
                let position = [rng.between(-4.0, 4.0), rng.between(-4.0, 4.0), z];
                let uv = [rng.between(0.0, 2.0), rng.between(0.0, 2.0)];
                vertices.push(vertex(position, uv));
            }
            let crosses = |v: &ModelVertex| -v.position[2] < view.near;
            if vertices.iter().filter(|v| crosses(v)).count() % 3 == 0 {
                continue;
            }
            let model = model(vertices, vec![[0, 1, 2]]);
            for (off, slope) in inside(&model, budget, &view, true) {
                pixels += 1;
                let beyond = farther(off) - STEP * slope;
                worst = worst.max(beyond);
                assert!(
                    beyond <= most,
                    "{budget:?}: {off:?}, {slope} texels a pixel: {model:?}"
                );
            }
        }
        println!("{budget:?}: {pixels} pixels, off by {worst:.4} texels beyond a step of the grid");
        assert!(pixels > 100_000, "{pixels}");
    }
}

#[test]
fn a_ground_plane_does_not_swim_when_the_camera_rolls() {
    // From behind the eye to far away; the horizon is in the picture.
    // In 4 x 4 parts: a triangle may stretch over 4,096 texels, and places are those of 1,024 a side.
    let corner = |i: u32| {
        let (x, z) = (
            -40.0 + 20.0 * f64::from(i % 5),
            2.0 - 22.5 * f64::from(i / 5),
        );
        vertex([x, -1.0, z], [(x + 40.0) / 10.0, (2.0 - z) / 10.0])
    };
    let parts = (0..4).flat_map(|row| (0..4).map(move |column| 5 * row + column));
    let two = |at: u32| [[at, at + 1, at + 6], [at, at + 6, at + 5]];
    let ground = model((0..25).map(corner).collect(), parts.flat_map(two).collect());
    for (budget, most) in BUDGETS {
        let mut means: Vec<[f64; 2]> = Vec::new();
        let (mut pixels, mut worst) = (0, 0.0f64);
        for step in -20..=20 {
            let roll = f64::from(step) * 0.05f64.to_radians();
            let view = View {
                up: [roll.sin(), roll.cos(), 0.0],
                ..view(160, 120)
            };
            let (mut sum, mut near) = ([0.0; 2], 0);
            for (off, slope) in inside(&ground, budget, &view, false) {
                pixels += 1;
                let beyond = farther(off) - STEP * slope;
                worst = worst.max(beyond);
                assert!(
                    beyond <= most,
                    "{budget:?}, {step}: {off:?}, {slope} texels a pixel"
                );
                // Where texels are as large as pixels they are seen to move.
                if slope < 2.0 {
                    near += 1;
                    sum = [0, 1].map(|i| sum[i] + off[i]);
                }
            }
            assert!(near > 1000, "{near}");
            means.push(sum.map(|s| s / f64::from(near)));
        }
        let largest = means.iter().map(|m| farther(*m)).fold(0.0, f64::max);
        let jump = means
            .windows(2)
            .map(|pair| farther([0, 1].map(|i| pair[1][i] - pair[0][i])))
            .fold(0.0, f64::max);
        println!(
            "{budget:?}: {pixels} pixels, off by {worst:.4} texels beyond a step of the grid; \
             the picture by {largest:.4} in the mean, {jump:.4} more or less from one to the next"
        );
        // In the mean it is off by less than snapping may move a corner, and jumps by no more.
        assert!(largest <= STEP, "{budget:?}: {largest}");
        assert!(jump <= STEP, "{budget:?}: {jump}");
    }
}
