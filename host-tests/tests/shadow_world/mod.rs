//! Worlds of random closed meshes in the shadows of lights, and what rays cast in f64 say of them (K9).

use crate::common::Rng;
use crate::common::solid::{V, along, cross, dot, octahedron, sub, unit};
use scanbeam::scene::ShadowLight;
use scanbeam::{Affine, Camera, Faces, Light, Mesh, Screen};

const WIDTH: usize = 72;
const HEIGHT: usize = 54;
const FOCAL: f64 = 60.0;
/// Samples of a pixel's side.
const FINE: usize = 2;

/// A mesh that stands in the world.
pub struct Body {
    positions: Vec<[i16; 3]>,
    faces: Vec<[u16; 3]>,
    scale: f64,
    offset: V,
}

impl Body {
    pub fn mesh<'a>(&'a self, colours: &'a [[u8; 3]]) -> Mesh<'a> {
        Mesh {
            positions: &self.positions,
            normals: &[],
            colours: &colours[..self.positions.len()],
            faces: Faces::Triangles(&self.faces),
        }
    }

    pub fn model(&self) -> Affine {
        Affine::placed(self.scale as f32, self.offset.map(|c| c as f32)).unwrap()
    }

    fn triangles(&self) -> impl Iterator<Item = [V; 3]> + '_ {
        self.faces.iter().map(|face| {
            face.map(|i| {
                let p = self.positions[usize::from(i)];
                [0, 1, 2].map(|k| f64::from(p[k]) / 16_384.0 * self.scale + self.offset[k])
            })
        })
    }
}

pub const WHITE: [[u8; 3]; 128] = [[255; 3]; 128];

/// A ball of 6 to 66 corners whose radii are random: closed, and anything but convex.
fn ball(rng: &mut Rng, scale: f64, offset: V) -> Body {
    let (points, faces) = octahedron(rng.below(3));
    let rough = rng.pick(&[0.0, 0.3, 0.6]);
    let positions = points
        .iter()
        .map(|p| {
            let radius = 16_000.0 * (1.0 - rough * f64::from(rng.below(1000)) / 1000.0);
            p.map(|c| (c * radius) as i16)
        })
        .collect();
    Body {
        positions,
        faces,
        scale,
        offset,
    }
}

fn floor() -> Body {
    let c = 16_000;
    Body {
        positions: vec![[-c, 0, -c], [c, 0, -c], [c, 0, c], [-c, 0, c]],
        faces: vec![[0, 2, 1], [0, 3, 2]],
        scale: 3.0,
        offset: [0.0, -0.9, -3.0],
    }
}

/// Where a ray first meets a triangle, beyond `from`.
fn first(triangles: &[[V; 3]], eye: V, way: V, from: f64) -> Option<(f64, usize)> {
    let mut best: Option<(f64, usize)> = None;
    for (i, [a, b, c]) in triangles.iter().enumerate() {
        let (ab, ac) = (sub(*b, *a), sub(*c, *a));
        let p = cross(way, ac);
        let det = dot(ab, p);
        if det == 0.0 {
            continue;
        }
        let to = sub(eye, *a);
        let u = dot(to, p) / det;
        let q = cross(to, ab);
        let v = dot(way, q) / det;
        let t = dot(ac, q) / det;
        let inside = u >= 0.0 && v >= 0.0 && u + v <= 1.0;
        if inside && t > from && best.is_none_or(|b| t < b.0) {
            best = Some((t, i));
        }
    }
    best
}

/// Which lights reach what is seen at a sample, a bit for each; `None` for the background.
type Sample = Option<u32>;

/// What rays say at a place of the picture, in pixels; a second answer from a little above the
/// surface, for those that lie almost along the light.
fn cast(
    all: &[[V; 3]],
    casters: &[[V; 3]],
    lights: &[V],
    near: f64,
    (x, y): (f64, f64),
) -> [Sample; 2] {
    let way = [
        (x - WIDTH as f64 / 2.0) / FOCAL,
        (HEIGHT as f64 / 2.0 - y) / FOCAL,
        -1.0,
    ];
    let Some((t, face)) = first(all, [0.0; 3], way, near) else {
        return [None; 2];
    };
    let at = along([0.0; 3], way, t);
    let [a, b, c] = all[face];
    let mut normal = unit(cross(sub(b, a), sub(c, a)));
    if dot(normal, way) > 0.0 {
        normal = normal.map(|c| -c);
    }
    [1e-7, 1.5 * t / FOCAL].map(|up| {
        let from = along(at, normal, up);
        let lit = |l: &V| first(casters, from, *l, 0.0).is_none();
        Some(
            lights
                .iter()
                .enumerate()
                .map(|(i, l)| u32::from(lit(l)) << i)
                .sum(),
        )
    })
}

/// Bodies that throw shadows, and a floor.
pub struct World {
    pub bodies: Vec<Body>,
    pub floor: Body,
    pub lights: Vec<ShadowLight>,
}

pub fn camera() -> Camera {
    Camera::look_at(
        [0.0; 3],
        [0.0, 0.0, -1.0],
        [0.0, 1.0, 0.0],
        FOCAL as f32,
        0.25,
        30.0,
    )
    .unwrap()
}

/// Where the light comes from.
#[derive(Clone, Copy, PartialEq)]
pub enum From {
    /// From above.
    Above,
    /// From behind the eye, with a body between it and the eye.
    Behind,
    /// From the side, along the near plane, with a body beside the eye.
    Beside,
}

