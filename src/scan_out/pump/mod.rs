//! The double-buffered pump: one buffer is filled while the other is sent (SPEC K12, S5, X5, M4).
//!
//! Two buffers and no third: the CPU is either ahead of the bus, and then has to wait whatever the number, or behind
//! it, and then never waits. What helps instead is a band of several lines per transfer, which spreads the cost of
//! starting one, and evens out slow and fast lines within the band.
//!
//! Waiting happens in two places only, both counted in [`ScanStats::stall_polls`]: in [`Pump::line`] when no buffer is
//! home, and before a start when the last transfer still runs and the sink does not chain (the swap waits for
//! the running scan-out, K12).
//!
//! Every error ends the frame, brings the buffers home and closes the sink's rectangle, so the next
//! [`Pump::begin`] starts a whole new frame.

use core::ops::Range;
use core::task::Poll;

use super::dma::{LineBuf, ScanoutDma, Window};

mod outcome;
mod runs;

use outcome::sink;
pub use outcome::{ScanError, ScanStats};
pub use runs::RunFrame;

/// How many line buffers a pump holds.
const PUMP_BUFFERS: usize = 2;

/// One pixel of the buffers that the sink `D` takes.
pub(super) type WordOf<D> = <<D as ScanoutDma>::Buf as LineBuf>::Word;

/// Owns a sink and its two line buffers, and swaps them.
///
/// ```
/// # use core::{convert::Infallible, task::Poll};
/// # use scanbeam::scan_out::{Pump, ScanError, ScanoutDma, Window};
/// # struct Null(Option<&'static mut [u16]>);
/// # impl ScanoutDma for Null {
/// #     type Error = Infallible;
/// #     type Buf = &'static mut [u16];
/// #     fn begin(&mut self, _: Window) -> Result<(), Infallible> { Ok(()) }
/// #     fn start(&mut self, buf: Self::Buf, _: usize) -> Result<(), (Infallible, Self::Buf)> { self.0 = Some(buf); Ok(()) }
/// #     fn poll(&mut self) -> Poll<Result<Option<Self::Buf>, Infallible>> { Poll::Ready(Ok(self.0.take())) }
/// #     fn end(&mut self) -> Result<(), Infallible> { Ok(()) }
/// # }
/// # fn buffer() -> &'static mut [u16] { Box::leak(vec![0; 320 * 4].into()) }
/// # fn main() -> Result<(), ScanError<Infallible>> {
/// # let (sink, buf0, buf1) = (Null(None), buffer(), buffer());
/// let window = Window { x: 0, y: 0, width: 320, height: 240 };
/// let mut pump = Pump::new(sink, [buf0, buf1]);
/// pump.begin(window, 4)?; // four lines per transfer
/// for y in 0..window.height {
///     pump.line()?.fill(y); // draw: the old content is whatever was there
///     pump.line_done()?;
/// }
/// pump.finish()?;
/// assert_eq!(pump.stats().transfers, 60);
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Pump<D: ScanoutDma> {
    dma: D,
    /// Buffers that are home and not being filled, in no order.
    idle: [Option<D::Buf>; PUMP_BUFFERS],
    /// The buffer of the band that is being filled; what a frame left there is put back as the next one begins.
    filling: Option<D::Buf>,
    /// First lines of the bands that the sink has, oldest first; `in_flight` of them count.
    flights: [u16; PUMP_BUFFERS],
    /// Buffers that the sink has. With `idle` and `filling` it makes `PUMP_BUFFERS`, unless one is lost.
    in_flight: usize,
    /// The frame in work; `None` between frames and after an error.
    window: Option<Window>,
    /// Whether the sink has an open rectangle. Outlives `window` when a transfer hangs.
    open: bool,
    /// Whether lines may be left out: then each band has a rectangle of its own.
    in_parts: bool,
    /// First line of the rectangle that is open, in such a frame.
    part_first: u16,
    /// Lines of a full band, 1..=`window.height`.
    band_lines: u16,
    /// First line of the band that is being filled.
    band_first: u16,
    /// Complete lines in the band that is being filled, `< band_lines` between calls.
    band_filled: u16,
    /// Whether the line `band_first + band_filled` was handed out.
    handed: bool,
    max_polls: Option<u32>,
    stats: ScanStats,
}

impl<D: ScanoutDma> Pump<D> {
    /// A pump over an idle sink. Any buffer length goes here: `begin` checks it against the band.
    pub fn new(dma: D, buffers: [D::Buf; PUMP_BUFFERS]) -> Self {
        Self {
            dma,
            idle: buffers.map(Some),
            filling: None,
            flights: [0; PUMP_BUFFERS],
            in_flight: 0,
            window: None,
            open: false,
            in_parts: false,
            part_first: 0,
            band_lines: 1,
            band_first: 0,
            band_filled: 0,
            handed: false,
            max_polls: None,
            stats: ScanStats::default(),
        }
    }

