//! Parts of lists that are passed over where they are turned away (X3, M4): the same picture as with all parts.

use crate::command_line::Desk;
use crate::common::Rng;
use crate::listing::{PLENTY, blocks, model_of};
use crate::played::{HEIGHT, Kept, WIDTH, begun, played};
use host_tests::image_out::Frame;
use host_tests::lists::bake::{BakeSettings, bake_textured};
use host_tests::lists::read_list;
use host_tests::lists::texels::Picture;
use host_tests::lists::writer::ListWriter;
use host_tests::model::{Material as ModelMaterial, Model};
use host_tests::rooms::{Room, SceneRooms};
use scanbeam::input::PlayerSettings;
use scanbeam::list::{CameraWords, Flow, Instruction, Material, Matrix, State};
use scanbeam::look::{Gouraud, Look, Textured};
use scanbeam::pixel::Rgb565Be;
use scanbeam::scene::{Draw, Shadow};
use scanbeam::{Affine, Camera, Light, Mesh, Screen};

type Smooth = Gouraud<Rgb565Be>;

const UP: [f32; 3] = [0.0, 1.0, 0.0];

/// A model in parts, textured or not.
fn baked(mesh: Mesh<'_>, textured: bool) -> Vec<u32> {
    let mut model: Model = model_of(mesh, [1.0, 0.8, 0.4]);
    let mut pictures = Vec::new();
    if textured {
        let rgb = (0..64 * 3).map(|n| (n * 37 % 251) as u8).collect();
        let picture = Picture::new(&Frame::new(8, 8, rgb).unwrap()).unwrap();
        pictures.push(Some(picture));
        model.materials.push(ModelMaterial::default());
        model.triangle_materials.fill(Some(0));
        for vertex in &mut model.vertices {
            vertex.uv = [vertex.position[0] * 2.0, vertex.position[1] * 2.0];
        }
    }
    let settings = BakeSettings {
        meshlets: true,
        ..BakeSettings::default()
    };
    let baked = bake_textured(&model, &pictures, &settings).unwrap();
    assert!(baked.parts > 8, "{}", baked.parts);
    baked.words
}

/// The same list, of which nothing is passed over.
fn whole(list: &[u32]) -> Vec<u32> {
    let mut whole = list.to_vec();
    for (at, instruction) in blocks(list) {
        if let Instruction::State(State::Cone(_)) = instruction {
            whole[at + 6] = 0;
        }
    }
    whole
}

/// The picture, and how many triangles were submitted.
fn picture<L: Look<Pixel = Rgb565Be>>(
    list: &[u32],
    camera: &Camera,
    settings: PlayerSettings<'static, 'static>,
    indices: usize,
) -> (Vec<u16>, u32) {
    let list: &'static [u32] = Vec::leak(list.to_vec());
    let mut kept = Kept::new(6000, indices);
    let mut player = kept.player::<L>(settings);
    let picture = begun::<L>(camera, |scene| {
        player.start(0);
        played(&mut player, list, scene, PLENTY).unwrap();
    });
    (picture, player.counts().triangles)
}

fn from(rng: &mut Rng) -> Camera {
    let away = rng.pick(&[1.4, 2.5, 20.0]);
    let way = [0, 1, 2].map(|_| rng.signed());
    let length = way.map(|c| c * c).iter().sum::<f64>().sqrt().max(0.1);
    let eye = way.map(|c| (c / length * away) as f32);
    let at = [0, 1, 2].map(|_| rng.signed() as f32 * 0.2);
    Camera::look_at(eye, at, UP, 40.0 * away as f32, 0.05, 99.0).unwrap()
}

fn lit(model: Affine) -> PlayerSettings<'static, 'static> {
    let settings = PlayerSettings::default();
    PlayerSettings {
        draw: Draw {
            model,
            light: Light::new([0.3, 0.8, 0.6], 0.2),
            ..settings.draw
        },
        camera: true,
        ..settings
    }
}

