//! An ESP32-C3 turns a teapot on an ILI9341; its DMA sends 8 lines while the next are drawn.
//!
//! SPI2: GPIO6 clock, GPIO7 data, GPIO5 data/command; chip select is wired low. The bus runs at
//! 40 MHz, which most ILI9341 take on short wires, though they are specified for 10 MHz.
#![no_std]
#![no_main]

use core::task::Poll;
use esp_hal::delay::Delay;
use esp_hal::dma::DmaTxBuf;
use esp_hal::gpio::{Level, Output, OutputConfig};
use esp_hal::spi::master::{Config, Spi, SpiDma, SpiDmaTransfer};
use esp_hal::{Blocking, clock::CpuClock, dma_tx_buffer, time::Rate};
use panic_halt as _;
use scanbeam::scan_out::{ErrorKind, LineBuf, ScanoutDma, Window};
use spinner::{LINES, WIDTH, panel};

esp_bootloader_esp_idf::esp_app_desc!();

/// A buffer of the HAL's, with its descriptors.
struct Line(DmaTxBuf);

impl LineBuf for Line {
    type Word = u16;

    /// The HAL aligns its buffers to 4 bytes.
    fn pixels(&mut self) -> &mut [u16] {
        bytemuck::cast_slice_mut(self.0.as_mut_slice())
    }
}

struct Panel {
    dc: Output<'static>,
    idle: Option<SpiDma<'static, Blocking>>,
    sending: Option<SpiDmaTransfer<'static, Blocking, DmaTxBuf>>,
}

impl Panel {
    fn command(&mut self, command: (u8, &[u8])) -> Result<(), ErrorKind> {
        let bus = self.idle.as_mut().ok_or(ErrorKind::Sequence)?;
        panel::command(&mut self.dc, ErrorKind::Bus, command, |bytes| {
            bus.write(bytes).map_err(|_| ErrorKind::Bus)
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
        let Some(bus) = self.idle.take() else { return Err((ErrorKind::Sequence, line)) };
        line.0.set_length(2 * len);
        match bus.write_buffer(2 * len, line.0) {
            Ok(sending) => self.sending = Some(sending),
            Err((_, bus, line)) => {
                self.idle = Some(bus);
                return Err((ErrorKind::Bus, Line(line)));
            }
        }
        Ok(())
    }

    fn poll(&mut self) -> Poll<Result<Option<Line>, ErrorKind>> {
        if self.sending.as_ref().is_some_and(|sending| !sending.is_done()) {
            return Poll::Pending;
        }
        Poll::Ready(Ok(self.sending.take().map(|sending| {
            let (bus, line) = sending.wait();
            self.idle = Some(bus);
            Line(line)
        })))
    }

    fn end(&mut self) -> Result<(), ErrorKind> {
        Ok(()) // `is_done` asks the bus too, not only the DMA
    }
}

#[esp_hal::main]
fn main() -> ! {
    let chip = esp_hal::init(esp_hal::Config::default().with_cpu_clock(CpuClock::max()));
    let config = Config::default().with_frequency(Rate::from_mhz(40));
    // Commands go by the processor: their bytes lie in flash, which the DMA cannot read.
    let config = config.with_min_async_transfer_size(64);
    let spi = Spi::new(chip.SPI2, config).expect("40 MHz is within its range");
    let bus = spi.with_sck(chip.GPIO6).with_mosi(chip.GPIO7).with_dma(chip.DMA_CH0);
    let dc = Output::new(chip.GPIO5, Level::High, OutputConfig::default());
    let sink = Panel { dc, idle: Some(bus), sending: None };
    let buffers = [dma_tx_buffer!(2 * LINES * WIDTH), dma_tx_buffer!(2 * LINES * WIDTH)];
    let buffers = buffers.map(|buffer| Line(buffer.expect("the descriptors are its own")));
    spinner::run(sink, buffers, Panel::command, |ms| Delay::new().delay_millis(ms))
}
