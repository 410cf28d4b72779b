//! The frames that are drawn on the host and on every target, and compared bit for bit.

use crate::suite::{self, Suite};
use crate::{CUBE, CUBE_QUADS, RIBBON, SPHERE, stress};
use scanbeam::list::{Halt, ListError};
use scanbeam::look::Look;
use scanbeam::scene::{BeginError, CacheError, DrawError, Shading, TextureError};
use scanbeam::{Affine, Camera, CameraError, Cull, Draw, Light, Mesh, Scene, Screen};

/// Pixels a line of every shot.
pub const WIDTH: u16 = 320;
/// Lines of every shot.
pub const HEIGHT: u16 = 240;
/// Vertices that suffice for every shot.
pub const VERTICES: usize = 10_240;
/// Objects that suffice for every shot.
pub const OBJECTS: usize = 5_120;
/// Draw calls that suffice for every shot: as many as [`Shot::Crowd`] has cubes.
pub const DRAWS: usize = 417;

/// A frame by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shot {
    /// The Utah teapot, lit.
    Teapot,
    /// A cube whose sides have their own colours.
    Cube,
    /// Scene A: 2,048 triangles submitted, radius 1 at distance 3.94, focal length 320 pixels.
    Sphere,
    /// A quad strip and a cube of quads that cut into each other; nothing is culled.
    Quads,
    /// A cube around the eye and the teapot across the near plane.
    Inside,
    /// [`DRAWS`] small cubes all over the picture, nothing culled: 5,004 objects, and far more on a line
    /// than a cache has slots. Not among [`SHOTS`].
    Crowd,
    /// Random triangles up to half a pixel wide. Among [`STRESS`](crate::STRESS).
    Slivers,
    /// Random triangles of up to 8192 pixels. Among [`STRESS`](crate::STRESS).
    Giants,
    /// Random triangles through the near plane. Among [`STRESS`](crate::STRESS).
    Crossings,
    /// Scene C: [`LAYERS`] smooth quads over the whole picture, the farthest submitted first, so
    /// that every pixel is drawn as often as there are quads. One of [`STACKS`].
    FarToNear,
    /// Scene C with the nearest submitted first, so that all others are hidden.
    NearToFar,
}

/// Quads of scene C.
pub const LAYERS: u8 = 16;
/// Depth of the nearest quad of scene C; each other is 1 farther than the one before it.
pub const NEAREST_LAYER: u8 = 2;

/// The two orders of scene C.
pub const STACKS: [Shot; 2] = [Shot::FarToNear, Shot::NearToFar];

/// The quad of scene C at a depth of 1.0, in Q1.14 and seen from the eye along -z, counter-clockwise:
/// at a focal length of 320 pixels a 64th wider and taller than the picture. All others are it,
/// scaled by their depth.
pub const LAYER: [[i16; 3]; 4] = {
    const X: i16 = 8192 + 128;
    const Y: i16 = 6144 + 96;
    const Z: i16 = -16_384;
    [[-X, -Y, Z], [X, -Y, Z], [X, Y, Z], [-X, Y, Z]]
};

/// The colours of a quad of scene C, corner by corner; `order` counts from the nearest, below
/// [`LAYERS`].
#[must_use]
pub const fn layer_colours(order: u8) -> [[u8; 3]; 4] {
    const CORNERS: [[u8; 3]; 4] = [[230, 40, 60], [40, 220, 80], [50, 70, 240], [240, 230, 200]];
    let mut colours = [[0; 3]; 4];
    let mut i = 0;
    while i < 12 {
        let level = CORNERS[(i / 3 + order as usize) % 4][i % 3];
        colours[i / 3][i % 3] = level.saturating_sub(2 * order);
        i += 1;
    }
    colours
}

/// [`layer_colours`] of all quads.
pub(crate) static LAYER_COLOURS: [[[u8; 3]; 4]; LAYERS as usize] = {
    let mut colours = [[[0; 3]; 4]; LAYERS as usize];
    let mut order = 0;
    while order < LAYERS {
        colours[order as usize] = layer_colours(order);
        order += 1;
    }
    colours
};

