//! An RP2350 (Pico 2) turns a teapot on an ILI9341; its DMA sends 8 lines while the next are drawn.
//!
//! SPI0: GP2 clock, GP3 data, GP4 data/command; chip select is wired low. The bus runs at 37.5 MHz,
//! a quarter of the processor's clock: the divider is even. Most ILI9341 take that on short wires,
//! though they are specified for 10 MHz, and so does an ST7789 (up to 62.5 MHz); 75 MHz, the next
//! above, is beyond both.
#![no_std]
#![no_main]

use core::task::Poll;
use embedded_hal::spi::{MODE_0, SpiBus};
use panic_halt as _;
use rp235x_hal::clocks::init_clocks_and_plls as start;
use rp235x_hal::dma::{CH0, Channel, DMAExt, single_buffer};
use rp235x_hal::gpio::{FunctionSioOutput, FunctionSpi, Pin, PullDown, bank0};
use rp235x_hal::{self as hal, Clock, fugit::RateExtU32, pac};
use scanbeam::scan_out::{ErrorKind, ScanoutDma, Window};
use spinner::dma::{Line, lines};
use spinner::panel;

/// What the boot ROM wants to see.
#[unsafe(link_section = ".start_block")]
#[used]
static IMAGE: hal::block::ImageDef = hal::block::ImageDef::secure_exe();

type Wire<P> = Pin<P, FunctionSpi, PullDown>;
type Wires = (Wire<bank0::Gpio3>, Wire<bank0::Gpio2>);
type Bus = hal::Spi<hal::spi::Enabled, pac::SPI0, Wires, 8>;

struct Panel {
    dc: Pin<bank0::Gpio4, FunctionSioOutput, PullDown>,
    idle: Option<(Channel<CH0>, Bus)>,
    sending: Option<single_buffer::Transfer<Channel<CH0>, Line, Bus>>,
}

impl Panel {
    fn command(&mut self, command: (u8, &[u8])) -> Result<(), ErrorKind> {
        let (_, bus) = self.idle.as_mut().ok_or(ErrorKind::Sequence)?;
        panel::command(&mut self.dc, ErrorKind::Bus, command, |bytes| {
            let sent = bus.write(bytes).and_then(|()| bus.flush());
            sent.map_err(|_| ErrorKind::Bus)
        })
    }
}

impl ScanoutDma for Panel {
    type Error = ErrorKind;
    type Buf = Line;

    fn begin(&mut self, window: Window) -> Result<(), ErrorKind> {
        panel::open(window, |command| self.command(command))
    }

    fn start(&mut self, mut line: Line, len: usize) -> Result<(), (ErrorKind, Line)> {
        let Some((channel, bus)) = self.idle.take() else {
            return Err((ErrorKind::Sequence, line));
        };
        line.set_len(len);
        self.sending = Some(single_buffer::Config::new(channel, line, bus).start());
        Ok(())
    }

    fn poll(&mut self) -> Poll<Result<Option<Line>, ErrorKind>> {
        if self.sending.as_ref().is_some_and(|sending| !sending.is_done()) {
            return Poll::Pending;
        }
        Poll::Ready(Ok(self.sending.take().map(|sending| {
            let (channel, line, bus) = sending.wait();
            self.idle = Some((channel, bus));
            line
        })))
    }

    fn end(&mut self) -> Result<(), ErrorKind> {
        let (_, bus) = self.idle.as_mut().ok_or(ErrorKind::Sequence)?;
        bus.flush().map_err(|_| ErrorKind::Bus) // the last bytes are still in the bus's queue
    }
}

#[hal::entry]
fn main() -> ! {
    let mut pac = pac::Peripherals::take().expect("main runs once");
    let mut watchdog = hal::Watchdog::new(pac.WATCHDOG);
    let (r, c) = (&mut pac.RESETS, pac.CLOCKS);
    let clocks = start(12_000_000, pac.XOSC, c, pac.PLL_SYS, pac.PLL_USB, r, &mut watchdog);
    let clocks = clocks.expect("a crystal of 12 MHz");
    let pins =
        hal::gpio::Pins::new(pac.IO_BANK0, pac.PADS_BANK0, hal::Sio::new(pac.SIO).gpio_bank0, r);
    let wires = (pins.gpio3.reconfigure(), pins.gpio2.reconfigure());
    let rate = clocks.peripheral_clock.freq();
    let bus = hal::Spi::new(pac.SPI0, wires).init(r, rate, 37_500.kHz(), MODE_0);
    let channel = pac.DMA.split(r).ch0;
    let sink = Panel { dc: pins.gpio4.reconfigure(), idle: Some((channel, bus)), sending: None };
    spinner::run(sink, lines(), Panel::command, |ms| cortex_m::asm::delay(150_000 * ms))
}
