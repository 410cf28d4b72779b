//! Which pixels of a span are seen: the depth of one line, or what is covered of it (K8, X3).
//!
//! A method is a type; the one without depth is `()`, and then the object submitted last wins.
//! Where objects can be ordered from front to back, `cover` does without depth.

mod block_fix;
mod cell;
mod cover;
mod function;
#[cfg(test)]
mod functions;
mod mask;
mod named;
mod placed;
mod test;
mod volume;
mod word;

pub use block_fix::BlockFixDepth;
pub use cell::DepthCell;
pub use cover::{Cover, Covered, Masked};
pub use function::{MOST, Rule};
pub(crate) use mask::{Mask, Part};
pub use named::{DepthAndId, MOST_NAMES, Named, name};
pub use placed::Placed;
pub(crate) use test::{MOST as MOST_TESTED, test};
pub(crate) use volume::{Receives, count, receive, settle};
pub use word::{DepthAndColour, WordCourse, resolve};

use crate::num::Plane;
use crate::stats::SpanCounter;
use core::cmp::Ordering;
use core::marker::PhantomData;

/// A way to find hidden surfaces along one line.
pub trait LineDepth {
    /// What is kept for each pixel of the line.
    type Cell: DepthCell;
    /// The farthest value, to which a line is cleared.
    const FARTHEST: Self::Cell = <Self::Cell as DepthCell>::FARTHEST;
    /// Whether pixels are tested at all.
    const TESTS: bool;
    /// Whether of two objects whose ranges of depth do not meet, the nearer one always wins.
    const ORDERS: bool = true;
    /// What a depth of one object is rounded to.
    type Grain: Copy;
    /// Whether pixels are shaded only when it is known whose they are.
    const DEFERS: bool = false;
    /// Whether a cell has the depth of a pixel and its colour, where pixels have at most 16 bits.
    const WORDS: bool = false;

    /// What the depths of an object are rounded to whose nearest corner is in unit `nearest` of
    /// 2^15.
    fn grain(nearest: u16) -> Self::Grain;

    /// Whether a pixel at `depth` (larger is nearer) is seen; if so the cell takes its depth.
    fn test(cell: &mut Self::Cell, depth: u32, grain: Self::Grain) -> bool;

    /// What a cell keeps of a depth.
    #[inline(always)]
    fn rounded(depth: u32, _: Self::Grain) -> u32 {
        depth
    }

    /// How `depth`, which is [rounded](LineDepth::rounded), compares with that of a cell: greater is nearer, and equal is all there is
    /// without depth.
    #[inline(always)]
    fn compare(cell: &Self::Cell, depth: u32) -> Ordering {
        if Self::TESTS {
            depth.cmp(&cell.number())
        } else {
            Ordering::Equal
        }
    }
}

/// 32 bits of 1/w: nearer or equal wins.
#[derive(Clone, Copy, Debug)]
pub struct Depth32;

impl LineDepth for Depth32 {
    type Cell = u32;
    const TESTS: bool = true;
    type Grain = ();

    #[inline(always)]
    fn grain(_: u16) {}

    #[inline(always)]
    fn test(cell: &mut u32, depth: u32, (): ()) -> bool {
        let seen = depth >= *cell;
        if seen {
            *cell = depth;
        }
        seen
    }
}

impl LineDepth for () {
    type Cell = ();
    const TESTS: bool = false;
    type Grain = ();

    #[inline(always)]
    fn grain(_: u16) {}

    #[inline(always)]
    fn test((): &mut (), _: u32, (): ()) -> bool {
        true
    }
}

/// Tells of each pixel of a span in turn whether it is seen.
pub trait Visible {
    /// Whether all pixels are seen, so that nobody has to ask.
    const ALL: bool = false;

    /// Column and line of the next pixel modulo 4, for formats that dither; both 0 where no one
    /// has said where it is.
    #[inline(always)]
    fn tile(&self) -> (u8, u8) {
        (0, 0)
    }

