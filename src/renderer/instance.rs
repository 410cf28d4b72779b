//! How a mesh stands in the world, and what pass one did with all of them.

use crate::geometry::{Affine, Cull, Light};

/// How and where a mesh stands in the world.
///
/// `L` is what lights it: [`Light`], or [`Lighting`](crate::light::Lighting) for several lights and a
/// material with highlights.
#[derive(Clone, Copy, Debug)]
pub struct Instance<L = Light> {
    /// Model space to world space.
    pub model: Affine,
    /// Which faces are dropped.
    pub cull: Cull,
    /// The light, where the mesh is to be lit.
    pub light: Option<L>,
    /// Colour of vertices that have none of their own.
    pub colour: [u8; 3],
}

impl Default for Instance {
    /// At the origin, white, not lit, faces seen from behind dropped.
    fn default() -> Self {
        Self {
            model: Affine::IDENTITY,
            cull: Cull::Back,
            light: None,
            colour: [255; 3],
        }
    }
}

impl<L> Instance<L> {
    /// The same instance lit by something else, or not at all.
    #[must_use]
    pub fn lit_by<M>(self, light: Option<M>) -> Instance<M> {
        Instance {
            model: self.model,
            cull: self.cull,
            light,
            colour: self.colour,
        }
    }
}

/// What pass one has done since the scene was begun.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PassOne {
    /// Triangles submitted.
    pub triangles: u32,
    /// Triangles that cannot be seen, and never cost anything again.
    pub culled: u32,
    /// Triangles that crossed a near, far or guard plane.
    pub clipped: u32,
    /// Objects in the arena.
    pub objects: u32,
    /// Vertices in the arena.
    pub vertices: u32,
    /// Triangles that found no room.
    pub dropped: u32,
    /// Triangles that are drawn without their texture, as they stretch over more of its texels than
    /// a [`Skin`](crate::texture::Skin) may say.
    pub untextured: u32,
    /// Meshes wholly outside the view, which were not looked at (M4). Their triangles are among
    /// the culled.
    pub meshes_skipped: u32,
    /// Triangles of these meshes.
    pub triangles_skipped: u32,
    /// Vertices of these meshes: neither transformed nor lit.
    pub vertices_skipped: u32,
    /// Triangles, or pieces of clipped ones, that have nothing in what a window keeps (H15). The
    /// triangles are among the culled.
    pub outside_window: u32,
}
