//! Any bytes: no panic, no hang, bounded work (X7). What `fuzz/src/list.rs` does for as
//! long as it is let, done here for a while, on random words and on damaged lists.

mod common;

use common::{Rng, SceneRooms};
use scanbeam::list::{Budget, Field, FieldForm, Header, Id, ListWriter, VertexFormat, parameter};
use scanbeam::{
    Camera, GouraudDepth, Instance, Light, ListMemory, ListRunner, ListSettings, Notice, Rgb888,
    Screen,
};

const BUDGET: Budget = Budget {
    instructions: 64,
    vertices: 4096,
    jumps: 8,
};

/// Runs a list and draws two lines of what it made; how much of the budget was spent.
fn survives(list: &[u32], rooms: &mut SceneRooms<GouraudDepth<Rgb888>>) -> Budget {
    let mut scene = rooms.scene(Screen::new(40, 30).unwrap());
    let camera = Camera::look_at([0.0, 0.0, 4.0], [0.0; 3], [0.0, 1.0, 0.0], 40.0, 0.1, 99.0);
    scene.begin(&camera.unwrap()).unwrap();
    let (mut positions, mut normals) = ([[0i16; 3]; 64], [[0; 3]; 64]);
    let (mut colours, mut indices) = ([[0; 3]; 64], [0; 96]);
    let memory = ListMemory {
        positions: &mut positions,
        normals: &mut normals,
        colours: &mut colours,
        indices: &mut indices,
    };
    let settings = ListSettings {
        instance: Instance {
            light: Light::new([0.0, 1.0, 0.0], 0.1),
            ..Instance::default()
        },
        camera: true,
        ..ListSettings::default()
    };
    let mut runner = ListRunner::new(memory, settings);
    runner.start(0);
    let mut left = BUDGET;
    let mut notices = 0;
    for _ in 0..3 {
        let _ = runner.run(list, &mut scene, &mut left, &mut |_: Notice| notices += 1);
        runner.command(scanbeam::list::ListCommand::Resume);
    }
    // Each block can cause a few events, a face that finds no room among them.
    assert!(notices < 10_000, "{notices}");
    let mut line = common::LineRooms::fitting(4, &scene);
    let mut renderer = line.renderer();
    for y in [0, 17] {
        common::line(&mut renderer, &scene, y);
    }
    left
}

fn rooms() -> SceneRooms<GouraudDepth<Rgb888>> {
    SceneRooms::new(4096, 4096, 30)
}

#[test]
fn random_words_do_no_harm() {
    let mut rooms = rooms();
    let mut rng = Rng::new(1);
    let mut blocks = 0;
    for _ in 0..100_000 {
        let list: Vec<u32> = (0..rng.below(60))
            .map(|_| {
                let word = rng.below(1 << 16) << 16 | rng.below(1 << 16);
                match rng.below(3) {
                    // Often a header that can be read, of few elements.
                    0 => (word & 0xF000_03F8 | 1 << 24) & !(rng.below(2) * 0xF8),
                    1 => rng.below(40),
                    _ => word,
                }
            })
            .collect();
        let left = survives(&list, &mut rooms);
        blocks += BUDGET.instructions - left.instructions;
    }
    assert!(blocks > 10_000, "{blocks} blocks were run");
}

/// A valid list of some of everything that draws.
fn valid(rng: &mut Rng) -> Vec<u32> {
    let mut memory = vec![0; 1024];
    let mut writer = ListWriter::new(&mut memory);
    let forms = [FieldForm::S16x3, FieldForm::S10x3, FieldForm::S8x3];
    let format = VertexFormat::new(&[
        Field {
            parameter: parameter::PLACE,
            form: rng.pick(&forms),
        },
        Field {
            parameter: parameter::NORMAL,
            form: rng.pick(&forms),
        },
        Field {
            parameter: parameter::DIFFUSE,
            form: FieldForm::U8x3,
        },
    ])
    .unwrap();
    writer
        .state(&scanbeam::list::State::Format(format))
        .unwrap();
    writer
        .state(&scanbeam::list::State::Matrix(
            scanbeam::list::Matrix::IDENTITY,
        ))
        .unwrap();
    for id in [Id::Short, Id::Quads, Id::Table] {
        let header = Header {
            shade: true,
            new: id != Id::Table,
            rm: id == Id::Short,
            ..Header::of(id, 8)
        };
        let words = match id {
            Id::Table => format.table_words(header, 8),
            _ => 8 * format.words(header),
        };
        let data: Vec<u32> = (0..words)
            .map(|_| rng.below(1 << 16) << 16 | rng.below(1 << 16))
            .collect();
        writer.vertices(header, &data).unwrap();
    }
    let indices: Vec<_> = (0..12).map(|_| Some(rng.below(8) as u16)).collect();
    writer.indexed(None, false, indices.into_iter()).unwrap();
    writer.flow(scanbeam::list::Flow::End).unwrap();
    writer.words().to_vec()
}

#[test]
fn every_cut_and_every_flipped_bit_is_survived() {
    let mut rooms = rooms();
    let mut rng = Rng::new(2);
    for _ in 0..3 {
        let list = valid(&mut rng);
        for len in 0..list.len() {
            survives(&list[..len], &mut rooms);
        }
        for bit in 0..32 * list.len() {
            let mut list = list.clone();
            list[bit / 32] ^= 1 << (bit % 32);
            survives(&list, &mut rooms);
        }
    }
}
