//! The scenes of the suite in the rooms `scene`, `look` and `frame`: 64 slots, one line a transfer.

use crate::lend::lend;
use crate::rooms::Rooms;
use scanbeam::Link;
use scanbeam::frame::{FastMemory, Memory as LineMemory, Renderer, draw_frame};
use scanbeam::input::{Player, PlayerMemory, TextureRoom};
use scanbeam::list::{ListCommand, TextureSlot};
use scanbeam::look::Look;
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scan_out::{Pump, ScanoutDma};
use scanbeam::scene::{DrawState, Memory, Object, Scene, TexturePlace, Vertex};
use scenes::{
    CRATE_INDICES, CRATE_TABLE, HEIGHT, LIST_INDICES, LIST_TABLE, LeanContours, LeanIndexed,
    LeanLook, LeanPhong, LeanPhongTextured, LeanTextured, PLAYED_NAMES, PLAYED_TEXELS,
    PLAYED_TEXTURES, Played, SUITE_DRAWS, SUITE_LINES, SUITE_OBJECTS, SUITE_VERTICES, Shot, Suite,
    VALUES_SHOWN, Values, ValuesMemory,
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
    lit_texels: &'static mut [FastMemory<LeanPhongTextured>],
    indexed: &'static mut [FastMemory<LeanIndexed>],
    banded: &'static mut [FastMemory<LeanContours>],
    shown: &'static mut [u32],
    teapot: Player<'static, 'static, LeanLook>,
    /// Its textures are made once.
    wood: Player<'static, 'static, LeanTextured>,
}

impl LeanRooms {
    /// Takes them, once.
    pub(crate) fn take() -> Self {
        // A constant: 6 KB are copied, and not made on the stack.
        const EMPTY: FastMemory<LeanLook> = FastMemory::new();
        const TEXTURED: FastMemory<LeanTextured> = FastMemory::new();
        const LIT: FastMemory<LeanPhong> = FastMemory::new();
        const LIT_TEXELS: FastMemory<LeanPhongTextured> = FastMemory::new();
        const INDEXED: FastMemory<LeanIndexed> = FastMemory::new();
        const BANDED: FastMemory<LeanContours> = FastMemory::new();
        Self {
            vertices: lend!(".slow", Vertex, SUITE_VERTICES, Vertex::EMPTY),
            places: lend!(".slow", TexturePlace, SUITE_VERTICES, TexturePlace::EMPTY),
            objects: lend!(".slow", Object, SUITE_OBJECTS, Object::EMPTY),
            bins: lend!(".slow", u16, HEIGHT as usize, 0),
            draws: lend!(".slow", DrawState<'static>, SUITE_DRAWS, DrawState::EMPTY),
            cache: lend!(".fast", FastMemory<LeanLook>, 1, EMPTY),
            textured: lend!(".fast", FastMemory<LeanTextured>, 1, TEXTURED),
            lit: lend!(".slow", FastMemory<LeanPhong>, 1, LIT),
            lit_texels: lend!(".slow", FastMemory<LeanPhongTextured>, 1, LIT_TEXELS),
            indexed: lend!(".slow", FastMemory<LeanIndexed>, 1, INDEXED),
            banded: lend!(".slow", FastMemory<LeanContours>, 1, BANDED),
            shown: lend!(".slow", u32, VALUES_SHOWN, 0),
            teapot: Player::new(teapot_memory(), Played::settings()),
            wood: Player::new(crate_memory(), Played::settings()),
        }
    }

    /// A scene in this memory, and that of a renderer, each with what a player of the look needs.
    fn parts(&mut self) -> Parts<'_> {
        Parts {
            memory: Memory {
                vertices: &mut *self.vertices,
                places: &mut *self.places,
                objects: &mut *self.objects,
                bins: &mut *self.bins,
                draws: &mut *self.draws,
            },
            cache: &mut *self.cache,
            textured: &mut *self.textured,
            teapot: &mut self.teapot,
            wood: &mut self.wood,
        }
    }
}

/// The rooms, apart.
struct Parts<'r> {
    memory: Memory<'r, 'static>,
    cache: &'r mut [FastMemory<LeanLook>],
    textured: &'r mut [FastMemory<LeanTextured>],
    teapot: &'r mut Player<'static, 'static, LeanLook>,
    wood: &'r mut Player<'static, 'static, LeanTextured>,
}

/// The teapot's places are used where they lie.
fn teapot_memory() -> PlayerMemory<'static, 'static> {
    PlayerMemory {
        normals: lend!(".slow", [i16; 3], LIST_TABLE, [0; 3]),
        indices: lend!(".slow", u16, LIST_INDICES, 0),
        ..PlayerMemory::default()
    }
}

