//! What reading a list costs: pass one of the baked teapot, from the list and from its own tables
//! unpacked beforehand and drawn by immediate calls.

use crate::rooms::Rooms;
use crate::unpacked::Unpacked;
use scanbeam::scene::Draw;
use scenes::Played;

/// By immediate calls; what [`play_teapot`](crate::lean::play_teapot) gives.
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
