//! The meshes are what their documentation says: sizes, winding, normals, closed surfaces.

use std::collections::{BTreeMap, BTreeSet};

use meshes::{CUBE, CUBE_QUADS, FINE_SPHERE, RIBBON, SPHERE, TEAPOT};
use scanbeam::mesh::QuadSplit;
use scanbeam::{Faces, Mesh};

#[path = "../generate/teapot.rs"]
mod generate;

type Point = [i16; 3];

const ALL: [(&str, &Mesh<'static>); 6] = [
    ("TEAPOT", &TEAPOT),
    ("SPHERE", &SPHERE),
    ("FINE_SPHERE", &FINE_SPHERE),
    ("CUBE", &CUBE),
    ("CUBE_QUADS", &CUBE_QUADS),
    ("RIBBON", &RIBBON),
];

/// The faces as triangles, split as the mesh asks.
fn triangles(mesh: &Mesh<'_>) -> Vec<[usize; 3]> {
    let split = |[a, b, c, d]: [u16; 4], how: QuadSplit| match how {
        QuadSplit::Corner0To2 => [[a, b, c], [a, c, d]],
        QuadSplit::Corner1To3 => [[b, c, d], [b, d, a]],
    };
    let faces: Vec<[u16; 3]> = match mesh.faces {
        Faces::Triangles(faces) => faces.to_vec(),
        Faces::Quads(quads, how) => quads.iter().flat_map(|&quad| split(quad, how)).collect(),
        Faces::QuadStrip(strip, how) => strip
            .windows(4)
            .step_by(2)
            .flat_map(|w| split([w[0], w[1], w[3], w[2]], how))
            .collect(),
    };
    faces
        .into_iter()
        .map(|face| face.map(usize::from))
        .collect()
}

fn subtract(a: Point, b: Point) -> [i64; 3] {
    [0, 1, 2].map(|axis| i64::from(a[axis]) - i64::from(b[axis]))
}

fn cross(a: [i64; 3], b: [i64; 3]) -> [i64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn dot(a: [i64; 3], b: [i64; 3]) -> i64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn wide(a: Point) -> [i64; 3] {
    a.map(i64::from)
}

fn length(a: [i64; 3]) -> f64 {
    (dot(a, a) as f64).sqrt()
}

fn face_normal(mesh: &Mesh<'_>, face: [usize; 3]) -> [i64; 3] {
    let [p, q, r] = face.map(|corner| mesh.positions[corner]);
    cross(subtract(q, p), subtract(r, p))
}

fn bounds(positions: &[Point]) -> (Point, Point) {
    let low = [0, 1, 2].map(|axis| positions.iter().map(|p| p[axis]).min().unwrap());
    let high = [0, 1, 2].map(|axis| positions.iter().map(|p| p[axis]).max().unwrap());
    (low, high)
}

/// The directed edges of the faces with an area, by position, with the number of their face.
///
/// Panics where two faces run along an edge the same way: one of them would be turned over.
fn edges(mesh: &Mesh<'_>) -> BTreeMap<(Point, Point), usize> {
    let mut edges = BTreeMap::new();
    for (number, &face) in triangles(mesh).iter().enumerate() {
        let [p, q, r] = face.map(|corner| mesh.positions[corner]);
        if p == q || q == r || r == p {
            continue;
        }
        for edge in [(p, q), (q, r), (r, p)] {
            assert_eq!(
                edges.insert(edge, number),
                None,
                "edge {edge:?} twice the same way"
            );
        }
    }
    edges
}

fn open_edges(edges: &BTreeMap<(Point, Point), usize>) -> Vec<(Point, Point)> {
    edges
        .keys()
        .copied()
        .filter(|&(p, q)| !edges.contains_key(&(q, p)))
        .collect()
}

/// Faces joined by edges, as sets of face numbers, in the order of their first face.
fn surfaces(edges: &BTreeMap<(Point, Point), usize>) -> Vec<BTreeSet<usize>> {
    let mut neighbours: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (&(p, q), &face) in edges {
        neighbours
            .entry(face)
            .or_default()
            .extend(edges.get(&(q, p)));
    }
    let mut seen = BTreeSet::new();
    let mut surfaces = Vec::new();
    for &start in neighbours.keys() {
        let mut surface = BTreeSet::new();
        let mut pending = vec![start];
        while let Some(face) = pending.pop() {
            if seen.insert(face) {
                surface.insert(face);
                pending.extend(&neighbours[&face]);
            }
        }
        if !surface.is_empty() {
            surfaces.push(surface);
        }
    }
    surfaces
}

/// How many closed loops the edges make. Panics where they do not.
fn loops(edges: &[(Point, Point)]) -> usize {
    let mut next: BTreeMap<Point, Point> = BTreeMap::new();
    for &(p, q) in edges {
        assert_eq!(next.insert(p, q), None, "two open edges leave {p:?}");
    }
    let mut count = 0;
    while let Some((start, mut at)) = next.pop_first() {
        count += 1;
        while at != start {
            at = next.remove(&at).expect("open edges go on");
        }
    }
    count
}

#[test]
fn counts_are_as_documented() {
    let counts = ALL.map(|(name, mesh)| (name, mesh.positions.len(), triangles(mesh).len()));
    assert_eq!(
        counts,
        [
            ("TEAPOT", 1178, 2256),
            ("SPHERE", 33 * 33, 2048),
            ("FINE_SPHERE", 65 * 65, 8192),
            ("CUBE", 24, 12),
            ("CUBE_QUADS", 24, 12),
            ("RIBBON", 66, 64),
        ]
    );
}

#[test]
fn attributes_match_and_every_vertex_is_used() {
    for (name, mesh) in ALL {
        let vertices = mesh.positions.len();
        assert_eq!(mesh.normals.len(), vertices, "{name}");
        assert!([0, vertices].contains(&mesh.colours.len()), "{name}");
        let used: BTreeSet<usize> = triangles(mesh).into_iter().flatten().collect();
        assert!(
            used.into_iter().eq(0..vertices),
            "{name}: all vertices, and no others"
        );
    }
}

#[test]
fn normals_are_unit() {
    for (name, mesh) in ALL {
        for &normal in mesh.normals {
            let error = (length(wide(normal)) - 16384.0).abs();
            // Half a step of rounding on each axis.
            assert!(error <= 0.87, "{name}: {normal:?} is off by {error}");
        }
    }
}

#[test]
fn faces_wind_counter_clockwise_about_their_normals() {
    for (name, mesh) in ALL {
        let mut flat = 0;
        for face in triangles(mesh) {
            let across = face_normal(mesh, face);
            if across == [0; 3] {
                flat += 1;
                continue;
            }
            for corner in face {
                let towards = dot(across, wide(mesh.normals[corner]));
                let cosine = towards as f64 / length(across) / 16384.0;
                // The spout's lip bends most within a triangle: 0.22 there.
                assert!(
                    cosine > 0.2,
                    "{name}: face {face:?}, corner {corner}: {cosine}"
                );
            }
        }
        // Those at the poles of the spheres.
        let none = match name {
            "SPHERE" => 64,
            "FINE_SPHERE" => 128,
            _ => 0,
        };
        assert_eq!(flat, none, "{name}: faces without area");
    }
}

#[test]
fn bounding_boxes() {
    let one = 16384;
    assert_eq!(bounds(SPHERE.positions), ([-one; 3], [one; 3]));
    assert_eq!(bounds(CUBE.positions), ([-one; 3], [one; 3]));
    assert_eq!(
        bounds(RIBBON.positions),
        ([-one, -4096, -4096], [one, 4096, 4096])
    );

    let (low, high) = bounds(TEAPOT.positions);
    assert_eq!((low[0], high[0]), (-one, one), "x is the longest side");
    for axis in 1..3 {
        assert_eq!(low[axis], -high[axis], "centred on the origin");
    }
    // 3.15 high and 4 deep to 6.43 long. Patches are cut at sixths, so 4 loses a little.
    let unit = 2.0 * f64::from(one) / 6.434;
    assert!(
        (f64::from(high[1]) - 3.15 / 2.0 * unit).abs() < 0.003 * unit,
        "{high:?}"
    );
    assert!(
        (f64::from(high[2]) - 4.0 / 2.0 * unit).abs() < 0.02 * unit,
        "{high:?}"
    );
}

#[test]
fn sphere_is_round_and_closed() {
    let rows: Vec<&[Point]> = SPHERE.positions.chunks(33).collect();
    assert!(rows[0].iter().all(|&p| p == [0, 16384, 0]), "a pole above");
    assert!(
        rows[32].iter().all(|&p| p == [0, -16384, 0]),
        "a pole below"
    );
    let known: BTreeSet<Point> = SPHERE.positions.iter().copied().collect();
    for row in &rows {
        assert_eq!(row[0], row[32], "the seam closes");
    }
    for &[x, y, z] in SPHERE.positions {
        for mirrored in [[-x, y, z], [x, -y, z], [x, y, -z], [z, y, x]] {
            assert!(known.contains(&mirrored), "{mirrored:?}");
        }
        assert!((length(wide([x, y, z])) - 16384.0).abs() <= 0.87);
    }
    assert_eq!(rows[16][0], [16384, 0, 0]);
    assert_eq!(rows[16][8], [0, 0, -16384]);
    assert_eq!(rows[16][4], [11585, 0, -11585]);
    assert_eq!(rows[8][0], [11585, 11585, 0]);
    let edges = edges(&SPHERE);
    assert_eq!(open_edges(&edges), []);
    assert_eq!(surfaces(&edges).len(), 1);
}

#[test]
fn cube_is_closed_and_its_sides_differ() {
    assert_eq!(open_edges(&edges(&CUBE)), []);
    assert_eq!(triangles(&CUBE), triangles(&CUBE_QUADS));
    let colours: BTreeSet<[u8; 3]> = CUBE.colours.iter().copied().collect();
    assert_eq!(colours.len(), 6);
    for face in triangles(&CUBE) {
        let [a, b, c] = face.map(|corner| (CUBE.colours[corner], CUBE.normals[corner]));
        assert!(a == b && b == c, "one side, one colour and normal");
        assert!(
            dot(face_normal(&CUBE, face), wide(CUBE.positions[face[0]])) > 0,
            "outwards"
        );
    }
}

#[test]
fn ribbon_is_one_band() {
    let edges = edges(&RIBBON);
    assert_eq!(surfaces(&edges).len(), 1);
    let open = open_edges(&edges);
    assert_eq!((open.len(), loops(&open)), (66, 1));
    assert_eq!(
        RIBBON.positions[..2],
        [[-16384, 4096, 0], [-16384, -4096, 0]]
    );
    assert_eq!(RIBBON.positions[32..34], [[0, -4096, 0], [0, 4096, 0]]);
    assert_eq!(
        RIBBON.positions[64..],
        [[16384, 4096, 0], [16384, -4096, 0]]
    );
    for (at, sign) in [(0, 1), (32, -1), (64, 1)] {
        assert_eq!(
            RIBBON.normals[at][2].signum(),
            sign,
            "turned half way, and back"
        );
    }
    let ends = [
        RIBBON.colours[0],
        RIBBON.colours[64],
        RIBBON.colours[1],
        RIBBON.colours[65],
    ];
    assert_eq!(
        ends,
        [[255, 40, 40], [40, 80, 255], [255, 220, 40], [40, 200, 80]]
    );
}

#[test]
fn teapot_is_mirrored_on_the_plane_of_spout_and_handle() {
    let mut at: BTreeMap<Point, Vec<Point>> = BTreeMap::new();
    for (&position, &normal) in TEAPOT.positions.iter().zip(TEAPOT.normals) {
        at.entry(position).or_default().push(normal);
    }
    for (&[x, y, z], normals) in &at {
        let twins = at.get(&[x, y, -z]).expect("a vertex across the plane");
        for &[nx, ny, nz] in normals {
            let near = |t: &Point| subtract(*t, [nx, ny, -nz]).iter().all(|c| c.abs() <= 2);
            assert!(
                twins.iter().any(near),
                "{:?}: {normals:?}, {twins:?}",
                [x, y, z]
            );
        }
    }
}

#[test]
fn teapot_is_four_surfaces_turned_outwards() {
    // `edges` fails on a patch turned over, or on one edge used by three faces.
    let edges = edges(&TEAPOT);
    let all_open = open_edges(&edges);
    let faces = triangles(&TEAPOT);
    let mut found = Vec::new();
    for surface in surfaces(&edges) {
        let open: Vec<(Point, Point)> = all_open
            .iter()
            .copied()
            .filter(|edge| surface.contains(&edges[edge]))
            .collect();
        // The volume within, seen from the middle of the openings.
        let mut middle = [0i64; 3];
        for (p, _) in &open {
            for axis in 0..3 {
                middle[axis] += i64::from(p[axis]);
            }
        }
        let middle = middle.map(|sum| sum / open.len() as i64);
        let volume: f64 = surface
            .iter()
            .map(|&face| {
                let p = wide(TEAPOT.positions[faces[face][0]]);
                let out = [0, 1, 2].map(|axis| p[axis] - middle[axis]);
                dot(out, face_normal(&TEAPOT, faces[face])) as f64 / 6.0
            })
            .sum();
        assert!(volume > 0.0, "a surface turned inside out");
        found.push((surface.len(), open.len(), loops(&open)));
    }
    assert_eq!(
        found,
        [
            // Rim, body and bottom, less the pole's triangles: open at the rim only.
            (16 * 72 - 24, 24, 1),
            // Handle: both ends lie within the body.
            (4 * 72, 24, 2),
            // Spout: its root and its tip.
            (4 * 72, 24, 2),
            // Lid.
            (8 * 72 - 24, 24, 1),
        ]
    );
}

#[test]
fn teapot_body_is_mirrored_about_its_axis() {
    // Patches 1 to 12 and 29 to 32 are one surface, the first of the four.
    let edges = edges(&TEAPOT);
    let faces = triangles(&TEAPOT);
    let body: BTreeSet<Point> = surfaces(&edges)[0]
        .iter()
        .flat_map(|&face| faces[face].map(|corner| TEAPOT.positions[corner]))
        .collect();
    let points: Vec<Point> = body.iter().copied().collect();
    let (low, high) = bounds(&points);
    let twice_axis = low[0] + high[0];
    for &[x, y, z] in &body {
        // The axis is not on the grid: a mirrored point may round the other way.
        assert!(
            [-1, 0, 1]
                .iter()
                .any(|by| body.contains(&[twice_axis - x + by, y, z])),
            "no twin of {:?}",
            [x, y, z]
        );
    }
}

#[test]
fn teapot_data_fill_the_known_box() {
    let used: BTreeSet<usize> = generate::PATCHES.iter().flatten().copied().collect();
    // Four points next to the lid's pole belong to another edition of the data.
    let unused: Vec<usize> = (1..=306).filter(|number| !used.contains(number)).collect();
    assert_eq!(unused, [205, 206, 216, 223]);
    for axis in 0..3 {
        assert!(
            generate::POINTS
                .iter()
                .all(|p| (-3.0..=3.525).contains(&p[axis]))
        );
    }
    // The surface itself, finely cut: x from -3 to 3.434, 4 across, z from 0 to 3.15.
    let fine = generate::teapot(24);
    let (low, high) = bounds(&fine.positions);
    let size =
        [0, 1, 2].map(|axis| (f64::from(high[axis]) - f64::from(low[axis])) * (6.434 / 32768.0));
    assert!(
        (size[1] - 3.15).abs() < 0.002 && (size[2] - 4.0).abs() < 0.002,
        "{size:?}"
    );
}

#[test]
fn generator_agrees_with_the_tables() {
    let teapot = generate::teapot(generate::TEAPOT_STEPS);
    assert_eq!(teapot.positions, TEAPOT.positions);
    assert_eq!(teapot.normals, TEAPOT.normals);
    for (k, n) in [(0, 32), (1, 32), (5, 64), (16, 64), (31, 32), (7, 9)] {
        let (sin, cos) = generate::sin_cos_turn(k, n);
        let angle = std::f64::consts::TAU * k as f64 / n as f64;
        assert!((sin - angle.sin()).abs() < 1e-14 && (cos - angle.cos()).abs() < 1e-14);
    }
}
