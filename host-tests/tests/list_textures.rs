//! Textures of lists, drawn from where they lie, against the same texels lent to calls (H7, H12).

use crate::common::Rng;
use crate::listing::{self, PLENTY, Room, drawn, some_instance};
use host_tests::lists::writer::{FieldPacker, ListWriter};
use scanbeam::event::{Event, Notice};
use scanbeam::input::ListSettings;
use scanbeam::list::{
    Field, FieldForm, Flow, Halt, Header, Id, ListRing, Material, Palette, State, TexelForm,
    Texture, TextureSlot, VertexFormat, parameter,
};
use scanbeam::mesh::ScreenVertex;
use scanbeam::pipeline::texture::{
    Clamp, ListTextures, Quality, Size, Skin, TexelOf, Textures, Words,
};
use scanbeam::pipeline::{Instance, ListedDepth, TexturedDepth, texture};
use scanbeam::pixel::Rgb888;
use scanbeam::{Cull, Faces, Mesh};
use std::sync::atomic::AtomicU32;

type Listed<'t> = ListedDepth<'t, Rgb888>;
type Picture = Vec<Vec<[u8; 3]>>;

/// A texture as levels, and as a list has it.
struct Image {
    block: Texture,
    words: Vec<u32>,
    /// For the forms that need one.
    palette: Vec<u32>,
    texels: Vec<[u8; 3]>,
}

/// The field of some bits from a place in a run of words, bit by bit.
fn bits(words: &[u32], from: usize, count: usize) -> u32 {
    (0..count).fold(0, |v, k| {
        let at = from + k;
        v | (words[at / 32] >> (at % 32) & 1) << k
    })
}

impl Image {
    fn random(rng: &mut Rng, form: TexelForm, number: u8, palette: u8) -> Self {
        let sides = [rng.below(7) as u8, rng.below(7) as u8];
        let block = Texture {
            number,
            log_width: sides[0],
            log_height: sides[1],
            form,
            levels: 1 + rng.below(4) as u8,
            palette,
            clamped: rng.below(2) == 1,
            at: 0,
        };
        let any = |rng: &mut Rng| rng.below(1 << 16) << 16 | rng.below(1 << 16);
        let words: Vec<u32> = (0..block.words()).map(|_| any(rng)).collect();
        let colours: Vec<u32> = (0..1 + rng.below(256)).map(|_| any(rng)).collect();
        let each = form.bits() as usize;
        let rgb = |v: u32| [v as u8, (v >> 8) as u8, (v >> 16) as u8];
        // 5 or 6 bits to 8: the nearest level of the same share of full.
        let grown = |v: u32, most: u32| (f64::from(v) * 255.0 / f64::from(most)).floor();
        let repeated = |v: u32, most: u32, bits: u32| {
            let level = (v << (8 - bits) | v >> (2 * bits - 8)) as u8;
            assert!((f64::from(level) - grown(v, most)).abs() <= 1.0);
            level
        };
        let texels = (0..1usize << (sides[0] + sides[1]))
            .map(|i| {
                let v = bits(&words, i * each, each);
                match form {
                    TexelForm::Rgb565 => [
                        repeated(v >> 11, 31, 5),
                        repeated(v >> 5 & 63, 63, 6),
                        repeated(v & 31, 31, 5),
                    ],
                    TexelForm::Rgb888 | TexelForm::Rgba => rgb(v),
                    // A colour that the palette lacks is black.
                    TexelForm::Index6 => rgb(*colours.get(v as usize & 63).unwrap_or(&0)),
                    _ => rgb(*colours.get(v as usize).unwrap_or(&0)),
                }
            })
            .collect();
        Self {
            block,
            words,
            palette: colours,
            texels,
        }
    }

    fn write(&self, writer: &mut ListWriter<'_>) {
        writer
            .bulk(&State::Texture(self.block), &self.words)
            .unwrap();
    }

    fn write_palette(&self, writer: &mut ListWriter<'_>) {
        let palette = Palette {
            number: self.block.palette,
            count: self.palette.len() as u16,
            at: 0,
        };
        writer
            .bulk(&State::Palette(palette), &self.palette)
            .unwrap();
    }

    /// Texels with 8 fraction bits, from sides in 4.12.
    fn place(&self, uv: [u16; 2]) -> [i32; 2] {
        let [u, v] = uv.map(i64::from);
        [
            ((u * 256) << self.block.log_width) / 4096,
            ((v * 256) << self.block.log_height) / 4096,
        ]
        .map(|v| v as i32)
    }
}

