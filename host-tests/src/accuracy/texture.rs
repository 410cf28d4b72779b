//! Texture places: in triangles by the renderer's budgets and the laboratory's divisions, and in whole scenes by the
//! renderer.
//!
//! The texture's texels are their own places, so a picture says which texel each pixel shows. A pixel is off by how far
//! its place lies outside of that texel.

use super::coverage::rates;
use super::stage::{Done, Place, Rng, Stage, ahead, call, covers, plane};
use super::{Errors, Row};
use crate::model::{Model, ModelVertex};
use crate::reference::{NO_OBJECT, Options, TextureMap, Textures, View, render_textured};
use crate::rooms::{Room, picture};
use scanbeam::look::Textured;
use scanbeam::mesh::ScreenVertex;
use scanbeam::pixel::Rgb565;
use scanbeam::scene::{Budget, ScreenCorner, Skin, Texture};
use scanbeam::{Affine, Camera, Cull, Draw, Faces, Mesh, Screen};
use scanbeam_lab::perspective::{FRACTION, Homogeneous, PerspectiveSpan, Stride, Uv};
use std::error::Error;

const FAMILY: &str = "texture";
const OFF: &str = "texels";
const WRONG: &str = "% wrong texel";
const TENTH: &str = "triangles 208 pixels wide, 1/w 1:10, 64 texels";
const ANY: &str = "triangles 2 to 1000 pixels wide, 1/w 1:1 to 1:100, 4 to 1024 texels";
const SCENES: &str = "sphere, ground, quad";
const CHOSEN: [(&str, &str); 3] = [
    (TENTH, "texels chosen, 208 pixels wide, 1/w 1:10"),
    (ANY, "texels chosen, 2 to 1000 pixels wide, to 1:100"),
    (SCENES, "texels chosen, sphere, ground, quad"),
];

/// How the places of a span are reckoned.
#[derive(Clone, Copy)]
enum Way {
    Fixed(Stride),
    Within(Budget),
}

/// By name, with the firmware's kernel.
const WAYS: [(&str, Way, &str); 9] = [
    ("affine", Way::Fixed(Stride::Affine), "affine"),
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
    ("every pixel", Way::Fixed(Stride::One), "perspective_1"),
    (
        "fast: 1/2 texel",
        Way::Within(Budget::FAST),
        "leaning_fast_565_large",
    ),
    (
        "balanced: 1/4 texel",
        Way::Within(Budget::BALANCED),
        "leaning_balanced_565_large",
    ),
    (
        "exact: 1/100 texel",
        Way::Within(Budget::EXACT),
        "leaning_exact_565_large",
    ),
];

