//! Directions and normals in f64.

use super::camera;
use crate::common::Rng;
use scanbeam::Screen;
use scanbeam::light::{Lighting, PixelLamps};
use scanbeam::mesh::{Material, U1F15};

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

/// Light at pixels that leaves each colour as it is.
pub fn even_light() -> Option<&'static PixelLamps> {
    let full = [U1F15::from_bits(1 << 15); 3];
    let material = Material {
        ambient: full,
        ..Material::default()
    };
    let lighting = Lighting::new(&[], full, material).expect("no light");
    let screen = Screen::new(8, 8).expect("a screen");
    Some(Box::leak(Box::new(PixelLamps::new(
        &lighting,
        &camera(),
        screen,
    ))))
}
