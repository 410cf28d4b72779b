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
use super::transform::{Affine, unit_q30};
use crate::num::{I2F14, U1F15, inverse_root, leading_zeros, mul_16, mul_high, mul_high_unsigned};

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
        let eye = model.then(view).origin_in_model();
        // Twice as far as the eye or any vertex, so that their difference fits.
        let power = eye.exponent.max(1) + 1;
        LampsInModel {
            lamps: Lamps::new(self, |l| {
                unit_q30(model.transposed_times(l)).unwrap_or_default()
            }),
            eye: [0, 1, 2].map(|i| eye.scaled(i, 30 - power) as i32),
            power: power.min(31) as u32,
            lit: LampsInModel::lit,
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
    /// Whether there is any of the latter.
    is_mirrored: bool,
}

/// Lights times a material, in the space of the normals that they fall on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lamps {
    lamps: [Lamp; Lighting::MAX_LIGHTS],
    count: u8,
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
            let specular = times(&light.colour, &material.specular);
            *lamp = Lamp {
                towards: turn(light.direction),
                diffuse: times(&light.colour, &material.diffuse),
                specular,
                is_mirrored: specular != [0; 3],
            };
        }
        Self {
            lamps,
            count: lighting.lights.len() as u8,
            shininess: material.shininess,
            base: Shine {
                factor: times(&lighting.ambient, &material.ambient),
                more: material.emission.map(|c| u32::from(c.to_bits())),
            },
        }
    }

    /// Whether light only multiplies colours: nothing is mirrored, and nothing shines by itself.
    pub(super) fn is_matt(&self) -> bool {
        !self.lamps.iter().any(|lamp| lamp.is_mirrored) && self.base.more == [0; 3]
    }

    /// What falls on a surface with this normal, about unit length in Q1.14, seen by an eye that
    /// lies this way: any length, the largest component in 2^14 ..= 2^15, or all 0.
    #[inline]
    pub(super) fn shine(&self, normal: [i16; 3], eye: impl Fn() -> [i32; 3]) -> Shine {
        // Of a normal that is longer than 1 more than 1, which its square mends in what is mirrored.
        let cosine = |sum: i32| sum.min((1 << 29) - 1);
        self.falls(normal, 0, cosine, || Glance::new(normal, eye()))
    }

    /// The same of a normal of any length in 15 fraction bits or less; light that is mirrored as little as `dim` says
    /// is none.
    #[inline(always)]
    pub(super) fn shine_any(
        &self,
        normal: [i16; 3],
        dim: u32,
        eye: impl Fn() -> [i32; 3],
    ) -> Shine {
        let length = Length::of(normal);
        let glance = || Glance::of_length(normal, &length, eye());
        self.falls(normal, dim, |sum| length.divides(sum), glance)
    }

    /// `cosine` makes N.L in Q28, below 2, of a sum above 0 of products by 2^-16.
    #[inline(always)]
    fn falls(
        &self,
        normal: [i16; 3],
        dim: u32,
        cosine: impl Fn(i32) -> i32,
        glance: impl Fn() -> Glance,
    ) -> Shine {
        let mut shine = self.base;
        let mut seen = None;
        for lamp in self.lamps.iter().take(usize::from(self.count)) {
            let part = |i: usize| mul_16(lamp.towards[i], normal[i]);
            let sum = part(0) + part(1) + part(2);
            if sum <= 0 {
                continue;
            }
            let cosine = cosine(sum);
            let level = ((cosine.min((1 << 28) - 1) + (1 << 12)) >> 13) as u32;
            // 17 and 16 bits; the sum of 8 lights has 20.
            for i in 0..3 {
                shine.factor[i] += (lamp.diffuse[i] * level) >> 15;
            }
            // Asked of each: what is the same for all has the compiler write the loop out eight times.
            if !lamp.is_mirrored {
                continue;
            }
            let glance = seen.get_or_insert_with(&glance);
            let rest = glance.mirrored(cosine, lamp.towards);
            if glance.is_below(rest, dim) {
                continue;
            }
            let mirrored = glance.divides(rest);
            let level = ((power(mirrored, self.shininess) >> 16) + 1) >> 1;
            for i in 0..3 {
                shine.more[i] += (lamp.specular[i] * level) >> 15;
            }
        }
        shine
    }

    /// What R.V may be at most for light that is mirrored to round to none, in 1/256; its square in Q30.
    pub(super) fn dim(&self) -> u32 {
        // Some units more than it may be by rounding.
        let is_none = |part: u32| power((part << 24) + (1 << 20), self.shininess) >> 16 == 0;
        let more = |part, bit| part | if is_none(part | bit) { bit } else { 0 };
        let part = (0..8).rev().map(|i| 1 << i).fold(0, more);
        (part * part) << 14
    }
}

