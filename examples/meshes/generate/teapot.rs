//! The Utah teapot from its patches, and arithmetic that all meshes share. The tests take it too.

#[path = "../teapot_data.rs"]
mod teapot_data;

pub(crate) use teapot_data::{PATCHES, POINTS};

/// 1.0 in Q1.14.
pub(crate) const ONE: i16 = 1 << 14;

/// Subdivisions of a patch of the teapot, in each direction.
pub(crate) const TEAPOT_STEPS: usize = 6;

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
pub(crate) fn unit(v: [f64; 3]) -> [i16; 3] {
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    v.map(|c| q14(c / length))
}

/// A value from -1 to 1 in Q1.14, to the nearest.
pub(crate) fn q14(value: f64) -> i16 {
    (value * f64::from(ONE)).round() as i16
}
