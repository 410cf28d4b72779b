//! An ILI9341 on SPI0, written to by a DMA channel. Commands are a few bytes, and block.

use core::task::Poll;
use embedded_hal::{delay::DelayNs, spi::SpiBus};
use rp2040_hal::dma::{CH0, Channel, single_buffer};
use rp2040_hal::gpio::{FunctionSioOutput, FunctionSpi, Pin, PullDown, bank0};
use rp2040_hal::{Timer, pac, spi};
use scanbeam::scan_out::{ErrorKind, ScanoutDma, Window};
use spinner::dma::Line;

type Wire<P> = Pin<P, FunctionSpi, PullDown>;
type Wires = (Wire<bank0::Gpio3>, Wire<bank0::Gpio2>);
/// GP3 data, GP2 clock.
pub type Bus = spi::Spi<spi::Enabled, pac::SPI0, Wires, 8>;
/// GP4 data/command.
pub type DataCommand = Pin<bank0::Gpio4, FunctionSioOutput, PullDown>;

/// The panel and the channel that sends its lines.
pub struct Panel {
    dc: DataCommand,
    idle: Option<(Channel<CH0>, Bus)>,
    sending: Option<single_buffer::Transfer<Channel<CH0>, Line, Bus>>,
}

impl Panel {
    /// Set up in landscape with 16 bits a pixel.
    ///
    /// # Errors
    /// When the bus or the pin fails.
    pub fn new(
        channel: Channel<CH0>,
        bus: Bus,
        dc: DataCommand,
        mut timer: Timer,
    ) -> Result<Self, ErrorKind> {
        let mut panel = Self { dc, idle: Some((channel, bus)), sending: None };
        let wait = |ms| timer.delay_ms(ms);
        spinner::panel::set_up(|command| panel.command(command), wait)?;
        Ok(panel)
    }

    fn command(&mut self, command: (u8, &[u8])) -> Result<(), ErrorKind> {
        let (_, bus) = self.idle.as_mut().ok_or(ErrorKind::Sequence)?;
        spinner::panel::command(&mut self.dc, ErrorKind::Bus, command, |bytes| {
            let sent = bus.write(bytes).and_then(|()| bus.flush());
            sent.map_err(|_| ErrorKind::Bus)
        })
    }
}

impl ScanoutDma for Panel {
    type Error = ErrorKind;
    type Buf = Line;

    fn begin(&mut self, window: Window) -> Result<(), ErrorKind> {
        spinner::panel::open(window, |command| self.command(command))
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
