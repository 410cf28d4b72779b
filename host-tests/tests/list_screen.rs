//! Long vertices, points and bounds: against the rules that define them, and against the same calls
//! (H11, M4).

use crate::common::Rng;
use crate::listing::{
    Cloud, Faceted, HEIGHT, PLENTY, Room, Smooth, WIDTH, drawn, in_blocks, listed, some_format,
    some_instance, unrolled,
};
use host_tests::lists::writer::ListWriter;
use scanbeam::event::Notice;
use scanbeam::input::ListSettings;
use scanbeam::list::{Bounds, Halt, Header, Id, Material, Matrix, State};
use scanbeam::mesh::ScreenVertex;
use scanbeam::pipeline::{Instance, Pipeline, WordOf};
use scanbeam::{Affine, Cull, Faces, Mesh};

/// Vertices on and around the picture.
fn on_screen(rng: &mut Rng, count: usize) -> Vec<ScreenVertex> {
    (0..count)
        .map(|_| {
            let far = rng.pick(&[0, 0, 200, 30_000]);
            ScreenVertex {
                x: rng.within(-far, i32::from(WIDTH) * 8 + far) as i16,
                y: rng.within(-far, i32::from(HEIGHT) * 8 + far) as i16,
                depth: rng.below(1 << 16) << 15 | rng.below(1 << 15),
                colour: [0; 3].map(|_: u8| rng.below(256) as u8),
            }
        })
        .collect()
}

/// What a strip keeps at its vertices, and what its header says of that.
fn long_words(v: &ScreenVertex, header: Header) -> Vec<u32> {
    let [r, g, b] = v.colour;
    let mut words = vec![u32::from(v.x as u16) | u32::from(v.y as u16) << 16];
    words.extend(header.prsp.then_some(v.depth));
    words.extend(header.shade.then_some(u32::from_le_bytes([r, g, b, 9])));
    words.extend(header.text.then_some(0x1234_5678));
    words
}

fn long<P: Pipeline>(seeds: std::ops::Range<u64>)
where
    WordOf<P>: PartialEq + std::fmt::Debug,
{
    for seed in seeds {
        let mut rng = Rng::new(seed);
        let vertices = on_screen(&mut rng, 50);
        let colour = [10, 200, 90];
        let two_sided = rng.below(2) == 1;
        let (shade, prsp, text) = (rng.below(3) > 0, rng.below(3) > 0, rng.below(3) == 0);
        let mut memory = vec![0; 8192];
        let mut writer = ListWriter::new(&mut memory);
        let material = Material {
            diffuse: colour,
            two_sided,
            ..Material::default()
        };
        writer.state(&State::Material(material)).unwrap();
        let mut faces = Vec::new();
        for _ in 0..1 + rng.below(4) {
            let fan = rng.below(2) == 1;
            // Longer than the pieces that they are drawn in.
            let order: Vec<u16> = (0..rng.below(90)).map(|_| rng.below(50) as u16).collect();
            faces.extend(unrolled(&order, fan));
            in_blocks(&mut rng, &order, |part, new| {
                let header = Header {
                    shade,
                    prsp,
                    text,
                    new,
                    rm: fan,
                    ..Header::of(Id::Long, part.len() as u16)
                };
                let words: Vec<u32> = part
                    .iter()
                    .flat_map(|i| long_words(&vertices[usize::from(*i)], header))
                    .collect();
                writer.vertices(header, &words).unwrap();
            });
        }
        let want = drawn::<P>(|scene| {
            let plain: Vec<ScreenVertex> = vertices
                .iter()
                .map(|v| ScreenVertex {
                    depth: if prsp { v.depth } else { 1 << 31 },
                    colour: if shade { v.colour } else { colour },
                    ..*v
                })
                .collect();
            let cull = if two_sided { Cull::None } else { Cull::Back };
            scene
                .draw_screen(&plain, &faces, Default::default(), cull)
                .unwrap();
        });
        let got = listed::<P, i16>(writer.words(), Instance::default(), (4, 4));
        assert!(got == want, "seed {seed}");
    }
}