/// A texture of either way beyond its sides.
#[derive(Clone, Copy)]
enum Plain<'t> {
    Wrap(texture::Texture<Words<'t, [u8; 3]>>),
    Clamp(texture::Texture<Words<'t, [u8; 3]>, Clamp>),
}

#[derive(Clone, Copy)]
struct Rgb([u8; 3]);

impl TexelOf<Rgb888> for Rgb {
    fn word(self) -> [u8; 3] {
        self.0
    }

    fn levels(self) -> [u8; 3] {
        self.0
    }
}

impl texture::Texels for Plain<'_> {
    type Texel = Rgb;

    fn period(&self) -> texture::Period {
        match self {
            Self::Wrap(t) => t.period(),
            Self::Clamp(t) => t.period(),
        }
    }

    fn at(&self, place: texture::Uv) -> Rgb {
        Rgb(match self {
            Self::Wrap(t) => t.at(place),
            Self::Clamp(t) => t.at(place),
        })
    }
}

fn plain(image: &Image) -> Plain<'_> {
    let size = Size::new(1 << image.block.log_width, 1 << image.block.log_height).unwrap();
    if image.block.clamped {
        Plain::Clamp(texture::Texture::new(Words(&image.texels), size).unwrap())
    } else {
        Plain::Wrap(texture::Texture::new(Words(&image.texels), size).unwrap())
    }
}

/// Places in space and on the texture.
struct Sheet {
    positions: Vec<[i16; 3]>,
    uv: Vec<[u16; 2]>,
}

impl Sheet {
    fn random(rng: &mut Rng, count: usize) -> Self {
        Self {
            positions: (0..count)
                .map(|_| [0; 3].map(|_: i16| rng.within(-16_384, 16_384) as i16))
                .collect(),
            uv: (0..count)
                .map(|_| [0; 2].map(|_: u16| rng.below(3 * 4096) as u16))
                .collect(),
        }
    }

    fn field(&self, field: Field, i: usize) -> [i32; 4] {
        match field.parameter {
            parameter::PLACE => {
                let [x, y, z] = self.positions[i].map(i32::from);
                [x, y, z, 0]
            }
            _ => {
                let [u, v] = self.uv[i].map(i32::from);
                [u, v, 0, 0]
            }
        }
    }

    fn words(&self, format: &VertexFormat, header: Header, order: &[u16]) -> Vec<u32> {
        let mut words = Vec::new();
        let mut packer = FieldPacker::new(|w| words.push(w));
        if header.id == Id::Table {
            for field in format.fields_of(header) {
                for &i in order {
                    packer.field(field.form, self.field(field, usize::from(i)));
                }
                packer.align();
            }
        } else {
            for &i in order {
                for field in format.fields_of(header) {
                    packer.field(field.form, self.field(field, usize::from(i)));
                    packer.align();
                }
            }
        }
        words
    }
}

fn format(rng: &mut Rng) -> VertexFormat {
    let mut fields = [
        Field {
            parameter: parameter::PLACE,
            form: FieldForm::S16x3,
        },
        Field {
            parameter: parameter::TEXTURE,
            form: FieldForm::U16x2,
        },
    ];
    rng.shuffle(&mut fields);
    VertexFormat::new(&fields).unwrap()
}

/// What a list draws with so many slots, and its events but for the end.
fn listed(
    list: &[u32],
    settings: ListSettings<'_>,
    (slots, room): (usize, usize),
) -> (Picture, Vec<Event>) {
    let slots: Vec<TextureSlot> = (0..slots).map(|_| TextureSlot::new()).collect();
    let mut events = Vec::new();
    let picture = drawn::<Listed<'_>>(|scene| {
        scene.set_textures(ListTextures {
            words: list,
            slots: &slots,
        });
        let mut room = Room::<i16>::new(room, 2 * room);
        let mut runner = room.textured(settings, &slots);
        runner.start(0);
        let mut note = |n: Notice| events.push(n.event);
        let halt = runner.run(list, scene, &mut PLENTY.clone(), &mut note);
        assert_eq!(halt, Ok(Halt::End));
    });
    events.retain(|e| !matches!(e, Event::ListEnd | Event::Clipped));
    (picture, events)
}

/// What the blocks of the test draw: an image, a kind of block, and vertices in an order.
struct Draw {
    image: usize,
    id: Id,
    fan: bool,
    prsp: bool,
    order: Vec<u16>,
}

