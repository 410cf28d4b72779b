//! Alphas of vertices and of texels before a ball, texels that are added, and some that are not dithered (K11, H7, H10).

use super::scenes::{at, draw_all, light, uncoloured};
use crate::looks::TexturedLook;
use crate::{CUBE, PLACES_F, RIBBON, SPHERE, ShotError};
use scanbeam::scene::{
    Blend, BlendMode, Budget, Draw, Factor, MaskTexel, Scene, Shading, Skin, Texture,
};
use scanbeam::{Affine, Cull};

/// Texels a side.
const SIDE: usize = 32;

/// Rings about the middle, 0 to 15 from there.
static RINGS: [u8; SIDE * SIDE / 2] = {
    let mut bytes = [0; SIDE * SIDE / 2];
    let mut i = 0;
    while i < SIDE * SIDE {
        // Twice as far as from the middle, which lies between texels.
        let x = (2 * (i % SIDE)).abs_diff(SIDE - 1);
        let y = (2 * (i / SIDE)).abs_diff(SIDE - 1);
        let ring = (x * x + y * y) / 121;
        bytes[i / 2] |= (ring as u8) << (4 * (i % 2));
        i += 1;
    }
    bytes
};

/// Of each ring.
static COLOURS: [u16; 16] = {
    let mut colours = [0; 16];
    let mut i = 0;
    while i < 16 {
        let ring = i as u16;
        colours[i] = ((16 + ring) << 11 | (63 - 3 * ring) << 5 | (2 * ring)).to_be();
        i += 1;
    }
    colours
};

/// Clearer from the middle on, with rings of light; every other one is not dithered.
static MASKS: [u16; 16] = {
    let mut masks = [0; 16];
    let mut i = 0;
    while i < 16 {
        let mut texel = MaskTexel::alpha(255 - 15 * i as u8);
        if i % 5 == 4 {
            texel = texel.added();
        }
        if i % 2 == 1 {
            texel = texel.undithered();
        }
        masks[i] = texel.word();
        i += 1;
    }
    masks
};

static MASK: Texture<'static> = match Texture::index4(&RINGS, &MASKS, SIDE as u32, SIDE as u32) {
    Ok(texture) => texture,
    Err(_) => panic!("as many texels as the sides need"),
};

static TARGET: Texture<'static> = match Texture::index4(&RINGS, &COLOURS, SIDE as u32, SIDE as u32)
{
    Ok(texture) => match texture.masked(&MASK) {
        Ok(texture) => texture,
        Err(_) => panic!("the same bytes"),
    },
    Err(_) => panic!("as many texels as the sides need"),
};

/// From one vertex to the next.
static FADING: [u8; RIBBON.positions.len()] = {
    let mut alphas = [0; RIBBON.positions.len()];
    let mut i = 0;
    while i < alphas.len() {
        alphas[i] = (i * 255 / (alphas.len() - 1)) as u8;
        i += 1;
    }
    alphas
};

/// Of a cube, whose corners fade towards the eye.
static CORNERS: [u8; CUBE.positions.len()] = {
    let mut alphas = [0; CUBE.positions.len()];
    let mut i = 0;
    while i < alphas.len() {
        alphas[i] = (40 + i * 61 % 200) as u8;
        i += 1;
    }
    alphas
};

/// A ribbon that fades and a dithered cube of rings before a ball, a cube of both that the near plane cuts, and one of flat
/// faces by factors.
pub(super) fn alpha(scene: &mut Scene<'_, 'static, TexturedLook>) -> Result<(), ShotError> {
    let ball = Draw {
        model: at(0.6, [-0.2, 0.1, -0.6]),
        colour: [250, 140, 50],
        light: light(),
        ..Draw::new(SPHERE)
    };
    let ribbon = Draw {
        model: Affine::rotation_y(0.3).then(&at(1.1, [0.1, -0.2, 0.3])),
        cull: Cull::None,
        alphas: &FADING,
        blend: Some(Blend::ALPHA),
        ..Draw::new(RIBBON)
    };
    let rings = Draw {
        model: Affine::rotation_y(0.5).then(&at(0.4, [0.7, 0.1, 0.5])),
        cull: Cull::None,
        light: light(),
        texture: Some(Skin {
            texture: &TARGET,
            places: &PLACES_F,
            budget: Budget::BALANCED,
        }),
        blend: Some(Blend::ALPHA),
        dither: true,
        ..Draw::new(uncoloured(CUBE))
    };
    let cut = Draw {
        model: Affine::rotation_y(0.9).then(&at(0.4, [0.1, 0.9, 2.5])),
        alphas: &CORNERS,
        blend: Some(Blend::filter(120)),
        ..rings
    };
    let flat = Draw {
        model: Affine::rotation_x(0.6).then(&at(0.3, [-0.9, 0.2, 0.6])),
        texture: None,
        alphas: &CORNERS,
        shading: Shading::Flat,
        blend: Some(Blend::new(BlendMode::Factors {
            source: Factor::SourceAlpha,
            destination: Factor::InverseSourceAlpha,
        })),
        ..rings
    };
    draw_all(scene, &[ribbon, ball, rings, cut, flat])
}
