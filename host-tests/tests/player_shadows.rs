//! K9: shadows of what lists draw, against rays cast in f64, and against the same calls; and what is refused.

use crate::common::Rng;
use crate::hot::SceneRooms;
use crate::hot_path_volumes::{drawn, lines};
use crate::listing::{PLENTY, model_of};
use crate::played::{Kept, played};
use crate::shadow_world::{ADDS, DARK, From, LIT, World, camera, many, screen, world};
use host_tests::lists::bake::{BakeSettings, bake_textured};
use host_tests::lists::writer::{FieldPacker, ListWriter};
use scanbeam::input::{PlayerSettings, RunCounts};
use scanbeam::list::{
    FieldForm, Flow, Halt, Header, Id, Lent, ListCommand, ListError, Material, Matrix, Missing,
    Reason, State,
};
use scanbeam::look::Gouraud;
use scanbeam::pixel::Rgb888;
use scanbeam::scene::{Blend, Draw, Scene, Shadow, ShadowEdge, ShadowLight, ShadowMemory};
use scanbeam::{Affine, Faces, Mesh};

type L = Gouraud<Rgb888>;

/// Writes a mesh as a table, and its faces.
fn write_mesh(writer: &mut ListWriter<'_>, mesh: &Mesh<'_>) {
    let Faces::Triangles(faces) = mesh.faces else {
        panic!("it has triangles");
    };
    let mut words = Vec::new();
    let mut packer = FieldPacker::new(|w| words.push(w));
    for place in mesh.positions {
        let [x, y, z] = place.map(i32::from);
        packer.field(FieldForm::S16x3, [x, y, z, 0]);
    }
    packer.align();
    let table = Header::of(Id::Table, mesh.positions.len() as u16);
    writer.vertices(table, &words).unwrap();
    let indices: Vec<_> = faces.iter().flatten().map(|i| Some(*i)).collect();
    writer.indexed(None, true, indices.into_iter()).unwrap();
}

/// A world in one colour; the floor, which casts no shadow, is not lit.
fn listed(world: &World, colour: [u8; 3]) -> &'static [u32] {
    let mut memory = vec![0; 8192];
    let mut writer = ListWriter::new(&mut memory);
    let bodies = world.bodies.iter().map(|body| (body, false));
    for (body, unlit) in bodies.chain([(&world.floor, true)]) {
        let matrix = Matrix::try_from(&body.model()).unwrap();
        writer.state(&State::Matrix(matrix)).unwrap();
        let material = Material {
            diffuse: colour,
            two_sided: true,
            unlit,
            ..Material::default()
        };
        writer.state(&State::Material(material)).unwrap();
        write_mesh(&mut writer, &body.mesh(&LIT));
    }
    writer.flow(Flow::End).unwrap();
    Vec::leak(writer.words().to_vec())
}

/// Plays a list by memory for so many indices, and for edges, positions and faces of volumes.
fn play(
    scene: &mut Scene<'_, 'static, L>,
    list: &'static [u32],
    settings: PlayerSettings<'_, 'static>,
    (indices, rooms): (usize, Option<[usize; 3]>),
) -> (Result<Halt, ListError>, RunCounts) {
    let mut kept = Kept::new(6_000, indices);
    let [edges, positions, faces] = rooms.unwrap_or_default();
    let mut edges = vec![ShadowEdge::default(); edges];
    let (mut positions, mut faces) = (vec![[0; 3]; positions], vec![[0; 3]; faces]);
    let mut player = kept.player::<L>(settings);
    if rooms.is_some() {
        player = player.with_shadows(ShadowMemory {
            edges: &mut edges,
            positions: &mut positions,
            faces: &mut faces,
        });
    }
    player.start(0);
    let done = played(&mut player, list, scene, PLENTY);
    (done, player.counts())
}

