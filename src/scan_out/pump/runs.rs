//! Frames of which runs within lines are left out: rectangles of cells that changed (SPEC X4).
//!
//! Lines are drawn whole into a buffer, a row of cells at a time, and only then is it known what changed. A run is
//! then moved to the front of the buffer, right behind the same columns of the lines above, as long as the runs
//! stay alike; so what changes as a rectangle is sent as one. A buffer holds full lines while they are drawn, and
//! the rectangle that goes out while it is sent: no memory beyond the two buffers. Of several runs in one row of
//! cells, all but the last are copied to the other buffer, and sent while drawing waits.

use bytemuck::NoUninit;
use core::ops::Range;

use super::{LineBuf, Pump, ScanError, ScanoutDma, Window, WordOf, part};
use crate::scan_out::shown_runs::ShownRuns;

/// A frame in work, of which unchanged cells are not sent: see [`Pump::begin_in_runs`].
///
/// Left unfinished, it ends as a frame with an error does, and what it has reached counts as not shown.
pub struct RunFrame<'p, 'm, D: ScanoutDma> {
    pump: &'p mut Pump<D>,
    shown: &'p mut ShownRuns<'m>,
    window: Window,
    /// Lines of a full rectangle, whole rows of cells, at least one.
    band_lines: u16,
    /// The top line of the row of cells that is drawn, and its lines that are drawn already.
    first: u16,
    drawn: u16,
    /// What lies at the front of the buffer, ready to be sent, in pixels of the window; no lines when nothing does.
    packed: Window,
    /// Whether an error has ended the frame.
    failed: bool,
}

impl<D: ScanoutDma> Pump<D> {
    /// Starts a frame of which cells may be left out, because `shown` knows that the display shows them (X4).
    ///
    /// The window begins at the edge of a cell. A transfer has as many lines as `lines_per_transfer` says, in whole rows
    /// of cells, and at least one row. Each transfer opens a rectangle of its own, whose edges are edges of
    /// cells or the window's.
    ///
    /// # Errors
    /// Those of [`begin`](Self::begin), and `Misaligned`.
    pub fn begin_in_runs<'p, 'm>(
        &'p mut self,
        window: Window,
        lines_per_transfer: u16,
        shown: &'p mut ShownRuns<'m>,
    ) -> Result<RunFrame<'p, 'm, D>, ScanError<D::Error>> {
        let (columns, lines) = shown.cell();
        let band_lines = (lines_per_transfer / lines).max(1).saturating_mul(lines);
        let band_lines = self.prepare(window, band_lines)?;
        if !window.x.is_multiple_of(columns) || !window.y.is_multiple_of(lines) {
            return Err(ScanError::Misaligned {
                cell: (columns, lines),
                corner: (window.x, window.y),
            });
        }
        shown.forget_unfinished();
        Ok(RunFrame {
            pump: self,
            shown,
            window,
            band_lines,
            first: 0,
            drawn: 0,
            packed: Window {
                height: 0,
                ..window
            },
            failed: false,
        })
    }
}

impl<D: ScanoutDma<Buf: LineBuf<Word: NoUninit>>> RunFrame<'_, '_, D> {
    /// The words of the next line, as from [`Pump::line`].
    ///
    /// # Errors
    /// `OutOfTurn` when no line is due; `Sink`, `Timeout` or `BufferLost`, for an earlier line, when waiting failed;
    /// `BufferTooShort` when the sink gave back a shorter buffer than it took.
    pub fn line(&mut self) -> Result<&mut [WordOf<D>], ScanError<D::Error>> {
        let line = self.first + self.drawn;
        if self.failed || line >= self.window.height {
            return Err(ScanError::OutOfTurn { line });
        }
        if self.pump.filling.is_none() {
            self.pump.filling = Some(self.spare()?);
        }
        self.pump.handed = true;
        let range = self.drawn_words();
        part::<D>(&mut self.pump.filling, range, line)
    }

