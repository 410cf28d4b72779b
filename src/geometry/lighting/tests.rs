//! Lit colours against the formula in `f64`, in the world's space and from numbers that were not
//! rounded.

use super::*;
use crate::num::random::Rng;
use core::slice;
use fixed::types::I2F30;
use std::vec::Vec;

impl Rng {
    fn about(&mut self, reach: f64) -> f64 {
        (2.0 * self.unit() - 1.0) * reach
    }

    fn direction(&mut self) -> [f64; 3] {
        loop {
            let v = [(); 3].map(|()| self.about(1.0));
            let length = times(v, v).sqrt();
            if (0.1..1.0).contains(&length) {
                return v.map(|c| c / length);
            }
        }
    }
}

pub(in crate::geometry) fn times(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(in crate::geometry) fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = times(v, v).sqrt();
    v.map(|c| c / length)
}

/// Everything as it is meant: world space, levels from 0 to 1.
struct Truth {
    lights: Vec<([f64; 3], [f64; 3])>,
    ambient: [f64; 3],
    ka: [f64; 3],
    kd: [f64; 3],
    ks: [f64; 3],
    ke: [f64; 3],
    power: u16,
}

impl Truth {
    fn random(rng: &mut Rng, lights: usize, power: u16) -> Self {
        let mut colour = |most: f64| [(); 3].map(|()| rng.unit() * most);
        let (ambient, ka, kd, ks, ke) = (
            colour(0.4),
            colour(1.0),
            colour(1.0),
            colour(1.0),
            colour(0.1),
        );
        let each = |_| (rng.direction(), [(); 3].map(|()| rng.unit() * 1.2));
        Self {
            lights: (0..lights).map(each).collect(),
            ambient,
            ka,
            kd,
            ks,
            ke,
            power,
        }
    }

    /// Levels from 0 to 255.
    fn colour(&self, colour: [u8; 3], n: [f64; 3], place: [f64; 3], eye: [f64; 3]) -> [f64; 3] {
        let v = unit([0, 1, 2].map(|i| eye[i] - place[i]));
        [0, 1, 2].map(|i| {
            let mut factor = self.ambient[i] * self.ka[i];
            let mut more = self.ke[i];
            for (l, colour) in &self.lights {
                let cosine = times(n, *l);
                if cosine > 0.0 {
                    factor += colour[i] * self.kd[i] * cosine;
                    let r = [0, 1, 2].map(|k| 2.0 * cosine * n[k] - l[k]);
                    let mirrored = times(r, v).max(0.0);
                    more += colour[i] * self.ks[i] * mirrored.powi(i32::from(self.power));
                }
            }
            (f64::from(colour[i]) * factor + 255.0 * more).min(255.0)
        })
    }

    fn lights(&self) -> Vec<DirectionalLight> {
        let f = |v: [f64; 3]| v.map(|c| c as f32);
        let light = |(l, c): &(_, _)| DirectionalLight::new(f(*l), f(*c));
        self.lights.iter().filter_map(light).collect()
    }

    fn material(&self) -> Material {
        let of = |c: [f64; 3]| c.map(|c| level_of(c as f32));
        Material {
            ambient: of(self.ka),
            diffuse: of(self.kd),
            specular: of(self.ks),
            emission: of(self.ke),
            shininess: self.power,
        }
    }
}

