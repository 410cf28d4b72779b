//! M1: what `render` draws, against the f64 reference of the same conventions. No pixel away
//! from edges may differ by more than two levels.

use crate::common::Rng;
use host_tests::args::PixelFormatArg;
use host_tests::draw::{CrewSettings, draw};
use host_tests::model::{Model, obj_text};
use host_tests::reference::{
    Comparison, Cull, Options, Shade, TOLERANCE_LEVELS, View, compare, render_with,
};
use scanbeam::Mesh;
use std::fmt::Write;
use std::path::Path;

/// A mesh of the test scenes as OBJ text, with colours and normals.
fn obj_of(mesh: &Mesh<'_>) -> String {
    obj_text(mesh).expect("triangles are asked for")
}

fn model(text: &str) -> Model {
    Model::from_obj_text(text, Path::new("made here.obj")).unwrap()
}

/// The figures of a family of pictures.
#[derive(Default)]
struct Family {
    name: &'static str,
    pictures: usize,
    compared: usize,
    excluded: usize,
    worst: f64,
    worst_near_edges: f64,
    sum: f64,
    failures: Vec<String>,
}

impl Family {
    fn new(name: &'static str) -> Self {
        Self {
            name,
            ..Self::default()
        }
    }

    /// Draws a picture and holds it against the reference with exact corners or, where
    /// `snapped`, with corners on the 1/8-pixel grid.
    fn picture(&mut self, model: &Model, view: &View, snapped: bool) -> Comparison {
        let drawn = draw(model, view, PixelFormatArg::Rgb888, CrewSettings::default()).unwrap();
        let options = Options {
            steps_per_pixel: snapped.then_some(8.0),
        };
        let reference = render_with(model, view, options).unwrap();
        let c = compare(&reference, view.background, &drawn.frame).unwrap();
        self.pictures += 1;
        self.compared += c.compared_pixels;
        self.excluded += c.excluded_pixels;
        self.worst = self.worst.max(c.max_error_levels);
        self.worst_near_edges = self.worst_near_edges.max(c.max_error_near_edges);
        self.sum += c.mean_error_levels * c.compared_pixels as f64;
        if c.max_error_levels > TOLERANCE_LEVELS || c.covered_differently_away > 0 {
            self.failures
                .push(format!("picture {}: {view:?}\n{c:?}", self.pictures));
        }
        c
    }

    /// Prints the figures and fails when a picture failed, or when too little was compared.
    fn done(&self, least_compared: usize) {
        println!(
            "{}: {} pictures, {} pixels compared, {} beside edges, max {:.3}, mean {:.4} levels, \
             beside edges max {:.1} beyond what is around",
            self.name,
            self.pictures,
            self.compared,
            self.excluded,
            self.worst,
            self.sum / self.compared.max(1) as f64,
            self.worst_near_edges
        );
        assert!(
            self.failures.is_empty(),
            "{}: {} of {} pictures differ\n{}",
            self.name,
            self.failures.len(),
            self.pictures,
            self.failures.join("\n")
        );
        assert!(self.compared >= least_compared, "{}", self.compared);
    }
}

const SHADES: [Shade; 3] = [Shade::None, Shade::Flat, Shade::Gouraud];
const CULLS: [Cull; 2] = [Cull::Back, Cull::None];

/// The solid models, in all shades, from several sides, in odd sizes.
#[test]
fn models_from_all_sides() {
    let mut family = Family::new("models");
    let models = [&scenes::TEAPOT, &scenes::SPHERE, &scenes::CUBE].map(|m| model(&obj_of(m)));
    let sizes = [
        (320, 240),
        (321, 241),
        (64, 48),
        (127, 31),
        (31, 127),
        (3, 5),
        (1, 1),
    ];
    let eyes = [
        [0.0, 1.2, 2.6],
        [1.5, 2.0, 4.0],
        [-2.0, -1.5, 1.0],
        [0.1, 3.0, 0.05],
    ];
    let mut turn = 0;
    for model in &models {
        for (i, &(width, height)) in sizes.iter().enumerate() {
            for shade in SHADES {
                for cull in CULLS {
                    turn += 1;
                    let view = View {
                        width,
                        height,
                        eye: eyes[turn % eyes.len()],
                        at: [0.05, 0.1, -0.02],
                        light: [0.3, 0.8, 0.6],
                        ambient: [0.0, 0.2, 1.0][turn % 3],
                        fov: [60.0, 25.0, 100.0][i % 3],
                        shade,
                        cull,
                        background: [24, 32, 48],
                        ..View::default()
                    };
                    family.picture(model, &view, false);
                }
            }
        }
    }
    family.done(800_000);
}

/// The cube from inside: every side crosses the near plane or the guard band.
#[test]
fn rooms_from_inside() {
    let mut family = Family::new("rooms");
    let cube = model(&obj_of(&scenes::CUBE));
    let mut rng = Rng::new(21);
    for i in 0..60 {
        let view = View {
            width: [161, 320, 33][i % 3],
            height: [121, 200, 77][i % 3],
            eye: [(); 3].map(|()| 0.9 * rng.signed()),
            at: [(); 3].map(|()| 5.0 * rng.signed()),
            up: [0.1, 1.0, 0.3],
            near: [0.001, 0.02, 0.3][i / 3 % 3],
            far: farthest([0.001, 0.02, 0.3][i / 3 % 3], View::default().far),
            fov: [60.0, 140.0, 20.0, 170.0][i % 4],
            light: [0.3, 0.8, -0.6],
            shade: SHADES[i / 2 % 3],
            background: [255, 0, 255],
            ..View::default()
        };
        family.picture(&cube, &view, false);
    }
    family.done(500_000);
}

