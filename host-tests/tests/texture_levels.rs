//! Levels of detail in whole pictures (H6), against `f64`: what is small keeps its mean.

use host_tests::args::PixelFormatArg;
use host_tests::draw::{CrewSettings, FilterArg, Skins, TextureSet, draw_textured};
use host_tests::image_out::Frame;
use host_tests::model::{Model, ModelVertex};
use host_tests::reference::View;
use host_tests::texture_file::TextureImage;
use scanbeam::scene::Budget;

/// The eye is at the origin and looks along -z.
fn view() -> View {
    View {
        eye: [0.0; 3],
        at: [0.0, 0.0, -1.0],
        ..View::default()
    }
}

fn drawn(model: &Model, set: &TextureSet, filter: FilterArg, budget: Budget) -> Frame {
    let skins = Skins {
        set,
        filter,
        budget,
    };
    let crew = CrewSettings::default();
    draw_textured(model, skins, &view(), PixelFormatArg::Rgb888, crew)
        .unwrap()
        .frame
}

fn triangle(model: &mut Model, corners: [([f64; 3], [f64; 2]); 3]) {
    for (position, uv) in corners {
        model.vertices.push(ModelVertex {
            position,
            normal: [0.0, 0.0, 1.0],
            colour: [1.0; 3],
            uv,
        });
    }
    let first = model.vertices.len() as u32 - 3;
    model.triangles.push([first, first + 1, first + 2]);
    model.triangle_materials.push(None);
}

/// The place of a corner on the picture, and its 1/w.
fn projected(p: [f64; 3]) -> [f64; 3] {
    let view = view();
    let focal = f64::from(view.height) / 2.0 / (view.fov.to_radians() / 2.0).tan();
    let q = -1.0 / p[2];
    [
        f64::from(view.width) / 2.0 + focal * p[0] * q,
        f64::from(view.height) / 2.0 - focal * p[1] * q,
        q,
    ]
}

/// Doubled area.
fn area(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
}

/// The texture place (sides of 1) of a triangle at a point of the picture, in perspective.
fn place(model: &Model, triangle: usize, x: f64, y: f64) -> [f64; 2] {
    let corners = model.triangles[triangle].map(|i| &model.vertices[i as usize]);
    let [a, b, c] = corners.map(|v| projected(v.position));
    let at = [x, y, 0.0];
    let weights = [area(at, b, c), area(a, at, c), area(a, b, at)];
    let (mut over, mut q) = ([0.0; 2], 0.0);
    for ((corner, weight), p) in corners.iter().zip(weights).zip([a, b, c]) {
        q += weight * p[2];
        over = [0, 1].map(|i| over[i] + weight * p[2] * corner.uv[i]);
    }
    over.map(|o| o / q)
}

/// A checker of squares of `cell` texels.
fn checker(side: u32, cell: u32) -> TextureImage {
    let rgb = (0..side)
        .flat_map(|y| (0..side).flat_map(move |x| [((x / cell + y / cell) % 2) as u8 * 255; 3]))
        .collect();
    TextureImage::new(&Frame::new(side, side, rgb).unwrap()).unwrap()
}

/// The mean of the picture over 16 x 16 pixels from a pixel on.
fn mean(frame: &Frame, (left, top): (u32, u32)) -> f64 {
    let mut sum = 0.0;
    for y in top..top + 16 {
        for x in left..left + 16 {
            // Green has the most bits of a texel.
            sum += f64::from(frame.pixel(x, y).unwrap()[1]);
        }
    }
    sum / 256.0
}

/// The mean of the checker itself over the same pixels, 6 x 6 places in each, in `f64`.
fn true_mean(model: &Model, (left, top): (u32, u32), cells: f64) -> f64 {
    let mut sum = 0.0;
    for y in 0..16 * 6 {
        for x in 0..16 * 6 {
            let at = |first: u32, i: u32| f64::from(first) + (f64::from(i) + 0.5) / 6.0;
            let [u, v] = place(model, 0, at(left, x), at(top, y));
            let odd = ((u * cells).floor() + ((1.0 - v) * cells).floor()).rem_euclid(2.0);
            sum += odd * 255.0;
        }
    }
    sum / f64::from(96 * 96)
}

/// A tilted wall over the whole picture, on which `repeats` textures are seen a unit: in 16 parts,
/// as a triangle may stretch over 4096 texels.
fn wall(repeats: f64, far: f64, tilt: f64) -> Model {
    let mut model = Model::default();
    let corner = |x: i32, y: i32| {
        let [x, y] = [x, y].map(|i| f64::from(i) / 2.0 - 1.0);
        let position = [x * far, y * far, -far * (1.0 + tilt * (x + y))];
        (position, [x * repeats * far, y * repeats * far])
    };
    for (x, y) in (0..4).flat_map(|y| (0..4).map(move |x| (x, y))) {
        let corners = [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)].map(|(x, y)| corner(x, y));
        let [a, b, c, d] = corners;
        triangle(&mut model, [a, b, c]);
        triangle(&mut model, [a, c, d]);
    }
    model
}

/// Windows of checkers from 1/2 to 11 texels a pixel: the mean and the largest of what their own
/// means are off.
fn off_the_mean(levels: bool, filter: FilterArg) -> (f64, f64) {
    const SIDE: u32 = 128;
    let mut off = Vec::new();
    for cell in [1, 2, 4] {
        for step in 0..14 {
            let density = 0.5 * 1.27f64.powi(step);
            let far = 2.0;
            let focal = 120.0 / 30f64.to_radians().tan();
            let repeats = density * focal / far / f64::from(SIDE);
            let model = wall(repeats, far, 0.05);
            let set = TextureSet::whole(&model, checker(SIDE, cell)).with_levels(levels);
            let frame = drawn(&model, &set, filter, Budget::BALANCED);
            for window in [(40, 40), (160, 100), (200, 180), (97, 203)] {
                let truth = true_mean(&model, window, f64::from(SIDE / cell));
                off.push((mean(&frame, window) - truth).abs());
            }
        }
    }
    let sum: f64 = off.iter().sum();
    let count = off.len() as f64;
    (sum / count, off.into_iter().fold(0.0, f64::max))
}

/// The nearest texel still beats with cells of two texels of its level, as it would at any level:
/// there the mean of all windows is held, and each window where four texels are weighed.
#[test]
fn small_checkers_keep_their_mean() {
    let (mean, worst) = off_the_mean(false, FilterArg::Nearest);
    println!("without levels: off by {mean:.2} of 255, at most {worst:.2}");
    assert!(worst > 40.0, "the test sees aliases: {worst}");
    let (mean, worst) = off_the_mean(true, FilterArg::Nearest);
    println!("nearest: off by {mean:.2} of 255, at most {worst:.2}");
    assert!(mean <= 4.0, "{mean}");
    let (mean, worst) = off_the_mean(true, FilterArg::Bilinear);
    println!("bilinear: off by {mean:.2} of 255, at most {worst:.2}");
    // 8 levels, and half a step of 6 bits in each texel.
    assert!(worst <= 8.0 + 255.0 / 63.0 / 2.0, "{worst}");
}
