//! The colour of a vertex in one word: 11-11-10 bits (K15), 1/8 level of red and green and 1/4
//! level of blue, half a step off at most.

/// A colour with red in 8.3, green in 8.3 and blue in 8.2 bits, 0 to 255 a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Colour(u32);

impl Colour {
    /// From 8-bit levels, exactly.
    #[must_use]
    pub const fn from_rgb8(rgb: [u8; 3]) -> Self {
        Self((rgb[0] as u32) << 24 | (rgb[1] as u32) << 13 | (rgb[2] as u32) << 2)
    }

    /// From channels in 8.8 bits, 0 to 0xFF00, rounded to nearest.
    #[inline]
    #[must_use]
    pub const fn from_levels(rgb: [u32; 3]) -> Self {
        Self((((rgb[0] + 16) >> 5) << 21) | (((rgb[1] + 16) >> 5) << 10) | ((rgb[2] + 32) >> 6))
    }

    /// The channels in 8.8 bits, 0 to 0xFF00.
    #[inline]
    #[must_use]
    pub const fn levels(self) -> [u32; 3] {
        [
            (self.0 >> 21) << 5,
            ((self.0 >> 10) & 0x7FF) << 5,
            (self.0 & 0x3FF) << 6,
        ]
    }

    /// The colour at `t` (0 to 2^30 for 0 to 1) on the way to `other`.
    #[must_use]
    pub fn lerp(self, other: Self, t: i64) -> Self {
        let (a, b) = (self.levels(), other.levels());
        let mix = |i: usize| {
            let (a, b) = (i64::from(a[i]), i64::from(b[i]));
            (a + (((b - a) * t + (1 << 29)) >> 30)) as u32
        };
        Self::from_levels([mix(0), mix(1), mix(2)])
    }
}

#[cfg(test)]
mod tests {
    use super::Colour;

    #[test]
    fn both_ends_survive() {
        for level in [0u8, 1, 127, 254, 255] {
            let c = Colour::from_rgb8([level, 255 - level, level]);
            let l = u32::from(level) << 8;
            assert_eq!(c.levels(), [l, 0xFF00 - l, l]);
            assert_eq!(Colour::from_levels(c.levels()), c);
        }
        let (a, b) = (Colour::from_rgb8([0; 3]), Colour::from_rgb8([255; 3]));
        assert_eq!(a.lerp(b, 0), a);
        assert_eq!(a.lerp(b, 1 << 30), b);
        assert_eq!(a.lerp(b, 1 << 29).levels(), [0x7F80; 3]);
    }
}
