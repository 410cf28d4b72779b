//! What tests of the player share: memory for it and for scenes, and pictures of what it draws.

pub mod lists;

use crate::hot::shine::even_light;
use host_tests::rooms::{Room, picture};
use scanbeam::event::Notice;
use scanbeam::input::{LightRoom, Player, PlayerMemory, PlayerSettings, TextureRoom};
use scanbeam::list::{Budget, Halt, ListError, OverlaySlot, TextureSlot, Words};
use scanbeam::look::Look;
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scene::{Draw, Scene, Texture};
use scanbeam::{Camera, Screen};

pub const WIDTH: u16 = 96;
pub const HEIGHT: u16 = 72;

/// The picture of what is drawn by the camera of most tests.
pub fn drawn<'t, L: Look<Pixel = Rgb565Be>>(build: impl FnOnce(&mut Scene<'_, 't, L>)) -> Vec<u16> {
    drawn_in(build)
}

/// The same in any format.
pub fn drawn_in<'t, P: PixelFormat, L: Look<Pixel = P>>(
    build: impl FnOnce(&mut Scene<'_, 't, L>),
) -> Vec<P::Word> {
    let camera = Camera::look_at([0.3, 0.5, 4.0], [0.0; 3], [0.0, 1.0, 0.0], 90.0, 0.1, 99.0);
    begun_in(&camera.unwrap(), build)
}

/// The picture of what is drawn, by any camera.
pub fn begun<'t, L: Look<Pixel = Rgb565Be>>(
    camera: &Camera,
    build: impl FnOnce(&mut Scene<'_, 't, L>),
) -> Vec<u16> {
    begun_in(camera, build)
}

/// The same in any format.
fn begun_in<'t, P: PixelFormat, L: Look<Pixel = P>>(
    camera: &Camera,
    build: impl FnOnce(&mut Scene<'_, 't, L>),
) -> Vec<P::Word> {
    let room = Room {
        vertices: 20_000,
        places: 20_000,
        objects: 20_000,
        draws: 4_000,
    };
    let screen = Screen::new(WIDTH, HEIGHT).unwrap();
    let built = |scene: &mut Scene<'_, 't, L>| {
        scene.begin(camera)?;
        build(scene);
        Ok(())
    };
    picture(screen, room, P::Word::default(), built).unwrap()
}

/// Settings of light at pixels.
pub fn lit_at_pixels() -> PlayerSettings<'static, 'static> {
    let settings = PlayerSettings::default();
    PlayerSettings {
        draw: Draw {
            lamps: even_light(),
            ..settings.draw
        },
        ..settings
    }
}

/// Memory of players.
pub struct Kept {
    positions: Vec<[i16; 3]>,
    normals: Vec<[i16; 3]>,
    colours: Vec<[u8; 3]>,
    indices: Vec<u16>,
    places: Vec<[i32; 2]>,
    names: Vec<TextureSlot>,
    lights: Option<LightRoom>,
    alphas: Vec<u8>,
}

impl Kept {
    pub fn new(vertices: usize, indices: usize) -> Self {
        Self {
            positions: vec![[0; 3]; vertices],
            normals: vec![[0; 3]; vertices],
            colours: vec![[0; 3]; vertices],
            indices: vec![0; indices],
            places: vec![[0; 2]; vertices],
            names: (0..16).map(|_| TextureSlot::new()).collect(),
            lights: None,
            alphas: Vec::new(),
        }
    }

    /// The same with room for the alphas of so many vertices.
    pub fn with_alphas(self, vertices: usize) -> Self {
        Self {
            alphas: vec![0; vertices],
            ..self
        }
    }

    /// The same, with room for several lights.
    pub fn with_lights(self) -> Self {
        let lights = Some(LightRoom::new());
        Self { lights, ..self }
    }

    /// A player with room for 8 textures, which is never given back.
    pub fn player<'m, 't, L: Look>(
        &'m mut self,
        settings: PlayerSettings<'m, 't>,
    ) -> Player<'m, 't, L> {
        self.player_with(settings, 8, 8192)
    }

    /// The same with room for so many textures and words of them.
    pub fn player_with<'m, 't, L: Look>(
        &'m mut self,
        settings: PlayerSettings<'m, 't>,
        textures: usize,
        texels: usize,
    ) -> Player<'m, 't, L> {
        self.player_in(settings, (textures, texels), &[])
    }

    /// A player with room for these overlays.
    pub fn player_over<'m, 't, L: Look>(
        &'m mut self,
        settings: PlayerSettings<'m, 't>,
        overlays: &'m [OverlaySlot],
    ) -> Player<'m, 't, L> {
        self.player_in(settings, (8, 8192), overlays)
    }

    fn player_in<'m, 't, L: Look>(
        &'m mut self,
        settings: PlayerSettings<'m, 't>,
        (textures, texels): (usize, usize),
        overlays: &'m [OverlaySlot],
    ) -> Player<'m, 't, L> {
        let textures: Vec<TextureRoom<'t>> = (0..textures).map(|_| TextureRoom::EMPTY).collect();
        let memory = PlayerMemory {
            positions: &mut self.positions,
            normals: &mut self.normals,
            colours: &mut self.colours,
            indices: &mut self.indices,
            places: &mut self.places,
            alphas: &mut self.alphas,
            names: &self.names,
            textures: Vec::leak(textures),
            texels: Vec::leak(vec![0; texels]),
            levels: Vec::leak(vec![Texture::EMPTY; 3]),
            overlays,
            lights: self.lights.as_mut(),
        };
        Player::new(memory, settings)
    }
}

/// Runs a list that was started.
pub fn played<'t, L: Look>(
    player: &mut Player<'_, 't, L>,
    list: impl Words<'t>,
    scene: &mut Scene<'_, 't, L>,
    mut budget: Budget,
) -> Result<Halt, ListError> {
    player.run(list, scene, &mut budget, &mut |_: Notice| {})
}