    /// The line that [`line`](Self::line) gave is complete. With the last line of a row of cells, what has changed
    /// in it is sent, or kept for the next transfer.
    ///
    /// # Errors
    /// `OutOfTurn` when `line` was not called for this line; `Sink`, `Timeout` or `BufferLost` when sending failed.
    /// The frame is over then: it gives no line any more.
    pub fn line_done(&mut self) -> Result<(), ScanError<D::Error>> {
        let line = self.first + self.drawn;
        if !core::mem::take(&mut self.pump.handed) {
            return Err(ScanError::OutOfTurn { line });
        }
        let range = self.drawn_words();
        match part::<D>(&mut self.pump.filling, range, line) {
            Ok(words) => self.shown.add_line(self.window.x, words),
            Err(error) => return Err(self.fail(error)),
        }
        self.drawn += 1;
        let (_, lines) = self.shown.cell();
        if self.drawn < lines && line + 1 < self.window.height {
            return Ok(());
        }
        self.row_done().map_err(|error| self.fail(error))
    }

    /// Where the line that is drawn lies in the buffer.
    fn drawn_words(&self) -> Range<usize> {
        let width = usize::from(self.window.width);
        let at = words(self.packed) + usize::from(self.drawn) * width;
        at..at + width
    }

    /// Ends the frame, which gives no line any more, after `error`, which is handed through.
    fn fail(&mut self, error: ScanError<D::Error>) -> ScanError<D::Error> {
        (self.failed, self.pump.handed) = (true, false);
        self.pump.fail(error)
    }

    /// Ends the frame: sends what is left, waits until both buffers are home, and closes the last rectangle.
    ///
    /// # Errors
    /// `OutOfTurn` after an error; `LinesMissing` when not every line was done; else what sending or closing said.
    pub fn finish(mut self) -> Result<(), ScanError<D::Error>> {
        let line = self.first + self.drawn;
        if self.failed {
            return Err(ScanError::OutOfTurn { line });
        }
        self.send_rest().map_err(|error| self.pump.fail(error))?;
        if line < self.window.height {
            return Err(ScanError::LinesMissing { line });
        }
        self.shown.unfinished = 0;
        Ok(())
    }

    fn send_rest(&mut self) -> Result<(), ScanError<D::Error>> {
        self.send_packed(None)?;
        while self.pump.in_flight > 0 {
            self.pump.wait_home()?;
        }
        self.pump.put_back_filling();
        self.pump.close_part()
    }

    /// A row of cells is drawn: sends or packs its runs, and goes on to the next.
    fn row_done(&mut self) -> Result<(), ScanError<D::Error>> {
        let row = Window {
            y: self.first,
            height: self.drawn,
            ..self.window
        };
        let (x, width) = (self.window.x, self.window.width);
        self.shown.compare(self.window.y + row.y, x, width);
        let mut unsent = words(row);
        let mut run = self.shown.next_run(x, width, 0);
        if run.is_none() {
            self.send_packed(None)?;
            let lines = u32::from(self.drawn);
            self.pump.stats.lines_unsent = self.pump.stats.lines_unsent.saturating_add(lines);
        }
        while let Some(columns) = run {
            let next = self.shown.next_run(x, width, columns.end);
            let part = Window {
                x: columns.start,
                width: columns.end - columns.start,
                ..row
            };
            let is_first = unsent == words(row);
            unsent -= words(part);
            self.take_run(part, is_first, next.is_none())?;
            run = next;
        }
        let bytes = unsent as u64 * size_of::<WordOf<D>>() as u64;
        self.pump.stats.bytes_unsent = self.pump.stats.bytes_unsent.wrapping_add(bytes);
        self.shown.sums.fill(0);
        self.first += self.drawn;
        self.drawn = 0;
        if self.packed.height.saturating_add(row.height) > self.band_lines {
            self.send_packed(None)?;
        }
        Ok(())
    }