/// From everywhere, with memory for all faces of a table and for few.
///
/// Kills: a spread of a quarter; vertices of the first half of the faces alone are moved.
#[test]
fn a_list_in_parts_is_the_whole_list() {
    fn same<L: Look<Pixel = Rgb565Be>>(list: &[u32], rng: &mut Rng) -> [u32; 2] {
        let whole = whole(list);
        let mut submitted = [0; 2];
        for case in 0..40 {
            let (camera, turn) = (from(rng), Affine::rotation_x(rng.signed() as f32 * 3.0));
            let indices = [12_000, 4800][case % 2];
            let (got, some) = picture::<L>(list, &camera, lit(turn), indices);
            let (want, all) = picture::<L>(&whole, &camera, lit(turn), 24_000);
            assert!(got == want, "case {case}");
            submitted = [submitted[0] + some, submitted[1] + all];
        }
        submitted
    }
    let mut rng = Rng::new(0xC0_4E5);
    for textured in [false, true] {
        let list = baked(scenes::FINE_SPHERE, textured);
        let [some, all] = match textured {
            false => same::<Smooth>(&list, &mut rng),
            true => same::<Textured<Rgb565Be>>(&list, &mut rng),
        };
        assert!(some * 10 < all * 9, "{some} of {all}");
        let teapot = baked(scenes::TEAPOT, textured);
        let [some, all] = match textured {
            false => same::<Smooth>(&teapot, &mut rng),
            true => same::<Textured<Rgb565Be>>(&teapot, &mut rng),
        };
        assert!(some < all, "{some} of {all}");
    }
}

/// Blocks of state, and of flow behind them.
fn written(states: &[State], flow: Option<Flow>) -> Vec<u32> {
    let mut memory = vec![0; 64];
    let mut writer = ListWriter::new(&mut memory);
    for state in states {
        writer.state(state).unwrap();
    }
    if let Some(flow) = flow {
        writer.flow(flow).unwrap();
    }
    writer.words().to_vec()
}

/// The list with another material or another matrix in it, where there was one.
fn changed(list: &[u32], state: State) -> Vec<u32> {
    let kind = std::mem::discriminant(&state);
    let words = written(&[state], None);
    let mut changed = list.to_vec();
    for (at, instruction) in blocks(list) {
        if matches!(&instruction, Instruction::State(s) if std::mem::discriminant(s) == kind) {
            changed[at..at + words.len()].copy_from_slice(&words);
        }
    }
    changed
}

/// Two-sided surfaces, models that are mirrored, and what bounds a shadow.
///
/// Kills: the question for the side, and for the shadow, left out.
#[test]
fn what_is_seen_from_all_sides_is_not_passed_over() {
    let list = baked(scenes::FINE_SPHERE, false);
    let camera = Camera::look_at([0.0, 0.3, 3.0], [0.0; 3], UP, 60.0, 0.1, 99.0).unwrap();
    let submitted = |list: &[u32], settings| {
        let list: &'static [u32] = Vec::leak(list.to_vec());
        let room = Room {
            vertices: 10_000,
            places: 0,
            objects: 20_000,
            draws: 100,
        };
        let mut rooms = SceneRooms::new(room, HEIGHT);
        let mut scene = rooms.scene::<Smooth>(Screen::new(WIDTH, HEIGHT).unwrap());
        scene.begin(&camera).unwrap();
        let mut kept = Kept::new(255, 1536);
        let mut player = kept.player::<Smooth>(settings);
        player.start(0);
        played(&mut player, list, &mut scene, PLENTY).unwrap();
        player.counts().triangles
    };
    let all = submitted(&whole(&list), lit(Affine::IDENTITY));
    assert!(submitted(&list, lit(Affine::IDENTITY)) < all);
    let two_sided = Material {
        two_sided: true,
        ..Material::default()
    };
    let list_of_both = changed(&list, State::Material(two_sided));
    assert_eq!(submitted(&list_of_both, lit(Affine::IDENTITY)), all);
    let rows = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]];
    let mirrored = Affine::from_rows(rows, [0.0; 3]).unwrap();
    assert_eq!(submitted(&list, lit(mirrored)), all);
    let settings = lit(Affine::IDENTITY);
    let volume = PlayerSettings {
        draw: Draw {
            shadow: Some(Shadow::Volume(0)),
            ..settings.draw
        },
        ..settings
    };
    assert_eq!(submitted(&list, volume), all);
}

