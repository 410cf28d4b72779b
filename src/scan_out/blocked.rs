//! A sink that is picture memory in blocks (B1).
//!
//! A picture that is read in other ways than along its lines, as a texture or turned on its way to the panel, changes
//! the page of a DRAM at almost every pixel where it lies in rows. In blocks that are a page each, what is near in the
//! picture is near in memory. Lines that come several at a time are filled in block by block, so that a page is
//! opened once for all of them: with as many lines a transfer as a block has, once a picture.
//!
//! Who only reads the picture line by line gains nothing from blocks: [`own_memory`](crate::guide::own_memory) has figures.

use super::dma::Window;
use super::frame_buffer::FrameBufferError;
use super::writer::LineWriter;
use crate::scene::Blocked;

/// A picture of `width` x `height` words in blocks, as a writer of lines. The buffers of the pump lie anywhere: they
/// are copied.
///
/// Blocks lie in rows from the top, those on the right and the bottom rim are whole; inside a block row by row. A picture
/// whose sides are powers of two, none of them below a block's, is a [texture in blocks](Blocked) as it lies.
///
/// ```
/// use scanbeam::scan_out::{BlockFrame, Blocking, Pump, Window};
/// use scanbeam::scene::Blocked;
///
/// let block = Blocked::new(1, 1).unwrap(); // 2 x 2 words
/// let mut words = [0_u16; 8];
/// let frame = BlockFrame::new(&mut words, 3, 2, block)?;
/// # fn lines() -> &'static mut [u16] { Box::leak(Box::new([0; 6])) }
/// let mut pump = Pump::new(Blocking::over(frame), [lines(), lines()]);
/// pump.begin(Window { x: 0, y: 0, width: 3, height: 2 }, 2)?;
/// for line in [[1, 2, 3], [4, 5, 6]] {
///     pump.line()?.copy_from_slice(&line);
///     pump.line_done()?;
/// }
/// pump.finish()?;
/// let frame = pump.sink().writer();
/// assert_eq!(frame.words(), [1, 2, 4, 5, 3, 0, 6, 0]);
/// assert_eq!((frame.word(2, 1), frame.word(3, 1)), (Some(6), None));
/// assert_eq!(frame.page_changes(), 2);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct BlockFrame<'f, W> {
    words: &'f mut [W],
    width: u16,
    height: u16,
    block: Blocked,
    /// The block that was written last.
    page: Option<usize>,
    page_changes: u32,
}

impl<'f, W: Copy> BlockFrame<'f, W> {
    /// Words that a picture of so many columns and lines takes in blocks: those of all blocks that it has a part of.
    #[must_use]
    pub const fn needed(width: u16, height: u16, block: Blocked) -> usize {
        let (across, down) = (block.width() as usize, block.height() as usize);
        (width as usize).next_multiple_of(across) * (height as usize).next_multiple_of(down)
    }

    /// A picture in memory that is as it is.
    ///
    /// # Errors
    /// When there are fewer words than are [needed](Self::needed).
    pub fn new(
        words: &'f mut [W],
        width: u16,
        height: u16,
        block: Blocked,
    ) -> Result<Self, FrameBufferError> {
        let (needed, have) = (Self::needed(width, height, block), words.len());
        if have < needed {
            return Err(FrameBufferError::Words { needed, have });
        }
        Ok(Self {
            words,
            width,
            height,
            block,
            page: None,
            page_changes: 0,
        })
    }

    /// All words as they lie.
    #[must_use]
    pub fn words(&self) -> &[W] {
        self.words
    }

    /// The word at a column and a line of the picture.
    #[must_use]
    pub fn word(&self, column: u16, line: u16) -> Option<W> {
        let is_inside = column < self.width && line < self.height;
        let (_, at) = self.place(column.into(), line.into());
        self.words.get(at).copied().filter(|_| is_inside)
    }

    /// Sets the word at a column and a line of the picture, for what is not drawn in lines; whether there is one.
    pub fn set_word(&mut self, column: u16, line: u16, word: W) -> bool {
        let is_inside = column < self.width && line < self.height;
        if is_inside {
            self.write_run(column.into(), line.into(), &[word]);
        }
        is_inside
    }