/// The largest difference from `f64`, in levels, of vertices in random places, and their number.
fn worst(powers: &[u16], rounds: u32, seed: u64) -> (f64, u32) {
    let mut rng = Rng(seed);
    let scale = Scale::new([255; 3]);
    let (mut worst, mut seen) = (0.0f64, 0);
    for round in 0..rounds {
        let power = powers[round as usize % powers.len()];
        let truth = Truth::random(&mut rng, 1 + round as usize % 8, power);
        let lights = truth.lights();
        let ambient = truth.ambient.map(|c| level_of(c as f32));
        let lighting = Lighting::new(&lights, ambient, truth.material()).unwrap();
        // A turn about two axes, with its rows in f64 as the map has them.
        let (a, b) = (rng.about(3.0), rng.about(3.0));
        let turn = Affine::rotation_y(a as f32).then(&Affine::rotation_x(b as f32));
        let size = (rng.about(6.0)).exp2();
        let at = [(); 3].map(|()| rng.about(3.0) as f32);
        let model = turn.then(&Affine::placed(size as f32, at).unwrap());
        let entry = |m: &Affine, i: usize| {
            f64::from(m.linear.mantissa[i]) * f64::from(m.linear.exponent - 30).exp2()
        };
        let turned =
            |v: [f64; 3]| [0, 1, 2].map(|i| times([0, 1, 2].map(|k| entry(&turn, 3 * i + k)), v));
        let eye = [(); 3].map(|()| (rng.about(9.0) * (1.0 + size)) as f32);
        let camera =
            super::super::Camera::look_at(eye, [0.1, 0.2, 0.3], [0.1, 1.0, 0.2], 100.0, 0.2, 1e4);
        let Ok(camera) = camera else { continue };
        let in_model = lighting.in_model(&model, &camera.view);
        for _ in 0..200 {
            // Half of the normals are near where the first light is mirrored to the eye.
            let p = [(); 3].map(|()| rng.about(1.5));
            let moved = turned(p);
            let place = [0, 1, 2].map(|i| moved[i] * f64::from(size as f32) + f64::from(at[i]));
            let eye = eye.map(f64::from);
            let v = unit([0, 1, 2].map(|i| eye[i] - place[i]));
            let l = truth.lights[0].0;
            let spread = rng.unit();
            let off = rng.direction();
            let world = if rng.unit() < 0.5 {
                rng.direction()
            } else {
                unit([0, 1, 2].map(|i| l[i] + v[i] + spread * off[i]))
            };
            // Back to the model: the transpose of the turn.
            let n = [0, 1, 2].map(|k| times([0, 1, 2].map(|i| entry(&turn, 3 * i + k)), world));
            // The normal that the mesh has, of 16 bits: what rounding does to it is no error of the light.
            let normal = n.map(|c| (c * 16_384.0).round() as i16);
            let world = unit(turned(normal.map(f64::from)));
            // Where a light begins to reach, what is mirrored may jump from 0 to a low power.
            if truth
                .lights
                .iter()
                .any(|(l, _)| times(world, *l).abs() < 2e-4)
            {
                continue;
            }
            let colour = [(); 3].map(|()| (rng.unit() * 255.99) as u8);
            let exact = truth.colour(colour, world, place, eye);
            let place = p.map(|c| I2F30::from_num(c).to_bits());
            let got = in_model.lit(&Tint::new(colour, &scale), &scale, normal, place);
            let fields = got.fields();
            for i in 0..3 {
                let bits = scale.fraction()[i];
                let got = f64::from(fields[i]) / f64::from(1u32 << bits) - 0.5;
                worst = worst.max((got - exact[i]).abs());
            }
            seen += 1;
        }
    }
    (worst, seen)
}

/// Bounds are what no one of 40 seeds was beyond: 0.207, 0.270 and 0.386 levels.
#[test]
fn random_vertices_lights_and_materials_are_as_in_f64() {
    for (powers, bound) in [
        (&[0, 1, 2, 5, 10, 20, 40, 64][..], 0.21),
        (&[100, 128, 200, 255], 0.28),
        (&[300, 500, 800, 1000], 0.39),
    ] {
        let (mut most, mut count) = (0f64, 0);
        for seed in 1..=4 {
            let (off, more) = worst(powers, 1_000, seed);
            most = most.max(off);
            count += more;
        }
        std::println!("powers {powers:?}: {most:.3} levels of {count}");
        assert!(count > 700_000 && most <= bound, "{most} of {count}");
    }
}

