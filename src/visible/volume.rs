//! Shadow volumes, counted pixel by pixel in front of what is seen (K9).
//!
//! A ray from the eye goes into a volume through a face that is seen from outside, and leaves it through one that is
//! seen from inside: where they do not balance, the pixel is in shadow. Counts are modulo 256.

use super::MOST_TESTED;
use crate::num::rolled;
use crate::scene::DepthFunction;

/// A pixel in shadow, once counts are [`settled`](settle): the lowest bit.
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
    // Nearly all volumes are in front of what is there.
    if passes == DepthFunction::NEARER {
        for (count, &cell) in counts.iter_mut().zip(cells) {
            rolled();
            if depth > cell {
                *count = count.wrapping_add(change);
            }
            depth = depth.wrapping_add(step);
        }
        return;
    }
    for (count, cell) in counts.iter_mut().zip(cells) {
        rolled();
        if passes.passes(depth.cmp(cell)) {
            *count = count.wrapping_add(change);
        }
        depth = depth.wrapping_add(step);
    }
}

/// Makes of counts what [`receive`] asks.
#[inline(never)]
pub(crate) fn settle(counts: &mut [u8]) {
    let (head, words, tail) = bytemuck::pod_align_to_mut::<u8, u32>(counts);
    for word in words {
        rolled();
        // Bit 7 of each byte says whether any of its bits is set.
        let any = ((*word & 0x7F7F_7F7F) + 0x7F7F_7F7F) | *word;
        *word = any >> 7 & 0x0101_0101;
    }
    for count in head.iter_mut().chain(tail) {
        rolled();
        *count = u8::from(*count != 0);
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

/// A bit for each of up to [`MOST_TESTED`] pixels that a surface is drawn on, the first the top one.
#[inline(never)]
pub(crate) fn receive(counts: &mut [u8], cells: &[u32], depths: [u32; 2], how: Receives) -> u32 {
    // Nearly all surfaces are those that are there.
    match how.passes {
        DepthFunction::EQUAL => receive_if(counts, cells, depths, how, |depth, cell| depth == cell),
        passes => receive_if(counts, cells, depths, how, |depth, cell| {
            passes.passes(depth.cmp(&cell))
        }),
    }
}

#[inline(always)]
fn receive_if(
    counts: &mut [u8],
    cells: &[u32],
    [at, step]: [u32; 2],
    how: Receives,
    passes: impl Fn(u32, u32) -> bool,
) -> u32 {
    let done = if how.is_once { DONE } else { 0 };
    let (mask, want) = (SHADOWED | done, u8::from(how.is_shadowed));
    let (mut seen, mut bit, mut depth) = (0, 1 << 31, at);
    // A loop of one end would be unrolled.
    for (count, &cell) in counts.iter_mut().zip(cells).take(MOST_TESTED) {
        if *count & mask == want && passes(depth, cell) {
            seen |= bit;
            *count |= done;
        }
        depth = depth.wrapping_add(step);
        bit >>= 1;
    }
    seen
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::random::Rng;
    use std::vec::Vec;

    /// Kills: a bit that is not looked at, one that is carried to the next count, bytes beside the words.
    #[test]
    fn counts_settle_wherever_they_lie() {
        let mut rng = Rng(20);
        for start in 0..8 {
            let mut counts: Vec<u8> = (0..=u8::MAX)
                .chain((0..99).map(|_| rng.below(3) as u8))
                .collect();
            let before = counts.clone();
            settle(&mut counts[start..]);
            let want = |i: usize| {
                if i < start {
                    before[i]
                } else {
                    u8::from(before[i] != 0)
                }
            };
            assert!((0..counts.len()).all(|i| counts[i] == want(i)));
        }
    }

    /// Kills: another comparison for the commonest function, and its loop for any other.
    #[test]
    fn counts_change_where_depths_pass_by_any_function() {
        use DepthFunction as D;
        let (cells, at, step) = ([7, 8, 9, 10, 11], 11, u32::MAX);
        for (passes, want) in [
            (D::NEVER, [0, 0, 0, 0, 0]),
            (D::FARTHER, [0, 0, 0, 5, 5]),
            (D::EQUAL, [0, 0, 5, 0, 0]),
            (D::FARTHER_OR_EQUAL, [0, 0, 5, 5, 5]),
            (D::NEARER, [5, 5, 0, 0, 0]),
            (D::DIFFERENT, [5, 5, 0, 5, 5]),
            (D::NEARER_OR_EQUAL, [5, 5, 5, 0, 0]),
            (D::ALWAYS, [5; 5]),
        ] {
            let mut counts = [0; 5];
            count(&mut counts, &cells, [at, step], passes, 5);
            assert_eq!(counts, want, "{passes:?}");
        }
    }

    /// Faces one behind the other, against what a ray through each pixel meets; then surfaces of all kinds, drawn again.
    #[test]
    fn counts_are_those_of_rays_and_say_who_is_drawn() {
        let mut rng = Rng(19);
        let mut seen = [0; 4];
        for _ in 0..4_000 {
            let width = 1 + rng.below(MOST_TESTED as u32) as usize;
            let cells: Vec<u32> = (0..width).map(|_| 100 + rng.below(20)).collect();
            let (mut counts, mut rays) = (std::vec![0; width], std::vec![0i32; width]);
            let ramp = |rng: &mut Rng| [95 + rng.below(30), rng.below(3).wrapping_sub(1)];
            let at = |[at, step]: [u32; 2], i: usize| at.wrapping_add(step.wrapping_mul(i as u32));
            for _ in 0..rng.below(5) {
                let (face, is_back) = (ramp(&mut rng), rng.below(2) == 1);
                let change = if is_back { 1 } else { u8::MAX };
                count(&mut counts, &cells, face, DepthFunction::NEARER, change);
                for i in (0..width).filter(|&i| at(face, i) > cells[i]) {
                    rays[i] += if is_back { 1 } else { -1 };
                }
            }
            settle(&mut counts);
            let mut done = std::vec![[false; 2]; width];
            for _ in 0..4 {
                let surface = ramp(&mut rng);
                let [is_shadowed, is_once] = [(); 2].map(|()| rng.below(2) == 1);
                let how = Receives {
                    passes: DepthFunction::EQUAL,
                    is_shadowed,
                    is_once,
                };
                let bits = receive(&mut counts, &cells, surface, how);
                for i in 0..32 {
                    let want = i < width && {
                        let done = &mut done[i][usize::from(is_shadowed)];
                        let is_here = at(surface, i) == cells[i];
                        let is_due = is_here && is_shadowed == (rays[i] != 0);
                        let is_first = !(is_once && *done);
                        *done |= is_due && is_once;
                        is_due && is_first
                    };
                    assert_eq!(bits << i >> 31 == 1, want);
                    let kind = usize::from(is_shadowed) * 2 + usize::from(is_once);
                    seen[kind] += usize::from(want);
                }
            }
        }
        assert!(seen.iter().all(|&n| n > 300), "{seen:?}");
    }
}
