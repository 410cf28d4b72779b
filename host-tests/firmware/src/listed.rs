//! What reading a list costs: pass one of the baked teapot, from the list and from its own tables
//! unpacked beforehand and drawn by immediate calls.

use crate::frames::Smooth;
use crate::rooms::{Rooms, RoomsOf};
use crate::unpacked::Unpacked;
use scanbeam::mesh::Vertices;
use scanbeam::pipeline::{Scene, SceneMemory};
use scanbeam::scene::Draw;
use scanbeam::{Camera, Faces};
use scenes::{Played, Shot, build_listed};

fn scene(smooth: &mut RoomsOf<Smooth>) -> Scene<'_, Smooth> {
    Scene::new(
        Shot::screen(),
        SceneMemory {
            vertices: smooth.vertices,
            objects: smooth.objects,
            buckets: smooth.buckets,
        },
    )
}

/// From the list; the vertices that were transformed and the objects that were filed.
pub(crate) fn from_list(rooms: &mut Rooms) -> (u32, u32) {
    let mut scene = scene(&mut rooms.smooth);
    let counts = build_listed(&mut scene, rooms.list.memory());
    let counts = counts.expect("the rooms are large enough");
    (counts.vertices, scene.pass_one().objects)
}

/// By immediate calls; what [`from_list`] gives.
pub(crate) fn by_calls(unpacked: &Unpacked, rooms: &mut Rooms) -> (u32, u32) {
    let mut scene = scene(&mut rooms.smooth);
    let (eye, up) = ([0.0, 1.2, 2.6], [0.0, 1.0, 0.0]);
    let camera = Camera::look_at(eye, [0.0; 3], up, 300.0, 0.1, 100.0);
    scene
        .begin(&camera.expect("it sees"))
        .expect("a bucket for each line");
    let mut vertices = 0;
    for mesh in unpacked.meshes() {
        vertices += mesh.positions.len() as u32;
        let Faces::Triangles(faces) = mesh.faces else {
            continue;
        };
        let vertices = Vertices {
            positions: mesh.positions,
            normals: mesh.normals,
            colours: &[],
        };
        scene
            .draw_indexed(vertices, faces, &unpacked.instance)
            .expect("the rooms are large enough");
    }
    (vertices, scene.pass_one().objects)
}

/// By immediate calls in the rooms; what [`play_teapot`](crate::lean::play_teapot) gives.
#[inline(never)]
pub(crate) fn by_draws(unpacked: &Unpacked, rooms: &mut Rooms) -> (u32, u32) {
    let mut scene = crate::lean::scene(rooms);
    let camera = Played::Teapot.camera().expect("it sees");
    scene.begin(&camera).expect("a bin for each line");
    let instance = &unpacked.instance;
    let mut vertices = 0;
    for mesh in unpacked.meshes() {
        vertices += mesh.positions.len() as u32;
        let call = Draw {
            model: instance.model,
            light: instance.light,
            colour: instance.colour,
            ..Draw::new(mesh)
        };
        scene.draw(&call).expect("the rooms are large enough");
    }
    (vertices, scene.objects() as u32)
}
