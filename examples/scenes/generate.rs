//! Generators for the test meshes, run by the build script and checked by the tests.
//!
//! Every host makes the same bytes: the teapot's points are exact integers up to the last
//! rounding, and the rest is `+ - * /` and `sqrt` in `f64`, which IEEE 754 defines to the bit. No
//! `sin` or `cos` of the host's libm is called.

#[path = "teapot_data.rs"]
mod teapot_data;

use std::fmt::Display;

pub(crate) use teapot_data::{PATCHES, POINTS};

/// 1.0 in Q1.14.
pub(crate) const ONE: i16 = 1 << 14;

/// Subdivisions of a patch of the teapot, in each direction.
pub(crate) const TEAPOT_STEPS: usize = 6;
/// Rings of the sphere from pole to pole.
pub(crate) const SPHERE_STACKS: usize = 32;
/// Steps of the sphere around its axis.
pub(crate) const SPHERE_SLICES: usize = 32;
/// Rings of the fine sphere, and steps around its axis.
pub(crate) const FINE_STEPS: usize = 64;
/// Quads of the ribbon.
pub(crate) const RIBBON_STEPS: usize = 32;

/// A mesh of triangles under construction.
#[derive(Clone, Debug, Default)]
pub(crate) struct Triangles {
    /// Positions in Q1.14.
    pub(crate) positions: Vec<[i16; 3]>,
    /// Unit normals in Q1.14.
    pub(crate) normals: Vec<[i16; 3]>,
    /// Corners, counter-clockwise seen from outside.
    pub(crate) faces: Vec<[u16; 3]>,
}

/// Writes every mesh as Rust constants, to be included by the library.
pub(crate) fn source() -> String {
    let mut out = String::new();

    let teapot = teapot(TEAPOT_STEPS);
    table(
        &mut out,
        "TEAPOT_POSITIONS",
        "[i16; 3]",
        &teapot.positions,
        triple,
    );
    table(
        &mut out,
        "TEAPOT_NORMALS",
        "[i16; 3]",
        &teapot.normals,
        triple,
    );
    table(&mut out, "TEAPOT_FACES", "[u16; 3]", &teapot.faces, triple);

    // The normals of a unit sphere are its positions: one table serves both.
    let sphere = sphere(SPHERE_STACKS, SPHERE_SLICES);
    table(
        &mut out,
        "SPHERE_POSITIONS",
        "[i16; 3]",
        &sphere.positions,
        triple,
    );
    table(&mut out, "SPHERE_FACES", "[u16; 3]", &sphere.faces, triple);
    let fine = self::sphere(FINE_STEPS, FINE_STEPS);
    table(
        &mut out,
        "FINE_POSITIONS",
        "[i16; 3]",
        &fine.positions,
        triple,
    );
    table(&mut out, "FINE_FACES", "[u16; 3]", &fine.faces, triple);

    let cube = cube();
    table(
        &mut out,
        "CUBE_POSITIONS",
        "[i16; 3]",
        &cube.positions,
        triple,
    );
    table(&mut out, "CUBE_NORMALS", "[i16; 3]", &cube.normals, triple);
    table(&mut out, "CUBE_COLOURS", "[u8; 3]", &cube.colours, triple);
    table(&mut out, "CUBE_QUAD_FACES", "[u16; 4]", &cube.quads, |q| {
        format!("[{}, {}, {}, {}]", q[0], q[1], q[2], q[3])
    });
    let halves: Vec<[u16; 3]> = cube
        .quads
        .iter()
        .flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]])
        .collect();
    table(&mut out, "CUBE_FACES", "[u16; 3]", &halves, triple);

    let ribbon = ribbon(RIBBON_STEPS);
    table(
        &mut out,
        "RIBBON_POSITIONS",
        "[i16; 3]",
        &ribbon.positions,
        triple,
    );
    table(
        &mut out,
        "RIBBON_NORMALS",
        "[i16; 3]",
        &ribbon.normals,
        triple,
    );
    table(
        &mut out,
        "RIBBON_COLOURS",
        "[u8; 3]",
        &ribbon.colours,
        triple,
    );
    table(&mut out, "RIBBON_STRIP", "u16", &ribbon.strip, |i| {
        i.to_string()
    });
    out
}

fn triple<T: Display>(v: &[T; 3]) -> String {
    format!("[{}, {}, {}]", v[0], v[1], v[2])
}

fn table<T>(out: &mut String, name: &str, item: &str, rows: &[T], text: impl Fn(&T) -> String) {
    *out += &format!("static {name}: [{item}; {}] = [\n", rows.len());
    for row in rows {
        *out += &format!("    {},\n", text(row));
    }
    *out += "];\n";
}

