//! Several coloured lights on a surface that has a material: ambient, diffuse, specular (K10).
//!
//! ```text
//! colour (La Ka + sum of Lp Kd max(0, N.L)) + Ke + sum of Lp Ks max(0, R.V)^n where N.L > 0
//! ```
//!
//! `colour` is the vertex's own or the instance's, V goes from the vertex to the eye, and
//! `R = 2 (N.L) N - L`. Each channel is reckoned apart and stops at full level: nothing wraps (P4).
//! The lights and the eye are taken to model space once a draw call, so a vertex is not moved for
//! its light. Only V has to be made unit length at each vertex; that a normal of 16 bits is not
//! quite is mended to the first order by `1 / |N|^2 = 2 - |N|^2`, since a power of 255 would make
//! 2 per cent of 2^-14. The power is a chain of squares in 32-bit fractions, each one product.
//!
//! Measured against the formula in `f64` on normals as meshes have them (see the tests), the rounding of the
//! colour to 10 and 11 bits included: at most 0.26 levels of 255 with powers up to 64, 0.25 up to 255, 0.3 up to
//! 1000. Of eleven more samples of 600,000 with powers up to 255 (the same test with seeds 3 to 13) one vertex was
//! 0.71 off.
//!
//! One light without a material is [`Light`](super::Light).

use super::colour::{Colour, Scale, Tint};
use super::light::{direction, level_of};
use super::transform::Affine;
use crate::num::{
    Block, I2F14, U1F15, inverse_root, leading_zeros, mul_16, mul_high, mul_high_unsigned,
    shift_round,
};

/// A light from infinitely far, with a colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DirectionalLight {
    /// Unit vector towards the light, world space.
    pub direction: [I2F14; 3],
    /// Its level in red, green and blue; 1 is full, above it is a stronger light.
    pub colour: [U1F15; 3],
}

impl DirectionalLight {
    /// From a direction of any length towards the light, world space, and a colour, of which each
    /// channel is clamped to 0 ..< 2.
    ///
    /// `None` when the direction is zero or not finite.
    #[must_use]
    pub fn new(towards: [f32; 3], colour: [f32; 3]) -> Option<Self> {
        Some(Self {
            direction: direction(towards)?,
            colour: colour.map(level_of),
        })
    }
}

/// How a surface answers light: factors in red, green and blue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Material {
    /// Ka, of the light from everywhere; times the colour of the vertex.
    pub ambient: [U1F15; 3],
    /// Kd, of light that falls on the surface; times the colour of the vertex.
    pub diffuse: [U1F15; 3],
    /// Ks, of light that is mirrored.
    pub specular: [U1F15; 3],
    /// Ke, what the surface shines by itself.
    pub emission: [U1F15; 3],
    /// The power n of R.V: the larger, the smaller the highlight.
    pub shininess: u16,
}

impl Default for Material {
    /// Matt: Ka and Kd are 1, so that the vertex colours say it all; nothing is mirrored.
    fn default() -> Self {
        Self {
            ambient: [U1F15::ONE; 3],
            diffuse: [U1F15::ONE; 3],
            specular: [U1F15::ZERO; 3],
            emission: [U1F15::ZERO; 3],
            shininess: 1,
        }
    }
}

impl Material {
    /// Matt, with highlights of a level in white and a power.
    #[must_use]
    pub fn shiny(specular: f32, shininess: u16) -> Self {
        Self {
            specular: [level_of(specular); 3],
            shininess,
            ..Self::default()
        }
    }
}

/// Lights, and the material that they shine on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lighting<'a> {
    lights: &'a [DirectionalLight],
    ambient: [U1F15; 3],
    material: Material,
}

impl<'a> Lighting<'a> {
    /// How many lights there can be.
    pub const MAX_LIGHTS: usize = 8;

    /// Of these lights, this light from everywhere (La), and a surface of this material.
    ///
    /// `None` when there are more than [`MAX_LIGHTS`](Lighting::MAX_LIGHTS).
    #[must_use]
    pub const fn new(
        lights: &'a [DirectionalLight],
        ambient: [U1F15; 3],
        material: Material,
    ) -> Option<Self> {
        if lights.len() > Self::MAX_LIGHTS {
            return None;
        }
        Some(Self {
            lights,
            ambient,
            material,
        })
    }

    /// The same lights on another material.
    #[must_use]
    pub const fn on(self, material: Material) -> Self {
        Self { material, ..self }
    }

