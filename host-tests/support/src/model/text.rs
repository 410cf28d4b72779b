//! Meshes of the test scenes as OBJ text.

use scanbeam::{Faces, Mesh};
use std::fmt::Write as _;

/// A mesh of triangles with its colours and normals; `None` for quads and strips.
#[must_use]
pub fn obj_text(mesh: &Mesh<'_>) -> Option<String> {
    let Faces::Triangles(faces) = mesh.faces else {
        return None;
    };
    let q14 = |v: i16| f64::from(v) / f64::from(1 << 14);
    let mut text = String::new();
    for (i, p) in mesh.positions.iter().enumerate() {
        let [x, y, z] = p.map(q14);
        let colour = mesh.colours.get(i);
        let [r, g, b] = colour.map_or([1.0; 3], |c| c.map(|c| f64::from(c) / 255.0));
        writeln!(text, "v {x} {y} {z} {r} {g} {b}").ok()?;
    }
    for n in mesh.normals {
        let [x, y, z] = n.map(q14);
        writeln!(text, "vn {x} {y} {z}").ok()?;
    }
    for face in faces {
        let [a, b, c] = face.map(|i| i + 1);
        if mesh.normals.is_empty() {
            writeln!(text, "f {a} {b} {c}").ok()?;
        } else {
            writeln!(text, "f {a}//{a} {b}//{b} {c}//{c}").ok()?;
        }
    }
    Some(text)
}