    /// Gives `each` the next pixels in turn, and whether each is seen.
    fn each<W>(&mut self, pixels: &mut [W], each: impl FnMut(&mut W, bool));

    /// The same for a number of pixels that is known when it is compiled.
    #[inline(always)]
    fn block<W, const N: usize>(&mut self, pixels: &mut [W; N], each: impl FnMut(&mut W, bool)) {
        self.each(pixels, each);
    }
}

/// All pixels are seen: nothing else was or will be drawn there.
#[derive(Clone, Copy, Debug)]
pub struct Everywhere;

impl Visible for Everywhere {
    const ALL: bool = true;

    #[inline(always)]
    fn each<W>(&mut self, pixels: &mut [W], mut each: impl FnMut(&mut W, bool)) {
        for pixel in pixels {
            each(pixel, true);
        }
    }
}

/// Depth along a span.
#[derive(Clone, Copy, Debug)]
pub struct DepthRamp {
    /// That of the first pixel.
    pub first: u32,
    /// What each has more than the one before.
    pub step: u32,
}

impl DepthRamp {
    /// Along a span that starts at a pixel of guard space.
    #[inline(always)]
    pub fn of(plane: &Plane, column: i32, line: i32) -> Self {
        Self {
            first: plane.at(column, line) as u32,
            step: plane.dx as u32,
        }
    }

    /// Of one pixel.
    #[inline(always)]
    pub const fn single(depth: u32) -> Self {
        Self {
            first: depth,
            step: 0,
        }
    }
}

/// The depth line decides; what is seen is counted if `C` counts.
#[derive(Debug)]
pub struct Tested<'d, D: LineDepth, C> {
    /// The cells of the pixels to come.
    cells: &'d mut [D::Cell],
    /// Depth of the next pixel.
    depth: u32,
    /// The step to the pixel after it.
    step: u32,
    grain: D::Grain,
    seen: u32,
    counter: PhantomData<C>,
}

impl<'d, D: LineDepth, C: SpanCounter> Tested<'d, D, C> {
    /// Over the cells of a span.
    #[inline(always)]
    pub fn new(cells: &'d mut [D::Cell], ramp: DepthRamp, grain: D::Grain) -> Self {
        Self {
            cells,
            depth: ramp.first,
            step: ramp.step,
            grain,
            seen: 0,
            counter: PhantomData,
        }
    }

    /// Pixels that were seen, where they are counted.
    #[inline(always)]
    pub fn seen(&self) -> u32 {
        self.seen
    }

    /// Tests the next pixel.
    #[inline(always)]
    fn test(&mut self, cell: &mut D::Cell) -> bool {
        let shown = D::test(cell, self.depth, self.grain);
        if C::COUNTS {
            self.seen += u32::from(shown);
        }
        self.depth = self.depth.wrapping_add(self.step);
        shown
    }
}

impl<D: LineDepth, C: SpanCounter> Visible for Tested<'_, D, C> {
    #[inline(always)]
    fn each<W>(&mut self, pixels: &mut [W], mut each: impl FnMut(&mut W, bool)) {
        let cells = core::mem::take(&mut self.cells);
        let (now, later) = cells.split_at_mut(pixels.len().min(cells.len()));
        for (pixel, cell) in pixels.iter_mut().zip(now) {
            let shown = self.test(cell);
            each(pixel, shown);
        }
        self.cells = later;
    }

    #[inline(always)]
    fn block<W, const N: usize>(
        &mut self,
        pixels: &mut [W; N],
        mut each: impl FnMut(&mut W, bool),
    ) {
        let cells = core::mem::take(&mut self.cells);
        if let Some((now, later)) = cells.split_first_chunk_mut::<N>() {
            for (pixel, cell) in pixels.iter_mut().zip(now) {
                let shown = self.test(cell);
                each(pixel, shown);
            }
            self.cells = later;
        }
    }
}
