//! What a look is lent in the small programs.

use crate::display::{Display, exit};
use scanbeam::frame::{FastMemory, Memory as LineMemory, draw_frame};
use scanbeam::look::Look;
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scene::{DrawState, Memory, Object, TexturePlace, Vertex};
use scanbeam::{Link, Renderer, Scene};

/// Vertices of the teapot on the screen, and its objects.
pub(crate) const VERTICES: usize = 1184;
pub(crate) const OBJECTS: usize = 1280;

/// Memory for one look, but for the states of draw calls.
pub(crate) struct Room<L: Look + 'static> {
    pub(crate) vertices: &'static mut [Vertex],
    pub(crate) places: &'static mut [TexturePlace],
    pub(crate) objects: &'static mut [Object],
    pub(crate) bins: &'static mut [u16],
    pub(crate) links: &'static mut [Link],
    pub(crate) cache: &'static mut [FastMemory<L>],
    pub(crate) depth: &'static mut [u32],
}

/// Lends a [`Room`] for a look, with so many vertices; with `textured` also places of them on a texture.
macro_rules! room {
    ($look:ty, $vertices:expr) => {
        room!($look, $vertices, places: &mut [])
    };
    ($look:ty, $vertices:expr, textured) => {
        room!($look, $vertices, places: {
            use scanbeam::scene::TexturePlace;
            crate::lend::lend!(".slow", TexturePlace, $vertices, TexturePlace::EMPTY)
        })
    };
    ($look:ty, $vertices:expr, places: $places:expr) => {{
        use crate::lend::lend;
        use crate::room::{OBJECTS, Room};
        use scanbeam::Link;
        use scanbeam::frame::FastMemory;
        use scanbeam::scene::{Object, Vertex};
        use scenes::{HEIGHT, WIDTH};
        const EMPTY: FastMemory<$look> = FastMemory::new();
        Room::<$look> {
            vertices: lend!(".slow", Vertex, $vertices, Vertex::EMPTY),
            places: $places,
            objects: lend!(".slow", Object, OBJECTS, Object::EMPTY),
            bins: lend!(".slow", u16, HEIGHT as usize, 0),
            links: lend!(".slow", Link, OBJECTS, Link::EMPTY),
            cache: lend!(".fast", FastMemory<$look>, 1, EMPTY),
            depth: lend!(".fast", u32, WIDTH as usize, 0),
        }
    }};
}
pub(crate) use room;

impl<L: Look + 'static> Room<L> {
    /// What a scene is lent, and what a renderer is.
    pub(crate) fn lend<'m, 't>(
        &'m mut self,
        draws: &'m mut [DrawState<'t>],
    ) -> (Memory<'m, 't>, LineMemory<'m, L>) {
        let memory = Memory {
            vertices: self.vertices,
            places: self.places,
            objects: self.objects,
            bins: self.bins,
            draws,
        };
        let [cache] = &mut *self.cache else {
            exit(false)
        };
        let lines = LineMemory {
            cache,
            links: self.links,
            depth: self.depth,
        };
        (memory, lines)
    }
}

/// Sends a scene, where it was built.
pub(crate) fn send<L: Look<Pixel = Rgb565Be>, E>(
    built: Result<(), E>,
    scene: &Scene<'_, '_, L>,
    mut renderer: Renderer<'_, L>,
    background: [u8; 3],
    display: &mut Display,
) {
    let background = Rgb565Be::from_rgb8(background);
    let drawn = draw_frame(scene, &mut renderer, display, background, 1);
    if built.is_err() || drawn.is_err() {
        exit(false);
    }
}
