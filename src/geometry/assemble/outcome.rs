//! What became of a mesh, and why it could not be drawn.

/// Which arena had no room.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Room {
    /// That of the vertices.
    Vertices,
    /// That of the objects.
    Objects,
}

/// Faces that could not be kept; all others are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Dropped {
    /// The arena that was full when the first was dropped.
    pub room: Room,
    /// Index of the first face that lost a triangle.
    pub first_face: u32,
    /// How many triangles were dropped, or lost a piece that clipping had made of them.
    pub triangles: u32,
}

/// A mesh that contradicts itself. Nothing of it is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum MeshError {
    /// An attribute slice is neither empty nor as long as the positions.
    AttributeLength,
    /// This face names a vertex that does not exist.
    Index {
        /// Index of the face.
        face: u32,
    },
    /// A quad strip has an odd number of indices, or two.
    StripLength,
}

/// What became of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Assembled {
    /// Triangles submitted.
    pub triangles: u32,
    /// Triangles that cannot be seen: outside, from behind, or between pixel centres.
    pub culled: u32,
    /// Triangles that crossed a near, far or guard plane.
    pub clipped: u32,
    /// Objects kept, pieces of clipped triangles included.
    pub kept: u32,
    /// Of the triangles kept, those that are drawn without their texture, as they stretch over too
    /// many of its texels.
    pub untextured: u32,
    /// What found no room.
    pub dropped: Option<Dropped>,
}