pub(super) fn rows() -> Result<Vec<Row>, Box<dyn Error>> {
    let texels = texels();
    let map = Texture::words(&texels, SIDE, SIDE)?;
    let mut rows = Vec::new();
    for (name, way, kernel) in WAYS {
        let tenth = spans(way, &map, 6, |rng| Subject::random(rng, 208, 10.0, 64.0))?;
        rows.extend(both(tenth, TENTH, name, kernel));
        let any = spans(way, &map, 7, |rng| {
            let pixels = rng.log(2.0, 1001.0) as i32;
            let (ratio, texels) = (rng.log(1.0, 100.0), rng.log(4.0, 1024.0));
            Subject::random(rng, pixels, ratio, texels)
        })?;
        rows.extend(both(any, ANY, name, kernel));
        if let Way::Within(budget) = way {
            rows.extend(both(scenes(budget, &map)?, SCENES, name, kernel));
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

/// Texels a side of the texture.
const SIDE: u32 = 128;
/// A texel that it has not.
const NOTHING: u16 = 0xFFFF;

/// Each texel its own number.
fn texels() -> Vec<u16> {
    (0..(SIDE * SIDE) as u16).collect()
}

/// Adds how far the texel that a pixel shows is from its place.
fn compare((errors, batch): (&mut Errors, &mut (u32, u32)), texel: u16, want: [f64; 2]) {
    let side = f64::from(SIDE);
    let shown = [u32::from(texel) % SIDE, u32::from(texel) / SIDE].map(f64::from);
    let off = [0, 1].map(|i| {
        let off = shown[i] + 0.5 - want[i];
        // The texture repeats.
        ((off - (off / side).round() * side).abs() - 0.5).max(0.0)
    });
    errors.push(off[0].max(off[1]));
    batch.0 += u32::from(off != [0.0; 2]);
    batch.1 += 1;
}

/// A triangle whose corners have 1/w and places on the texture.
struct Subject {
    places: [Place; 3],
    /// 1/w, 1 at the near plane.
    q: [f64; 3],
    /// Texels in units of 1/256.
    texels: [[i32; 2]; 3],
}

/// Lines of the picture.
const LINES: u16 = 64;

impl Subject {
    /// As wide as said at its top, where 1/w changes by the ratio. Its nearest corner has any 1/w of an octave.
    fn random(rng: &mut Rng, pixels: i32, ratio: f64, texels: f64) -> Self {
        let x = rng.within(0, 8 * (1_008 - pixels));
        let foot = rng.within(0, 8 * pixels);
        let places = [
            (x, 0),
            (x + 8 * pixels, 0),
            (x + foot, 8 * i32::from(LINES)),
        ];
        let near = 0.5 + 0.499 * rng.unit();
        let mut q = [
            near,
            near / ratio,
            near / (1.0 + (ratio - 1.0) * rng.unit()),
        ];
        if rng.unit() < 0.5 {
            q.swap(0, 1);
        }
        // As corners have it.
        let q = q.map(|q| (q * 2f64.powi(31)).round() / 2f64.powi(31));
        let place = |rng: &mut Rng| (256.0 * texels * rng.unit()) as i32;
        let texels = [(); 3].map(|()| [place(rng), place(rng)]);
        Self { places, q, texels }
    }

    fn corners(&self) -> [ScreenCorner; 3] {
        [0, 1, 2].map(|i| ScreenCorner {
            vertex: ScreenVertex {
                x: self.places[i].0 as i16,
                y: self.places[i].1 as i16,
                depth: (self.q[i] * 2f64.powi(31)) as u32,
                colour: [255; 3],
            },
            texel: self.texels[i],
        })
    }

    /// 1/w, u/w and v/w at a pixel, in texels.
    fn at(&self, column: i32, line: i32) -> [f64; 3] {
        let over = |axis: usize| {
            let of = |i: usize| f64::from(self.texels[i][axis]) / 256.0 * self.q[i];
            plane(self.places, [of(0), of(1), of(2)], column, line)
        };
        [plane(self.places, self.q, column, line), over(0), over(1)]
    }

    /// Texels of the covered columns of a line by a way of dividing.
    fn divided(&self, stride: Stride, columns: &[i32], line: i32) -> Vec<u16> {
        let (first, last) = (columns[0], columns[columns.len() - 1]);
        let [first, last] = [first, last].map(|column| self.at(column, line));
        let steps = (columns.len() - 1).max(1) as f64;
        // 1/w with 31 fraction bits, places over w with 21.
        let fixed = |values: [f64; 3]| {
            let of = |i: usize, bits: i32| (values[i] * 2f64.powi(bits)).round() as i32;
            Homogeneous {
                q: of(0, 31),
                s: of(1, 21),
                t: of(2, 21),
            }
        };
        let span = PerspectiveSpan {
            at: fixed(first),
            step: fixed([0, 1, 2].map(|i| (last[i] - first[i]) / steps)),
        };
        let mut texels = vec![0; columns.len()];
        span.walk(stride, &mut texels, |texel, Uv { u, v }| {
            let of = |place: i32| (place >> FRACTION) as u32 % SIDE;
            *texel = (of(v) * SIDE + of(u)) as u16;
        });
        texels
    }
}

/// Lines of random triangles by a way.
fn spans<'t>(
    way: Way,
    map: &'t Texture<'t>,
    seed: u64,
    random: impl Fn(&mut Rng) -> Subject,
) -> Done<Found> {
    const BATCHES: usize = 20;
    const TRIANGLES: usize = 60;
    let mut rng = Rng::new(seed);
    let mut errors = Errors::default();
    let mut batches = vec![(0, 0); BATCHES];
    let mut stage = Stage::<Textured<Rgb565>>::new((1_008, LINES), ahead(100.0, 1.0, 100.0)?)?;
    let mut pixels = [0; 1_008];
    for batch in &mut batches {
        for _ in 0..TRIANGLES {
            let subject = random(&mut rng);
            let lines = [(); 2].map(|()| rng.within(0, i32::from(LINES) - 1));
            let mut line_of = |line: i32, shown: &dyn Fn(&[i32]) -> Vec<u16>| {
                let columns: Vec<i32> = (0..1_008)
                    .filter(|&column| covers(subject.places, column, line))
                    .collect();
                if columns.is_empty() {
                    return;
                }
                for (column, texel) in columns.iter().zip(shown(&columns)) {
                    let [q, s, t] = subject.at(*column, line);
                    compare((&mut errors, batch), texel, [s / q, t / q]);
                }
            };
            match way {
                Way::Fixed(stride) => {
                    for line in lines {
                        line_of(line, &|columns| subject.divided(stride, columns, line));
                    }
                }
                Way::Within(budget) => stage.show(
                    |scene| {
                        let texture = Some(Skin {
                            texture: map,
                            places: &[],
                            budget,
                        });
                        let draw = Draw { texture, ..call() };
                        Ok(scene.draw_screen(&draw, &[subject.corners()])?)
                    },
                    |scene, renderer| {
                        for line in lines {
                            renderer.draw_line(scene, line as u16, &mut pixels, NOTHING)?;
                            let at = |column: &i32| pixels[*column as usize];
                            line_of(line, &|columns| columns.iter().map(at).collect());
                        }
                        Ok(())
                    },
                )?,
            }
        }
    }
    Ok((errors, batches))
}

/// Whole scenes by the renderer, each a batch. Its corners are rounded to 1/64 pixel, which is up to 1/8 texel on the
/// ground near its horizon.
///
/// The near plane cuts none: what it makes of corners is the edges' error, which has its own bound.
fn scenes<'t>(budget: Budget, map: &'t Texture<'t>) -> Done<Found> {
    let mut errors = Errors::default();
    let mut batches = Vec::new();
    let blank = TextureMap::made(SIDE, SIDE, |_, _| [255.0; 3]);
    for (model, view) in pictures() {
        let of_triangle = vec![Some(0); model.triangles.len()];
        let textures = Textures {
            maps: std::slice::from_ref(&blank),
            of_triangle: &of_triangle,
        };
        let reference = render_textured(&model, textures, &view, Options::default())?;
        let mut batch = (0, 0);
        for (i, &texel) in shown(&model, &view, budget, map)?.iter().enumerate() {
            if reference.object[i] == NO_OBJECT || reference.near_edge[i] {
                continue;
            }
            if texel == NOTHING {
                return Err("a pixel shows no texel".into());
            }
            compare((&mut errors, &mut batch), texel, reference.place[i]);
        }
        batches.push(batch);
    }
    Ok((errors, batches))
}

/// World units of a whole coordinate of a mesh.
const SCALE: f64 = 128.0;

/// The texels that the renderer shows of a model.
fn shown<'t>(model: &Model, view: &View, budget: Budget, map: &'t Texture<'t>) -> Done<Vec<u16>> {
    let q30 = |c: f64| (c / SCALE * f64::from(1 << 30)).round() as i32;
    let positions: Vec<_> = model.vertices.iter().map(|v| v.position.map(q30)).collect();
    let units = |c: f64| (c * f64::from(256 * SIDE)).round() as i32;
    let place = |v: &ModelVertex| [units(v.uv[0]), units(1.0 - v.uv[1])];
    let places: Vec<_> = model.vertices.iter().map(place).collect();
    let faces: Vec<_> = model
        .triangles
        .iter()
        .map(|f| f.map(|i| i as u16))
        .collect();
    let mesh = Mesh {
        positions: &positions,
        normals: &[],
        colours: &[],
        faces: Faces::Triangles(&faces),
    };
    let room = Room {
        vertices: 8_000,
        places: 8_000,
        objects: 8_000,
        draws: 1,
    };
    let screen = Screen::new(view.width as u16, view.height as u16)?;
    picture::<_, Textured<Rgb565>>(screen, room, NOTHING, |scene| {
        let focal = f64::from(view.height) / 2.0 / (view.fov.to_radians() / 2.0).tan();
        let [eye, at, up] = [view.eye, view.at, view.up].map(|p| p.map(|c| c as f32));
        let (near, far) = (view.near as f32, view.far as f32);
        scene.begin(&Camera::look_at(eye, at, up, focal as f32, near, far)?)?;
        Ok(scene.draw(&Draw {
            model: Affine::placed(SCALE as f32, [0.0; 3]).ok_or("the scale is finite")?,
            cull: Cull::None,
            texture: Some(Skin {
                texture: map,
                places: &places,
                budget,
            }),
            ..Draw::new(mesh)
        })?)
    })
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
