//! Light at each pixel against the formulae in f64 on a sphere (K10).

use crate::common::solid::{V, cross, dot, octahedron, unit};
use crate::common::{Rng, SceneRooms, frame};
use scanbeam::light::{DirectionalLight, Lamplight, Lighting, PixelLamps};
use scanbeam::mesh::{Material, U1F15};
use scanbeam::pipeline::{Composited, GouraudDepth, Instance, PhongDepth, Pipeline, WordOf};
use scanbeam::pixel::{PixelFormat, Rgb565, Rgb888};
use scanbeam::{Affine, Camera, Cull, Faces, Mesh, Screen};

const SIDE: u16 = 121;
const FOCAL: f64 = 170.0;
const EYE: [f64; 3] = [0.4, 0.3, 3.0];

/// Corners and normals of a unit sphere in Q1.14, and its faces.
fn sphere(n: u32) -> (Vec<[i16; 3]>, Vec<[u16; 3]>) {
    let (points, faces) = octahedron(n);
    let q14 = |c: f64| (c * 16_384.0).round() as i16;
    (points.iter().map(|p| p.map(q14)).collect(), faces)
}

fn f32s(v: V) -> [f32; 3] {
    v.map(|c| c as f32)
}

fn camera() -> Camera {
    let up = [0.0, 1.0, 0.0];
    Camera::look_at(f32s(EYE), [0.0; 3], up, FOCAL as f32, 0.5, 9.0).unwrap()
}

fn screen() -> Screen {
    Screen::new(SIDE, SIDE).unwrap()
}

/// The ray through the centre of a pixel, from the eye.
fn ray(x: usize, y: usize) -> V {
    let ahead = unit(EYE.map(|c| -c));
    let right = unit(cross(ahead, [0.0, 1.0, 0.0]));
    let up = cross(right, ahead);
    let middle = f64::from(SIDE) / 2.0;
    let (dx, dy) = (x as f64 + 0.5 - middle, middle - y as f64 - 0.5);
    unit([0, 1, 2].map(|i| ahead[i] * FOCAL + right[i] * dx + up[i] * dy))
}

/// Where a ray from the eye meets the unit sphere.
fn met(way: V) -> Option<V> {
    let b = dot(EYE, way);
    let root = b * b - (dot(EYE, EYE) - 1.0);
    (root > 0.0).then(|| [0, 1, 2].map(|i| EYE[i] + way[i] * (-b - root.sqrt())))
}

fn real(level: [U1F15; 3]) -> V {
    level.map(|c| f64::from(c.to_bits()) / 32_768.0)
}

/// The light of a point with a normal, seen along `way`, in f64.
fn shade(
    (lights, ambient, material): (&[DirectionalLight], [U1F15; 3], &Material),
    colour: V,
    normal: V,
    way: V,
) -> V {
    let (ka, kd) = (real(material.ambient), real(material.diffuse));
    let (ks, ke) = (real(material.specular), real(material.emission));
    let la = real(ambient);
    let mut out = [0, 1, 2].map(|i| colour[i] * la[i] * ka[i] + ke[i]);
    for light in lights {
        let l = unit(light.direction.map(|c| f64::from(c.to_bits())));
        let lp = real(light.colour);
        let cosine = dot(normal, l);
        if cosine <= 0.0 {
            continue;
        }
        let r = [0, 1, 2].map(|i| 2.0 * cosine * normal[i] - l[i]);
        let mirrored = -dot(r, way);
        for i in 0..3 {
            out[i] += colour[i] * lp[i] * kd[i] * cosine;
            out[i] += lp[i] * ks[i] * mirrored.max(0.0).powi(material.shininess.into());
        }
    }
    out.map(|c| c.min(1.0))
}

fn picture<'l, P>(
    positions: &[[i16; 3]],
    faces: &[[u16; 3]],
    colour: [u8; 3],
    lamps: &'l [PixelLamps],
    slots: usize,
) -> Vec<Vec<WordOf<P>>>
where
    P: Pipeline<Lights = Lamplight<'l>>,
{
    let mut rooms = SceneRooms::<P>::new(40_000, 20_000, SIDE.into());
    let mut scene = rooms.scene(screen());
    scene.set_lights(Lamplight(lamps));
    scene.begin(&camera()).unwrap();
    let instance = Instance {
        // Turned and grown: normals have to follow.
        model: Affine::rotation_y(0.7)
            .then(&Affine::rotation_x(-0.4))
            .then(&Affine::placed(1.0, [0.0; 3]).unwrap()),
        cull: Cull::Back,
        light: None::<scanbeam::Light>,
        colour,
    };
    let mesh = Mesh {
        positions,
        normals: positions,
        colours: &[],
        faces: Faces::Triangles(faces),
    };
    scene.draw(&mesh, &instance).unwrap();
    frame(&scene, slots)
}

fn some_lights(rng: &mut Rng, count: usize) -> Vec<DirectionalLight> {
    (0..count)
        .map(|_| {
            let towards = [rng.signed(), rng.signed(), 0.3 + rng.signed().abs()];
            let colour = [0; 3].map(|_: u8| rng.signed().abs() as f32);
            DirectionalLight::new(f32s(towards), colour).unwrap()
        })
        .collect()
}

fn some_material(rng: &mut Rng, shininess: u16) -> Material {
    let mut levels = || [0; 3].map(|_: u8| U1F15::from_bits(rng.below(1 << 14) as u16));
    Material {
        diffuse: levels(),
        specular: levels(),
        emission: levels().map(|c| U1F15::from_bits(c.to_bits() >> 3)),
        shininess,
        ..Material::default()
    }
}

