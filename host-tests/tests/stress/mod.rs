//! One triangle at a time, put on chosen 1/8-pixel places at chosen distances, and held pixel by
//! pixel against whole numbers and f64: coverage, depth and colour, in every format.

use crate::common::{LineRooms, Rng, SceneRooms, line};
use crate::watertight::count::{Count, Place, doubled_area};
use scanbeam::pipeline::{
    Depth32, FlatDepth, FlatPainter, GouraudDepth, GouraudPainter, Instance, LineDepth, Pipeline,
    WordOf,
};
use scanbeam::pixel::{PixelFormat, Rgb565, Rgb565Be, Rgb888};
use scanbeam::{Affine, Camera, Cull, Faces, Mesh, Screen};

/// Distance of the near plane: what is 1 away is just behind it.
pub const NEAR: f64 = 1.0 - 1.0 / 1024.0;
/// Depth units of 1/w = 1.
pub const ONE: f64 = 2_147_483_648.0;

/// A corner: where it is seen, how far away, and its colour.
#[derive(Clone, Copy, Debug)]
pub struct Corner {
    pub at: Place,
    pub w: f64,
    pub colour: [u8; 3],
}

/// The worst that was seen, each as a part of its bound or in its own unit.
#[derive(Debug, Default)]
pub struct Worst {
    pub triangles: usize,
    pub pixels: u64,
    /// Depth error over its bound.
    pub depth: f64,
    /// Depth error, 2^31 being 1/w = 1.
    pub depth_units: f64,
    /// Steps of the output away from the exact interpolation.
    pub steps: f64,
}

/// How far the plane of depth and the depths of corners may be off, in units of 2^-31.
///
/// | part | bound |
/// |---|---|
/// | plane | 2^13 units, and half a unit a pixel each way for its rounded steps |
/// | corner | three products and an offset, each rounded to 2^-26 of the model's scale: 4 of these, over its distance |
/// | reciprocal | 2^-27 of it |
/// | ends | corners keep 2^15 units from 0 and from 2^31 |
pub fn depth_bound(screen: Screen, corners: &[Corner; 3]) -> f64 {
    let extent = |c: [i32; 3]| c.iter().max().unwrap() - c.iter().min().unwrap();
    let (x, y) = (
        extent(corners.map(|c| c.at.0)),
        extent(corners.map(|c| c.at.1)),
    );
    let grid = 4.0 * 2f64.powi(-26) * scale(screen, corners);
    let corner = corners.iter().fold(0.0, |worst: f64, c| {
        let q = NEAR / c.w;
        let near_an_end = q * ONE < 32_768.0 || (1.0 - q) * ONE < 32_768.0;
        let ends = if near_an_end { 32_768.0 } else { 0.0 };
        worst.max(q * ONE * (grid / c.w + 2f64.powi(-27)) + ends)
    });
    8192.0 + 2.0 + f64::from(x + y) / 16.0 + corner
}

/// The scale of the triangle's model: a power of two that all its coordinates are within.
fn scale(screen: Screen, corners: &[Corner; 3]) -> f64 {
    let farthest = corners.iter().fold(0.0, |m: f64, c| {
        let [x, y] = from_middle(screen, c.at);
        m.max(c.w * (x.abs().max(y.abs()) / 32_768.0).max(1.0))
    });
    farthest.log2().ceil().exp2()
}

/// Colours that try the ends of the range.
pub fn colour(rng: &mut Rng) -> [u8; 3] {
    match rng.below(4) {
        0 => [(); 3].map(|()| rng.pick(&[0, 255])),
        1 => [rng.pick(&[0, 255]); 3],
        2 => [(); 3].map(|()| rng.pick(&[0, 1, 127, 128, 254, 255])),
        _ => [(); 3].map(|()| rng.below(256) as u8),
    }
}

/// Distances of corners: all 1/w between 1 and 2^-`bits`.
pub fn distance(rng: &mut Rng, bits: f64) -> f64 {
    (bits * (0.5 + 0.5 * rng.signed())).exp2()
}

