//! The scenes of the benchmark, as data: meshes, where they stand, and who looks at them.
//!
//! Every picture is 320 x 240 at [`Suite::view`]. A scene is a few [`Part`]s, drawn in their order;
//! [`Suite::build`] hands them to a scene, and a renderer of
//! another kind may read the parts themselves.
//!
//! | name | what | triangles | texture |
//! |---|---|---|---|
//! | `a` | [`SPHERE`], tilted by [`tilt`], lit | 2,048 | |
//! | `b`, `b_unlit` | the same with a texture once around, with and without the light | 2,048 | 128 x 128 |
//! | `c_f2n`, `c_n2f` | 16 quads over the whole picture, the farthest or the nearest first | 32 | |
//! | `f` | 27 cubes in a block of 3 x 3 x 3, not lit | 324 | 64 x 64 on each side |
//! | `g` | [`FINE_SPHERE`], as `a` | 8,192 | |
//! | `teapot` | the teapot, lit, its lid and spout across each other | 2,256 | |
//! | `inside` | a cube around the eye and the teapot across the near plane | 2,268 | |

use crate::scene_b::{PLACES, TEXELS_PANEL};
use crate::shots::{LAYER, LAYER_COLOURS, LAYERS, NEAREST_LAYER};
use crate::texels::TEXEL_SIDE;
use crate::{CUBE, FINE_SPHERE, SPHERE, ShotError, TEAPOT};
use scanbeam::look::Look;
use scanbeam::mesh::QuadSplit;
use scanbeam::scene::{Budget, Shading, Skin, Texture};
use scanbeam::{Affine, Camera, CameraError, Cull, Draw, Faces, Light, Mesh, Scene};

/// Lines of a transfer that the suite is measured with.
pub const SUITE_LINES: u16 = 1;
/// Vertices that suffice for every scene of the suite.
pub const SUITE_VERTICES: usize = 65 * 65;
/// Objects that suffice for every scene of the suite.
pub const SUITE_OBJECTS: usize = 4_224;
/// Draw calls that suffice for every scene of the suite.
pub const SUITE_DRAWS: usize = CUBES;

/// Texels a side of [`TEXELS_F`].
pub const TEXEL_SIDE_F: u32 = 64;
/// The texture of scene F: squares of 8 texels with a frame, 5, 6 and 5 bits.
pub static TEXELS_F: [u16; 4096] = texels_f();
/// The same as an SPI panel takes it.
pub static TEXELS_F_PANEL: [u16; 4096] = {
    let mut texels = texels_f();
    let mut i = 0;
    while i < texels.len() {
        texels[i] = texels[i].to_be();
        i += 1;
    }
    texels
};

const fn texels_f() -> [u16; 4096] {
    let mut texels = [0; 4096];
    let mut i = 0;
    while i < 4096 {
        let (x, y) = (i as u32 % TEXEL_SIDE_F, i as u32 / TEXEL_SIDE_F);
        let rim = x < 2 || y < 2 || x >= 62 || y >= 62;
        let square = if (x ^ y) & 8 == 0 { 44 } else { 14 };
        let (red, blue) = if rim { (31, 31) } else { (x >> 1, y >> 1) };
        let green = if rim { 63 } else { square };
        texels[i] = (red << 11 | green << 5 | blue) as u16;
        i += 1;
    }
    texels
}

/// Where the corners of [`CUBE`] lie on the texture of scene F: each side has it once.
pub static PLACES_F: [[i32; 2]; 24] = {
    const FAR: i32 = TEXEL_SIDE_F as i32 * 256;
    let mut places = [[0; 2]; 24];
    let mut i = 0;
    while i < 24 {
        places[i] = [[0, FAR], [FAR, FAR], [FAR, 0], [0, 0]][i % 4];
        i += 1;
    }
    places
};

/// Cubes of scene F.
pub const CUBES: usize = 27;
/// Half the side of a cube of scene F.
pub const CUBE_HALF: f32 = 0.25;
/// From the middle of a cube of scene F to that of the next one.
pub const CUBE_PITCH: f32 = 1.0;

