//! What a draw call says, and what pass two needs of it.

use super::texture::Square;
use super::{Budget, Texture};
use crate::geometry::{Affine, Cull, Light, Mesh};

/// One draw call: a mesh, where it stands and how it looks.
///
/// `C` is the coordinate type of the mesh, as in [`Mesh`].
#[derive(Clone, Copy, Debug)]
pub struct Draw<'a, 't, C = i16> {
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
    /// The texture, for looks that have any; colours and light are multiplied with it.
    pub texture: Option<Skin<'a, 't>>,
}

/// How a texture lies on a mesh.
#[derive(Clone, Copy, Debug)]
pub struct Skin<'a, 't> {
    /// The texture.
    pub texture: &'t Texture<'t>,
    /// The place of each vertex on it: to the right and down from its upper left corner, in texels with 8 fraction
    /// bits, -2^20 to 2^20 texels. As many as there are positions.
    ///
    /// A triangle may stretch over less than 4,096 texels; one that stretches farther is drawn without the texture,
    /// and counted.
    pub places: &'a [[i32; 2]],
    /// How far a pixel's texel may be from its place.
    pub budget: Budget,
}

impl<'a, C> Draw<'a, '_, C> {
    /// A mesh at the origin, white, not lit, faces seen from behind dropped.
    #[must_use]
    pub const fn new(mesh: Mesh<'a, C>) -> Self {
        Self {
            mesh,
            model: Affine::IDENTITY,
            cull: Cull::Back,
            light: None,
            colour: [255; 3],
            texture: None,
        }
    }
}

/// What pass two needs of a draw call, kept once a call.
#[derive(Clone, Copy, Debug, Default)]
pub struct DrawState<'t> {
    /// The number of its first triangle.
    pub(crate) first: u16,
    pub(crate) texture: Option<&'t Texture<'t>>,
    pub(crate) budget: Budget,
    /// The texture's rows, if it is one of the squares that have loops of their own.
    square: Option<Square<'t>>,
}

impl<'t> DrawState<'t> {
    /// What fresh memory is filled with.
    pub const EMPTY: Self = Self {
        first: 0,
        texture: None,
        budget: Budget::BALANCED,
        square: None,
    };

    /// That of a call whose first triangle has this number.
    pub(crate) fn new(first: u16, skin: Option<&Skin<'_, 't>>) -> Self {
        let texture = skin.map(|skin| skin.texture);
        Self {
            first,
            texture,
            budget: skin.map_or(Self::EMPTY.budget, |skin| skin.budget),
            square: texture.and_then(Texture::square),
        }
    }

    /// The texture, if there is one, and how exact it is.
    #[inline(always)]
    pub(crate) fn texture(&self) -> Option<(&'t Texture<'t>, Budget)> {
        Some((self.texture?, self.budget))
    }

    /// The texture's rows, if it is one of the squares that have loops of their own.
    #[inline(always)]
    pub(crate) fn square(&self) -> Option<Square<'t>> {
        self.square
    }
}
