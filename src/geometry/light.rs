//! Light at a vertex: ambient and one infinite light, Lambert's law (K10).

use super::colour::{Colour, Tint};
use super::transform::{Affine, unit};
use crate::num::{Block, I2F14, U1F15};

/// An infinite light and the ambient level.
///
/// A lit colour is `colour (ambient + (1 - ambient) max(0, N.L))`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Light {
    /// Unit vector towards the light, world space.
    pub direction: [I2F14; 3],
    /// Level where the light does not reach, 0 to 1; above 1 counts as 1.
    pub ambient: U1F15,
}

impl Light {
    /// From a direction of any length towards the light, world space, and an ambient level,
    /// which is clamped to 0..=1.
    ///
    /// `None` when the direction is zero or not finite.
    #[must_use]
    pub fn new(direction: [f32; 3], ambient: f32) -> Option<Self> {
        Some(Self {
            direction: self::direction(direction)?,
            ambient: level_of(ambient).min(U1F15::ONE),
        })
    }

    /// The light level for a normal, both in the space of [`direction`](Light::direction); 0 to 1,
    /// whatever the lengths of the two and the ambient level are.
    #[must_use]
    pub fn level(&self, normal: [i16; 3]) -> U1F15 {
        let part = |i: usize| i64::from(normal[i]) * i64::from(self.direction[i].to_bits());
        // Beyond 1 all levels are alike.
        let dot = (part(0) + part(1) + part(2)).clamp(-1 << 28, 1 << 28) as i32;
        level(cosine(dot), self.ambient.min(U1F15::ONE))
    }

    /// The product of a normal with the direction where that is a unit vector, in Q15.
    #[inline(always)]
    fn cosine(&self, normal: [i16; 3]) -> i32 {
        let l = self.direction;
        let mut dot = 0i32;
        for i in 0..3 {
            dot += i32::from(normal[i]) * i32::from(l[i].to_bits());
        }
        cosine(dot)
    }

    /// In the space of a model, by the map from there to the world.
    #[inline(always)]
    pub(crate) fn in_model(&self, model: &Affine) -> Self {
        Self {
            direction: model.direction_to_model(self.direction),
            ambient: self.ambient.min(U1F15::ONE),
        }
    }

    /// A colour in this light, which is in the space of the normal: its direction is a unit vector, and its ambient level
    /// at most 1.
    #[inline(always)]
    pub(crate) fn lit(&self, tint: &Tint, normal: [i16; 3]) -> Colour {
        tint.lit(level(self.cosine(normal), self.ambient).to_bits())
    }

    /// The same as a word, where one that the light does not reach is known.
    #[inline(always)]
    pub(crate) fn lit_or(&self, dark: u32, tint: &Tint, normal: [i16; 3]) -> u32 {
        match self.cosine(normal) {
            ..=0 => dark,
            cosine => tint.lit(level(cosine, self.ambient).to_bits()).word(),
        }
    }
}

/// Q28 to Q15.
#[inline(always)]
fn cosine(dot: i32) -> i32 {
    (dot + (1 << 12)) >> 13
}

/// The level of a surface whose normal has this product with the light's direction, in Q15; the
/// ambient level is at most 1.
#[inline(always)]
fn level(cosine: i32, ambient: U1F15) -> U1F15 {
    if cosine <= 0 {
        return ambient;
    }
    // A normal a little longer than 1 must not lift the level above 1.
    let lambert = cosine.min(1 << 15) as u32;
    let ambient = u32::from(ambient.to_bits());
    let level = ambient + ((((1 << 15) - ambient) * lambert + (1 << 14)) >> 15);
    U1F15::from_bits(level as u16)
}

/// A direction of any length as a unit vector; `None` when it is zero or not finite.
pub(super) fn direction(v: [f32; 3]) -> Option<[I2F14; 3]> {
    Block::direction(v).map(|v| unit(v.map(i64::from)))
}

/// 0 to 1.99 to nearest; what is below 0, or no number, is 0.
pub(super) fn level_of(value: f32) -> U1F15 {
    const MOST: u32 = 1.99f32.to_bits();
    let bits = value.to_bits();
    // What has a sign has larger bits, and so has what is no number.
    if bits > f32::INFINITY.to_bits() {
        return U1F15::ZERO;
    }
    let bits = bits.min(MOST);
    let twice = (bits & 0x7F_FFFF | 0x80_0000) << 1 >> (135 - (bits >> 23)).min(31);
    U1F15::from_bits(((twice + 1) >> 1) as u16)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_follow_lambert() {
        let light = Light::new([0.0, 3.0, 4.0], 0.25).unwrap();
        let level = |n| light.level(n).to_num::<f64>();
        assert!((level([0, 0, 16_384]) - (0.25 + 0.75 * 0.8)).abs() < 1e-4);
        assert_eq!(level([0, 0, -16_384]), 0.25);
        assert!((level([0, 9_830, 13_107]) - 1.0).abs() < 1e-4);
        assert!(level([32_767; 3]) <= 1.0);
        let _ = level([-32_768; 3]);
        assert_eq!(Light::new([0.0; 3], 0.0), None);
        assert_eq!(Light::new([f32::NAN, 1.0, 0.0], 0.0), None);
        let tiny = Light::new([1e-30, 0.0, 0.0], 2.0).unwrap();
        assert_eq!(tiny.direction[0], I2F14::ONE);
        assert_eq!(tiny.ambient, U1F15::ONE);
    }

    /// Fields are public: whatever they hold, a level stays within 0 and 1, and that of a unit
    /// vector is the one that vertices get.
    #[test]
    fn levels_stay_within_1_whatever_the_fields_hold() {
        for bits in [0, 1, 0x7FFF, 0x8000, 0x8001, 0xFFFF] {
            let ambient = U1F15::from_bits(bits);
            let wide = Light {
                direction: [I2F14::MIN; 3],
                ambient,
            };
            assert_eq!(wide.level([i16::MIN; 3]), U1F15::ONE);
            assert_eq!(wide.level([i16::MAX; 3]), ambient.min(U1F15::ONE));
            let unit = Light::new([0.6, 0.0, 0.8], 0.0).unwrap();
            let light = Light { ambient, ..unit };
            let model = light.in_model(&Affine::IDENTITY);
            for normal in [
                [0, 0, 16_384],
                [0, 0, -16_384],
                [8_192, 0, 0],
                [i16::MIN; 3],
            ] {
                assert_eq!(
                    level(model.cosine(normal), model.ambient),
                    light.level(normal)
                );
                assert!(light.level(normal) <= U1F15::ONE);
                assert!(light.level(normal) >= ambient.min(U1F15::ONE));
            }
        }
    }
}
