//! Quads, strips of quads and tables of lists that are played: what the same calls draw (H11, H16, K2, K15).

use crate::common::Rng;
use crate::listing::{Cloud, PLENTY, ring_memory, some_format, unrolled};
use crate::played::{Kept, drawn, played};
use host_tests::lists::writer::{FieldPacker, Form, ListWriter};
use scanbeam::input::PlayerSettings;
use scanbeam::list::{
    FieldForm, Flow, Halt, Header, Id, ListRing, Reason, State, VertexFormat, Words,
};
use scanbeam::look::Gouraud;
use scanbeam::mesh::QuadSplit;
use scanbeam::pixel::Rgb565Be;
use scanbeam::scene::{Draw, Shading};
use scanbeam::{Affine, Cull, Faces, Light, Mesh};

type Smooth = Gouraud<Rgb565Be>;

/// How a list begins.
fn some_call(rng: &mut Rng) -> Draw<'static, 'static> {
    Draw {
        model: Affine::rotation_y(rng.signed() as f32 * 3.0),
        cull: rng.pick(&[Cull::Back, Cull::None]),
        light: (rng.below(2) == 0).then(|| Light::new([0.3, 0.9, 0.5], 0.2).unwrap()),
        colour: [200, 90, 40],
        shading: rng.pick(&[Shading::Smooth, Shading::Flat]),
        ..PlayerSettings::default().draw
    }
}

/// What a list draws, with memory for so many vertices and indices.
pub fn listed<'t>(
    list: impl Words<'t>,
    draw: Draw<'static, 'static>,
    (vertices, indices): (usize, usize),
) -> Vec<u16> {
    let settings = PlayerSettings {
        draw,
        ..PlayerSettings::default()
    };
    let mut kept = Kept::new(vertices, indices);
    let mut player = kept.player::<Smooth>(settings);
    // Kills: a player that stands behind the first word before it is started.
    assert_eq!(player.position(), 0);
    drawn::<Smooth>(|scene| {
        player.start(0);
        assert_eq!(played(&mut player, list, scene, PLENTY), Ok(Halt::End));
    })
}

/// Writes a cloud as a table.
fn write_table(writer: &mut ListWriter<'_>, cloud: &Cloud, format: &VertexFormat) {
    let header = Header {
        shade: true,
        ..Header::of(Id::Table, cloud.positions.len() as u16)
    };
    let words = cloud.columns(format, header);
    writer.vertices(header, &words).unwrap();
}

#[test]
fn quads_and_quad_strips_are_those_of_meshes() {
    for seed in 0..100 {
        let mut rng = Rng::new(seed);
        let (format, place, normal) = some_format(&mut rng);
        let cloud = Cloud::random(&mut rng, 40, place, normal);
        let call = some_call(&mut rng);
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
                    Header::SPLIT
                } else {
                    0
                },
                ..Header::of(Id::Quads, part.len() as u16)
            };
            let words = cloud.vertices(&format, header, part);
            writer.vertices(header, &words).unwrap();
            new = false;
        }
        writer.flow(Flow::End).unwrap();
        let list = writer.words();
        let mut fours = Vec::new();
        fours.extend(order.chunks_exact(4).map(|q| [q[0], q[1], q[2], q[3]]));
        let vertices = cloud.plain(true, &format);
        let want = drawn::<Smooth>(|scene| {
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
            scene.draw(&Draw { mesh, ..call }).unwrap();
        });
        for room in [(4, 4), (5, 6), (9, 100), (1000, 1000)] {
            assert!(
                listed(list, call, room) == want,
                "seed {seed}, room {room:?}, strip {strip}"
            );
        }
    }
}