    /// Bounds each wait: a transfer that more than so many polls find busy is reported as [`ScanError::Timeout`].
    ///
    /// `None`, which is how it starts, waits for ever, for systems with a watchdog. How long a poll takes is the
    /// sink's affair, so the bound is best set to some hundred times the usual [`ScanStats::stall_polls`] of a band.
    pub fn set_max_polls(&mut self, max_polls: Option<u32>) {
        self.max_polls = max_polls;
    }

    /// Starts a frame, or a part of one: opens `window`, to be filled line by line from its top.
    ///
    /// `lines_per_transfer` is the band: how many lines are collected in a buffer before it is sent, cut to the
    /// window's height. The last band may be shorter. A frame that is still open is abandoned.
    ///
    /// # Errors
    /// `Empty` and `BufferTooShort` before anything is sent; `Timeout` and `BufferLost` when a buffer of an earlier
    /// frame is still away; `Sink` when the sink does not open the window.
    pub fn begin(
        &mut self,
        window: Window,
        lines_per_transfer: u16,
    ) -> Result<(), ScanError<D::Error>> {
        let band_lines = self.prepare(window, lines_per_transfer)?;
        self.dma.begin(window).map_err(sink(0))?;
        self.open = true;
        self.window = Some(window);
        self.band_lines = band_lines;
        Ok(())
    }

    /// Starts a frame of which lines may be [left out](Self::line_left_out), because the display shows
    /// them already (X4).
    ///
    /// Nobody knows yet which, so each transfer opens a rectangle for its own lines and no more. Before that the
    /// last transfer must be home, chained or not; the next band is drawn meanwhile all the same. On an SPI
    /// panel a rectangle is 11 bytes of commands, beside 5,120 of 8 lines of 320 pixels.
    ///
    /// # Errors
    /// Those of [`begin`](Self::begin). What the sink says to a rectangle comes from `line_done` and `finish`.
    pub fn begin_in_parts(
        &mut self,
        window: Window,
        lines_per_transfer: u16,
    ) -> Result<(), ScanError<D::Error>> {
        self.band_lines = self.prepare(window, lines_per_transfer)?;
        self.in_parts = true;
        self.window = Some(window);
        Ok(())
    }

    /// Ends what was before a frame; the lines of a full band.
    fn prepare(
        &mut self,
        window: Window,
        lines_per_transfer: u16,
    ) -> Result<u16, ScanError<D::Error>> {
        self.recover()?;
        let band_lines = lines_per_transfer.min(window.height);
        if window.width == 0 || band_lines == 0 || !window.has_ends() {
            return Err(ScanError::Empty);
        }
        if self.idle.iter().any(Option::is_none) {
            return Err(ScanError::BufferLost { line: 0 });
        }
        let needed = usize::from(window.width).saturating_mul(usize::from(band_lines));
        for buf in self.idle.iter_mut().flatten() {
            let have = buf.pixels().len();
            if have < needed {
                return Err(ScanError::BufferTooShort { needed, have });
            }
        }
        self.in_parts = false;
        self.band_first = 0;
        Ok(band_lines)
    }

    /// The words of the next line, `window.width` of them, with any old content.
    ///
    /// Waits only when no buffer is home. Gives the same line again until [`line_done`](Self::line_done).
    ///
    /// # Errors
    /// `OutOfTurn` when no line is due; `Sink`, `Timeout` or `BufferLost`, for an earlier line, when waiting failed;
    /// `BufferTooShort` when the sink gave back a shorter buffer than it took.
    pub fn line(&mut self) -> Result<&mut [WordOf<D>], ScanError<D::Error>> {
        let Some(window) = self.window else {
            return Err(ScanError::OutOfTurn { line: 0 });
        };
        let line = self.next_line();
        if line >= window.height {
            return Err(ScanError::OutOfTurn { line });
        }
        if self.filling.is_none() {
            if self.idle.iter().all(Option::is_none) {
                self.wait_home_apart().map_err(|error| self.fail(error))?;
            }
            self.filling = self.idle.iter_mut().find_map(Option::take);
        }
        let width = usize::from(window.width);
        let at = usize::from(self.band_filled) * width; // `begin` saw that this fits
        // A sink that swaps buffers behind our back can hand back a shorter one: an error, not a panic.
        if let Err(error) = part::<D>(&mut self.filling, at..at + width, line) {
            return Err(self.fail(error));
        }
        self.handed = true;
        part::<D>(&mut self.filling, at..at + width, line)
    }

