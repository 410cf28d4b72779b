//! Lists draw what the same calls draw, in any memory, in every form of vertices (H11, H16, K2, K15).

use crate::common::Rng;
use crate::listing::{
    Cloud, Faceted, Smooth, drawn, in_blocks, listed, some_format, some_instance, unrolled,
};
use host_tests::lists::writer::{Form, ListWriter};
use scanbeam::list::{FieldForm, Flow, Header, Id, SPLIT, State, VertexFormat};
use scanbeam::mesh::{QuadSplit, Vertices};
use scanbeam::pipeline::{Pipeline, WordOf};
use scanbeam::{Faces, Mesh};

fn strips_and_fans<P: Pipeline>(seeds: std::ops::Range<u64>)
where
    WordOf<P>: PartialEq + std::fmt::Debug,
{
    for seed in seeds {
        let mut rng = Rng::new(seed);
        let (format, place, normal) = some_format(&mut rng);
        let cloud = Cloud::random(&mut rng, 40, place, normal);
        let instance = some_instance(&mut rng);
        let shade = rng.below(4) > 0;
        let mut memory = vec![0; 4096];
        let mut writer = ListWriter::new(&mut memory);
        writer.state(&State::Format(format)).unwrap();
        let mut faces = Vec::new();
        for _ in 0..1 + rng.below(6) {
            let fan = rng.below(2) == 1;
            let order: Vec<u16> = (0..rng.below(20)).map(|_| rng.below(40) as u16).collect();
            faces.extend(unrolled(&order, fan));
            in_blocks(&mut rng, &order, |part, new| {
                let header = Header {
                    shade,
                    new,
                    rm: fan,
                    ..Header::of(Id::Short, part.len() as u16)
                };
                let words = cloud.vertices(&format, header, part);
                writer.vertices(header, &words).unwrap();
            });
        }
        if rng.below(2) == 0 {
            writer.flow(Flow::End).unwrap();
        }
        let list = writer.words();
        let want = drawn::<P>(|scene| {
            let vertices = cloud.plain(shade, &format);
            scene.draw_indexed(vertices, &faces, &instance).unwrap();
        });
        for room in [(4, 4), (5, 7), (9, 100), (1000, 1000)] {
            let got = listed::<P, i16>(list, instance, room);
            assert!(got == want, "seed {seed}, room {room:?}");
            let got = listed::<P, i32>(list, instance, room);
            assert!(got == want, "seed {seed}, room {room:?}, 32 bits");
        }
    }
}

#[test]
fn strips_and_fans_are_the_triangles_that_they_stand_for() {
    strips_and_fans::<Smooth>(0..60);
    strips_and_fans::<Faceted>(100..130);
}

fn quads<P: Pipeline>(seeds: std::ops::Range<u64>)
where
    WordOf<P>: PartialEq + std::fmt::Debug,
{
    for seed in seeds {
        let mut rng = Rng::new(seed);
        let (format, place, normal) = some_format(&mut rng);
        let cloud = Cloud::random(&mut rng, 40, place, normal);
        let instance = some_instance(&mut rng);
        let strip = rng.below(2) == 1;
        let split = rng.pick(&[QuadSplit::Corner0To2, QuadSplit::Corner1To3]);
        let group = if strip { 2 } else { 4 };
        let order: Vec<u16> = (0..group * (2 + rng.below(8)))
            .map(|_| rng.below(40) as u16)
            .collect();
        let mut memory = vec![0; 4096];
        let mut writer = ListWriter::new(&mut memory);
        writer.state(&State::Format(format)).unwrap();
        let (mut rest, mut new) = (&order[..], true);
        while !rest.is_empty() {
            let most = rest.len() as u32 / group;
            let (part, left) = rest.split_at((group * (1 + rng.below(most))) as usize);
            rest = left;
            let header = Header {
                shade: true,
                new: new || !strip,
                rm: strip,
                low: if split == QuadSplit::Corner1To3 {
                    SPLIT
                } else {
                    0
                },
                ..Header::of(Id::Quads, part.len() as u16)
            };
            let words = cloud.vertices(&format, header, part);
            writer.vertices(header, &words).unwrap();
            new = false;
        }
        let list = writer.words();
        let mut fours = Vec::new();
        fours.extend(order.chunks_exact(4).map(|q| [q[0], q[1], q[2], q[3]]));
        let vertices = cloud.plain(true, &format);
        let want = drawn::<P>(|scene| {
            let mesh = Mesh {
                positions: vertices.positions,
                normals: vertices.normals,
                colours: vertices.colours,
                faces: if strip {
                    Faces::QuadStrip(&order, split)
                } else {
                    Faces::Quads(&fours, split)
                },
            };
            scene.draw(&mesh, &instance).unwrap();
        });
        for room in [(4, 4), (5, 6), (9, 100), (1000, 1000)] {
            assert!(
                listed::<P, i16>(list, instance, room) == want,
                "seed {seed}, room {room:?}, strip {strip}"
            );
        }
    }
}

