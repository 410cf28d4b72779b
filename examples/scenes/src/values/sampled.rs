//! A floor in levels of detail that reaches to the horizon, balls of small triangles in such levels, and cubes near enough
//! to show single texels: one whose texels are mixed, one whose are not, and one with holes (H6).

use super::scenes::{GRILLE, PANEL, at, draw_all, light, uncoloured};
use crate::ShotError;
use crate::looks::TexturedLook;
use crate::scene_b::PLACES;
use crate::{CUBE, PLACES_F, SPHERE};
use scanbeam::look::halved;
use scanbeam::pixel::Rgb565Be;
use scanbeam::scene::{Budget, Draw, Sampling, Scene, Skin, Texture};
use scanbeam::{Affine, Cull, Faces, Mesh, mesh::QuadSplit};

const ONE: i16 = 1 << 14;

const FLOOR: Mesh<'static> = Mesh {
    positions: &[
        [-ONE, 0, -ONE],
        [ONE, 0, -ONE],
        [ONE, 0, ONE],
        [-ONE, 0, ONE],
    ],
    normals: &[],
    colours: &[],
    faces: Faces::Quads(&[[3, 2, 1, 0]], QuadSplit::Corner0To2),
};

/// The texture twelve times each way, in texels with 8 fraction bits.
const FAR: i32 = 12 * 64 * 256;
const FLOOR_PLACES: [[i32; 2]; 4] = [[0, FAR], [FAR, FAR], [FAR, 0], [0, 0]];

/// Words of four levels below 64 x 64 texels.
pub(super) type Words = ([u16; 1024], [u16; 256], [u16; 64], [u16; 16]);

/// The levels below the texture of the floor.
pub(super) fn levels(words: &mut Words) -> Result<[Texture<'_>; 4], ShotError> {
    let half = |texture: &Texture<'_>, words| {
        halved::<Rgb565Be>(texture, words).map_err(ShotError::Texture)
    };
    let first = half(&PANEL, &mut words.0)?;
    let second = half(&first, &mut words.1)?;
    let third = half(&second, &mut words.2)?;
    let fourth = half(&third, &mut words.3)?;
    Ok([first, second, third, fourth])
}

/// The textures: in levels, in levels that are mixed, mixed, and mixed with holes.
pub(super) fn textures<'t>(levels: &'t [Texture<'t>]) -> Result<[Texture<'t>; 4], ShotError> {
    let of = |texture: Texture<'t>, sampling, levels| {
        texture
            .sampled(sampling, levels)
            .map_err(ShotError::Texture)
    };
    Ok([
        of(PANEL, Sampling::NEAREST, levels)?,
        of(PANEL, Sampling::LINEAR, levels)?,
        of(PANEL, Sampling::LINEAR, &[])?,
        of(GRILLE, Sampling::LINEAR, &[])?,
    ])
}

/// A floor so far to the right.
pub(super) fn floor<'t>(texture: &'t Texture<'t>, x: f32) -> Draw<'static, 't> {
    Draw {
        model: at(6.0, [x, -0.5, -4.0]),
        texture: Some(Skin {
            texture,
            places: &FLOOR_PLACES,
            budget: Budget::BALANCED,
        }),
        ..Draw::new(FLOOR)
    }
}

/// A cube at a place, turned about the vertical.
pub(super) fn cube<'t>(texture: &'t Texture<'t>, angle: f32, place: [f32; 3]) -> Draw<'static, 't> {
    Draw {
        model: Affine::rotation_y(angle).then(&at(0.3, place)),
        cull: Cull::None,
        light: light(),
        texture: Some(Skin {
            texture,
            places: &PLACES_F,
            budget: Budget::EXACT,
        }),
        ..Draw::new(uncoloured(CUBE))
    }
}

/// A ball of small triangles at a place, of so much of its size.
fn ball<'t>(texture: &'t Texture<'t>, size: f32, place: [f32; 3]) -> Draw<'static, 't> {
    Draw {
        model: at(size, place),
        texture: Some(Skin {
            texture,
            places: &PLACES,
            budget: Budget::BALANCED,
        }),
        ..Draw::new(uncoloured(SPHERE))
    }
}

/// Makes the scene.
pub(super) fn sampled<'t>(
    scene: &mut Scene<'_, 't, TexturedLook>,
    [near, mixed, sharp, holes]: &'t [Texture<'t>; 4],
) -> Result<(), ShotError> {
    let calls = [
        floor(near, -6.0),
        floor(mixed, 6.0),
        cube(sharp, 0.5, [-0.1, 0.0, 1.2]),
        cube(&PANEL, 0.9, [0.8, 0.2, 0.8]),
        cube(holes, 0.2, [-0.7, 0.3, 0.6]),
        ball(near, 0.45, [-0.3, 0.75, -1.0]),
        ball(near, 0.2, [0.55, 0.75, -0.5]),
    ];
    draw_all(scene, &calls)
}
