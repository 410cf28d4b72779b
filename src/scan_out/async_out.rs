//! Sinks that are awaited, with drawing and sending at the same time (SPEC S5, X5, feature `async`).
//!
//! Futures borrow, so the line buffers are borrowed too: any memory will do, not only `'static`. A band is sent
//! while the next one is drawn; the two are joined, and after each line drawing lets others have their turn: the
//! sink, if it has to be looked after, and every other task.

use core::fmt::Debug;

use embassy_futures::join::join;
use embassy_futures::yield_now;
use embedded_hal::digital::OutputPin;
use embedded_hal_async::spi::SpiDevice;

use super::dma::{Error, Window};
use super::pump::{ScanError, ScanStats};
use super::spi::{PanelError, RAMWR, SpiPanel, Wire, window_commands};

/// Takes lines, and is awaited until it is done with them: the async twin of [`LineWriter`](super::LineWriter).
///
/// A future that is dropped stops what it does. The next rectangle starts anew.
#[expect(
    async_fn_in_trait,
    reason = "as in embedded-hal-async: executors of one core need no Send"
)]
pub trait AsyncLineWriter {
    /// What can go wrong.
    type Error: Error;
    /// One pixel, as the display takes it.
    type Word: Copy + 'static;

    /// Opens a rectangle of at least one pixel. One that is still open is abandoned.
    async fn open(&mut self, window: Window) -> Result<(), Self::Error>;

    /// Sends the next whole lines of the rectangle: `lines` says where they are, `words` has its width times its
    /// height.
    async fn write(&mut self, lines: Window, words: &[Self::Word]) -> Result<(), Self::Error>;

    /// Closes the rectangle, and waits until the bus is idle. `whole` says that each of its lines was sent.
    async fn close(&mut self, whole: bool) -> Result<(), Self::Error> {
        let _ = whole;
        Ok(())
    }
}

impl<T: AsyncLineWriter + ?Sized> AsyncLineWriter for &mut T {
    type Error = T::Error;
    type Word = T::Word;

    async fn open(&mut self, window: Window) -> Result<(), Self::Error> {
        T::open(self, window).await
    }

    async fn write(&mut self, lines: Window, words: &[Self::Word]) -> Result<(), Self::Error> {
        T::write(self, lines, words).await
    }

    async fn close(&mut self, whole: bool) -> Result<(), Self::Error> {
        T::close(self, whole).await
    }
}

impl<SPI: SpiDevice, DC: OutputPin> Wire<SPI, DC> {
    /// Sends a command and leaves the pin at data.
    async fn command_async(
        &mut self,
        command: u8,
        data: &[u8],
    ) -> Result<(), PanelError<SPI::Error, DC::Error>> {
        self.dc.set_low().map_err(PanelError::Pin)?;
        self.spi.write(&[command]).await.map_err(PanelError::Spi)?;
        self.dc.set_high().map_err(PanelError::Pin)?;
        if data.is_empty() {
            return Ok(());
        }
        self.spi.write(data).await.map_err(PanelError::Spi)
    }
}

impl<SPI: SpiDevice, DC: OutputPin, W: bytemuck::NoUninit + 'static> AsyncLineWriter
    for SpiPanel<SPI, DC, W>
{
    type Error = PanelError<SPI::Error, DC::Error>;
    type Word = W;

    async fn open(&mut self, window: Window) -> Result<(), Self::Error> {
        let commands = window_commands(window, self.offset).ok_or(PanelError::Window)?;
        for (command, data) in commands {
            self.wire.command_async(command, &data).await?;
        }
        self.wire.command_async(RAMWR, &[]).await
    }

    async fn write(&mut self, _: Window, words: &[W]) -> Result<(), Self::Error> {
        let bytes = bytemuck::cast_slice(words);
        self.wire.spi.write(bytes).await.map_err(PanelError::Spi)
    }
}

/// Owns a writer and borrows two line buffers: one is sent while the other is drawn.
#[derive(Debug)]
pub struct AsyncPump<'b, D: AsyncLineWriter> {
    writer: D,
    buffers: [&'b mut [D::Word]; 2],
    stats: ScanStats,
}

