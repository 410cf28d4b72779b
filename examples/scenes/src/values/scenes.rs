//! What the small frames show: their draw calls, their textures and sprites.

use super::{PhongLook, TexturedPhongLook, values_screen};
use crate::ShotError;
use crate::contours::{CONTOURED, ContourLook};
use crate::looks::{SmoothLook, TexturedLook};
use crate::suite::{Looking, Suite, teapot_part};
use crate::{CUBE, PLACES_F, RIBBON, SPHERE, SURROUNDINGS, TEAPOT, TEXELS_F_PANEL};
use scanbeam::light::{DirectionalLight, Lighting, PixelLamps};
use scanbeam::look::Look;
use scanbeam::mesh::{Material, U1F15};
use scanbeam::overlay::Pixels;
use scanbeam::overlay::{Ink, Sprite};
use scanbeam::scene::{
    Application, Blend, BlendMode, Budget, DepthFunction, DepthTest, Draw, Factor, Scene, Scissor,
    Shading, Skin, TexGen, Texture,
};
use scanbeam::{Affine, Camera, Cull, Light, Mesh};

/// Who looks at it.
pub(super) fn camera() -> Result<Camera, ShotError> {
    let (eye, up) = ([0.6, 1.0, 2.8], [0.0, 1.0, 0.0]);
    Camera::look_at(eye, [0.0; 3], up, 140.0, 0.1, 100.0).map_err(ShotError::Camera)
}

pub(super) fn at(scale: f32, place: [f32; 3]) -> Affine {
    Affine::placed(scale, place).unwrap_or(Affine::IDENTITY)
}

/// A warm light from the right, as pixels see it.
pub(super) fn lamps() -> Result<Option<PixelLamps>, ShotError> {
    let light = DirectionalLight::new([0.6, 0.8, 1.0], [1.0, 0.9, 0.8]);
    let ambient = [U1F15::from_bits(5_000); 3];
    let lighting = light.as_ref().and_then(|light| {
        let light = core::slice::from_ref(light);
        Lighting::new(light, ambient, Material::shiny(0.6, 30))
    });
    let camera = camera()?;
    Ok(lighting.map(|lighting| PixelLamps::new(&lighting, &camera, values_screen())))
}

/// A mesh without colours of its own.
pub(super) fn uncoloured(mesh: Mesh<'static>) -> Mesh<'static> {
    Mesh {
        colours: &[],
        ..mesh
    }
}

/// Begins a scene and draws these calls.
pub(super) fn draw_all<'t, L: Look>(
    scene: &mut Scene<'_, 't, L>,
    calls: &[Draw<'_, 't>],
) -> Result<(), ShotError> {
    scene.begin(&camera()?).map_err(ShotError::Begin)?;
    for call in calls {
        scene.draw(call).map_err(ShotError::Draw)?;
    }
    Ok(())
}

/// A ball and a ribbon, and a smaller ball that is lit at its vertices.
pub(super) fn phong<'t>(
    scene: &mut Scene<'_, 't, PhongLook>,
    lamps: &'t Option<PixelLamps>,
) -> Result<(), ShotError> {
    let lamps = lamps.as_ref();
    let ball = Draw {
        model: Affine::rotation_x(0.5).then(&at(0.8, [-0.2, 0.1, 0.0])),
        colour: [200, 90, 60],
        lamps,
        ..Draw::new(SPHERE)
    };
    let ribbon = Draw {
        model: Affine::rotation_y(0.3).then(&at(1.0, [0.2, -0.3, 0.8])),
        cull: Cull::None,
        lamps,
        dither: true,
        ..Draw::new(uncoloured(RIBBON))
    };
    let smaller = Draw {
        model: at(0.3, [-0.9, -0.5, 0.6]),
        colour: [90, 160, 220],
        light: light(),
        ..Draw::new(SPHERE)
    };
    draw_all(scene, &[ball, ribbon, smaller])
}

/// A cube, a grille in front of it and a ball without texels; and a cube that is lit at its faces.
pub(super) fn texels<'t>(
    scene: &mut Scene<'_, 't, TexturedPhongLook>,
    lamps: &'t Option<PixelLamps>,
) -> Result<(), ShotError> {
    let lamps = lamps.as_ref();
    let cube = Draw {
        model: Affine::rotation_x(0.5)
            .then(&Affine::rotation_y(0.7).then(&at(0.5, [-0.3, 0.1, 0.0]))),
        texture: Some(Skin {
            texture: &PANEL,
            ..SKIN
        }),
        lamps,
        ..Draw::new(uncoloured(CUBE))
    };
    let grille = Draw {
        model: Affine::rotation_y(0.3).then(&at(0.3, [0.2, 0.3, 0.9])),
        cull: Cull::None,
        texture: Some(SKIN),
        colour: [250, 200, 90],
        dither: true,
        ..cube
    };
    let ball = Draw {
        model: at(0.4, [0.8, -0.3, 0.2]),
        texture: None,
        colour: [200, 90, 60],
        lamps,
        ..Draw::new(SPHERE)
    };
    let smaller = Draw {
        model: Affine::rotation_y(0.4).then(&at(0.25, [-0.9, -0.5, 0.6])),
        lamps: None,
        light: light(),
        shading: Shading::Flat,
        ..cube
    };
    draw_all(scene, &[cube, grille, ball, smaller])
}

