//! Lists with places of 32 bits that are played into the rooms: what the same calls draw (H11).

use crate::common::Rng;
use crate::listing::{PLENTY, ring_memory, unrolled};
use crate::played::{Kept, begun, drawn, played};
use host_tests::lists::writer::{FieldPacker, ListWriter};
use scanbeam::event::Notice;
use scanbeam::input::{Player, PlayerMemory, PlayerSettings};
use scanbeam::list::{
    Field, FieldForm, Flow, Halt, Header, Id, ListRing, State, VertexFormat, Words,
};
use scanbeam::look::Gouraud;
use scanbeam::mesh::QuadSplit;
use scanbeam::pixel::Rgb565Be;
use scanbeam::scene::{Draw, Scene};
use scanbeam::{Affine, Cull, Faces, Light, Mesh};
use scenes::Played;

type Smooth = Gouraud<Rgb565Be>;

const COUNT: usize = 40;

/// Vertices near one another, seen from near: what 16 bits cannot tell apart is pixels away.
struct Fine {
    positions: Vec<[i32; 3]>,
    normals: Vec<[i16; 3]>,
    colours: Vec<[u8; 3]>,
}

impl Fine {
    fn random(rng: &mut Rng) -> Self {
        let half = 1 << 21;
        let mut each = || {
            (
                [0; 3].map(|_: i32| rng.within(-half, half)),
                [0; 3].map(|_: i16| rng.within(-16_384, 16_384) as i16),
                [0; 3].map(|_: u8| rng.below(256) as u8),
            )
        };
        let mut fine = Self {
            positions: Vec::new(),
            normals: Vec::new(),
            colours: Vec::new(),
        };
        for (position, normal, colour) in (0..COUNT).map(|_| each()) {
            fine.positions.push(position);
            fine.normals.push(normal);
            fine.colours.push(colour);
        }
        fine
    }

    fn format() -> VertexFormat {
        let field = |parameter, form| Field { parameter, form };
        VertexFormat::new(&[
            field(Field::PLACE, FieldForm::S32x3),
            field(Field::NORMAL, FieldForm::S16x3),
            field(Field::DIFFUSE, FieldForm::U8x3),
        ])
        .unwrap()
    }

    fn field(&self, form: FieldForm, i: usize) -> [i32; 4] {
        let [x, y, z] = match form {
            FieldForm::S32x3 => self.positions[i],
            FieldForm::S16x3 => self.normals[i].map(i32::from),
            _ => self.colours[i].map(i32::from),
        };
        [x, y, z, 0]
    }

    /// Some vertices, one after the other.
    fn rows(&self, header: Header, order: &[u16]) -> Vec<u32> {
        let mut words = Vec::new();
        let mut packer = FieldPacker::new(|w| words.push(w));
        for &i in order {
            for field in Self::format().fields_of(header) {
                packer.field(field.form, self.field(field.form, i.into()));
                packer.align();
            }
        }
        words
    }

    /// All vertices, column by column.
    fn columns(&self, header: Header) -> Vec<u32> {
        let mut words = Vec::new();
        let mut packer = FieldPacker::new(|w| words.push(w));
        for field in Self::format().fields_of(header) {
            for i in 0..COUNT {
                packer.field(field.form, self.field(field.form, i));
            }
            packer.align();
        }
        words
    }

    /// Writes a strip, quads, or a table and triangles of it; what stands for it.
    fn write(
        &self,
        rng: &mut Rng,
        writer: &mut ListWriter<'_>,
    ) -> Result<Vec<[u16; 3]>, Vec<[u16; 4]>> {
        let order: Vec<u16> = (0..12 * (1 + rng.below(2)))
            .map(|_| rng.below(COUNT as u32) as u16)
            .collect();
        let header = |id, count: usize| Header {
            shade: true,
            new: true,
            ..Header::of(id, count as u16)
        };
        match rng.below(3) {
            0 => {
                let header = header(Id::Short, order.len());
                writer.vertices(header, &self.rows(header, &order)).unwrap();
                Ok(unrolled(&order, false))
            }
            1 => {
                let header = header(Id::Quads, order.len());
                writer.vertices(header, &self.rows(header, &order)).unwrap();
                Err(in_arrays(&order))
            }
            _ => {
                let header = Header {
                    new: false,
                    ..header(Id::Table, COUNT)
                };
                writer.vertices(header, &self.columns(header)).unwrap();
                let indices = order.iter().map(|i| Some(*i));
                writer.indexed(None, false, indices).unwrap();
                Ok(in_arrays(&order))
            }
        }
    }
}

