//! The memory that the firmware lends, each piece in the region of `memory.x` it belongs to.

use crate::frames::{Faceted, LINES_PER_TRANSFER, Smooth};
use crate::lean::LeanRooms;
use crate::lend::lend;
use crate::unpacked::Unpacked;
use scanbeam::pipeline::{
    BlockFixed, CellOf, Deferred, LineDepth, LineMemory, LineRenderer, Object, ObjectOf, Pipeline,
    Scene, SceneMemory, SceneVertex, SlotOf, VertexOf,
};
use scanbeam::{Link, Screen};
use scenes::{
    BLOCK_TEXELS_B, CACHE_SLOTS_B, EFFECT_HEIGHT, EFFECT_ROOM, EFFECT_WIDTH, Grainy, HEIGHT, LookB,
    MOST_SLOTS, OBJECTS, OBJECTS_B, SHEET_TRIANGLES, SUITE_SLOTS, Sheet, SheetPipeline, Shot,
    TEXELS_PANEL, Transparent, VERTICES, VERTICES_B, WIDTH,
};

/// Slots of the object cache.
pub(crate) const SLOTS: usize = 43;

/// What one pipeline is lent.
pub(crate) struct RoomsOf<P: Pipeline> {
    /// External RAM, `.slow`.
    pub(crate) vertices: &'static mut [VertexOf<P>],
    pub(crate) objects: &'static mut [ObjectOf<P>],
    pub(crate) buckets: &'static mut [Link],
    pub(crate) links: &'static mut [Link],
    /// Tightly coupled RAM, `.fast`.
    pub(crate) slots: &'static mut [SlotOf<P>],
    pub(crate) depth: &'static mut [CellOf<P>],
}

impl<P: Pipeline> RoomsOf<P> {
    /// An empty scene and a renderer with so many slots, of a pipeline with records like these.
    pub(crate) fn lend<Q>(
        &mut self,
        screen: Screen,
        slots: usize,
    ) -> (Scene<'_, Q>, LineRenderer<'_, Q>)
    where
        Q: Pipeline<Shading = P::Shading, Depth = P::Depth>,
    {
        let scene = Scene::new(
            screen,
            SceneMemory {
                vertices: self.vertices,
                objects: self.objects,
                buckets: self.buckets,
            },
        );
        let renderer = LineRenderer::new(LineMemory {
            slots: &mut self.slots[..slots],
            links: self.links,
            depth: self.depth,
        });
        (scene, renderer)
    }
}

