//! The depth test of a draw call that has one of its own (H9): answers in bits.

use crate::num::rolled;
use crate::scene::{DepthFunction, DepthTest};
use core::hint::black_box;

/// Most pixels that are asked for in one go.
pub(crate) const MOST: usize = 32;

/// What is seen through and hidden by what is nearer.
const SEEN: DepthTest = DepthTest::HIDES.without_write();

/// How up to [`MOST`] depths compare with their cells: a bit for each pixel, the first the top one.
#[derive(Clone, Copy)]
struct Orders {
    farther: u32,
    nearer: u32,
    all: u32,
}

impl Orders {
    /// Of depths from `at` on by `step`.
    #[inline(never)]
    fn of(cells: &[u32], at: u32, step: u32) -> Self {
        let (mut farther, mut nearer, mut depth) = (0u32, 0u32, at);
        // Counted down beside the end of the cells: a loop of one end would be unrolled, and conditions come back.
        let mut left = 32;
        for &cell in cells.iter().take(MOST) {
            // The borrow of a subtraction, -1 or 0, takes fewer instructions than a condition.
            let is_less = |a: u32, b: u32| (u64::from(a).wrapping_sub(u64::from(b)) >> 32) as u32;
            farther = (farther << 1).wrapping_sub(is_less(depth, cell));
            nearer = (nearer << 1).wrapping_sub(is_less(cell, depth));
            depth = depth.wrapping_add(step);
            left -= 1;
        }
        // Of no cells no bit is set, whatever it is shifted by.
        let top = left & 31;
        Self {
            farther: farther << top,
            nearer: nearer << top,
            all: if left == 32 { 0 } else { u32::MAX << top },
        }
    }

    /// Those that pass.
    #[inline(always)]
    fn passing(self, function: DepthFunction) -> u32 {
        let Self {
            farther,
            nearer,
            all,
        } = self;
        function.among([farther, all & !(farther | nearer), nearer])
    }
}

/// Compares up to [`MOST`] depths, from `at` on by `step`, with their cells, and keeps those that are to be kept; a
/// bit for each pixel that is seen, the first the top one.
#[inline(never)]
pub(crate) fn test(cells: &mut [u32], at: u32, step: u32, test: DepthTest) -> u32 {
    // Most calls hide what is farther, or are seen through and keep nothing.
    match test {
        DepthTest::HIDES => return nearer(cells, at, step, |cell, depth| *cell = depth),
        SEEN => return nearer(cells, at, step, |_, _| {}),
        _ => {}
    }
    let orders = Orders::of(cells, at, step);
    let (mut kept, mut depth) = (orders.passing(test.depth_if), at);
    if kept == orders.all {
        keep(cells, at, step);
    } else if kept != 0 {
        // A length that the compiler knows would be unrolled.
        for cell in black_box(cells) {
            if kept >> 31 != 0 {
                *cell = depth;
            }
            kept <<= 1;
            depth = depth.wrapping_add(step);
        }
    }
    orders.passing(test.colour_if)
}

/// The same of depths that are seen where they are at least as near, each of which `keep` may keep.
#[inline(always)]
fn nearer(cells: &mut [u32], at: u32, step: u32, keep: impl Fn(&mut u32, u32)) -> u32 {
    let (mut seen, mut depth) = (0u32, at);
    let count = cells.len().min(MOST) as u32;
    for cell in cells {
        rolled();
        seen <<= 1;
        if depth >= *cell {
            keep(cell, depth);
            seen |= 1;
        }
        depth = depth.wrapping_add(step);
    }
    // Of no cells no bit is set, whatever it is shifted by.
    seen << (32u32.wrapping_sub(count) & 31)
}

/// Keeps depths from `at` on by `step`.
#[inline(never)]
pub(crate) fn keep(cells: &mut [u32], at: u32, step: u32) {
    let mut depth = at;
    for cell in cells {
        *cell = depth;
        depth = depth.wrapping_add(step);
    }
}

#[cfg(test)]
mod tests {
    use super::super::functions::FUNCTIONS;
    use super::*;
    use crate::num::random::Rng;

    #[test]
    fn every_pair_of_functions_does_what_its_name_says() {
        let mut rng = Rng(3);
        let mut passed = [0; 2];
        for (colour_if, colours) in FUNCTIONS {
            for (depth_if, writes) in FUNCTIONS {
                for _ in 0..60 {
                    // Few depths, so that many are equal.
                    let count = 1 + rng.below(MOST as u32) as usize;
                    let before = [(); MOST].map(|()| rng.below(6));
                    let (at, step) = (rng.below(6), [0, 1, u32::MAX][rng.below(3) as usize]);
                    let mut cells = before;
                    let rule = DepthTest {
                        colour_if,
                        depth_if,
                    };
                    let seen = test(&mut cells[..count], at, step, rule);
                    for i in 0..MOST {
                        let new = at.wrapping_add(step.wrapping_mul(i as u32));
                        let (old, here) = (before[i], i < count);
                        assert_eq!(seen << i >> 31 == 1, here && colours(new, old));
                        let kept = here && writes(new, old);
                        assert_eq!(cells[i], if kept { new } else { old });
                        passed[usize::from(kept)] += 1;
                    }
                }
            }
        }
        assert!(passed.iter().all(|&n| n > 10_000), "{passed:?}");
    }
}
