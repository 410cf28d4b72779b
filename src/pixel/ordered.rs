//! The order of a 4 x 4 dither over the picture (H10).

/// The order in which pixels of a tile take the next step, line by line: each 2 x 2 block, line and diagonal has ranks
/// from all quarters.
const RANKS: [[u8; 4]; 4] = [[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]];

/// By how much a place of the picture raises a colour before it is cut to a step: -15 to 15 of 32 parts of a step, all
/// of them once in 4 x 4 pixels.
#[inline(always)]
pub(crate) const fn threshold(column: u32, line: u32) -> i32 {
    2 * RANKS[line as usize & 3][column as usize & 3] as i32 - 15
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