/// The faces of a layer of scene C.
static LAYER_FACES: [[u16; 4]; 1] = [[0, 1, 2, 3]];

/// What a camera is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Looking {
    /// Where the eye is.
    pub eye: [f32; 3],
    /// What it looks at.
    pub at: [f32; 3],
    /// What is up.
    pub up: [f32; 3],
    /// Focal length in pixels.
    pub focal: f32,
    /// Distance of the near plane.
    pub near: f32,
    /// Distance of the far plane.
    pub far: f32,
}

impl Looking {
    /// From `eye` to the origin, y up, to a distance of 100.
    const fn to_origin(eye: [f32; 3], focal: f32, near: f32) -> Self {
        Self {
            eye,
            at: [0.0; 3],
            up: [0.0, 1.0, 0.0],
            focal,
            near,
            far: 100.0,
        }
    }

    /// The camera.
    ///
    /// # Errors
    /// As [`Camera::look_at`].
    pub fn camera(&self) -> Result<Camera, CameraError> {
        Camera::look_at(self.eye, self.at, self.up, self.focal, self.near, self.far)
    }
}

/// A mesh where it stands.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    /// The mesh, in Q1.14.
    pub mesh: Mesh<'static>,
    /// Where its vertices lie on the texture, in 1/256 texel; empty where it has none.
    pub places: &'static [[i32; 2]],
    /// Model space to world space.
    pub model: Affine,
    /// Which faces are dropped.
    pub cull: Cull,
    /// The light, where it is lit.
    pub light: Option<Light>,
    /// Colour of vertices that have none of their own.
    pub colour: [u8; 3],
}

impl Part {
    /// Without a texture and a light, faces seen from behind dropped.
    const fn plain(mesh: Mesh<'static>, model: Affine) -> Self {
        Self {
            mesh,
            places: &[],
            model,
            cull: Cull::Back,
            light: None,
            colour: [255; 3],
        }
    }

    /// Its draw call, without a texture.
    #[must_use]
    pub const fn draw(&self) -> Draw<'static, 'static> {
        Draw {
            model: self.model,
            cull: self.cull,
            light: self.light,
            colour: self.colour,
            ..Draw::new(self.mesh)
        }
    }
}

/// The textures of scenes B and F, as an SPI panel takes them.
static TEXTURES: [Texture<'static>; 2] = [
    texture(&TEXELS_PANEL, TEXEL_SIDE),
    texture(&TEXELS_F_PANEL, TEXEL_SIDE_F),
];

/// A square texture of so many texels a side.
pub(crate) const fn texture(texels: &'static [u16], side: u32) -> Texture<'static> {
    match Texture::words(texels, side, side) {
        Ok(texture) => texture,
        Err(_) => panic!("as many texels as the sides need"),
    }
}

/// A scene of the suite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Suite {
    /// The tilted sphere, lit.
    A,
    /// The tilted sphere with a texture, lit.
    B,
    /// The tilted sphere with a texture alone.
    BUnlit,
    /// Quads over the whole picture, the farthest first.
    FarToNear,
    /// Quads over the whole picture, the nearest first.
    NearToFar,
    /// 27 textured cubes.
    F,
    /// The tilted sphere of 8,192 triangles, lit.
    G,
    /// The teapot, lit.
    Teapot,
    /// Inside a cube, with the teapot.
    Inside,
}

/// Every scene of the suite.
pub const SUITE: [Suite; 9] = [
    Suite::A,
    Suite::B,
    Suite::BUnlit,
    Suite::FarToNear,
    Suite::NearToFar,
    Suite::F,
    Suite::G,
    Suite::Teapot,
    Suite::Inside,
];

/// How the spheres of scenes A, B and G stand: turned by 0.3 rad about y, then by 0.4 about x.
#[must_use]
pub fn tilt() -> Affine {
    Affine::rotation_y(0.3).then(&Affine::rotation_x(0.4))
}

