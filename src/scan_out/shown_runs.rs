//! Which cells of the display are shown already, by a hash of 32 bits a cell (SPEC X4).
//!
//! A cell is some columns by some lines, and windows begin and end at its edges. So its size is the alignment of
//! windows too: panels that want even columns or lines, e-paper that wants bytes of 8 pixels. A cell of 16 x 1 is
//! a fair start for SPI panels: a window costs 11 bytes of commands, as much as 5 pixels.
//! What [`ShownLines`](super::ShownLines) says about hashes that are alike by chance holds for each cell.

use core::ops::Range;

use super::changed::{hash, step};
use bytemuck::NoUninit;

/// What each cell of the display shows, as far as it is known: 4 bytes a cell, and 4 for each of a row, lent.
///
/// It is right as long as everything that reaches the display goes through it; else call [`forget`](Self::forget).
#[derive(Debug)]
pub struct ShownRuns<'m> {
    /// Hashes of the row of cells that is drawn, so far.
    pub(super) sums: &'m mut [u32],
    /// Of each cell, row by row, 0 where nobody knows what is shown.
    hashes: &'m mut [u32],
    columns: u16,
    lines: u16,
    /// Rows of cells from the top that an unfinished frame may have changed.
    pub(super) unfinished: usize,
}

impl<'m> ShownRuns<'m> {
    /// How many words to lend for a display of `width` x `height` pixels in cells of `columns` x `lines`.
    #[must_use]
    pub const fn words(width: u16, height: u16, columns: u16, lines: u16) -> usize {
        let columns = if columns == 0 { 1 } else { columns };
        let lines = if lines == 0 { 1 } else { lines };
        width.div_ceil(columns) as usize * (height.div_ceil(lines) as usize + 1)
    }

    /// Nothing is shown yet, on a display of `width` pixels in cells of `columns` x `lines` of them, at least one.
    /// Cells for which there is no word are always sent.
    #[must_use]
    pub fn new(words: &'m mut [u32], width: u16, columns: u16, lines: u16) -> Self {
        words.fill(0);
        let (columns, lines) = (columns.max(1), lines.max(1));
        let stride = usize::from(width.div_ceil(columns));
        let (sums, hashes) = words.split_at_mut_checked(stride).unwrap_or_default();
        Self {
            sums,
            hashes,
            columns,
            lines,
            unfinished: 0,
        }
    }

    /// Columns and lines of a cell.
    #[must_use]
    pub const fn cell(&self) -> (u16, u16) {
        (self.columns, self.lines)
    }

    /// All cells are sent with the next frame.
    pub fn forget(&mut self) {
        self.hashes.fill(0);
    }

    /// What an unfinished frame has reached counts as not shown, and a new one begins.
    pub(super) fn forget_unfinished(&mut self) {
        let cells = core::mem::take(&mut self.unfinished) * self.sums.len();
        let reached = cells.min(self.hashes.len());
        self.hashes[..reached].fill(0);
        self.sums.fill(0);
    }

    /// Takes in a line of the row of cells, which begins at column `x`, the left edge of a cell.
    pub(super) fn add_line<W: NoUninit>(&mut self, x: u16, pixels: &[W]) {
        let cells = pixels.chunks(self.columns.into());
        let sums = self.sums.iter_mut().skip((x / self.columns).into());
        for (sum, cell) in sums.zip(cells) {
            *sum = step(*sum, hash(cell));
        }
    }

    /// A row of cells is complete, from column `x` on, `width` columns wide: marks those that are other than what is
    /// shown; they are about to be shown. `line` is the row's top line on the display.
    pub(super) fn compare(&mut self, line: u16, x: u16, width: u16) {
        let row = usize::from(line / self.lines);
        self.unfinished = self.unfinished.max(row + 1);
        let (left, count) = (x / self.columns, width.div_ceil(self.columns));
        let at = row * self.sums.len() + usize::from(left);
        let sums = self.sums.iter_mut().skip(left.into()).take(count.into());
        for (sum, cell) in sums.zip(at..) {
            let hash = core::mem::take(sum).max(1);
            let shown = self.hashes.get_mut(cell);
            let is_other = shown.is_none_or(|shown| core::mem::replace(shown, hash) != hash);
            *sum = is_other.into();
        }
    }

    /// The next run of marked cells at or after column `from` of a window that begins at column `x` and is
    /// `width` columns wide: columns of the window.
    pub(super) fn next_run(&self, x: u16, width: u16, from: u16) -> Option<Range<u16>> {
        // A cell beyond the display's width has no word of its own.
        let changed = |start: u16| {
            let column = usize::from(x / self.columns) + usize::from(start / self.columns);
            self.sums.get(column).is_none_or(|&mark| mark != 0)
        };
        let mut cells = (from..width).step_by(self.columns.into());
        let start = cells.find(|&start| changed(start))?;
        let end = cells.find(|&end| !changed(end)).unwrap_or(width);
        Some(start..end)
    }
}
