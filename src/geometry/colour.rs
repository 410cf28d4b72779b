//! The colour of a vertex in one word: 11, 10 and 11 bits (K15).
//!
//! The channels are steps of the output, such as 31, 63 and 31, with the fraction bits that are
//! left, and half a step added, so that to cut off the fraction rounds to nearest. All values
//! lie half a step within the fields: an interpolation that errs by less than that at either
//! end cannot leave its field, so no colour ever wraps (P4).

use super::lighting::Shine;
use crate::num::mul_wide;

/// Red in bits 31..21, blue in bits 20..11, green in bits 10..0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Colour(u32);

/// Bits of the red, green and blue fields.
const FIELD_BITS: [u32; 3] = [11, 11, 10];

/// How 8-bit levels become steps of the output.
#[derive(Clone, Copy, Debug)]
pub struct Scale {
    /// A field is `level factor / 2^8`.
    factor: [u32; 3],
    /// Fraction bits of each field.
    fraction: [u32; 3],
    /// The field of level 255, without the half.
    full: [u32; 3],
}

impl Scale {
    /// For `steps` above 0 in red, green and blue, each 1 to 256.
    #[must_use]
    pub const fn new(steps: [u16; 3]) -> Self {
        let (mut full, mut fraction, mut factor) = ([0; 3], [0; 3], [0; 3]);
        let mut i = 0;
        while i < 3 {
            fraction[i] = FIELD_BITS[i] - 1 - steps[i].ilog2();
            full[i] = (steps[i] as u32) << fraction[i];
            factor[i] = ((full[i] << 8) + 127) / 255;
            i += 1;
        }
        Self {
            factor,
            fraction,
            full,
        }
    }

    /// For shades of texels: full light is 1,024, 1,024 and 512 of a field, and a margin of 2, 2 and 1 stays to either
    /// end.
    pub(crate) const SHADE: Self = Self::new([256; 3]);

    /// The word of white in full light.
    pub(crate) const fn full_word(&self) -> u32 {
        Colour::from_rgb8([255; 3], self).word()
    }

    /// Fraction bits of the red, green and blue fields.
    #[must_use]
    pub const fn fraction(&self) -> [u32; 3] {
        self.fraction
    }
}

/// A colour that waits for its light: one multiply-add a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tint {
    /// The fields of red, green and blue in full light, times 2^3; at most 14 bits.
    field: [u32; 3],
    /// Half a step and the rounding, in 2^-18 of a field's unit.
    half: [u32; 3],
}

impl Tint {
    /// From 8-bit levels.
    pub(crate) const fn new(rgb: [u8; 3], scale: &Scale) -> Self {
        let (mut field, mut half) = ([0; 3], [0; 3]);
        let mut i = 0;
        while i < 3 {
            field[i] = (rgb[i] as u32 * scale.factor[i] + (1 << 4)) >> 5;
            half[i] = (((1 << scale.fraction[i]) >> 1) << 18) + (1 << 17);
            i += 1;
        }
        Self { field, half }
    }

    /// In `light`, 1 being 2^15; within 1/8 of a field's unit before rounding.
    #[inline]
    pub(crate) const fn lit(&self, light: u16) -> Colour {
        self.times([light as u32; 3])
    }

    /// In light of a level a channel, with which none of a colour is above full level.
    #[inline(always)]
    pub(super) const fn times(&self, light: [u32; 3]) -> Colour {
        let mut field = [0; 3];
        let mut i = 0;
        while i < 3 {
            field[i] = (self.field[i] * light[i] + self.half[i]) >> 18;
            i += 1;
        }
        Colour::from_fields(field)
    }

    /// In light of several colours; stops at full level, within 1/8 of a field's unit before
    /// rounding.
    #[inline]
    pub(super) fn shone_on(&self, shine: &Shine, scale: &Scale) -> Colour {
        Colour::from_fields([0, 1, 2].map(|i| {
            let full = scale.full[i] << 3;
            // 14 and 21 bits each.
            let part = |a: u32, b: u32| u64::from(a) * u64::from(b);
            let sum = part(self.field[i], shine.factor[i]) + part(full, shine.more[i]);
            (sum.min(u64::from(full) << 15) as u32 + self.half[i]) >> 18
        }))
    }
}

