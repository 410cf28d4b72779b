//! Two cores of an RP2040 draw alternate lines of one scene; core 0 sends them, in order (X6).
//!
//! Core 0 has pass one, the even lines and the SPI; core 1 has the odd lines. The scene is behind
//! a read-write lock: written by core 0 between frames, read by both while they draw. What core 1
//! draws comes through a [`Relay`] of four line buffers. Each has its own cache, link column and
//! line of depth, and there is no shared memory that two write.
//!
//! The panel, an ILI9341 class on SPI0 (GP2 clock, GP3 data), is taken to be set up and its
//! window to be the whole screen; see the driver of your panel for that.
#![no_std]
#![no_main]

use core::convert::Infallible;
use core::task::Poll;
use embedded_hal::spi::{MODE_0, SpiBus};
use panic_halt as _;
use rp2040_hal as hal;
use scanbeam::scan_out::{ErrorType, Pump, ScanoutDma, Window};
use scanbeam::{
    Affine, Camera, CellOf, Crew, GouraudDepth, Instance, Interleave, Light, LineMemory,
    LineRenderer, LineWorker, Link, Object, ObjectOf, PixelFormat, Relay, Rgb565Be, Scene,
    SceneMemory, SceneVertex, Screen, SlotOf, VertexOf, send_frame,
};
use scenes::TEAPOT;
use spin::RwLock;
use static_cell::StaticCell;

type P = GouraudDepth<Rgb565Be>;
type Line = &'static mut [u16];

const WIDTH: usize = 320;
const HEIGHT: usize = 240;
const OBJECTS: usize = 1_300;
const SLOTS: usize = 64;
/// Bytes a line that each core fetches ahead while it waits.
const AHEAD: u32 = 1_000;
const BACKGROUND: [u8; 3] = [24, 32, 48];

/// The second-stage boot loader, for the flash chip of a Pico.
#[unsafe(link_section = ".boot2")]
#[used]
static BOOT2: [u8; 256] = rp2040_boot2::BOOT_LOADER_W25Q080;
static CORE1_STACK: hal::multicore::Stack<2048> = hal::multicore::Stack::new();
static SCENE: StaticCell<RwLock<Scene<'static, P>>> = StaticCell::new();
static RELAY: StaticCell<Relay<Line, 5>> = StaticCell::new();

/// Lends an array of `$value`s for ever.
macro_rules! lend {
    ($element:ty, $len:expr, $value:expr) => {{
        static ROOM: StaticCell<[$element; $len]> = StaticCell::new();
        ROOM.init_with(|| core::array::from_fn(|_| $value))
            .as_mut_slice()
    }};
}

/// A renderer of every other line, from line `$offset` on, with memory of its own.
macro_rules! renderer {
    ($offset:literal) => {{
        let mut renderer = LineRenderer::<P>::new(LineMemory {
            slots: lend!(SlotOf<P>, SLOTS, LineRenderer::<P>::empty_slot()),
            links: lend!(Link, OBJECTS, Link::NONE),
            depth: lend!(CellOf<P>, WIDTH, 0),
        });
        renderer.set_interleave(Interleave::lines(2, $offset).unwrap_or_default());
        renderer.set_prefetch(AHEAD);
        renderer
    }};
}