/// A ball with contour bands, a corner of the picture left out.
pub(super) fn bands(scene: &mut Scene<'_, 'static, ContourLook>) -> Result<(), ShotError> {
    let ball = Draw {
        model: Affine::rotation_x(0.5).then(&at(0.9, [0.0, 0.1, 0.0])),
        scissor: Some(Scissor::outside(0..75, 0..40)),
        ..Draw::new(CONTOURED)
    };
    draw_all(scene, &[ball])
}

/// A teapot that is a mirror.
pub(super) fn mirror(scene: &mut Scene<'_, 'static, TexturedLook>) -> Result<(), ShotError> {
    let teapot = Draw {
        model: Affine::rotation_y(0.6),
        texture: Some(Skin {
            texture: &SURROUNDINGS,
            places: &[],
            budget: Budget::BALANCED,
        }),
        texgen: Some(TexGen::SPHERE),
        ..Draw::new(TEAPOT)
    };
    draw_all(scene, &[teapot])
}

/// What is transparent in [`GRILLE`]: no other texel is magenta.
const KEY: u16 = 0xF81F_u16.to_be();

/// The texture of scene F, every other square of which is transparent.
static GRILLE_TEXELS: [u16; 64 * 64] = {
    let mut texels = TEXELS_F_PANEL;
    let mut i = 0;
    while i < texels.len() {
        let (x, y) = (i % 64, i / 64);
        let is_rim = x < 2 || y < 2 || x >= 62 || y >= 62;
        if (x ^ y) & 8 == 0 && !is_rim {
            texels[i] = KEY;
        }
        i += 1;
    }
    texels
};

pub(super) static GRILLE: Texture<'static> = match Texture::words(&GRILLE_TEXELS, 64, 64) {
    Ok(texture) => texture.keyed(KEY),
    Err(_) => panic!("as many texels as the sides need"),
};

pub(super) static PANEL: Texture<'static> = match Texture::words(&TEXELS_F_PANEL, 64, 64) {
    Ok(texture) => texture,
    Err(_) => panic!("as many texels as the sides need"),
};

/// How the grille lies on a cube.
const SKIN: Skin<'static, 'static> = Skin {
    texture: &GRILLE,
    places: &PLACES_F,
    budget: Budget::BALANCED,
};

pub(super) fn light() -> Option<Light> {
    Light::new([0.3, 0.8, 0.6], 0.3)
}

/// A lit cube with holes around a ball, one whose holes its colours fill, and one that is not lit.
pub(super) fn holes(scene: &mut Scene<'_, 'static, TexturedLook>) -> Result<(), ShotError> {
    let cube = |angle: f32, scale: f32, place: [f32; 3]| Draw {
        model: Affine::rotation_y(angle).then(&at(scale, place)),
        cull: Cull::None,
        light: light(),
        texture: Some(SKIN),
        ..Draw::new(uncoloured(CUBE))
    };
    let ball = Draw {
        model: at(0.5, [-0.3, 0.1, 0.0]),
        colour: [250, 120, 40],
        light: light(),
        ..Draw::new(SPHERE)
    };
    let decal = Draw {
        application: Application::Decal,
        colour: [60, 200, 90],
        cull: Cull::Back,
        ..cube(0.9, 0.28, [0.75, -0.1, 0.6])
    };
    let plain = Draw {
        application: Application::Replace,
        ..cube(0.3, 0.22, [0.6, 0.75, 0.0])
    };
    draw_all(
        scene,
        &[cube(0.5, 0.6, [-0.3, 0.1, 0.0]), ball, decal, plain],
    )
}

/// A ball, a ribbon and a textured cube.
pub(super) fn dither(scene: &mut Scene<'_, 'static, TexturedLook>) -> Result<(), ShotError> {
    let ball = Draw {
        model: at(0.8, [-0.5, 0.1, 0.0]),
        colour: [90, 70, 60],
        light: light(),
        dither: true,
        ..Draw::new(SPHERE)
    };
    let ribbon = Draw {
        model: Affine::rotation_y(0.3).then(&at(1.0, [0.2, -0.3, 0.8])),
        cull: Cull::None,
        dither: true,
        ..Draw::new(RIBBON)
    };
    let skin = Skin {
        texture: &PANEL,
        ..SKIN
    };
    let cube = Draw {
        model: Affine::rotation_y(0.5).then(&at(0.45, [0.8, 0.2, -0.2])),
        light: Light::new([0.3, 0.8, 0.6], 0.1),
        texture: Some(skin),
        dither: true,
        ..Draw::new(uncoloured(CUBE))
    };
    draw_all(scene, &[ball, ribbon, cube])
}

