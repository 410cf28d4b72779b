//! Any bytes as a list: no panic, no hang, work within the budget (X7).

use scanbeam::event::Notice;
use scanbeam::input::{EightLights, ListMemory, ListRunner, ListSettings};
use scanbeam::list::{Budget, Halt, ListCommand, OverlaySlot, TextureSlot};
use scanbeam::overlay::{LineOverlay, ListOverlays};
use scanbeam::pipeline::texture::ListTextures;
use scanbeam::pipeline::{
    Instance, LineMemory, LineRenderer, ListedDepth, ObjectOf, Scene, SceneMemory, VertexOf,
};
use scanbeam::pixel::Rgb888;
use scanbeam::{Camera, Light, Link, Screen};

type Look<'t> = ListedDepth<'t, Rgb888>;

/// What a list may cause, each resumption included.
const BUDGET: Budget = Budget {
    instructions: 64,
    vertices: 4096,
    jumps: 8,
};

/// Executes the bytes; panics when something does not hold. How many blocks were executed.
pub fn run(data: &[u8]) -> usize {
    let list: Vec<u32> = data
        .chunks_exact(4)
        .map(|b| u32::from_ne_bytes([b[0], b[1], b[2], b[3]]))
        .collect();
    let overlays = [const { OverlaySlot::new() }; 3];
    let slots = [const { TextureSlot::new() }; 8];
    let mut vertices = [VertexOf::<Look<'_>>::empty(); 512];
    let mut objects = [ObjectOf::<Look<'_>>::default(); 512];
    let mut buckets = [Link::NONE; 24];
    let mut scene = Scene::<Look<'_>>::new(
        Screen::new(32, 24).expect("within the limits"),
        SceneMemory {
            vertices: &mut vertices,
            objects: &mut objects,
            buckets: &mut buckets,
        },
    );
    let camera = Camera::look_at([0.0, 0.0, 4.0], [0.0; 3], [0.0, 1.0, 0.0], 30.0, 0.1, 99.0);
    scene
        .begin(&camera.expect("it sees"))
        .expect("a bucket a line");
    scene.set_textures(ListTextures {
        words: &list,
        slots: &slots,
    });
    let (mut positions, mut normals) = ([[0i16; 3]; 32], [[0; 3]; 32]);
    let (mut colours, mut indices) = ([[0; 3]; 32], [0; 48]);
    let mut places = [[0; 2]; 32];
    let mut runner = ListRunner::<'_, '_, _, EightLights>::with_lights(
        ListMemory {
            positions: &mut positions,
            normals: &mut normals,
            colours: &mut colours,
            indices: &mut indices,
            places: &mut places,
            textures: &slots,
            overlays: &overlays,
        },
        ListSettings {
            camera: true,
            instance: Instance {
                light: Light::new([0.0, 1.0, 0.0], 0.1),
                ..Instance::default()
            },
            ..ListSettings::default()
        },
    );
    runner.start(0);
    let mut left = BUDGET;
    for _ in 0..4 {
        match runner.run(&list[..], &mut scene, &mut left, &mut |_: Notice| {}) {
            Ok(Halt::Paused | Halt::Sync) => runner.command(ListCommand::Resume),
            _ => break,
        }
    }
    let mut cache = [LineRenderer::<Look<'_>>::empty_slot(); 4];
    let (mut links, mut depth) = ([Link::NONE; 512], [0; 32]);
    let mut lines = LineRenderer::<Look<'_>>::new(LineMemory {
        slots: &mut cache,
        links: &mut links,
        depth: &mut depth,
    });
    let mut over = ListOverlays {
        words: &list,
        slots: &overlays,
    };
    for y in [0, 12, 23] {
        let mut pixels = [[0; 3]; 32];
        lines
            .draw_line(&scene, y, &mut pixels)
            .expect("there is room for all");
        LineOverlay::<Rgb888>::paint(&mut over, y, &mut pixels);
    }
    assert!(runner.counts().blocks <= BUDGET.instructions - left.instructions);
    (BUDGET.instructions - left.instructions) as usize
}
