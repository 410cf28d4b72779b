//! Test meshes, as tables in flash: those of the boards' programs and of the test scenes.
//!
//! The build script makes the tables, the same bytes on every host (`generate.rs`). All are y up, in Q1.14, with faces
//! counter-clockwise seen from outside.
//!
//! | Mesh | Vertices | Faces | Triangles | Attributes | Bytes |
//! | --- | --- | --- | --- | --- | --- |
//! | [`TEAPOT`] | 1,178 | triangles | 2,256 | normals | 27,672 |
//! | [`SPHERE`] | 1,089 | triangles | 2,048 | normals | 18,822 |
//! | [`FINE_SPHERE`] | 4,225 | triangles | 8,192 | normals | 74,502 |
//! | [`CUBE`] | 24 | triangles | 12 | normals, colours | 432 |
//! | [`CUBE_QUADS`] | 24 | 6 quads | 12 | normals, colours | 408 |
//! | [`RIBBON`] | 66 | strip of 32 quads | 64 | normals, colours | 1,122 |
//!
//! The two cubes share their vertices, 360 bytes.
#![no_std]
#![forbid(unsafe_code)]

use scanbeam::mesh::QuadSplit;
use scanbeam::{Faces, Mesh};

include!(concat!(env!("OUT_DIR"), "/meshes.rs"));

/// The Utah teapot (Martin Newell, University of Utah, 1975): 32 patches of 6 by 6 quads.
///
/// 1,178 vertices, 2,256 triangles, smooth normals, no colours. The spout points along +x, the handle
/// along -x; the bounding box is centred on the origin and x goes from -1.0 to 1.0. As in the
/// original, the lid, the body, the handle and the spout are four surfaces that cut into or stand
/// off from each other: the spout is open at its tip, and there is a gap around the lid.
pub static TEAPOT: Mesh<'static> = Mesh {
    positions: &TEAPOT_POSITIONS,
    normals: &TEAPOT_NORMALS,
    colours: &[],
    faces: Faces::Triangles(&TEAPOT_FACES),
};

/// A sphere of radius 1.0, 32 by 32 quads by latitude and longitude (scene A).
///
/// 33 by 33 vertices, from the pole at +y down, and 2,048 triangles, of which the 64 at the poles
/// have no area. The normals are the same table as the positions. No colours.
pub static SPHERE: Mesh<'static> = Mesh {
    positions: &SPHERE_POSITIONS,
    normals: &SPHERE_POSITIONS,
    colours: &[],
    faces: Faces::Triangles(&SPHERE_FACES),
};

/// The same sphere of 64 by 64 quads: 65 by 65 vertices and 8,192 triangles, of
/// which the 128 at the poles have no area (scene G).
pub static FINE_SPHERE: Mesh<'static> = Mesh {
    positions: &FINE_POSITIONS,
    normals: &FINE_POSITIONS,
    colours: &[],
    faces: Faces::Triangles(&FINE_FACES),
};

/// A cube from -1.0 to 1.0 on each axis: 24 vertices, 12 triangles, each side in its own colour.
///
/// The sides are, in order, +x red, -x cyan, +y green, -y magenta, +z blue, -z yellow. Its corners
/// are 1.73 from the origin.
pub static CUBE: Mesh<'static> = Mesh {
    positions: &CUBE_POSITIONS,
    normals: &CUBE_NORMALS,
    colours: &CUBE_COLOURS,
    faces: Faces::Triangles(&CUBE_FACES),
};

/// [`CUBE`] as 6 quads, split like it: from the first corner to the third.
pub static CUBE_QUADS: Mesh<'static> = Mesh {
    positions: &CUBE_POSITIONS,
    normals: &CUBE_NORMALS,
    colours: &CUBE_COLOURS,
    faces: Faces::Quads(&CUBE_QUAD_FACES, QuadSplit::Corner0To2),
};

/// A band along x from -1.0 to 1.0, 0.5 wide, turned once about x, as a strip of 32 quads.
///
/// 66 vertices. One edge fades from red to blue, the other from yellow to green. The normals
/// belong to the front, which looks to +z at both ends and to -z in the middle; from behind, the
/// faces are clockwise.
pub static RIBBON: Mesh<'static> = Mesh {
    positions: &RIBBON_POSITIONS,
    normals: &RIBBON_NORMALS,
    colours: &RIBBON_COLOURS,
    faces: Faces::QuadStrip(&RIBBON_STRIP, QuadSplit::Corner0To2),
};
