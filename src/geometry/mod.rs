//! Vertices in, objects out: pass one but for the filing (K1, K2, K10).
//!
//! `mesh` is what the application hands in; `transform`, `camera` and `light` are where it
//! stands and how it is lit; `project` takes one vertex to the screen; `clip` mends triangles
//! that cross the near, far or guard planes; `bounds` asks whether a mesh is outside; `assemble` runs them and culls;
//! `setup` makes of an
//! object's corners what drawing needs, once it is reached.

mod assemble;
mod blended;
mod bounds;
mod camera;
mod clip;
mod colour;
mod finish;
mod light;
mod lighting;
mod listed;
mod mesh;
mod object;
mod pixel_lamps;
mod project;
mod setup;
mod shading;
mod shadow;
pub mod texturing;
mod transform;

pub use assemble::{Assembled, Cull, Dropped, MeshError, Room, ScreenVertex};
pub(crate) use assemble::{
    Assembler, Looks, ScreenMesh, Store, Surfaced, check, check_mesh, each_triangle, face_normal,
    on_screen, triangles,
};
pub use blended::{Blended, BlendedLevels, ObjectFinish, Surface};
pub use bounds::Sphere;
pub use camera::{Camera, CameraError, Screen, ScreenError};
pub(crate) use colour::Tint;
pub use colour::{Colour, Scale};
pub use finish::{Blend, DepthFunction, Factor, Finish, Role};
pub(crate) use light::ModelLight;
pub use light::{Light, LightingModel};
pub(crate) use lighting::LampsInModel;
pub use lighting::{DirectionalLight, Lighting, Material};
pub use mesh::{Coordinate, Faces, Mesh, QuadSplit};
pub use object::{Filed, Object, SceneVertex};
pub use pixel_lamps::PixelLamps;
pub(crate) use pixel_lamps::unit_normal;
pub(crate) use project::Projection;
pub(crate) use setup::at_pixel;
pub use setup::{Drawable, Parameters};
pub use shading::{Empty, Flat, FlatLevels, Gouraud, GouraudLevels, Shading};
pub(crate) use shadow::Extrusion;
pub use shadow::{ShadowEdge, ShadowLight, ShadowMemory, ShadowRoom};
pub use transform::Affine;
