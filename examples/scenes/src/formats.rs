//! Scenes in pixels that are not those of an SPI panel.
//!
//! | name | what it shows |
//! |---|---|
//! | `a_888`, `b_888`, `f_888` | smooth colours, textures in light and in perspective, in bytes |
//! | `slivers_888` | triangles too thin for planes, in bytes |
//! | `lit_888` | cubes and a ball that are lit at each pixel, behind a pane, in bytes |
//! | `lit_xrgb` | the same, in words of 32 bits |
//! | `smooth_grey` | a ball, flat faces and a pane of grey |
//! | `smooth_565` | the same, in numbers of 16 bits |
//! | `c_565` | flat faces that fill the picture, in numbers of 16 bits |

use crate::suite::texture;
use crate::{
    CUBE, PLACES_F, SPHERE, ShotError, Suite, TEXEL_SIDE, TEXEL_SIDE_F, TEXELS_565, TEXELS_F,
};
use scanbeam::light::PixelLamps;
use scanbeam::look::Look;
use scanbeam::scene::{Blend, Budget, Draw, Shading, Skin, Texture};
use scanbeam::{Affine, Light, Mesh, Scene};

/// A scene, and what its pixels are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InFormat {
    /// A scene of the suite in bytes.
    Suite(Suite),
    /// A scene of the suite without textures in numbers.
    SuiteNumbers(Suite),
    /// Triangles that are too thin for planes, in bytes.
    Slivers,
    /// Light at each pixel, in bytes.
    LitBytes,
    /// The same in words.
    LitWords,
    /// Smooth grey.
    Grey,
    /// Smooth colours in numbers.
    Numbers,
}

/// Their names, and which scene each is.
pub const IN_FORMATS: [(&str, InFormat); 9] = [
    ("a_888", InFormat::Suite(Suite::A)),
    ("b_888", InFormat::Suite(Suite::B)),
    ("f_888", InFormat::Suite(Suite::F)),
    ("slivers_888", InFormat::Slivers),
    ("lit_888", InFormat::LitBytes),
    ("lit_xrgb", InFormat::LitWords),
    ("smooth_grey", InFormat::Grey),
    ("smooth_565", InFormat::Numbers),
    ("c_565", InFormat::SuiteNumbers(Suite::NearToFar)),
];

/// The textures of scenes B and F as numbers, which such looks take.
static TEXTURES: [Texture<'static>; 2] = [
    texture(&TEXELS_565, TEXEL_SIDE),
    texture(&TEXELS_F, TEXEL_SIDE_F),
];

/// Draws a scene of the suite as [`Suite::build`] does.
///
/// # Errors
/// As that.
pub fn build_in_format<L: Look>(
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

/// A ball; flat faces behind it, and a pane of flat faces before it.
fn parts() -> [Draw<'static, 'static>; 3] {
    let place = |scale, at| Affine::placed(scale, at).unwrap_or(Affine::IDENTITY);
    let light = Light::new([0.3, 0.8, 0.6], 0.3);
    let turned = Affine::rotation_x(0.5).then(&Affine::rotation_y(0.7));
    let ball = Draw {
        model: place(0.6, [0.3, 0.4, 0.2]),
        colour: [200, 90, 60],
        light,
        ..Draw::new(SPHERE)
    };
    let cube = Draw {
        model: turned.then(&place(0.4, [-0.6, 0.5, 0.0])),
        shading: Shading::Flat,
        colour: [230, 220, 190],
        light,
        ..Draw::new(Mesh {
            colours: &[],
            ..CUBE
        })
    };
    let pane = Draw {
        model: turned.then(&place(0.25, [0.0, 0.2, 1.0])),
        colour: [60, 160, 230],
        blend: Some(Blend::filter(150)),
        ..cube
    };
    [ball, cube, pane]
}

/// Draws smooth and flat faces, and a pane.
///
/// # Errors
/// When the memory is smaller than the suite says.
pub fn build_smooth<L: Look>(scene: &mut Scene<'_, '_, L>) -> Result<(), ShotError> {
    scene.begin(&Suite::Teapot.view().camera()?)?;
    for part in parts() {
        scene.draw(&part)?;
    }
    Ok(())
}

/// Draws the same with textures, and most of it lit at each pixel.
///
/// # Errors
/// As [`build_smooth`].
pub fn build_lit<'t, L: Look>(
    lamps: &'t Option<PixelLamps>,
    scene: &mut Scene<'_, 't, L>,
) -> Result<(), ShotError> {
    scene.begin(&Suite::Teapot.view().camera()?)?;
    let texture = Some(Skin {
        texture: &TEXTURES[1],
        places: &PLACES_F,
        budget: Budget::BALANCED,
    });
    let lamps = lamps.as_ref();
    let [ball, cube, pane] = parts();
    let calls = [
        Draw {
            lamps,
            light: None,
            ..ball
        },
        Draw {
            lamps,
            light: None,
            texture,
            shading: Shading::Smooth,
            ..cube
        },
        Draw { texture, ..pane },
    ];
    for call in &calls {
        scene.draw(call)?;
    }
    Ok(())
}
