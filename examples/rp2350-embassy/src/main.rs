//! An RP2350 (Pico 2) turns a teapot on an ILI9341 in one async task of embassy: while the DMA sends
//! a band of 8 lines, the task draws the next, and other tasks have their turn between lines.
//!
//! SPI0: GP2 clock, GP3 data, GP4 data/command; chip select is wired low. The bus runs at 37.5 MHz,
//! a quarter of the processor's clock: the divider is even. Most ILI9341 take that on short wires,
//! though they are specified for 10 MHz, and so does an ST7789 (up to 62.5 MHz).
#![no_std]
#![no_main]

use core::convert::Infallible;
use embassy_executor::Spawner;
use embassy_rp::gpio::{Level, Output};
use embassy_rp::peripherals::{DMA_CH0, SPI0};
use embassy_rp::spi::{self, Async, Spi};
use embassy_rp::{bind_interrupts, dma};
use embassy_time::{Delay, Duration, block_for};
use embedded_hal::digital::{ErrorType, OutputPin};
use embedded_hal_bus::spi::ExclusiveDevice;
use panic_halt as _;
use scanbeam::frame::draw_frame_async;
use scanbeam::scan_out::{AsyncPump, ErrorKind, SpiPanel};
use spinner::{LINES, Smooth, TURN, WIDTH, background, lend, panel};

bind_interrupts!(struct Interrupts {
    DMA_IRQ_0 => dma::InterruptHandler<DMA_CH0>;
});

/// Chip select, which is wired low.
struct WiredLow;

impl ErrorType for WiredLow {
    type Error = Infallible;
}

impl OutputPin for WiredLow {
    fn set_low(&mut self) -> Result<(), Infallible> {
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

/// Wakes the panel up, before anything else is to be done, and so without the DMA.
fn wake(bus: &mut Spi<'_, SPI0, Async>, dc: &mut Output<'_>) {
    let set_up = panel::set_up(
        |command| {
            panel::command(dc, ErrorKind::Bus, command, |bytes| {
                bus.blocking_write(bytes).map_err(|_| ErrorKind::Bus)
            })
        },
        |ms| block_for(Duration::from_millis(ms.into())),
    );
    set_up.expect("the bus sends the panel's commands");
}

#[embassy_executor::main]
async fn main(_spawner: Spawner) {
    let chip = embassy_rp::init(embassy_rp::config::Config::default());
    let mut config = spi::Config::default();
    config.frequency = 37_500_000;
    let (clock, data) = (chip.PIN_2, chip.PIN_3);
    let mut bus = Spi::new_txonly(chip.SPI0, clock, data, chip.DMA_CH0, Interrupts, config);
    let mut dc = Output::new(chip.PIN_4, Level::High);
    wake(&mut bus, &mut dc);

    let device = ExclusiveDevice::new(bus, WiredLow, Delay).expect("nothing selects the chip");
    let panel = SpiPanel::<_, _, u16>::new(device, dc);
    let buffers = [lend!(u16, LINES * WIDTH, 0), lend!(u16, LINES * WIDTH, 0)];
    let mut pump = AsyncPump::new(panel, buffers);
    let (mut scene, mut renderer) = (spinner::scene!(Smooth), spinner::renderer!(Smooth));
    for turn in (0..TURN).cycle() {
        spinner::build(&mut scene, turn);
        let lines = LINES as u16;
        let sent = draw_frame_async(&scene, &mut renderer, &mut pump, background(), lines).await;
        sent.expect("the bus takes the frame");
        spinner::count_frame();
    }
}
