//! K9: shadow volumes of meshes, against rays cast in f64, and what is
//! refused. The worlds, and what rays say of them, are those of `shadow_world`.

use crate::common::Rng;
use crate::hot::shine::even_light;
use crate::hot::{LineRooms, SceneRooms, Smooth, WordOf, line};
use crate::shadow_world::{
    ADDS, Body, DARK, From, LIT, WHITE, World, camera, many, one, screen, world,
};
use scanbeam::frame::LineError;
use scanbeam::look::{Gouraud, Phong, Textured};
use scanbeam::pixel::{PixelFormat, Rgb565Be, Rgb888};
use scanbeam::scene::{
    Blend, Draw, DrawError, Full, Master, Scene, ScreenCorner, Shadow, ShadowEdge, ShadowLight,
    ShadowMemory, ShadowRoom,
};
use scanbeam::{Cull, Mesh, Screen};

type L = Gouraud<Rgb888>;

/// Draws a body's shadow volume with so many edges, positions and faces lent.
fn throw<L>(
    scene: &mut Scene<'_, '_, L>,
    body: &Body,
    light: &ShadowLight,
    rooms: [usize; 3],
) -> Result<(), DrawError> {
    let memory = ShadowMemory {
        edges: &mut vec![ShadowEdge::default(); rooms[0]],
        positions: &mut vec![[0; 3]; rooms[1]],
        faces: &mut vec![[0; 3]; rooms[2]],
    };
    scene.draw_shadow(&body.mesh(&WHITE), &body.model(), light, memory)
}

fn draw_all(
    scene: &mut Scene<'_, '_, impl scanbeam::look::Look>,
    world: &World,
    colours: &[[u8; 3]],
    what: (Option<Shadow>, Option<Blend>),
) {
    for body in world.bodies.iter().chain([&world.floor]) {
        let call = Draw {
            model: body.model(),
            cull: Cull::None,
            shadow: what.0,
            blend: what.1,
            ..Draw::new(body.mesh(colours))
        };
        scene.draw(&call).unwrap();
    }
}

/// In one light the dark is drawn over, in several each adds its own.
fn build(scene: &mut Scene<'_, '_, impl scanbeam::look::Look>, world: &World) {
    scene.begin(&camera()).unwrap();
    let alone = world.lights.len() == 1;
    draw_all(scene, world, if alone { &LIT } else { &DARK }, (None, None));
    for light in &world.lights {
        for body in &world.bodies {
            throw(scene, body, light, [1_000; 3]).unwrap();
        }
    }
    for (light, adds) in world.lights.iter().zip(&ADDS) {
        if alone {
            let dark = Some(Shadow::Shadowed(light.light));
            draw_all(scene, world, &DARK, (dark, None));
        } else {
            let lit = Some(Shadow::Lit(light.light));
            draw_all(scene, world, adds, (lit, Some(Blend::add(255))));
        }
    }
}

fn rooms(screen: Screen) -> SceneRooms {
    SceneRooms::new(20_000, 8_000, screen.height().into(), 100)
}

/// All lines, every `step`-th first, with so many slots.
pub fn lines<L: Smooth>(scene: &Scene<'_, '_, L>, slots: u16, step: usize) -> Vec<Vec<WordOf<L>>> {
    let mut lines = LineRooms::fitting(scene, slots, true);
    let mut renderer = lines.with_shadows();
    let mut picture = vec![Vec::new(); scene.lines().len()];
    let black = L::Format::from_rgb8([0; 3]);
    for offset in 0..step {
        for y in scene.lines().skip(offset).step_by(step) {
            picture[usize::from(y)] = line(&mut renderer, scene, y, black);
        }
    }
    picture
}

pub fn drawn(world: &World) -> Vec<Vec<[u8; 3]>> {
    let mut memory = rooms(screen());
    let mut scene = memory.scene::<L>(screen());
    build(&mut scene, world);
    lines(&scene, 128, 1)
}

#[test]
fn shadows_of_random_closed_meshes_are_those_of_rays() {
    many(41, 1, From::Above, drawn);
}

#[test]
fn several_lights_each_have_their_shadows() {
    many(43, 2, From::Above, drawn);
}

/// Kills: a volume that does not begin where its mesh is on the screen, in the first three of these worlds; depths of both
/// that are held to be exact, in the others.
#[test]
fn shadows_begin_at_what_casts_them() {
    for (seed, number) in [
        (1035, 35),
        (1081, 8),
        (1111, 22),
        (1000, 26),
        (1022, 8),
        (1026, 5),
        (1026, 29),
        (1032, 23),
        (1072, 14),
        (1087, 33),
        (1098, 31),
    ] {
        one(seed, number, 2, drawn);
    }
}

