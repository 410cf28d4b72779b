//! What a draw call says, and what pass two needs of it.

use crate::geometry::{Affine, Cull, Light, Mesh};

/// One draw call: a mesh, where it stands and how it looks.
///
/// `C` is the coordinate type of the mesh, as in [`Mesh`].
#[derive(Clone, Copy, Debug)]
pub struct Draw<'a, C = i16> {
    /// What is drawn.
    pub mesh: Mesh<'a, C>,
    /// Model space to world space.
    pub model: Affine,
    /// Which faces are dropped.
    pub cull: Cull,
    /// The light, where the mesh is to be lit; it needs normals.
    pub light: Option<Light>,
    /// Colour of vertices that have none of their own.
    pub colour: [u8; 3],
}

impl<'a, C> Draw<'a, C> {
    /// A mesh at the origin, white, not lit, faces seen from behind dropped.
    #[must_use]
    pub const fn new(mesh: Mesh<'a, C>) -> Self {
        Self {
            mesh,
            model: Affine::IDENTITY,
            cull: Cull::Back,
            light: None,
            colour: [255; 3],
        }
    }
}

/// What pass two needs of a draw call, kept once a call.
#[derive(Clone, Copy, Debug, Default)]
pub struct DrawState<'t> {
    /// The number of its first triangle.
    pub(crate) first: u16,
    pub(crate) texture: core::marker::PhantomData<&'t ()>,
}

impl DrawState<'_> {
    /// What fresh memory is filled with.
    pub const EMPTY: Self = Self {
        first: 0,
        texture: core::marker::PhantomData,
    };
}
