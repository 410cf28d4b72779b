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
///
/// ```
/// use scanbeam::scene::Master;
///
/// let late = Master { blend: false, dither: false, ..Master::ALL };
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Master {
    /// There is light, and corners have colours.
    pub shading: bool,
    /// Depths are compared.
    pub depth: bool,
    /// There are textures.
    pub texture: bool,
    /// There is what shines through.
    pub blend: bool,
    /// There is a dither.
    pub dither: bool,
    /// There are shadows.
    pub shadows: bool,
}

impl Master {
    /// Nothing is off.
    pub const ALL: Self = Self {
        shading: true,
        depth: true,
        texture: true,
        blend: true,
        dither: true,
        shadows: true,
    };

    /// What the texture of a call does to its colours, if there is one: a decal without transparent texels hides them,
    /// and so does any without shading.
    pub(super) fn applied<C>(self, draw: &Draw<'_, '_, C>) -> Option<Application> {
        let skin = draw.texture.as_ref().filter(|_| self.texture)?;
        match (draw.application, skin.texture.key()) {
            (Application::Decal, None) => Some(Application::Replace),
            (Application::Product, _) if !self.shading => Some(Application::Replace),
            (application, _) => Some(application),
        }
    }
}
