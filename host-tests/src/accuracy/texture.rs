//! Texture places: along spans by every way of dividing, and in whole scenes by every quality.

use super::coverage::rates;
use super::stage::Rng;
use super::{Errors, Row};
use crate::model::{Model, ModelVertex};
use crate::places::places;
use crate::reference::{NO_OBJECT, Options, TextureMap, Textures, View, render_textured};
use scanbeam::pipeline::texture::{
    FRACTION, Homogeneous, PerspectiveSpan, Quality, Stride, Texels, Uv,
};
use std::error::Error;

const FAMILY: &str = "texture";
const OFF: &str = "texels";
const WRONG: &str = "% wrong texel";
/// The span of the kernels' goals: 1/w falls or rises to a tenth.
const TENTH: &str = "spans of 208 pixels, 1/w 1:10, 64 texels";
const ANY: &str = "spans of 2 to 1024 pixels, 1/w 1:1 to 1:100, 4 to 1024 texels";
const SCENES: &str = "sphere, ground, quad";
const CHOSEN: [(&str, &str); 3] = [
    (TENTH, "texels chosen, spans of 208 pixels, 1/w 1:10"),
    (ANY, "texels chosen, spans of 2 to 1024 pixels, to 1:100"),
    (SCENES, "texels chosen, sphere, ground, quad"),
];

/// How the places of a span are reckoned.
#[derive(Clone, Copy)]
enum Way {
    Fixed(Stride),
    Within(Quality),
}

/// By name, with the firmware's kernel.
const WAYS: [(&str, Way, &str); 8] = [
    ("affine", Way::Fixed(Stride::Affine), "affine_565"),
    (
        "linear over 16",
        Way::Fixed(Stride::Sixteen),
        "perspective_16",
    ),
    ("linear over 8", Way::Fixed(Stride::Eight), "perspective_8"),
    ("linear over 4", Way::Fixed(Stride::Four), "perspective_4"),
    (
        "every 2nd, average between",
        Way::Fixed(Stride::Two),
        "perspective_2",
    ),
    (
        "fast: 1/2 texel",
        Way::Within(Quality::Fast),
        "texture_fast",
    ),
    (
        "balanced: 1/4 texel",
        Way::Within(Quality::Balanced),
        "texture_balanced",
    ),
    (
        "exact: every pixel",
        Way::Within(Quality::Exact),
        "perspective_1",
    ),
];

/// What a skin has when nothing is said.
#[cfg(test)]
pub(super) const DEFAULT: &str = "balanced: 1/4 texel";

pub(super) fn rows() -> Result<Vec<Row>, Box<dyn Error>> {
    let mut rows = Vec::new();
    for (name, way, kernel) in WAYS {
        let tenth = spans(way, 6, |rng| Ends::random(rng, 208, 10.0, 64.0));
        rows.extend(both(tenth, TENTH, name, kernel));
        let any = spans(way, 7, |rng| {
            let pixels = rng.log(2.0, 1025.0) as usize;
            let (ratio, texels) = (rng.log(1.0, 100.0), rng.log(4.0, 1024.0));
            Ends::random(rng, pixels, ratio, texels)
        });
        rows.extend(both(any, ANY, name, kernel));
        if let Way::Within(quality) = way {
            rows.extend(both(scenes(quality)?, SCENES, name, kernel));
        }
    }
    Ok(rows)
}

/// Distances of places, and wrong texels of all, of each batch.
type Found = (Errors, Vec<(u32, u32)>);

/// The row of distances, and that of texels chosen.
fn both(
    (errors, batches): Found,
    case: &'static str,
    name: &'static str,
    kernel: &'static str,
) -> Vec<Row> {
    let chosen = CHOSEN.iter().filter(|(of, _)| *of == case);
    let chosen = chosen
        .map(|(_, chosen)| rates((FAMILY, chosen, name, WRONG, Some(kernel)), 100.0, &batches));
    let mut rows: Vec<Row> = chosen.collect();
    rows.insert(0, errors.row((FAMILY, case, name, OFF, Some(kernel))));
    rows
}