impl<'b, D: AsyncLineWriter> AsyncPump<'b, D> {
    /// A pump over an idle writer. Any buffer length goes here: `frame` checks it against the band.
    pub fn new(writer: D, buffers: [&'b mut [D::Word]; 2]) -> Self {
        Self {
            writer,
            buffers,
            stats: ScanStats::default(),
        }
    }

    /// Draws and sends a rectangle, so many lines a transfer, cut to its height. `draw` writes a line, which counts
    /// from 0 at the top of the rectangle; lines come in order. While a band is on its way the next is drawn, and
    /// other tasks run between lines.
    ///
    /// Dropped before it is done, it leaves a part of the picture on the display, and nothing else: the next
    /// frame is whole.
    ///
    /// # Errors
    /// `Empty` and `BufferTooShort` before anything is sent; `Sink`, with the first line of the transfer that failed;
    /// and what `draw` says. The rectangle is closed then.
    pub async fn frame<E: From<ScanError<D::Error>>>(
        &mut self,
        window: Window,
        lines_per_transfer: u16,
        draw: impl FnMut(u16, &mut [D::Word]) -> Result<(), E>,
    ) -> Result<(), E> {
        let band = lines_per_transfer.min(window.height);
        if window.width == 0 || band == 0 || !window.has_ends() {
            return Err(ScanError::Empty.into());
        }
        let needed = usize::from(window.width).saturating_mul(usize::from(band));
        for buffer in &self.buffers {
            let have = buffer.len();
            if have < needed {
                return Err(ScanError::BufferTooShort { needed, have }.into());
            }
        }
        let sink = |line| move |error| E::from(ScanError::Sink { line, error });
        self.writer.open(window).await.map_err(sink(0))?;
        let sent = self.bands(window, band, draw).await;
        let closed = self.writer.close(sent.is_ok()).await;
        sent.and_then(|()| closed.map_err(sink(window.height)))
    }

    /// Draws the first band, then sends each while it draws the one below.
    async fn bands<E: From<ScanError<D::Error>>>(
        &mut self,
        window: Window,
        band: u16,
        mut draw: impl FnMut(u16, &mut [D::Word]) -> Result<(), E>,
    ) -> Result<(), E> {
        let [mut ready, mut free] = self.buffers.each_mut();
        let width = usize::from(window.width);
        let lines_from = |first: u16| band.min(window.height.saturating_sub(first));
        draw_band(0, lines_from(0), width, ready, &mut draw).await?;
        let mut first = 0;
        while first < window.height {
            let lines = Window {
                y: window.y.saturating_add(first),
                height: lines_from(first),
                ..window
            };
            let below = first.saturating_add(lines.height);
            let len = width * usize::from(lines.height); // `frame` saw that this fits
            let words = ready.get(..len).unwrap_or_default();
            let (sent, drawn) = join(
                self.writer.write(lines, words),
                draw_band(below, lines_from(below), width, free, &mut draw),
            )
            .await;
            sent.map_err(|error| ScanError::Sink { line: first, error })?;
            let bytes = size_of_val(words) as u64;
            self.stats.bytes_sent = self.stats.bytes_sent.wrapping_add(bytes);
            self.stats.transfers = self.stats.transfers.saturating_add(1);
            drawn?;
            core::mem::swap(&mut ready, &mut free);
            first = below;
        }
        Ok(())
    }

    /// The figures so far. Nobody polls, so there are no `stall_polls`.
    pub fn stats(&self) -> ScanStats {
        self.stats
    }

    /// The figures so far, which start again from zero, for figures per frame.
    pub fn take_stats(&mut self) -> ScanStats {
        core::mem::take(&mut self.stats)
    }

    /// The writer.
    pub const fn writer(&self) -> &D {
        &self.writer
    }

    /// The writer, for settings between frames.
    pub const fn writer_mut(&mut self) -> &mut D {
        &mut self.writer
    }

    /// Gives writer and buffers back.
    pub fn release(self) -> (D, [&'b mut [D::Word]; 2]) {
        (self.writer, self.buffers)
    }
}

/// Draws so many lines from `first` on; between them it is the turn of others.
async fn draw_band<W, E>(
    first: u16,
    lines: u16,
    width: usize,
    buffer: &mut [W],
    draw: &mut impl FnMut(u16, &mut [W]) -> Result<(), E>,
) -> Result<(), E> {
    let rows = buffer.chunks_exact_mut(width.max(1));
    for (line, row) in (first..first.saturating_add(lines)).zip(rows) {
        draw(line, row)?;
        yield_now().await;
    }
    Ok(())
}
