//! Alphas of vertices in lists: what a list draws is what calls with the same alphas draw (K11, H11).

use crate::common::Rng;
use crate::listing::PLENTY;
use crate::played::{Kept, drawn, played};
use host_tests::lists::writer::{FieldPacker, ListWriter};
use scanbeam::input::PlayerSettings;
use scanbeam::list::{Field, FieldForm, Flow, Halt, Header, Id, Material, State, VertexFormat};
use scanbeam::look::Gouraud;
use scanbeam::mesh::ScreenVertex;
use scanbeam::pixel::Rgb565Be;
use scanbeam::scene::{Blend, Draw, ScreenCorner};
use scanbeam::{Cull, Faces, Mesh};

type Smooth = Gouraud<Rgb565Be>;

/// Vertices of a strip: places, colours, alphas.
pub struct Band {
    pub positions: Vec<[i16; 3]>,
    pub colours: Vec<[u8; 3]>,
    pub alphas: Vec<u8>,
}

impl Band {
    pub fn new(rng: &mut Rng, count: usize) -> Self {
        let positions = (0..count).map(|i| {
            let side = [-5_000, 5_000][i % 2];
            let [x, y] = [(); 2].map(|()| rng.within(-2_000, 2_000) as i16);
            [i as i16 * 1_500 - 14_000 + x, side + y, 0]
        });
        Self {
            positions: positions.collect(),
            colours: (0..count)
                .map(|_| [(); 3].map(|()| rng.below(256) as u8))
                .collect(),
            alphas: (0..count).map(|_| rng.below(256) as u8).collect(),
        }
    }

    /// Vertices one after the other, or columns.
    pub fn words(&self, is_table: bool) -> Vec<u32> {
        let mut words = Vec::new();
        let mut packer = FieldPacker::new(|w| words.push(w));
        let places = self.positions.iter().map(|p| p.map(i32::from));
        let places = places.map(|[x, y, z]| [x, y, z, 0]);
        let colours = self.colours.iter().zip(&self.alphas);
        let colours = colours.map(|(c, a)| [c[0], c[1], c[2], *a].map(i32::from));
        if is_table {
            places.for_each(|place| packer.field(FieldForm::S16x3, place));
            packer.align();
            colours.for_each(|colour| packer.field(FieldForm::U8x4, colour));
            packer.align();
        } else {
            for (place, colour) in places.zip(colours) {
                packer.field(FieldForm::S16x3, place);
                packer.align();
                packer.field(FieldForm::U8x4, colour);
                packer.align();
            }
        }
        words
    }

    fn faces(&self) -> Vec<[u16; 3]> {
        let last = self.positions.len() as u16 - 2;
        (0..last).map(|i| [i, i + 1, i + 2]).collect()
    }

    /// The same by a call.
    fn called(&self, alphas: &[u8], blend: Option<Blend>) -> Vec<u16> {
        drawn::<Smooth>(|scene| {
            let faces = self.faces();
            let call = Draw {
                cull: Cull::None,
                alphas,
                blend,
                ..Draw::new(Mesh {
                    positions: &self.positions,
                    normals: &[],
                    colours: &self.colours,
                    faces: Faces::Triangles(&faces),
                })
            };
            scene.draw(&call).unwrap();
        })
    }
}