/// A way to draw a shot; its pixels are the shot's whatever the slots and renderers are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Variant {
    /// The name that reports use.
    pub name: &'static str,
    /// What is drawn.
    pub shot: Shot,
    /// Where the colours of faces come from.
    pub shading: Shading,
    /// Slots of each renderer's cache.
    pub slots: u16,
    /// Renderers that draw lines in turn.
    pub renderers: u16,
    /// Bytes a line fetched ahead.
    pub ahead: u32,
}

impl Variant {
    /// The shot itself: one renderer with 64 slots.
    #[must_use]
    pub const fn of(shot: Shot) -> Self {
        Self::with(shot.name(), shot, SLOTS)
    }

    const fn with(name: &'static str, shot: Shot, slots: u16) -> Self {
        Self {
            name,
            shot,
            shading: Shading::Smooth,
            slots,
            renderers: 1,
            ahead: 0,
        }
    }
}

/// Slots of a renderer, where nothing else is said.
const SLOTS: u16 = 64;
/// The most slots of any variant, and of any cache.
pub const MOST_SLOTS: u16 = 224;

/// Every variant. Those with [`MOST_SLOTS`] are what a scene costs that is almost all in fast memory.
pub const VARIANTS: [Variant; 10] = [
    Variant::with("teapot_cache0", Shot::Teapot, 0),
    Variant::with("teapot_cache3", Shot::Teapot, 3),
    Variant::with("teapot_all_fast", Shot::Teapot, MOST_SLOTS),
    Variant {
        ahead: 4_000,
        ..Variant::with("teapot_ahead", Shot::Teapot, SLOTS)
    },
    Variant {
        renderers: 2,
        ..Variant::with("sphere_two", Shot::Sphere, 43)
    },
    Variant::with("crowd_cache0", Shot::Crowd, 0),
    Variant::with("crowd_cache64", Shot::Crowd, SLOTS),
    Variant::with("crowd_all_fast", Shot::Crowd, MOST_SLOTS),
    Variant {
        shading: Shading::Flat,
        ..Variant::with("teapot_flat", Shot::Teapot, SLOTS)
    },
    Variant {
        shading: Shading::Flat,
        ..Variant::with("crossings_flat", Shot::Crossings, SLOTS)
    },
];

/// Every shot, in the order in which they are drawn.
pub const SHOTS: [Shot; 5] = [
    Shot::Teapot,
    Shot::Cube,
    Shot::Sphere,
    Shot::Quads,
    Shot::Inside,
];

/// Why a shot could not be built; none of them fails where the memory is as large as said here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShotError {
    /// Its camera cannot be made.
    Camera(CameraError),
    /// It was not begun.
    Begin(BeginError),
    /// A part was not drawn.
    Draw(DrawError),
    /// A texture, or a level of detail, was not made.
    Texture(TextureError),
    /// A cache of a texture was not made.
    Cache(CacheError),
    /// Sprites are not in order.
    Sprites,
    /// A light comes from nowhere.
    Light,
    /// A list was not played to its end, or the scene is too small for it.
    List(Result<Halt, ListError>),
}

impl From<CameraError> for ShotError {
    fn from(error: CameraError) -> Self {
        Self::Camera(error)
    }
}

impl From<BeginError> for ShotError {
    fn from(error: BeginError) -> Self {
        Self::Begin(error)
    }
}

impl From<DrawError> for ShotError {
    fn from(error: DrawError) -> Self {
        Self::Draw(error)
    }
}

