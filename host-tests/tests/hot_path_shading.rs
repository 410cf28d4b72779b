//! K10: where the colours of faces come from, as values of the call: one a face, and several lights.
//!
//! The reference lights a normal in f64. What is drawn is a triangle around the picture's middle.

use crate::common::Rng;
use crate::hot::{LineRooms, SceneRooms, line};
use scanbeam::light::{DirectionalLight, Lighting};
use scanbeam::look::Gouraud;
use scanbeam::mesh::{Material, QuadSplit};
use scanbeam::pixel::Rgb888;
use scanbeam::scene::{Draw, Shading};
use scanbeam::{Affine, Camera, Cull, Faces, Light, Mesh, Screen};

type V3 = [f64; 3];

fn dot(a: V3, b: V3) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

fn unit(v: V3) -> V3 {
    v.map(|c| c / dot(v, v).sqrt())
}

/// The unit vector that stands on a face seen counter-clockwise.
fn normal(face: [V3; 3]) -> V3 {
    let d = |i: usize| [0, 1, 2].map(|k| face[i][k] - face[0][k]);
    let (a, b) = (d(1), d(2));
    unit([
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ])
}

fn some_direction(rng: &mut Rng) -> V3 {
    loop {
        let v = [rng.signed(), rng.signed(), rng.signed()];
        if dot(v, v) > 0.1 && dot(v, v) < 1.0 {
            return unit(v);
        }
    }
}

fn screen() -> Screen {
    Screen::new(40, 24).unwrap()
}

/// Looks at the origin from 3 away.
fn camera() -> Camera {
    Camera::look_at([0.0, 0.0, 3.0], [0.0; 3], [0.0, 1.0, 0.0], 30.0, 0.1, 50.0).unwrap()
}

/// Draws a mesh as a call that `dress` changes; the picture, and how many triangles were kept.
fn picture(
    mesh: Mesh<'_, i32>,
    slots: u16,
    dress: impl FnOnce(&mut Draw<'_, '_, i32>),
) -> (Vec<Vec<[u8; 3]>>, usize) {
    let mut rooms = SceneRooms::new(60, 40, 24, 1);
    let mut scene = rooms.scene::<Gouraud<Rgb888>>(screen());
    scene.begin(&camera()).expect("the rooms are large enough");
    let mut call = Draw::new(mesh);
    call.model = Affine::IDENTITY;
    call.cull = Cull::None;
    dress(&mut call);
    scene.draw(&call).expect("there is room");
    let mut rooms = LineRooms::fitting(&scene, slots, true);
    let mut renderer = rooms.renderer();
    let lines = scene.lines();
    let lines = lines.map(|y| line(&mut renderer, &scene, y, [0; 3]));
    (lines.collect(), scene.objects())
}

/// Corners around the middle, so that the picture's middle is inside.
fn around(rng: &mut Rng, reach: f64) -> [V3; 3] {
    let turn = rng.between(0.0, 6.0);
    [0.0, 2.1, 4.2].map(|at| {
        let (sin, cos) = (at + turn + rng.between(-0.3, 0.3)).sin_cos();
        let z = rng.between(-1.0, 1.0);
        [reach * cos, reach * sin, z]
    })
}

fn q30(p: V3) -> [i32; 3] {
    p.map(|c| (c * f64::from(1 << 30)) as i32)
}

