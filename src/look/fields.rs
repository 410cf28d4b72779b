//! The fields of words of colour, as corners of triangles have them: 11 bits of red, 10 of blue, 11 of green.

/// Red, green and blue of a word of colour: 11, 11 and 10 bits.
#[inline(always)]
pub(super) fn fields(word: u32) -> [i32; 3] {
    [word >> 21, word & 0x7FF, word >> 11 & 0x3FF].map(|f| f as i32)
}

/// Whether corners have one colour.
#[inline(always)]
pub(super) fn is_even([a, b, c]: [u32; 3]) -> bool {
    a == b && a == c
}

/// Whether no field changes by more than a quarter of its range from the first corner on.
#[inline(always)]
pub(super) fn is_flat(colour: [u32; 3]) -> bool {
    let [a, b, c] = colour.map(fields);
    let rise = |i: usize| {
        let (one, other) = (b[i] - a[i], c[i] - a[i]);
        (one ^ one >> 31) | (other ^ other >> 31)
    };
    rise(0) | rise(1) | rise(2) << 1 < 512
}

/// The fields with 20, 20 and 21 bits more: below 2^31 each.
#[inline(always)]
pub(super) fn wide_fields(word: u32) -> [u32; 3] {
    let [red, green, blue] = fields(word);
    [red << 20, green << 20, blue << 21].map(|field| field as u32)
}

/// Steps of red, green and blue with so many bits below a field's unit, rounded into one word.
#[inline(always)]
pub(super) fn packed_step(step: [i32; 3], below: [u32; 3]) -> u32 {
    let round = |i: usize| (step[i] + (1 << below[i] >> 1)) >> below[i];
    ((round(0) << 21) as u32)
        .wrapping_add((round(2) << 11) as u32)
        .wrapping_add(round(1) as u32)
}

#[cfg(test)]
mod tests {
    use super::{is_even, is_flat};

    /// Kills: a corner or a bit that is not looked at.
    #[test]
    fn corners_of_one_colour_are_even() {
        assert!(is_even([0x1234_5678; 3]));
        for corner in 0..3 {
            for bit in 0..32 {
                let mut colour = [0x1234_5678; 3];
                colour[corner] ^= 1 << bit;
                assert!(!is_even(colour), "{corner} {bit}");
            }
        }
    }

    /// Kills: a field that may change by more, or less, than the others.
    #[test]
    fn a_quarter_of_the_range_is_flat_in_each_field() {
        for (level, flat) in [(0, true), (510, true), (514, false), (2047, false)] {
            for light in [level << 21, level, level >> 1 << 11] {
                assert_eq!(is_flat([0, 0, light]), flat, "{light:#x}");
                assert_eq!(is_flat([light, 0, light]), flat, "{light:#x}");
            }
        }
    }
}
