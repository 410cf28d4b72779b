//! Pictures of scenes in the rooms `scene`, `look` and `frame`, in memory on the heap.

use scanbeam::frame::{FastMemory, Memory as LineMemory, Renderer};
use scanbeam::look::Look;
use scanbeam::pixel::PixelFormat;
use scanbeam::scene::{DrawState, Memory, Object, Scene, TexturePlace, Vertex};
use scanbeam::{Link, Screen};
use std::error::Error;

/// What a scene has room for.
#[derive(Clone, Copy, Debug)]
pub struct Room {
    /// Vertices, and their places on textures.
    pub vertices: usize,
    /// Triangles.
    pub objects: usize,
    /// Draw calls.
    pub draws: usize,
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
    let mut vertices = vec![Vertex::EMPTY; room.vertices];
    let mut places = vec![TexturePlace::EMPTY; room.vertices];
    let mut objects = vec![Object::EMPTY; room.objects];
    let mut bins = vec![0; screen.height().into()];
    let mut draws = vec![DrawState::EMPTY; room.draws];
    let memory = Memory {
        vertices: &mut vertices,
        places: &mut places,
        objects: &mut objects,
        bins: &mut bins,
        draws: &mut draws,
    };
    let mut scene = Scene::<L>::new(screen, memory);
    build(&mut scene)?;
    let width = usize::from(screen.width());
    let mut cache = Box::new(FastMemory::<L>::new());
    let (mut links, mut depth) = (vec![Link::NONE; room.objects], vec![0; width]);
    let mut renderer = Renderer::new(LineMemory {
        cache: &mut cache,
        links: &mut links,
        depth: &mut depth,
    });
    let (mut words, mut line) = (Vec::new(), vec![background; width]);
    for y in scene.lines() {
        renderer.draw_line(&scene, y, &mut line, background)?;
        words.extend_from_slice(&line);
    }
    Ok(words)
}
