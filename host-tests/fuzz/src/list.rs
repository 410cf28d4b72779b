//! Any bytes as a list: no panic, no hang, work within the budget (X7).

use scanbeam::event::Notice;
use scanbeam::frame::{FastMemory, Memory as LineMemory, Renderer};
use scanbeam::input::{LightRoom, Player, PlayerMemory, PlayerSettings, TextureRoom};
use scanbeam::list::{Budget, Halt, ListCommand, OverlaySlot, TextureSlot};
use scanbeam::look::Textured;
use scanbeam::overlay::ListOverlays;
use scanbeam::pixel::Rgb565;
use scanbeam::scene::{Draw, DrawState, Memory, Object, Scene, Texture, TexturePlace, Vertex};
use scanbeam::{Camera, Light, Link, Screen};

type Look = Textured<Rgb565>;

/// What a list may cause, each resumption included.
const BUDGET: Budget = Budget {
    instructions: 64,
    vertices: 4096,
    jumps: 8,
};

/// What became of a list.
#[derive(Debug)]
pub struct Played {
    /// Words of the list before the block that was refused, or before the one that would come next.
    pub good: u32,
    /// Whether it came to its end.
    pub ended: bool,
}

/// Plays the bytes; panics when something does not hold. How many words of good blocks there were.
pub fn run(data: &[u8]) -> usize {
    let list: Vec<u32> = data
        .chunks_exact(4)
        .map(|b| u32::from_ne_bytes([b[0], b[1], b[2], b[3]]))
        .collect();
    play(&list).good as usize
}

/// Plays a list, and draws three lines of what it made; panics when something does not hold.
pub fn play(list: &[u32]) -> Played {
    let overlays = [const { OverlaySlot::new() }; 3];
    let names = [const { TextureSlot::new() }; 8];
    let mut textures = [TextureRoom::EMPTY; 3];
    let (mut texels, mut levels) = ([0; 600], [Texture::EMPTY; 3]);
    let (mut positions, mut normals) = ([[0i16; 3]; 32], [[0; 3]; 32]);
    let (mut colours, mut indices) = ([[0; 3]; 32], [0; 48]);
    let (mut places, mut lights) = ([[0; 2]; 32], LightRoom::new());
    let mut alphas = [0; 32];
    let (mut vertices, mut objects) = ([Vertex::EMPTY; 512], [Object::EMPTY; 512]);
    let mut placed = [TexturePlace::EMPTY; 512];
    let (mut bins, mut draws) = ([0; 24], [DrawState::EMPTY; 64]);
    let mut scene = Scene::<Look>::new(
        Screen::new(32, 24).expect("within the limits"),
        Memory {
            vertices: &mut vertices,
            places: &mut placed,
            objects: &mut objects,
            bins: &mut bins,
            draws: &mut draws,
        },
    );
    let camera = Camera::look_at([0.0, 0.0, 4.0], [0.0; 3], [0.0, 1.0, 0.0], 30.0, 0.1, 99.0);
    let begun = scene.begin(&camera.expect("it sees"));
    begun.expect("a bin a line");
    let defaults = PlayerSettings::default();
    let settings = PlayerSettings {
        camera: true,
        draw: Draw {
            light: Light::new([0.0, 1.0, 0.0], 0.1),
            ..defaults.draw
        },
        ..defaults
    };
    let memory = PlayerMemory {
        positions: &mut positions,
        normals: &mut normals,
        colours: &mut colours,
        indices: &mut indices,
        places: &mut places,
        alphas: &mut alphas,
        names: &names,
        textures: &mut textures,
        texels: &mut texels,
        levels: &mut levels,
        overlays: &overlays,
        lights: Some(&mut lights),
    };
    let mut player = Player::<Look>::new(memory, settings);
    player.start(0);
    let (mut left, mut notices) = (BUDGET, 0);
    let mut done = Ok(Halt::Sync);
    for _ in 0..4 {
        done = player.run(list, &mut scene, &mut left, &mut |_: Notice| notices += 1);
        match done {
            Ok(Halt::Paused | Halt::Sync) => player.command(ListCommand::Resume),
            _ => break,
        }
    }
    // Each block can cause a few events, a face that finds no room among them.
    assert!(notices < 10_000, "{notices}");
    assert!(player.counts().blocks <= BUDGET.instructions - left.instructions);
    show(&scene, list, &overlays);
    Played {
        good: done.map_or_else(|error| error.offset / 4, |_| player.position()),
        ended: done == Ok(Halt::End),
    }
}

/// Draws some lines of a scene, with the overlays of a list.
fn show(scene: &Scene<'_, '_, Look>, words: &[u32], slots: &[OverlaySlot]) {
    let mut cache = FastMemory::<Look, 1>::new();
    cache.set_limit(4);
    let (mut links, mut depth) = ([Link::NONE; 512], [0; 32]);
    let mut renderer = Renderer::new(LineMemory {
        cache: &mut cache,
        links: &mut links,
        depth: &mut depth,
    });
    let over = ListOverlays { words, slots };
    for y in [0, 12, 23] {
        let mut pixels = [0; 32];
        let drawn = renderer.draw_line(scene, y, &mut pixels, 0);
        drawn.expect("there is room for all");
        over.paint::<Rgb565>(y, &mut pixels);
    }
}
