//! What the proofs share: a generator whose failures can be repeated, memory for scenes, and
//! frames drawn line by line.
#![allow(dead_code, reason = "each proof uses its own part")]

use scanbeam::{
    CellOf, LineDepth, LineMemory, LineRenderer, Link, ObjectOf, Pipeline, Scene, SceneMemory,
    Screen, SlotOf, VertexOf, WordOf,
};

/// xorshift64*: small, and the same everywhere.
#[derive(Clone, Debug)]
pub struct Rng(u64);

impl Rng {
    /// A generator that gives the same numbers for the same seed.
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    fn next(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 16
    }

    /// A number from 0, below `n`.
    pub fn below(&mut self, n: u32) -> u32 {
        (((self.next() & 0xFFFF_FFFF) * u64::from(n)) >> 32) as u32
    }

    /// A number from `low` to `high`, both inclusive.
    pub fn within(&mut self, low: i32, high: i32) -> i32 {
        low + self.below((high - low + 1) as u32) as i32
    }

    /// A number in `-1.0 .. 1.0`.
    pub fn signed(&mut self) -> f64 {
        f64::from(self.below(1 << 30)) / f64::from(1 << 29) - 1.0
    }

    /// One of the values.
    pub fn pick<T: Copy>(&mut self, values: &[T]) -> T {
        values[self.below(values.len() as u32) as usize]
    }

    /// Mixes up the order.
    pub fn shuffle<T>(&mut self, values: &mut [T]) {
        for i in (1..values.len()).rev() {
            values.swap(i, self.below(i as u32 + 1) as usize);
        }
    }
}

/// Memory for one scene.
pub struct SceneRooms<P: Pipeline> {
    vertices: Vec<VertexOf<P>>,
    objects: Vec<ObjectOf<P>>,
    buckets: Vec<Link>,
}

impl<P: Pipeline> SceneRooms<P> {
    /// So many vertices, objects and buckets.
    pub fn new(vertices: usize, objects: usize, buckets: usize) -> Self {
        Self {
            vertices: vec![VertexOf::<P>::empty(); vertices],
            objects: vec![ObjectOf::<P>::default(); objects],
            buckets: vec![Link::NONE; buckets],
        }
    }

    /// An empty scene in this memory.
    pub fn scene(&mut self, screen: Screen) -> Scene<'_, P> {
        Scene::new(
            screen,
            SceneMemory {
                vertices: &mut self.vertices,
                objects: &mut self.objects,
                buckets: &mut self.buckets,
            },
        )
    }
}

/// Memory for one line renderer.
pub struct LineRooms<P: Pipeline> {
    slots: Vec<SlotOf<P>>,
    links: Vec<Link>,
    depth: Vec<CellOf<P>>,
}

impl<P: Pipeline> LineRooms<P> {
    /// So many cache slots, links and depth cells.
    pub fn new(slots: usize, links: usize, depth: usize) -> Self {
        Self {
            slots: vec![LineRenderer::<P>::empty_slot(); slots],
            links: vec![Link::NONE; links],
            depth: vec![P::Depth::FARTHEST; depth],
        }
    }

    /// Enough for any line of `scene`, with so many cache slots.
    pub fn fitting(slots: usize, scene: &Scene<'_, P>) -> Self {
        Self::new(
            slots,
            scene.pass_one().objects as usize,
            usize::from(scene.screen().width()),
        )
    }

    /// The depth of the line that was drawn last.
    pub fn depth(&self) -> &[CellOf<P>] {
        &self.depth
    }

    /// A renderer in this memory.
    pub fn renderer(&mut self) -> LineRenderer<'_, P> {
        LineRenderer::new(LineMemory {
            slots: &mut self.slots,
            links: &mut self.links,
            depth: &mut self.depth,
        })
    }
}

/// One line, drawn over the default word.
pub fn line<P: Pipeline>(
    renderer: &mut LineRenderer<'_, P>,
    scene: &Scene<'_, P>,
    line: u16,
) -> Vec<WordOf<P>> {
    let mut pixels = vec![WordOf::<P>::default(); usize::from(scene.screen().width())];
    renderer
        .draw_line(scene, line, &mut pixels)
        .expect("the memory suffices");
    pixels
}

/// All lines that were begun, from the top, with so many cache slots.
pub fn frame<P: Pipeline>(scene: &Scene<'_, P>, slots: usize) -> Vec<Vec<WordOf<P>>> {
    let mut rooms = LineRooms::fitting(slots, scene);
    let mut renderer = rooms.renderer();
    scene
        .lines()
        .map(|y| line(&mut renderer, scene, y))
        .collect()
}
