//! An STM32F411 turns a teapot on an ILI9341; its DMA sends 8 lines while the next are drawn.
//! SPI1: PA5 clock, PA7 data, PA1 data/command; chip select is wired low. DMA2 stream 3, channel 3.
//! The bus runs at 50 MHz: an ST7789 takes that. An ILI9341 is specified for 10 MHz, and most take
//! 40 MHz and more on short wires; the next below is 25 MHz.
#![no_std]
#![no_main]

use core::task::Poll;
use panic_halt as _;
use scanbeam::scan_out::{ErrorKind, ScanoutDma, Window};
use spinner::dma::{Line, lines};
use spinner::panel;
use stm32f4xx_hal::dma::{MemoryToPeripheral, Stream3, StreamsTuple, Transfer, config::DmaConfig};
use stm32f4xx_hal::gpio::{Output, Pin, Speed};
use stm32f4xx_hal::pac::{self, DMA2, SPI1};
use stm32f4xx_hal::spi::{Mode, Phase, Polarity, Spi, Tx};
use stm32f4xx_hal::{ReadFlags, prelude::*, rcc};

type Sending = Transfer<Stream3<DMA2>, 3, Tx<SPI1>, MemoryToPeripheral, Line>;

struct Panel {
    dc: Pin<'A', 1, Output>,
    idle: Option<(Stream3<DMA2>, Tx<SPI1>)>,
    sending: Option<Sending>,
    failed: Option<Line>, // its transfer did
}

impl Panel {
    /// By the processor, while the DMA rests: the HAL's `Tx` sends by DMA alone.
    fn command(&mut self, command: (u8, &[u8])) -> Result<(), ErrorKind> {
        panel::command(&mut self.dc, ErrorKind::Bus, command, write)
    }
}

/// Sends bytes and waits until the last bit of all is out, which is later than the DMA is done.
fn write(bytes: &[u8]) -> Result<(), ErrorKind> {
    // SAFETY: `Tx` owns the bus and is the panel's, which calls this while the DMA rests.
    let spi = unsafe { &*SPI1::PTR };
    for &byte in bytes {
        while spi.sr().read().txe().bit_is_clear() {}
        spi.dr8().write(|w| w.dr().set(byte));
    }
    while spi.sr().read().txe().bit_is_clear() || spi.sr().read().bsy().bit_is_set() {}
    Ok(())
}

impl ScanoutDma for Panel {
    type Error = ErrorKind;
    type Buf = Line;

    fn begin(&mut self, window: Window) -> Result<(), ErrorKind> {
        panel::open(window, |command| self.command(command))
    }

    fn start(&mut self, mut line: Line, len: usize) -> Result<(), (ErrorKind, Line)> {
        let Some((stream, tx)) = self.idle.take() else { return Err((ErrorKind::Sequence, line)) };
        line.set_len(len);
        let config = DmaConfig::default().memory_increment(true);
        let mut sending = Sending::init_memory_to_peripheral(stream, tx, line, None, config);
        sending.start(|_| {});
        self.sending = Some(sending);
        Ok(())
    }

    fn poll(&mut self) -> Poll<Result<Option<Line>, ErrorKind>> {
        let Some(sending) = self.sending.take() else { return Poll::Ready(Ok(self.failed.take())) };
        let flags = sending.flags();
        if !flags.is_transfer_complete() && !flags.is_transfer_error() {
            self.sending = Some(sending);
            return Poll::Pending;
        }
        let (stream, tx, line, _) = sending.release();
        self.idle = Some((stream, tx));
        if flags.is_transfer_complete() {
            return Poll::Ready(Ok(Some(line)));
        }
        self.failed = Some(line);
        Poll::Ready(Err(ErrorKind::Bus))
    }

    fn end(&mut self) -> Result<(), ErrorKind> {
        write(&[])
    }
}

#[cortex_m_rt::entry]
fn main() -> ! {
    let pac = pac::Peripherals::take().expect("main runs once");
    let mut rcc = pac.RCC.freeze(rcc::Config::hsi().sysclk(100.MHz()));
    let a = pac.GPIOA.split(&mut rcc);
    let clock = a.pa5.into_alternate().speed(Speed::VeryHigh);
    let data = a.pa7.into_alternate().speed(Speed::VeryHigh);
    let mode = Mode { polarity: Polarity::IdleLow, phase: Phase::CaptureOnFirstTransition };
    let spi = Spi::new(pac.SPI1, (Some(clock), SPI1::NoMiso, Some(data)), mode, 50.MHz(), &mut rcc);
    let idle = Some((StreamsTuple::new(pac.DMA2, &mut rcc).3, spi.use_dma().tx()));
    let sink = Panel { dc: a.pa1.into_push_pull_output(), idle, sending: None, failed: None };
    spinner::run(sink, lines(), Panel::command, |ms| cortex_m::asm::delay(100_000 * ms))
}