/// A normal of 16 bits may be longer than 1; what it mirrors of a light that it points at is that of its direction.
///
/// Kills: N.L that is cut off at 1, a square of the normal that is not mended.
#[test]
fn normals_longer_than_one_mirror_what_their_direction_does() {
    let mut rng = Rng(11);
    let lamp = Lamp {
        specular: [1 << 15; 3],
        is_mirrored: true,
        ..Lamp::default()
    };
    let (mut worst, mut longer) = (0f64, 0);
    for _ in 0..50_000 {
        let (l, off) = (rng.direction(), rng.direction());
        let v = unit([0, 1, 2].map(|i| l[i] + 0.05 * off[i]));
        let normal = l.map(|c| (c * 16_384.0).round() as i16);
        let wide = normal.map(f64::from);
        longer += u32::from(times(wide, wide) > f64::from(1 << 28));
        let n = unit(wide);
        let largest = v.iter().fold(0f64, |most, c| most.max(c.abs()));
        let lamps = Lamps {
            lamps: [Lamp {
                towards: l.map(|c| (c * f64::from(1 << 30)) as i32),
                ..lamp
            }; 8],
            count: 1,
            shininess: 1000,
            base: Shine {
                factor: [0; 3],
                more: [0; 3],
            },
        };
        let eye = v.map(|c| (c / largest * 32_768.0).round() as i32);
        let shine = lamps.shine(normal, || eye);
        let across = 2.0 * times(n, l);
        let mirrored = times([0, 1, 2].map(|i| across * n[i] - l[i]), v).max(0.0);
        let exact = mirrored.powi(1000) * 255.0;
        worst = worst.max((f64::from(shine.more[0]) / 32_768.0 * 255.0 - exact).abs());
    }
    std::println!("{worst:.3} levels, {longer} longer than 1");
    assert!(longer > 10_000 && worst <= 0.15, "{worst} of {longer}");
}

#[test]
fn a_power_is_a_power() {
    let mut rng = Rng(9);
    for i in 0..200_000u32 {
        let base = if i < 1000 {
            u32::MAX - i
        } else {
            (rng.unit() * 4294967296.0) as u32
        };
        let exponent = (rng.unit() * 1001.0) as u16;
        let exact = (f64::from(base) / 4294967295.0).powi(i32::from(exponent)) * 4294967295.0;
        let error = f64::from(power(base, exponent)) - exact;
        let bound = 3.0 * f64::from(exponent) + 1.0;
        assert!(
            (-bound..=bound).contains(&error),
            "{base} {exponent}: {error}"
        );
    }
    assert_eq!(power(u32::MAX, 1000), u32::MAX);
    assert_eq!(power(0, 0), u32::MAX);
    assert_eq!(power(0, 7), 0);
}

/// Kills: a bound that is a step too high, and one that is far too low.
#[test]
fn light_that_is_too_dim_to_be_mirrored_is_none() {
    for shininess in (0..=1000).chain([4_000, u16::MAX]) {
        let material = Material::shiny(1.0, shininess);
        let light = DirectionalLight::new([0.0, 0.0, 1.0], [1.0; 3]).unwrap();
        let lighting = Lighting::new(slice::from_ref(&light), [U1F15::ZERO; 3], material).unwrap();
        let dim = Lamps::new(&lighting, |_| [0, 0, 1 << 30]).dim();
        let part = (dim >> 14).isqrt();
        assert_eq!((part * part) << 14, dim);
        let level = |base: u32| ((power(base, shininess) >> 16) + 1) >> 1;
        assert!(
            part == 0 || level((part << 24) + (1 << 10)) == 0,
            "{shininess}"
        );
        let above = (part + 2).min(255) << 24;
        assert!(part >= 254 || level(above) > 0, "{shininess}");
    }
}