    /// The line that [`line`](Self::line) gave is complete. Starts the transfer when it fills the band or the window.
    ///
    /// # Errors
    /// `OutOfTurn` when `line` was not called for this line; `Sink`, `Timeout` or `BufferLost` when sending failed.
    pub fn line_done(&mut self) -> Result<(), ScanError<D::Error>> {
        let Some(window) = self.window else {
            return Err(ScanError::OutOfTurn { line: 0 });
        };
        if !self.handed {
            let line = self.next_line();
            return Err(ScanError::OutOfTurn { line });
        }
        self.handed = false;
        self.band_filled += 1;
        if self.band_filled == self.band_lines || self.next_line() == window.height {
            self.start_band(window).map_err(|error| self.fail(error))?;
        }
        Ok(())
    }

    /// The line that [`line`](Self::line) gave is not to be sent: the display shows it already. Starts the transfer
    /// of the lines before it; the next line is the first of another.
    ///
    /// # Errors
    /// `OutOfTurn` when `line` was not called for this line, or the frame was not
    /// [begun in parts](Self::begin_in_parts); `Sink`, `Timeout` or `BufferLost` when sending failed.
    pub fn line_left_out(&mut self) -> Result<(), ScanError<D::Error>> {
        let line = self.next_line();
        let Some(window) = self.window.filter(|_| self.handed && self.in_parts) else {
            return Err(ScanError::OutOfTurn { line });
        };
        self.handed = false;
        self.start_band(window).map_err(|error| self.fail(error))?;
        self.band_first = line + 1;
        let bytes = u64::from(window.width) * size_of::<WordOf<D>>() as u64;
        self.stats.bytes_unsent = self.stats.bytes_unsent.wrapping_add(bytes);
        self.stats.lines_unsent = self.stats.lines_unsent.saturating_add(1);
        Ok(())
    }

    /// Ends the frame: sends what is complete, waits until both buffers are home, and closes the window.
    ///
    /// # Errors
    /// `OutOfTurn` without a frame; `LinesMissing` when not every line was done; else what sending or closing said.
    pub fn finish(&mut self) -> Result<(), ScanError<D::Error>> {
        let window = self.window.ok_or(ScanError::OutOfTurn { line: 0 })?;
        let line = self.next_line();
        self.start_band(window).map_err(|error| self.fail(error))?;
        while self.in_flight > 0 {
            self.wait_home_apart().map_err(|error| self.fail(error))?;
        }
        self.window = None;
        self.open = false;
        let closed = self.dma.end();
        if line < window.height {
            return Err(ScanError::LinesMissing { line });
        }
        closed.map_err(sink(line))
    }

    /// The figures so far.
    pub fn stats(&self) -> ScanStats {
        self.stats
    }

    /// The figures so far, which start again from zero, for figures per frame.
    pub fn take_stats(&mut self) -> ScanStats {
        core::mem::take(&mut self.stats)
    }

    /// The sink.
    pub fn sink(&self) -> &D {
        &self.dma
    }

    /// The sink, for settings between frames. A rectangle or transfer started here confuses the pump's frame.
    pub fn sink_mut(&mut self) -> &mut D {
        &mut self.dma
    }

    /// Takes the pump apart, after waiting for what still runs. A buffer that did not come home is `None`.
    pub fn release(mut self) -> (D, [Option<D::Buf>; PUMP_BUFFERS]) {
        // Whatever is wrong shows as a `None`.
        self.give_up();
        (self.dma, self.idle)
    }

    /// The first line that is not complete.
    fn next_line(&self) -> u16 {
        self.band_first.saturating_add(self.band_filled)
    }

    /// Sends the complete lines of the band, if there are any.
    fn start_band(&mut self, window: Window) -> Result<(), ScanError<D::Error>> {
        if self.band_filled == 0 {
            return Ok(());
        }
        while self.in_flight > 0 && !self.dma.chains() {
            self.wait_home()?;
        }
        let line = self.band_first;
        if self.in_parts {
            let part = Window {
                y: window.y + line,
                height: self.band_filled,
                ..window
            };
            self.open_part(line, part)?;
        }
        let Some(buf) = self.filling.take() else {
            return Err(ScanError::BufferLost { line });
        };
        let len = usize::from(window.width) * usize::from(self.band_filled);
        self.launch(line, buf, len)?;
        self.band_first = self.next_line();
        self.band_filled = 0;
        Ok(())
    }

    /// Starts a transfer, whose first line is `line`. Called when the sink can take it.
    #[inline]
    fn launch(&mut self, line: u16, buf: D::Buf, len: usize) -> Result<(), ScanError<D::Error>> {
        if let Err((error, buf)) = self.dma.start(buf, len) {
            self.put_idle(buf);
            return Err(ScanError::Sink { line, error });
        }
        if let Some(flight) = self.flights.get_mut(self.in_flight) {
            *flight = line;
        }
        self.in_flight += 1;
        debug_assert!(self.in_flight <= PUMP_BUFFERS);
        let bytes = len as u64 * size_of::<WordOf<D>>() as u64;
        self.stats.bytes_sent = self.stats.bytes_sent.wrapping_add(bytes);
        self.stats.transfers = self.stats.transfers.saturating_add(1);
        Ok(())
    }