#[test]
fn the_eye_may_be_in_a_shadow() {
    many(47, 1, From::Behind, drawn);
}

/// Both ends of a volume cross the near plane: the lit faces, and their copies far away.
#[test]
fn the_far_end_of_a_shadow_may_be_cut_too() {
    many(78, 1, From::Beside, drawn);
}

/// Several renderers over one scene, each with slots, lines and counts of its own.
fn is_the_same_for_all<L: Smooth>(rng: &mut Rng)
where
    WordOf<L>: PartialEq,
{
    for round in 0..6 {
        let from = [From::Behind, From::Above, From::Beside][round % 3];
        let world = world(rng, 1 + round as u8 % 2, from);
        let mut memory = rooms(screen());
        let mut scene = memory.scene::<L>(screen());
        build(&mut scene, &world);
        let scene = &scene;
        let want = lines(scene, 128, 1);
        for slots in [0, 1, 7, 40] {
            assert!(lines(scene, slots, 1) == want, "{slots} slots");
            assert!(lines(scene, slots, 5) == want, "{slots} slots, lines apart");
        }
    }
}

#[test]
fn any_cache_and_any_lines_give_the_same_shadows() {
    let mut rng = Rng::new(105);
    is_the_same_for_all::<Gouraud<Rgb888>>(&mut rng);
    is_the_same_for_all::<Gouraud<Rgb565Be>>(&mut rng);
    is_the_same_for_all::<Textured<Rgb565Be>>(&mut rng);
}

#[test]
fn memory_that_is_too_short_is_named_and_nothing_is_drawn() {
    let world = world(&mut Rng::new(2), 1, From::Above);
    let (body, light) = (&world.bodies[0], &world.lights[0]);
    let mut memory = rooms(screen());
    let mut scene = memory.scene::<L>(screen());
    assert_eq!(
        throw(&mut scene, body, light, [1_000; 3]),
        Err(DrawError::NotBegun)
    );
    scene.begin(&camera()).unwrap();
    for (rooms, expected) in [
        ([2, 1_000, 1_000], ShadowRoom::Edges),
        ([1_000, 3, 1_000], ShadowRoom::Positions),
        ([1_000, 1_000, 3], ShadowRoom::Faces),
    ] {
        let done = throw(&mut scene, body, light, rooms);
        assert_eq!(done, Err(DrawError::Shadow(expected)));
    }
    assert_eq!((scene.objects(), scene.vertices()), (0, 0));
    // Two positions and two faces an edge. Kills: room for one more is asked for.
    let mut least = |which: usize| {
        (0..1_000).find(|&room| {
            let mut rooms = [1_000; 3];
            rooms[which] = room;
            scene.begin(&camera()).unwrap();
            throw(&mut scene, body, light, rooms).is_ok()
        })
    };
    assert_eq!(least(1), least(2));
    // One state for two sides.
    let mut memory = SceneRooms::new(20_000, 8_000, 54, 1);
    let mut scene = memory.scene::<L>(screen());
    scene.begin(&camera()).unwrap();
    let done = throw(&mut scene, body, light, [1_000; 3]);
    let is_full = matches!(
        done,
        Err(DrawError::Full {
            memory: Full::Draws,
            ..
        })
    );
    assert!(is_full, "{done:?}");
    assert_eq!((scene.objects(), scene.vertices()), (0, 0));
    // The state is free again.
    let call = Draw::new(world.floor.mesh(&LIT));
    scene.draw(&call).unwrap();
    // Kills: states of draw calls before it are taken back as well. Two states, of which the floor has one.
    let mut memory = SceneRooms::new(20_000, 8_000, 54, 2);
    let mut scene = memory.scene::<L>(screen());
    scene.begin(&camera()).unwrap();
    scene.draw(&call).unwrap();
    let floor = scene.objects();
    assert!(throw(&mut scene, body, light, [1_000; 3]).is_err());
    assert_eq!(scene.objects(), floor);
    scene.draw(&call).unwrap();
    assert!(scene.draw(&call).is_err(), "there are three states");
}

