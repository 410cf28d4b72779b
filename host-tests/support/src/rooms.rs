//! The memory that firmware would lend to the rooms `scene` and `frame`, on the heap, and pictures drawn in it.

use scanbeam::frame::{FastMemory, Memory as LineMemory, Renderer};
use scanbeam::look::Look;
use scanbeam::pixel::PixelFormat;
use scanbeam::scene::{DrawState, Memory, Object, Scene, TexturePlace, Vertex};
use scanbeam::{Link, Screen};
use std::error::Error;

/// What a scene has room for.
#[derive(Clone, Copy, Debug)]
pub struct Room {
    /// Vertices.
    pub vertices: usize,
    /// Places of vertices on textures: as many as vertices, or none where nothing has a texture.
    pub places: usize,
    /// Triangles.
    pub objects: usize,
    /// Draw calls.
    pub draws: usize,
}

/// What a scene is lent.
pub struct SceneRooms<'t> {
    vertices: Vec<Vertex>,
    places: Vec<TexturePlace>,
    objects: Vec<Object>,
    bins: Vec<u16>,
    draws: Vec<DrawState<'t>>,
}

impl<'t> SceneRooms<'t> {
    /// Of a picture of so many lines.
    #[must_use]
    pub fn new(room: Room, lines: u16) -> Self {
        Self {
            vertices: vec![Vertex::EMPTY; room.vertices],
            places: vec![TexturePlace::EMPTY; room.places],
            objects: vec![Object::EMPTY; room.objects],
            bins: vec![0; lines.into()],
            draws: vec![DrawState::EMPTY; room.draws],
        }
    }

    /// An empty scene in this memory.
    pub fn scene<L: Look>(&mut self, screen: Screen) -> Scene<'_, 't, L> {
        let memory = Memory {
            vertices: &mut self.vertices,
            places: &mut self.places,
            objects: &mut self.objects,
            bins: &mut self.bins,
            draws: &mut self.draws,
        };
        Scene::new(screen, memory)
    }
}

/// What a renderer with `32 WORDS` slots is lent.
pub struct LineRooms<L: Look, const WORDS: usize = 2> {
    cache: Box<FastMemory<L, WORDS>>,
    links: Vec<Link>,
    depth: Vec<u32>,
    counts: Vec<u8>,
}

impl<L: Look, const WORDS: usize> LineRooms<L, WORDS> {
    /// For so many triangles, and lines of so many pixels, with depth.
    #[must_use]
    pub fn new(objects: usize, width: u16) -> Self {
        Self {
            cache: Box::new(FastMemory::new()),
            links: vec![Link::EMPTY; objects],
            depth: vec![0; width.into()],
            counts: Vec::new(),
        }
    }

    /// The same, with counts for shadows.
    #[must_use]
    pub fn with_counts(mut self) -> Self {
        self.counts = vec![0; self.depth.len()];
        self
    }

    /// The same, without depth: what is drawn later is in front.
    #[must_use]
    pub fn without_depth(mut self) -> Self {
        self.depth.clear();
        self
    }

    /// The same, of which no more than so many slots are used.
    #[must_use]
    pub fn with_limit(mut self, slots: u16) -> Self {
        self.cache.set_limit(slots);
        self
    }

    /// A renderer in this memory; without counts for any scene without shadows.
    pub fn renderer(&mut self) -> Renderer<'_, L, WORDS> {
        let memory = LineMemory {
            cache: &mut self.cache,
            links: &mut self.links,
            depth: &mut self.depth,
        };
        match self.counts.is_empty() {
            true => Renderer::new(memory),
            false => Renderer::with_shadows(memory, &mut self.counts),
        }
    }
}

/// The words of the lines from the first that was begun on, over a background, of a scene that `build` makes, with depth.
///
/// # Errors
/// Those of `build`, and when a line cannot be drawn.
pub fn picture<'t, P: PixelFormat, L: Look<Pixel = P>>(
    screen: Screen,
    room: Room,
    background: P::Word,
    build: impl FnOnce(&mut Scene<'_, 't, L>) -> Result<(), Box<dyn Error>>,
) -> Result<Vec<P::Word>, Box<dyn Error>> {
    let mut memory = SceneRooms::new(room, screen.height());
    let mut scene = memory.scene(screen);
    build(&mut scene)?;
    words_of(&scene, room.objects, background)
}

/// The words of a scene's lines, over a background, with room for so many triangles. It is apart from what builds the
/// scene, so that all that draw by a look share it.
fn words_of<P: PixelFormat, L: Look<Pixel = P>>(
    scene: &Scene<'_, '_, L>,
    objects: usize,
    background: P::Word,
) -> Result<Vec<P::Word>, Box<dyn Error>> {
    let width = scene.screen().width();
    let mut lines: LineRooms<L> = LineRooms::new(objects, width);
    let mut renderer = lines.renderer();
    let (mut words, mut line) = (Vec::new(), vec![background; width.into()]);
    for y in scene.lines() {
        renderer.draw_line(scene, y, &mut line, background)?;
        words.extend_from_slice(&line);
    }
    Ok(words)
}
