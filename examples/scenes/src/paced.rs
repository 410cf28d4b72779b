//! Scenes of the suite from elsewhere, whose lines cost no more than they may, and what is paid for that.

use crate::suite::Looking;
use crate::{ShotError, Suite};
use scanbeam::frame::Pace;
use scanbeam::look::Look;
use scanbeam::scene::{Budget, Skin};
use scanbeam::{Draw, Scene};

/// A scene of the suite as another eye sees it, and what its lines may cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paced {
    /// Its name as a frame.
    pub name: &'static str,
    /// The scene.
    pub suite: Suite,
    /// Where the eye is.
    pub eye: [f32; 3],
    /// What a line may cost.
    pub pace: Pace,
}

impl Eq for Paced {}

/// Eyes that no other frame has.
const TEAPOT_EYE: [f32; 3] = [2.0, 0.4, 1.2];
const INSIDE_EYE: [f32; 3] = [-0.3, 0.5, 0.4];
const B_EYE: [f32; 3] = [0.3, 2.6, -2.4];
const F_EYE: [f32; 3] = [1.2, -2.6, 2.3];

/// Those scenes, as frames: with the costs of M4 code, then with those of M0+ code.
pub const PACED: [Paced; 8] = [
    Paced::new("teapot_paced", Suite::Teapot, TEAPOT_EYE, 30_000),
    Paced::new("inside_paced", Suite::Inside, INSIDE_EYE, 40_000),
    Paced::new("b_paced", Suite::B, B_EYE, 30_000),
    Paced::new("f_paced", Suite::F, F_EYE, 30_000),
    Paced::new("teapot_paced_m0", Suite::Teapot, TEAPOT_EYE, 50_000).in_m0_code(),
    Paced::new("inside_paced_m0", Suite::Inside, INSIDE_EYE, 65_000).in_m0_code(),
    Paced::new("b_paced_m0", Suite::B, B_EYE, 50_000).in_m0_code(),
    Paced::new("f_paced_m0", Suite::F, F_EYE, 50_000).in_m0_code(),
];

impl Paced {
    const fn new(name: &'static str, suite: Suite, eye: [f32; 3], most: u32) -> Self {
        let costs = match suite {
            Suite::B | Suite::F => Pace::TEXTURED_M4,
            _ => Pace::GOURAUD_M4,
        };
        Self {
            name,
            suite,
            eye,
            pace: Pace { most, ..costs },
        }
    }

    const fn in_m0_code(self) -> Self {
        let costs = match self.suite {
            Suite::B | Suite::F => Pace::TEXTURED_M0,
            _ => Pace::GOURAUD_M0,
        };
        let most = self.pace.most;
        Self {
            pace: Pace { most, ..costs },
            ..self
        }
    }

    /// Whether its costs are those of M0+ code.
    #[must_use]
    pub fn is_in_m0_code(&self) -> bool {
        self.name.ends_with("_m0")
    }

    /// Draws it into `scene`, as [`Suite::build`] does.
    ///
    /// # Errors
    /// As there.
    pub fn build<L: Look>(self, scene: &mut Scene<'_, '_, L>) -> Result<(), ShotError> {
        let looking = Looking {
            eye: self.eye,
            ..self.suite.view()
        };
        scene.begin(&looking.camera()?)?;
        for index in 0..self.suite.parts() {
            let part = self.suite.part(index);
            let skin = |texture| Skin {
                texture,
                places: part.places,
                budget: Budget::BALANCED,
            };
            scene.draw(&Draw {
                texture: self.suite.texture().map(skin),
                ..part.draw()
            })?;
        }
        Ok(())
    }
}
