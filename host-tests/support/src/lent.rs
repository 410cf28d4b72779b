//! The memory that firmware would lend, on the heap: for one scene, and for one line renderer.

use scanbeam::pipeline::{
    CellOf, LineDepth, LineMemory, LineRenderer, ObjectOf, Pipeline, Scene, SceneMemory, SlotOf,
    VertexOf,
};
use scanbeam::{Link, Screen};

/// What a scene is lent.
pub struct SceneRooms<P: Pipeline> {
    vertices: Vec<VertexOf<P>>,
    objects: Vec<ObjectOf<P>>,
    buckets: Vec<Link>,
    /// The textures of its scenes.
    pub textures: P::Textures,
}

impl<P: Pipeline> SceneRooms<P> {
    /// So many vertices, objects and buckets.
    #[must_use]
    pub fn new(vertices: usize, objects: usize, buckets: usize) -> Self {
        Self {
            vertices: vec![VertexOf::<P>::empty(); vertices],
            objects: vec![ObjectOf::<P>::default(); objects],
            buckets: vec![Link::NONE; buckets],
            textures: P::Textures::default(),
        }
    }

    /// Most objects that a scene can have here.
    #[must_use]
    pub fn objects(&self) -> usize {
        self.objects.len()
    }

    /// An empty scene in this memory.
    pub fn scene(&mut self, screen: Screen) -> Scene<'_, P> {
        let mut scene = Scene::new(
            screen,
            SceneMemory {
                vertices: &mut self.vertices,
                objects: &mut self.objects,
                buckets: &mut self.buckets,
            },
        );
        scene.set_textures(self.textures);
        scene
    }
}

/// What one line renderer is lent.
pub struct LineRooms<P: Pipeline> {
    slots: Vec<SlotOf<P>>,
    links: Vec<Link>,
    depth: Vec<CellOf<P>>,
}

impl<P: Pipeline> LineRooms<P> {
    /// So many cache slots, links and depth cells.
    #[must_use]
    pub fn new(slots: usize, links: usize, width: usize) -> Self {
        Self {
            slots: vec![LineRenderer::<P>::empty_slot(); slots],
            links: vec![Link::NONE; links],
            depth: vec![P::Depth::FARTHEST; width],
        }
    }

    /// Enough for any line of `scene`, with so many cache slots.
    #[must_use]
    pub fn fitting(slots: usize, scene: &Scene<'_, P>) -> Self {
        let objects = scene.pass_one().objects as usize;
        Self::new(slots, objects, scene.screen().width().into())
    }

    /// The depth of the line that was drawn last.
    #[must_use]
    pub fn depth(&self) -> &[CellOf<P>] {
        &self.depth
    }

    /// Bytes that firmware would put into fast memory.
    #[must_use]
    pub fn fast_bytes(&self) -> usize {
        size_of_val(self.slots.as_slice()) + size_of_val(self.depth.as_slice())
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