    /// How often another block was written than the one before, since the picture was made: pages that a DRAM had to
    /// open, where a block is a page.
    #[must_use]
    pub fn page_changes(&self) -> u32 {
        self.page_changes
    }

    /// The number of the block that has a pixel, and the pixel's place in memory.
    fn place(&self, column: usize, line: usize) -> (usize, usize) {
        let (width, height) = (self.block.width() as usize, self.block.height() as usize);
        let across = usize::from(self.width).div_ceil(width);
        let block = line / height * across + column / width;
        let inside = line % height * width + column % width;
        (block, block * width * height + inside)
    }

    /// Writes a run of words that lie in one row of a block.
    fn write_run(&mut self, column: usize, line: usize, run: &[W]) {
        let (block, at) = self.place(column, line);
        let is_other = u32::from(self.page != Some(block));
        self.page_changes = self.page_changes.saturating_add(is_other);
        self.page = Some(block);
        if let Some(row) = self.words.get_mut(at..at + run.len()) {
            row.copy_from_slice(run);
        }
    }
}

impl<W: Copy + 'static> LineWriter for BlockFrame<'_, W> {
    type Error = FrameBufferError;
    type Word = W;

    fn open(&mut self, window: Window) -> Result<(), FrameBufferError> {
        let is_inside = window.is_within(self.width, self.height);
        is_inside.then_some(()).ok_or(FrameBufferError::Window)
    }

