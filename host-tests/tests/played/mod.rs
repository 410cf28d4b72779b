//! What tests of the player share: memory for it and for scenes, and pictures of what it draws.

use scanbeam::event::Notice;
use scanbeam::frame::{FastMemory, Memory as LineMemory, Renderer};
use scanbeam::input::{Player, PlayerMemory, PlayerSettings, TextureRoom};
use scanbeam::list::{Budget, Halt, ListError, TextureSlot, Words};
use scanbeam::look::Look;
use scanbeam::pixel::Rgb565Be;
use scanbeam::scene::{DrawState, Memory, Object, Scene, TexturePlace, Vertex};
use scanbeam::{Camera, Link, Screen};

pub const WIDTH: u16 = 96;
pub const HEIGHT: u16 = 72;

/// Vertices, triangles and draw calls of a scene.
const VERTICES: usize = 20_000;
const OBJECTS: usize = 20_000;
const DRAWS: usize = 4_000;

/// The picture of what is drawn by the camera of most tests.
pub fn drawn<'t, L: Look<Pixel = Rgb565Be>>(build: impl FnOnce(&mut Scene<'_, 't, L>)) -> Vec<u16> {
    let camera = Camera::look_at([0.3, 0.5, 4.0], [0.0; 3], [0.0, 1.0, 0.0], 90.0, 0.1, 99.0);
    begun(&camera.unwrap(), build)
}

/// The picture of what is drawn, by any camera.
pub fn begun<'t, L: Look<Pixel = Rgb565Be>>(
    camera: &Camera,
    build: impl FnOnce(&mut Scene<'_, 't, L>),
) -> Vec<u16> {
    let mut vertices = vec![Vertex::EMPTY; VERTICES];
    let mut places = vec![TexturePlace::EMPTY; VERTICES];
    let mut objects = vec![Object::EMPTY; OBJECTS];
    let mut bins = [0; HEIGHT as usize];
    let mut draws = vec![DrawState::EMPTY; DRAWS];
    let memory = Memory {
        vertices: &mut vertices,
        places: &mut places,
        objects: &mut objects,
        bins: &mut bins,
        draws: &mut draws,
    };
    let mut scene = Scene::<L>::new(Screen::new(WIDTH, HEIGHT).unwrap(), memory);
    scene.begin(camera).unwrap();
    build(&mut scene);
    let mut cache = Box::new(FastMemory::<L>::new());
    let (mut links, mut depth) = (vec![Link::NONE; OBJECTS], [0; WIDTH as usize]);
    let mut renderer = Renderer::new(LineMemory {
        cache: &mut cache,
        links: &mut links,
        depth: &mut depth,
    });
    let mut picture = Vec::new();
    let mut line = [0; WIDTH as usize];
    for y in scene.lines() {
        renderer.draw_line(&scene, y, &mut line, 0).unwrap();
        picture.extend(line);
    }
    picture
}

/// Memory of players.
pub struct Kept {
    positions: Vec<[i16; 3]>,
    normals: Vec<[i16; 3]>,
    colours: Vec<[u8; 3]>,
    indices: Vec<u16>,
    places: Vec<[i32; 2]>,
    names: Vec<TextureSlot>,
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
        }
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
        let textures: Vec<TextureRoom<'t>> = (0..textures).map(|_| TextureRoom::EMPTY).collect();
        let memory = PlayerMemory {
            positions: &mut self.positions,
            normals: &mut self.normals,
            colours: &mut self.colours,
            indices: &mut self.indices,
            places: &mut self.places,
            names: &self.names,
            textures: Vec::leak(textures),
            texels: Vec::leak(vec![0; texels]),
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
