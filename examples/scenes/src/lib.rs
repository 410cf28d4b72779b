//! Test scenes that the firmware and the host draw alike.
//!
//! The meshes are those of the crate `meshes`; the build script hands baked lists on.
//!
//! [`teapot_list`] is the teapot as `scanbeam bake` makes it: 14,380 bytes; [`crate_list`] is a
//! textured box.
#![no_std]
#![forbid(unsafe_code)]

mod contours;
mod formats;
mod frames;
mod in_parts;
mod lamps;
mod listed;
mod looks;
mod mirror;
mod octasphere;
mod paced;
mod played;
mod scene_b;
mod sheet;
mod shots;
mod stress;
mod suite;
mod texels;
mod values;

pub use contours::{CONTOURED, ContourLook, Contours};
pub use formats::{IN_FORMATS, InFormat, build_in_format, build_lit, build_smooth};
pub use frames::{Frame, frames, unhurried};
pub use in_parts::{CutMemory, IN_PARTS, InParts};
pub use lamps::{lamplit_teapot, teapot_lamps};
pub use listed::{
    CRATE_INDICES, CRATE_TABLE, LIST_INDICES, LIST_TABLE, crate_list, teapot_list,
    teapot_meshlets_list,
};
pub use looks::{
    GreyLook, LitBytesLook, LitWordsLook, NumbersLook, SmoothLook, TexturedLook, TrueColourLook,
    TrueColourTexturedLook,
};
pub use meshes::{CUBE, CUBE_QUADS, FINE_SPHERE, RIBBON, SPHERE, TEAPOT};
pub use mirror::SURROUNDINGS;
pub use octasphere::{OCTASPHERES, Octasphere};
pub use paced::{PACED, Paced};
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
