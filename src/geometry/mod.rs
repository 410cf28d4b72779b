//! What is drawn, where it stands, and how it is lit: meshes, transforms, cameras, lights, colours, shadow volumes (K1, K2, K9, K10).
//!
//! `mesh` and `faces` are what the application hands in; `transform`, `camera` and `project` are where it stands;
//! `light`, `lighting` and `pixel_lamps` are how it is lit; `colour` is a colour in one word; `bounds` is a sphere around a mesh, `meshlet` are its parts; `shadow`
//! draws the silhouette of a mesh out away from a light. Pass one itself is [`scene`](crate::scene).

mod bounds;
mod camera;
mod colour;
mod faces;
mod light;
mod lighting;
mod listed;
mod mesh;
mod meshlet;
mod pixel_lamps;
mod project;
mod shadow;
mod transform;

pub use bounds::Sphere;
pub use camera::{Camera, CameraError, Screen, ScreenError};
pub(crate) use colour::Tint;
pub use colour::{Colour, Scale};
pub use faces::{Cull, MeshError};
pub(crate) use faces::{check, each_triangle, face_normal, triangles};
pub use light::Light;
pub(crate) use lighting::LampsInModel;
pub use lighting::{DirectionalLight, Lighting, Material};
pub(crate) use mesh::place_of;
pub use mesh::{Coordinate, Faces, Mesh, QuadSplit};
pub(crate) use meshlet::Eye;
pub use meshlet::{CutError, Meshlet, Meshlets};
pub use pixel_lamps::PixelLamps;
pub(crate) use project::{Projection, along};
pub(crate) use shadow::Extrusion;
pub use shadow::{ShadowEdge, ShadowLight, ShadowMemory, ShadowRoom};
pub use transform::Affine;
