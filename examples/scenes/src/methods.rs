//! A small scene of small triangles and of large ones: a ribbon in a room around the eye.

use crate::{CUBE, RIBBON, ShotError};
use scanbeam::look::Look;
use scanbeam::{Affine, Camera, Cull, Draw, Light, Mesh, Scene, Screen};

/// Pixels a line of it.
pub const METHOD_WIDTH: u16 = 64;
/// Lines of it.
pub const METHOD_HEIGHT: u16 = 48;

/// The size of it.
#[must_use]
pub fn method_screen() -> Screen {
    match Screen::new(METHOD_WIDTH, METHOD_HEIGHT) {
        Ok(screen) => screen,
        // A size within the limits.
        Err(_) => unreachable!(),
    }
}

/// Draws a ribbon of small triangles in a coloured room of large ones around the eye.
///
/// # Errors
/// When the scene's memory is smaller than 256 vertices and objects.
pub fn build_method<L: Look>(scene: &mut Scene<'_, '_, L>) -> Result<(), ShotError> {
    let camera = Camera::look_at([0.4, 0.5, 1.6], [0.0; 3], [0.0, 1.0, 0.0], 50.0, 0.1, 100.0)?;
    scene.begin(&camera)?;
    let ribbon = Draw {
        cull: Cull::None,
        model: Affine::rotation_y(0.4),
        light: Light::new([0.3, 0.8, 0.6], 0.3),
        ..Draw::new(RIBBON)
    };
    scene.draw(&ribbon)?;
    let room = Affine::placed(4.0, [0.3, 0.2, 0.1]).unwrap_or(Affine::IDENTITY);
    // Walls whose colours change from corner to corner.
    let walls = Mesh {
        colours: &WALLS,
        ..CUBE
    };
    scene.draw(&Draw {
        mesh: walls,
        model: Affine::rotation_y(0.7).then(&room),
        light: None,
        ..ribbon
    })?;
    Ok(())
}

/// Colours of the room's 24 corners.
static WALLS: [[u8; 3]; 24] = {
    let mut colours = [[0; 3]; 24];
    let mut i = 0;
    while i < 24 {
        let k = i * 5 + i / 4;
        colours[i] = [
            if k & 1 == 1 { 255 } else { 0 },
            if k & 2 == 2 { 255 } else { 20 },
            if k & 4 == 4 { 255 } else { 0 },
        ];
        i += 1;
    }
    colours
};