    /// In the space of a model, by the maps from there to the world and on to the camera.
    #[inline(never)]
    pub(crate) fn in_model(&self, model: &Affine, view: &Affine) -> LampsInModel {
        let eye: Block<3> = model.then(view).origin_in_model();
        // Twice as far as the eye or any vertex, so that their difference fits.
        let power = eye.exponent.max(1) + 1;
        LampsInModel {
            lamps: Lamps::new(self, |l| model.direction_to_model_q30(l)),
            eye: eye
                .mantissa
                .map(|c| shift_round(i64::from(c), eye.exponent - power) as i32),
            power: power.min(31) as u32,
        }
    }
}

/// What falls on a surface: factors of its colour, and what is added; 1 is 2^15.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shine {
    /// Times the colour.
    pub(super) factor: [u32; 3],
    /// And then added.
    pub(super) more: [u32; 3],
}

/// A light in some space, times the material.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
struct Lamp {
    /// Unit vector towards the light in Q1.30, or zero.
    towards: [i32; 3],
    /// Lp Kd and Lp Ks, 1 is 2^15; below 4.
    diffuse: [u32; 3],
    specular: [u32; 3],
}

/// Lights times a material, in the space of the normals that they fall on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lamps {
    lamps: [Lamp; Lighting::MAX_LIGHTS],
    count: u8,
    shiny: bool,
    shininess: u16,
    /// Where no light reaches.
    base: Shine,
}

impl Lamps {
    /// Of a lighting whose directions are turned into some space, Q1.30.
    pub(super) fn new(lighting: &Lighting<'_>, turn: impl Fn([I2F14; 3]) -> [i32; 3]) -> Self {
        let material = &lighting.material;
        let times = |a: &[U1F15; 3], b: &[U1F15; 3]| {
            [0, 1, 2]
                .map(|i| (u32::from(a[i].to_bits()) * u32::from(b[i].to_bits()) + (1 << 14)) >> 15)
        };
        let mut lamps = [Lamp::default(); Lighting::MAX_LIGHTS];
        for (lamp, light) in lamps.iter_mut().zip(lighting.lights) {
            *lamp = Lamp {
                towards: turn(light.direction),
                diffuse: times(&light.colour, &material.diffuse),
                specular: times(&light.colour, &material.specular),
            };
        }
        Self {
            lamps,
            count: lighting.lights.len() as u8,
            shiny: lamps.iter().any(|lamp| lamp.specular != [0; 3]),
            shininess: material.shininess,
            base: Shine {
                factor: times(&lighting.ambient, &material.ambient),
                more: material.emission.map(|c| u32::from(c.to_bits())),
            },
        }
    }

    /// Whether light only multiplies colours: nothing is mirrored, and nothing shines by itself.
    pub(super) fn is_matt(&self) -> bool {
        !self.shiny && self.base.more == [0; 3]
    }

    /// What falls on a surface with this normal, about unit length in Q1.14, seen by an eye that
    /// lies this way: any length, the largest component in 2^14 ..= 2^15, or all 0.
    #[inline]
    pub(super) fn shine(&self, normal: [i16; 3], eye: impl FnOnce() -> [i32; 3]) -> Shine {
        let glance = self
            .shiny
            .then(|| Glance::new(normal.map(i32::from), eye()));
        self.falls(normal, glance.as_ref())
    }

    /// The same of what [is matt](Self::is_matt).
    #[inline]
    pub(super) fn matt(&self, normal: [i16; 3]) -> Shine {
        self.falls(normal, None)
    }

    #[inline(always)]
    fn falls(&self, normal: [i16; 3], glance: Option<&Glance>) -> Shine {
        let mut shine = self.base;
        for lamp in self.lamps.iter().take(usize::from(self.count)) {
            // Q44 to Q28; of a normal that is longer than 1 more than 1, which its square mends in what is mirrored.
            let part = |i: usize| mul_16(lamp.towards[i], normal[i]);
            let cosine = (part(0) + part(1) + part(2)).min((1 << 29) - 1);
            if cosine <= 0 {
                continue;
            }
            let level = ((cosine.min((1 << 28) - 1) + (1 << 12)) >> 13) as u32;
            // 17 and 16 bits; the sum of 8 lights has 20.
            for i in 0..3 {
                shine.factor[i] += (lamp.diffuse[i] * level) >> 15;
            }
            let Some(glance) = glance else {
                continue;
            };
            let mirrored = glance.mirrored(cosine, lamp.towards);
            let level = ((power(mirrored, self.shininess) >> 16) + 1) >> 1;
            for i in 0..3 {
                shine.more[i] += (lamp.specular[i] * level) >> 15;
            }
        }
        shine
    }
}