fn random_list(seed: u64) {
    let mut rng = Rng::new(seed);
    let instance = Instance {
        light: None,
        colour: rng.pick(&[[255; 3], [255, 128, 40]]),
        ..some_instance(&mut rng)
    };
    let sheet = Sheet::random(&mut rng, 24);
    let format = format(&mut rng);
    // Two of the images share a palette's number: it is the one defined last that counts.
    let images: Vec<Image> = (0..4)
        .map(|n| {
            let form = TexelForm::ALL[rng.below(8) as usize];
            Image::random(&mut rng, form, n, 7 + n / 2)
        })
        .collect();
    let mut memory = vec![0; 1 << 17];
    let mut writer = ListWriter::new(&mut memory);
    writer.state(&State::Format(format)).unwrap();
    let blocks: Vec<u32> = images
        .iter()
        .map(|image| {
            let at = writer.position();
            image.write(&mut writer);
            at
        })
        .collect();
    let mut draws: Vec<Draw> = Vec::new();
    for _ in 0..1 + rng.below(5) {
        let draw = Draw {
            image: rng.below(4) as usize,
            id: rng.pick(&[Id::Short, Id::Long, Id::Points, Id::Quads, Id::Indexed]),
            fan: rng.below(2) == 1,
            prsp: rng.below(2) == 1,
            order: (0..4 * (1 + rng.below(5)))
                .map(|_| rng.below(24) as u16)
                .collect(),
        };
        let image = &images[draw.image];
        image.write_palette(&mut writer);
        // By its own number, or loaded under another one (H12).
        let mut number = image.block.number;
        if rng.below(2) == 1 {
            number = 200 + rng.below(3) as u8;
            let at = blocks[draw.image];
            writer.flow(Flow::LoadTexture { number, at }).unwrap();
        }
        let material = Material {
            diffuse: instance.colour,
            two_sided: instance.cull == Cull::None,
            texture: Some(number),
            ..Material::default()
        };
        writer.state(&State::Material(material)).unwrap();
        let header = Header {
            prsp: draw.prsp,
            text: true,
            new: !matches!(draw.id, Id::Points | Id::Indexed),
            rm: draw.fan && matches!(draw.id, Id::Short | Id::Long),
            ..Header::of(draw.id, draw.order.len() as u16)
        };
        match draw.id {
            Id::Indexed => {
                let all: Vec<u16> = (0..24).collect();
                let table = Header {
                    new: false,
                    rm: false,
                    ..Header {
                        id: Id::Table,
                        ..header
                    }
                };
                let table = Header { count: 24, ..table };
                let words = sheet.words(&format, table, &all);
                writer.vertices(table, &words).unwrap();
                let order = draw.order.iter().map(|i| Some(*i)).collect::<Vec<_>>();
                let form = host_tests::lists::writer::Form::Strip;
                writer
                    .indexed(Some(form), false, order.into_iter())
                    .unwrap();
            }
            Id::Long => {
                let mut words = Vec::new();
                for &i in &draw.order {
                    let v = screen_vertex(&sheet, i);
                    words.push(u32::from(v.x as u16) | u32::from(v.y as u16) << 16);
                    words.extend(draw.prsp.then_some(v.depth));
                    let [u, v] = sheet.uv[usize::from(i)].map(u32::from);
                    words.push(u | v << 16);
                }
                writer.vertices(header, &words).unwrap();
            }
            _ => {
                let words = sheet.words(&format, header, &draw.order);
                writer.vertices(header, &words).unwrap();
            }
        }
        draws.push(draw);
    }
    let list = writer.words();
    let textures: Vec<Plain<'_>> = images.iter().map(plain).collect();
    let quality = rng.pick(&[Quality::Fast, Quality::Balanced, Quality::Exact]);
    let want = drawn::<TexturedDepth<'_, Rgb888, Plain<'_>>>(|scene| {
        scene.set_textures(Textures(&textures));
        for draw in &draws {
            let image = &images[draw.image];
            let places: Vec<[i32; 2]> = sheet.uv.iter().map(|uv| image.place(*uv)).collect();
            let skin = Skin {
                places: &places,
                texture: draw.image as u16,
                quality: if draw.prsp { quality } else { Quality::Fast },
            };
            let mesh = |faces| Mesh {
                positions: &sheet.positions,
                normals: &[],
                colours: &[],
                faces,
            };
            let unrolled = listing::unrolled(&draw.order, draw.fan && draw.id != Id::Indexed);
            let done = match draw.id {
                Id::Short | Id::Indexed => {
                    scene.draw_skinned(&mesh(Faces::Triangles(&unrolled)), skin, &instance)
                }
                Id::Quads => {
                    let fours: Vec<[u16; 4]> = draw
                        .order
                        .chunks_exact(4)
                        .map(|q| [q[0], q[1], q[2], q[3]])
                        .collect();
                    let faces = Faces::Quads(&fours, scanbeam::mesh::QuadSplit::Corner0To2);
                    scene.draw_skinned(&mesh(faces), skin, &instance)
                }
                Id::Long => {
                    let all: Vec<ScreenVertex> = (0..24)
                        .map(|i| ScreenVertex {
                            colour: instance.colour,
                            ..screen_vertex(&sheet, i)
                        })
                        .map(|v| ScreenVertex {
                            depth: if draw.prsp { v.depth } else { 1 << 31 },
                            ..v
                        })
                        .collect();
                    scene.draw_screen(&all, &unrolled, skin, instance.cull)
                }
                _ => {
                    let of = |i: &u16| usize::from(*i);
                    let positions: Vec<_> =
                        draw.order.iter().map(|i| sheet.positions[of(i)]).collect();
                    let places: Vec<_> = draw.order.iter().map(|i| places[of(i)]).collect();
                    let points = Mesh {
                        positions: &positions,
                        ..mesh(Faces::Triangles(&[]))
                    };
                    let skin = Skin {
                        places: &places,
                        ..skin
                    };
                    scene.draw_points(&points, 1, skin, &instance)
                }
            };
            done.unwrap();
        }
    });
    let settings = ListSettings {
        instance,
        quality,
        ..ListSettings::default()
    };
    for room in [28, 64, 500] {
        let (got, events) = listed(list, settings, (64, room));
        assert_eq!(events, [], "seed {seed}");
        assert!(got == want, "seed {seed}, room {room}");
    }
}

