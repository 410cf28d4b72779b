//! Scene B on the upright sphere: [`SPHERE`] with a texture of 128 x 128 once around it, the nearest texel,
//! in perspective.
//!
//! Each is there with the light of scene A and without any, and with places that keep 1/4 texel as
//! well as exact ones.

use crate::texels::{TEXEL_SIDE, TEXELS_565};
use crate::{Canvas, SPHERE, Shot, ShotError, Suite};
use scanbeam::Draw;
use scanbeam::pipeline::texture::{
    BlockCache, Blocked, Quality, Skin as PresetSkin, Square128, Texture, Textured, Words, Wrap,
};
use scanbeam::pipeline::{Gouraud, Instance, Pipeline, Scene, TexturedDepth};
use scanbeam::pixel::Rgb565Be;
use scanbeam::scene::{Budget, Skin};

/// A way to draw scene B.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SceneB {
    /// The name that reports use.
    pub name: &'static str,
    /// Whether the light of scene A falls on it; otherwise it shows its texels as they are.
    pub lit: bool,
    /// How far places on the texture may be off.
    pub budget: Budget,
}

/// All of them.
pub const SCENES_B: [SceneB; 4] = [
    scene("b_upright", true, Budget::BALANCED),
    scene("b_upright_exact", true, Budget::EXACT),
    scene("b_upright_unlit", false, Budget::BALANCED),
    scene("b_upright_unlit_exact", false, Budget::EXACT),
];

const fn scene(name: &'static str, lit: bool, budget: Budget) -> SceneB {
    SceneB { name, lit, budget }
}

/// What scene B is drawn with: as an SPI panel takes it.
pub type LookB = TexturedDepth<'static, Rgb565Be, Square128<'static, u16>>;

/// The texture of scene B: [`TEXELS_565`] as an SPI panel takes it.
pub static TEXELS_PANEL: [u16; TEXELS_565.len()] = {
    let mut texels = TEXELS_565;
    let mut i = 0;
    while i < texels.len() {
        texels[i] = texels[i].to_be();
        i += 1;
    }
    texels
};

/// The same for a scene.
pub static TEXTURES_B: [Square128<'static, u16>; 1] = [Square128::new(&TEXELS_PANEL)];

/// The texture of scene B in blocks, read through a cache of them (B5).
pub type CachedB<'t> = Texture<BlockCache<'t, Words<'t, u16>>, Wrap, Blocked>;
/// What scene B is drawn with where its texture lies in slow memory.
pub type CachedLookB<'t> = TexturedDepth<'t, Rgb565Be, CachedB<'t>>;

/// The layout of that texture: blocks of 32 bytes.
pub const BLOCKS_B: Blocked = Blocked::of_page(32, 16);
/// Texels of a block.
pub const BLOCK_TEXELS_B: usize = 16;
/// Blocks that the cache holds where the firmware draws: 1 KB of texels.
pub const CACHE_SLOTS_B: usize = 32;

/// How it is drawn so: without light, as `b_upright_unlit`.
pub const SCENE_B_BLOCKS: SceneB = scene("b_blocks", false, Budget::BALANCED);

/// Vertices that suffice for scene B: those of the mesh.
pub const VERTICES_B: usize = 33 * 33;
/// Objects that suffice for it: half of the mesh's triangles, and some more.
pub const OBJECTS_B: usize = 1024 + 64;

/// Where the vertices of [`SPHERE`] lie on the texture, once around it and once from pole to pole.
pub(crate) static PLACES: [[i32; 2]; VERTICES_B] = {
    const STEP: i32 = TEXEL_SIDE as i32 * 256 / 32;
    let mut places = [[0; 2]; VERTICES_B];
    let mut i = 0;
    while i < VERTICES_B {
        places[i] = [(i % 33) as i32 * STEP, (i / 33) as i32 * STEP];
        i += 1;
    }
    places
};

impl SceneB {
    /// Draws it into `scene`, whose screen must be [`Shot::screen`].
    ///
    /// # Errors
    /// When the memory is smaller than [`VERTICES_B`] and [`OBJECTS_B`], and when the look has no textures.
    pub fn build(self, scene: &mut impl Canvas) -> Result<(), ShotError> {
        let (camera, light) = Shot::sphere_camera()?;
        scene.begin(&camera)?;
        let skin = |texture| Skin {
            texture,
            places: &PLACES,
            budget: self.budget,
        };
        scene.draw(&Draw {
            light: light.filter(|_| self.lit),
            texture: Suite::B.texture().map(skin),
            ..Draw::new(SPHERE)
        })
    }

    /// Draws it into the scene of a preset, with the scene's texture 0, of [`TEXEL_SIDE`] texels each way.
    ///
    /// # Errors
    /// As [`build`](SceneB::build).
    pub fn build_preset<P>(self, scene: &mut Scene<'_, P>) -> Result<(), ShotError>
    where
        P: Pipeline<Shading = Textured<Gouraud>>,
    {
        let (camera, light) = Shot::sphere_camera()?;
        scene.begin(&camera)?;
        let instance = Instance {
            light: light.filter(|_| self.lit),
            ..Instance::default()
        };
        let skin = PresetSkin {
            places: &PLACES,
            texture: 0,
            quality: match self.budget {
                Budget::EXACT => Quality::Exact,
                _ => Quality::Balanced,
            },
        };
        scene.draw_skinned(&SPHERE, skin, &instance)?;
        Ok(())
    }
}