/// A span in real numbers: 1/w, u and v in texels at the first and the last pixel's centre.
struct Ends {
    pixels: usize,
    q: [f64; 2],
    u: [f64; 2],
    v: [f64; 2],
}

impl Ends {
    /// Places from 0 to so many texels; the nearest end is anywhere in its exponent's octave.
    fn random(rng: &mut Rng, pixels: usize, ratio: f64, texels: f64) -> Self {
        let near = 0.5 + 0.499 * rng.unit();
        let mut q = [near, near / ratio];
        if rng.unit() < 0.5 {
            q.reverse();
        }
        let [u, v] = [(); 2].map(|()| [(); 2].map(|()| texels * rng.unit()));
        Self { pixels, q, u, v }
    }

    fn steps(&self) -> f64 {
        (self.pixels - 1) as f64
    }

    /// Where a pixel lies on the texture.
    fn place(&self, pixel: usize) -> [f64; 2] {
        let t = pixel as f64 / self.steps();
        let mix = |a: f64, b: f64| a * (1.0 - t) + b * t;
        let q = mix(self.q[0], self.q[1]);
        [self.u, self.v].map(|x| mix(x[0] * self.q[0], x[1] * self.q[1]) / q)
    }

    /// As planes hand it to a span: 1/w with 31 fraction bits, places over w with 21.
    fn span(&self) -> PerspectiveSpan {
        let fixed = |x: [f64; 2], bits: i32| x.map(|x| x * 2f64.powi(bits));
        let over = |x: [f64; 2]| fixed([x[0] * self.q[0], x[1] * self.q[1]], 21);
        let (q, s, t) = (fixed(self.q, 31), over(self.u), over(self.v));
        let at = |x: [f64; 2]| x[0].round() as i32;
        let step = |x: [f64; 2]| ((x[1] - x[0]) / self.steps()).round() as i32;
        PerspectiveSpan {
            at: Homogeneous {
                q: at(q),
                s: at(s),
                t: at(t),
            },
            step: Homogeneous {
                q: step(q),
                s: step(s),
                t: step(t),
            },
        }
    }
}

/// A texture whose texel is its place.
struct Placed;

impl Texels for Placed {
    type Texel = Uv;

    fn at(&self, place: Uv) -> Uv {
        place
    }
}

/// Random spans by a way.
fn spans(way: Way, seed: u64, random: impl Fn(&mut Rng) -> Ends) -> Found {
    const BATCHES: usize = 20;
    const SPANS: usize = 100;
    let mut rng = Rng::new(seed);
    let mut errors = Errors::default();
    let mut batches = vec![(0, 0); BATCHES];
    let mut line = Vec::new();
    for batch in &mut batches {
        for _ in 0..SPANS {
            let ends = random(&mut rng);
            let span = ends.span();
            let stride = match way {
                Way::Fixed(stride) => stride,
                Way::Within(quality) => quality.budget().stride(&span, ends.pixels),
            };
            line.clear();
            line.resize(ends.pixels, Uv::default());
            span.draw(stride, &Placed, &mut line, |pixel, place| *pixel = place);
            for (pixel, place) in line.iter().enumerate() {
                let want = ends.place(pixel);
                let got = [place.u, place.v].map(|x| f64::from(x) / f64::from(1 << FRACTION));
                errors.push((got[0] - want[0]).abs().max((got[1] - want[1]).abs()));
                let same = got.map(f64::floor) == want.map(f64::floor);
                batch.0 += u32::from(!same);
                batch.1 += 1;
            }
        }
    }
    (errors, batches)
}

/// Texels a side of the scenes' texture.
const SIDE: u32 = 128;