/// The triangle's picture on `screen` by every pipeline in every format; see [`Worst`].
pub fn check(screen: Screen, corners: &[Corner; 3], worst: &mut Worst) {
    worst.triangles += 1;
    with_depth::<GouraudDepth<Rgb888>>(screen, corners, worst);
    with_depth::<GouraudDepth<Rgb565>>(screen, corners, worst);
    with_depth::<GouraudDepth<Rgb565Be>>(screen, corners, worst);
    with_depth::<FlatDepth<Rgb888>>(screen, corners, worst);
    painted::<GouraudPainter<Rgb888>>(screen, corners, worst);
    painted::<GouraudPainter<Rgb565Be>>(screen, corners, worst);
    painted::<FlatPainter<Rgb565>>(screen, corners, worst);
}

/// Units from the picture's middle.
fn from_middle(screen: Screen, at: Place) -> [f64; 2] {
    let (w, h) = (i32::from(screen.width()), i32::from(screen.height()));
    [f64::from(at.0 - 4 * w), f64::from(at.1 - 4 * h)]
}

/// Draws one triangle into `rooms`' scene and hands it to `draw`.
pub fn with_scene<P: Pipeline, R>(
    screen: Screen,
    triangles: &[[Corner; 3]],
    draw: impl FnOnce(&scanbeam::pipeline::Scene<'_, P>) -> R,
) -> R {
    let height = usize::from(screen.height());
    let mut rooms = SceneRooms::<P>::new(8 * triangles.len(), 8 * triangles.len(), height);
    let mut scene = rooms.scene(screen);
    // One unit of the screen is 2^-15 of the distance.
    let camera = Camera::look_at(
        [0.0; 3],
        [0.0, 0.0, -1.0],
        [0.0, 1.0, 0.0],
        4096.0,
        NEAR as f32,
        Camera::MOST_FAR * NEAR as f32,
    );
    scene.begin(&camera.unwrap()).unwrap();
    for corners in triangles {
        let scale = scale(screen, corners);
        let q30 = |v: f64| (v / scale * f64::from(1 << 30)).round() as i32;
        let positions = corners.map(|c| {
            let [x, y] = from_middle(screen, c.at);
            [q30(x / 32_768.0 * c.w), q30(-y / 32_768.0 * c.w), q30(-c.w)]
        });
        let mesh = Mesh {
            positions: &positions,
            normals: &[],
            colours: &corners.map(|c| c.colour),
            faces: Faces::Triangles(&[[0, 1, 2]]),
        };
        let instance = Instance {
            cull: Cull::None,
            model: Affine::placed(scale as f32, [0.0; 3]).unwrap(),
            ..Instance::default()
        };
        let drawn = scene.draw(&mesh, &instance).unwrap();
        assert_eq!(drawn.clipped, 0, "places are chosen within the planes");
    }
    draw(&scene)
}

/// What is exact at a pixel: the weights of the corners, from whole numbers.
fn weights(p: [Place; 3], column: i32, line: i32) -> [f64; 3] {
    let at = (8 * column + 4, 8 * line + 4);
    let area = doubled_area(p) as f64;
    [[at, p[1], p[2]], [p[0], at, p[2]], [p[0], p[1], at]].map(|t| doubled_area(t) as f64 / area)
}

/// Depth at a pixel, in units of 2^-31.
pub fn exact_depth(corners: &[Corner; 3], column: i32, line: i32) -> f64 {
    let part = weights(corners.map(|c| c.at), column, line);
    (0..3).map(|k| part[k] * NEAR / corners[k].w * ONE).sum()
}

/// Whether colours are one a face.
trait Look: Pipeline {
    const FLAT: bool;
}

impl<D: LineDepth, F: PixelFormat> Look
    for scanbeam::pipeline::Parts<scanbeam::pipeline::Gouraud, D, F>
{
    const FLAT: bool = false;
}

impl<D: LineDepth, F: PixelFormat> Look
    for scanbeam::pipeline::Parts<scanbeam::pipeline::Flat, D, F>
{
    const FLAT: bool = true;
}

/// Steps of the output of a drawn word.
pub fn steps<P: Pipeline>(word: WordOf<P>) -> [f64; 3] {
    let levels = P::Pixel::to_rgb8(word);
    [0, 1, 2].map(|i| {
        let steps = f64::from(P::Pixel::STEPS[i]);
        // The words of 5 and 6 bits come back exactly.
        (f64::from(levels[i]) * steps / 255.0).round()
    })
}

/// P4: every channel is within a step of the corners' own, and within a step of the exact
/// interpolation.
///
/// Half a step is the rounding. The rest is less than half a step: a corner's field has at least
/// 2 bits below the step, a plane errs by an eighth, a packed run of 8 by another eighth.
fn colours<P: Look>(
    word: WordOf<P>,
    corners: &[Corner; 3],
    weights: [f64; 3],
    worst: &mut Worst,
    context: impl Fn() -> String,
) {
    let got = steps::<P>(word);
    for i in 0..3 {
        let per_level = f64::from(P::Pixel::STEPS[i]) / 255.0;
        let own = corners.map(|c| steps::<P>(P::Pixel::from_rgb8(c.colour))[i]);
        let corner = corners.map(|c| f64::from(c.colour[i]) * per_level);
        let (low, high, exact) = if P::FLAT {
            (own[0], own[0], corner[0])
        } else {
            (
                own.into_iter().fold(f64::MAX, f64::min),
                own.into_iter().fold(0.0, f64::max),
                (0..3).map(|k| weights[k] * corner[k]).sum(),
            )
        };
        assert!(
            (low - 1.0..=high + 1.0).contains(&got[i]),
            "channel {i}: {got:?} of {own:?}, {}",
            context()
        );
        let off = (got[i] - exact).abs();
        worst.steps = worst.steps.max(off);
        assert!(
            off <= 1.0,
            "channel {i}: {got:?} for {exact}, {}",
            context()
        );
    }
}

/// With depth and without a cache, so that the depth of each line can be looked at; and again
/// with a cache, where a triangle alone is drawn without depth.
fn with_depth<P: Look + Pipeline<Depth = Depth32>>(
    screen: Screen,
    corners: &[Corner; 3],
    worst: &mut Worst,
) where
    WordOf<P>: std::fmt::Debug,
{
    let places = corners.map(|c| c.at);
    let count = Count::new(screen, &[places], Cull::None);
    let bound = depth_bound(screen, corners);
    with_scene::<P, _>(screen, std::slice::from_ref(corners), |scene| {
        let mut cached = LineRooms::<P>::fitting(2, scene);
        let mut cached = cached.renderer();
        // A fresh renderer starts from the top, so of a high picture not every line.
        for y in (0..screen.height()).step_by(usize::from(screen.height() / 64).max(1)) {
            let hits = &count.hits[count.line(y)];
            let mut rooms = LineRooms::<P>::fitting(0, scene);
            let pixels = line(&mut rooms.renderer(), scene, y);
            assert_eq!(pixels, line(&mut cached, scene, y), "line {y}: {corners:?}");
            if hits.iter().all(|h| *h == 0) {
                assert!(pixels.iter().all(|p| *p == WordOf::<P>::default()));
                continue;
            }
            for (x, (word, cell)) in pixels.iter().zip(rooms.depth()).enumerate() {
                let context = || format!("{screen:?} column {x} line {y} of {corners:?}");
                assert_eq!(u32::from(*cell != 0), hits[x], "{}", context());
                if hits[x] == 0 {
                    continue;
                }
                worst.pixels += 1;
                let part = weights(places, x as i32, i32::from(y));
                let exact = exact_depth(corners, x as i32, i32::from(y));
                let off = (f64::from(*cell) - exact).abs();
                worst.depth = worst.depth.max(off / bound);
                worst.depth_units = worst.depth_units.max(off);
                assert!(
                    off <= bound,
                    "depth {cell} for {exact}, {bound}, {}",
                    context()
                );
                colours::<P>(*word, corners, part, worst, context);
            }
        }
    });
}

/// Without depth: over a ground that no covered pixel of the other look can have.
fn painted<P: Look>(screen: Screen, corners: &[Corner; 3], worst: &mut Worst)
where
    WordOf<P>: std::fmt::Debug,
{
    let places = corners.map(|c| c.at);
    let count = Count::new(screen, &[places], Cull::None);
    with_scene::<P, _>(screen, std::slice::from_ref(corners), |scene| {
        let mut rooms = LineRooms::<P>::fitting(1, scene);
        let mut renderer = rooms.renderer();
        for y in 0..screen.height() {
            let pixels = line(&mut renderer, scene, y);
            let hits = &count.hits[count.line(y)];
            for (x, word) in pixels.iter().enumerate() {
                let context = || format!("{screen:?} column {x} line {y} of {corners:?}");
                if hits[x] == 0 {
                    assert_eq!(*word, WordOf::<P>::default(), "{}", context());
                } else {
                    let part = weights(places, x as i32, i32::from(y));
                    colours::<P>(*word, corners, part, worst, context);
                }
            }
        }
    });
}