/// Whatever numbers come in, nothing overflows, and channels stop at full level (P4).
#[test]
fn no_colour_wraps() {
    let mut rng = Rng(4);
    let scale = Scale::new([31, 63, 31]);
    let full = [U1F15::from_bits(u16::MAX); 3];
    for round in 0..3_000 {
        let light = |rng: &mut Rng| DirectionalLight {
            direction: [(); 3].map(|()| I2F14::from_bits(rng.about(32_767.99) as i16)),
            colour: full,
        };
        let lights = [(); 8].map(|()| light(&mut rng));
        let material = Material {
            ambient: full,
            diffuse: full,
            specular: full,
            emission: if round % 2 == 0 {
                full
            } else {
                [U1F15::ZERO; 3]
            },
            shininess: (rng.unit() * 65_535.0) as u16,
        };
        let lighting = Lighting::new(&lights, full, material).unwrap();
        let reach = rng.about(80.0).exp2() as f32;
        let model = Affine::from_rows(
            [(); 3].map(|()| [(); 3].map(|()| rng.about(1.0) as f32 * reach)),
            [(); 3].map(|()| rng.about(1e20) as f32),
        )
        .unwrap();
        let in_model = lighting.in_model(&model, &Affine::rotation_y(1.0));
        for _ in 0..50 {
            let normal = [(); 3].map(|()| rng.about(32_768.99) as i16);
            let place = [(); 3].map(|()| rng.about(2147483647.0) as i32);
            let tint = Tint::new([255; 3], &scale);
            let got = in_model.lit(&tint, &scale, normal, place);
            assert!((0..3).all(|i| got.steps(&scale)[i] <= [31, 63, 31][i]));
            if round % 2 == 0 {
                assert_eq!(got.steps(&scale), [31, 63, 31]);
            }
        }
    }
    assert_eq!(
        Lighting::new(&[], full, Material::default()).map(|l| l.lights),
        Some(&[][..])
    );
    let light = DirectionalLight::new([0.0, 0.0, 1.0], [1.0; 3]).unwrap();
    assert_eq!(Lighting::new(&[light; 9], full, Material::default()), None);
}

/// One white light on a matt surface gives what [`Light`] gives, within one unit of a field.
#[test]
fn a_single_matt_light_is_lamberts() {
    let mut rng = Rng(5);
    let scale = Scale::new([255; 3]);
    let mut worst = 0;
    for _ in 0..2_000 {
        let (towards, ambient) = (rng.direction().map(|c| c as f32), rng.unit() as f32);
        let one = super::super::Light::new(towards, ambient).unwrap();
        let lights = [DirectionalLight::new(towards, [1.0 - ambient; 3]).unwrap()];
        let lighting = Lighting::new(&lights, [level_of(ambient); 3], Material::default()).unwrap();
        let model = Affine::rotation_y(rng.about(3.0) as f32);
        let many = lighting.in_model(&model, &Affine::IDENTITY);
        let one = one.in_model(&model);
        for _ in 0..50 {
            let normal = rng.direction().map(|c| (c * 16_384.0).round() as i16);
            let tint = Tint::new([(); 3].map(|()| (rng.unit() * 255.99) as u8), &scale);
            let a = one.lit(&tint, normal).fields();
            let b = many.lit(&tint, &scale, normal, [0; 3]).fields();
            for i in 0..3 {
                worst = worst.max(a[i].abs_diff(b[i]));
            }
        }
    }
    assert!(worst <= 1, "{worst}");
}

/// Kills: a light that grazes a surface counts as one behind it.
#[test]
fn a_light_that_grazes_a_surface_shines_in_it() {
    let shines = |sine: i32| {
        let mut lamps = [Lamp::default(); Lighting::MAX_LIGHTS];
        lamps[0] = Lamp {
            towards: [sine, 1 << 30, 0],
            diffuse: [1 << 15; 3],
            specular: [1 << 15; 3],
            is_mirrored: true,
        };
        let base = Shine {
            factor: [0; 3],
            more: [0; 3],
        };
        let lamps = Lamps {
            lamps,
            count: 1,
            shininess: 1,
            base,
        };
        lamps.shine([1 << 14, 0, 0], || [0, -1 << 15, 0]).more[0]
    };
    // A cosine has 28 fraction bits.
    assert_eq!([-1, 0].map(shines), [0; 2]);
    assert!((32_000..=1 << 15).contains(&shines(4)), "{}", shines(4));
}

/// Kills: vectors of one unit that are none.
#[test]
fn any_vector_fills_fifteen_bits() {
    assert_eq!(fifteen_bits([1, 0, -1]), [1 << 14, 0, -1 << 14]);
    assert_eq!(fifteen_bits([0, i32::MAX, 1]), [0, 1 << 15, 0]);
    assert_eq!(fifteen_bits([0; 3]), [0; 3]);
}