impl Colour {
    /// From 8-bit levels.
    #[must_use]
    pub const fn from_rgb8(rgb: [u8; 3], scale: &Scale) -> Self {
        Tint::new(rgb, scale).lit(1 << 15)
    }

    /// The three fields in one word: red in bits 31..21, blue in 20..11, green in 10..0.
    #[inline]
    #[must_use]
    pub const fn word(self) -> u32 {
        self.0
    }

    /// From [`word`](Colour::word).
    pub(crate) const fn from_word(word: u32) -> Self {
        Self(word)
    }

    /// From fields of red, green and blue.
    #[inline]
    const fn from_fields(f: [u32; 3]) -> Self {
        Self(f[0] << 21 | f[2] << 11 | f[1])
    }

    /// The fields of red, green and blue.
    #[inline]
    #[must_use]
    pub const fn fields(self) -> [u32; 3] {
        [self.0 >> 21, self.0 & 0x7FF, (self.0 >> 11) & 0x3FF]
    }

    /// Whole steps of red, green and blue.
    #[must_use]
    pub const fn steps(self, scale: &Scale) -> [u8; 3] {
        let f = self.fields();
        [
            (f[0] >> scale.fraction[0]) as u8,
            (f[1] >> scale.fraction[1]) as u8,
            (f[2] >> scale.fraction[2]) as u8,
        ]
    }

    /// 8-bit levels, rounded to nearest.
    #[must_use]
    pub fn to_rgb8(self, scale: &Scale) -> [u8; 3] {
        let fields = self.fields();
        [0, 1, 2].map(|i| {
            let field = fields[i].saturating_sub((1 << scale.fraction[i]) >> 1);
            ((field * 510 + scale.full[i]) / (2 * scale.full[i])).min(255) as u8
        })
    }

    /// The colour at `t` (0 to 2^30 for 0 to 1) on the way to `other`.
    #[must_use]
    pub fn lerp(self, other: Self, t: i64) -> Self {
        let (a, b) = (self.fields(), other.fields());
        Self::from_fields([0, 1, 2].map(|i| {
            let way = mul_wide(b[i] as i32 - a[i] as i32, t as i32);
            a[i].wrapping_add(((way + (1 << 29)) >> 30) as u32)
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_levels_round_to_the_nearest_step() {
        for steps in [[255, 255, 255], [31, 63, 31], [15, 15, 15], [1, 1, 1]] {
            let scale = Scale::new(steps);
            for level in 0..=255u8 {
                let got = Colour::from_rgb8([level; 3], &scale).steps(&scale);
                for i in 0..3 {
                    let exact = f64::from(level) * f64::from(steps[i]) / 255.0;
                    // 1/64 of a step off where two are equally near.
                    assert!(
                        (f64::from(got[i]) - exact).abs() <= 0.52,
                        "{level}: {got:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn levels_come_back() {
        for steps in [[255, 255, 255], [31, 63, 31]] {
            let scale = Scale::new(steps);
            for level in 0..=255u8 {
                assert_eq!(
                    Colour::from_rgb8([level; 3], &scale).to_rgb8(&scale),
                    [level; 3]
                );
            }
        }
    }

    #[test]
    fn light_and_lerp_reach_both_ends() {
        let scale = Scale::new([31, 63, 31]);
        let (a, b) = (
            Colour::from_rgb8([0; 3], &scale),
            Colour::from_rgb8([255; 3], &scale),
        );
        assert_eq!(a.steps(&scale), [0; 3]);
        assert_eq!(b.steps(&scale), [31, 63, 31]);
        assert_eq!(Tint::new([255; 3], &scale).lit(0), a);
        assert_eq!(a.lerp(b, 0), a);
        assert_eq!(a.lerp(b, 1 << 30), b);
        assert_eq!(a.lerp(b, 1 << 29).steps(&scale), [16, 32, 16]);
    }
}
