//! What reading a list costs: pass one of the baked teapot, from the list and from its own tables
//! unpacked beforehand and drawn by immediate calls.

use crate::rooms::Rooms;
use crate::unpacked::Unpacked;
use scanbeam::list::ListCommand;
use scanbeam::{Draw, Scene};
use scenes::{Played, SmoothLook};

/// From the list: the vertices that were transformed and the triangles that were filed.
#[inline(never)]
pub(crate) fn by_list(begin: ListCommand, rooms: &mut Rooms) -> (u32, u32) {
    let mut scene = rooms.scene.scene();
    let counts = Played::Teapot.play(&mut rooms.teapot, begin, &mut scene);
    let counts = counts.expect("the rooms are large enough");
    (counts.vertices, scene.objects() as u32)
}

/// By immediate calls; what [`by_list`] gives.
#[inline(never)]
pub(crate) fn by_draws(unpacked: &Unpacked, rooms: &mut Rooms) -> (u32, u32) {
    let mut scene: Scene<'_, '_, SmoothLook> = rooms.scene.scene();
    let camera = Played::Teapot.camera().expect("it sees");
    scene.begin(&camera).expect("a bin for each line");
    let mut vertices = 0;
    for mesh in unpacked.meshes() {
        vertices += mesh.positions.len() as u32;
        let call = Draw {
            mesh,
            ..unpacked.call
        };
        scene.draw(&call).expect("the rooms are large enough");
    }
    (vertices, scene.objects() as u32)
}
