//! Depth and whose it is in one word: first all depths, then only colours that are seen (X3).
//!
//! A word holds the upper 22 bits of a depth above 10 bits that name a slot of the cache. Where
//! the 22 bits are the same, the depth that stands there is taken again, whole, from the plane of
//! the slot it names: so every pixel is that which 32 bits give.

use super::{Depth32, DepthCell, DepthRamp, LineDepth, Visible};

/// Bits of a word that name who is there, 0 for nobody.
const NAMES: u32 = (1 << 10) - 1;
/// Most that can be named.
pub const MOST_NAMES: usize = NAMES as usize;

/// 32 bits of 1/w as [`Depth32`], but no pixel is shaded that something later hides: on lines
/// where spans overlap, depths and names are found first, and each pixel is shaded once.
///
/// Lines on which an object has no slot among the first 1,023, or is too thin for planes, are
/// drawn as by [`Depth32`]. The picture is always the same.
#[derive(Clone, Copy, Debug)]
pub struct DepthAndId;

impl LineDepth for DepthAndId {
    type Cell = u32;
    const TESTS: bool = true;
    const DEFERS: bool = true;
    type Grain = ();

    #[inline(always)]
    fn grain(_: u16) {}

    #[inline(always)]
    fn test(cell: &mut u32, depth: u32, (): ()) -> bool {
        Depth32::test(cell, depth, ())
    }
}

/// Lets `name`, 1 to [`MOST_NAMES`], have those cells of a span in which it is not behind what is
/// there. `whole` gives the depth of
/// another name at an index of the span.
#[inline(always)]
pub fn name<D: LineDepth>(
    cells: &mut [D::Cell],
    ramp: DepthRamp,
    name: u32,
    mut whole: impl FnMut(usize, u32) -> u32,
) {
    let mut depth = ramp.first;
    for (i, cell) in cells.iter_mut().enumerate() {
        let there = cell.number();
        let wins = depth > there | NAMES
            || (depth >= there & !NAMES
                && (there & NAMES == 0 || depth >= whole(i, there & NAMES)));
        if wins {
            cell.set_number(depth & !NAMES | name);
        }
        depth = depth.wrapping_add(ramp.step);
    }
}

/// Those pixels of a span are seen whose cells have this name; their cells become farthest.
pub struct Named<'c, D: LineDepth> {
    cells: &'c mut [D::Cell],
    name: u32,
    seen: u32,
}

impl<'c, D: LineDepth> Named<'c, D> {
    /// Over the cells of a span.
    pub fn new(cells: &'c mut [D::Cell], name: u32) -> Self {
        Self {
            cells,
            name,
            seen: 0,
        }
    }

    /// Who has a cell, 0 for nobody.
    pub fn of(cell: &D::Cell) -> u32 {
        cell.number() & NAMES
    }

    /// How many pixels were seen.
    pub fn seen(&self) -> u32 {
        self.seen
    }
}

impl<D: LineDepth> Visible for Named<'_, D> {
    #[inline(always)]
    fn each<W>(&mut self, pixels: &mut [W], mut each: impl FnMut(&mut W, bool)) {
        let cells = core::mem::take(&mut self.cells);
        let (now, later) = cells.split_at_mut(pixels.len().min(cells.len()));
        for (pixel, cell) in pixels.iter_mut().zip(now) {
            let shown = Self::of(cell) == self.name;
            if shown {
                *cell = D::FARTHEST;
                self.seen += 1;
            }
            each(pixel, shown);
        }
        self.cells = later;
    }
}
