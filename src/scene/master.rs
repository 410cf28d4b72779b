//! What a supervisor has switched off, whatever draw calls ask for (H13).

use super::{Application, Draw};

/// What all draw calls of a scene have to do without: a load switch for a frame that would be late.
///
/// It is looked at once a draw call, by [`Scene::set_master`](super::Scene::set_master), so that whoever draws into a
/// scene that it is lent cannot switch on what is off. Whether a call is refused does not depend on it.
///
/// | off | what is drawn |
/// |---|---|
/// | shading | one colour a call, that of the call; texels as they are |
/// | depth | calls over each other in the order in which they were submitted, or by their priorities |
/// | texture | colours alone |
/// | blend | what is clear is opaque |
/// | dither | the nearest step |
/// | shadows | all that a light reaches, as if nothing were between; also where depth is off |
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Master(u8);

impl Master {
    /// Nothing is off.
    pub const ALL: Self = Self(0);

    const SHADING: u8 = 1;
    const DEPTH: u8 = 2;
    const TEXTURE: u8 = 4;
    const BLEND: u8 = 8;
    const DITHER: u8 = 16;
    const SHADOWS: u8 = 32;

    /// The same without light and colours of corners.
    #[must_use]
    pub const fn without_shading(self) -> Self {
        Self(self.0 | Self::SHADING)
    }

    /// The same without comparisons of depth.
    #[must_use]
    pub const fn without_depth(self) -> Self {
        Self(self.0 | Self::DEPTH)
    }

    /// The same without textures.
    #[must_use]
    pub const fn without_texture(self) -> Self {
        Self(self.0 | Self::TEXTURE)
    }

    /// The same without what shines through.
    #[must_use]
    pub const fn without_blend(self) -> Self {
        Self(self.0 | Self::BLEND)
    }

    /// The same without dither.
    #[must_use]
    pub const fn without_dither(self) -> Self {
        Self(self.0 | Self::DITHER)
    }

    /// The same without shadows.
    #[must_use]
    pub const fn without_shadows(self) -> Self {
        Self(self.0 | Self::SHADOWS)
    }

    const fn has(self, bit: u8) -> bool {
        self.0 & bit == 0
    }

    /// Whether there is light, and corners have colours.
    pub(super) const fn has_shading(self) -> bool {
        self.has(Self::SHADING)
    }

    /// Whether depths are compared.
    pub(crate) const fn has_depth(self) -> bool {
        self.has(Self::DEPTH)
    }

    pub(super) const fn has_texture(self) -> bool {
        self.has(Self::TEXTURE)
    }

    pub(super) const fn has_blend(self) -> bool {
        self.has(Self::BLEND)
    }

    pub(super) const fn has_dither(self) -> bool {
        self.has(Self::DITHER)
    }

    pub(super) const fn has_shadows(self) -> bool {
        self.has(Self::SHADOWS)
    }

    /// What the texture of a call does to its colours, if there is one: a decal without transparent texels hides them,
    /// and so does any without shading.
    pub(super) fn applied<C>(self, draw: &Draw<'_, '_, C>) -> Option<Application> {
        let skin = draw.texture.as_ref().filter(|_| self.has_texture())?;
        match (draw.application, skin.texture.key()) {
            (Application::Decal, None) => Some(Application::Replace),
            (Application::Product, _) if !self.has_shading() => Some(Application::Replace),
            (application, _) => Some(application),
        }
    }
}