fn crate_memory() -> PlayerMemory<'static, 'static> {
    PlayerMemory {
        positions: lend!(".slow", [i16; 3], CRATE_TABLE, [0; 3]),
        normals: lend!(".slow", [i16; 3], CRATE_TABLE, [0; 3]),
        indices: lend!(".slow", u16, CRATE_INDICES, 0),
        places: lend!(".slow", [i32; 2], CRATE_TABLE, [0; 2]),
        names: lend!(".slow", TextureSlot, PLAYED_NAMES, TextureSlot::new()),
        textures: lend!(
            ".slow",
            TextureRoom<'static>,
            PLAYED_TEXTURES,
            TextureRoom::EMPTY
        ),
        texels: lend!(".slow", u16, PLAYED_TEXELS, 0),
        ..PlayerMemory::default()
    }
}

/// Draws a scene of the suite.
#[inline(never)]
pub(crate) fn draw_lean<D>(suite: Suite, rooms: &mut Rooms, pump: &mut Pump<D>)
where
    D: ScanoutDma<Buf = &'static mut [u16]>,
{
    let parts = rooms.lean.parts();
    let (links, depth) = (&mut *rooms.smooth.links, &mut *rooms.smooth.depth);
    let background = suite.background();
    match (parts.textured, parts.cache) {
        ([cache], _) if suite.texels().is_some() => {
            let mut scene = Scene::<LeanTextured>::new(Shot::screen(), parts.memory);
            suite.build(&mut scene).expect(LARGE);
            send(&scene, lines(cache, links, depth), background, pump);
        }
        (_, [cache]) => {
            let mut scene = Scene::<LeanLook>::new(Shot::screen(), parts.memory);
            suite.build(&mut scene).expect(LARGE);
            send(&scene, lines(cache, links, depth), background, pump);
        }
        _ => {}
    }
}

/// Draws a list; it is looked at before, or taken to be what it was.
#[inline(never)]
pub(crate) fn draw_played<D>(played: Played, rooms: &mut Rooms, pump: &mut Pump<D>)
where
    D: ScanoutDma<Buf = &'static mut [u16]>,
{
    let begin = ListCommand::Start(0);
    let parts = rooms.lean.parts();
    let (links, depth) = (&mut *rooms.smooth.links, &mut *rooms.smooth.depth);
    let background = played.background();
    match (played, parts.textured, parts.cache) {
        (Played::Crate, [cache], _) => {
            let mut scene = Scene::<LeanTextured>::new(Shot::screen(), parts.memory);
            played.play(parts.wood, begin, &mut scene).expect(LARGE);
            send(&scene, lines(cache, links, depth), background, pump);
        }
        (Played::Teapot, _, [cache]) => {
            let mut scene = Scene::<LeanLook>::new(Shot::screen(), parts.memory);
            played.play(parts.teapot, begin, &mut scene).expect(LARGE);
            send(&scene, lines(cache, links, depth), background, pump);
        }
        _ => {}
    }
}

/// Pass one of the teapot's list alone: the vertices that were transformed and the triangles that were filed.
#[inline(never)]
pub(crate) fn play_teapot(begin: ListCommand, rooms: &mut Rooms) -> (u32, u32) {
    let parts = rooms.lean.parts();
    let mut scene = Scene::<LeanLook>::new(Shot::screen(), parts.memory);
    let counts = Played::Teapot.play(parts.teapot, begin, &mut scene);
    (counts.expect(LARGE).vertices, scene.objects() as u32)
}

/// The scene that lists are played into, empty.
pub(crate) fn scene(rooms: &mut Rooms) -> Scene<'_, 'static, LeanLook> {
    Scene::new(Shot::screen(), rooms.lean.parts().memory)
}

const LARGE: &str = "the rooms are large enough";

/// What a renderer is lent.
fn lines<'r, L: Look>(
    cache: &'r mut FastMemory<L>,
    links: &'r mut [Link],
    depth: &'r mut [u32],
) -> LineMemory<'r, L> {
    LineMemory {
        cache,
        links,
        depth,
    }
}

/// Draws all lines of a scene.
#[inline(never)]
fn send<L: Look<Pixel = Rgb565Be>, D>(
    scene: &Scene<'_, '_, L>,
    lines: LineMemory<'_, L>,
    background: [u8; 3],
    pump: &mut Pump<D>,
) where
    D: ScanoutDma<Buf = &'static mut [u16]>,
{
    let mut renderer = Renderer::new(lines);
    let background = Rgb565Be::from_rgb8(background);
    draw_frame(scene, &mut renderer, pump, background, SUITE_LINES)
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
    let ([lit_texels], [indexed]) = (&mut *lean.lit_texels, &mut *lean.indexed) else {
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
        lit_texels,
        indexed,
        banded,
    };
    let drawn = values.draw(lent, pump);
    assert!(
        drawn.is_ok(),
        "the sink cannot fail and the rooms are large enough"
    );
}
