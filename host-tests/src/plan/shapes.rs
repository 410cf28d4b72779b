//! Shapes as OBJ models, with normals and places on a texture.

use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;

/// A shape of one sheet or of six sides, and of how many pieces along it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Shape {
    /// A ball of so many rings and of so many pieces around.
    Ball(u32, u32),
    /// A ring of so many pieces around, and around its pipe.
    Ring(u32, u32),
    /// Hills.
    Land(u32),
    /// A square that stands.
    Pane(u32),
    /// A square that lies.
    Floor(u32),
    /// A cube.
    Cube(u32),
    /// A cube seen from inside.
    Room(u32),
}

/// A place and its normal.
type Point = [[f64; 3]; 2];

impl Shape {
    /// What it is called.
    #[must_use]
    pub fn name(self) -> String {
        match self {
            Self::Ball(rings, around) => format!("ball-{rings}-{around}"),
            Self::Ring(around, pipe) => format!("ring-{around}-{pipe}"),
            Self::Land(n) => format!("land-{n}"),
            Self::Pane(n) => format!("pane-{n}"),
            Self::Floor(n) => format!("floor-{n}"),
            Self::Cube(n) => format!("cube-{n}"),
            Self::Room(n) => format!("room-{n}"),
        }
    }

    /// Its file.
    #[must_use]
    pub fn file(self) -> String {
        self.name() + ".obj"
    }

    /// Whether it stays level.
    #[must_use]
    pub fn is_lying(self) -> bool {
        matches!(self, Self::Land(_) | Self::Floor(_) | Self::Room(_))
    }

    /// As an OBJ model.
    #[must_use]
    pub fn to_obj(self) -> String {
        let mut obj = Obj::default();
        match self {
            Self::Ball(rings, around) => obj.sheet([rings, around], &ball),
            Self::Ring(around, pipe) => obj.sheet([around, pipe], &ring),
            Self::Land(n) => obj.sheet([n, n], &land),
            Self::Pane(n) => obj.sheet([n, n], &|u, v| {
                [[2.0 * v - 1.0, 1.0 - 2.0 * u, 0.0], [0.0, 0.0, 1.0]]
            }),
            Self::Floor(n) => obj.sheet([n, n], &|u, v| {
                [[2.0 * v - 1.0, 0.0, 2.0 * u - 1.0], [0.0, 1.0, 0.0]]
            }),
            Self::Cube(n) => obj.sides(n, 1.0),
            Self::Room(n) => obj.sides(n, -1.0),
        }
        obj.vertices + &obj.faces
    }
}

fn ball(u: f64, v: f64) -> Point {
    let (polar, around) = (PI * u, TAU * v);
    let place = [
        polar.sin() * around.cos(),
        polar.cos(),
        -polar.sin() * around.sin(),
    ];
    [place, place]
}

fn ring(u: f64, v: f64) -> Point {
    const PIPE: f64 = 0.4;
    let (around, pipe) = (TAU * u, -TAU * v);
    let normal = [
        around.cos() * pipe.cos(),
        pipe.sin(),
        around.sin() * pipe.cos(),
    ];
    let place = [
        around.cos() + PIPE * normal[0],
        PIPE * normal[1],
        around.sin() + PIPE * normal[2],
    ];
    [place, normal]
}

fn land(u: f64, v: f64) -> Point {
    let (x, z) = (2.0 * v - 1.0, 2.0 * u - 1.0);
    let height = 0.25 * (5.0 * x).sin() * (4.0 * z).cos();
    let down_x = -1.25 * (5.0 * x).cos() * (4.0 * z).cos();
    let down_z = (5.0 * x).sin() * (4.0 * z).sin();
    let length = (down_x * down_x + 1.0 + down_z * down_z).sqrt();
    [[x, height, z], [down_x, 1.0, down_z].map(|c| c / length)]
}

/// Lines of a model.
#[derive(Default)]
struct Obj {
    vertices: String,
    count: u32,
    faces: String,
}

impl Obj {
    /// A sheet of so many pieces down and across.
    fn sheet(&mut self, [down, across]: [u32; 2], of: &dyn Fn(f64, f64) -> Point) {
        let first = self.count + 1;
        for row in 0..=down {
            for column in 0..=across {
                let at = |k: u32, of: u32| f64::from(k) / f64::from(of);
                let (u, v) = (at(row, down), at(column, across));
                let [[x, y, z], [nx, ny, nz]] = of(u, v);
                // Writing to a string cannot fail.
                let _ = writeln!(self.vertices, "v {x:.5} {y:.5} {z:.5}");
                let _ = writeln!(self.vertices, "vt {v:.5} {:.5}", 1.0 - u);
                let _ = writeln!(self.vertices, "vn {nx:.5} {ny:.5} {nz:.5}");
                self.count += 1;
            }
        }
        for row in 0..down {
            for column in 0..across {
                let a = first + row * (across + 1) + column;
                let c = a + across + 1;
                for face in [[a, c, c + 1], [a, c + 1, a + 1]] {
                    let [i, j, k] = face.map(|at| format!("{at}/{at}/{at}"));
                    let _ = writeln!(self.faces, "f {i} {j} {k}");
                }
            }
        }
    }

    /// Six sides, seen from outside, or with -1 from inside.
    fn sides(&mut self, n: u32, out: f64) {
        for axis in 0..3 {
            for side in [-1.0, 1.0] {
                self.sheet([n, n], &|u, v| {
                    let (mut place, mut normal) = ([0.0; 3], [0.0; 3]);
                    place[axis] = side;
                    place[(axis + 1) % 3] = (2.0 * v - 1.0) * side * out;
                    place[(axis + 2) % 3] = 1.0 - 2.0 * u;
                    normal[axis] = side * out;
                    [place, normal]
                });
            }
        }
    }
}
