//! The memory that the firmware lends, each piece in the region of `memory.x` it belongs to.

use crate::lend::lend;
use crate::unpacked::Unpacked;
use scanbeam::frame::{FastMemory, Memory as LineMemory, Renderer};
use scanbeam::input::{Player, PlayerMemory, TextureRoom};
use scanbeam::list::TextureSlot;
use scanbeam::look::Look;
use scanbeam::mesh::Meshlet;
use scanbeam::scene::{DrawState, Memory, Object, TexturePlace, Vertex};
use scanbeam::{Link, Scene, Screen};
use scenes::{
    CRATE_INDICES, CRATE_TABLE, ContourLook, CutMemory, DRAWS, GreyLook, HEIGHT, Hits, IN_PARTS,
    InParts, IndexedLook, LIST_INDICES, LIST_TABLE, LitBytesLook, LitWordsLook, NumbersLook,
    OBJECTS, Octasphere, PLAYED_NAMES, PLAYED_TEXELS, PLAYED_TEXTURES, PhongLook, Played, Sheet,
    Shot, SmoothLook, Suite, TexturedLook, TexturedPhongLook, TrueColourLook,
    TrueColourTexturedLook, VALUES_SHOWN, VERTICES, WIDTH,
};

/// Lines that one transfer takes, at most.
pub(crate) const LINES_PER_TRANSFER: u16 = 4;
/// Words of 32 slots in the largest cache: [`scenes::MOST_SLOTS`].
pub(crate) const WIDE: usize = 7;

/// Vertices, and triangles, that there is room for: those of any shot and of any sphere.
const MOST_VERTICES: usize = larger(VERTICES, Octasphere::MOST_VERTICES);
const MOST_OBJECTS: usize = larger(OBJECTS, Octasphere::MOST_FACES);

const fn larger(a: usize, b: usize) -> usize {
    if a > b { a } else { b }
}

/// What a scene is lent: external RAM, `.slow`.
pub(crate) struct SceneRooms {
    pub(crate) vertices: &'static mut [Vertex],
    pub(crate) places: &'static mut [TexturePlace],
    pub(crate) objects: &'static mut [Object],
    pub(crate) bins: &'static mut [u16],
    pub(crate) draws: &'static mut [DrawState<'static>],
}

impl SceneRooms {
    /// An empty scene of the size of a shot.
    pub(crate) fn scene<L: Look>(&mut self) -> Scene<'_, 'static, L> {
        self.sized(Shot::screen())
    }

    /// One whose draw states are lent.
    pub(crate) fn lent<'a, 't, L: Look>(
        &'a mut self,
        draws: &'a mut [DrawState<'t>],
    ) -> Scene<'a, 't, L> {
        let memory = Memory {
            vertices: self.vertices,
            places: self.places,
            objects: self.objects,
            bins: self.bins,
            draws,
        };
        Scene::new(Shot::screen(), memory)
    }

    /// One of that size.
    pub(crate) fn sized<L: Look>(&mut self, screen: Screen) -> Scene<'_, 'static, L> {
        let memory = Memory {
            vertices: self.vertices,
            places: self.places,
            objects: self.objects,
            bins: self.bins,
            draws: self.draws,
        };
        Scene::new(screen, memory)
    }
}

/// What renderers of all looks share, one after the other: links in external RAM, and the depth of a line in tightly
/// coupled RAM, `.fast`.
pub(crate) struct LineRooms {
    pub(crate) links: &'static mut [Link],
    pub(crate) depth: &'static mut [u32],
}

impl LineRooms {
    /// A renderer with these slots.
    pub(crate) fn renderer<'r, L: Look, const WORDS: usize>(
        &'r mut self,
        cache: &'r mut FastMemory<L, WORDS>,
    ) -> Renderer<'r, L, WORDS> {
        Renderer::new(LineMemory {
            cache,
            links: self.links,
            depth: self.depth,
        })
    }
}

