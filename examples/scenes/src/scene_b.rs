//! Scene B on the upright sphere: [`SPHERE`] with a texture of 128 x 128 once around it, the nearest texel,
//! in perspective.
//!
//! Each is there with the light of scene A and without any, and with places that keep 1/4 texel as
//! well as exact ones.

use crate::texels::{TEXEL_SIDE, TEXELS_565};
use crate::{SPHERE, Shot, ShotError, Suite};
use scanbeam::look::Look;
use scanbeam::scene::{Budget, Skin};
use scanbeam::{Draw, Scene};

/// A way to draw scene B.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SceneB {
    /// The name that reports use.
    pub name: &'static str,
    /// Whether the light of scene A falls on it; otherwise it shows its texels as they are.
    pub lit: bool,
    /// How far places on the texture may be off.
    pub budget: Budget,
}

/// All of them.
pub const SCENES_B: [SceneB; 4] = [
    scene("b_upright", true, Budget::BALANCED),
    scene("b_upright_exact", true, Budget::EXACT),
    scene("b_upright_unlit", false, Budget::BALANCED),
    scene("b_upright_unlit_exact", false, Budget::EXACT),
];

const fn scene(name: &'static str, lit: bool, budget: Budget) -> SceneB {
    SceneB { name, lit, budget }
}

/// The texture of scene B: [`TEXELS_565`] as an SPI panel takes it.
pub static TEXELS_PANEL: [u16; TEXELS_565.len()] = {
    let mut texels = TEXELS_565;
    let mut i = 0;
    while i < texels.len() {
        texels[i] = texels[i].to_be();
        i += 1;
    }
    texels
};

/// Vertices of the mesh.
const VERTICES_B: usize = 33 * 33;
/// Where the vertices of [`SPHERE`] lie on the texture, once around it and once from pole to pole.
pub(crate) static PLACES: [[i32; 2]; VERTICES_B] = {
    const STEP: i32 = TEXEL_SIDE as i32 * 256 / 32;
    let mut places = [[0; 2]; VERTICES_B];
    let mut i = 0;
    while i < VERTICES_B {
        places[i] = [(i % 33) as i32 * STEP, (i / 33) as i32 * STEP];
        i += 1;
    }
    places
};

impl SceneB {
    /// Draws it into `scene`, whose screen must be [`Shot::screen`].
    ///
    /// # Errors
    /// When the memory is smaller than [`VERTICES`](crate::VERTICES) and [`OBJECTS`](crate::OBJECTS), and when the look has no textures.
    pub fn build<L: Look>(self, scene: &mut Scene<'_, '_, L>) -> Result<(), ShotError> {
        let (camera, light) = Shot::sphere_camera()?;
        scene.begin(&camera)?;
        let skin = |texture| Skin {
            texture,
            places: &PLACES,
            budget: self.budget,
        };
        scene.draw(&Draw {
            light: light.filter(|_| self.lit),
            texture: Suite::B.texture().map(skin),
            ..Draw::new(SPHERE)
        })?;
        Ok(())
    }
}