/// What frames are drawn with.
pub(crate) struct Rooms {
    pub(crate) smooth: RoomsOf<Smooth>,
    pub(crate) faceted: RoomsOf<Faceted>,
    /// For scenes of the suite in the new rooms.
    pub(crate) lean: LeanRooms,
    /// For scenes B and F; all in external RAM.
    pub(crate) textured: RoomsOf<LookB>,
    /// For scene B in blocks: its texels, in external RAM, and the cache through which they are
    /// read, tags and texels.
    pub(crate) blocks: &'static mut [u16],
    pub(crate) tags: &'static mut [u32],
    pub(crate) cached: &'static mut [u16],
    /// Depth of a line in 16 bits, and with names: external RAM.
    pub(crate) block_fix: &'static mut [CellOf<BlockFixed<Smooth>>],
    pub(crate) named: &'static mut [CellOf<Deferred<Smooth>>],
    /// Depth and colour of two lines each, for the hardware model: external RAM.
    pub(crate) model: [&'static mut [u64]; 4],
    /// What comparisons take beyond what one renderer needs: a cache for everything and a second
    /// renderer's links and depth. No scene. All in external RAM: here instructions count.
    pub(crate) second: RoomsOf<Smooth>,
    /// For sheets, which are drawn without depth and counted.
    pub(crate) sheet: RoomsOf<SheetPipeline>,
    /// For small frames of effects, one after the other: external RAM.
    pub(crate) effects: EffectRooms,
    /// RAM that a DMA can reach, `.dma`; absent while a pump has them.
    pub(crate) lines: Option<[&'static mut [u16]; 2]>,
}

/// The rooms of a pipeline, its slots and the depth of a line in the section `$near`: so many
/// vertices and objects, and lines and columns, and [`SLOTS`] where it is not said how many.
macro_rules! rooms_of {
    ($pipeline:ty, $near:literal, ($vertices:expr, $objects:expr), ($lines:expr, $columns:expr)) => {
        rooms_of!(
            $pipeline,
            $near,
            ($vertices, $objects),
            ($lines, $columns),
            SLOTS
        )
    };
    (
        $pipeline:ty, $near:literal, ($vertices:expr, $objects:expr), ($lines:expr, $columns:expr),
        $slots:expr
    ) => {
        RoomsOf::<$pipeline> {
            vertices: lend!(
                ".slow",
                VertexOf<$pipeline>,
                $vertices,
                SceneVertex::empty()
            ),
            objects: lend!(".slow", ObjectOf<$pipeline>, $objects, Object::default()),
            buckets: lend!(".slow", Link, $lines as usize, Link::NONE),
            links: lend!(".slow", Link, $objects, Link::NONE),
            slots: lend!(
                $near,
                SlotOf<$pipeline>,
                $slots,
                LineRenderer::<$pipeline>::empty_slot()
            ),
            depth: depth_of!($pipeline, $near, $columns),
        }
    };
}

/// The depth of a line in the section `$near`.
macro_rules! depth_of {
    ($pipeline:ty, $near:literal, $columns:expr) => {
        lend!(
            $near,
            CellOf<$pipeline>,
            $columns as usize,
            <$pipeline as Pipeline>::Depth::FARTHEST
        )
    };
}

/// Rooms for small frames of effects.
macro_rules! small_rooms_of {
    ($pipeline:ty) => {
        rooms_of!(
            $pipeline,
            ".slow",
            (EFFECT_ROOM, EFFECT_ROOM),
            (EFFECT_HEIGHT, EFFECT_WIDTH)
        )
    };
}

/// What the pipelines of effects are lent.
pub(crate) struct EffectRooms {
    pub(crate) transparent: RoomsOf<Transparent>,
    pub(crate) grainy: RoomsOf<Grainy>,
}

impl Rooms {
    /// Takes all of them, once.
    pub(crate) fn take() -> Self {
        const WORDS: usize = WIDTH as usize * LINES_PER_TRANSFER as usize;
        Self {
            smooth: rooms_of!(Smooth, ".fast", (VERTICES, OBJECTS), (HEIGHT, WIDTH)),
            faceted: rooms_of!(Faceted, ".fast", (VERTICES, OBJECTS), (HEIGHT, WIDTH)),
            lean: LeanRooms::take(),
            textured: rooms_of!(
                LookB,
                ".slow",
                (VERTICES_B, OBJECTS_B),
                (HEIGHT, WIDTH),
                SUITE_SLOTS
            ),
            blocks: lend!(".slow", u16, TEXELS_PANEL.len(), 0),
            tags: lend!(".fast", u32, CACHE_SLOTS_B, 0),
            cached: lend!(".fast", u16, CACHE_SLOTS_B * BLOCK_TEXELS_B, 0),
            block_fix: depth_of!(BlockFixed<Smooth>, ".slow", WIDTH),
            named: depth_of!(Deferred<Smooth>, ".slow", WIDTH),
            model: [
                lend!(".slow", u64, WIDTH as usize, 0),
                lend!(".slow", u64, WIDTH as usize, 0),
                lend!(".slow", u64, WIDTH as usize, 0),
                lend!(".slow", u64, WIDTH as usize, 0),
            ],
            sheet: rooms_of!(
                SheetPipeline,
                ".slow",
                (SHEET_TRIANGLES, SHEET_TRIANGLES),
                (HEIGHT, WIDTH)
            ),
            effects: EffectRooms {
                transparent: small_rooms_of!(Transparent),
                grainy: small_rooms_of!(Grainy),
            },
            second: RoomsOf {
                vertices: &mut [],
                objects: &mut [],
                buckets: &mut [],
                links: lend!(".slow", Link, OBJECTS, Link::NONE),
                slots: lend!(
                    ".slow",
                    SlotOf<Smooth>,
                    MOST_SLOTS,
                    LineRenderer::<Smooth>::empty_slot()
                ),
                depth: depth_of!(Smooth, ".slow", WIDTH),
            },
            lines: Some([lend!(".dma", u16, WORDS, 0), lend!(".dma", u16, WORDS, 0)]),
        }
    }
}

impl Rooms {
    /// Draws the sheet of a seed: pixels drawn, hits counted, and pixels left out.
    pub(crate) fn sheet_hits(&mut self, seed: u32) -> (u32, u32) {
        let (mut scene, mut renderer) = self.sheet.lend::<SheetPipeline>(Shot::screen(), SLOTS);
        Sheet::new(seed)
            .hits(&mut scene, &mut renderer)
            .expect("the rooms are large enough")
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