impl Shot {
    /// The name that reports use.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Teapot => "teapot",
            Self::Cube => "cube",
            Self::Sphere => "sphere",
            Self::Quads => "quads",
            Self::Inside => "inside",
            Self::Crowd => "crowd",
            Self::Slivers => "slivers",
            Self::Giants => "giants",
            Self::Crossings => "crossings",
            Self::FarToNear => "c_f2n",
            Self::NearToFar => "c_n2f",
        }
    }

    /// The colour where nothing is, 8-bit levels.
    #[must_use]
    pub const fn background(self) -> [u8; 3] {
        match self {
            Self::Sphere => [0, 0, 0],
            _ => [24, 32, 48],
        }
    }

    /// The size of every shot.
    #[must_use]
    pub fn screen() -> Screen {
        match Screen::new(WIDTH, HEIGHT) {
            Ok(screen) => screen,
            // A size within the limits.
            Err(_) => unreachable!(),
        }
    }

    /// The camera and the light of scene A, which scene B has too.
    pub(crate) fn sphere_camera() -> Result<(Camera, Option<Light>), ShotError> {
        Ok((Suite::A.view().camera()?, suite::sphere_light()))
    }

    /// Draws the shot into `scene`, whose screen must be [`screen`](Shot::screen).
    ///
    /// # Errors
    /// When the scene's memory is smaller than [`VERTICES`], [`OBJECTS`] and [`DRAWS`].
    pub fn build<L: Look>(self, scene: &mut Scene<'_, '_, L>) -> Result<(), ShotError> {
        self.build_shaded(Shading::Smooth, scene)
    }

    /// The same with colours of faces from there.
    ///
    /// # Errors
    /// As [`build`](Shot::build); faces of one colour take three vertices each, which have to have room too.
    pub fn build_shaded<L: Look>(
        self,
        shading: Shading,
        scene: &mut Scene<'_, '_, L>,
    ) -> Result<(), ShotError> {
        let lit = |mesh, model| lit(mesh, model, shading);
        let open = |mesh, model| open(mesh, model, shading);
        let looking =
            |eye, focal, near| Camera::look_at(eye, [0.0; 3], [0.0, 1.0, 0.0], focal, near, 100.0);
        match self {
            Self::Teapot => Suite::Teapot.build_shaded(shading, scene)?,
            Self::Cube => {
                scene.begin(&looking([1.5, 2.0, 4.0], 260.0, 0.1)?)?;
                scene.draw(&lit(CUBE, Affine::rotation_y(0.3)))?;
            }
            Self::Sphere => {
                let (camera, light) = Self::sphere_camera()?;
                scene.begin(&camera)?;
                scene.draw(&Draw {
                    light,
                    shading,
                    ..Draw::new(SPHERE)
                })?;
            }
            Self::Quads => {
                scene.begin(&looking([0.8, 1.4, 3.6], 240.0, 0.1)?)?;
                scene.draw(&open(RIBBON, Affine::rotation_y(0.4)))?;
                let small = Affine::placed(0.45, [0.1, 0.0, 0.0]).unwrap_or(Affine::IDENTITY);
                scene.draw(&open(CUBE_QUADS, Affine::rotation_x(0.5).then(&small)))?;
            }
            Self::Inside => Suite::Inside.build_shaded(shading, scene)?,
            Self::FarToNear => Suite::FarToNear.build_shaded(shading, scene)?,
            Self::NearToFar => Suite::NearToFar.build_shaded(shading, scene)?,
            Self::Crowd => {
                scene.begin(&looking([0.0, 0.4, 5.0], 300.0, 0.1)?)?;
                crowd(shading, scene)?;
            }
            Self::Slivers | Self::Giants | Self::Crossings => stress::build(self, shading, scene)?,
        }
        Ok(())
    }
}

/// A mesh in the light of the teapot.
fn lit(mesh: Mesh<'static>, model: Affine, shading: Shading) -> Draw<'static, 'static> {
    Draw {
        model,
        shading,
        light: suite::room_light(),
        ..Draw::new(mesh)
    }
}

/// The same, seen from behind too.
fn open(mesh: Mesh<'static>, model: Affine, shading: Shading) -> Draw<'static, 'static> {
    Draw {
        cull: Cull::None,
        ..lit(mesh, model, shading)
    }
}

/// [`DRAWS`] small cubes at random places.
fn crowd<L: Look>(shading: Shading, scene: &mut Scene<'_, '_, L>) -> Result<(), ShotError> {
    let mut seed = 1u32;
    let mut next = |reach: f32| {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        ((seed >> 16) as f32 / 32_768.0 - 1.0) * reach
    };
    for _ in 0..DRAWS {
        let turn = Affine::rotation_y(next(3.0)).then(&Affine::rotation_x(next(3.0)));
        let at = [next(2.2), next(1.6), next(1.5)];
        let place = Affine::placed(0.07, at).unwrap_or(Affine::IDENTITY);
        scene.draw(&open(CUBE, turn.then(&place), shading))?;
    }
    Ok(())
}