// --- The Utah teapot ---

/// Units of [`POINTS`] to 1: every coordinate is a whole number of these.
const UNITS: f64 = 100_000.0;

/// Normals of one place that differ by no more than this, in Q1.14 and any axis, are one normal.
const SAME_NORMAL: i32 = 2;

/// A point of a patch, in integers: a position, and a normal of any length.
struct PatchPoint {
    position: [i128; 3],
    normal: [i128; 3],
}

/// Tessellates the Utah teapot, with `steps` by `steps` quads a patch.
///
/// y up, the spout towards +x, the handle towards -x, the bounding box centred on the origin and
/// its longest side, x, from -1.0 to 1.0. Triangles without an area at the two poles are left
/// out. Points of the same place and normal are one vertex.
pub(crate) fn teapot(steps: usize) -> Triangles {
    let mut low = [i128::MAX; 3];
    let mut high = [i128::MIN; 3];
    let patches: Vec<Vec<PatchPoint>> = PATCHES
        .iter()
        .map(|patch| {
            let mut points = Vec::with_capacity((steps + 1) * (steps + 1));
            for i in 0..=steps {
                for j in 0..=steps {
                    let point = patch_point(patch, i, j, steps);
                    for axis in 0..3 {
                        low[axis] = low[axis].min(point.position[axis]);
                        high[axis] = high[axis].max(point.position[axis]);
                    }
                    points.push(point);
                }
            }
            points
        })
        .collect();
    let extent = (0..3)
        .map(|axis| high[axis] - low[axis])
        .max()
        .expect("three axes");

    let mut mesh = Triangles::default();
    for points in &patches {
        let corners: Vec<u16> = points
            .iter()
            .map(|point| {
                // z up becomes y up by a quarter turn about x.
                let [x, y, z] = [0, 1, 2].map(|axis| {
                    let twice = 2 * point.position[axis] - low[axis] - high[axis];
                    rounded_ratio(twice * i128::from(ONE), extent)
                });
                let n = point.normal.map(|c| c as f64);
                vertex(&mut mesh, [x, z, -y], unit([n[0], n[2], -n[1]]))
            })
            .collect();
        for i in 0..steps {
            for j in 0..steps {
                let a = corners[i * (steps + 1) + j];
                let b = corners[i * (steps + 1) + j + 1];
                let c = corners[(i + 1) * (steps + 1) + j + 1];
                let d = corners[(i + 1) * (steps + 1) + j];
                for face in [[a, b, c], [a, c, d]] {
                    let [p, q, r] = face.map(|corner| mesh.positions[usize::from(corner)]);
                    if p != q && q != r && r != p {
                        mesh.faces.push(face);
                    }
                }
            }
        }
    }
    without_unused(mesh)
}

/// The point `i` of `steps` from row to row, and `j` of `steps` along the rows.
///
/// The position is in units of `1 / (UNITS * steps^6)`, so that neighbouring patches agree on
/// their common edge exactly.
fn patch_point(patch: &[usize; 16], i: usize, j: usize, steps: usize) -> PatchPoint {
    let (wu, wv) = (weights(i, steps), weights(j, steps));
    let (du, dv) = (slope_weights(i, steps), slope_weights(j, steps));
    let position = blend(patch, wu, wv);
    let along_u = blend(patch, du, wv);
    let along_v = blend(patch, wu, dv);
    let mut normal = cross(along_v, along_u);
    if normal == [0; 3] {
        // A pole: the first row is one point. Near it the slope along the row grows as u times
        // the mixed derivative, which hence gives the limit of the normal.
        assert_eq!((i, along_v), (0, [0; 3]), "only first rows collapse");
        normal = cross(blend(patch, du, dv), along_u);
    }
    assert_ne!(normal, [0; 3], "every point has a normal");
    PatchPoint { position, normal }
}

/// Bernstein's weights at `k / n`, times `n^3`.
fn weights(k: usize, n: usize) -> [i128; 4] {
    let b = k as i128;
    let a = n as i128 - b;
    [a * a * a, 3 * a * a * b, 3 * a * b * b, b * b * b]
}

/// The slope of [`weights`], up to a positive factor.
fn slope_weights(k: usize, n: usize) -> [i128; 4] {
    let b = k as i128;
    let a = n as i128 - b;
    [-a * a, a * a - 2 * a * b, 2 * a * b - b * b, b * b]
}

