//! What the board examples have in common, so that each board shows its own part alone: how its
//! DMA takes a line.
//!
//! - [`Spinner`]: the teapot, turned a little further each frame, in memory lent for ever.
//! - [`panel`]: the few commands of an ILI9341 on a bus and a data/command pin.
//! - `dma` (feature): a line buffer for the DMAs of HALs that take `embedded-dma`.
#![no_std]

#[cfg(feature = "dma")]
pub mod dma;
pub mod panel;

use core::sync::atomic::{AtomicU32, Ordering};
use scanbeam::frame::{
    FastMemory, FrameError, FrameUse, Memory as LineMemory, Renderer, draw_frame,
};
use scanbeam::look::{Gouraud, Look};
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scan_out::{LineBuf, Pump, ScanoutDma};
use scanbeam::scene::{Draw, Memory, Scene};
use scanbeam::{Affine, Camera, Light, Screen};
use static_cell::ConstStaticCell;

/// Smooth colours, pixels in the order of the wire.
pub type Smooth = Gouraud<Rgb565Be>;

/// Pixels of a line.
pub const WIDTH: usize = 320;
/// Lines of the picture.
pub const HEIGHT: usize = 240;
/// Lines that a buffer holds and a transfer takes.
pub const LINES: usize = 8;
/// Triangles that a frame may have.
pub const OBJECTS: usize = 1_300;
/// Vertices that a frame may have.
pub const VERTICES: usize = 1_300;

/// Frames of a turn.
pub const TURN: u16 = 126;

/// What is behind the teapot.
pub const BACKGROUND: [u8; 3] = [24, 32, 48];

/// The same, as a pixel.
#[must_use]
pub fn background() -> u16 {
    Rgb565Be::from_rgb8(BACKGROUND)
}

/// Frames that were sent since the start. By its name a debug probe finds it, and so a person with a
/// board can measure its frames a second: see README.md of the examples.
#[unsafe(no_mangle)]
pub static SCANBEAM_FRAMES: AtomicU32 = AtomicU32::new(0);

/// A frame was sent. One core says so.
pub fn count_frame() {
    let frames = SCANBEAM_FRAMES.load(Ordering::Relaxed);
    SCANBEAM_FRAMES.store(frames.wrapping_add(1), Ordering::Relaxed);
}

/// Static memory for `N` elements, empty until it is lent.
pub type Room<T, const N: usize> = ConstStaticCell<heapless::Vec<T, N>>;

/// Lends an array for ever; a second time at the same place is a panic.
#[macro_export]
macro_rules! lend {
    ($element:ty, $len:expr, $value:expr) => {{
        static ROOM: $crate::Room<$element, { $len }> = $crate::Room::new($crate::empty_room());
        $crate::fill(&ROOM, || $value)
    }};
}

/// What a [`Room`] holds before it is lent.
#[must_use]
pub const fn empty_room<T, const N: usize>() -> heapless::Vec<T, N> {
    heapless::Vec::new()
}

/// Fills a room element by element, in its place: an array that is made first and then moved there
/// would pass over the stack, and these are larger than many a stack.
///
/// # Panics
/// The second time.
pub fn fill<T, const N: usize>(
    room: &'static Room<T, N>,
    mut value: impl FnMut() -> T,
) -> &'static mut [T] {
    let room = room.take();
    while room.push(value()).is_ok() {}
    room.as_mut_slice()
}

/// A scene of one teapot, for pixels of the look `$look`, in memory lent for ever.
#[macro_export]
macro_rules! scene {
    ($look:ty) => {
        $crate::scene_in::<$look>($crate::scene_memory!())
    };
}

/// Memory of a scene.
#[macro_export]
macro_rules! scene_memory {
    () => {
        $crate::SceneMemory {
            vertices: $crate::lend!(
                $crate::SceneVertex,
                $crate::VERTICES,
                $crate::SceneVertex::EMPTY
            ),
            places: &mut [],
            objects: $crate::lend!(
                $crate::SceneObject,
                $crate::OBJECTS,
                $crate::SceneObject::EMPTY
            ),
            bins: $crate::lend!(u16, $crate::HEIGHT, 0),
            draws: $crate::lend!($crate::SceneDraw, 1, $crate::SceneDraw::EMPTY),
        }
    };
}

