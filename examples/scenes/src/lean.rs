//! The scenes of the suite that have no texture, in the rooms `scene`, `look` and `frame`.

use crate::suite::Suite;
use scanbeam::look::{Gouraud, Look};
use scanbeam::scene::{BeginError, Draw, DrawError, Scene};
use scanbeam::{CameraError, Rgb565Be};

/// What they are drawn with: smooth colours, as an SPI panel takes them.
pub type LeanLook = Gouraud<Rgb565Be>;

/// Their names, and which scene each is.
pub const LEAN: [(&str, Suite); 6] = [
    ("lean_a", Suite::A),
    ("lean_c_f2n", Suite::FarToNear),
    ("lean_c_n2f", Suite::NearToFar),
    ("lean_g", Suite::G),
    ("lean_teapot", Suite::Teapot),
    ("lean_inside", Suite::Inside),
];

/// Draw calls that suffice for each of them.
pub const LEAN_DRAWS: usize = 16;

/// Why a scene was not made.
#[derive(Clone, Copy, Debug)]
pub enum LeanError {
    /// Its camera cannot be made.
    Camera(CameraError),
    /// It was not begun.
    Begin(BeginError),
    /// A part was not drawn.
    Draw(DrawError),
}

impl Suite {
    /// Draws it into `scene`, whose screen must be [`Shot::screen`](crate::Shot::screen), without its texture.
    ///
    /// # Errors
    /// When the memory is less than [`SUITE_VERTICES`](crate::SUITE_VERTICES),
    /// [`SUITE_OBJECTS`](crate::SUITE_OBJECTS), [`LEAN_DRAWS`] and a bin a line.
    pub fn build_lean<L: Look>(self, scene: &mut Scene<'_, '_, L>) -> Result<(), LeanError> {
        let camera = self.view().camera().map_err(LeanError::Camera)?;
        scene.begin(&camera).map_err(LeanError::Begin)?;
        for index in 0..self.parts() {
            let part = self.part(index);
            let call = Draw {
                model: part.instance.model,
                cull: part.instance.cull,
                light: part.instance.light,
                colour: part.instance.colour,
                ..Draw::new(part.mesh)
            };
            scene.draw(&call).map_err(LeanError::Draw)?;
        }
        Ok(())
    }
}