fn blend(patch: &[usize; 16], u: [i128; 4], v: [i128; 4]) -> [i128; 3] {
    let mut sum = [0; 3];
    for (slot, &number) in patch.iter().enumerate() {
        let weight = u[slot / 4] * v[slot % 4];
        for (total, &coordinate) in sum.iter_mut().zip(&POINTS[number - 1]) {
            *total += weight * (coordinate * UNITS).round() as i128;
        }
    }
    sum
}

/// `a / b` to the nearest integer, halves away from zero, so that mirrored points stay mirrored.
fn rounded_ratio(a: i128, b: i128) -> i16 {
    let magnitude = (2 * a.abs() + b) / (2 * b);
    i16::try_from(a.signum() * magnitude).expect("scaled into Q1.14")
}

/// The vertex of that place and normal, added where there is none.
fn vertex(mesh: &mut Triangles, position: [i16; 3], normal: [i16; 3]) -> u16 {
    let near = |other: [i16; 3]| {
        (0..3).all(|axis| (i32::from(normal[axis]) - i32::from(other[axis])).abs() <= SAME_NORMAL)
    };
    let known =
        (0..mesh.positions.len()).find(|&v| mesh.positions[v] == position && near(mesh.normals[v]));
    let index = known.unwrap_or_else(|| {
        mesh.positions.push(position);
        mesh.normals.push(normal);
        mesh.positions.len() - 1
    });
    u16::try_from(index).expect("few enough vertices for u16 indices")
}

/// Drops the vertices that no face uses.
fn without_unused(mesh: Triangles) -> Triangles {
    let mut kept = Triangles::default();
    let mut renamed: Vec<Option<u16>> = vec![None; mesh.positions.len()];
    for face in &mesh.faces {
        kept.faces.push(face.map(|corner| {
            let old = usize::from(corner);
            *renamed[old].get_or_insert_with(|| {
                kept.positions.push(mesh.positions[old]);
                kept.normals.push(mesh.normals[old]);
                // No more than before, which did fit.
                (kept.positions.len() - 1) as u16
            })
        }));
    }
    kept
}

// --- The sphere ---

/// A sphere of radius 1 about the y axis, by latitude and longitude.
///
/// `stacks + 1` rows of `slices + 1` vertices; the last vertex of a row is where the first is.
/// All `2 * stacks * slices` triangles are there, those without an area at the poles too. The
/// normals are the positions.
pub(crate) fn sphere(stacks: usize, slices: usize) -> Triangles {
    let mut mesh = Triangles::default();
    for i in 0..=stacks {
        // From the north pole down: half a turn.
        let (sin_down, cos_down) = sin_cos_turn(i, 2 * stacks);
        for j in 0..=slices {
            let (sin_round, cos_round) = sin_cos_turn(j, slices);
            let place = [sin_down * cos_round, cos_down, -sin_down * sin_round];
            mesh.positions.push(place.map(q14));
        }
    }
    for i in 0..stacks {
        for j in 0..slices {
            // `a b` above `d c`, from west to east.
            let a = i * (slices + 1) + j;
            let d = a + slices + 1;
            let [a, b, c, d] =
                [a, a + 1, d + 1, d].map(|v| u16::try_from(v).expect("indices fit u16"));
            mesh.faces.push([a, d, c]);
            mesh.faces.push([a, c, b]);
        }
    }
    mesh.normals.clone_from(&mesh.positions);
    mesh
}

// --- The cube ---

/// A cube under construction.
pub(crate) struct Cube {
    /// Positions in Q1.14, four a face.
    pub(crate) positions: Vec<[i16; 3]>,
    /// The face's normal at each of its corners.
    pub(crate) normals: Vec<[i16; 3]>,
    /// The face's colour at each of its corners.
    pub(crate) colours: Vec<[u8; 3]>,
    /// One quad a face, counter-clockwise seen from outside.
    pub(crate) quads: Vec<[u16; 4]>,
}

/// A cube from -1.0 to 1.0, each face in a colour of its own.
pub(crate) fn cube() -> Cube {
    /// Colours of the faces +x, -x, +y, -y, +z, -z.
    const COLOURS: [[u8; 3]; 6] = [
        [230, 40, 40],
        [40, 200, 210],
        [60, 190, 60],
        [200, 60, 190],
        [50, 90, 230],
        [235, 200, 40],
    ];
    let mut cube = Cube {
        positions: vec![],
        normals: vec![],
        colours: vec![],
        quads: vec![],
    };
    for (face, &colour) in COLOURS.iter().enumerate() {
        let axis = face / 2;
        let side = if face % 2 == 0 { ONE } else { -ONE };
        // `right x up` points along the positive axis; a mirrored `right` turns it over.
        let (right, up) = ((axis + 1) % 3, (axis + 2) % 3);
        let first = cube.positions.len() as u16;
        for (across, along) in [(-ONE, -ONE), (ONE, -ONE), (ONE, ONE), (-ONE, ONE)] {
            let mut position = [0; 3];
            position[axis] = side;
            position[right] = if side > 0 { across } else { -across };
            position[up] = along;
            let mut normal = [0; 3];
            normal[axis] = side;
            cube.positions.push(position);
            cube.normals.push(normal);
            cube.colours.push(colour);
        }
        cube.quads.push([first, first + 1, first + 2, first + 3]);
    }
    cube
}

