//! A ball and a cube of flat faces, whose light is a place on a ramp, over water, and two octahedra of a list, one of them
//! in a number of its own: indices, and a palette for each line (H18).

use super::octahedron::{numbered, octahedron};
use super::scenes::{at, light, uncoloured};
use super::{IndexedLook, VALUES_HEIGHT, scenes::draw_all};
use crate::ShotError;
use crate::{CUBE, SPHERE};
use scanbeam::Affine;
use scanbeam::pixel::{Index8, PixelFormat, Rgb565Be};
use scanbeam::scene::{Draw, Scene, Shading};

/// A ramp above the water and one below it, and a sky that changes from line to line.
pub(super) struct Dusk([[u16; 256]; 2]);

impl Dusk {
    pub(super) fn new() -> Self {
        let ramp = |[r, g, b]: [u16; 3]| {
            core::array::from_fn(|i| {
                let level = |full: u16| (i as u16 * full / 255) as u8;
                Rgb565Be::from_rgb8([level(r), level(g), level(b)])
            })
        };
        Self([ramp([255, 190, 110]), ramp([40, 150, 210])])
    }

    /// The palette of a line.
    pub(super) fn palette(&mut self, line: u16) -> &[u16; 256] {
        let high = (3 * (VALUES_HEIGHT - line.min(VALUES_HEIGHT)) / 2) as u8;
        let water = usize::from(line >= VALUES_HEIGHT / 2);
        let palette = &mut self.0[water];
        palette[0] = match water {
            0 => Rgb565Be::from_rgb8([240 - high / 2, 120, high]),
            _ => Rgb565Be::from_rgb8([0, high / 2, 40 + high]),
        };
        palette
    }
}

/// Makes the scene.
pub(super) fn dusk(scene: &mut Scene<'_, 'static, IndexedLook>) -> Result<(), ShotError> {
    let ball = Draw {
        model: at(0.7, [-0.5, 0.1, 0.0]),
        light: light(),
        colour: Index8::colour(255),
        ..Draw::new(SPHERE)
    };
    let cube = Draw {
        model: Affine::rotation_y(0.6).then(&at(0.45, [0.9, -0.2, 0.3])),
        mesh: uncoloured(CUBE),
        shading: Shading::Flat,
        ..ball
    };
    draw_all(scene, &[ball, cube])?;
    let turned = |place| Affine::rotation_x(0.4).then(&at(0.3, place));
    let lit = Draw {
        model: turned([0.1, 0.75, 0.5]),
        ..cube
    };
    octahedron(scene, &lit, &[])?;
    let model = turned([0.25, -0.3, 1.0]);
    numbered(scene, &Draw { model, ..cube })
}