/// A list: what is seen from both sides, of places and colours with alphas, and then what `write` writes.
pub fn list_of(opacity: u8, write: impl FnOnce(&mut ListWriter<'_>)) -> &'static [u32] {
    let mut memory = vec![0; 1024];
    let mut writer = ListWriter::new(&mut memory);
    let fields = [
        (Field::PLACE, FieldForm::S16x3),
        (Field::DIFFUSE, FieldForm::U8x4),
    ];
    let fields = fields.map(|(parameter, form)| Field { parameter, form });
    let format = VertexFormat::new(&fields).unwrap();
    writer.state(&State::Format(format)).unwrap();
    let material = Material {
        two_sided: true,
        opacity,
        ..Material::default()
    };
    writer.state(&State::Material(material)).unwrap();
    write(&mut writer);
    writer.flow(Flow::End).unwrap();
    Vec::leak(writer.words().to_vec())
}

/// What a list draws, with room for so many vertices, and for the alphas of so many.
fn listed(list: &'static [u32], vertices: usize, alphas: usize) -> Vec<u16> {
    let mut kept = Kept::new(vertices, 96).with_alphas(alphas);
    let mut player = kept.player::<Smooth>(PlayerSettings::default());
    drawn::<Smooth>(|scene| {
        player.start(0);
        assert_eq!(played(&mut player, list, scene, PLENTY), Ok(Halt::End));
    })
}

/// Strips and tables, with room for all at once or for a few; without room for alphas they are passed over.
///
/// Kills: alphas of the vertices before where a strip goes on, a column that is read as vertices are, alphas of a call that
/// hides what is behind, opacity that is dropped.
#[test]
fn alphas_of_lists_are_those_of_calls() {
    for (seed, opacity) in [(1, 255), (2, 255), (3, 140)] {
        let mut rng = Rng::new(seed);
        let band = Band::new(&mut rng, 18);
        let want = band.called(&band.alphas, Some(Blend::filter(opacity)));
        let header = |id| Header {
            shade: true,
            new: true,
            ..Header::of(id, 18)
        };
        let strip = list_of(opacity, |writer| {
            writer
                .vertices(header(Id::Short), &band.words(false))
                .unwrap();
        });
        let table = list_of(opacity, |writer| {
            let header = Header {
                new: false,
                ..header(Id::Table)
            };
            writer.vertices(header, &band.words(true)).unwrap();
            for face in band.faces() {
                writer
                    .indexed(None, false, face.map(Some).into_iter())
                    .unwrap();
            }
        });
        for list in [strip, table] {
            assert!(listed(list, 64, 64) == want, "seed {seed}");
            let opaque = (opacity < 255).then(|| Blend::filter(opacity));
            assert!(
                listed(list, 64, 0) == band.called(&[], opaque),
                "seed {seed}"
            );
        }
        // Of a few vertices at a time each edge between two is drawn by either call, in order of submission.
        let parts = listed(strip, 7, 7);
        assert!(parts == want, "seed {seed}: in parts");
    }
}

/// Vertices that were set up beforehand. Kills: alphas of another corner of the strip, more faces than are drawn at once
/// with the alphas of the first.
#[test]
fn alphas_of_long_vertices_are_those_of_calls() {
    let mut rng = Rng::new(9);
    let count = 40;
    let vertices: Vec<(ScreenVertex, u8)> = (0..count)
        .map(|i| {
            let vertex = ScreenVertex {
                x: 18 * i + rng.within(-9, 9) as i16,
                y: [40, 500][i as usize % 2] + rng.within(-30, 30) as i16,
                depth: 1 << 31,
                colour: [(); 3].map(|()| rng.below(256) as u8),
            };
            (vertex, rng.below(256) as u8)
        })
        .collect();
    let list = list_of(255, |writer| {
        let header = Header {
            shade: true,
            new: true,
            ..Header::of(Id::Long, count as u16)
        };
        let words = vertices.iter().flat_map(|(v, alpha)| {
            let [r, g, b] = v.colour;
            let place = u32::from(v.x as u16) | u32::from(v.y as u16) << 16;
            [place, u32::from_le_bytes([r, g, b, *alpha])]
        });
        let words: Vec<u32> = words.collect();
        writer.vertices(header, &words).unwrap();
    });
    let called = |has_alphas: bool| {
        drawn::<Smooth>(|scene| {
            let none = PlayerSettings::default().draw;
            for i in 0..vertices.len() - 2 {
                let of = [i, i + 1, i + 2];
                let corners = of.map(|i| ScreenCorner {
                    vertex: vertices[i].0,
                    ..ScreenCorner::default()
                });
                let alphas = of.map(|i| vertices[i].1);
                let call = Draw {
                    cull: Cull::None,
                    alphas: if has_alphas { &alphas } else { &[] },
                    blend: has_alphas.then_some(Blend::ALPHA),
                    ..none
                };
                scene.draw_screen(&call, &[corners]).unwrap();
            }
        })
    };
    assert!(listed(list, 64, 64) == called(true));
    assert!(listed(list, 64, 0) == called(false));
    assert!(called(true) != called(false));
}