// --- The ribbon ---

/// A ribbon under construction.
pub(crate) struct Ribbon {
    /// Positions in Q1.14.
    pub(crate) positions: Vec<[i16; 3]>,
    /// Unit normals of the front in Q1.14.
    pub(crate) normals: Vec<[i16; 3]>,
    /// Colours.
    pub(crate) colours: Vec<[u8; 3]>,
    /// The strip: two vertices, then two for each quad.
    pub(crate) strip: Vec<u16>,
}

/// A band along x from -1.0 to 1.0, 0.5 wide, turned once about its axis on the way.
///
/// It lies across y at both ends and shows its front towards +z there. One edge fades from red to
/// blue, the other from yellow to green.
pub(crate) fn ribbon(steps: usize) -> Ribbon {
    const HALF_WIDTH: f64 = 0.25;
    /// Radians for a step of 1 along x: one turn on a length of 2.
    const TWIST: f64 = std::f64::consts::PI;
    let fade = |from: u8, to: u8, step: usize| {
        let (from, to) = (usize::from(from), usize::from(to));
        ((from * (steps - step) + to * step + steps / 2) / steps) as u8
    };
    let mut ribbon = Ribbon {
        positions: vec![],
        normals: vec![],
        colours: vec![],
        strip: vec![],
    };
    for step in 0..=steps {
        let x = (2.0 * step as f64 - steps as f64) / steps as f64;
        let (sin, cos) = sin_cos_turn(step, steps);
        let edges = [
            (HALF_WIDTH, [255, 40, 40], [40, 80, 255]),
            (-HALF_WIDTH, [255, 220, 40], [40, 200, 80]),
        ];
        for (across, from, to) in edges {
            ribbon.strip.push(ribbon.positions.len() as u16);
            ribbon
                .positions
                .push([x, across * cos, across * sin].map(q14));
            // The cross product of the slope along the band and that across it.
            ribbon.normals.push(unit([-across * TWIST, -sin, cos]));
            ribbon
                .colours
                .push([0, 1, 2].map(|c| fade(from[c], to[c], step)));
        }
    }
    ribbon
}

// --- Arithmetic ---

/// Sine and cosine of `k / n` of a turn, the same on every host.
///
/// The angle is brought into the first eighth of a turn in integers, so that points mirrored on an
/// axis or a diagonal come out mirrored exactly; there the series converges fast.
pub(crate) fn sin_cos_turn(k: usize, n: usize) -> (f64, f64) {
    // Quadrants and the rest, in units of 1 / (4 * n) of a turn.
    let (quadrant, rest) = ((4 * k / n) % 4, 4 * k % n);
    let (sin, cos) = if 2 * rest <= n {
        series(rest, n)
    } else {
        let (sin, cos) = series(n - rest, n);
        (cos, sin)
    };
    match quadrant {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// Sine and cosine of `k / n` of a quarter turn, up to an eighth of a turn.
fn series(k: usize, n: usize) -> (f64, f64) {
    let angle = std::f64::consts::FRAC_PI_2 * k as f64 / n as f64;
    let square = angle * angle;
    let (mut sin, mut cos) = (1.0, 1.0);
    // Horner's scheme of Taylor's series, far past the last bit of f64.
    for term in (1..=10).rev() {
        let even = f64::from(2 * term);
        cos = 1.0 - cos * square / ((even - 1.0) * even);
        sin = 1.0 - sin * square / (even * (even + 1.0));
    }
    (angle * sin, cos)
}

fn cross(a: [i128; 3], b: [i128; 3]) -> [i128; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// The vector made one long, in Q1.14.
fn unit(v: [f64; 3]) -> [i16; 3] {
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    v.map(|c| q14(c / length))
}

/// A value from -1 to 1 in Q1.14, to the nearest.
fn q14(value: f64) -> i16 {
    (value * f64::from(ONE)).round() as i16
}