/// The light of scenes A, B and G.
#[must_use]
pub fn sphere_light() -> Option<Light> {
    Light::new([0.5, 0.7, 0.8], 0.15)
}

/// The light of the teapot and of the room around it.
#[must_use]
pub fn room_light() -> Option<Light> {
    Light::new([0.3, 0.8, 0.6], 0.2)
}

/// The model of a cube of scene F, below [`CUBES`]; the block is turned by -30 degrees about
/// y, then by 20 about x.
#[must_use]
pub fn cube_model(index: usize) -> Affine {
    const THIRTY: f32 = core::f32::consts::PI / 6.0;
    const TWENTY: f32 = core::f32::consts::PI / 9.0;
    let along = |step: usize| (index / step % 3) as f32 * CUBE_PITCH - CUBE_PITCH;
    let at = [along(1), along(3), along(9)];
    let placed = Affine::placed(CUBE_HALF, at).unwrap_or(Affine::IDENTITY);
    placed
        .then(&Affine::rotation_y(-THIRTY))
        .then(&Affine::rotation_x(TWENTY))
}

/// A sphere of scenes A and G.
#[must_use]
pub fn tilted(mesh: Mesh<'static>) -> Part {
    Part {
        light: sphere_light(),
        ..Part::plain(mesh, tilt())
    }
}

/// The sphere of scene B, with its light or without.
#[must_use]
pub fn tilted_textured(lit: bool) -> Part {
    Part {
        places: &PLACES,
        light: sphere_light().filter(|_| lit),
        ..Part::plain(SPHERE, tilt())
    }
}

/// A quad of scene C; `order` counts from the nearest, below [`LAYERS`].
#[must_use]
pub fn layer(order: u8) -> Part {
    let mesh = Mesh {
        positions: &LAYER,
        normals: &[],
        colours: &LAYER_COLOURS[usize::from(order % LAYERS)],
        faces: Faces::Quads(&LAYER_FACES, QuadSplit::Corner0To2),
    };
    let depth = f32::from(NEAREST_LAYER + order);
    let model = Affine::placed(depth, [0.0; 3]).unwrap_or(Affine::IDENTITY);
    Part::plain(mesh, model)
}

/// A cube of scene F, below [`CUBES`].
#[must_use]
pub fn cube(index: usize) -> Part {
    let mesh = Mesh {
        normals: &[],
        colours: &[],
        ..CUBE
    };
    Part {
        places: &PLACES_F,
        ..Part::plain(mesh, cube_model(index))
    }
}

/// The teapot of its own scene.
#[must_use]
pub fn teapot_part() -> Part {
    Part {
        light: room_light(),
        colour: [236, 196, 112],
        ..Part::plain(TEAPOT, Affine::rotation_y(0.6))
    }
}

/// The cube around the eye, 0, and the teapot in it, 1.
#[must_use]
pub fn inside(index: usize) -> Part {
    let around = Affine::placed(9.0, [0.0, 0.0, 0.0]).unwrap_or(Affine::IDENTITY);
    let (mesh, model) = match index {
        0 => (CUBE, Affine::rotation_y(0.2).then(&around)),
        _ => (TEAPOT, Affine::rotation_y(2.0)),
    };
    Part {
        cull: Cull::None,
        light: room_light(),
        ..Part::plain(mesh, model)
    }
}

