//! What can go wrong while a scene is made.

use super::LARGEST;
use super::shadow::Shadow;
use crate::geometry::{MeshError, ShadowRoom};
use core::fmt;

/// Why a scene cannot be begun. It is as it was.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum BeginError {
    /// The picture has more columns or lines than [`LARGEST`].
    Size {
        /// Columns.
        width: u16,
        /// Lines.
        height: u16,
    },
    /// The lines are not within the picture, or there are none.
    Lines {
        /// The first line.
        start: u16,
        /// The line after the last.
        end: u16,
        /// The picture's height.
        height: u16,
    },
    /// There are fewer bins than lines.
    Bins {
        /// How many lines were to be begun.
        needed: u16,
        /// How many bins there are.
        have: usize,
    },
}

impl fmt::Display for BeginError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("scene: ")?;
        match self {
            Self::Size { width, height } => {
                write!(
                    f,
                    "a picture of {width} x {height} pixels: at most {LARGEST} each way"
                )
            }
            Self::Lines { start, end, height } => {
                write!(f, "lines {start}..{end} of a picture of {height} lines")
            }
            Self::Bins { needed, have } => {
                write!(f, "{needed} lines need as many bins, there are {have}")
            }
        }
    }
}

impl core::error::Error for BeginError {}

/// Which memory is full.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Full {
    /// That of the vertices.
    Vertices,
    /// That of the places of vertices on textures.
    Places,
    /// That of the triangles.
    Objects,
    /// That of the draw calls.
    Draws,
}

/// Why a mesh was not drawn, or not all of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum DrawError {
    /// The scene was not begun; nothing is drawn.
    NotBegun,
    /// The mesh contradicts itself; nothing of it is drawn.
    Mesh(MeshError),
    /// Light falls on corners where the scene's look is lit at pixels, or the other way; nothing of it is drawn.
    Light,
    /// The call has a texture, and the scene's look draws none; nothing of it is drawn.
    Untextured,
    /// The call has a blend, and pixels of the scene are numbers of a palette, which have no mean; nothing of it is drawn.
    Indices,
    /// The memory lent for a shadow volume is too short; nothing of it is drawn.
    Shadow(ShadowRoom),
    /// The number of a shadow's light is not below [`Shadow::LIGHTS`]; nothing of the call is drawn.
    ShadowLight,
    /// A scene has both shadows and priorities: these decide on nothing by depth, and shadows are counted by it.
    /// Nothing of the call is drawn.
    ShadowRanked,
    /// A shadow volume is drawn as points or by corners on the screen: its faces have no inside there. Nothing of the
    /// call is drawn.
    ShadowFlat,
    /// Memory is full; what was kept is drawn.
    Full {
        /// Which memory.
        memory: Full,
        /// How many triangles were dropped, or lost a piece.
        triangles: u32,
        /// The first of them, as the face of the mesh that it comes from.
        first_face: u32,
    },
}

impl fmt::Display for DrawError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotBegun => "scene: drawn before it was begun",
            Self::Mesh(MeshError::AttributeLength) => {
                "mesh: normals, colours, places or alphas are not as many as positions"
            }
            Self::Mesh(MeshError::Index { face }) => {
                return write!(f, "mesh: face {face} names a vertex that does not exist");
            }
            Self::Mesh(MeshError::StripLength) => {
                "mesh: a quad strip needs an even number of indices, and not two"
            }
            Self::Mesh(MeshError::Meshlets) => {
                "mesh: the parts are not those of its triangles and vertices"
            }
            Self::Light => {
                "scene: the light is for pixels and the look of the scene for corners, or the other way"
            }
            Self::Untextured => "scene: a texture is drawn, and the look of the scene has none",
            Self::Indices => "scene: colours are blended, and pixels are numbers of a palette",
            Self::Shadow(room) => return write!(f, "shadow: no room for all {room}"),
            Self::ShadowLight => {
                return write!(f, "shadow: lights have numbers below {}", Shadow::LIGHTS);
            }
            Self::ShadowRanked => "shadow: a scene has shadows or priorities, not both",
            Self::ShadowFlat => "shadow: points and triangles on the screen bound no volume",
            Self::Full {
                memory,
                triangles,
                first_face,
            } => {
                let memory = match memory {
                    Full::Vertices => "vertices",
                    Full::Places => "places",
                    Full::Objects => "objects",
                    Full::Draws => "draws",
                };
                return write!(
                    f,
                    "scene: the memory of {memory} is full: {triangles} triangles dropped, from face {first_face} on"
                );
            }
        })
    }
}

impl core::error::Error for DrawError {}