#[test]
fn quads_and_quad_strips_are_those_of_meshes() {
    quads::<Smooth>(0..60);
    quads::<Faceted>(100..140);
}

fn indexed<P: Pipeline>(seeds: std::ops::Range<u64>)
where
    WordOf<P>: PartialEq + std::fmt::Debug,
{
    for seed in seeds {
        let mut rng = Rng::new(seed);
        let (format, place, normal) = some_format(&mut rng);
        let count = 30 + rng.below(3) as usize;
        let cloud = Cloud::random(&mut rng, count, place, normal);
        let instance = some_instance(&mut rng);
        let mut memory = vec![0; 4096];
        let mut writer = ListWriter::new(&mut memory);
        writer.state(&State::Format(format)).unwrap();
        let header = Header {
            shade: true,
            ..Header::of(Id::Table, count as u16)
        };
        writer
            .vertices(header, &cloud.columns(&format, header))
            .unwrap();
        let mut faces = Vec::new();
        for _ in 0..1 + rng.below(4) {
            let form = rng.pick(&[None, Some(Form::Strip), Some(Form::Fan)]);
            let mut indices = Vec::new();
            for _ in 0..1 + rng.below(4) {
                let mut len = rng.below(12);
                len -= if form.is_none() { len % 3 } else { 0 };
                let order: Vec<u16> = (0..len).map(|_| rng.below(count as u32) as u16).collect();
                match form {
                    None => faces.extend(order.chunks_exact(3).map(|f| [f[0], f[1], f[2]])),
                    Some(form) => faces.extend(unrolled(&order, form == Form::Fan)),
                }
                if form.is_some() && !indices.is_empty() {
                    indices.push(None);
                }
                indices.extend(order.into_iter().map(Some));
            }
            let wide = rng.below(2) == 1;
            writer.indexed(form, wide, indices.into_iter()).unwrap();
        }
        let list = writer.words();
        let want = drawn::<P>(|scene| {
            let vertices = cloud.plain(true, &format);
            scene.draw_indexed(vertices, &faces, &instance).unwrap();
        });
        for room in [(40, 4), (33, 31), (1000, 1000)] {
            assert!(
                listed::<P, i16>(list, instance, room) == want,
                "seed {seed}, room {room:?}"
            );
            assert!(listed::<P, i32>(list, instance, room) == want);
        }
        // What can be used where it lies needs no room.
        if format.fields().iter().all(|f| {
            matches!(
                (f.parameter, f.form),
                (0 | 4, FieldForm::S16x3) | (2, FieldForm::U8x3) | (9, _)
            )
        }) {
            assert!(listed::<P, i16>(list, instance, (4, 9)) == want);
        }
    }
}

#[test]
fn tables_are_indexed_meshes() {
    indexed::<Smooth>(0..80);
    indexed::<Faceted>(100..140);
}

#[test]
fn immediate_calls_are_meshes() {
    let mut rng = Rng::new(3);
    let cloud = Cloud::random(&mut rng, 840, FieldForm::S16x3, FieldForm::S16x3);
    let vertices = cloud.plain(true, &VertexFormat::default());
    let instance = some_instance(&mut rng);
    let threes: Vec<[u16; 3]> = (0..280).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let fours: Vec<[u16; 4]> = (0..210).map(|i| [0, 1, 2, 3].map(|k| 4 * i + k)).collect();
    let triangles = drawn::<Smooth>(|scene| {
        let done = scene.draw_triangles(vertices, &instance).unwrap();
        assert_eq!(done.triangles, 280);
    });
    let indexed = drawn::<Smooth>(|scene| {
        scene.draw_indexed(vertices, &threes, &instance).unwrap();
    });
    assert!(triangles == indexed);
    for split in [QuadSplit::Corner0To2, QuadSplit::Corner1To3] {
        let quads = drawn::<Faceted>(|scene| {
            let done = scene.draw_quads(vertices, split, &instance).unwrap();
            assert_eq!(done.triangles, 420);
        });
        let mesh = Mesh {
            positions: vertices.positions,
            normals: vertices.normals,
            colours: vertices.colours,
            faces: Faces::Quads(&fours, split),
        };
        let want = drawn::<Faceted>(|scene| {
            scene.draw(&mesh, &instance).unwrap();
        });
        assert!(quads == want);
    }
    let bad = Vertices {
        normals: &cloud.normals[1..],
        ..vertices
    };
    drawn::<Smooth>(|scene| assert!(scene.draw_triangles(bad, &instance).is_err()));
}
