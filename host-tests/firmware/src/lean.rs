//! The scenes of the suite in the rooms `scene`, `look` and `frame`: 64 slots, one line a transfer.

use crate::lend::lend;
use crate::rooms::Rooms;
use scanbeam::frame::{FastMemory, Memory as LineMemory, Renderer, draw_frame};
use scanbeam::look::Look;
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scan_out::{Pump, ScanoutDma};
use scanbeam::scene::{DrawState, Memory, Object, Scene, TexturePlace, Vertex};
use scenes::{
    HEIGHT, LEAN_DRAWS, LeanContours, LeanLook, LeanPhong, LeanTextured, SUITE_LINES,
    SUITE_OBJECTS, SUITE_VERTICES, Shot, Suite, VALUES_SHOWN, Values, ValuesMemory,
};

/// What a scene is lent, in external RAM, and the object cache, in tightly coupled RAM. Links and depth are those
/// of other frames.
pub(crate) struct LeanRooms {
    vertices: &'static mut [Vertex],
    places: &'static mut [TexturePlace],
    objects: &'static mut [Object],
    bins: &'static mut [u16],
    draws: &'static mut [DrawState<'static>],
    cache: &'static mut [FastMemory<LeanLook>],
    textured: &'static mut [FastMemory<LeanTextured>],
    /// In external RAM, as what is shown: here instructions count.
    lit: &'static mut [FastMemory<LeanPhong>],
    banded: &'static mut [FastMemory<LeanContours>],
    shown: &'static mut [u32],
}

impl LeanRooms {
    /// Takes them, once.
    pub(crate) fn take() -> Self {
        // A constant: 6 KB are copied, and not made on the stack.
        const EMPTY: FastMemory<LeanLook> = FastMemory::new();
        const TEXTURED: FastMemory<LeanTextured> = FastMemory::new();
        const LIT: FastMemory<LeanPhong> = FastMemory::new();
        const BANDED: FastMemory<LeanContours> = FastMemory::new();
        Self {
            vertices: lend!(".slow", Vertex, SUITE_VERTICES, Vertex::EMPTY),
            places: lend!(".slow", TexturePlace, SUITE_VERTICES, TexturePlace::EMPTY),
            objects: lend!(".slow", Object, SUITE_OBJECTS, Object::EMPTY),
            bins: lend!(".slow", u16, HEIGHT as usize, 0),
            draws: lend!(".slow", DrawState<'static>, LEAN_DRAWS, DrawState::EMPTY),
            cache: lend!(".fast", FastMemory<LeanLook>, 1, EMPTY),
            textured: lend!(".fast", FastMemory<LeanTextured>, 1, TEXTURED),
            lit: lend!(".slow", FastMemory<LeanPhong>, 1, LIT),
            banded: lend!(".slow", FastMemory<LeanContours>, 1, BANDED),
            shown: lend!(".slow", u32, VALUES_SHOWN, 0),
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
    let memory = Memory {
        vertices: &mut *lean.vertices,
        places: &mut *lean.places,
        objects: &mut *lean.objects,
        bins: &mut *lean.bins,
        draws: &mut *lean.draws,
    };
    let (links, depth) = (&mut *rooms.smooth.links, &mut *rooms.smooth.depth);
    if suite.texels().is_some() {
        if let [cache] = &mut *lean.textured {
            let lines = LineMemory {
                cache,
                links,
                depth,
            };
            draw_as::<LeanTextured, D>(suite, memory, lines, pump);
        }
    } else if let [cache] = &mut *lean.cache {
        let lines = LineMemory {
            cache,
            links,
            depth,
        };
        draw_as::<LeanLook, D>(suite, memory, lines, pump);
    }
}

/// The same with a look.
#[inline(never)]
fn draw_as<L: Look<Pixel = Rgb565Be>, D>(
    suite: Suite,
    memory: Memory<'_, 'static>,
    lines: LineMemory<'_, L>,
    pump: &mut Pump<D>,
) where
    D: ScanoutDma<Buf = &'static mut [u16]>,
{
    let mut scene = Scene::<L>::new(Shot::screen(), memory);
    suite
        .build_lean(&mut scene)
        .expect("the rooms are large enough");
    let mut renderer = Renderer::new(lines);
    let background = Rgb565Be::from_rgb8(suite.background());
    draw_frame(&scene, &mut renderer, pump, background, SUITE_LINES)
        .expect("the sink cannot fail and the rooms are large enough");
}

/// Draws a small frame of what few draw calls have.
#[inline(never)]
pub(crate) fn draw_values<D>(values: Values, rooms: &mut Rooms, pump: &mut Pump<D>)
where
    D: ScanoutDma<Buf = &'static mut [u16]>,
{
    let lean = &mut rooms.lean;
    let ([smooth], [textured]) = (&mut *lean.cache, &mut *lean.textured) else {
        return;
    };
    let ([lit], [banded]) = (&mut *lean.lit, &mut *lean.banded) else {
        return;
    };
    let lent = ValuesMemory {
        vertices: &mut *lean.vertices,
        places: &mut *lean.places,
        objects: &mut *lean.objects,
        links: &mut *rooms.smooth.links,
        bins: &mut *lean.bins,
        depth: &mut *rooms.smooth.depth,
        shown: &mut *lean.shown,
        smooth,
        textured,
        lit,
        banded,
    };
    let drawn = values.draw(lent, pump);
    assert!(
        drawn.is_ok(),
        "the sink cannot fail and the rooms are large enough"
    );
}