/// Slots, of the look that most frames have and of textures in tightly coupled RAM, of all others in external RAM:
/// here instructions count.
pub(crate) struct Caches {
    pub(crate) smooth: &'static mut FastMemory<SmoothLook>,
    pub(crate) textured: &'static mut FastMemory<TexturedLook>,
    /// Slots for almost everything.
    pub(crate) wide: &'static mut FastMemory<SmoothLook, WIDE>,
    /// Of a second renderer.
    pub(crate) second: &'static mut FastMemory<SmoothLook>,
    pub(crate) lit: &'static mut FastMemory<PhongLook>,
    pub(crate) lit_texels: &'static mut FastMemory<TexturedPhongLook>,
    pub(crate) indexed: &'static mut FastMemory<IndexedLook>,
    pub(crate) banded: &'static mut FastMemory<ContourLook>,
    pub(crate) true_colour: &'static mut FastMemory<TrueColourLook>,
    pub(crate) true_texels: &'static mut FastMemory<TrueColourTexturedLook>,
    pub(crate) lit_bytes: &'static mut FastMemory<LitBytesLook>,
    pub(crate) lit_words: &'static mut FastMemory<LitWordsLook>,
    pub(crate) grey: &'static mut FastMemory<GreyLook>,
    pub(crate) numbers: &'static mut FastMemory<NumbersLook>,
}

