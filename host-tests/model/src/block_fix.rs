//! Block-fix depth: 1/w in 16 bits, a range and a significand (H2).
//!
//! `1/w = s 2^(-3 e)`: two bits say which of four ranges, 14 bits divide it evenly. A triangle has
//! one range, that of its nearest corner, so that its significands are linear on the screen like
//! 1/w itself. Ranges overlap: a far corner of a near triangle may have a value that a far
//! triangle writes with a higher range. Hence a comparison shifts both to the finest range; the
//! 16 bits alone have no order.

/// 1/w as `range` in the upper 2 and `significand` in the lower 14 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Hash)]
pub struct BlockFix16(u16);

impl BlockFix16 {
    /// Farther than anything: 1/w is 0.
    pub const FARTHEST: Self = Self(3 << 14);

    /// The range of a triangle whose largest 1/w is `nearest`, in 1.31: 0 to 3.
    ///
    /// Range `e` is for values of at least `2^(-3 e - 3)`; what is smaller than `2^-9` has 3.
    #[inline]
    #[must_use]
    pub const fn range_of(nearest: u32) -> u32 {
        // 2^-3 is bit 28. 1 itself, bit 31, is in range 0 and saturates.
        let zeros = nearest.leading_zeros();
        let range = zeros.saturating_sub(1) / 3;
        if range > 3 { 3 } else { range }
    }

    /// The value in 1.31 in a range (0 to 3), rounded down; what is beyond the range's largest
    /// significand becomes that.
    #[inline]
    #[must_use]
    pub const fn new(depth: u32, range: u32) -> Self {
        let range = range & 3;
        // s = depth 2^(3 e) in 0.14 of 1.31
        let significand = depth >> (17 - 3 * range);
        let significand = if significand > 0x3FFF {
            0x3FFF
        } else {
            significand
        };
        Self((range << 14 | significand) as u16)
    }

    /// The range, 0 to 3.
    #[inline]
    #[must_use]
    pub const fn range(self) -> u32 {
        (self.0 >> 14) as u32
    }

    /// The significand, 14 fraction bits.
    #[inline]
    #[must_use]
    pub const fn significand(self) -> u32 {
        (self.0 & 0x3FFF) as u32
    }

    /// The 16 bits.
    #[inline]
    #[must_use]
    pub const fn to_bits(self) -> u16 {
        self.0
    }

    /// From its 16 bits; every pattern is a depth.
    #[inline]
    #[must_use]
    pub const fn from_bits(bits: u16) -> Self {
        Self(bits)
    }

    /// 1/w exactly, 23 fraction bits: what comparisons are made of.
    #[inline]
    #[must_use]
    pub const fn key(self) -> u32 {
        self.significand() << (9 - 3 * self.range())
    }

    /// 1/w exactly in 1.31.
    #[inline]
    #[must_use]
    pub const fn to_depth(self) -> u32 {
        self.key() << 8
    }

    /// Whether this is as near as `other`, or nearer.
    #[inline]
    #[must_use]
    pub const fn covers(self, other: Self) -> bool {
        self.key() >= other.key()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A decimal with `digits` digits behind the point in 1.31, rounded down.
    fn depth(units: u64, digits: u32) -> u32 {
        ((units << 31) / 10u64.pow(digits)) as u32
    }

    #[test]
    fn the_printed_table_comes_out() {
        for (units, digits, range, significand) in [
            (5, 1, 0, 0b10_0000_0000_0000),
            (25, 2, 0, 0b01_0000_0000_0000),
            (125, 3, 0, 0b00_1000_0000_0000),
            (625, 4, 1, 0b10_0000_0000_0000),
            (5, 2, 1, 0b01_1001_1001_1001),
            (1, 2, 2, 0b10_1000_1111_0101),
            (5, 3, 2, 0b01_0100_0111_1010),
            (1, 3, 3, 0b10_0000_1100_0100),
            (5, 4, 3, 0b01_0000_0110_0010),
            (1, 4, 3, 0b00_0011_0100_0110),
        ] {
            let depth = depth(units, digits);
            assert_eq!(
                BlockFix16::range_of(depth),
                range,
                "{units} of 10^{digits} has range {range}"
            );
            let fix = BlockFix16::new(depth, range);
            assert_eq!(fix.significand(), significand, "{units} of 10^{digits}");
            assert_eq!(fix.range(), range);
        }
    }

    #[test]
    fn ends_of_the_ranges() {
        let one = 1u32 << 31;
        assert_eq!(BlockFix16::range_of(one), 0);
        assert_eq!(BlockFix16::new(one, 0).significand(), 0x3FFF);
        for range in 1..4 {
            let first = one >> (3 * range);
            assert_eq!(BlockFix16::range_of(first), range - 1);
            assert_eq!(BlockFix16::range_of(first - 1), range);
            assert_eq!(BlockFix16::new(first - 1, range).significand(), 0x3FFF);
        }
        assert_eq!(BlockFix16::range_of(0), 3);
        assert_eq!(BlockFix16::new(0, 3), BlockFix16::FARTHEST);
        assert_eq!(BlockFix16::FARTHEST.key(), 0);
    }

    /// Comparisons against exact rationals `s / 2^(14 + 3 e)` by cross multiplication, for all
    /// significands at random and all pairs of ranges.
    #[test]
    fn order_is_that_of_the_rationals() {
        let mut state = 9u64;
        let mut equal = 0;
        for i in 0..2_000_000u64 {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let a = (state >> 33) as u16;
            // Half of the time a neighbour in another range, so that equal ones come too.
            let b = if i % 2 == 0 {
                (state >> 49) as u16
            } else {
                let down = (u32::from(a & 0x3FFF) >> 3) as u16;
                (a.wrapping_sub(1 << 14) & 0xC000) | (down + (state >> 60) as u16 % 2) & 0x3FFF
            };
            let part = |bits: u16| (u128::from(bits & 0x3FFF), 1u128 << (14 + 3 * (bits >> 14)));
            let ((an, ad), (bn, bd)) = (part(a), part(b));
            let exact = (an * bd).cmp(&(bn * ad));
            let (a, b) = (BlockFix16::from_bits(a), BlockFix16::from_bits(b));
            assert_eq!(a.key().cmp(&b.key()), exact, "{a:?} {b:?}");
            assert_eq!(a.covers(b), exact.is_ge());
            equal += u32::from(exact.is_eq());
        }
        assert!(equal > 10_000, "{equal} pairs were equal");
    }

    #[test]
    fn encoding_rounds_down_by_less_than_a_step() {
        for bits in 0..=u16::MAX {
            let fix = BlockFix16::from_bits(bits);
            let step = 1u32 << (17 - 3 * fix.range());
            assert_eq!(BlockFix16::new(fix.to_depth(), fix.range()), fix);
            assert_eq!(BlockFix16::new(fix.to_depth() + step - 1, fix.range()), fix);
        }
    }
}
