//! Numbers, maps and cameras of any bytes.

use arbitrary::{Result, Unstructured};
use scanbeam::{Affine, Camera, CameraError};

/// Any float: plain ones most of the time, any bits now and then.
pub fn float(u: &mut Unstructured<'_>) -> Result<f32> {
    Ok(match u.int_in_range(0..=15u8)? {
        15 => f32::from_bits(u.arbitrary()?),
        14 => {
            let power = f32::from(u.arbitrary::<i8>()?);
            if u.arbitrary()? {
                power.exp2()
            } else {
                -power.exp2()
            }
        }
        12 | 13 => f32::from(u.arbitrary::<i16>()?) / 256.0,
        _ => f32::from(u.arbitrary::<i8>()?) / 64.0,
    })
}

pub fn vector(u: &mut Unstructured<'_>) -> Result<[f32; 3]> {
    Ok([float(u)?, float(u)?, float(u)?])
}

/// A chain of maps of every kind; what is refused is left out.
pub fn affine(u: &mut Unstructured<'_>) -> Result<Affine> {
    let mut map = Affine::IDENTITY;
    for _ in 0..u.int_in_range(0..=4u8)? {
        let next = match u.int_in_range(0..=5u8)? {
            0 => Affine::from_rows([vector(u)?, vector(u)?, vector(u)?], vector(u)?),
            1 => Affine::placed(float(u)?, vector(u)?),
            2 => Some(Affine::rotation_x(float(u)?)),
            3 => Some(Affine::rotation_y(float(u)?)),
            4 => Some(Affine::rotation_z(float(u)?)),
            _ => map.orthonormalised(),
        };
        map = map.then(&next.unwrap_or(Affine::IDENTITY));
    }
    Ok(map)
}

/// Mostly one that sees the origin.
pub fn camera(u: &mut Unstructured<'_>) -> Result<std::result::Result<Camera, CameraError>> {
    if u.ratio(1, 4)? {
        let (eye, at, up) = (vector(u)?, vector(u)?, vector(u)?);
        let (focal, near, range) = (float(u)?.abs(), float(u)?.abs(), float(u)?.abs());
        return Ok(Camera::look_at(eye, at, up, focal, near, near + range));
    }
    let [x, y, z] = vector(u)?;
    let near = f32::from(u.int_in_range(0..=20i8)? - 10).exp2();
    Ok(Camera::look_at(
        [x, y, z + 2.0],
        [x / 4.0, y / 4.0, 0.0],
        [0.0, 1.0, 0.0],
        f32::from(u.arbitrary::<u8>()?) + 20.0,
        near,
        near * (1.0 + f32::from(u.arbitrary::<u16>()?)) + 4.0,
    ))
}