/// Kills: an error that counts triangles where the call counted them already.
#[test]
fn what_closes_a_shadow_at_the_near_plane_needs_states_of_its_own() {
    let mut closed = 0;
    let worlds = (0..24).flat_map(|seed| {
        [From::Behind, From::Beside].map(|from| world(&mut Rng::new(seed), 1, from))
    });
    for world in worlds {
        let body = world.bodies.last().unwrap();
        let done = [2, 3, 4].map(|states| {
            let mut memory = SceneRooms::new(20_000, 8_000, 54, states);
            let mut scene = memory.scene::<L>(screen());
            scene.begin(&camera()).unwrap();
            let done = throw(&mut scene, body, &world.lights[0], [1_000; 3]);
            assert_eq!(scene.assembled().dropped, 0);
            done
        });
        let full = Err(DrawError::Full {
            memory: Full::Draws,
            triangles: 0,
            first_face: 0,
        });
        if done[0].is_err() {
            assert_eq!(done, [full, full, Ok(())]);
            closed += 1;
        } else {
            assert_eq!(done, [Ok(()); 3]);
        }
    }
    assert!(closed > 4, "{closed}");
}

/// Kills: faces of the far side that are cut where none is.
#[test]
fn volumes_within_the_planes_are_not_cut() {
    let world = world(&mut Rng::new(2), 1, From::Above);
    let body = &world.bodies[0];
    let mut memory = rooms(screen());
    let mut scene = memory.scene::<L>(screen());
    scene.begin(&camera()).unwrap();
    let call = Draw {
        model: body.model(),
        shadow: Some(Shadow::Volume(0)),
        ..Draw::new(body.mesh(&WHITE))
    };
    scene.draw(&call).unwrap();
    assert!(scene.objects() > 0);
    assert_eq!(scene.assembled().clipped, 0);
}

/// A triangle in the picture, whatever it is drawn as.
fn triangle<'a>(mesh: Mesh<'a>, shadow: Option<Shadow>, priority: u8) -> Draw<'a, 'static> {
    Draw {
        shadow,
        priority,
        ..Draw::new(mesh)
    }
}

#[test]
fn priorities_and_lights_without_a_number_are_refused() {
    let world = world(&mut Rng::new(3), 1, From::Above);
    let mesh = world.bodies[0].mesh(&WHITE);
    let mut memory = rooms(screen());
    let mut scene = memory.scene::<L>(screen());
    for shadow in [Shadow::Volume(3), Shadow::Lit(0), Shadow::Shadowed(7)] {
        let with = |priority| triangle(mesh, Some(shadow), priority);
        scene.begin(&camera()).unwrap();
        assert_eq!(scene.draw(&with(1)), Err(DrawError::ShadowRanked));
        scene.draw(&triangle(mesh, None, 9)).unwrap();
        assert_eq!(scene.draw(&with(0)), Err(DrawError::ShadowRanked));
        scene.begin(&camera()).unwrap();
        scene.draw(&with(0)).unwrap();
        let ranked = triangle(mesh, None, 1);
        assert_eq!(scene.draw(&ranked), Err(DrawError::ShadowRanked));
        scene.draw(&triangle(mesh, None, 0)).unwrap();
    }
    let beyond = Some(Shadow::Lit(Shadow::LIGHTS));
    let call = triangle(mesh, beyond, 0);
    assert_eq!(scene.draw(&call), Err(DrawError::ShadowLight));
    let light = ShadowLight {
        light: Shadow::LIGHTS,
        ..world.lights[0]
    };
    let done = throw(&mut scene, &world.bodies[0], &light, [1_000; 3]);
    assert_eq!(done, Err(DrawError::ShadowLight));
    // What has no inside bounds no volume, and is drawn again like any other surface.
    let corners = [[ScreenCorner::default(); 3]];
    for (shadow, drawn) in [
        (Shadow::Volume(0), Err(DrawError::ShadowFlat)),
        (Shadow::Lit(0), Ok(())),
    ] {
        scene.begin(&camera()).unwrap();
        let call = triangle(mesh, Some(shadow), 0);
        assert_eq!(scene.draw_screen(&call, &corners), drawn);
        assert_eq!(scene.draw_points(&call, 1), drawn);
        assert!(drawn.is_ok() || scene.objects() == 0);
    }
    for error in [
        DrawError::ShadowRanked,
        DrawError::ShadowFlat,
        DrawError::ShadowLight,
        DrawError::Shadow(ShadowRoom::Edges),
    ] {
        assert!(error.to_string().starts_with("shadow: "), "{error}");
    }
}

