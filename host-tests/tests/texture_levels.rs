//! Levels of detail in whole pictures (H6), against `f64`: which level a pixel has, and that what
//! is small keeps its mean.

use crate::common::Rng;
use host_tests::args::PixelFormatArg;
use host_tests::draw::{CrewSettings, FilterArg, TextureSet, draw_textured};
use host_tests::image_out::Frame;
use host_tests::model::{Model, ModelVertex};
use host_tests::reference::{NO_OBJECT, Options, View, render_with};
use host_tests::texture_file::TextureImage;
use scanbeam::pipeline::texture::Quality;

/// The eye is at the origin and looks along -z.
fn view() -> View {
    View {
        eye: [0.0; 3],
        at: [0.0, 0.0, -1.0],
        ..View::default()
    }
}

fn drawn(model: &Model, set: &TextureSet, filter: FilterArg, quality: Quality) -> Frame {
    let how = (filter, quality);
    let crew = CrewSettings::default();
    draw_textured(model, set, how, &view(), PixelFormatArg::Rgb888, crew)
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

/// Texels of a texture of `side` texels in a pixel around a point, from differences.
fn texels_in_pixel(model: &Model, triangle: usize, (x, y): (f64, f64), side: f64) -> f64 {
    const STEP: f64 = 1.0 / 1024.0;
    let d = |dx: f64, dy: f64| {
        let (a, b) = (
            place(model, triangle, x + dx, y + dy),
            place(model, triangle, x - dx, y - dy),
        );
        [0, 1].map(|i| (a[i] - b[i]) * side / (2.0 * STEP))
    };
    let (across, down) = (d(STEP, 0.0), d(0.0, STEP));
    (across[0] * down[1] - across[1] * down[0]).abs()
}

/// A texture whose levels say their number: red is 50 of them.
fn numbered(side: u32) -> TextureImage {
    let black = Frame::new(side, side, vec![0; 3 * (side * side) as usize]).unwrap();
    let mut image = TextureImage::new(&black).unwrap();
    for (number, level) in (0u32..).zip(&mut image.levels) {
        let word = level[0] | Rgba(number * 50).word();
        level.fill(word);
    }
    image
}

/// A level of red as a word of the texture.
struct Rgba(u32);

impl Rgba {
    fn word(&self) -> u32 {
        use scanbeam::pipeline::texture::{Rgba8871, Texel, TexelFormat};
        Rgba8871::pack(Texel {
            rgb: [self.0 as u8, 0, 0],
            alpha: 127,
            undithered: false,
        })
    }
}

#[test]
fn each_pixel_has_the_level_that_its_texels_ask_for() {
    const SIDE: u32 = 128;
    let mut rng = Rng::new(5);
    let (mut seen, mut all, mut magnified) = ([0u32; 4], 0u32, 0u32);
    for _ in 0..12 {
        let mut model = Model::default();
        for _ in 0..10 {
            let repeats = 0.2 + 20.0 * rng.unit().powi(2);
            let corner = |rng: &mut Rng| {
                let far = 1.0 + 11.0 * rng.unit().powi(2);
                let mut side = || (2.0 * rng.unit() - 1.0) * far * 0.6;
                let position = [side(), side(), -far];
                (position, [repeats * rng.unit(), repeats * rng.unit()])
            };
            let corners = [(); 3].map(|()| corner(&mut rng));
            triangle(&mut model, corners);
        }
        let set = TextureSet::whole(&model, numbered(SIDE)).with_levels(true);
        let frame = drawn(&model, &set, FilterArg::Nearest, Quality::Exact);
        let options = Options {
            steps_per_pixel: Some(8.0),
        };
        let reference = render_with(&model, &view(), options).unwrap();
        for (i, pixel) in frame.rgb().chunks_exact(3).enumerate() {
            let object = reference.object[i];
            if object == NO_OBJECT || reference.near_edge[i] {
                continue;
            }
            let corners = model.triangles[object as usize];
            let [a, b, c] = corners.map(|k| projected(model.vertices[k as usize].position));
            // Thin ones change their area when corners are rounded to eighths.
            if area(a, b, c).abs() < 1000.0 {
                continue;
            }
            let (x, y) = (i % frame.width() as usize, i / frame.width() as usize);
            let at = (x as f64 + 0.5, y as f64 + 0.5);
            let texels = texels_in_pixel(&model, object as usize, at, f64::from(SIDE));
            // A level begins at 2, 8 and 32 texels.
            let level = |texels: f64| ((texels.log2() + 1.0) / 2.0).floor().clamp(0.0, 3.0) as u32;
            let drawn = u32::from(pixel[0]) / 50;
            let (low, high) = (level(texels / 1.08), level(texels * 1.08));
            assert!(
                (low..=high).contains(&drawn),
                "({x}, {y}): {texels} texels a pixel, level {drawn}"
            );
            all += 1;
            seen[drawn as usize] += 1;
            if texels <= 1.0 {
                assert_eq!(drawn, 0, "magnified");
                magnified += 1;
            }
        }
    }
    println!("{all} pixels: {seen:?}, {magnified} of them magnified");
    assert!(seen.iter().all(|n| *n > 2_000), "{seen:?}");
    assert!(magnified > 2_000);
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
            sum += f64::from(frame.pixel(x, y).unwrap()[0]);
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
            let frame = drawn(&model, &set, filter, Quality::Balanced);
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
    assert!(worst <= 8.0, "{worst}");
}

#[test]
fn what_is_magnified_is_drawn_whole() {
    for tilt in [0.0, 0.1, 0.2] {
        let model = wall(0.02, 2.0, tilt);
        let set = || TextureSet::whole(&model, checker(64, 2));
        for filter in [FilterArg::Nearest, FilterArg::Bilinear] {
            for quality in [Quality::Fast, Quality::Exact] {
                let with = drawn(&model, &set().with_levels(true), filter, quality);
                let without = drawn(&model, &set(), filter, quality);
                assert!(with == without, "{filter:?} {quality:?}, tilt {tilt}");
                let first = without.pixel(20, 20);
                assert!((0..200).any(|x| without.pixel(x, 100) != first), "it shows");
            }
        }
    }
}