#[hal::entry]
fn main() -> ! {
    let Some(mut pac) = hal::pac::Peripherals::take() else {
        panic!("main runs once")
    };
    let mut sio = hal::Sio::new(pac.SIO);
    let pins = hal::gpio::Pins::new(
        pac.IO_BANK0,
        pac.PADS_BANK0,
        sio.gpio_bank0,
        &mut pac.RESETS,
    );
    let clock = pins.gpio2.into_function::<hal::gpio::FunctionSpi>();
    let data = pins.gpio3.into_function::<hal::gpio::FunctionSpi>();
    let spi = hal::spi::Spi::<_, _, _, 8>::new(pac.SPI0, (data, clock)).init(
        &mut pac.RESETS,
        hal::fugit::HertzU32::MHz(125),
        hal::fugit::HertzU32::MHz(62),
        MODE_0,
    );
    let Ok(screen) = Screen::new(WIDTH as u16, HEIGHT as u16) else {
        panic!("a size within the limits")
    };
    let scene: &'static RwLock<_> = SCENE.init(RwLock::new(Scene::new(
        screen,
        SceneMemory {
            vertices: lend!(VertexOf<P>, 1_300, SceneVertex::empty()),
            objects: lend!(ObjectOf<P>, OBJECTS, Object::default()),
            buckets: lend!(Link, HEIGHT, Link::NONE),
        },
    )));
    let lines = lend!(u16, 4 * WIDTH, 0).chunks_exact_mut(WIDTH);
    let (worker, desk) = RELAY.init(Relay::new(lines)).split();

    let far = renderer!(1);
    let mut cores = hal::multicore::Multicore::new(&mut pac.PSM, &mut pac.PPB, &mut sio.fifo);
    let stack = CORE1_STACK.take().expect("taken once");
    let spawned = cores.cores()[1].spawn(stack, move || core1(scene, worker, far));
    spawned.expect("core 1 was idle");

    let mut here = [renderer!(0)];
    let mut desks = [(Interleave::lines(2, 1).unwrap_or_default(), desk)];
    let buffers = [lend!(u16, WIDTH, 0), lend!(u16, WIDTH, 0)];
    let mut pump = Pump::new(Panel { spi, sent: None }, buffers);
    for turn in 0u16.. {
        // Waits until core 1 has let go of the last frame.
        let _ = build(&mut scene.write(), f32::from(turn) * 0.05);
        let scene = scene.read();
        sio.fifo.write_blocking(0); // core 1 may draw
        here[0].restart();
        let mut crew = Crew {
            scene: &scene,
            here: &mut here,
            desks: &mut desks,
            background: Rgb565Be::from_rgb8(BACKGROUND),
            wait: || true,
            skipped: 0,
        };
        send_frame(&scene, &mut crew, &mut pump, 1).expect("the panel cannot fail");
    }
    unreachable!("it turns for ever")
}

/// Core 1: whenever core 0 says so, the odd lines of the scene.
fn core1(
    scene: &'static RwLock<Scene<'static, P>>,
    mut worker: LineWorker<'static, Line>,
    mut renderer: LineRenderer<'static, P>,
) {
    // SAFETY: SIO answers each core with its own side of the mailbox; nothing else is taken.
    let mut sio = hal::Sio::new(unsafe { hal::pac::Peripherals::steal() }.SIO);
    loop {
        sio.fifo.read_blocking();
        let scene = scene.read();
        let background = Rgb565Be::from_rgb8(BACKGROUND);
        worker.frame(&scene, &mut renderer, background, || true);
    }
}

/// Pass one: the teapot, turned. `None` when the camera or a room is too small for it.
fn build(scene: &mut Scene<'_, P>, turn: f32) -> Option<()> {
    let eye = [0.0, 1.2, 2.6];
    let camera = Camera::look_at(eye, [0.0; 3], [0.0, 1.0, 0.0], 300.0, 0.1, 100.0).ok()?;
    scene.begin(&camera).ok()?;
    let instance = Instance {
        model: Affine::rotation_y(turn),
        light: Light::new([0.3, 0.8, 0.6], 0.2),
        colour: [236, 196, 112],
        ..Instance::default()
    };
    scene.draw(&TEAPOT, &instance).ok().map(|_| ())
}

/// The panel, written to by the processor: a board would let a DMA do this.
struct Panel<S> {
    spi: S,
    sent: Option<Line>,
}

impl<S> ErrorType for Panel<S> {
    type Error = Infallible;
}

impl<S: SpiBus> ScanoutDma for Panel<S> {
    type Buf = Line;

    fn begin(&mut self, _: Window) -> Result<(), Infallible> {
        Ok(())
    }

    fn start(&mut self, line: Line, len: usize) -> Result<(), (Infallible, Line)> {
        // rp2040-hal's SPI cannot fail.
        let _ = self.spi.write(bytemuck::cast_slice(&line[..len]));
        self.sent = Some(line);
        Ok(())
    }

    fn poll(&mut self) -> Poll<Result<Option<Line>, Infallible>> {
        Poll::Ready(Ok(self.sent.take()))
    }

    fn end(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}
