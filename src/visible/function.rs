//! Depth functions: which pixels of a span are coloured, and which keep their depth (H9).
//!
//! What is hidden in the usual way does not come here: that is one comparison in the loop that
//! colours. Here the answer is a word of bits, so that pixels which are all seen can be blended
//! several at a time.

use super::{DepthCell, DepthRamp, LineDepth};
use crate::geometry::DepthFunction;

/// Most pixels that are asked for in one go.
pub const MOST: usize = 32;

/// Which pixels pass.
#[derive(Clone, Copy, Debug)]
pub struct Rule {
    /// Those whose colour is written.
    pub colour_if: DepthFunction,
    /// Those whose depth is written.
    pub depth_if: DepthFunction,
}

impl Rule {
    /// A bit for each of at most [`MOST`] pixels whose colour is to be written, the first the
    /// lowest; their cells get the depths that are to be written. Depths are
    /// those of `ramp`, each rounded to the object's grain as where it is [tested](LineDepth::test); pixels
    /// that `keep` has no bit of are as if they were not there.
    #[inline(never)]
    pub fn apply<D: LineDepth>(
        &self,
        cells: &mut [D::Cell],
        ramp: DepthRamp,
        grain: D::Grain,
        keep: u32,
    ) -> u32 {
        let (mut seen, mut next) = (0, ramp.first);
        for (i, cell) in cells.iter_mut().take(MOST).enumerate() {
            if keep >> i & 1 != 0 {
                let depth = D::rounded(next, grain);
                let order = D::compare(cell, depth);
                let passes = self.colour_if.passes(order);
                seen |= u32::from(passes) << i;
                if self.depth_if.passes(order) {
                    cell.set_number(depth);
                }
            }
            next = next.wrapping_add(ramp.step);
        }
        seen
    }
}

#[cfg(test)]
mod tests {
    use super::super::Depth32;
    use super::super::functions::FUNCTIONS;
    use super::*;
    use crate::num::random::Rng;
    use std::vec::Vec;

    /// Random spans of all pairs of functions, against one pixel after the other.
    #[test]
    fn functions_are_those_of_a_naive_line() {
        let mut rng = Rng(3);
        let mut below = |n: u32| rng.below(n);
        let mut passed = [0u32; 2];
        for (colour_if, colours) in FUNCTIONS {
            for (depth_if, writes) in FUNCTIONS {
                for _ in 0..60 {
                    // Few depths, so that many are equal.
                    let count = 1 + below(32) as usize;
                    let before: Vec<u32> = (0..count).map(|_| 4 * below(6)).collect();
                    let mut cells = before.clone();
                    let (depth, step) = (
                        4 * below(6),
                        [0u32, 4, 4u32.wrapping_neg()][below(3) as usize],
                    );
                    let keep = if below(2) == 0 {
                        u32::MAX
                    } else {
                        below(1 << 24) << below(9)
                    };
                    let ramp = DepthRamp { first: depth, step };
                    let rule = Rule {
                        colour_if,
                        depth_if,
                    };
                    let seen = rule.apply::<Depth32>(&mut cells, ramp, (), keep);
                    for i in 0..count {
                        let new = depth.wrapping_add(step.wrapping_mul(i as u32));
                        let old = before[i];
                        let here = keep >> i & 1 == 1;
                        assert_eq!(seen >> i & 1 == 1, here && colours(new, old));
                        let expected = if here && writes(new, old) { new } else { old };
                        assert_eq!(cells[i], expected);
                        passed[usize::from(seen >> i & 1 == 1)] += 1;
                    }
                    assert_eq!(seen.checked_shr(count as u32).unwrap_or(0), 0);
                }
            }
        }
        assert!(passed.iter().all(|n| *n > 10_000), "{passed:?}");
    }
}
