//! What shines on pixels: lights and a material as a camera sees them, and normals of unit length (K10).

use super::camera::{Camera, Screen};
use super::colour::{Scale, Tint};
use super::lighting::{Lamps, Lighting, fifteen_bits};
use super::transform::{Affine, unit};
use crate::num::{Block, I2F14, inverse_root, mul_high, mul_high_unsigned, rounded, shift_round};

/// A normal of any length as about unit length in Q1.14; no component reaches 2^31.
#[inline(always)]
pub(crate) fn unit_normal(wide: [i32; 3]) -> [i16; 3] {
    let v = fifteen_bits(wide);
    let square = v.iter().map(|c| (c * c) as u32).sum();
    let (root, half) = inverse_root(square);
    // Q14 of v times root 2^(half - 46).
    v.map(|c| rounded(mul_high(c << 15, (root >> 1) as i32), 14 - half as i32) as i16)
}

impl Affine {
    /// The normal of a surface that is moved by this, about unit length in Q1.14.
    pub(crate) fn unit_normal(&self, normal: [i16; 3]) -> [i16; 3] {
        unit(self.turned(normal.map(I2F14::from_bits))).map(I2F14::to_bits)
    }
}

/// Lights and a material, as a camera sees them: what shines on pixels.
#[derive(Clone, Copy, Debug)]
pub struct PixelLamps {
    lamps: Lamps,
    /// The middle of the picture, 1/8 pixels of guard space.
    centre: [i32; 2],
    /// The focal length in 1/256 pixel.
    focal: i32,
    /// The picture's first column and line in guard space.
    first: [i32; 2],
}

impl PixelLamps {
    /// As `camera` sees them on a picture of the size of `screen`: to be made anew when the camera
    /// turns.
    #[must_use]
    pub fn new(lighting: &Lighting<'_>, camera: &Camera, screen: Screen) -> Self {
        let focal: Block<1> = camera.focal;
        let [focal] = focal.mantissa.map(|f| {
            // In 1/8 pixels, below 2^23.
            shift_round(i64::from(f), focal.exponent - 30 + 5)
        });
        Self {
            lamps: Lamps::new(lighting, |l| camera.view.direction_from_model_q30(l)),
            centre: [0, 1].map(|i| screen.centre()[i] - camera.shift[i]),
            focal: focal.clamp(1, 1 << 29) as i32,
            first: [screen.left(), screen.top()],
        }
    }

    /// The word of a colour on a surface with this normal, of any length, if it is the same from wherever that is seen,
    /// and may be multiplied with texels afterwards: nothing is added to it, and it does not stop at full level.
    pub(crate) fn matt(&self, normal: [i32; 3], colour: [u8; 3], scale: &Scale) -> Option<u32> {
        if !self.lamps.is_matt() {
            return None;
        }
        let shine = self.lamps.matt(unit_normal(normal));
        let stops = |i: usize| u32::from(colour[i]) * shine.factor[i] > 255 << 15;
        if stops(0) || stops(1) || stops(2) {
            return None;
        }
        Some(Tint::new(colour, scale).times(shine.factor).word())
    }

    /// Colours of a pixel of the picture in this light: 16.16 steps plus one half, of formats with
    /// so many steps a channel; none above the full step.
    #[inline]
    #[must_use]
    pub(crate) fn lit(
        &self,
        normal: [i16; 3],
        [column, line]: [u32; 2],
        colour: [i32; 3],
        steps: [u16; 3],
    ) -> [i32; 3] {
        let [left, top] = self.first;
        let (column, line) = (left + column as i32, top + line as i32);
        let to_eye = || {
            let from = |at: i32, centre: i32| (centre - (8 * at + 4)) << 5;
            let [x, y] = self.centre;
            fifteen_bits([from(column, x), from(line, y), -self.focal])
        };
        let shine = self.lamps.shine(normal, to_eye);
        [0, 1, 2].map(|i| {
            let full = u32::from(steps[i]) << 16;
            let own = (colour[i] - HALF).max(0) as u32;
            // 24 and 20 bits; a bit more than is kept.
            let part = |own: u32, factor: u32| mul_high_unsigned(own << 8, factor << 10);
            let sum = part(own, shine.factor[i]) + part(full, shine.more[i]);
            ((sum + 1) >> 1).min(full) as i32 + HALF
        })
    }
}

/// Half a step, which colours in planes carry for rounding.
const HALF: i32 = 1 << 15;

#[cfg(test)]
mod tests {
    use super::unit_normal;
    use crate::num::random::Rng;

    /// Kills: a root that is halved once too often, and components that are not rounded.
    #[test]
    fn normals_of_any_length_become_units() {
        let mut rng = Rng(12);
        let mut worst = 0f64;
        for i in 0..200_000 {
            let wide = [(); 3].map(|()| rng.bits() as i32 >> (1 + i % 30));
            let length = wide
                .iter()
                .map(|&c| f64::from(c).powi(2))
                .sum::<f64>()
                .sqrt();
            if length == 0.0 {
                assert_eq!(unit_normal(wide), [0; 3]);
                continue;
            }
            for (got, c) in unit_normal(wide).into_iter().zip(wide) {
                worst = worst.max((f64::from(got) - f64::from(c) / length * 16384.0).abs());
            }
        }
        std::println!("{worst} of 2^-14");
        assert!((0.5..1.0).contains(&worst), "{worst}");
    }
}
