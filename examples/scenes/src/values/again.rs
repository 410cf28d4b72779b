//! Textured cubes that are drawn again where they are as far as before: one is lit by a second call, one has its texture
//! added by one, and one is seen through, twice.

use super::scenes::{PANEL, at, draw_all, light, uncoloured};
use crate::looks::TexturedLook;
use crate::{CUBE, PLACES_F, ShotError};
use scanbeam::scene::{
    Blend, BlendMode, Budget, DepthFunction, DepthTest, Draw, Factor, Scene, Skin,
};
use scanbeam::{Affine, Cull};

/// A cube so near that its texels are in perspective.
fn cube(angle: f32, scale: f32, place: [f32; 3]) -> Draw<'static, 'static> {
    Draw {
        model: Affine::rotation_x(0.4).then(&Affine::rotation_y(angle).then(&at(scale, place))),
        cull: Cull::Back,
        texture: Some(Skin {
            texture: &PANEL,
            places: &PLACES_F,
            budget: Budget::BALANCED,
        }),
        ..Draw::new(uncoloured(CUBE))
    }
}

/// Where it is as far as what is there, and nothing is kept.
fn equal() -> DepthTest {
    DepthTest::new(DepthFunction::EQUAL).without_write()
}

/// A cube and its light, a cube and its texture, and one that is drawn twice over them.
pub(super) fn again(scene: &mut Scene<'_, 'static, TexturedLook>) -> Result<(), ShotError> {
    let first = cube(0.5, 0.62, [-0.5, 0.1, 0.9]);
    // All that is there times the light: what is missed stays as it was.
    let lit = Draw {
        texture: None,
        light: light(),
        depth: equal(),
        blend: Some(Blend::new(BlendMode::Factors {
            source: Factor::Destination,
            destination: Factor::ZERO,
        })),
        ..first
    };
    let second = Draw {
        texture: None,
        colour: [30, 60, 20],
        ..cube(1.1, 0.4, [0.75, 0.3, 0.8])
    };
    let added = Draw {
        depth: equal(),
        blend: Some(Blend::add(160)),
        ..cube(1.1, 0.4, [0.75, 0.3, 0.8])
    };
    let through = Draw {
        blend: Some(Blend::filter(120)),
        ..cube(0.2, 0.3, [0.35, -0.35, 1.3])
    };
    draw_all(scene, &[first, lit, second, added, through, through])
}