/// What frames are drawn with.
pub(crate) struct Rooms {
    pub(crate) scene: SceneRooms,
    pub(crate) lines: LineRooms,
    /// Of a second renderer: external RAM.
    pub(crate) second: LineRooms,
    pub(crate) caches: Caches,
    /// Depth and colour of two lines each, for the hardware model: external RAM.
    pub(crate) model: [&'static mut [u64]; 4],
    /// Meshes in parts, each cut once.
    cuts: [Option<InParts<'static>>; IN_PARTS.len()],
    /// Where meshes are cut that are not yet.
    cutting: CutMemory<'static>,
    /// What a display shows.
    pub(crate) shown: &'static mut [u32],
    pub(crate) teapot: Player<'static, 'static, SmoothLook>,
    /// Its textures are made once.
    pub(crate) wood: Player<'static, 'static, TexturedLook>,
    /// RAM that a DMA can reach, `.dma`; absent while a pump has them.
    pub(crate) buffers: Option<[&'static mut [u16]; 2]>,
}

/// Slots in the section `$near`: a constant, so that they are copied, and not made on the stack.
macro_rules! slots {
    ($near:literal, $look:ty) => {
        slots!($near, $look, 2)
    };
    ($near:literal, $look:ty, $words:expr) => {{
        const EMPTY: FastMemory<$look, $words> = FastMemory::new();
        let one: &'static mut [_] = lend!($near, FastMemory<$look, $words>, 1, EMPTY);
        one.first_mut().expect("one is lent")
    }};
}

impl Rooms {
    /// Takes all of them, once.
    pub(crate) fn take() -> Self {
        const WORDS: usize = WIDTH as usize * LINES_PER_TRANSFER as usize;
        Self {
            scene: SceneRooms {
                vertices: lend!(".slow", Vertex, MOST_VERTICES, Vertex::EMPTY),
                places: lend!(".slow", TexturePlace, MOST_VERTICES, TexturePlace::EMPTY),
                objects: lend!(".slow", Object, MOST_OBJECTS, Object::EMPTY),
                bins: lend!(".slow", u16, HEIGHT as usize, 0),
                draws: lend!(".slow", DrawState<'static>, DRAWS, DrawState::EMPTY),
            },
            lines: LineRooms {
                links: lend!(".slow", Link, MOST_OBJECTS, Link::EMPTY),
                depth: lend!(".fast", u32, WIDTH as usize, 0),
            },
            second: LineRooms {
                links: lend!(".slow", Link, OBJECTS, Link::EMPTY),
                depth: lend!(".slow", u32, WIDTH as usize, 0),
            },
            caches: Caches {
                smooth: slots!(".fast", SmoothLook),
                textured: slots!(".fast", TexturedLook),
                wide: slots!(".slow", SmoothLook, WIDE),
                second: slots!(".slow", SmoothLook),
                lit: slots!(".slow", PhongLook),
                lit_texels: slots!(".slow", TexturedPhongLook),
                indexed: slots!(".slow", IndexedLook),
                banded: slots!(".slow", ContourLook),
                true_colour: slots!(".slow", TrueColourLook),
                true_texels: slots!(".slow", TrueColourTexturedLook),
                lit_bytes: slots!(".slow", LitBytesLook),
                lit_words: slots!(".slow", LitWordsLook),
                grey: slots!(".slow", GreyLook),
                numbers: slots!(".slow", NumbersLook),
            },
            model: [
                lend!(".slow", u64, WIDTH as usize, 0),
                lend!(".slow", u64, WIDTH as usize, 0),
                lend!(".slow", u64, WIDTH as usize, 0),
                lend!(".slow", u64, WIDTH as usize, 0),
            ],
            cuts: [None; IN_PARTS.len()],
            cutting: CutMemory {
                faces: lend!(".slow", [u16; 3], CutMemory::FACES, [0; 3]),
                parts: lend!(".slow", Meshlet, CutMemory::PARTS, Meshlet::EMPTY),
                vertices: lend!(".slow", u16, CutMemory::VERTICES, 0),
            },
            shown: lend!(".slow", u32, VALUES_SHOWN, 0),
            teapot: Player::new(teapot_memory(), Played::Teapot.settings()),
            wood: Player::new(crate_memory(), Played::Crate.settings()),
            buffers: Some([lend!(".dma", u16, WORDS, 0), lend!(".dma", u16, WORDS, 0)]),
        }
    }

    /// The mesh of a scene in parts, which it is cut into where it was not.
    pub(crate) fn in_parts(&mut self, suite: Suite) -> InParts<'static> {
        let mut cuts = self.cuts.iter().flatten();
        if let Some(cut) = cuts.find(|cut| cut.suite == suite) {
            return *cut;
        }
        let free = self.cuts.iter_mut().find(|cut| cut.is_none());
        let cut = InParts::new(suite, &mut self.cutting).expect("the rooms are large enough");
        *free.expect("a frame each") = Some(cut);
        cut
    }

    /// Draws the sheet of a seed, without depth.
    pub(crate) fn sheet_hits(&mut self, seed: u32) -> Hits {
        let mut scene = self.scene.scene();
        let mut renderer = Renderer::new(LineMemory {
            cache: self.caches.smooth,
            links: self.lines.links,
            depth: &mut [],
        });
        Sheet::new(seed)
            .hits(&mut scene, &mut renderer)
            .expect("the rooms are large enough")
    }
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

/// The list's tables, unpacked into external RAM.
pub(crate) fn unpacked() -> Unpacked {
    const MOST: usize = 2400;
    Unpacked::new(
        lend!(".slow", [i16; 3], MOST, [0; 3]),
        lend!(".slow", [u16; 3], MOST, [0; 3]),
    )
}

/// The most bytes of stack that were in use at once since the start.
pub(crate) fn stack_peak() -> usize {
    unsafe extern "C" {
        static _stack_end: u32;
        static _stack_start: u32;
    }
    let low = &raw const _stack_end;
    let high = &raw const _stack_start;
    let mut at = low;
    // SAFETY: all words from `_stack_end` up to the stack's start are RAM of nobody else (there is no
    // heap), painted before `main`; volatile, because the stack below us is not Rust's to reason on.
    while at < high && unsafe { at.read_volatile() } == cortex_m_rt::STACK_PAINT_VALUE {
        // SAFETY: still at most `high`, one past the region.
        at = unsafe { at.add(1) };
    }
    high as usize - at as usize
}