    /// Closes the rectangle of the last band and opens `part`, whose first line is `line` of the frame.
    #[inline(never)]
    fn open_part(&mut self, line: u16, part: Window) -> Result<(), ScanError<D::Error>> {
        while self.in_flight > 0 {
            self.wait_home()?;
        }
        self.close_part()?;
        self.dma.begin(part).map_err(sink(line))?;
        self.open = true;
        self.part_first = line;
        Ok(())
    }

    /// Closes the rectangle of the last band, if there is one.
    fn close_part(&mut self) -> Result<(), ScanError<D::Error>> {
        if core::mem::take(&mut self.open) {
            self.dma.end().map_err(sink(self.part_first))?;
        }
        Ok(())
    }

    /// [`wait_home`](Self::wait_home) where that is rare, so that its loop lies once among what runs once a line.
    #[cold]
    #[inline(never)]
    fn wait_home_apart(&mut self) -> Result<(), ScanError<D::Error>> {
        self.wait_home()
    }

    /// Polls until the oldest transfer has given its buffer back. Called with `in_flight > 0`.
    fn wait_home(&mut self) -> Result<(), ScanError<D::Error>> {
        let line = self.flights[0];
        let mut polls = 0_u32;
        loop {
            match self.dma.poll() {
                Poll::Pending => {
                    self.stats.stall_polls = self.stats.stall_polls.saturating_add(1);
                    if self.max_polls.is_some_and(|max| polls >= max) {
                        return Err(ScanError::Timeout { line });
                    }
                    polls = polls.saturating_add(1);
                    core::hint::spin_loop();
                }
                Poll::Ready(Ok(Some(buf))) => {
                    self.put_idle(buf);
                    self.flights.rotate_left(1);
                    self.in_flight = self.in_flight.saturating_sub(1);
                    return Ok(());
                }
                Poll::Ready(Ok(None)) => {
                    // An idle sink gives nothing back any more.
                    self.in_flight = 0;
                    return Err(ScanError::BufferLost { line });
                }
                Poll::Ready(Err(error)) => return Err(ScanError::Sink { line, error }),
            }
        }
    }

    /// Ends the frame after `error`, which is handed through.
    #[cold]
    #[inline(never)]
    fn fail(&mut self, error: ScanError<D::Error>) -> ScanError<D::Error> {
        match error {
            // A wait has just been in vain. `begin` and `release` will wait again.
            ScanError::Timeout { .. } => self.window = None,
            // The first error is the one that tells; a second one shows again in `begin`.
            _ => self.give_up(),
        }
        error
    }

    /// Ends a frame that is given up; what the sink says to that shows again in `begin`.
    pub(crate) fn give_up(&mut self) {
        let _ = self.recover();
    }

    /// Ends the frame, brings the buffers home and closes the sink's rectangle.
    ///
    /// Each running transfer may fail once more on its way, which no longer matters. A sink that goes on failing is
    /// not asked for ever: its error is returned.
    #[inline(never)]
    fn recover(&mut self) -> Result<(), ScanError<D::Error>> {
        self.put_back_filling();
        self.window = None;
        let mut failures = 0;
        while self.in_flight > 0 {
            match self.wait_home() {
                Err(ScanError::Sink { .. }) if failures < PUMP_BUFFERS => failures += 1,
                done => done?,
            }
        }
        // The frame is given up, so the sink may well find that lines are missing.
        let _ = self.close_part();
        Ok(())
    }

    fn put_back_filling(&mut self) {
        self.handed = false;
        self.band_filled = 0;
        if let Some(buf) = self.filling.take() {
            self.put_idle(buf);
        }
    }

    /// A buffer too many, which only a sink that makes buffers of its own could give, is dropped.
    fn put_idle(&mut self, buf: D::Buf) {
        if let Some(slot) = self.idle.iter_mut().find(|slot| slot.is_none()) {
            *slot = Some(buf);
        }
    }
}

/// A part of a buffer's words. That it is there was seen when the frame began,
/// unless a sink gives back other buffers than it takes.
fn part<D: ScanoutDma>(
    buf: &mut Option<D::Buf>,
    range: Range<usize>,
    line: u16,
) -> Result<&mut [WordOf<D>], ScanError<D::Error>> {
    let words = buf.as_mut().ok_or(ScanError::BufferLost { line })?.pixels();
    let (needed, have) = (range.end, words.len());
    words
        .get_mut(range)
        .ok_or(ScanError::BufferTooShort { needed, have })
}

#[cfg(test)]
mod tests;
