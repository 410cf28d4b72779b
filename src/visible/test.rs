//! The depth test of a draw call that has one of its own (H9): answers in bits.

use crate::scene::DepthTest;

/// Most pixels that are asked for in one go.
pub(crate) const MOST: usize = 32;

/// Compares up to [`MOST`] depths, from `at` on by `step`, with their cells, and keeps those that are to be kept; a
/// bit for each pixel that is seen, the first the lowest.
#[inline(never)]
pub(crate) fn test(cells: &mut [u32], at: u32, step: u32, test: DepthTest) -> u32 {
    let (mut seen, mut depth) = (0, at);
    for (i, cell) in cells.iter_mut().take(MOST).enumerate() {
        let order = depth.cmp(cell);
        seen |= u32::from(test.colour_if.passes(order)) << i;
        if test.depth_if.passes(order) {
            *cell = depth;
        }
        depth = depth.wrapping_add(step);
    }
    seen
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
                        assert_eq!(seen >> i & 1 == 1, here && colours(new, old));
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