#[test]
fn long_vertices_are_triangles_on_the_screen() {
    long::<Smooth>(0..60);
    long::<Faceted>(100..130);
}

/// The pixels of a triangle by K4: the edges whose lines hold the pixel's centre, in whole numbers.
fn covers(p: [(i64, i64); 3], (x, y): (i64, i64)) -> bool {
    let (cx, cy) = (8 * x + 4, 8 * y + 4);
    let mut sides = Vec::new();
    for k in 0..3 {
        let (a, b) = (p[k], p[(k + 1) % 3]);
        let (top, bottom) = if a.1 < b.1 { (a, b) } else { (b, a) };
        if top.1 < cy && cy <= bottom.1 {
            // Where the edge is, less the centre, over the edge's height.
            let at = (top.0 - cx) * (bottom.1 - top.1) + (bottom.0 - top.0) * (cy - top.1);
            sides.push(at);
        }
    }
    // One side is left of the centre, the other at or right of it.
    sides.len() == 2 && sides.iter().any(|s| *s < 0) && sides.iter().any(|s| *s >= 0)
}

#[test]
fn a_triangle_on_the_screen_covers_what_the_rule_says() {
    let mut pixels = 0;
    for seed in 0..200 {
        let mut rng = Rng::new(seed);
        let vertices: Vec<ScreenVertex> = on_screen(&mut rng, 3)
            .into_iter()
            .map(|v| ScreenVertex {
                colour: [255; 3],
                // Those that guard space holds.
                x: v.x.clamp(-30_000, 30_000),
                y: v.y.clamp(-30_000, 30_000),
                ..v
            })
            .collect();
        let got = drawn::<Smooth>(|scene| {
            scene
                .draw_screen(&vertices, &[[0, 1, 2]], (), Cull::None)
                .unwrap();
        });
        let p = [0, 1, 2].map(|k: usize| (i64::from(vertices[k].x), i64::from(vertices[k].y)));
        for (y, line) in (0..).zip(&got) {
            for (x, pixel) in (0..).zip(line) {
                let is = *pixel == [255; 3];
                assert_eq!(is, covers(p, (x, y)), "seed {seed}, pixel {x}, {y}");
                pixels += u32::from(is);
            }
        }
    }
    assert!(pixels > 50_000, "{pixels}");
}

#[test]
fn bad_indices_and_full_arenas_are_said() {
    let vertices = on_screen(&mut Rng::new(1), 9);
    drawn::<Smooth>(|scene| {
        let done = scene.draw_screen(&vertices, &[[0, 1, 2], [3, 4, 9]], (), Cull::None);
        assert!(done.is_err());
        assert_eq!(scene.pass_one().objects, 0);
        // More faces than objects fit: the rest is drawn.
        let faces = vec![[0, 1, 2]; 70_000];
        let one = ScreenVertex {
            colour: [255; 3],
            ..ScreenVertex::default()
        };
        let three = [(0, 0), (400, 0), (0, 400)].map(|(x, y)| ScreenVertex { x, y, ..one });
        let done = scene.draw_screen(&three, &faces, (), Cull::None);
        assert!(done.is_err());
        let pass = scene.pass_one();
        assert_eq!(pass.objects + pass.dropped, 70_000);
    });
}