/// `far`, or what a camera with this near plane sees at most.
fn farthest(near: f64, far: f64) -> f64 {
    far.min(65_000.0 * near)
}

/// Planes that go from behind the eye to the horizon, with a colour at each corner; the eye is almost in some.
///
/// Kills: corners in the near plane without the bits of x and y that a vertex does not need.
#[test]
fn grounds_across_the_near_plane() {
    let mut family = Family::new("grounds");
    let mut rng = Rng::new(22);
    for i in 0..400 {
        let size = [3.0, 50.0, 4000.0][i % 3];
        let mut text = String::new();
        for (x, z) in [(-1, -1), (-1, 1), (1, 1), (1, -1)] {
            let [r, g, b] = [(); 3].map(|()| f64::from(rng.below(256)) / 255.0);
            let tilt = 0.05 * rng.signed();
            let (x, z) = (f64::from(x) * size, f64::from(z) * size);
            writeln!(text, "v {x} {} {z} {r} {g} {b}", size * tilt).unwrap();
        }
        text.push_str("f 1 2 3\nf 1 3 4\n");
        let view = View {
            width: [200, 321][i % 2],
            height: [150, 241][i % 2],
            eye: [
                0.3 * size * rng.signed(),
                0.02 * size + 0.4,
                0.3 * size * rng.signed(),
            ],
            at: [size * rng.signed(), -0.1 * size, size * rng.signed()],
            near: [0.01, 0.1, 1.0][i / 2 % 3],
            far: farthest(
                [0.01, 0.1, 1.0][i / 2 % 3],
                [20.0, 100.0, 10_000.0][i / 3 % 3],
            ),
            shade: SHADES[i % 3],
            light: [0.2, 1.0, 0.1],
            ..View::default()
        };
        family.picture(&model(&text), &view, false);
    }
    family.done(20_000_000);
}

/// A soup of triangles of any size with a colour at each corner, that cut into each other.
fn soup(rng: &mut Rng, count: usize, sizes: &[f64]) -> Model {
    let mut text = String::new();
    for i in 0..count {
        let size = rng.pick(sizes);
        let centre = [(); 3].map(|()| 1.2 * rng.signed());
        for _ in 0..3 {
            let [x, y, z] = centre.map(|c| c + size * rng.signed());
            let [r, g, b] = [(); 3].map(|()| f64::from(rng.below(256)) / 255.0);
            writeln!(text, "v {x} {y} {z} {r} {g} {b}").unwrap();
        }
        let at = 3 * i;
        writeln!(text, "f {} {} {}", at + 1, at + 2, at + 3).unwrap();
    }
    model(&text)
}

fn soup_view(rng: &mut Rng, i: usize) -> View {
    View {
        width: [96, 320, 321, 200][i % 4],
        height: [64, 240, 241, 321][i % 4],
        eye: [(); 3].map(|()| 3.0 * rng.signed()),
        at: [(); 3].map(|()| 0.4 * rng.signed()),
        up: [0.2, 1.0, 0.1],
        near: [0.05, 0.5][i % 2],
        fov: [60.0, 30.0, 110.0][i % 3],
        light: [0.3, 0.8, 0.6],
        shade: SHADES[i % 3],
        cull: CULLS[i / 3 % 2],
        background: [1, 2, 3],
        ..View::default()
    }
}

/// Large triangles: colours change slowly, so even the exact corners must agree.
#[test]
fn soups_of_large_triangles() {
    let mut family = Family::new("large soups");
    let mut rng = Rng::new(23);
    for i in 0..48 {
        let model = soup(&mut rng, [4, 20, 60][i % 3], &[1.0, 2.0]);
        family.picture(&model, &soup_view(&mut rng, i), false);
    }
    family.done(400_000);
}

/// Triangles of all sizes, small ones with colours that change by tens of levels a pixel: there
/// the 1/8-pixel grid alone moves a colour by more than two levels, so the reference takes its
/// corners from the grid too, and what is measured is the arithmetic.
#[test]
fn soups_of_small_triangles() {
    let mut family = Family::new("small soups");
    let mut rng = Rng::new(24);
    for i in 0..48 {
        let model = soup(&mut rng, [30, 300, 1500][i % 3], &[0.03, 0.1, 0.3]);
        family.picture(&model, &soup_view(&mut rng, i), true);
    }
    family.done(200_000);
}

/// What the format costs: the same small soups against exact corners, as a figure and a bound.
#[test]
fn the_grid_moves_steep_colours_by_little() {
    let mut family = Family::new("small soups, exact corners");
    let mut rng = Rng::new(24);
    for i in 0..24 {
        let model = soup(&mut rng, [30, 300, 1500][i % 3], &[0.03, 0.1, 0.3]);
        let c = family.picture(&model, &soup_view(&mut rng, i), false);
        assert!(c.mean_error_levels < 0.6, "{c:?}");
    }
    family.failures.clear();
    family.done(100_000);
}

/// 16-bit output is the nearest 5- or 6-bit level: half a step, and what is drawn errs by.
#[test]
fn sixteen_bits_are_the_nearest() {
    let teapot = model(&obj_of(&scenes::TEAPOT));
    let view = View {
        eye: [0.0, 1.2, 2.6],
        light: [0.3, 0.8, 0.6],
        shade: Shade::Gouraud,
        ..View::default()
    };
    let drawn = draw(
        &teapot,
        &view,
        PixelFormatArg::Rgb565,
        CrewSettings::default(),
    )
    .unwrap();
    let reference = render_with(&teapot, &view, Options::default()).unwrap();
    let c = compare(&reference, view.background, &drawn.frame).unwrap();
    assert!(c.max_error_levels < 255.0 / 31.0 / 2.0 + 2.0, "{c:?}");
}