impl Suite {
    /// The name that reports use.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::A => "a",
            Self::B => "b",
            Self::BUnlit => "b_unlit",
            Self::FarToNear => "c_f2n",
            Self::NearToFar => "c_n2f",
            Self::F => "f",
            Self::G => "g",
            Self::Teapot => "teapot",
            Self::Inside => "inside",
        }
    }

    /// Who looks at it.
    #[must_use]
    pub const fn view(self) -> Looking {
        match self {
            Self::A | Self::B | Self::BUnlit | Self::G => {
                Looking::to_origin([0.0, 0.0, 3.94], 320.0, 0.1)
            }
            Self::FarToNear | Self::NearToFar => Looking {
                at: [0.0, 0.0, -1.0],
                ..Looking::to_origin([0.0; 3], 320.0, 0.1)
            },
            Self::F => Looking::to_origin([0.0, 0.0, 5.0], 320.0, 0.1),
            Self::Teapot => Looking::to_origin([0.0, 1.2, 2.6], 300.0, 0.1),
            Self::Inside => Looking::to_origin([0.35, 0.3, 0.55], 150.0, 0.3),
        }
    }

    /// The colour where nothing is, 8-bit levels.
    #[must_use]
    pub const fn background(self) -> [u8; 3] {
        match self {
            Self::A | Self::B | Self::BUnlit | Self::F | Self::G => [0, 0, 0],
            _ => [24, 32, 48],
        }
    }

    /// The texture of all its parts, square, rows from the top, as an SPI panel takes it.
    #[must_use]
    pub fn texels(self) -> Option<&'static [u16]> {
        match self {
            Self::B | Self::BUnlit => Some(&TEXELS_PANEL),
            Self::F => Some(&TEXELS_F_PANEL),
            _ => None,
        }
    }

    /// Texels a side of that texture.
    #[must_use]
    pub const fn texel_side(self) -> u32 {
        match self {
            Self::F => TEXEL_SIDE_F,
            _ => TEXEL_SIDE,
        }
    }

    /// How many parts it has.
    #[must_use]
    pub const fn parts(self) -> usize {
        match self {
            Self::FarToNear | Self::NearToFar => LAYERS as usize,
            Self::F => CUBES,
            Self::Inside => 2,
            _ => 1,
        }
    }

    /// A part, in the order in which they are drawn, below [`parts`](Suite::parts).
    #[must_use]
    pub fn part(self, index: usize) -> Part {
        match self {
            Self::A => tilted(SPHERE),
            Self::G => tilted(FINE_SPHERE),
            Self::B => tilted_textured(true),
            Self::BUnlit => tilted_textured(false),
            Self::FarToNear => layer(LAYERS - 1 - index as u8 % LAYERS),
            Self::NearToFar => layer(index as u8 % LAYERS),
            Self::F => cube(index),
            Self::Teapot => teapot_part(),
            Self::Inside => inside(index),
        }
    }

    /// Its texture, for looks that have any.
    #[must_use]
    pub fn texture(self) -> Option<&'static Texture<'static>> {
        match self {
            Self::B | Self::BUnlit => Some(&TEXTURES[0]),
            Self::F => Some(&TEXTURES[1]),
            _ => None,
        }
    }

    /// Draws it into `scene`, whose screen must be [`Shot::screen`](crate::Shot::screen), with its
    /// texture, within 1/4 texel.
    ///
    /// # Errors
    /// When the memory is less than [`SUITE_VERTICES`], [`SUITE_OBJECTS`], [`SUITE_DRAWS`] and a bin a line, and when it
    /// has a texture and the look has none.
    pub fn build<L: Look>(self, scene: &mut Scene<'_, '_, L>) -> Result<(), ShotError> {
        self.build_shaded(Shading::Smooth, scene)
    }

    /// The same with colours of faces from there.
    ///
    /// # Errors
    /// As [`build`](Suite::build); faces of one colour take three vertices each, which have to have room too.
    // So that a program that draws smooth faces alone has no code for others.
    #[inline(always)]
    pub fn build_shaded<L: Look>(
        self,
        shading: Shading,
        scene: &mut Scene<'_, '_, L>,
    ) -> Result<(), ShotError> {
        scene.begin(&self.view().camera()?)?;
        let texture = self.texture();
        for index in 0..self.parts() {
            let part = self.part(index);
            let skin = |texture| Skin {
                texture,
                places: part.places,
                budget: Budget::BALANCED,
            };
            scene.draw(&Draw {
                texture: texture.map(skin),
                shading,
                ..part.draw()
            })?;
        }
        Ok(())
    }
}