fn points<P: Pipeline>(seeds: std::ops::Range<u64>)
where
    WordOf<P>: PartialEq + std::fmt::Debug,
{
    for seed in seeds {
        let mut rng = Rng::new(seed);
        let (format, place, normal) = some_format(&mut rng);
        let cloud = Cloud::random(&mut rng, 60, place, normal);
        let instance = some_instance(&mut rng);
        let size = rng.pick(&[1, 1, 2, 3, 8, 255]);
        let mut memory = vec![0; 4096];
        let mut writer = ListWriter::new(&mut memory);
        writer.state(&State::Format(format)).unwrap();
        if size > 1 {
            writer.state(&State::PointSize(size)).unwrap();
        }
        let order: Vec<u16> = (0..60).collect();
        for part in order.chunks(1 + rng.below(60) as usize) {
            let header = Header {
                shade: true,
                ..Header::of(Id::Points, part.len() as u16)
            };
            let words = cloud.vertices(&format, header, part);
            writer.vertices(header, &words).unwrap();
        }
        let vertices = cloud.plain(true, &format);
        let want = drawn::<P>(|scene| {
            let mesh = Mesh {
                positions: vertices.positions,
                normals: vertices.normals,
                colours: vertices.colours,
                faces: Faces::Triangles(&[]),
            };
            scene
                .draw_points(&mesh, size, Default::default(), &instance)
                .unwrap();
        });
        for room in [(4, 4), (7, 9), (1000, 1000)] {
            let got = listed::<P, i16>(writer.words(), instance, room);
            assert!(got == want, "seed {seed}, room {room:?}");
        }
    }
}

#[test]
fn points_of_lists_are_those_of_calls() {
    points::<Smooth>(0..40);
    points::<Faceted>(100..130);
}

/// A point is the square of whole pixels around the place that `f64` projects it to, and the
/// nearest of two wins.
#[test]
fn points_are_squares_of_pixels_where_they_project_to() {
    let (eye, focal) = ([0.3, 0.5, 4.0f64], 90.0);
    let minus = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|i| a[i] - b[i]);
    let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
    let unit = |a: [f64; 3]| a.map(|c| c / dot(a, a).sqrt());
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [0, 1, 2].map(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
    };
    let ahead = unit(minus([0.0; 3], eye));
    let right = unit(cross(ahead, [0.0, 1.0, 0.0]));
    let up = cross(right, ahead);
    let (mut sure, mut shown) = (0, 0);
    for seed in 0..400 {
        let mut rng = Rng::new(seed);
        let size = 1 + rng.below(9) as u8;
        let point = [0; 3].map(|_: i16| rng.within(-16_384, 16_384) as i16);
        let p = minus(point.map(|c| f64::from(c) / 16_384.0), eye);
        let z = dot(p, ahead);
        let middle = [f64::from(WIDTH) / 2.0, f64::from(HEIGHT) / 2.0];
        let at = [
            middle[0] + focal * dot(p, right) / z,
            middle[1] - focal * dot(p, up) / z,
        ];
        // The first pixel of the square whose middle is nearest; not where it is a close call.
        let first = at.map(|c| c - f64::from(size - 1) / 2.0);
        if first.iter().any(|c| (c - c.round()).abs() < 0.13) {
            continue;
        }
        sure += 1;
        let first = first.map(|c| c.floor() as i64);
        let got = drawn::<Smooth>(|scene| {
            let mesh = Mesh {
                positions: &[point],
                normals: &[],
                colours: &[],
                faces: Faces::Triangles(&[]),
            };
            scene
                .draw_points(&mesh, size, (), &Instance::default())
                .unwrap();
        });
        for (y, line) in (0..).zip(&got) {
            for (x, pixel) in (0..).zip(line) {
                let within = |v: i64, k: usize| (first[k]..first[k] + i64::from(size)).contains(&v);
                let is = within(x, 0) && within(y, 1);
                assert_eq!(*pixel == [255; 3], is, "seed {seed}, size {size}, {x}, {y}");
                shown += u32::from(is);
            }
        }
    }
    assert!(sure > 150 && shown > 1000, "{sure} points, {shown} pixels");
    let pair = |depths: [f32; 2]| {
        drawn::<Smooth>(|scene| {
            for (far, colour) in depths.into_iter().zip([[255, 0, 0], [0, 255, 0]]) {
                let place = ahead.map(|c| c as f32 * far);
                let eye = eye.map(|c| c as f32);
                let instance = Instance {
                    model: Affine::placed(1.0, [0, 1, 2].map(|i| eye[i] + place[i])).unwrap(),
                    colour,
                    ..Instance::default()
                };
                let mesh = Mesh {
                    positions: &[[0i16; 3]],
                    normals: &[],
                    colours: &[],
                    faces: Faces::Triangles(&[]),
                };
                scene.draw_points(&mesh, 3, (), &instance).unwrap();
            }
        })
    };
    let count = |picture: &[Vec<[u8; 3]>], c| picture.iter().flatten().filter(|p| **p == c).count();
    assert_eq!(count(&pair([2.0, 3.0]), [255, 0, 0]), 9);
    assert_eq!(count(&pair([3.0, 2.0]), [0, 255, 0]), 9);
}