/// A renderer of the look `$look`, in memory lent for ever.
#[macro_export]
macro_rules! renderer {
    ($look:ty) => {{
        static CACHE: $crate::Cell<$crate::Cache<$look>> = $crate::Cell::new($crate::Cache::new());
        $crate::renderer_in::<$look>(
            CACHE.take(),
            $crate::lend!($crate::Link, $crate::OBJECTS, $crate::Link::EMPTY),
            $crate::lend!(u32, $crate::WIDTH, 0),
        )
    }};
}

pub use scanbeam::Link;
pub use scanbeam::frame::FastMemory as Cache;
pub use scanbeam::scene::{
    DrawState as SceneDraw, Memory as SceneMemory, Object as SceneObject, Vertex as SceneVertex,
};
pub use static_cell::ConstStaticCell as Cell;

/// A scene in this memory, of the whole picture.
#[must_use]
pub fn scene_in<L: Look>(memory: Memory<'static, 'static>) -> Scene<'static, 'static, L> {
    let Ok(screen) = Screen::new(WIDTH as u16, HEIGHT as u16) else {
        unreachable!("a size within the limits")
    };
    Scene::new(screen, memory)
}

/// A renderer in this memory.
#[must_use]
pub fn renderer_in<L: Look>(
    cache: &'static mut FastMemory<L>,
    links: &'static mut [Link],
    depth: &'static mut [u32],
) -> Renderer<'static, L> {
    Renderer::plain(LineMemory {
        cache,
        links,
        depth,
    })
}

/// Pass one: the teapot, turned.
///
/// # Panics
/// When the memory of `scene` is too small for the teapot: that of [`scene!`](crate::scene!) is not.
pub fn build<L: Look>(scene: &mut Scene<'_, '_, L>, turn: u16) {
    let eye = [0.0, 1.2, 2.6];
    let camera = Camera::look_at(eye, [0.0; 3], [0.0, 1.0, 0.0], 300.0, 0.1, 100.0)
        .expect("the eye is apart from what it looks at");
    scene.begin(&camera).expect("the scene has a bin a line");
    let call = Draw {
        model: Affine::rotation_y(f32::from(turn % TURN) * (core::f32::consts::TAU / 126.0)),
        light: Light::new([0.3, 0.8, 0.6], 0.2),
        colour: [236, 196, 112],
        ..Draw::new(meshes::TEAPOT)
    };
    scene.draw(&call).expect("the memory holds the teapot");
}

/// The teapot and who draws it.
pub struct Spinner {
    scene: Scene<'static, 'static, Smooth>,
    renderer: Renderer<'static, Smooth>,
    turn: u16,
}

impl Spinner {
    /// Takes the memory of this module.
    ///
    /// # Panics
    /// The second time.
    #[must_use]
    pub fn new() -> Self {
        Self {
            scene: scene!(Smooth),
            renderer: renderer!(Smooth),
            turn: 0,
        }
    }

    /// Draws and sends a frame, then turns on.
    ///
    /// # Errors
    /// When the sink fails. The next frame is whole again.
    pub fn frame<D>(&mut self, pump: &mut Pump<D>) -> Result<FrameUse, FrameError<D::Error>>
    where
        D: ScanoutDma<Buf: LineBuf<Word = u16>>,
    {
        build(&mut self.scene, self.turn);
        self.turn = (self.turn + 1) % TURN;
        let (scene, renderer) = (&self.scene, &mut self.renderer);
        draw_frame(scene, renderer, pump, background(), LINES as u16)
    }
}

impl Default for Spinner {
    fn default() -> Self {
        Self::new()
    }
}

/// How a sink sends a command of the panel: its code and what follows it.
pub type SendCommand<D> = fn(&mut D, (u8, &[u8])) -> Result<(), <D as ScanoutDma>::Error>;

/// Wakes the panel up, then draws and sends frames for ever. `command` has the sink send a command
/// by [`panel::command`], `wait` waits at least so many milliseconds.
///
/// # Panics
/// When the sink fails: the panel itself never answers, so this is all that tells of a dark one.
pub fn run<D>(
    mut sink: D,
    buffers: [D::Buf; 2],
    command: SendCommand<D>,
    wait: impl FnMut(u32),
) -> !
where
    D: ScanoutDma<Buf: LineBuf<Word = u16>>,
{
    let set_up = panel::set_up(|code| command(&mut sink, code), wait);
    set_up.expect("the sink sends the panel's commands");
    let (mut pump, mut spinner) = (Pump::new(sink, buffers), Spinner::new());
    loop {
        spinner.frame(&mut pump).expect("the sink takes the frame");
        count_frame();
    }
}
