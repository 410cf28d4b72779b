//! The scenes of the suite in the rooms `scene`, `look` and `frame`: 64 slots, one line a transfer.

use crate::lend::lend;
use crate::rooms::Rooms;
use scanbeam::PixelFormat;
use scanbeam::Rgb565Be;
use scanbeam::frame::{FastMemory, Memory as LineMemory, Renderer, draw_frame};
use scanbeam::scan_out::{Pump, ScanoutDma};
use scanbeam::scene::{DrawState, Memory, Object, Scene, Vertex};
use scenes::{
    HEIGHT, LEAN_DRAWS, LeanLook, SUITE_LINES, SUITE_OBJECTS, SUITE_VERTICES, Shot, Suite,
};

/// What a scene is lent, in external RAM, and the object cache, in tightly coupled RAM. Links and depth are those
/// of other frames.
pub(crate) struct LeanRooms {
    vertices: &'static mut [Vertex],
    objects: &'static mut [Object],
    bins: &'static mut [u16],
    draws: &'static mut [DrawState<'static>],
    cache: &'static mut [FastMemory<LeanLook>],
}

impl LeanRooms {
    /// Takes them, once.
    pub(crate) fn take() -> Self {
        // A constant: 6 KB are copied, and not made on the stack.
        const EMPTY: FastMemory<LeanLook> = FastMemory::new();
        Self {
            vertices: lend!(".slow", Vertex, SUITE_VERTICES, Vertex::EMPTY),
            objects: lend!(".slow", Object, SUITE_OBJECTS, Object::EMPTY),
            bins: lend!(".slow", u16, HEIGHT as usize, 0),
            draws: lend!(".slow", DrawState<'static>, LEAN_DRAWS, DrawState::EMPTY),
            cache: lend!(".fast", FastMemory<LeanLook>, 1, EMPTY),
        }
    }
}

/// Draws a scene of the suite.
#[inline(never)]
pub(crate) fn draw_lean<D>(suite: Suite, rooms: &mut Rooms, pump: &mut Pump<D>)
where
    D: ScanoutDma<Buf = &'static mut [u16]>,
{
    let lean = &mut rooms.lean;
    let mut scene = Scene::<LeanLook>::new(
        Shot::screen(),
        Memory {
            vertices: lean.vertices,
            places: &mut [],
            objects: lean.objects,
            bins: lean.bins,
            draws: lean.draws,
        },
    );
    suite
        .build_lean(&mut scene)
        .expect("the rooms are large enough");
    let [cache] = lean.cache else {
        unreachable!("one was lent")
    };
    let mut renderer = Renderer::new(LineMemory {
        cache,
        links: rooms.smooth.links,
        depth: rooms.smooth.depth,
    });
    let background = Rgb565Be::from_rgb8(suite.background());
    draw_frame(&scene, &mut renderer, pump, background, SUITE_LINES)
        .expect("the sink cannot fail and the rooms are large enough");
}
