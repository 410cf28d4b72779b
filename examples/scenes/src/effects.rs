//! A small frame for each thing that presets have beyond opaque matt surfaces and draw calls have otherwise, which must
//! have the same bits everywhere: transparency by finishes, dithered pixels.

use crate::{CUBE, METHOD_HEIGHT, METHOD_WIDTH, RIBBON, ShotError, build_method};
use scanbeam::pipeline::blend::{Blend, Factor, Finish, Surface};
use scanbeam::pipeline::{Composited, GouraudDepth, Instance, Scene};
use scanbeam::pixel::{Dithered, Rgb565, Rgb565Be};
use scanbeam::{Affine, Camera, Cull, Light};

/// Pixels a line of such a frame.
pub const EFFECT_WIDTH: u16 = METHOD_WIDTH;
/// Lines of such a frame.
pub const EFFECT_HEIGHT: u16 = METHOD_HEIGHT;
/// Vertices and objects that suffice for any of them.
pub const EFFECT_ROOM: usize = 2200;

/// The frames by name, in the order of [`by_effect`].
pub const EFFECTS: [&str; 2] = ["effect_transparency", "effect_dither"];

/// Surfaces with a finish.
pub type Transparent = Composited<GouraudDepth<Rgb565Be>>;
/// Dithered colours.
pub type Grainy = GouraudDepth<Dithered<Rgb565>>;

/// What draws a frame with any of these pipelines.
pub trait DrawsEffect {
    /// Surfaces with a finish.
    fn transparent(&mut self, build: impl Fn(&mut Scene<'_, Transparent>) -> Result<(), ShotError>);
    /// Dither.
    fn grainy(&mut self, build: impl Fn(&mut Scene<'_, Grainy>) -> Result<(), ShotError>);
}

/// Has the frame of [`EFFECTS`] at `index` drawn; the last one for any index above.
pub fn by_effect(index: usize, to: &mut impl DrawsEffect) {
    match index {
        0 => to.transparent(transparency),
        _ => to.grainy(build_method),
    }
}

fn camera() -> Result<Camera, ShotError> {
    let up = [0.0, 1.0, 0.0];
    Ok(Camera::look_at(
        [0.6, 1.0, 2.8],
        [0.0; 3],
        up,
        56.0,
        0.1,
        100.0,
    )?)
}

fn at(scale: f32, place: [f32; 3]) -> Affine {
    Affine::placed(scale, place).unwrap_or(Affine::IDENTITY)
}

/// Panes of all kinds around a ribbon, in each other and in front of a cube.
fn transparency(scene: &mut Scene<'_, Transparent>) -> Result<(), ShotError> {
    scene.begin(&camera()?)?;
    let open = Instance {
        cull: Cull::None,
        light: Light::new([0.3, 0.8, 0.6], 0.4),
        ..Instance::default()
    };
    scene.draw(&RIBBON, &open)?;
    let back = Instance {
        model: Affine::rotation_y(0.6).then(&at(0.7, [0.3, 0.0, -1.6])),
        ..open
    };
    scene.draw(&CUBE, &back)?;
    let finishes = [
        Finish::filtered(120),
        Finish::additive(200),
        Finish::subtractive(90),
        Finish::blended(Blend::Half, 255),
        Finish::blended(
            Blend::Factors {
                source: Factor::SourceAlpha,
                destination: Factor::Destination,
            },
            180,
        ),
    ];
    for (i, finish) in (0u8..).zip(finishes) {
        let angle = 0.9 * f32::from(i);
        let place = [0.45 * f32::from(i) - 0.9, 0.1 * f32::from(i), 0.2];
        let instance = Instance {
            model: Affine::rotation_x(angle)
                .then(&Affine::rotation_y(2.0 * angle))
                .then(&at(0.3, place)),
            ..open
        };
        scene.draw_skinned(&CUBE, Surface::from(finish), &instance)?;
    }
    Ok(())
}