/// Whole scenes through the pipeline, corners moved to the grid of the screen; each a batch.
///
/// The near plane cuts none: what it makes of corners is the edges' error, which has its own bound.
fn scenes(quality: Quality) -> Result<Found, Box<dyn Error>> {
    let mut errors = Errors::default();
    let mut batches = Vec::new();
    let map = TextureMap::made(SIDE, SIDE, |_, _| [255.0; 3]);
    for (model, view) in pictures() {
        let of_triangle = vec![Some(0); model.triangles.len()];
        let textures = Textures {
            maps: std::slice::from_ref(&map),
            of_triangle: &of_triangle,
        };
        let snapped = Options {
            steps_per_pixel: Some(8.0),
        };
        let reference = render_textured(&model, textures, &view, snapped)?;
        let drawn = places(&model, SIDE, quality, &view)?;
        let mut batch = (0, 0);
        for (i, shown) in drawn.iter().enumerate() {
            if reference.object[i] == NO_OBJECT || reference.near_edge[i] {
                continue;
            }
            let want = reference.place[i];
            let off = shown.off(want).ok_or("a pixel shows no texel")?;
            errors.push(off[0].abs().max(off[1].abs()));
            batch.0 += u32::from(!shown.is_texel_of(want));
            batch.1 += 1;
        }
        batches.push(batch);
    }
    Ok((errors, batches))
}

/// The scenes: a sphere as scene B has it, a ground plane to the horizon, a turned and tilted quad.
fn pictures() -> Vec<(Model, View)> {
    let far = |eye: [f64; 3], at: [f64; 3]| View {
        eye,
        at,
        // 53.13 degrees across.
        fov: 2.0 * 0.375f64.atan().to_degrees(),
        ..View::default()
    };
    let square = |corner: &dyn Fn(f64, f64) -> [f64; 3], repeats: f64| {
        sheet(1, |x, y| (corner(x, y), [x * repeats, y * repeats]))
    };
    let turned = |x: f64, y: f64| {
        let (sin, cos) = 0.6f64.sin_cos();
        let (x, y) = (2.0 * x - 1.0, 2.0 * y - 1.0);
        let (x, y) = (x * cos - y * sin, x * sin + y * cos);
        [x, y * 0.6, -y * 1.5]
    };
    vec![
        (ball(32), far([1.2, 2.0, 3.2], [0.0; 3])),
        (
            // Wider than the picture at any distance, and nothing of it is cut.
            sheet(16, |x, y| {
                let away = 90.0 * y;
                let aside = (2.0 * x - 1.0) * (3.0 + 0.7 * away);
                ([aside, -1.0, -1.0 - away], [aside / 10.0, away / 10.0])
            }),
            far([0.3, 0.2, 1.0], [0.0, 0.0, -8.0]),
        ),
        (square(&turned, 1.0), far([0.2, 0.1, 2.6], [0.0; 3])),
    ]
}

/// A sheet of `n` squares a side; corners and their places by where they are on it, 0 to 1.
fn sheet(n: u32, corner: impl Fn(f64, f64) -> ([f64; 3], [f64; 2])) -> Model {
    let mut model = Model::default();
    for j in 0..=n {
        for i in 0..=n {
            let (position, uv) = corner(f64::from(i) / f64::from(n), f64::from(j) / f64::from(n));
            model.vertices.push(ModelVertex {
                position,
                normal: [0.0, 0.0, 1.0],
                colour: [1.0; 3],
                uv,
            });
        }
    }
    for j in 0..n {
        for i in 0..n {
            let at = j * (n + 1) + i;
            for triangle in [[at, at + 1, at + n + 2], [at, at + n + 2, at + n + 1]] {
                model.triangles.push(triangle);
                model.triangle_materials.push(None);
            }
        }
    }
    model
}

/// A sphere of radius 1 by longitude and latitude, the texture once around it.
fn ball(n: u32) -> Model {
    sheet(n, |x, y| {
        let (longitude, latitude) = (x * std::f64::consts::TAU, (y - 0.5) * std::f64::consts::PI);
        let around = latitude.cos();
        let position = [
            around * longitude.sin(),
            latitude.sin(),
            around * longitude.cos(),
        ];
        (position, [x, y])
    })
}
