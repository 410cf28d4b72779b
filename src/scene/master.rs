//! What a supervisor has switched off, whatever draw calls ask for (H13).

use super::{Application, Draw};

/// What all draw calls of a scene have to do without: a load switch for a frame that would be late.
///
/// It is looked at once a draw call, by [`Scene::set_master`](super::Scene::set_master), so that whoever draws into a
/// scene that it is lent cannot switch on what is off. Whether a call is refused does not depend on it, but that the
/// memory lent for a volume's sides is not looked at where shadows are off.
///
/// | off | what is drawn |
/// |---|---|
/// | shading | one colour a call, that of the call; texels as they are |
/// | depth | calls over each other in the order in which they were submitted, or by their priorities |
/// | texture | colours alone |
/// | blend | what is clear is opaque |
/// | dither | the nearest step |
/// | shadows | all that a light reaches, as if nothing were between; also where depth is off |
///
/// ```
/// use scanbeam::scene::Master;
///
/// let late = Master::ALL.without(Master::BLEND).without(Master::DITHER);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Master(
    /// A bit for each that is off.
    u8,
);

impl Master {
    /// Nothing is off.
    pub const ALL: Self = Self(0);
    /// Nothing but light and colours of corners is off, for [`without`](Self::without); likewise the others.
    pub const SHADING: Self = Self(1);
    /// Comparisons of depth.
    pub const DEPTH: Self = Self(2);
    /// Textures.
    pub const TEXTURE: Self = Self(4);
    /// What shines through.
    pub const BLEND: Self = Self(8);
    /// Dither.
    pub const DITHER: Self = Self(16);
    /// Shadows.
    pub const SHADOWS: Self = Self(32);

    /// The same, and what is off in `off` is off as well.
    #[must_use]
    pub const fn without(self, off: Self) -> Self {
        Self(self.0 | off.0)
    }

    /// Whether one of these is on.
    pub(crate) const fn has(self, one: Self) -> bool {
        self.0 & one.0 == 0
    }

    /// What the texture of a call does to its colours, if there is one: a decal without transparent texels hides them,
    /// and so does any without shading.
    pub(super) fn applied<C>(self, draw: &Draw<'_, '_, C>) -> Option<Application> {
        let skin = draw.texture.as_ref().filter(|_| self.has(Self::TEXTURE))?;
        match (draw.application, skin.texture.key()) {
            (Application::Decal, None) => Some(Application::Replace),
            (Application::Product, _) if !self.has(Self::SHADING) => Some(Application::Replace),
            (application, _) => Some(application),
        }
    }
}
