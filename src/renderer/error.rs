//! Why a scene, a mesh or a line was not drawn.

use crate::geometry::{Dropped, MeshError, Room};

/// Why a scene cannot be begun.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum SceneError {
    /// There are fewer buckets than lines.
    Buckets {
        /// How many lines were to be begun.
        needed: u16,
        /// How many buckets there are.
        have: usize,
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
}

impl core::fmt::Display for SceneError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Buckets { needed, have } => {
                write!(
                    f,
                    "scene: {needed} lines need as many buckets, there are {have}"
                )
            }
            Self::Lines { start, end, height } => {
                write!(
                    f,
                    "scene: lines {start}..{end} of a picture of {height} lines"
                )
            }
        }
    }
}

impl core::error::Error for SceneError {}

/// Why a mesh was not drawn, or not all of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum DrawError {
    /// An arena is full; what was kept is drawn.
    Full(Dropped),
    /// The mesh contradicts itself; nothing of it is drawn.
    Mesh(MeshError),
}

impl core::fmt::Display for DrawError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Full(Dropped {
                room,
                first_face,
                triangles,
            }) => {
                let room = match room {
                    Room::Vertices => "vertex",
                    Room::Objects => "object",
                };
                write!(
                    f,
                    "the {room} arena is full: {triangles} triangles dropped, from face {first_face} on"
                )
            }
            Self::Mesh(MeshError::AttributeLength) => {
                f.write_str("mesh: normals or colours are not as many as the positions")
            }
            Self::Mesh(MeshError::Index { face }) => {
                write!(f, "mesh: face {face} names a vertex that does not exist")
            }
            Self::Mesh(MeshError::StripLength) => {
                f.write_str("mesh: a quad strip needs an even number of indices, and not two")
            }
        }
    }
}

impl core::error::Error for DrawError {}

/// A line renderer has less memory than the scene needs. Nothing was drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RendererError {
    /// Fewer links than the scene has objects.
    Links {
        /// Objects of the scene.
        needed: usize,
        /// Links of the renderer.
        have: usize,
    },
    /// Fewer depth cells than a line has pixels.
    Depth {
        /// Pixels a line.
        needed: usize,
        /// Depth cells of the renderer.
        have: usize,
    },
    /// The pixels lent for a line are not as many as a line has.
    Pixels {
        /// Pixels a line.
        needed: usize,
        /// Pixels lent.
        have: usize,
    },
    /// The line is not among those the scene was begun with.
    Line {
        /// The line.
        line: u16,
    },
    /// The line belongs to none of the renderers, or came out of turn from the one it belongs to.
    Unowned {
        /// The line.
        line: u16,
    },
}

impl core::fmt::Display for RendererError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Links { needed, have } => {
                write!(
                    f,
                    "renderer: {needed} objects need as many links, there are {have}"
                )
            }
            Self::Depth { needed, have } => {
                write!(
                    f,
                    "renderer: a line of {needed} pixels has {have} depth cells"
                )
            }
            Self::Pixels { needed, have } => {
                write!(f, "renderer: a line of {needed} pixels was lent {have}")
            }
            Self::Line { line } => write!(f, "renderer: line {line} is not part of the scene"),
            Self::Unowned { line } => write!(f, "renderer: nobody draws line {line} in its turn"),
        }
    }
}

impl core::error::Error for RendererError {}
