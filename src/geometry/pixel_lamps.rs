//! What shines on pixels: lights and a material as a camera sees them (K10).
//!
//! Normals come in any length, with 15 fraction bits, as planes give them: one root divides what they are multiplied
//! with. The way to the eye has 15 bits too, a step across the picture from pixel to pixel.
//!
//! Measured against the formula in `f64` on normals of 0.7 to 1 times their length at corners (see the tests): at most
//! 0.14 levels of 255 with powers up to 64, 0.23 up to 255, 0.52 up to 1000; shorter ones have fewer bits.

use super::camera::{Camera, Screen};
use super::colour::{Scale, Tint};
use super::lighting::{Lamps, Lighting, Shine};
use super::transform::{Affine, unit};
use crate::num::{I2F14, leading_zeros, mul_high_unsigned};

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
    /// What is mirrored less than this is none, as [`Lamps::dim`] says.
    dim: u32,
    /// From the first pixel across and down to the eye with 15 fraction bits and one half, where no component is beyond
    /// 2^15 in the picture; a pixel, and the focal length ahead.
    first: [i32; 2],
    pixel: i32,
    ahead: i16,
}

/// One half of what has 15 fraction bits.
const HALF: i32 = 1 << 14;

/// With 15 fraction bits less.
#[inline(always)]
fn cut(wide: i32) -> i16 {
    // Outside of the picture there may be more, where lights of a smaller one are used.
    (wide >> 15).clamp(i16::MIN.into(), i16::MAX.into()) as i16
}

impl PixelLamps {
    /// As `camera` sees them on a picture of the size of `screen`: to be made anew when the camera
    /// turns.
    #[must_use]
    pub fn new(lighting: &Lighting<'_>, camera: &Camera, screen: Screen) -> Self {
        // In 1/8 pixels, below 2^23; here with 5 fraction bits.
        let focal = camera.focal.scaled(0, 5).clamp(1, 1 << 29) as i32;
        let sides = [screen.width(), screen.height()].map(i32::from);
        let first = [0, 1].map(|i| (4 * sides[i] - 4 - camera.shift[i]) << 5);
        let reach = |i: usize| {
            let last = first[i] - 256 * (sides[i] - 1);
            first[i].unsigned_abs().max(last.unsigned_abs())
        };
        let most = reach(0).max(reach(1)).max(focal as u32);
        let up = leading_zeros(most).saturating_sub(2);
        let lamps = Lamps::new(lighting, |l| camera.view.direction_from_model_q30(l));
        Self {
            dim: lamps.dim(),
            lamps,
            first: first.map(|c| (c << up) + HALF),
            pixel: 256 << up,
            ahead: cut((-focal << up) + HALF),
        }
    }

    /// The word of a colour on a surface with this normal, of any length as for [`lit`](Self::lit), if it is the same
    /// from wherever that is seen, and may be multiplied with texels afterwards: nothing is added to it, and it does
    /// not stop at full level.
    pub(crate) fn matt(&self, normal: [i16; 3], colour: [u8; 3], scale: &Scale) -> Option<u32> {
        if !self.lamps.is_matt() {
            return None;
        }
        let shine = self.lamps.shine_any(normal, 0, || [0; 3]);
        let stops = |i: usize| u32::from(colour[i]) * shine.factor[i] > 255 << 15;
        if stops(0) || stops(1) || stops(2) {
            return None;
        }
        Some(Tint::new(colour, scale).times(shine.factor).word())
    }

    /// Colours of a pixel of the picture in this light, of a normal of any length: channels of 16 bits, of formats with
    /// so many steps, as its own colour is; none above the full step.
    #[inline(always)]
    pub(crate) fn lit(
        &self,
        normal: [i16; 3],
        [column, line]: [u32; 2],
        own: [u32; 3],
        steps: [u16; 3],
    ) -> [u32; 3] {
        let to_eye = || {
            let from = |first: i32, at: u32| {
                cut(first.wrapping_sub(self.pixel.wrapping_mul(at as i32))).into()
            };
            let [x, y] = self.first;
            [from(x, column), from(y, line), self.ahead.into()]
        };
        let shine = self.lamps.shine_any(normal, self.dim, to_eye);
        let Shine { factor, more } = shine;
        let long = (factor[0] | factor[1] | factor[2]) >> 15;
        if long | more[0] | more[1] | more[2] == 0 {
            return [0, 1, 2].map(|i| (own[i] * factor[i]) >> 15);
        }
        let bright = |i: usize| {
            let (steps, below) = (u32::from(steps[i]), steps[i].leading_zeros());
            // 24 and 29 bits.
            let part = mul_high_unsigned(own[i] << 8, factor[i] << 9);
            (part + ((more[i] * steps) >> (15 - below))).min(steps << below)
        };
        // Not mapped: in a program with several formats that would be called.
        [bright(0), bright(1), bright(2)]
    }
}

