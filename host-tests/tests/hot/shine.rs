//! Directions and normals in f64.

use crate::common::Rng;

pub type V3 = [f64; 3];

pub fn dot(a: V3, b: V3) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

pub fn unit(v: V3) -> V3 {
    v.map(|c| c / dot(v, v).sqrt())
}

/// Of unit length.
pub fn some_direction(rng: &mut Rng) -> V3 {
    loop {
        let v = [(); 3].map(|()| rng.signed());
        if dot(v, v) > 0.1 && dot(v, v) < 1.0 {
            return unit(v);
        }
    }
}

/// As meshes have normals.
pub fn q14(v: V3) -> [i16; 3] {
    v.map(|c| (c * 16_384.0).round() as i16)
}