/// Normals of a fine sphere are those of the true one but for 12 bits and the triangles' own
/// error, so each pixel is the formula of the sphere.
#[test]
fn a_sphere_has_the_light_of_the_formulae() {
    let mut rng = Rng::new(19);
    let (positions, faces) = sphere(5);
    let (mut worst, mut sum, mut count) = (0.0f64, 0.0, 0);
    for round in 0..12 {
        let lights = some_lights(&mut rng, 1 + round % 4);
        let material = some_material(&mut rng, [1, 3, 10, 30, 64][round % 5]);
        let ambient = [U1F15::from_bits(rng.below(10_000) as u16); 3];
        let lighting = Lighting::new(&lights, ambient, material).unwrap();
        let lamps = [PixelLamps::new(&lighting, &camera(), screen())];
        let colour = [0; 3].map(|_: u8| 60 + rng.below(196) as u8);
        let drawn = picture::<PhongDepth<'_, Rgb888>>(&positions, &faces, colour, &lamps, 64);
        let base = colour.map(|c| f64::from(c) / 255.0);
        for (y, line) in drawn.iter().enumerate() {
            for (x, word) in line.iter().enumerate() {
                let way = ray(x, y);
                let Some(at) = met(way).filter(|at| -dot(*at, way) > 0.25) else {
                    // The rim, where the polygon is not the sphere.
                    continue;
                };
                let want = shade((&lights, ambient, &material), base, at, way);
                for i in 0..3 {
                    let off = (f64::from(word[i]) - 255.0 * want[i]).abs();
                    worst = worst.max(off);
                    sum += off;
                    count += 1;
                }
            }
        }
    }
    let mean = sum / f64::from(count);
    println!("{count} channels: at most {worst:.3} levels off, {mean:.3} in the mean");
    assert!(count > 200_000);
    // Ideal rounding is half a level, and one more is what may be added.
    assert!(worst <= 1.5, "{worst}");
}

/// Few large triangles: the light between the corners is that of the pixels, which light at the
/// corners alone does not have.
#[test]
fn a_highlight_between_corners_is_seen() {
    let (positions, faces) = sphere(1);
    let light = [DirectionalLight::new([0.3, 0.5, 1.0], [1.0; 3]).unwrap()];
    let lighting = Lighting::new(
        &light,
        [U1F15::from_bits(3000); 3],
        Material::shiny(0.8, 40),
    )
    .unwrap();
    let lamps = [PixelLamps::new(&lighting, &camera(), screen())];
    let colour = [90, 60, 30];
    let by_pixels = picture::<PhongDepth<'_, Rgb888>>(&positions, &faces, colour, &lamps, 64);
    let mut rooms = SceneRooms::<GouraudDepth<Rgb888>>::new(400, 400, SIDE.into());
    let mut scene = rooms.scene(screen());
    scene.begin(&camera()).unwrap();
    let mesh = Mesh {
        positions: &positions,
        normals: &positions,
        colours: &[],
        faces: Faces::Triangles(&faces),
    };
    let instance = Instance {
        model: Affine::rotation_y(0.7).then(&Affine::rotation_x(-0.4)),
        colour,
        ..Instance::default()
    }
    .lit_by(Some(lighting));
    scene.draw(&mesh, &instance).unwrap();
    let by_corners = frame(&scene, 64);
    let most = |picture: &[Vec<[u8; 3]>]| picture.iter().flatten().map(|w| w[0]).max();
    let (pixels, corners) = (most(&by_pixels).unwrap(), most(&by_corners).unwrap());
    println!("brightest: {pixels} by pixels, {corners} by corners");
    assert!(pixels > corners + 30, "{pixels} {corners}");
    // The same outline.
    let seen = |picture: &[Vec<[u8; 3]>]| -> Vec<bool> {
        picture.iter().flatten().map(|w| *w != [0; 3]).collect()
    };
    assert!(seen(&by_pixels) == seen(&by_corners));
}

#[test]
fn any_cache_and_format_give_the_same_light() {
    let (positions, faces) = sphere(3);
    let mut rng = Rng::new(3);
    let lights = some_lights(&mut rng, 3);
    let material = some_material(&mut rng, 20);
    let lighting = Lighting::new(&lights, [U1F15::from_bits(3000); 3], material).unwrap();
    let lamps = [PixelLamps::new(&lighting, &camera(), screen())];
    let colour = [200, 150, 100];
    type Small<'l> = PhongDepth<'l, Rgb565>;
    let whole = picture::<Small<'_>>(&positions, &faces, colour, &lamps, 300);
    for slots in [0, 2, 17] {
        assert!(picture::<Small<'_>>(&positions, &faces, colour, &lamps, slots) == whole);
    }
    // A finish that is opaque changes nothing.
    let finished = picture::<Composited<Small<'_>>>(&positions, &faces, colour, &lamps, 300);
    assert!(finished == whole);
    // 5 and 6 bits are within a step of 8.
    let fine = picture::<PhongDepth<'_, Rgb888>>(&positions, &faces, colour, &lamps, 300);
    for (a, b) in whole.iter().flatten().zip(fine.iter().flatten()) {
        let a = Rgb565::to_rgb8(*a);
        for i in 0..3 {
            assert!(
                a[i].abs_diff(b[i]) <= if i == 1 { 3 } else { 5 },
                "{a:?} {b:?}"
            );
        }
    }
}
