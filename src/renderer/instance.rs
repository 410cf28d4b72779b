//! How a mesh stands in the world.

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
