//! What a preset is lent in the small programs, and the teapot by it.

use crate::small::{Display, exit};
use scanbeam::Link;
use scanbeam::pipeline::{
    CellOf, LineMemory, LineRenderer, ObjectOf, Pipeline, Scene, SceneMemory, SlotOf, VertexOf,
    draw_frame,
};
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scenes::Shot;

/// Slots of the object cache.
pub(crate) const SLOTS: usize = 43;

/// What one pipeline is lent.
pub(crate) struct Room<P: Pipeline> {
    pub(crate) vertices: &'static mut [VertexOf<P>],
    pub(crate) objects: &'static mut [ObjectOf<P>],
    pub(crate) buckets: &'static mut [Link],
    pub(crate) links: &'static mut [Link],
    pub(crate) slots: &'static mut [SlotOf<P>],
    pub(crate) depth: &'static mut [CellOf<P>],
}

/// Lends a [`Room`] for a pipeline whose depth cells start as `$cell`.
macro_rules! room {
    ($pipeline:ty, $cell:expr) => {{
        use crate::lend::lend;
        use crate::preset_room::{Room, SLOTS};
        use crate::small::{OBJECTS, VERTICES};
        use scanbeam::Link;
        use scanbeam::pipeline::{CellOf, LineRenderer, ObjectOf, SlotOf, VertexOf};
        use scenes::{HEIGHT, WIDTH};
        Room::<$pipeline> {
            vertices: lend!(
                ".slow",
                VertexOf<$pipeline>,
                VERTICES,
                VertexOf::<$pipeline>::empty()
            ),
            objects: lend!(
                ".slow",
                ObjectOf<$pipeline>,
                OBJECTS,
                ObjectOf::<$pipeline>::default()
            ),
            buckets: lend!(".slow", Link, HEIGHT as usize, Link::NONE),
            links: lend!(".slow", Link, OBJECTS, Link::NONE),
            slots: lend!(
                ".fast",
                SlotOf<$pipeline>,
                SLOTS,
                LineRenderer::<$pipeline>::empty_slot()
            ),
            depth: lend!(".fast", CellOf<$pipeline>, WIDTH as usize, $cell),
        }
    }};
}
pub(crate) use room;

/// Draws the teapot and sends it.
pub(crate) fn teapot<P: Pipeline<Pixel = Rgb565Be>>(room: Room<P>, display: &mut Display) {
    let memory = SceneMemory {
        vertices: room.vertices,
        objects: room.objects,
        buckets: room.buckets,
    };
    let mut scene = Scene::<P>::new(Shot::screen(), memory);
    let mut renderer = LineRenderer::new(LineMemory {
        slots: room.slots,
        links: room.links,
        depth: room.depth,
    });
    let background = Rgb565Be::from_rgb8(Shot::Teapot.background());
    let built = scenes::teapot(&mut scene);
    let drawn = draw_frame(&scene, &mut renderer, display, background, 1);
    if built.is_err() || drawn.is_err() {
        exit(false);
    }
}
