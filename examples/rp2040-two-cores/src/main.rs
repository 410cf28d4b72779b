//! Two cores of an RP2040 draw alternate lines of one scene; core 0's DMA sends them (X6).
//!
//! Core 0 has pass one, the even lines and the SPI; core 1 has the odd lines. The scene is behind
//! a read-write lock: written by core 0 between frames, read by both while they draw. What core 1
//! draws comes through a [`Relay`] of four line buffers. Each has its own cache, link column and
//! line of depth, and there is no shared memory that two write. A core that has to wait for the
//! other sleeps (`wfe`) until that has passed on a line or a buffer (`sev`), and leaves the memory
//! to it meanwhile.
//!
//! SPI0: GP2 clock, GP3 data, GP4 data/command; chip select is wired low. The bus runs at 62.5 MHz,
//! half of the processor's clock: an ST7789 takes that. An ILI9341 is specified for 10 MHz; most
//! take 40 MHz and more, on short wires. The divider is even, so the next below is 31.25 MHz.
#![no_std]
#![no_main]

mod panel;
mod ram_code;

use panic_halt as _;
use rp2040_hal::clocks::init_clocks_and_plls as start;
use rp2040_hal::{self as hal, Clock, dma::DMAExt, fugit::RateExtU32, multicore, pac};
use scanbeam::parallel::{Crew, Interleave, LineSource, LineWorker, Relay};
use scanbeam::pipeline::{CellOf, SlotOf};
use scanbeam::scan_out::Pump;
use scanbeam::send::send_frame;
use scanbeam::{LineMemory, LineRenderer, Link, RendererError, Scene};
use spin::RwLock;
use spinner::{LINES, Look, OBJECTS, SLOTS, WIDTH, background, lend};
use static_cell::StaticCell;

type RelayLine = &'static mut [u16];

/// The second-stage boot loader, for the flash chip of a Pico.
#[unsafe(link_section = ".boot2")]
#[used]
static BOOT2: [u8; 256] = rp2040_boot2::BOOT_LOADER_W25Q080;
static CORE1_STACK: multicore::Stack<2048> = multicore::Stack::new();
static SCENE: StaticCell<RwLock<Scene<'static, Look>>> = StaticCell::new();
static RELAY: StaticCell<Relay<RelayLine, 5>> = StaticCell::new();

/// A renderer of every other line, from line `$offset` on, with memory of its own.
macro_rules! renderer {
    ($offset:literal) => {{
        let mut renderer = LineRenderer::<Look>::new(LineMemory {
            slots: lend!(SlotOf<Look>, SLOTS, LineRenderer::<Look>::empty_slot()),
            links: lend!(Link, OBJECTS, Link::NONE),
            depth: lend!(CellOf<Look>, WIDTH, 0),
        });
        renderer.set_interleave(every_other($offset));
        renderer.set_prefetch(1_000); // bytes a line, while it waits
        renderer
    }};
}

/// Every other line, from `offset` on.
fn every_other(offset: u16) -> Interleave {
    Interleave::lines(2, offset).expect("0 and 1 are below 2")
}

/// Lines as another source gives them; after each the other core is woken, which may wait for the
/// buffer that it came in.
struct Waking<S>(S);

impl<S: LineSource<Look>> LineSource<Look> for Waking<S> {
    fn line(&mut self, line: u16, pixels: &mut [u16]) -> Result<(), RendererError> {
        let given = self.0.line(line, pixels);
        cortex_m::asm::sev();
        given
    }

    fn idle(&mut self, line: u16) {
        self.0.idle(line);
    }
}

/// Sleeps until the other core stirs; it never gives up.
fn sleep() -> bool {
    cortex_m::asm::wfe();
    true
}

#[hal::entry]
fn main() -> ! {
    let mut pac = pac::Peripherals::take().expect("main runs once");
    let mut watchdog = hal::Watchdog::new(pac.WATCHDOG);
    let (r, c) = (&mut pac.RESETS, pac.CLOCKS);
    let clocks = start(12_000_000, pac.XOSC, c, pac.PLL_SYS, pac.PLL_USB, r, &mut watchdog);
    let clocks = clocks.expect("a crystal of 12 MHz");
    let rate = clocks.peripheral_clock.freq();
    let timer = hal::Timer::new(pac.TIMER, r, &clocks);
    let mut sio = hal::Sio::new(pac.SIO);
    let pins = hal::gpio::Pins::new(pac.IO_BANK0, pac.PADS_BANK0, sio.gpio_bank0, r);
    let wires = (pins.gpio3.reconfigure(), pins.gpio2.reconfigure());
    let bus = hal::Spi::new(pac.SPI0, wires).init(r, rate, 62_500.kHz(), embedded_hal::spi::MODE_0);
    let sink = panel::Panel::new(pac.DMA.split(r).ch0, bus, pins.gpio4.reconfigure(), timer);
    let sink = sink.expect("the bus sends the panel's commands");

    let scene: &'static RwLock<_> = SCENE.init(RwLock::new(spinner::scene()));
    let lines = lend!(u16, 4 * WIDTH, 0).chunks_exact_mut(WIDTH);
    let (worker, desk) = RELAY.init(Relay::new(lines)).split();
    let far = renderer!(1);
    let mut cores = multicore::Multicore::new(&mut pac.PSM, &mut pac.PPB, &mut sio.fifo);
    let stack = CORE1_STACK.take().expect("taken once");
    let spawned = cores.cores()[1].spawn(stack, move || core1(scene, worker, far));
    spawned.expect("core 1 was idle");

    let mut here = [renderer!(0)];
    let mut desks = [(every_other(1), desk)];
    let mut pump = Pump::new(sink, spinner::dma::lines());
    for turn in (0..126).cycle() {
        // Waits until core 1 has let go of the last frame.
        spinner::build(&mut scene.write(), turn);
        let scene = scene.read();
        sio.fifo.write_blocking(0); // core 1 may draw
        here[0].restart();
        let (here, desks, background) = (&mut here, &mut desks, background());
        let crew = Crew { scene: &scene, here, desks, background, wait: sleep, skipped: 0 };
        let mut crew = Waking(crew);
        let sent = send_frame(&scene, &mut crew, &mut pump, LINES as u16);
        crew.0.stats(sent.expect("the buses of the RP2040 cannot fail")); // and logs it, by defmt
        spinner::count_frame();
    }
    unreachable!("it turns for ever")
}

/// Core 1: whenever core 0 says so, the odd lines of the scene.
fn core1(
    scene: &'static RwLock<Scene<'static, Look>>,
    mut worker: LineWorker<'static, RelayLine>,
    mut renderer: LineRenderer<'static, Look>,
) {
    // SAFETY: SIO answers each core with its own side of the mailbox; nothing else is taken.
    let mut sio = hal::Sio::new(unsafe { pac::Peripherals::steal() }.SIO);
    loop {
        sio.fifo.read_blocking();
        let scene = scene.read();
        renderer.restart();
        for line in renderer.interleave().of(scene.lines()) {
            while worker.step(&scene, &mut renderer, background(), line).is_pending() {
                sleep();
            }
            cortex_m::asm::sev(); // core 0 may wait for this line
        }
    }
}
