//! Depth and colour in one word: one comparison and one store a pixel, and the line is read out of the
//! depth line when all of it is drawn (K8, X3).
//!
//! A word holds 16 bits of 1/w above the finished pixel, so the nearer of two is the larger. What is
//! compared has all lower bits set: where 16 bits of depth are the same, what is submitted later wins,
//! as by [`Depth32`](super::Depth32). 1/w of a pixel is at least 1 in its 16 bits, so 0 is nobody.

use super::{DepthCell, DepthRamp, LineDepth};
use core::cmp::Ordering;

/// 16 bits of 1/w, one word a pixel with its colour: nearer or equal wins.
///
/// Nearer by less than 2^-16 of the nearest depth may lose to what is submitted later; otherwise the
/// picture is that of [`Depth32`](super::Depth32). On lines where spans overlap, pixels of at most 16 bits go into
/// the words of the depth line first; formats with more are tested by the same 16 bits.
#[derive(Clone, Copy, Debug)]
pub struct DepthAndColour;

/// Bits of 1/w in 1.31 below the 16 that are kept.
const BELOW: u32 = 15;
/// The least and the most that 16 bits keep, in 1.31.
const LEAST: u32 = 1 << BELOW;
const MOST: u32 = (1 << 31) - 1;

/// What of a depth is compared: 1 itself is as near as what is next to it.
#[inline(always)]
fn within(depth: u32) -> u32 {
    depth.clamp(LEAST, MOST)
}

impl LineDepth for DepthAndColour {
    type Cell = u32;
    const TESTS: bool = true;
    // Two ranges of depth that do not meet may lie within one step.
    const ORDERS: bool = false;
    const WORDS: bool = true;
    type Grain = ();

    #[inline(always)]
    fn grain(_: u16) {}

    #[inline(always)]
    fn test(cell: &mut u32, depth: u32, (): ()) -> bool {
        let depth = within(depth);
        let seen = depth | (LEAST - 1) >= *cell;
        if seen {
            *cell = depth;
        }
        seen
    }

    #[inline(always)]
    fn compare(cell: &u32, depth: u32) -> Ordering {
        (within(depth) >> BELOW).cmp(&(cell >> BELOW))
    }
}

/// Depths along a span in the upper halves of words.
#[derive(Clone, Copy, Debug)]
pub struct WordCourse {
    /// The depth of the next pixel; what the lower half has is below what is kept.
    at: u32,
    step: u32,
}

impl WordCourse {
    /// Over so many pixels, at least one, from a depth and its step on; none where a depth between has to be
    /// put within limits first.
    #[inline(always)]
    pub fn new(ramp: DepthRamp, pixels: usize) -> Option<Self> {
        let DepthRamp { first: depth, step } = ramp;
        let last = depth.wrapping_add(step.wrapping_mul(pixels as u32 - 1));
        let fits = within(depth) == depth && within(last) == last;
        fits.then_some(Self {
            at: depth << 1,
            step: step << 1,
        })
    }

    /// At one pixel, whatever its depth is.
    pub fn single(depth: u32) -> Self {
        Self {
            at: within(depth) << 1,
            step: 0,
        }
    }

    /// Puts a pixel into its cell, where it is not behind what is there, and goes on to the next;
    /// whether it is seen.
    #[inline(always)]
    pub fn put<C: DepthCell>(&mut self, cell: &mut C, pixel: u16) -> bool {
        let seen = self.at | 0xFFFF >= cell.number();
        if seen {
            cell.set_number(self.at & 0xFFFF_0000 | u32::from(pixel));
        }
        self.at = self.at.wrapping_add(self.step);
        seen
    }

    /// Whether one would be seen.
    pub fn is_seen<C: DepthCell>(&self, cell: &C) -> bool {
        self.at | 0xFFFF >= cell.number()
    }
}

/// Takes the pixels out of the cells, which become farthest; where nobody is, `pixels` stay.
#[inline(never)]
pub fn resolve<C: DepthCell, W>(cells: &mut [C], pixels: &mut [W], from_half: impl Fn(u16) -> W) {
    for (cell, pixel) in cells.iter_mut().zip(pixels) {
        let word = cell.number();
        cell.set_number(0);
        if word != 0 {
            *pixel = from_half(word as u16);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::random::Rng;
    use std::vec;

    /// Random spans over each other, against 16 bits of depth and a colour kept apart.
    #[test]
    fn words_are_16_bits_of_depth_and_the_colour_of_the_nearest() {
        let mut rng = Rng(21);
        let (mut equal, mut limited) = (0, 0);
        for _ in 0..3000 {
            let width = 1 + rng.below(40) as usize;
            let mut cells = vec![0u32; width];
            let mut tested = vec![0u32; width];
            let mut naive: std::vec::Vec<Option<(u64, u16)>> = vec![None; width];
            for _ in 0..8 {
                let start = rng.below(width as u32) as usize;
                let end = start + 1 + rng.below((width - start) as u32) as usize;
                // Near the ends of the range too, and few steps apart.
                let base = [0, 1 << 20, 1 << 30, (1 << 31) - (1 << 19)][rng.below(4) as usize];
                let depth = base + rng.below(1 << 19);
                let step = rng.below(1 << 12).wrapping_sub(1 << 11);
                let last = i64::from(depth) + i64::from(step as i32) * (end - start - 1) as i64;
                if !(0..=1 << 31).contains(&last) {
                    continue;
                }
                let course = WordCourse::new(DepthRamp { first: depth, step }, end - start);
                limited += u32::from(course.is_none());
                let colour = rng.below(1 << 16) as u16;
                for i in start..end {
                    let at = depth.wrapping_add(step.wrapping_mul((i - start) as u32));
                    let mut single = match course {
                        Some(mut course) => {
                            course.at = course
                                .at
                                .wrapping_add(course.step.wrapping_mul((i - start) as u32));
                            course
                        }
                        None => WordCourse::single(at),
                    };
                    let shown = single.put(&mut cells[i], colour);
                    let sixteen = (u64::from(at) >> 15).clamp(1, 0xFFFF);
                    let expected = naive[i].is_none_or(|(there, _)| sixteen >= there);
                    equal += u32::from(naive[i].is_some_and(|(there, _)| sixteen == there));
                    if expected {
                        naive[i] = Some((sixteen, colour));
                    }
                    assert_eq!(shown, expected);
                    let order = DepthAndColour::compare(&tested[i], at);
                    assert_eq!(DepthAndColour::test(&mut tested[i], at, ()), expected);
                    assert_eq!(order.is_ge(), expected);
                }
            }
            let mut pixels = vec![0xAAAA; width];
            resolve(&mut cells, &mut pixels, |half| half);
            let colours = naive.iter().map(|n| n.map_or(0xAAAA, |(_, colour)| colour));
            assert!(pixels.iter().copied().eq(colours));
            assert!(cells.iter().all(|cell| *cell == 0));
        }
        assert!(equal > 1000 && limited > 300, "{equal} {limited}");
    }
}