/// One colour a face, that of its first vertex or of the call, lit by its own normal; as triangles and as quads.
#[test]
fn flat_faces_have_one_colour_lit_by_their_own_normal() {
    let mut rng = Rng::new(1_606);
    let (mut lit, mut covered) = (0, 0);
    for round in 0..600 {
        let reach = rng.pick(&[0.5, 1.0, 1.9]);
        let face = around(&mut rng, reach);
        let positions: Vec<_> = face.iter().map(|&p| q30(p)).collect();
        let colours: Vec<_> = (0..3)
            .map(|_| [(); 3].map(|()| rng.below(256) as u8))
            .collect();
        let has_colours = round % 3 > 0;
        // Normals of vertices do not matter.
        let normals = [[0, 16_384, 0]; 3];
        let (triangle, quad) = ([[0, 1, 2]], [[0, 1, 2, 2]]);
        let mesh = Mesh {
            positions: &positions,
            normals: if round % 2 == 0 { &normals } else { &[] },
            colours: if has_colours { &colours } else { &[] },
            faces: if round % 5 == 0 {
                Faces::Quads(&quad, QuadSplit::Corner0To2)
            } else {
                Faces::Triangles(&triangle)
            },
        };
        let towards = some_direction(&mut rng);
        let ambient = rng.unit();
        let light = Light::new(towards.map(|c| c as f32), ambient as f32);
        let is_lit = round % 7 > 0;
        let (lines, objects) = picture(mesh, rng.pick(&[0, 4]), |call| {
            call.shading = Shading::Flat;
            call.colour = [200, 90, 30];
            call.light = light.filter(|_| is_lit);
        });
        let level = if is_lit {
            ambient + (1.0 - ambient) * dot(normal(face), towards).max(0.0)
        } else {
            1.0
        };
        let colour = if has_colours {
            colours[0]
        } else {
            [200, 90, 30]
        };
        let want = colour.map(|c| f64::from(c) * level);
        assert!(objects > 0);
        let mut pixels = lines.iter().flatten();
        let first = lines[12][20];
        assert_ne!(first, [0; 3], "the middle is covered: {face:?}");
        for (got, want) in first.iter().zip(want) {
            // Half a level, half of the 1/4 level that a vertex's blue has, and 2^-12 for normal and light.
            assert!(
                (f64::from(*got) - want).abs() < 0.69,
                "{first:?} for {want}: {face:?}"
            );
        }
        assert!(pixels.all(|pixel| *pixel == [0; 3] || *pixel == first));
        lit += usize::from(is_lit && level > ambient);
        covered += lines
            .iter()
            .flatten()
            .filter(|pixel| **pixel == first)
            .count();
    }
    assert!(lit > 200 && covered > 50_000, "{lit} {covered}");
}

/// Several coloured lights and a material, per vertex: smooth by the normals of vertices, flat by that of the face.
#[test]
fn several_lights_add_up_at_each_vertex_and_at_each_face() {
    let mut rng = Rng::new(1_607);
    for round in 0..400 {
        let face = around(&mut rng, 1.9);
        let positions: Vec<_> = face.iter().map(|&p| q30(p)).collect();
        // The same at all vertices, so that all pixels have one colour.
        let given = some_direction(&mut rng);
        let normals = [given.map(|c| (c * 16_384.0).round() as i16); 3];
        let triangle = [[0, 1, 2]];
        let mesh = Mesh {
            positions: &positions,
            normals: &normals,
            colours: &[],
            faces: Faces::Triangles(&triangle),
        };
        let lamps: Vec<_> = (0..rng.below(4))
            .map(|_| (some_direction(&mut rng), [(); 3].map(|()| rng.unit())))
            .collect();
        // A call may outlive this round.
        let lights: &'static [_] = lamps
            .iter()
            .map(|&(towards, colour)| {
                let [towards, colour] = [towards, colour].map(|v| v.map(|c| c as f32));
                DirectionalLight::new(towards, colour).expect("a direction")
            })
            .collect::<Vec<_>>()
            .leak();
        let lighting = Lighting::new(lights, [Default::default(); 3], Material::default());
        let lighting: &'static _ = Box::leak(Box::new(lighting.expect("few lights")));
        let is_flat = round % 2 == 0;
        let (lines, _) = picture(mesh, 4, |call| {
            call.lights = Some(lighting);
            // In place of it.
            call.light = Light::new([0.0, 0.0, 1.0], 1.0);
            call.colour = [220, 180, 140];
            call.shading = if is_flat {
                Shading::Flat
            } else {
                Shading::Smooth
            };
        });
        let standing = if is_flat { normal(face) } else { given };
        for (i, whole) in [220.0, 180.0, 140.0].into_iter().enumerate() {
            let falls = lamps
                .iter()
                .map(|(towards, colour)| colour[i] * dot(standing, *towards).max(0.0));
            let want = (whole * falls.sum::<f64>()).min(255.0);
            let got = f64::from(lines[12][20][i]);
            assert!((got - want).abs() < 0.9, "{got} for {want}: {lamps:?}");
        }
    }
}