#[cfg(test)]
mod tests {
    use super::super::lighting::tests::{times, unit};
    use super::*;
    use crate::geometry::DirectionalLight;
    use crate::mesh::{Material, U1F15};
    use crate::num::random::Rng;
    use std::vec::Vec;

    type V3 = [f64; 3];

    fn direction(rng: &mut Rng) -> V3 {
        loop {
            let v = [(); 3].map(|()| f64::from(rng.signed()));
            if (0.1..1.0).contains(&times(v, v).sqrt()) {
                return unit(v);
            }
        }
    }

    /// Lights, a material of full diffuse and mirrored light, and who sees them, in f64 and as the crate has them.
    struct Seen {
        lights: Vec<V3>,
        levels: Vec<f64>,
        power: u16,
        /// The middle of the picture and the focal length in 1/8 pixels.
        centre: [f64; 2],
        focal: f64,
        lamps: PixelLamps,
    }

    impl Seen {
        fn new(rng: &mut Rng, count: usize, power: u16, size: [u16; 2], focal: f32) -> Self {
            let screen = Screen::new(size[0], size[1]).unwrap();
            let camera = Camera::look_at(
                [0.0, 1.0, 5.0],
                [0.3, 0.2, 0.1],
                [0.0, 1.0, 0.0],
                focal,
                0.2,
                1e4,
            )
            .unwrap();
            let lights: Vec<_> = (0..count)
                .map(|_| {
                    let towards = direction(rng).map(|c| c as f32);
                    let level = (0.2 + 0.8 * rng.unit() / count as f64) as f32;
                    DirectionalLight::new(towards, [level; 3]).unwrap()
                })
                .collect();
            let material = Material {
                specular: [U1F15::ONE; 3],
                shininess: power,
                ..Material::default()
            };
            let lighting = Lighting::new(&lights, [U1F15::ZERO; 3], material).unwrap();
            let turned = |l: &DirectionalLight| {
                let q30 = camera.view.direction_from_model_q30(l.direction);
                unit(q30.map(f64::from))
            };
            let focal =
                f64::from(camera.focal.mantissa[0]) * f64::from(camera.focal.exponent - 30).exp2();
            Self {
                lights: lights.iter().map(turned).collect(),
                levels: lights
                    .iter()
                    .map(|l| f64::from(l.colour[0].to_bits()) / 32_768.0)
                    .collect(),
                power,
                centre: [0, 1].map(|i| f64::from(screen.centre()[i] - camera.shift[i])),
                focal,
                lamps: PixelLamps::new(&lighting, &camera, screen),
            }
        }

        fn eye(&self, screen: Screen, at: [u32; 2]) -> V3 {
            let from =
                |centre: f64, first: i32, at: u32| centre - f64::from(8 * (first + at as i32) + 4);
            let x = from(self.centre[0], screen.left(), at[0]);
            let y = from(self.centre[1], screen.top(), at[1]);
            unit([x, y, -self.focal])
        }

        /// Of 255.
        fn level(&self, own: f64, normal: V3, eye: V3) -> f64 {
            let mut sum = 0.0;
            for (l, level) in self.lights.iter().zip(&self.levels) {
                let cosine = times(normal, *l);
                if cosine > 0.0 {
                    let mirrored = [0, 1, 2].map(|k| 2.0 * cosine * normal[k] - l[k]);
                    let shine = times(mirrored, eye).max(0.0).powi(i32::from(self.power));
                    sum += level * (own * cosine + shine);
                }
            }
            255.0 * sum.min(1.0)
        }
    }