/// Panes of all modes before a ribbon, a cube in two lights and a ribbon of flat faces, some of them cut; each by a
/// priority of its own if it `is_ranked`.
pub(super) fn blends(
    scene: &mut Scene<'_, 'static, SmoothLook>,
    is_ranked: bool,
) -> Result<(), ShotError> {
    let warm = DirectionalLight::new([0.3, 0.8, 0.6], [0.9, 0.8, 0.6]);
    let cold = DirectionalLight::new([-0.9, 0.1, 0.3], [0.1, 0.2, 0.5]);
    let lights = warm.zip(cold).map(|(warm, cold)| [warm, cold]);
    let ambient = [U1F15::from_bits(6_000); 3];
    let lighting = lights
        .as_ref()
        .and_then(|lights| Lighting::new(lights, ambient, Material::shiny(0.5, 20)));
    let open = Draw {
        cull: Cull::None,
        light: light(),
        ..Draw::new(RIBBON)
    };
    let back = Draw {
        mesh: CUBE,
        model: Affine::rotation_y(0.6).then(&at(0.7, [0.3, 0.0, -1.6])),
        light: None,
        lights: lighting.as_ref().map(|lighting| lighting as _),
        scissor: Some(Scissor::outside(70..90, 40..60)),
        ..open
    };
    let faceted = Draw {
        mesh: uncoloured(RIBBON),
        model: Affine::rotation_z(1.2).then(&at(0.9, [-0.9, 0.1, -0.4])),
        shading: Shading::Flat,
        colour: [210, 120, 90],
        depth: DepthTest::new(DepthFunction::NEARER),
        ..open
    };
    let mut calls = [open, back, faceted, open, open, open, open, open];
    let multiply = BlendMode::Factors {
        source: Factor::Destination,
        destination: Factor::Constant(60),
    };
    let modes = [
        Blend::filter(120),
        Blend::add(200).writing([true, true, false]),
        Blend::new(BlendMode::Subtract(90)),
        Blend::new(BlendMode::Half),
        Blend::new(multiply),
    ];
    for (i, (call, blend)) in (0u8..).zip(calls.iter_mut().skip(3).zip(modes)) {
        let angle = 0.9 * f32::from(i);
        let place = [0.45 * f32::from(i) - 0.9, 0.1 * f32::from(i), 0.2];
        let turned = Affine::rotation_x(angle).then(&Affine::rotation_y(2.0 * angle));
        *call = Draw {
            mesh: CUBE,
            model: turned.then(&at(0.3, place)),
            blend: Some(blend),
            scissor: (i == 3).then_some(Scissor::inside(0..130, 30..120)),
            ..open
        };
    }
    for (i, call) in (0u8..).zip(calls.iter_mut()) {
        call.priority = if is_ranked { (i * 5) % 8 + 1 } else { 0 };
    }
    draw_all(scene, &calls)
}

/// The teapot of the suite, at half the size.
pub(super) fn teapot(scene: &mut Scene<'_, 'static, SmoothLook>) -> Result<(), ShotError> {
    let view = Suite::Teapot.view();
    let half = Looking {
        focal: view.focal / 2.0,
        ..view
    };
    let camera = half.camera().map_err(ShotError::Camera)?;
    scene.begin(&camera).map_err(ShotError::Begin)?;
    let part = teapot_part();
    scene.draw(&part.draw()).map_err(ShotError::Draw)
}

/// A ball of which a part turns, with a cube that goes round it.
pub(super) fn ball(
    scene: &mut Scene<'_, 'static, SmoothLook>,
    moment: f32,
) -> Result<(), ShotError> {
    let ball = Draw {
        model: at(0.8, [-0.2, 0.1, 0.0]),
        colour: [90, 160, 220],
        light: light(),
        ..Draw::new(SPHERE)
    };
    let cube = Draw {
        model: Affine::rotation_y(1.0 + moment).then(&at(0.2, [0.6 + moment, -0.3, 0.8])),
        light: light(),
        ..Draw::new(CUBE)
    };
    draw_all(scene, &[ball, cube])
}

/// A bar across the picture, a cross that lets the picture through, and a light spot beyond the right edge.
pub(super) fn sprites() -> [Sprite<'static, u16>; 3] {
    static CROSS: [u16; 49] = {
        let mut cross = [0; 49];
        let mut i = 0;
        while i < 49 {
            if i % 7 == i / 7 || i % 7 == 6 - i / 7 {
                cross[i] = 0xFFE0_u16.to_be();
            }
            i += 1;
        }
        cross
    };
    let sprite = Sprite {
        x: -5,
        y: 4,
        width: 120,
        height: 6,
        pixels: Pixels::Colour(0x07E0_u16.to_be()),
        ink: Ink::Opaque,
    };
    [
        sprite,
        Sprite {
            x: 70,
            y: 50,
            width: 7,
            height: 7,
            pixels: Pixels::Image(&CROSS),
            ink: Ink::Keyed(0),
        },
        Sprite {
            x: 60,
            y: 70,
            height: 60,
            pixels: Pixels::Colour(0x30C6_u16.to_be()),
            ink: Ink::Additive,
            ..sprite
        },
    ]
}