/// Faces that are drawn by one matrix and camera, and then by others.
///
/// Kills: an eye that stays where it was when the matrix, the camera of the list, or the scene's changes.
#[test]
fn the_eye_is_that_of_the_block() {
    let list = baked(scenes::FINE_SPHERE, false);
    let all = blocks(&list);
    // What is drawn: from the first table on, without the list's end.
    let is_table = |block: &&(usize, Instruction)| matches!(block.1, Instruction::Table(_));
    let first = all.iter().find(is_table).unwrap().0;
    let is_end = |block: &&(usize, Instruction)| block.1 == Instruction::Flow(Flow::End);
    let end = all.iter().find(is_end).unwrap().0;
    let faces = &list[first..end];
    let is_bounds =
        |block: &&(usize, Instruction)| matches!(block.1, Instruction::State(State::Bounds(_)));
    let begin = all.iter().find(is_bounds).unwrap().0 + 7;
    let behind = Affine::rotation_y(3.1).then(&Affine::placed(1.0, [0.3, 0.0, 0.0]).unwrap());
    let behind = State::Matrix(Matrix::try_from(&behind).unwrap());
    let beyond = State::Camera(CameraWords {
        eye: [0.2, 0.4, -2.5],
        at: [0.0; 3],
        up: UP,
        focal: 200.0,
        near: 0.1,
        far: 99.0,
    });
    let front = Camera::look_at([0.0, 0.3, 3.0], [0.0; 3], UP, 60.0, 0.1, 99.0).unwrap();
    let back = Camera::look_at([0.1, -0.3, -3.0], [0.0; 3], UP, 60.0, 0.1, 99.0).unwrap();
    let between = [
        written(&[behind], None),
        written(&[beyond], None),
        written(&[], Some(Flow::Sync)),
    ];
    for (case, between) in between.iter().enumerate() {
        let twice = [&list[begin..first], faces, between, faces].concat();
        let draw = |list: Vec<u32>| {
            let list: &'static [u32] = Vec::leak(list);
            let mut kept = Kept::new(255, 1536);
            let mut player = kept.player::<Smooth>(lit(Affine::IDENTITY));
            let picture = begun::<Smooth>(&front, |scene| {
                player.start(0);
                played(&mut player, list, scene, PLENTY).unwrap();
                if case == 2 {
                    scene.begin(&back).unwrap();
                    played(&mut player, list, scene, PLENTY).unwrap();
                }
            });
            (picture, player.counts())
        };
        let (got, counts) = draw(twice.clone());
        let (want, all) = draw(whole(&twice));
        assert!(got == want, "case {case}");
        assert!(counts.triangles < all.triangles && counts.skipped > 4);
        assert!(counts.skipped_words > 0 && all.skipped_words == 0);
    }
}

/// A cone speaks of whole blocks of faces, and of nothing else.
///
/// Kills: words that are counted from where the cone begins.
#[test]
fn cones_speak_of_faces_alone() {
    let list = baked(scenes::TEAPOT, false);
    let all = blocks(&list);
    let mut cones = 0;
    for (n, (at, instruction)) in all.iter().enumerate() {
        let Instruction::State(State::Cone(cone)) = instruction else {
            continue;
        };
        cones += 1;
        let length: i64 = cone.axis.iter().map(|c| i64::from(*c).pow(2)).sum();
        assert!((length - (1 << 28)).abs() < 1 << 16);
        let end = at + 7 + cone.words as usize;
        let within: Vec<_> = all[n + 1..].iter().take_while(|b| b.0 < end).collect();
        let is_faces = |b: &&(usize, Instruction)| matches!(b.1, Instruction::Indexed(_));
        assert!(!within.is_empty() && within.iter().all(is_faces));
        assert!(all.iter().any(|b| b.0 == end), "a block begins behind it");
    }
    assert!(cones > 8);
}

/// Kills: a flag of the tool that is not looked at.
#[test]
fn the_tool_bakes_in_parts_where_it_is_told_to() {
    const SIDE: usize = 12;
    let mut obj = String::new();
    for n in 0..SIDE * SIDE {
        obj += &format!("v {} {} {}\n", n % SIDE, n / SIDE, n % 3);
    }
    for n in (0..SIDE * (SIDE - 1)).filter(|n| n % SIDE < SIDE - 1) {
        let (here, above) = (n + 1, n + 1 + SIDE);
        obj += &format!(
            "f {here} {} {above}\nf {} {} {above}\n",
            here + 1,
            here + 1,
            above + 1
        );
    }
    let desk = Desk::new(obj);
    for (flag, has) in [("--meshlets", true), ("", false)] {
        let output = desk.run(&format!("bake m.obj -o m.list --json {flag}"));
        let told: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        let list = read_list(&desk.path("m.list")).unwrap();
        let is_cone = |b: &&(usize, Instruction)| matches!(b.1, Instruction::State(State::Cone(_)));
        let cones = blocks(&list).iter().filter(is_cone).count();
        assert_eq!(
            (cones > 1, told["parts"].as_u64()),
            (has, Some(cones as u64)),
            "{flag}"
        );
    }
}