#[test]
fn what_bounds_pass_over_would_not_have_been_seen() {
    let (mut skipped, mut drawn_whole) = (0, 0);
    for seed in 0..300 {
        let mut rng = Rng::new(seed);
        let cloud = Cloud::random(
            &mut rng,
            30,
            scanbeam::list::FieldForm::S16x3,
            scanbeam::list::FieldForm::S16x3,
        );
        let instance = some_instance(&mut rng);
        let scale = rng.pick(&[0.05f32, 0.3, 1.0]);
        let far = rng.pick(&[1.0, 3.0, 8.0, 150.0]);
        let offset = [0; 3].map(|_: i32| (rng.signed() * far) as f32);
        let matrix = Affine::placed(scale, offset).unwrap();
        // Positions are within 1 each way.
        let radius = f64::from(scale) * 3f64.sqrt();
        let largest = offset.iter().fold(radius, |m, c| m.max(f64::from(c.abs())));
        let exponent = largest.log2().floor() as i32 + 2;
        let mantissa = |v: f64| v * 2f64.powi(30 - exponent);
        let bounds = |words| Bounds {
            centre: offset.map(|c| mantissa(f64::from(c)).round() as i32),
            radius: mantissa(radius).ceil() as i32 + 2,
            exponent: exponent as i16,
            words,
        };
        let list = |bounded: bool| {
            let mut memory = vec![0; 1024];
            let mut writer = ListWriter::new(&mut memory);
            if bounded {
                writer.state(&State::Bounds(bounds(0))).unwrap();
            }
            let from = writer.position();
            let matrix = Matrix::try_from(&matrix).unwrap();
            writer.state(&State::Matrix(matrix)).unwrap();
            let order: Vec<u16> = (0..30).collect();
            let header = Header {
                new: true,
                ..Header::of(Id::Short, 30)
            };
            let format = *writer.format();
            let words = cloud.vertices(&format, header, &order);
            writer.vertices(header, &words).unwrap();
            if bounded {
                let words = writer.position() - from;
                writer.rewrite(0, &State::Bounds(bounds(words))).unwrap();
            }
            writer.words().to_vec()
        };
        let want = listed::<Smooth, i16>(&list(false), instance, (64, 200));
        let bounded = list(true);
        let got = drawn::<Smooth>(|scene| {
            let mut room = Room::<i16>::new(64, 200);
            let mut runner = room.runner(ListSettings {
                instance,
                ..ListSettings::default()
            });
            runner.start(0);
            let halt = runner.run(
                &bounded[..],
                scene,
                &mut PLENTY.clone(),
                &mut |_: Notice| {},
            );
            assert_eq!(halt, Ok(Halt::End));
            let counts = runner.counts();
            if counts.skipped > 0 {
                assert_eq!((counts.skipped, counts.triangles), (1, 0));
                assert_eq!(counts.skipped_words as usize, bounded.len() - 7);
                skipped += 1;
            } else {
                assert_eq!(counts.triangles, 28);
                drawn_whole += 1;
            }
        });
        assert!(got == want, "seed {seed}");
    }
    assert!(skipped > 40 && drawn_whole > 40, "{skipped}, {drawn_whole}");
}
