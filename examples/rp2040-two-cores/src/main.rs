//! Two cores of an RP2040 draw one picture; core 0's DMA sends it (X6).
//!
//! Core 1 makes the next scene while core 0 draws this one; then it helps, and gets bands of lines
//! from core 0 by a [`Relay`] until there are no more. Core 0 draws the other lines and sends all.
//! There are three scenes, so that core 1 goes on while core 0 sends the last lines. Each core has
//! its own cache, link column and line of depth; a scene is behind a read-write lock. A core that has to wait for the other sleeps (`wfe`) until that has
//! passed on a line, a buffer or a band (`sev`), and leaves the memory to it meanwhile.
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
use scanbeam::frame::{Desk, Peer, Relay, Renderer, Worker, draw_frame_shared};
use scanbeam::{scan_out::Pump, scene::Scene};
use spin::RwLock;
use spinner::{LINES, Smooth, TURN, WIDTH, background, lend};
use static_cell::StaticCell;

type RelayLine = &'static mut [u16];
type Scenes = [RwLock<Scene<'static, 'static, Smooth>>; 3];

/// Lines that core 1 may be ahead of core 0.
const AHEAD: usize = 24;

/// The second-stage boot loader, for the flash chip of a Pico.
#[unsafe(link_section = ".boot2")]
#[used]
static BOOT2: [u8; 256] = rp2040_boot2::BOOT_LOADER_W25Q080;
static CORE1_STACK: multicore::Stack<2048> = multicore::Stack::new();
static SCENES: StaticCell<Scenes> = StaticCell::new();
static RELAY: StaticCell<Relay<RelayLine, { AHEAD + 1 }>> = StaticCell::new();

/// Sleeps until the other core stirs; it never gives up.
fn sleep() -> bool {
    cortex_m::asm::wfe();
    true
}

/// The other core.
const PEER: Peer<'static> = Peer { wait: &sleep, wake: &cortex_m::asm::sev };

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

    let scenes = [spinner::scene!(Smooth), spinner::scene!(Smooth), spinner::scene!(Smooth)];
    let scenes: &'static Scenes = SCENES.init(scenes.map(RwLock::new));
    spinner::build(&mut scenes[0].write(), 0);
    let lines = lend!(u16, AHEAD * WIDTH, 0).chunks_exact_mut(WIDTH);
    let (worker, desk) = RELAY.init(Relay::new(lines)).split();
    let far = spinner::renderer!(Smooth);
    let mut cores = multicore::Multicore::new(&mut pac.PSM, &mut pac.PPB, &mut sio.fifo);
    let stack = CORE1_STACK.take().expect("taken once");
    let spawned = cores.cores()[1].spawn(stack, move || core1(scenes, worker, far));
    spawned.expect("core 1 was idle");
    let pump = Pump::new(sink, spinner::dma::lines());
    core0(scenes, desk, spinner::renderer!(Smooth), pump)
}

/// Core 0: draws and sends frame after frame.
fn core0(
    scenes: &'static Scenes,
    mut desk: Desk<'static, RelayLine>,
    mut renderer: Renderer<'static, Smooth>,
    mut pump: Pump<panel::Panel>,
) -> ! {
    for scene in scenes.iter().cycle() {
        let scene = scene.read();
        let sent = draw_frame_shared(
            &scene,
            &mut renderer,
            &mut desk,
            &mut pump,
            background(),
            LINES as u16,
            PEER,
        );
        sent.expect("the buses of the RP2040 cannot fail");
        drop(scene);
        cortex_m::asm::sev(); // core 1 may wait for this scene
        spinner::count_frame();
    }
    unreachable!("it turns for ever")
}

/// Core 1: makes the next scene, then helps with the lines of this one.
fn core1(
    scenes: &'static Scenes,
    mut worker: Worker<'static, RelayLine>,
    mut renderer: Renderer<'static, Smooth>,
) {
    let others = scenes.iter().cycle().skip(1);
    for (turn, (scene, next)) in (1..=TURN).cycle().zip(scenes.iter().cycle().zip(others)) {
        // Core 0 may still draw the frame before the last.
        loop {
            if let Some(mut next) = next.try_write() {
                spinner::build(&mut next, turn);
                break;
            }
            sleep();
        }
        let scene = scene.read();
        worker.help(&scene, &mut renderer, background(), PEER);
    }
}
