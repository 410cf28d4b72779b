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
use scanbeam::parallel::{Crew, Interleave, LineDesk};
use scanbeam::pipeline::{
    CellOf, GouraudDepth, Object, ObjectOf, Pipeline, SceneVertex, SlotOf, VertexOf,
};
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scan_out::{ErrorType, LineBuf, Pump, ScanoutDma};
use scanbeam::send::send_frame;
use scanbeam::{
    Affine, Camera, FrameError, FrameStats, Instance, Light, LineMemory, LineRenderer, Link, Scene,
    SceneMemory, Screen, draw_frame,
};
use static_cell::ConstStaticCell;

/// Smooth colours, 32-bit depth, pixels in the order of the wire.
pub type Look = GouraudDepth<Rgb565Be>;

/// Pixels of a line.
pub const WIDTH: usize = 320;
/// Lines of the picture.
pub const HEIGHT: usize = 240;
/// Lines that a buffer holds and a transfer takes.
pub const LINES: usize = 8;
/// Triangles that a frame may have.
pub const OBJECTS: usize = 1_300;
/// Triangles that the cache holds.
pub const SLOTS: usize = 64;

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

/// The scene of one teapot, in memory lent for ever.
///
/// # Panics
/// The second time.
#[must_use]
pub fn scene() -> Scene<'static, Look> {
    let Ok(screen) = Screen::new(WIDTH as u16, HEIGHT as u16) else {
        unreachable!("a size within the limits")
    };
    Scene::new(
        screen,
        SceneMemory {
            vertices: lend!(VertexOf<Look>, OBJECTS, SceneVertex::empty()),
            objects: lend!(ObjectOf<Look>, OBJECTS, Object::default()),
            buckets: lend!(Link, HEIGHT, Link::NONE),
        },
    )
}

/// Pass one: the teapot, turned.
///
/// # Panics
/// When a room of `scene` is too small for the teapot: those of [`scene()`] are not.
pub fn build<P: Pipeline>(scene: &mut Scene<'_, P>, turn: u16) {
    let eye = [0.0, 1.2, 2.6];
    let camera = Camera::look_at(eye, [0.0; 3], [0.0, 1.0, 0.0], 300.0, 0.1, 100.0)
        .expect("the eye is apart from what it looks at");
    scene.begin(&camera).expect("the scene has a bucket a line");
    let instance = Instance {
        model: Affine::rotation_y(f32::from(turn % 126) * (core::f32::consts::TAU / 126.0)),
        light: Light::new([0.3, 0.8, 0.6], 0.2),
        colour: [236, 196, 112],
        ..Instance::default()
    };
    let drawn = scene.draw(&scenes::TEAPOT, &instance);
    drawn.expect("the rooms hold the teapot");
}

/// The teapot and who draws it.
pub struct Spinner {
    scene: Scene<'static, Look>,
    renderer: LineRenderer<'static, Look>,
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
            scene: scene(),
            renderer: LineRenderer::new(LineMemory {
                slots: lend!(SlotOf<Look>, SLOTS, LineRenderer::<Look>::empty_slot()),
                links: lend!(Link, OBJECTS, Link::NONE),
                depth: lend!(CellOf<Look>, WIDTH, 0),
            }),
            turn: 0,
        }
    }

    /// Draws and sends a frame, then turns on: 126 frames a turn.
    ///
    /// # Errors
    /// When the sink fails. The next frame is whole again.
    pub fn frame<D>(&mut self, pump: &mut Pump<D>) -> Result<FrameStats, FrameError<D::Error>>
    where
        D: ScanoutDma<Buf: LineBuf<Word = u16>>,
    {
        build(&mut self.scene, self.turn);
        self.turn = (self.turn + 1) % 126;
        let (scene, renderer) = (&self.scene, &mut self.renderer);
        draw_frame(scene, renderer, pump, background(), LINES as u16)
    }

    /// The same, once, by a crew of two renderers on this core, which take lines in turn.
    ///
    /// # Errors
    /// When the sink fails.
    ///
    /// # Panics
    /// The second time: the second renderer's memory is lent here.
    pub fn frame_by_crew<D>(
        &mut self,
        pump: &mut Pump<D>,
    ) -> Result<FrameStats, FrameError<D::Error>>
    where
        D: ScanoutDma<Buf: LineBuf<Word = u16>>,
    {
        build(&mut self.scene, self.turn);
        let mut here = [
            LineRenderer::new(LineMemory {
                slots: lend!(SlotOf<Look>, SLOTS, LineRenderer::<Look>::empty_slot()),
                links: lend!(Link, OBJECTS, Link::NONE),
                depth: lend!(CellOf<Look>, WIDTH, 0),
            }),
            LineRenderer::new(LineMemory {
                slots: lend!(SlotOf<Look>, SLOTS, LineRenderer::<Look>::empty_slot()),
                links: lend!(Link, OBJECTS, Link::NONE),
                depth: lend!(CellOf<Look>, WIDTH, 0),
            }),
        ];
        for (offset, renderer) in (0..).zip(&mut here) {
            renderer.set_interleave(Interleave::lines(2, offset).unwrap_or_default());
        }
        let mut crew = Crew {
            scene: &self.scene,
            here: &mut here,
            desks: &mut [] as &mut [(Interleave, LineDesk<'_, D::Buf>)],
            background: background(),
            wait: || false,
            skipped: 0,
        };
        let sent = send_frame(&self.scene, &mut crew, pump, LINES as u16)?;
        Ok(crew.stats(sent))
    }
}

impl Default for Spinner {
    fn default() -> Self {
        Self::new()
    }
}

/// How a sink sends a command of the panel: its code and what follows it.
pub type SendCommand<D> = fn(&mut D, (u8, &[u8])) -> Result<(), <D as ErrorType>::Error>;

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
