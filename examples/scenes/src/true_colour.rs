//! Scenes of the suite in pixels of 24 bits.

use crate::suite::texture;
use crate::{ShotError, Suite, TEXEL_SIDE, TEXEL_SIDE_F, TEXELS_565, TEXELS_F};
use scanbeam::Scene;
use scanbeam::look::Look;
use scanbeam::scene::{Budget, Draw, Skin, Texture};

/// By name: smooth, textures in light, and textures in perspective.
pub const TRUE_COLOUR: [(&str, Suite); 3] = [
    ("a_888", Suite::A),
    ("b_888", Suite::B),
    ("f_888", Suite::F),
];

/// The textures of scenes B and F as numbers, which such looks take.
static TEXTURES: [Texture<'static>; 2] = [
    texture(&TEXELS_565, TEXEL_SIDE),
    texture(&TEXELS_F, TEXEL_SIDE_F),
];

/// Draws a scene as [`Suite::build`] does.
///
/// # Errors
/// As that.
pub fn build_true_colour<L: Look>(
    suite: Suite,
    scene: &mut Scene<'_, '_, L>,
) -> Result<(), ShotError> {
    scene.begin(&suite.view().camera()?)?;
    let texture = match suite {
        Suite::B | Suite::BUnlit => Some(&TEXTURES[0]),
        Suite::F => Some(&TEXTURES[1]),
        _ => None,
    };
    for part in (0..suite.parts()).map(|index| suite.part(index)) {
        let skin = |texture| Skin {
            texture,
            places: part.places,
            budget: Budget::BALANCED,
        };
        scene.draw(&Draw {
            texture: texture.map(skin),
            ..part.draw()
        })?;
    }
    Ok(())
}