    /// The largest difference from f64 in levels of 255, of normals of such lengths and formats with so many steps.
    fn worst(seed: u64, powers: &[u16], lengths: [f64; 2], steps: [u16; 3]) -> f64 {
        let mut rng = Rng(seed);
        let mut worst = 0f64;
        for round in 0..600usize {
            let power = powers[round % powers.len()];
            let size = [16 + rng.below(500) as u16, 16 + rng.below(400) as u16];
            let screen = Screen::new(size[0], size[1]).unwrap();
            let focal = (f64::from(size[0]) * (2.0 * f64::from(rng.signed())).exp2()) as f32;
            let seen = Seen::new(&mut rng, 1 + round % 8, power, size, focal);
            for i in 0..300 {
                let at = size.map(|side| rng.below(side.into()));
                let eye = seen.eye(screen, at);
                // Half of them are near where a light is mirrored to the eye.
                let to = if i % 2 == 0 {
                    let (l, off, part) = (seen.lights[0], direction(&mut rng), rng.unit());
                    unit([0, 1, 2].map(|k| l[k] + eye[k] + part * off[k]))
                } else {
                    direction(&mut rng)
                };
                let length = lengths[0] + (lengths[1] - lengths[0]) * rng.unit();
                let wide = to.map(|c| (c * length * 1_048_576_000.0).round() as i32);
                let normal = unit(wide.map(f64::from));
                if seen.lights.iter().any(|l| times(*l, normal).abs() < 5e-4) {
                    continue;
                }
                let own = (rng.unit() * 255.99) as u32;
                let exact = seen.level(f64::from(own) / 255.0, normal, eye);
                let got = lit_of(&seen.lamps, wide, at, own, steps);
                for (got, steps) in got.into_iter().zip(steps) {
                    worst = worst.max((got / f64::from(steps) * 255.0 - exact).abs());
                }
            }
        }
        worst
    }

    /// Steps of a pixel before they are cut.
    fn lit_of(lamps: &PixelLamps, wide: [i32; 3], at: [u32; 2], own: u32, steps: [u16; 3]) -> V3 {
        let own = steps.map(|s| (((own * u32::from(s)) << s.leading_zeros()) + 127) / 255);
        let got = lamps.lit(wide.map(|c| ((c + (1 << 14)) >> 15) as i16), at, own, steps);
        [0, 1, 2].map(|i| f64::from(got[i]) / f64::from(1 << steps[i].leading_zeros()))
    }

    /// Bounds are what no one of 40 seeds was beyond: 0.135, 0.222, 0.404, 0.432 and 1.045 levels; of 40 with directions
    /// of another sequence the third was 0.515. A short normal has fewer bits; what it came from has fewer still.
    ///
    /// Kills: a root that is halved once too often, a way to the eye that is cut off, a light whose mirror is given up
    /// too early.
    #[test]
    fn pixels_are_lit_as_in_f64() {
        for (powers, lengths, bound) in [
            (&[0u16, 1, 2, 5, 10, 20, 40, 64][..], [0.7, 1.0], 0.14),
            (&[100, 128, 200, 255], [0.7, 1.0], 0.23),
            (&[300, 500, 800, 1000], [0.7, 1.0], 0.41),
            (&[0, 1, 2, 5, 10, 20, 40, 64], [0.05, 0.7], 0.44),
            (&[100, 128, 200, 255], [0.05, 0.7], 1.05),
        ] {
            for steps in [[255; 3], [31, 63, 31]] {
                let off = (1..=2)
                    .map(|seed| worst(seed, powers, lengths, steps))
                    .fold(0f64, f64::max);
                std::println!("powers {powers:?}, lengths {lengths:?}: {off:.3}");
                assert!((bound / 4.0..=bound).contains(&off), "{off} of {bound}");
            }
        }
    }

    /// Lights of a picture of another size, and normals of any bits, give some colour.
    #[test]
    fn no_pixel_is_brighter_than_full() {
        let mut rng = Rng(5);
        for round in 0..400 {
            let seen = Seen::new(&mut rng, 1 + round % 8, 1 + round as u16, [40, 30], 30.0);
            for _ in 0..100 {
                let normal = [(); 3].map(|()| rng.bits() as i16);
                let at = [rng.bits(), rng.bits()];
                let own = [(); 3].map(|()| rng.below(65_281));
                let got = seen.lamps.lit(normal, at, own, [255; 3]);
                assert!(got.iter().all(|&c| c <= 255 << 8), "{got:?}");
            }
        }
    }
}
