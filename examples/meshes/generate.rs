//! Generators for the test meshes, run by the build script.
//!
//! Every host makes the same bytes: the teapot's points are exact integers up to the last
//! rounding, and the rest is `+ - * /` and `sqrt` in `f64`, which IEEE 754 defines to the bit. No
//! `sin` or `cos` of the host's libm is called.

mod teapot;

use std::fmt::Display;
use teapot::{ONE, TEAPOT_STEPS, Triangles, q14, sin_cos_turn, teapot, unit};

/// Rings of the sphere from pole to pole.
pub(crate) const SPHERE_STACKS: usize = 32;
/// Steps of the sphere around its axis.
pub(crate) const SPHERE_SLICES: usize = 32;
/// Rings of the fine sphere, and steps around its axis.
pub(crate) const FINE_STEPS: usize = 64;
/// Quads of the ribbon.
pub(crate) const RIBBON_STEPS: usize = 32;

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
