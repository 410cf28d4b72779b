//! Test scenes: meshes that the firmware and the host draw alike.
//!
//! The build script makes the tables, the same bytes on every host (`generate.rs`); they lie in
//! flash. All are y up, in Q1.14, with faces counter-clockwise seen from outside.
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
//!
//! [`teapot_list`] is the teapot as `scanbeam bake` makes it: 14,380 bytes; [`crate_list`] is a
//! textured box.
#![no_std]
#![forbid(unsafe_code)]

mod contours;
mod frames;
mod in_parts;
mod lamps;
mod listed;
mod looks;
mod mirror;
mod octasphere;
mod played;
mod scene_b;
mod sheet;
mod shots;
mod stress;
mod suite;
mod texels;
mod values;

pub use contours::{CONTOURED, ContourLook, Contours};
pub use frames::{Frame, frames};
pub use in_parts::{CutMemory, IN_PARTS, InParts};
pub use lamps::{lamplit_teapot, teapot_lamps};
pub use listed::{
    CRATE_INDICES, CRATE_TABLE, LIST_INDICES, LIST_TABLE, crate_list, teapot_list,
    teapot_meshlets_list,
};
pub use looks::{SmoothLook, TexturedLook};
pub use mirror::SURROUNDINGS;
pub use octasphere::{OCTASPHERES, Octasphere};
pub use played::{PLAYED, PLAYED_NAMES, PLAYED_TEXELS, PLAYED_TEXTURES, Played, PlayedError};
pub use scene_b::{SCENES_B, SceneB, TEXELS_PANEL};
pub use sheet::{Hits, SHEET_TRIANGLES, SHEETS, Sheet, SheetError};
pub use shots::{
    DRAWS, HEIGHT, LAYER, LAYERS, MOST_SLOTS, NEAREST_LAYER, OBJECTS, SHOTS, STACKS, Shot,
    ShotError, VARIANTS, VERTICES, Variant, WIDTH, layer_colours,
};
pub use stress::STRESS;
pub use suite::{
    CUBE_HALF, CUBE_PITCH, CUBES, Looking, PLACES_F, Part, SUITE, SUITE_DRAWS, SUITE_LINES,
    SUITE_OBJECTS, SUITE_VERTICES, Suite, TEXEL_SIDE_F, TEXELS_F, TEXELS_F_PANEL, cube, cube_model,
    inside, layer, room_light, sphere_light, teapot_part, tilt, tilted, tilted_textured,
};
pub use texels::{TEXEL_SIDE, TEXELS_565};
pub use values::{
    IndexedLook, PhongLook, STONE, TexturedPhongLook, VALUES, VALUES_HEIGHT, VALUES_ROOM,
    VALUES_SHOWN, VALUES_WIDTH, Values, ValuesError, ValuesMemory, values_screen,
};

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