    /// Packs a run of the drawn row, or sends it when others follow.
    fn take_run(
        &mut self,
        run: Window,
        first: bool,
        last: bool,
    ) -> Result<(), ScanError<D::Error>> {
        let alike = (self.packed.x, self.packed.width) == (run.x, run.width);
        if self.packed.height > 0 && !(first && last && alike) {
            self.carry(run)?;
        }
        let width = usize::from(self.window.width);
        let from = words(self.packed) + usize::from(run.x);
        if !last {
            // `carry` has seen to it that nothing is packed.
            let mut other = self.spare()?;
            let source = self.pump.filling.as_mut().map(LineBuf::pixels);
            let rows = source.and_then(|words| words.get(from..)).unwrap_or(&[]);
            let run_width = usize::from(run.width);
            let rows = rows.chunks(width.max(1)).take(run.height.into());
            let to = other.pixels().chunks_exact_mut(run_width.max(1));
            for (to, row) in to.zip(rows) {
                if let Some(row) = row.get(..run_width) {
                    to.copy_from_slice(row);
                }
            }
            return self.send(run, other);
        }
        let to = words(self.packed);
        for row in 0..usize::from(run.height) {
            let (at, run_width) = (from + row * width, usize::from(run.width));
            // Rows go towards the front, the first first, so none is overwritten before it has moved.
            let words = part::<D>(&mut self.pump.filling, 0..at + run_width, run.y)?;
            words.copy_within(at.., to + row * run_width);
        }
        if self.packed.height == 0 {
            self.packed = run;
        } else {
            self.packed.height += run.height;
        }
        Ok(())
    }

    /// Sends what is packed, and moves the drawn row to the other buffer.
    fn carry(&mut self, row: Window) -> Result<(), ScanError<D::Error>> {
        let from = words(self.packed);
        let len = usize::from(self.window.width) * usize::from(row.height);
        let mut other = self.spare()?;
        let source = part::<D>(&mut self.pump.filling, from..from + len, row.y)?;
        for (to, from) in other.pixels().iter_mut().zip(source) {
            *to = *from;
        }
        self.send_packed(Some(other))
    }

    /// Sends what is packed, if anything is; then `next` is filled.
    fn send_packed(&mut self, next: Option<D::Buf>) -> Result<(), ScanError<D::Error>> {
        let packed = self.packed;
        if packed.height == 0 {
            return Ok(());
        }
        self.packed.height = 0;
        match core::mem::replace(&mut self.pump.filling, next) {
            Some(full) => self.send(packed, full),
            None => Err(ScanError::BufferLost { line: packed.y }),
        }
    }

    /// A buffer that is home and holds a transfer, after waiting for it.
    fn spare(&mut self) -> Result<D::Buf, ScanError<D::Error>> {
        if self.pump.idle.iter().all(Option::is_none) && self.pump.in_flight > 0 {
            self.pump.wait_home().map_err(|error| self.fail(error))?;
        }
        let line = self.first;
        let idle = self.pump.idle.iter_mut().find_map(Option::take);
        let mut buffer = idle.ok_or(ScanError::BufferLost { line })?;
        let needed = usize::from(self.window.width) * usize::from(self.band_lines);
        let have = buffer.pixels().len();
        if have >= needed {
            return Ok(buffer);
        }
        self.pump.put_idle(buffer);
        Err(self.fail(ScanError::BufferTooShort { needed, have }))
    }

    /// Opens the rectangle of `part`, which is in pixels of the window, and starts its transfer.
    fn send(&mut self, part: Window, buf: D::Buf) -> Result<(), ScanError<D::Error>> {
        let on_display = Window {
            x: self.window.x + part.x,
            y: self.window.y + part.y,
            ..part
        };
        if let Err(error) = self.pump.open_part(part.y, on_display) {
            self.pump.put_idle(buf);
            return Err(error);
        }
        self.pump.launch(part.y, buf, words(part))
    }
}

/// Words of a rectangle.
fn words(part: Window) -> usize {
    usize::from(part.width) * usize::from(part.height)
}
