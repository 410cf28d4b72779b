//! What a list says, in the types of this room (H11).

use super::bounds::Sphere;
use super::camera::{Camera, CameraError};
use super::light::Light;
use super::lighting::DirectionalLight;
use super::meshlet::Meshlet;
use super::transform::Affine;
use crate::list::{Bounds, CameraWords, Cone, LightWords, Matrix};
use crate::num::{Block, I2F14, U1F15};

impl From<&Matrix> for Affine {
    fn from(m: &Matrix) -> Self {
        // Normalised again, whatever the list has: mantissas and exponents are within limits.
        let linear = m.linear.map(i64::from);
        let offset = m.offset.map(i64::from);
        Self {
            linear: Block::new(linear, i32::from(m.linear_exponent)),
            offset: Block::new(offset, i32::from(m.offset_exponent)),
        }
    }
}

impl From<&Bounds> for Sphere {
    /// In units of the bounds: 2^-30, times two to the power of their exponent plus one.
    fn from(bounds: &Bounds) -> Self {
        Self {
            centre: bounds.centre,
            radius: bounds.radius.unsigned_abs(),
        }
    }
}

impl From<&Cone> for Meshlet {
    /// What tells from where it is seen from behind.
    fn from(cone: &Cone) -> Self {
        Self {
            apex: cone.apex,
            axis: cone.axis,
            spread: cone.spread,
            ..Self::EMPTY
        }
    }
}

impl Affine {
    /// From the units of bounds to the list's world.
    pub(crate) fn scale_of(bounds: &Bounds) -> Self {
        Self::from(&Matrix {
            linear_exponent: bounds.exponent + 1,
            ..Matrix::IDENTITY
        })
    }
}

/// The map's numbers are beyond what a list can say: 2^96.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MatrixRange;

impl TryFrom<&Affine> for Matrix {
    type Error = MatrixRange;

    /// Exact, but for parts below 2^-128, which become 0.
    fn try_from(a: &Affine) -> Result<Self, MatrixRange> {
        let (linear, linear_exponent) = listed(&a.linear)?;
        let (offset, offset_exponent) = listed(&a.offset)?;
        Ok(Self {
            linear,
            linear_exponent,
            offset,
            offset_exponent,
        })
    }
}

/// Mantissas and their exponent, as a list has them.
fn listed<const N: usize>(block: &Block<N>) -> Result<([i32; N], i16), MatrixRange> {
    match block.exponent {
        97.. => Err(MatrixRange),
        -128.. => Ok((block.mantissa, block.exponent as i16)),
        _ => Ok(([0; N], -128)),
    }
}

impl From<LightWords> for Light {
    fn from(l: LightWords) -> Self {
        Self {
            direction: l.direction.map(I2F14::from_bits),
            ambient: U1F15::from_bits(l.ambient),
        }
    }
}

impl From<Light> for LightWords {
    fn from(l: Light) -> Self {
        Self {
            direction: l.direction.map(I2F14::to_bits),
            ambient: l.ambient.to_bits(),
            colour: [255; 3],
        }
    }
}

impl From<LightWords> for DirectionalLight {
    /// What of it falls: `1 - ambient` of its colour.
    fn from(l: LightWords) -> Self {
        let falls = (1 << 15) - u32::from(l.ambient.min(1 << 15));
        let level = |c: u8| U1F15::from_bits(((u32::from(c) * falls + 127) / 255) as u16);
        Self {
            direction: l.direction.map(I2F14::from_bits),
            colour: l.colour.map(level),
        }
    }
}

impl Camera {
    /// The camera of a list, for a picture of so many lines.
    ///
    /// # Errors
    /// As [`look_at`](Camera::look_at).
    pub fn listed(c: &CameraWords, lines: u16) -> Result<Self, CameraError> {
        let focal = c.focal * (f32::from(lines) / 240.0);
        Self::look_at(c.eye, c.at, c.up, focal, c.near, c.far)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Kills: a focal length that does not grow with the picture.
    #[test]
    fn a_focal_length_is_of_240_lines() {
        let words = CameraWords {
            eye: [0.0, 1.0, 4.0],
            at: [0.0; 3],
            up: [0.0, 1.0, 0.0],
            focal: 300.0,
            near: 0.5,
            far: 50.0,
        };
        for (lines, focal) in [(120, 150.0), (240, 300.0), (480, 600.0)] {
            let CameraWords { near, far, .. } = words;
            let listed = Camera::listed(&words, lines).unwrap();
            let want = Camera::look_at(words.eye, words.at, words.up, focal, near, far).unwrap();
            assert_eq!(std::format!("{listed:?}"), std::format!("{want:?}"));
        }
    }

    #[test]
    fn maps_and_lights_come_back() {
        for k in 0..40 {
            let turn = Affine::rotation_y(0.3 * k as f32).then(&Affine::rotation_x(k as f32));
            let place = Affine::placed(1e-9 * 7f32.powi(k), [1e3, -2.5, 0.0]).unwrap();
            let map = turn.then(&place);
            let matrix = Matrix::try_from(&map).unwrap();
            assert_eq!(Affine::from(&matrix), map);
        }
        let identity = Matrix::try_from(&Affine::IDENTITY);
        assert_eq!(identity, Ok(Matrix::IDENTITY));
        let huge = Affine::placed(1e28, [0.0; 3]).unwrap();
        let huge = huge.then(&huge);
        assert_eq!(Matrix::try_from(&huge), Err(MatrixRange));
        // Kills: parts that a list has no exponent for, and are as large as 2^-128 then.
        let tiny = Affine::placed(1e-30, [1e-30, 0.0, 0.0]).unwrap();
        let matrix = Matrix::try_from(&tiny.then(&tiny).then(&tiny)).unwrap();
        assert_eq!((matrix.linear, matrix.linear_exponent), ([0; 9], -128));
        let near = Affine::placed(1.0, [1e-40, 0.0, 0.0]).unwrap();
        let matrix = Matrix::try_from(&near).unwrap();
        assert_eq!((matrix.offset, matrix.offset_exponent), ([0; 3], -128));
        assert_eq!(matrix.linear, Matrix::IDENTITY.linear);
        let light = Light::new([0.3, -0.4, 2.0], 0.25).unwrap();
        assert_eq!(Light::from(LightWords::from(light)), light);
    }
}
