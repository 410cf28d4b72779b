//! The scenes of the suite in the rooms `scene`, `look` and `frame`.

use crate::suite::Suite;
use crate::{TEXELS_F_PANEL, TEXELS_PANEL};
use scanbeam::CameraError;
use scanbeam::look::{Gouraud, Look, Textured};
use scanbeam::pixel::Rgb565Be;
use scanbeam::scene::{
    BeginError, Budget, CacheError, Draw, DrawError, Scene, Skin, Texture, TextureError,
};

/// What they are drawn with: smooth colours, as an SPI panel takes them.
pub type LeanLook = Gouraud<Rgb565Be>;

/// What those with a texture are drawn with.
pub type LeanTextured = Textured<Rgb565Be>;

/// Their names, and which scene each is.
pub const LEAN: [(&str, Suite); 9] = [
    ("lean_a", Suite::A),
    ("lean_b", Suite::B),
    ("lean_b_unlit", Suite::BUnlit),
    ("lean_c_f2n", Suite::FarToNear),
    ("lean_c_n2f", Suite::NearToFar),
    ("lean_f", Suite::F),
    ("lean_g", Suite::G),
    ("lean_teapot", Suite::Teapot),
    ("lean_inside", Suite::Inside),
];

/// Draw calls that suffice for each of them.
pub const LEAN_DRAWS: usize = 27;

/// The textures of scenes B and F.
static TEXTURES: [Texture<'static>; 2] =
    [texture(&TEXELS_PANEL, 128), texture(&TEXELS_F_PANEL, 64)];

const fn texture(texels: &'static [u16], side: u32) -> Texture<'static> {
    match Texture::words(texels, side, side) {
        Ok(texture) => texture,
        Err(_) => panic!("as many texels as the sides need"),
    }
}

/// Why a scene was not made.
#[derive(Clone, Copy, Debug)]
pub enum LeanError {
    /// Its camera cannot be made.
    Camera(CameraError),
    /// It was not begun.
    Begin(BeginError),
    /// A part was not drawn.
    Draw(DrawError),
    /// A texture, or a level of detail, was not made.
    Texture(TextureError),
    /// A cache of a texture was not made.
    Cache(CacheError),
    /// Sprites are not in order.
    Sprites,
}

impl Suite {
    /// Draws it into `scene`, whose screen must be [`Shot::screen`](crate::Shot::screen), with its texture where the look
    /// has any, within 1/4 texel.
    ///
    /// # Errors
    /// When the memory is less than [`SUITE_VERTICES`](crate::SUITE_VERTICES),
    /// [`SUITE_OBJECTS`](crate::SUITE_OBJECTS), [`LEAN_DRAWS`] and a bin a line.
    pub fn build_lean<L: Look>(self, scene: &mut Scene<'_, '_, L>) -> Result<(), LeanError> {
        let camera = self.view().camera().map_err(LeanError::Camera)?;
        scene.begin(&camera).map_err(LeanError::Begin)?;
        let texture = match self {
            Self::B | Self::BUnlit => Some(&TEXTURES[0]),
            Self::F => Some(&TEXTURES[1]),
            _ => None,
        };
        for index in 0..self.parts() {
            let part = self.part(index);
            let call = Draw {
                model: part.instance.model,
                cull: part.instance.cull,
                light: part.instance.light,
                colour: part.instance.colour,
                texture: texture.map(|texture| Skin {
                    texture,
                    places: part.places,
                    budget: Budget::BALANCED,
                }),
                ..Draw::new(part.mesh)
            };
            scene.draw(&call).map_err(LeanError::Draw)?;
        }
        Ok(())
    }
}