/// What a list is drawn with.
fn with<'m>(
    casts: &'m [ShadowLight],
    shadow: Option<Shadow>,
    blend: Option<Blend>,
) -> PlayerSettings<'m, 'static> {
    let settings = PlayerSettings::default();
    PlayerSettings {
        draw: Draw {
            shadow,
            blend,
            ..settings.draw
        },
        casts,
        ..settings
    }
}

fn rooms() -> SceneRooms {
    SceneRooms::new(60_000, 20_000, screen().height().into(), 4_000)
}

/// As `hot_path_volumes` draws a world by calls.
fn by_lists(world: &World, indices: usize) -> Vec<Vec<[u8; 3]>> {
    let mut memory = rooms();
    let mut scene = memory.scene::<L>(screen());
    scene.begin(&camera()).unwrap();
    let mut play = |colour, settings| {
        let rooms = (indices, Some([1_000; 3]));
        let (done, counts) = play(&mut scene, listed(world, colour), settings, rooms);
        assert_eq!((done, counts.dropped), (Ok(Halt::End), 0));
    };
    let alone = world.lights.len() == 1;
    let colour = if alone { LIT[0] } else { DARK[0] };
    play(colour, with(&world.lights, None, None));
    for (light, adds) in world.lights.iter().zip(&ADDS) {
        // What is drawn again casts nothing.
        let (colour, shadow, blend) = match alone {
            true => (DARK[0], Shadow::Shadowed(light.light), None),
            false => (adds[0], Shadow::Lit(light.light), Some(Blend::add(255))),
        };
        play(colour, with(&world.lights, Some(shadow), blend));
    }
    lines(&scene, 128, 1)
}

/// Kills: volumes of the wrong light, or of what is not lit.
#[test]
fn shadows_of_lists_are_those_of_rays() {
    many(141, 1, From::Above, |world| by_lists(world, 1_000));
    many(142, 2, From::Above, |world| by_lists(world, 1_000));
    many(143, 1, From::Behind, |world| by_lists(world, 1_000));
}

/// Parts of a mesh cast what the whole casts: their borders are counted both ways.
#[test]
fn meshes_that_are_drawn_in_parts_cast_the_same_shadows() {
    for (seed, indices) in [(144, 4), (145, 30)] {
        let mut rng = Rng::new(seed);
        let mut wrong = Vec::new();
        for _ in 0..20 {
            let world = world(&mut rng, 1, From::Above);
            let (got, want) = (by_lists(&world, indices), drawn(&world));
            let pairs = got.iter().flatten().zip(want.iter().flatten());
            wrong.push(pairs.filter(|(got, want)| got != want).count());
        }
        println!("{indices} indices: pixels that differ: {wrong:?}");
        // Between two volumes that begin at the same edge, below 1 % of the picture.
        let all = usize::from(screen().width()) * usize::from(screen().height());
        assert!(wrong.iter().all(|&pixels| 100 * pixels < all), "{wrong:?}");
    }
}

/// Kills: a volume that is drawn by another model, or before its mesh.
#[test]
fn lists_cast_what_calls_cast() {
    let mut rng = Rng::new(146);
    for round in 0..20 {
        let from = [From::Above, From::Behind, From::Beside][round % 3];
        let world = world(&mut rng, 1 + round as u8 % 2, from);
        assert!(by_lists(&world, 1_000) == drawn(&world), "round {round}");
    }
}