pub fn world(rng: &mut Rng, lights: u8, from: From) -> World {
    let lights: Vec<ShadowLight> = (0..lights)
        .map(|light| {
            let towards = match from {
                From::Above => [0.7 * rng.signed(), 0.8, 0.7 * rng.signed()],
                From::Behind => [rng.signed() * 0.2, 0.3 + rng.signed() * 0.2, 1.0],
                From::Beside => [1.0, 0.3 * rng.signed(), 0.004 * rng.signed()],
            };
            ShadowLight {
                light: light * 3,
                direction: Light::new(towards.map(|c| c as f32), 0.0)
                    .unwrap()
                    .direction,
                reach: 5,
            }
        })
        .collect();
    let mut bodies: Vec<Body> = (0..1 + rng.below(3))
        .map(|_| {
            let scale = 0.3 + 0.4 * (rng.signed() + 1.0) / 2.0;
            let offset = [rng.signed() * 1.2, rng.signed() * 0.7, -3.0 + rng.signed()];
            ball(rng, scale, offset)
        })
        .collect();
    if from != From::Above {
        let l = towards(&lights[0]);
        let off = [rng.signed() * 0.4, rng.signed() * 0.4, rng.signed() * 0.4];
        bodies.push(ball(rng, 0.9, along(l.map(|c| c * 1.6), off, 1.0)));
    }
    World {
        bodies,
        floor: floor(),
        lights,
    }
}

fn towards(light: &ShadowLight) -> V {
    light.direction.map(|c| f64::from(c.to_bits()) / 16_384.0)
}

pub const DARK: [[u8; 3]; 128] = [[30, 20, 10]; 128];
/// What each light adds.
pub const ADDS: [[[u8; 3]; 128]; 2] = [[[100, 0, 7]; 128], [[0, 150, 70]; 128]];
pub const LIT: [[u8; 3]; 128] = [[130, 20, 17]; 128];

pub fn screen() -> Screen {
    Screen::new(WIDTH as u16, HEIGHT as u16).unwrap()
}

/// Compares a picture of a world with rays: pixels that were compared, and how many of them are in shadow.
fn compare(world: &World, drawn: &[Vec<[u8; 3]>]) -> (u32, u32) {
    let casters: Vec<_> = world.bodies.iter().flat_map(Body::triangles).collect();
    let mut all = casters.clone();
    all.extend(world.floor.triangles());
    let lights: Vec<V> = world.lights.iter().map(towards).collect();
    let columns = FINE * WIDTH + 1;
    let samples: Vec<[Sample; 2]> = (0..(FINE * HEIGHT + 1) * columns)
        .map(|i| {
            let at = |n: usize| n as f64 / FINE as f64;
            let place = (at(i % columns), at(i / columns));
            cast(&all, &casters, &lights, 0.25, place)
        })
        .collect();
    let (mut compared, mut shadows) = (0, 0);
    let full = (1u32 << lights.len()) - 1;
    for (y, words) in drawn.iter().enumerate().take(HEIGHT - 1).skip(1) {
        for (x, word) in words.iter().enumerate().take(WIDTH - 1).skip(1) {
            let (left, top) = (FINE * x - 1, FINE * y - 1);
            let here = samples[(top + 2) * columns + left + 2][0];
            let same = (0..2 * FINE + 1).all(|dy| {
                (0..2 * FINE + 1).all(|dx| samples[(top + dy) * columns + left + dx] == [here; 2])
            });
            if !same {
                continue;
            }
            let want = match here {
                None => [0; 3],
                Some(lit) if lights.len() == 1 => {
                    if lit == 1 {
                        LIT[0]
                    } else {
                        DARK[0]
                    }
                }
                Some(lit) => {
                    let part = |i: usize, k: usize| (lit >> i & 1) as u8 * ADDS[i][0][k];
                    [0, 1, 2].map(|k| DARK[0][k] + part(0, k) + part(1, k))
                }
            };
            assert_eq!(*word, want, "({x}, {y})");
            compared += 1;
            shadows += u32::from(here.is_some_and(|lit| lit != full));
        }
    }
    (compared, shadows)
}

/// Compares one world of those that [`many`] makes of a seed, by its number.
pub fn one(seed: u64, number: usize, lights: u8, draw: fn(&World) -> Vec<Vec<[u8; 3]>>) {
    let mut rng = Rng::new(seed);
    for _ in 0..number {
        world(&mut rng, lights, From::Above);
    }
    let world = world(&mut rng, lights, From::Above);
    let (compared, shadows) = compare(&world, &draw(&world));
    assert!(compared > 1000 && shadows > 0, "{compared} {shadows}");
}

/// Compares random worlds that `draw` has drawn.
pub fn many(seed: u64, lights: u8, from: From, draw: fn(&World) -> Vec<Vec<[u8; 3]>>) {
    let mut rng = Rng::new(seed);
    let (mut compared, mut shadows) = (0, 0);
    let rounds = 40;
    for _ in 0..rounds {
        let world = world(&mut rng, lights, from);
        let (c, s) = compare(&world, &draw(&world));
        compared += c;
        shadows += s;
    }
    let share = f64::from(compared) / f64::from(rounds * (WIDTH * HEIGHT) as u32);
    println!("{compared} pixels compared, {share:.2} of all, {shadows} in shadow, none wrong");
    assert!(share > 0.5 && shadows > 2000, "{share} {shadows}");
}
