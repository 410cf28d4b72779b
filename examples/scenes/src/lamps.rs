//! The teapot with light at each pixel.

use crate::suite::Suite;
use crate::{Shot, ShotError};
use scanbeam::light::{DirectionalLight, Lighting, PixelLamps};
use scanbeam::look::Look;
use scanbeam::mesh::{Material, U1F15};
use scanbeam::{Draw, Scene};

/// A warm light from the right on what shines, as pixels of a shot see it.
///
/// # Errors
/// None: the camera sees.
pub fn teapot_lamps() -> Result<Option<PixelLamps>, ShotError> {
    let light = DirectionalLight::new([0.6, 0.8, 1.0], [1.0, 0.9, 0.8]);
    let ambient = [U1F15::from_bits(5_000); 3];
    let lighting = light.as_ref().and_then(|light| {
        let light = core::slice::from_ref(light);
        Lighting::new(light, ambient, Material::shiny(0.6, 30))
    });
    let camera = Suite::Teapot.view().camera()?;
    Ok(lighting.map(|lighting| PixelLamps::new(&lighting, &camera, Shot::screen())))
}

/// Draws the teapot of the suite in that light, by a look that has it.
///
/// # Errors
/// When the memory is smaller than the suite says.
pub fn lamplit_teapot<'t, L: Look>(
    lamps: &'t Option<PixelLamps>,
    scene: &mut Scene<'_, 't, L>,
) -> Result<(), ShotError> {
    scene
        .begin(&Suite::Teapot.view().camera()?)
        .map_err(ShotError::Begin)?;
    let call = Draw {
        light: None,
        lamps: lamps.as_ref(),
        ..Suite::Teapot.part(0).draw()
    };
    scene.draw(&call).map_err(ShotError::Draw)
}
