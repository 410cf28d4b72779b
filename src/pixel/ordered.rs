//! The order of a 4 x 4 dither over the picture (H10).

use crate::composite::{Ordered, Ranks};

/// By how much a place of the picture raises a colour before it is cut to a step: -15 to 15 of 32 parts of a step, all
/// of them once in 4 x 4 pixels.
#[inline(always)]
pub(crate) fn threshold(column: u32, line: u32) -> i32 {
    2 * i32::from(Ordered::RANKS[line as usize & 3][column as usize & 3]) - 15
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_part_is_there_once_and_neighbours_on_a_line_are_far_apart() {
        let mut seen = [0; 31];
        for (x, y) in (0..4).flat_map(|y| (0..4).map(move |x| (x, y))) {
            seen[(threshold(x, y) + 15) as usize] += 1;
            assert_eq!(threshold(x, y), threshold(x + 4, y + 8));
            let apart = (threshold(x, y) - threshold(x + 1, y)).abs();
            assert!(apart >= 12, "{x}, {y}: {apart}");
        }
        assert!(seen.iter().step_by(2).all(|&n| n == 1));
        assert!(seen.iter().skip(1).step_by(2).all(|&n| n == 0));
    }
}