fn screen_vertex(sheet: &Sheet, i: u16) -> ScreenVertex {
    let [x, y, z] = sheet.positions[usize::from(i)];
    ScreenVertex {
        x: (x >> 4) + 300,
        y: (y >> 5) + 250,
        depth: (i32::from(z) + 20_000) as u32 * 50_000,
        colour: [0; 3],
    }
}

#[test]
fn textured_lists_are_textured_meshes() {
    for seed in 0..120 {
        random_list(seed);
    }
}

/// One textured triangle, with what is asked for before it.
fn one(state: impl FnOnce(&mut ListWriter<'_>), texture: Option<u8>) -> Vec<u32> {
    let mut memory = vec![0; 4096];
    let mut writer = ListWriter::new(&mut memory);
    state(&mut writer);
    let material = Material {
        diffuse: [255; 3],
        two_sided: true,
        texture,
        ..Material::default()
    };
    writer.state(&State::Material(material)).unwrap();
    let header = Header {
        text: true,
        new: true,
        ..Header::of(Id::Short, 3)
    };
    let sheet = Sheet {
        positions: vec![[-9000, -9000, 0], [9000, -9000, 0], [0, 9000, 0]],
        uv: vec![[0, 0], [4096, 0], [0, 4096]],
    };
    let words = sheet.words(&VertexFormat::default(), header, &[0, 1, 2]);
    writer.vertices(header, &words).unwrap();
    writer.words().to_vec()
}

#[test]
fn a_texture_that_is_not_there_is_an_event_and_its_faces_are_drawn_plain() {
    let mut rng = Rng::new(5);
    let image = Image::random(&mut rng, TexelForm::Index4, 3, 1);
    let settings = ListSettings::default();
    let white = |picture: &Picture| picture.iter().flatten().filter(|p| **p == [255; 3]).count();
    // No texture; a texture without its palette; no slots.
    let without_palette = one(|w| image.write(w), Some(3));
    for (list, slots, event) in [
        (one(|_| {}, Some(3)), 8, Event::Unimplemented),
        (without_palette.clone(), 8, Event::Unimplemented),
        (without_palette, 0, Event::Full),
    ] {
        let (picture, events) = listed(&list, settings, (slots, 16));
        assert!(events.contains(&event), "{events:?}");
        assert!(white(&picture) > 100);
    }
    let whole = one(
        |w| {
            image.write(w);
            image.write_palette(w);
        },
        Some(3),
    );
    let (picture, events) = listed(&whole, settings, (3, 16));
    assert_eq!(events, []);
    assert!(white(&picture) < 20);
    // A pair needs a slot of its own.
    assert_eq!(listed(&whole, settings, (2, 16)).1, [Event::Full]);
    // Where no texture is named, places are passed over.
    assert_eq!(listed(&one(|_| {}, None), settings, (0, 16)).1, []);
}

#[test]
fn a_ring_has_no_textures() {
    let image = Image::random(&mut Rng::new(6), TexelForm::Rgb565, 3, 1);
    let blocks = one(|w| image.write(w), Some(3));
    let mut memory: Vec<AtomicU32> = (0..8192).map(|_| AtomicU32::new(0)).collect();
    let mut ring = ListRing::new(&mut memory);
    let (mut writer, reader) = ring.split();
    writer.append(&blocks).unwrap();
    let slots = [const { TextureSlot::new() }; 4];
    let mut events = Vec::new();
    drawn::<Listed<'_>>(|scene| {
        let mut room = Room::<i16>::new(16, 32);
        let mut runner = room.textured(ListSettings::default(), &slots);
        runner.start(0);
        let mut note = |n: Notice| events.push(n.event);
        let halt = runner.run(reader.words(), scene, &mut PLENTY.clone(), &mut note);
        assert_eq!(halt, Ok(Halt::Waiting));
        assert_eq!(runner.counts().triangles, 1);
    });
    assert!(events.contains(&Event::Unimplemented));
}