/// The length of a normal in units of 2^-15 or less: 1 / length = root 2^(half - 46).
struct Length {
    root: u32,
    half: u32,
}

impl Length {
    #[inline(always)]
    fn of(normal: [i16; 3]) -> Self {
        let (root, half) = inverse_root(square(normal.map(i32::from)));
        Self { root, half }
    }

    /// A Q28 cosine of a sum above 0 of products of the normal and a unit vector in Q1.30, by 2^-16.
    #[inline(always)]
    fn divides(&self, sum: i32) -> i32 {
        // Below 2^30 after the shift.
        mul_high_unsigned((sum as u32) << self.half, self.root) as i32
    }
}

/// The square of a vector of at most 15 bits each.
#[inline(always)]
fn square(v: [i32; 3]) -> u32 {
    v.iter().map(|c| (c * c) as u32).sum()
}

/// What all lights share where a surface is looked at.
struct Glance {
    /// The eye's vector with 15 fraction bits.
    eye: [i32; 3],
    /// N.V / |N|^2, of unit length N.V / |N|, with 14 fraction bits beyond those that the eye's vector came with.
    across: i32,
    /// |V|^2.
    square: u32,
}

impl Glance {
    /// A quarter of N.V.
    #[inline(always)]
    fn along(n: [i16; 3], eye: [i32; 3]) -> i32 {
        // A normal may be any number: two bits less, and the sum fits.
        let part = |i: usize| (i32::from(n[i]) * eye[i]) >> 2;
        part(0) + part(1) + part(2)
    }

    /// With a normal of about unit length in Q1.14.
    #[inline]
    fn new(n: [i16; 3], eye: [i32; 3]) -> Self {
        // 1 / |N|^2 in Q28, to the first order. Of no normal it is 2, which has no sign in 32 bits, but there the sum is 0.
        let mend = (2u32 << 28).saturating_sub(square(n.map(i32::from)));
        let across = mul_high(Self::along(n, eye), (mend << 2) as i32) << 4;
        Self::across(eye, across)
    }

    /// With a normal of any length.
    #[inline(always)]
    fn of_length(n: [i16; 3], length: &Length, eye: [i32; 3]) -> Self {
        let along = Self::along(n, eye) << length.half;
        Self::across(eye, mul_high(along, (length.root >> 1) as i32) << 3)
    }

    #[inline(always)]
    fn across(eye: [i32; 3], across: i32) -> Self {
        Self {
            eye: eye.map(|c| c << 15),
            across,
            square: square(eye),
        }
    }

    /// R.V with 13 fraction bits beyond those that the eye's vector came with, 0 where it is negative; of N.L in Q28,
    /// below 2.
    #[inline(always)]
    fn mirrored(&self, cosine: i32, towards: [i32; 3]) -> u32 {
        let forth = mul_high(cosine << 2, self.across) << 2;
        let part = |i: usize| mul_high(self.eye[i], towards[i]);
        // |V| is below 2^16, so R.V |V| is below 2^29 where the normal is unit length.
        (forth - (part(0) + part(1) + part(2))).max(0) as u32
    }

    /// Whether that is surely less than a part of |V|, whose square is in Q30: no root is needed.
    #[inline(always)]
    fn is_below(&self, rest: u32, part: u32) -> bool {
        mul_high_unsigned(rest << 2, rest << 2) < mul_high_unsigned(self.square, part)
    }

    /// That by |V|, as a 32-bit fraction.
    #[inline(always)]
    fn divides(&self, rest: u32) -> u32 {
        // 1 / |V| = root 2^(half - 46).
        let (root, half) = inverse_root(self.square);
        let cosine = mul_high_unsigned(rest << 2, root);
        let up = 3 + half;
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
#[derive(Clone, Copy, Debug)]
pub struct LampsInModel {
    lamps: Lamps,
    /// The eye in units of 2^(power - 30), below 2^30.
    eye: [i32; 3],
    /// At least 2.
    power: u32,
    /// A colour in these lights, with a normal at a place in Q1.30. Who makes no such lights has no code for it.
    pub(crate) lit: fn(&Self, &Tint, &Scale, [i16; 3], [i32; 3]) -> Colour,
}

impl LampsInModel {
    /// A colour in these lights, with a normal at a place in Q1.30.
    #[inline(never)]
    pub(crate) fn lit(
        &self,
        tint: &Tint,
        scale: &Scale,
        normal: [i16; 3],
        place: [i32; 3],
    ) -> Colour {
        let to_eye = || [0, 1, 2].map(|i| self.eye[i] - (place[i] >> self.power));
        let shine = self.lamps.shine(normal, || fifteen_bits(to_eye()));
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
pub(super) mod tests;
