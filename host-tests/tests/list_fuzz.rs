//! Any bytes: no panic, no hang, bounded work (X7). What `fuzz/src/list.rs` does for as
//! long as it is let, done here for a while, on random words and on damaged lists.

mod common;

use common::{LineRooms, Rng, SceneRooms};
use scanbeam::list::{
    Bounds, Budget, Field, FieldForm, Flow, Header, Id, ListWriter, Material, Matrix, Palette,
    State, TexelForm, Texture, TextureSlot, VertexFormat, parameter,
};
use scanbeam::{
    Camera, Instance, Light, ListMemory, ListRunner, ListSettings, ListTextures, ListedDepth,
    Notice, Rgb888, Screen,
};

/// Memory of a scene whose textures lie in a list.
type Rooms<'t> = SceneRooms<ListedDepth<'t, Rgb888>>;

const BUDGET: Budget = Budget {
    instructions: 64,
    vertices: 4096,
    jumps: 8,
};

/// Runs a list and draws two lines of what it made; how much of the budget was spent.
fn survives<'t>(list: &'t [u32], slots: &'t [TextureSlot]) -> Budget {
    let mut rooms = Rooms::<'t>::new(512, 512, 30);
    let mut scene = rooms.scene(Screen::new(40, 30).unwrap());
    let camera = Camera::look_at([0.0, 0.0, 4.0], [0.0; 3], [0.0, 1.0, 0.0], 40.0, 0.1, 99.0);
    scene.begin(&camera.unwrap()).unwrap();
    scene.set_textures(ListTextures { words: list, slots });
    let (mut positions, mut normals) = ([[0i16; 3]; 64], [[0; 3]; 64]);
    let (mut colours, mut indices) = ([[0; 3]; 64], [0; 96]);
    let mut places = [[0; 2]; 64];
    let memory = ListMemory {
        positions: &mut positions,
        normals: &mut normals,
        colours: &mut colours,
        indices: &mut indices,
        places: &mut places,
        textures: slots,
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
    let mut line = LineRooms::fitting(4, &scene);
    let mut renderer = line.renderer();
    for y in [0, 17] {
        common::line(&mut renderer, &scene, y);
    }
    left
}

fn slots() -> [TextureSlot; 6] {
    [const { TextureSlot::new() }; 6]
}

#[test]
fn random_words_do_no_harm() {
    let slots = slots();
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
        let left = survives(&list, &slots);
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
        Field {
            parameter: parameter::TEXTURE,
            form: FieldForm::U16x2,
        },
    ])
    .unwrap();
    writer.state(&State::Format(format)).unwrap();
    let bounds = Bounds {
        centre: [0; 3],
        radius: 1 << 29,
        exponent: 1,
        words: 14,
    };
    writer.state(&State::Bounds(bounds)).unwrap();
    writer.state(&State::Matrix(Matrix::IDENTITY)).unwrap();
    let texture = Texture {
        number: 1,
        log_width: 2,
        log_height: 2,
        form: TexelForm::Index4,
        levels: 1,
        palette: 2,
        clamped: false,
        at: 0,
    };
    let at = writer.position();
    writer
        .bulk(&State::Texture(texture), &[0x1234_5678; 2])
        .unwrap();
    let palette = Palette {
        number: 2,
        count: 6,
        at: 0,
    };
    writer
        .bulk(&State::Palette(palette), &[0x00AA_55FF; 6])
        .unwrap();
    writer.flow(Flow::LoadTexture { number: 3, at }).unwrap();
    let material = Material {
        texture: Some(3),
        two_sided: true,
        ..Material::default()
    };
    writer.state(&State::Material(material)).unwrap();
    writer.state(&State::PointSize(5)).unwrap();
    for id in [Id::Short, Id::Long, Id::Points, Id::Quads, Id::Table] {
        let strip = !matches!(id, Id::Table | Id::Points);
        let header = Header {
            shade: true,
            text: true,
            new: strip,
            rm: id == Id::Short,
            ..Header::of(id, 8)
        };
        let words = match id {
            Id::Table => format.table_words(header, 8),
            Id::Long => 8 * 3,
            _ => 8 * format.words(header),
        };
        let data: Vec<u32> = (0..words)
            .map(|_| rng.below(1 << 16) << 16 | rng.below(1 << 16))
            .collect();
        writer.vertices(header, &data).unwrap();
    }
    let indices: Vec<_> = (0..12).map(|_| Some(rng.below(8) as u16)).collect();
    writer.indexed(None, false, indices.into_iter()).unwrap();
    writer.flow(Flow::End).unwrap();
    writer.words().to_vec()
}

#[test]
fn every_cut_and_every_flipped_bit_is_survived() {
    let slots = slots();
    let mut rng = Rng::new(2);
    for _ in 0..3 {
        let list = valid(&mut rng);
        for len in 0..list.len() {
            survives(&list[..len], &slots);
        }
        for bit in 0..32 * list.len() {
            let mut list = list.clone();
            list[bit / 32] ^= 1 << (bit % 32);
            survives(&list, &slots);
        }
    }
}
