//! A look of one's own: a parameter of vertices as contour bands, as maps have them.

use crate::SPHERE;
use scanbeam::Mesh;
use scanbeam::look::{Shaded, Shader};
use scanbeam::pixel::{PixelFormat, Rgb565Be};

/// 16 bands from blue to red by the first parameter, a dark line between two of them and dots on every other one; as
/// bright as the second one says.
#[derive(Clone, Copy, Debug)]
pub struct Contours;

/// The look of them, as an SPI panel takes it.
pub type ContourLook = Shaded<Contours>;

impl Shader for Contours {
    type Pixel = Rgb565Be;

    fn pixel([height, bright, _]: [u16; 3], [column, line]: [u16; 2]) -> u16 {
        let (band, within) = ((height >> 12) as u8, height & 0xFFF);
        if within < 0x300 || band % 2 == 1 && (column | line) % 4 == 0 {
            return Rgb565Be::from_rgb8([12; 3]);
        }
        let light = |level: u8| ((u32::from(level) * u32::from(bright)) >> 16) as u8;
        Rgb565Be::from_rgb8([17 * band, 90, 255 - 17 * band].map(light))
    }
}

/// The height of each vertex of [`SPHERE`] above its lowest, and how far it is in front, 255 for the whole sphere.
static PARAMETERS: [[u8; 3]; SPHERE.positions.len()] = {
    const fn level(place: i16) -> u8 {
        (((place as i32 + (1 << 14)) * 255) >> 15) as u8
    }
    let mut parameters = [[0; 3]; SPHERE.positions.len()];
    let mut i = 0;
    while i < parameters.len() {
        let [_, y, z] = SPHERE.positions[i];
        parameters[i] = [level(y), level(z), 0];
        i += 1;
    }
    parameters
};

/// [`SPHERE`] with its parameters.
pub static CONTOURED: Mesh<'static> = Mesh {
    positions: SPHERE.positions,
    normals: &[],
    colours: &PARAMETERS,
    faces: SPHERE.faces,
};