/// What all lights share where a surface is looked at.
struct Glance {
    /// The eye's vector with 15 fraction bits.
    eye: [i32; 3],
    /// N.V / |N|^2, with 14 fraction bits beyond those that the eye's vector came with.
    across: i32,
    /// 1 / |V| = root 2^(half - 46).
    root: u32,
    half: u32,
}

impl Glance {
    #[inline]
    fn new(n: [i32; 3], eye: [i32; 3]) -> Self {
        // Each at most 2^30.
        let square = |v: [i32; 3]| v.iter().map(|c| (c * c) as u32).sum::<u32>();
        let (root, half) = inverse_root(square(eye));
        // 1 / |N|^2 in Q28, to the first order. Of no normal it is 2, which has no sign in 32 bits, but there the sum is 0.
        let mend = (2u32 << 28).saturating_sub(square(n));
        // A normal may be any number: two bits less, and the sum fits.
        let part = |i: usize| (n[i] * eye[i]) >> 2;
        let along = part(0) + part(1) + part(2);
        Self {
            eye: eye.map(|c| c << 15),
            across: mul_high(along, (mend << 2) as i32) << 4,
            root,
            half,
        }
    }

    /// R.V as a 32-bit fraction, 0 where it is negative; of N.L in Q28, below 2.
    #[inline]
    fn mirrored(&self, cosine: i32, towards: [i32; 3]) -> u32 {
        // Both with 13 fraction bits beyond those that the eye's vector came with.
        let forth = mul_high(cosine << 2, self.across) << 2;
        let part = |i: usize| mul_high(self.eye[i], towards[i]);
        // |V| is below 2^16, so R.V |V| is below 2^29 where the normal is unit length.
        let rest = (forth - (part(0) + part(1) + part(2))).max(0);
        let cosine = mul_high_unsigned((rest as u32) << 2, self.root);
        let up = 3 + self.half;
        if cosine >> (32 - up) != 0 {
            return u32::MAX;
        }
        cosine << up
    }
}

/// `base^exponent` of a 32-bit fraction; all ones is 1. Below the true value by at most
/// `3 exponent` units of 2^-32.
#[inline]
fn power(base: u32, exponent: u16) -> u32 {
    if base == u32::MAX {
        return base;
    }
    let (mut result, mut square, mut rest) = (u32::MAX, base, exponent);
    while rest != 0 {
        if rest & 1 == 1 {
            result = mul_high_unsigned(result, square);
        }
        square = mul_high_unsigned(square, square);
        rest >>= 1;
    }
    result
}

/// Lights times a material, and the eye, in model space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LampsInModel {
    lamps: Lamps,
    /// The eye in units of 2^(power - 30), below 2^30.
    eye: [i32; 3],
    /// At least 2.
    power: u32,
}

impl LampsInModel {
    /// The way from a place to the eye, its largest component in 2^14 ..= 2^15, or all 0.
    #[inline]
    fn towards_eye(&self, place: [i32; 3]) -> [i32; 3] {
        let d = [0, 1, 2].map(|i| self.eye[i] - (place[i] >> self.power));
        fifteen_bits(d)
    }

    /// A colour in these lights, with a normal at a place in Q1.30.
    #[inline(never)]
    pub(crate) fn lit(
        &self,
        tint: &Tint,
        scale: &Scale,
        normal: [i16; 3],
        place: [i32; 3],
    ) -> Colour {
        let shine = self.lamps.shine(normal, || self.towards_eye(place));
        tint.shone_on(&shine, scale)
    }
}

/// A vector with its largest component in 2^14 ..= 2^15, or all 0; each below 2^31 in magnitude.
#[inline]
pub(super) fn fifteen_bits(v: [i32; 3]) -> [i32; 3] {
    let bits = v.iter().fold(0, |bits, c| bits | c.unsigned_abs());
    let shift = leading_zeros(bits) as i32 - 17;
    if bits == 0 {
        return [0; 3];
    }
    if shift >= 0 {
        return v.map(|c| c << shift);
    }
    v.map(|c| ((c >> (-shift - 1)) + 1) >> 1)
}

#[cfg(test)]
mod tests;