/// The world's first body in white, behind what `write` writes.
fn one(world: &World, write: impl FnOnce(&mut ListWriter<'_>)) -> &'static [u32] {
    let mut memory = vec![0; 4096];
    let mut writer = ListWriter::new(&mut memory);
    let matrix = Matrix::try_from(&world.bodies[0].model()).unwrap();
    writer.state(&State::Matrix(matrix)).unwrap();
    write(&mut writer);
    write_mesh(&mut writer, &world.bodies[0].mesh(&LIT));
    writer.flow(Flow::End).unwrap();
    Vec::leak(writer.words().to_vec())
}

/// Two points.
fn points() -> &'static [u32] {
    let mut memory = [0; 16];
    let mut writer = ListWriter::new(&mut memory);
    let header = Header::of(Id::Points, 2);
    writer.vertices(header, &[0; 4]).unwrap();
    writer.flow(Flow::End).unwrap();
    Vec::leak(writer.words().to_vec())
}

/// Kills: shadows of what is seen through, of what is not lit, of points, of what is drawn again.
#[test]
fn what_is_not_lit_and_solid_casts_nothing() {
    let world = world(&mut Rng::new(147), 2, From::Above);
    let casts = &world.lights[..];
    let draws = |list, settings| {
        let mut memory = rooms();
        let mut scene = memory.scene::<L>(screen());
        scene.begin(&camera()).unwrap();
        let (done, counts) = play(&mut scene, list, settings, (1_000, Some([1_000; 3])));
        assert_eq!(done, Ok(Halt::End));
        counts.draws
    };
    let of = |material: Material| {
        one(&world, |writer| {
            writer.state(&State::Material(material)).unwrap();
        })
    };
    let white = Material::default();
    // Its mesh, and two volumes.
    assert_eq!(draws(of(white), with(casts, None, None)), 3);
    assert_eq!(draws(of(white), with(&[], None, None)), 1);
    for (list, settings) in [
        (of(white), with(casts, Some(Shadow::Lit(0)), None)),
        (of(white), with(casts, None, Some(Blend::add(255)))),
        (
            of(Material {
                opacity: 200,
                ..white
            }),
            with(casts, None, None),
        ),
        (
            of(Material {
                unlit: true,
                ..white
            }),
            with(casts, None, None),
        ),
    ] {
        assert_eq!(draws(list, settings), 1);
    }
    assert_eq!(draws(points(), with(casts, None, None)), 1);
}

/// Kills: a list that goes on without its shadows.
#[test]
fn shadows_that_cannot_be_had_are_refused() {
    let world = world(&mut Rng::new(148), 1, From::Above);
    let mut at = 0;
    let list = one(&world, |writer| at = writer.position());
    let lights = |light| {
        [ShadowLight {
            light,
            ..world.lights[0]
        }]
    };
    let ranked = |casts| {
        let settings = with(casts, None, None);
        PlayerSettings {
            draw: Draw {
                priority: 1,
                ..settings.draw
            },
            ..settings
        }
    };
    let (first, beyond) = (lights(0), lights(Shadow::LIGHTS));
    let plenty = Some([1_000; 3]);
    let begun = with(&first, None, None);
    for (settings, rooms, reason) in [
        (begun, None, Reason::Lent(Lent::Shadows)),
        (ranked(&first), plenty, Reason::Missing(Missing::Shadows)),
        (
            with(&beyond, None, None),
            plenty,
            Reason::Missing(Missing::Shadows),
        ),
    ] {
        let mut memory = self::rooms();
        let mut scene = memory.scene::<L>(screen());
        scene.begin(&camera()).unwrap();
        let (done, _) = play(&mut scene, list, settings, (1_000, rooms));
        let error = done.unwrap_err();
        assert_eq!((error.offset, error.block), (0, None));
        assert_eq!(error.reason, reason);
        assert_eq!(scene.objects(), 0, "{reason:?}");
    }
    // What is drawn again, or is a volume itself.
    let shadowed = |priority, shadow| {
        let settings = with(&[], Some(shadow), None);
        PlayerSettings {
            draw: Draw {
                priority,
                ..settings.draw
            },
            ..settings
        }
    };
    for settings in [
        shadowed(1, Shadow::Lit(0)),
        shadowed(0, Shadow::Lit(Shadow::LIGHTS)),
    ] {
        let mut memory = self::rooms();
        let mut scene = memory.scene::<L>(screen());
        scene.begin(&camera()).unwrap();
        let (done, counts) = play(&mut scene, list, settings, (1_000, None));
        assert_eq!(done.unwrap_err().reason, Reason::Missing(Missing::Shadows));
        assert_eq!(counts.draws, 0);
    }
    let mut memory = self::rooms();
    let mut scene = memory.scene::<L>(screen());
    scene.begin(&camera()).unwrap();
    let volume = shadowed(0, Shadow::Volume(0));
    let (done, _) = play(&mut scene, points(), volume, (1_000, None));
    assert_eq!(done.unwrap_err().reason, Reason::Missing(Missing::Shadows));
    // Other settings, and the list once more without a walk.
    let mut memory = self::rooms();
    let mut scene = memory.scene::<L>(screen());
    scene.begin(&camera()).unwrap();
    let mut kept = Kept::new(255, 1_000);
    let mut player = kept.player::<L>(with(&[], None, None));
    player.start(0);
    assert_eq!(played(&mut player, list, &mut scene, PLENTY), Ok(Halt::End));
    player.set(begun);
    player.command(ListCommand::Restart);
    let error = played(&mut player, list, &mut scene, PLENTY).unwrap_err();
    assert_eq!(error.reason, Reason::Lent(Lent::Shadows));
    let again = played(&mut player, list, &mut scene, PLENTY);
    assert_eq!(again, Ok(Halt::Stopped));
    // What only the meshes tell: the block at which they are drawn.
    for rooms in [[2, 1_000, 1_000], [1_000, 3, 1_000], [1_000, 1_000, 3]] {
        let mut memory = self::rooms();
        let mut scene = memory.scene::<L>(screen());
        scene.begin(&camera()).unwrap();
        let (done, _) = play(&mut scene, list, begun, (1_000, Some(rooms)));
        let error = done.unwrap_err();
        assert_eq!(error.reason, Reason::Lent(Lent::Shadows));
        assert!(error.to_string().contains("shadow volumes"), "{error}");
        assert!(error.offset > 4 * at);
    }
    let mut memory = self::rooms();
    let mut scene = memory.scene::<L>(screen());
    scene.begin(&camera()).unwrap();
    let (done, _) = play(&mut scene, list, ranked(&[]), (1_000, None));
    assert_eq!(done, Ok(Halt::End));
    let (done, _) = play(&mut scene, list, begun, (1_000, plenty));
    let error = done.unwrap_err();
    assert_eq!(error.reason, Reason::Missing(Missing::Shadows));
    assert!(error.to_string().contains("by priority"), "{error}");
}

/// What is out of sight or turned away casts shadows, too. Kills: parts that are passed over all the same.
#[test]
fn nothing_that_casts_a_shadow_is_passed_over() {
    let settings = BakeSettings {
        meshlets: true,
        ..BakeSettings::default()
    };
    let model = model_of(scenes::TEAPOT, [1.0; 3]);
    let baked = bake_textured(&model, &[], &settings).unwrap();
    let list: &'static [u32] = Vec::leak(baked.words);
    let beside = Affine::placed(1.0, [40.0, 0.0, -3.0]).unwrap();
    let here = Affine::placed(1.0, [0.0, 0.0, -3.0]).unwrap();
    let mut memory = rooms();
    let mut scene = memory.scene::<L>(screen());
    let casts = world(&mut Rng::new(149), 1, From::Above).lights;
    for model in [here, beside] {
        let skipped = [&casts[..], &[]].map(|casts| {
            let settings = with(casts, None, None);
            let settings = PlayerSettings {
                draw: Draw {
                    model,
                    ..settings.draw
                },
                ..settings
            };
            scene.begin(&camera()).unwrap();
            let lent = (20_000, Some([20_000; 3]));
            let (done, counts) = play(&mut scene, list, settings, lent);
            assert_eq!((done, counts.dropped), (Ok(Halt::End), 0));
            counts.skipped
        });
        assert!(skipped[0] == 0 && skipped[1] > 0, "{skipped:?}");
    }
}
