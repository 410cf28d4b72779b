//! What documents say and no other proof holds: shadows of meshes with edges of several faces, faces on the near
//! and the far plane.

use host_tests::rooms::{self, Room};
use scanbeam::look;
use scanbeam::mesh::I2F14;
use scanbeam::pixel::Rgb888;
use scanbeam::scene::{Draw, Shadow, ShadowEdge, ShadowLight, ShadowMemory};
use scanbeam::{Affine, Camera, Cull, Faces, Mesh, Screen};

/// The picture of a floor in the shadow of meshes.
fn shaded(meshes: &[&[[u16; 3]]], positions: &[[i16; 3]]) -> Vec<Vec<[u8; 3]>> {
    let room = Room {
        vertices: 400,
        places: 0,
        objects: 400,
        draws: 32,
    };
    let screen = Screen::new(64, 48).unwrap();
    let mut rooms = rooms::SceneRooms::new(room, 48);
    let mut scene = rooms.scene::<look::Gouraud<Rgb888>>(screen);
    let eye = [0.4, 2.5, 2.0];
    let camera = Camera::look_at(eye, [0.0; 3], [0.0, 1.0, 0.0], 40.0, 0.1, 99.0).unwrap();
    scene.begin(&camera).unwrap();
    let c = 32_000;
    let floor = [[-c, 0, -c], [c, 0, -c], [c, 0, c], [-c, 0, c]];
    let faces = [[0, 2, 1], [0, 3, 2]];
    let mesh = |positions, faces| Mesh {
        positions,
        normals: &[],
        colours: &[],
        faces: Faces::Triangles(faces),
    };
    let plain = Draw {
        cull: Cull::None,
        ..Draw::new(mesh(&floor[..], &faces[..]))
    };
    scene.draw(&plain).unwrap();
    let light = ShadowLight {
        light: 0,
        direction: [I2F14::ZERO, I2F14::ONE, I2F14::ZERO],
        reach: 3,
    };
    for faces in meshes {
        let memory = ShadowMemory {
            edges: &mut [ShadowEdge::default(); 32],
            positions: &mut [[0; 3]; 64],
            faces: &mut [[0; 3]; 64],
        };
        scene
            .draw_shadow(&mesh(positions, faces), &Affine::IDENTITY, &light, memory)
            .unwrap();
    }
    let dark = Draw {
        colour: [40; 3],
        shadow: Some(Shadow::Shadowed(0)),
        ..plain
    };
    scene.draw(&dark).unwrap();
    let mut lines: rooms::LineRooms<look::Gouraud<Rgb888>> =
        rooms::LineRooms::new(room.objects, 64).with_counts();
    let mut renderer = lines.renderer();
    let line = |y| {
        let mut line = vec![[0; 3]; 64];
        renderer.draw_line(&scene, y, &mut line, [0; 3]).unwrap();
        line
    };
    scene.lines().map(line).collect()
}

/// K9: a volume is closed whatever the mesh is: faces that share an edge the same way cast the
/// shadow that they cast one by one.
#[test]
fn edges_of_several_faces_are_drawn_out_for_each() {
    // One edge, along x, and corners on both sides of it and one above the other.
    let positions = [
        [-9000, 6000, 0],
        [9000, 6000, 0],
        [0, 6000, -9000],
        [3000, 9000, -7000],
        [-2000, 3000, -12_000],
    ];
    let (a, b, c) = ([0, 1, 2], [0, 1, 3], [0, 1, 4]);
    for faces in [&[a, b][..], &[a, b, c], &[b, c, a], &[c, c]] {
        let apart: Vec<&[[u16; 3]]> = faces.chunks(1).collect();
        let (together, one_by_one) = (shaded(&[faces], &positions), shaded(&apart, &positions));
        let dark = |p: &Vec<Vec<[u8; 3]>>| p.iter().flatten().filter(|p| **p == [40; 3]).count();
        assert!(dark(&one_by_one) > 30, "{}", dark(&one_by_one));
        assert!(together == one_by_one, "{faces:?}");
    }
}

/// How many pixels are drawn of a triangle, seen from 2 in front of the origin, from 1 to 3 far away, 160 pixels being as
/// wide there as 160 / `focal` of the distance.
fn drawn(positions: [[i16; 3]; 3], focal: f32) -> usize {
    let room = Room {
        vertices: 40,
        places: 0,
        objects: 40,
        draws: 1,
    };
    let mut rooms = rooms::SceneRooms::new(room, 120);
    let mut scene = rooms.scene::<look::Gouraud<Rgb888>>(Screen::new(160, 120).unwrap());
    let camera = Camera::look_at([0.0, 0.0, 2.0], [0.0; 3], [0.0, 1.0, 0.0], focal, 1.0, 3.0);
    scene.begin(&camera.unwrap()).unwrap();
    let triangle = Draw {
        cull: Cull::None,
        colour: [255; 3],
        ..Draw::new(Mesh {
            positions: &positions,
            normals: &[],
            colours: &[],
            faces: Faces::Triangles(&[[0, 1, 2]]),
        })
    };
    scene.draw(&triangle).unwrap();
    let mut lines: rooms::LineRooms<look::Gouraud<Rgb888>> =
        rooms::LineRooms::new(room.objects, 160).with_counts();
    let mut renderer = lines.renderer();
    let pixels = scene.lines().map(|y| {
        let mut line = vec![[0; 3]; 160];
        renderer.draw_line(&scene, y, &mut line, [0; 3]).unwrap();
        line.iter().filter(|pixel| **pixel != [0; 3]).count()
    });
    pixels.sum()
}

/// The nearest and the farthest distance are drawn, also of a face whose corners are all far beyond the picture. Kills:
/// planes that are off.
#[test]
fn faces_on_the_near_and_the_far_plane_are_drawn() {
    let one = 16_384;
    let at = |z: i16| drawn([[0, 0, z], [15_000, 0, z], [0, 5_000, z]], 120.0);
    let all = |z: i16| {
        drawn(
            [[-32_768, -32_768, z], [32_767, -32_768, z], [0, 32_767, z]],
            9_000.0,
        )
    };
    // Neither nearer than 1 nor farther than 3.
    for (kept, dropped) in [(-one, -one - 1), (one, one + 1)] {
        assert!(at(kept) > 200, "{kept}");
        assert_eq!(at(dropped), 0, "{dropped}");
        assert_eq!([all(kept), all(dropped)], [160 * 120, 0], "{kept}");
    }
}