    /// Block by block: in each all lines of it that came.
    fn write(&mut self, lines: Window, words: &[W]) -> Result<(), FrameBufferError> {
        let (wide, high) = (self.block.width() as usize, self.block.height() as usize);
        let [left, width] = [lines.x, lines.width].map(usize::from);
        let [top, height] = [lines.y, lines.height].map(usize::from);
        let mut first = top;
        while first < top + height {
            let end = (first / high * high + high).min(top + height);
            let mut column = left;
            while column < left + width {
                let next = (column / wide * wide + wide).min(left + width);
                for line in first..end {
                    let from = (line - top) * width + (column - left);
                    let run = words.get(from..from + (next - column));
                    self.write_run(column, line, run.ok_or(FrameBufferError::Window)?);
                }
                column = next;
            }
            first = end;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::random::Rng;
    use std::vec;
    use std::vec::Vec;

    /// A picture whose words are their places, by so many lines a transfer; and how often the block changed.
    fn filled(size: (u16, u16), block: Blocked, lines: u16) -> (Vec<u32>, u32) {
        let (width, height) = size;
        let mut words = vec![u32::MAX; BlockFrame::<u32>::needed(width, height, block)];
        let mut frame = BlockFrame::new(&mut words, width, height, block).unwrap();
        let mut window = Window {
            x: 0,
            y: 0,
            width,
            height,
        };
        frame.open(window).unwrap();
        let all: Vec<u32> = (0..u32::from(width) * u32::from(height)).collect();
        for part in all.chunks(usize::from(lines) * usize::from(width)) {
            window.height = (part.len() / usize::from(width)) as u16;
            frame.write(window, part).unwrap();
            window.y += window.height;
        }
        frame.close(true).unwrap();
        for line in 0..height {
            for column in 0..width {
                let place = u32::from(line) * u32::from(width) + u32::from(column);
                assert_eq!(frame.word(column, line), Some(place));
            }
        }
        assert_eq!((frame.word(width, 0), frame.word(0, height)), (None, None));
        let changes = frame.page_changes();
        (words, changes)
    }

    /// Kills: a counter that overflows after some days.
    #[test]
    fn page_changes_stay_at_their_maximum() {
        let mut words = [0; 16];
        let mut frame = BlockFrame::new(&mut words, 4, 4, Blocked::new(1, 1).unwrap()).unwrap();
        frame.page_changes = u32::MAX;
        let window = Window {
            x: 0,
            y: 0,
            width: 4,
            height: 4,
        };
        frame.open(window).unwrap();
        frame.write(window, &[7; 16]).unwrap();
        assert_eq!(frame.page_changes(), u32::MAX);
    }

    /// Kills: rows of blocks by the picture's width where that is no multiple of a block's, a pixel of the rim that is
    /// dropped, lines of a transfer that end in the middle of a block, and pages that are counted a line.
    #[test]
    fn every_pixel_is_in_its_block_and_blocks_change_least() {
        let mut rng = Rng(11);
        for _ in 0..200 {
            let (log_w, log_h) = (rng.below(6), rng.below(5));
            let block = Blocked::new(log_w, log_h).unwrap();
            let [width, height] = [1 + rng.below(90) as u16, 1 + rng.below(60) as u16];
            let lines = 1 + rng.below(40) as u16;
            let (words, changes) = filled((width, height), block, lines);
            let across = u32::from(width).div_ceil(block.width());
            // Each block in one piece: all of its pixels lie in the part of memory that has its number.
            let part = (block.width() * block.height()) as usize;
            for (number, part) in (0..).zip(words.chunks(part)) {
                for &place in part.iter().filter(|&&place| place != u32::MAX) {
                    let [x, y] = [place % u32::from(width), place / u32::from(width)];
                    let of = y / block.height() * across + x / block.width();
                    assert_eq!(of, number);
                }
            }
            // One page for each block of a row of blocks and each transfer that has a part of that row, but for two that
            // follow each other.
            let rows = |from: u16, to: u16| {
                u32::from(to - 1) / block.height() - u32::from(from) / block.height() + 1
            };
            let firsts = (0..height).step_by(lines.into());
            let visits: u32 = firsts
                .map(|from| rows(from, height.min(from.saturating_add(lines))))
                .sum();
            let want = if across == 1 {
                rows(0, height)
            } else {
                visits * across
            };
            assert_eq!(
                changes, want,
                "{width} x {height}, {block:?}, {lines} lines"
            );
        }
    }

    /// The figures of the guide: a picture of 320 x 240 in pages of 1 KB.
    #[test]
    fn a_transfer_as_high_as_a_block_opens_each_page_once() {
        let block = Blocked::of_page(1024, 16);
        assert_eq!((block.width(), block.height()), (32, 16));
        let changes = [1, 4, 8, 16].map(|lines| filled((320, 240), block, lines).1);
        assert_eq!(changes, [2400, 600, 300, 150]);
        // Rows of 512 words.
        assert_eq!(320 * 240 * 2 / 1024, 150);
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let block = Blocked::new(2, 2).unwrap();
        let mut words = [0_u8; 63];
        let short = BlockFrame::new(&mut words, 5, 8, block).map(drop);
        let (needed, have) = (64, 63);
        assert_eq!(short, Err(FrameBufferError::Words { needed, have }));
        let mut frame = BlockFrame::new(&mut words, 4, 8, block).unwrap();
        for (x, y, width, height) in [(0, 0, 5, 1), (1, 0, 4, 1), (0, 1, 4, 8), (0xFFFF, 0, 1, 1)] {
            let window = Window {
                x,
                y,
                width,
                height,
            };
            assert_eq!(frame.open(window), Err(FrameBufferError::Window));
        }
        let few = Window {
            x: 0,
            y: 0,
            width: 4,
            height: 2,
        };
        assert_eq!(frame.write(few, &[1; 7]), Err(FrameBufferError::Window));
        assert!(!frame.set_word(4, 0, 1) && !frame.set_word(0, 8, 1));
        let changes = frame.page_changes();
        assert!(frame.set_word(1, 7, 9));
        assert_eq!((frame.words()[29], frame.word(1, 7)), (9, Some(9)));
        assert_eq!(frame.page_changes(), changes + 1);
    }

    /// A picture in blocks is the texture in blocks that its rows would be arranged to.
    #[test]
    fn a_picture_is_a_texture_as_it_lies() {
        let block = Blocked::new(3, 2).unwrap();
        let (words, _) = filled((64, 32), block, 5);
        let rows: Vec<u32> = (0..64 * 32).collect();
        let mut texels = vec![0; rows.len()];
        block.arrange([64, 32], &rows, &mut texels).unwrap();
        assert!(words == texels);
    }
}