/// Indices in groups of as many.
fn in_arrays<const N: usize>(indices: &[u16]) -> Vec<[u16; N]> {
    let groups = indices.chunks_exact(N);
    groups.filter_map(|group| group.try_into().ok()).collect()
}

/// What a player with places of 32 bits draws, in a scene that was begun.
fn play<'t>(
    list: impl Words<'t>,
    settings: PlayerSettings<'_, 't>,
    [vertices, indices]: [usize; 2],
    scene: &mut Scene<'_, 't, Smooth>,
) -> Halt {
    let memory = PlayerMemory {
        positions: &mut vec![[0i32; 3]; vertices],
        normals: &mut vec![[0; 3]; vertices],
        colours: &mut vec![[0; 3]; vertices],
        indices: &mut vec![0; indices],
        ..PlayerMemory::default()
    };
    let mut player = Player::new(memory, settings);
    player.start(0);
    let halt = player.run(list, scene, &mut PLENTY.clone(), &mut |_: Notice| {});
    halt.unwrap()
}

#[test]
fn places_of_32_bits_are_what_the_same_calls_draw() {
    let (mut in_pieces, mut told_apart) = (0, 0);
    for seed in 0..60 {
        let mut rng = Rng::new(seed);
        let fine = Fine::random(&mut rng);
        let begin = Draw {
            model: Affine::placed(600.0, [0.0; 3]).unwrap(),
            cull: Cull::None,
            light: (rng.below(2) == 0).then(|| Light::new([0.3, 0.9, 0.5], 0.2).unwrap()),
            ..PlayerSettings::default().draw
        };
        let settings = PlayerSettings {
            draw: begin,
            ..PlayerSettings::default()
        };
        let mut memory = vec![0; 8192];
        let mut writer = ListWriter::new(&mut memory);
        writer.state(&State::Format(Fine::format())).unwrap();
        let faces: Vec<_> = (0..1 + rng.below(3))
            .map(|_| fine.write(&mut rng, &mut writer))
            .collect();
        writer.flow(Flow::End).unwrap();
        let list = writer.words();
        let called = |positions: &[[i32; 3]]| {
            drawn::<Smooth>(|scene| {
                for faces in &faces {
                    let mesh = Mesh {
                        positions,
                        normals: &fine.normals,
                        colours: &fine.colours,
                        faces: match faces {
                            Ok(faces) => Faces::Triangles(faces),
                            Err(quads) => Faces::Quads(quads, QuadSplit::Corner0To2),
                        },
                    };
                    let call = Draw {
                        model: begin.model,
                        cull: begin.cull,
                        light: begin.light,
                        ..Draw::new(mesh)
                    };
                    scene.draw(&call).unwrap();
                }
            })
        };
        let want = called(&fine.positions);
        let coarse: Vec<_> = (fine.positions.iter())
            .map(|p| p.map(|c| c >> 16 << 16))
            .collect();
        told_apart += u32::from(called(&coarse) != want);
        for room in [[COUNT + 4, 12], [1000, 1000]] {
            let got = drawn::<Smooth>(|scene| {
                assert_eq!(play(list, settings, room, scene), Halt::End);
            });
            assert!(got == want, "seed {seed}, {room:?}");
        }
        // Through a ring tables are unpacked.
        let mut ring = ring_memory(8192);
        let mut ring = ListRing::new(&mut ring);
        let (mut into, from) = ring.split();
        into.append(list).unwrap();
        let got = drawn::<Smooth>(|scene| {
            assert_eq!(play(from.words(), settings, [1000, 1000], scene), Halt::End);
        });
        assert!(got == want, "seed {seed}, a ring");
        in_pieces += u32::from(faces.len() > 1);
    }
    assert!(
        told_apart > 50 && in_pieces > 20,
        "{told_apart}, {in_pieces}"
    );
}

/// A list of places of 16 bits is drawn alike by either.
#[test]
fn places_of_16_bits_are_the_same_in_memory_of_32() {
    let list = Played::Teapot.list().unwrap();
    let camera = Played::Teapot.camera().unwrap();
    let mut kept = Kept::new(255, 1536);
    let mut player = kept.player::<Smooth>(Played::Teapot.settings());
    let want = begun::<Smooth>(&camera, |scene| {
        player.start(0);
        played(&mut player, list, scene, PLENTY).unwrap();
        assert!(scene.objects() > 100);
    });
    let got = begun::<Smooth>(&camera, |scene| {
        assert_eq!(
            play(list, Played::Teapot.settings(), [255, 1536], scene),
            Halt::End
        );
    });
    assert!(got == want);
}
