//! Shadow volumes, counted pixel by pixel in front of what is seen (K9).
//!
//! A ray from the eye goes into a volume through a face that is seen from outside, and leaves it through one that is
//! seen from inside: where they do not balance, the pixel is in shadow. Counts are modulo 256.

use super::MOST_TESTED;
use crate::geometry::DepthFunction;

/// A pixel in shadow, once counts are [`settled`](settle).
const SHADOWED: u8 = 1;
/// A pixel that has its part already.
const DONE: u8 = 2;

/// Changes the counts of pixels whose depths, from `at` on by `step`, pass.
#[inline(never)]
pub(crate) fn count(
    counts: &mut [u8],
    cells: &[u32],
    [at, step]: [u32; 2],
    passes: DepthFunction,
    change: u8,
) {
    let mut depth = at;
    for (count, cell) in counts.iter_mut().zip(cells) {
        if passes.passes(depth.cmp(cell)) {
            *count = count.wrapping_add(change);
        }
        depth = depth.wrapping_add(step);
    }
}

/// Makes of counts what [`receive`] asks.
#[inline(never)]
pub(crate) fn settle(counts: &mut [u8]) {
    for count in counts {
        *count = if *count == 0 { 0 } else { SHADOWED };
    }
}

/// Which pixels get a surface that is drawn again.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Receives {
    pub(crate) passes: DepthFunction,
    /// Those in shadow, or the others.
    pub(crate) is_shadowed: bool,
    /// Each once alone: where two faces meet at one depth, such as at the outline of a mesh, a light is added once.
    pub(crate) is_once: bool,
}

/// A bit for each of up to [`MOST_TESTED`] pixels that a surface is drawn on, the first the lowest.
#[inline(never)]
pub(crate) fn receive(
    counts: &mut [u8],
    cells: &[u32],
    [at, step]: [u32; 2],
    how: Receives,
) -> u32 {
    let mask = SHADOWED | if how.is_once { DONE } else { 0 };
    let want = u8::from(how.is_shadowed);
    let (mut seen, mut depth) = (0, at);
    let pixels = counts.iter_mut().zip(cells).take(MOST_TESTED);
    for (i, (count, cell)) in pixels.enumerate() {
        if *count & mask == want && how.passes.passes(depth.cmp(cell)) {
            seen |= 1 << i;
            if how.is_once {
                *count |= DONE;
            }
        }
        depth = depth.wrapping_add(step);
    }
    seen
}
