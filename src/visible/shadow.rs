//! Shadow polygons, counted pixel by pixel in front of what is seen (K9).
//!
//! A ray from the eye goes into a shadow volume through the front of a polygon and leaves it
//! through the back of another, so where fronts (-1) and backs (+1) do not balance the pixel is in
//! shadow. The counts of one line are all that is kept: they lie beside its depths.

use super::{DepthCell, DepthRamp, LineDepth};
use crate::geometry::DepthFunction;

/// The depth of a pixel, and how many shadow polygons are in front of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct ShadowCell {
    depth: u32,
    count: i32,
}

impl ShadowCell {
    /// With a depth, 0 for the farthest, and a count.
    #[must_use]
    pub const fn new(depth: u32, count: i32) -> Self {
        Self { depth, count }
    }
}

impl DepthCell for ShadowCell {
    const FARTHEST: Self = Self::new(0, 0);

    #[inline(always)]
    fn number(&self) -> u32 {
        self.depth
    }

    #[inline(always)]
    fn set_number(&mut self, number: u32) {
        self.depth = number;
    }

    #[inline(always)]
    fn count(&self) -> i32 {
        self.count
    }

    #[inline(always)]
    fn set_count(&mut self, count: i32) {
        self.count = count;
    }
}

/// 32 bits of 1/w as [`Depth32`](super::Depth32), and a count of shadow polygons: 8 bytes a pixel
/// of one line.
#[derive(Clone, Copy, Debug)]
pub struct ShadowDepth32;

impl LineDepth for ShadowDepth32 {
    type Cell = ShadowCell;
    const TESTS: bool = true;
    type Grain = ();

    #[inline(always)]
    fn grain(_: u16) {}

    #[inline(always)]
    fn test(cell: &mut ShadowCell, depth: u32, (): ()) -> bool {
        let seen = depth >= cell.depth;
        if seen {
            cell.depth = depth;
        }
        seen
    }
}

/// Counts a shadow polygon along a span, where `passes` says so of its depths.
#[inline(never)]
pub fn count_span<D: LineDepth>(
    cells: &mut [D::Cell],
    ramp: DepthRamp,
    passes: DepthFunction,
    away: bool,
) {
    let change = if away { 1 } else { -1 };
    let mut depth = ramp.first;
    for cell in cells {
        if passes.passes(D::compare(cell, depth)) {
            cell.set_count(cell.count().wrapping_add(change));
        }
        depth = depth.wrapping_add(ramp.step);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::random::Rng;
    use std::vec::Vec;

    /// Polygons one behind the other, against what a ray through each pixel meets.
    #[test]
    fn counts_are_those_of_rays() {
        let mut rng = Rng(11);
        let mut below = |n: u32| rng.below(n);
        let mut in_shadow = 0;
        for _ in 0..2000 {
            let width = 1 + below(40) as usize;
            let mut cells: Vec<ShadowCell> = (0..width)
                .map(|_| ShadowCell::new(100 + below(100), 0))
                .collect();
            let mut expected = std::vec![0; width];
            for _ in 0..below(6) {
                let start = below(width as u32) as usize;
                let end = start + 1 + below((width - start) as u32) as usize;
                let (depth, step) = (80 + below(140), below(5).wrapping_sub(2));
                let away = below(2) == 1;
                count_span::<ShadowDepth32>(
                    &mut cells[start..end],
                    DepthRamp { first: depth, step },
                    DepthFunction::NEARER,
                    away,
                );
                for i in start..end {
                    let at = depth.wrapping_add(step.wrapping_mul((i - start) as u32));
                    let front = at > cells[i].depth;
                    expected[i] += i32::from(front) * if away { 1 } else { -1 };
                }
            }
            for (cell, count) in cells.iter().zip(&expected) {
                assert_eq!(cell.count, *count);
                in_shadow += u32::from(*count != 0);
            }
        }
        assert!(in_shadow > 1000);
    }
}
