//! A small frame for each interpolation method, which must have the same bits everywhere.

use crate::{CUBE, RIBBON, ShotError};
use scanbeam::pipeline::{
    Auto, Forward, HalfRate, Instance, Interpolation, Lirp10, Lirp12, Lirp16, LirpPacked, Packed8,
    Packed16, Pipeline, Quality, QuarterRate, Scene,
};
use scanbeam::{Affine, Camera, Cull, Light, Screen};

/// Pixels a line of a method's frame.
pub const METHOD_WIDTH: u16 = 64;
/// Lines of a method's frame.
pub const METHOD_HEIGHT: u16 = 48;

/// The frames by name, in the order of [`by_method`].
pub const METHODS: [&str; 12] = [
    "method_plane",
    "method_packed8",
    "method_packed16",
    "method_half",
    "method_quarter",
    "method_lirp10",
    "method_lirp12",
    "method_lirp16",
    "method_lirp_packed",
    "method_auto_fast",
    "method_auto_balanced",
    "method_auto_exact",
];

/// What draws a frame with any interpolation.
pub trait DrawsMethod {
    /// With `I`, at this quality.
    fn draw<I: Interpolation>(&mut self, quality: Quality);
}

/// Has the frame of [`METHODS`] at `index` drawn; the last one for any index above.
pub fn by_method(index: usize, to: &mut impl DrawsMethod) {
    let exact = Quality::exact();
    match index {
        0 => to.draw::<Forward>(exact),
        1 => to.draw::<Packed8>(exact),
        2 => to.draw::<Packed16>(exact),
        3 => to.draw::<HalfRate>(exact),
        4 => to.draw::<QuarterRate>(exact),
        5 => to.draw::<Lirp10>(exact),
        6 => to.draw::<Lirp12>(exact),
        7 => to.draw::<Lirp16>(exact),
        8 => to.draw::<LirpPacked>(exact),
        9 => to.draw::<Auto>(Quality::fast()),
        10 => to.draw::<Auto>(Quality::balanced()),
        _ => to.draw::<Auto>(exact),
    }
}

/// The size of a method's frame.
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
/// When the scene's arenas are smaller than 256 vertices and objects.
pub fn build_method<P: Pipeline>(scene: &mut Scene<'_, P>) -> Result<(), ShotError> {
    let camera = Camera::look_at([0.4, 0.5, 1.6], [0.0; 3], [0.0, 1.0, 0.0], 50.0, 0.1, 100.0)?;
    scene.begin(&camera)?;
    let open = |model| Instance {
        cull: Cull::None,
        model,
        light: Light::new([0.3, 0.8, 0.6], 0.3),
        ..Instance::default()
    };
    scene.draw(&RIBBON, &open(Affine::rotation_y(0.4)))?;
    let room = Affine::placed(4.0, [0.3, 0.2, 0.1]).unwrap_or(Affine::IDENTITY);
    let instance = Instance {
        light: None,
        ..open(Affine::rotation_y(0.7).then(&room))
    };
    // Walls whose colours change from corner to corner.
    scene.draw(
        &scanbeam::Mesh {
            colours: &WALLS,
            ..CUBE
        },
        &instance,
    )?;
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