/// Kills: memory for vertices that a table takes which is used where it lies.
#[test]
fn a_table_that_is_used_where_it_lies_takes_no_memory() {
    let mut rng = Rng::new(77);
    let mut fields = |form: FieldForm, count: usize| {
        let mut words = Vec::new();
        let mut packer = FieldPacker::new(|word| words.push(word));
        for _ in 0..count {
            let place = [(); 2].map(|()| rng.within(-16_000, 16_000));
            packer.field(form, [place[0], place[1], 0, 0]);
            if count == 3 {
                packer.align();
            }
        }
        packer.align();
        words
    };
    let table = fields(FieldForm::S16x3, 40);
    let run = fields(FieldForm::S16x3, 3);
    let mut memory = vec![0; 512];
    let mut writer = ListWriter::new(&mut memory);
    writer.vertices(Header::of(Id::Table, 40), &table).unwrap();
    let header = Header {
        new: true,
        ..Header::of(Id::Short, 3)
    };
    writer.vertices(header, &run).unwrap();
    let face = [7u16, 22, 39].map(Some);
    writer.indexed(None, false, face.into_iter()).unwrap();
    writer.flow(Flow::End).unwrap();
    let call = Draw {
        cull: Cull::None,
        ..some_call(&mut Rng::new(1))
    };
    let small = listed(writer.words(), call, (4, 9));
    assert!(small == listed(writer.words(), call, (100, 100)));
    assert!(small.iter().filter(|word| **word != 0).count() > 100);
}

#[test]
fn tables_are_indexed_meshes() {
    for seed in 0..120 {
        let mut rng = Rng::new(seed);
        let (format, place, normal) = some_format(&mut rng);
        let count = 30 + rng.below(3) as usize;
        let cloud = Cloud::random(&mut rng, count, place, normal);
        let call = some_call(&mut rng);
        let mut memory = vec![0; 4096];
        let mut writer = ListWriter::new(&mut memory);
        writer.state(&State::Format(format)).unwrap();
        write_table(&mut writer, &cloud, &format);
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
        writer.flow(Flow::End).unwrap();
        let list = writer.words();
        let want = drawn::<Smooth>(|scene| {
            let vertices = cloud.plain(true, &format);
            let mesh = Mesh {
                positions: vertices.positions,
                normals: vertices.normals,
                colours: vertices.colours,
                faces: Faces::Triangles(&faces),
            };
            scene.draw(&Draw { mesh, ..call }).unwrap();
        });
        for room in [(40, 4), (33, 31), (1000, 1000)] {
            assert!(
                listed(list, call, room) == want,
                "seed {seed}, room {room:?}"
            );
        }
        // In a ring nothing lies as bytes. Kills: indices behind the last whole word of them are left out.
        let mut memory = ring_memory(4096);
        let mut ring = ListRing::new(&mut memory);
        let (mut appended, reader) = ring.split();
        appended.append(list).unwrap();
        let got = listed(reader.words(), call, (1000, 1000));
        assert!(got == want, "seed {seed}, in a ring");
        // What can be used where it lies needs no room.
        if format.fields().iter().all(|f| {
            matches!(
                (f.parameter, f.form),
                (0 | 4, FieldForm::S16x3) | (2, FieldForm::U8x3) | (9, _)
            )
        }) {
            assert!(listed(list, call, (4, 9)) == want);
        }
    }
}

/// Kills: the first index that a table does not have, far along in a strip.
#[test]
fn strips_of_tables_end_at_the_last_vertex() {
    let mut rng = Rng::new(3);
    let (format, place, normal) = some_format(&mut rng);
    let cloud = Cloud::random(&mut rng, 40, place, normal);
    for (index, wide, form) in [
        (39, false, Form::Strip),
        (40, false, Form::Strip),
        (40, true, Form::Strip),
        (40, false, Form::Fan),
    ] {
        let mut memory = vec![0; 4096];
        let mut writer = ListWriter::new(&mut memory);
        writer.state(&State::Format(format)).unwrap();
        write_table(&mut writer, &cloud, &format);
        let order = [0, 1, 2, 3, 4, 5, index, 6].map(Some);
        writer.indexed(Some(form), wide, order.into_iter()).unwrap();
        writer.flow(Flow::End).unwrap();
        let mut kept = Kept::new(64, 96);
        let mut player = kept.player::<Smooth>(PlayerSettings::default());
        drawn::<Smooth>(|scene| {
            player.start(0);
            let done = played(&mut player, writer.words(), scene, PLENTY);
            let refused = Reason::Index { index, count: 40 };
            match index {
                40 => assert_eq!(done.unwrap_err().reason, refused),
                _ => assert_eq!(done, Ok(Halt::End)),
            }
        });
    }
}