#[test]
fn renderers_without_counts_or_depth_refuse_shadows() {
    let world = world(&mut Rng::new(4), 1, From::Above);
    let mut memory = rooms(screen());
    let mut scene = memory.scene::<L>(screen());
    build(&mut scene, &world);
    let needed = usize::from(screen().width());
    let check = |have: usize, depth: bool| {
        let mut lines = LineRooms::fitting(&scene, 128, depth);
        lines.counts.truncate(have);
        let mut renderer = lines.with_shadows();
        let mut pixels = vec![[1, 2, 3]; needed];
        let drawn = L::draw_line(&mut renderer, &scene, 20, &mut pixels, [0; 3]).err();
        assert!(drawn.is_none() || pixels == vec![[1, 2, 3]; needed]);
        assert_eq!(renderer.check(&scene).err(), drawn);
        drawn
    };
    assert_eq!(check(needed, true), None);
    for have in [0, 1, needed - 1] {
        assert_eq!(check(have, true), Some(LineError::Counts { needed, have }));
    }
    let have = 0;
    assert_eq!(
        check(needed, false),
        Some(LineError::Depth { needed, have })
    );
    let mut lines = LineRooms::fitting(&scene, 128, true);
    let error = LineError::Counts { needed, have };
    assert_eq!(lines.renderer().check(&scene), Err(error));
    assert!(error.to_string().contains("with_shadows"));
    assert_eq!(lines.plain().check(&scene), Err(LineError::Values));
}

/// With shadows or depth off, all that a light reaches; of what is switched off later, nothing is in shadow either.
#[test]
fn shadows_can_be_switched_off() {
    let mut rng = Rng::new(5);
    for lights in [1, 2] {
        let world = world(&mut rng, lights, From::Above);
        let picture = |master: Master, later: Master| {
            let mut memory = rooms(screen());
            let mut scene = memory.scene::<L>(screen());
            scene.set_master(master);
            build(&mut scene, &world);
            scene.set_master(later);
            (lines(&scene, 128, 1), lines(&scene, 3, 1), scene.objects())
        };
        let all = picture(Master::ALL, Master::ALL);
        assert!(all.0 == all.1);
        let off = Master::ALL.without(Master::SHADOWS);
        let lit = picture(off, Master::ALL);
        assert!(lit.0 == lit.1 && lit.0 != all.0 && lit.2 < all.2);
        // Nothing but the background and what is lit.
        let full = match lights {
            1 => LIT[0],
            _ => [0, 1, 2].map(|k| DARK[0][k] + ADDS[0][0][k] + ADDS[1][0][k]),
        };
        let colours = lit.0.iter().flatten();
        assert!(colours.clone().all(|&p| p == full || p == [0; 3]));
        assert!(colours.filter(|&&p| p == full).count() > 500);
        // Calls over each other, and none of them dark in one light.
        let shallow = Master::ALL.without(Master::DEPTH);
        for (master, later) in [
            (shallow, Master::ALL),
            (shallow, shallow),
            (Master::ALL, shallow),
        ] {
            let flat = picture(master, later);
            assert!(flat.0 == flat.1);
            let is_dark = |p: &[u8; 3]| *p == DARK[0];
            assert!(lights > 1 || !flat.0.iter().flatten().any(is_dark));
        }
    }
}

/// Light at pixels: a surface that is drawn again has the same depth, whatever its words are.
#[test]
fn light_at_pixels_has_shadows() {
    let world = world(&mut Rng::new(6), 1, From::Above);
    let light = even_light();
    let mut memory = rooms(screen());
    let mut scene = memory.scene::<Phong<Rgb888>>(screen());
    scene.begin(&camera()).unwrap();
    let draw = |scene: &mut Scene<'_, '_, Phong<Rgb888>>, colour, shadow| {
        for body in world.bodies.iter().chain([&world.floor]) {
            let call = Draw {
                model: body.model(),
                cull: Cull::None,
                colour,
                lamps: light,
                shadow,
                ..Draw::new(Mesh {
                    colours: &[],
                    ..body.mesh(&WHITE)
                })
            };
            scene.draw(&call).unwrap();
        }
    };
    draw(&mut scene, LIT[0], None);
    for body in &world.bodies {
        throw(&mut scene, body, &world.lights[0], [1_000; 3]).unwrap();
    }
    draw(&mut scene, DARK[0], Some(Shadow::Shadowed(0)));
    let want = drawn(&world);
    assert!(lines(&scene, 128, 1) == want);
}
