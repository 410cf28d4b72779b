//! Blocks with their data at random, written and read again.

use host_tests::lists::writer::{Form, ListWriter, WriteError};
use scanbeam::list::*;

/// A small generator with no dependency: the same numbers everywhere.
pub(super) struct Random(pub(super) u64);

impl Random {
    pub(super) fn next(&mut self) -> u32 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let x = (self.0 >> 33) as u32 ^ (self.0 >> 45) as u32;
        x.wrapping_mul(0x9E37_79B9).rotate_left(13)
    }

    pub(super) fn below(&mut self, n: u32) -> u32 {
        ((u64::from(self.next()) * u64::from(n)) >> 32) as u32
    }

    pub(super) fn flag(&mut self) -> bool {
        self.below(2) == 1
    }

    pub(super) fn mantissa(&mut self) -> i32 {
        (self.next() as i32) >> (2 + self.below(20))
    }
}

/// A block with its data, apart from where it lies.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Item {
    Flow(Flow),
    State(State),
    Bulk(State, Vec<u32>),
    Vertices(Header, Vec<u32>),
    Indexed(Option<Form>, bool, Vec<Option<u16>>),
    Master(u32),
}

fn random_format(r: &mut Random) -> VertexFormat {
    loop {
        let mut fields: Vec<Field> = (0..1 + r.below(6))
            .map(|_| Field {
                parameter: r.below(16) as u8,
                form: FieldForm::ALL[r.below(8) as usize],
            })
            .collect();
        fields.push(Field {
            parameter: Field::PLACE,
            form: FieldForm::ALL[[1, 2, 5, 7][r.below(4) as usize]],
        });
        if let Ok(format) = VertexFormat::new(&fields) {
            return format;
        }
    }
}

pub(super) fn random_item(
    r: &mut Random,
    format: &mut VertexFormat,
    kept: &mut Option<Header>,
) -> Item {
    let byte = |r: &mut Random| r.below(256) as u8;
    let bytes = |r: &mut Random| [byte(r), byte(r), byte(r)];
    let words = |r: &mut Random, n: u32| (0..n).map(|_| r.next()).collect::<Vec<_>>();
    let form = |r: &mut Random| TexelForm::ALL[r.below(10) as usize];
    match r.below(20) {
        0 => Item::Flow(match r.below(3) {
            0 => Flow::Pause,
            1 => Flow::Sync,
            _ => Flow::Interrupt(byte(r)),
        }),
        1 => Item::State(State::Head(Head {
            words: 0,
            table: r.next(),
            triangles: r.next(),
        })),
        2 => {
            *format = random_format(r);
            *kept = None;
            Item::State(State::Format(*format))
        }
        3 => Item::State(State::Matrix(Matrix {
            linear: [0; 9].map(|_: i32| r.mantissa()),
            linear_exponent: r.below(225) as i16 - 128,
            offset: [0; 3].map(|_: i32| r.mantissa()),
            offset_exponent: r.below(225) as i16 - 128,
        })),
        4 => Item::State(State::Light {
            number: byte(r),
            light: LightWords {
                direction: [0; 3].map(|_: i32| r.next() as i16),
                ambient: r.below(32_769) as u16,
                colour: bytes(r),
            },
        }),
        5 => Item::State(match r.flag() {
            true => State::LightOff { number: byte(r) },
            false => State::PointSize(1 + r.below(255) as u8),
        }),
        6 => Item::State(State::Material(Material {
            diffuse: bytes(r),
            opacity: byte(r),
            specular: bytes(r),
            exponent: byte(r),
            two_sided: r.flag(),
            unlit: r.flag(),
            texture: r.flag().then_some(r.next() as u8),
        })),
        7 => {
            let mut float = || r.next() as i32 as f32 / 1e6;
            let mut vector = || [float(), float(), float()];
            Item::State(State::Camera(CameraWords {
                eye: vector(),
                at: vector(),
                up: vector(),
                focal: float(),
                near: float(),
                far: float(),
            }))
        }
        8 => {
            let (left, top) = (r.below(65_000) as u16, r.below(65_000) as u16);
            Item::State(State::Window(Window {
                left,
                top,
                right: left + 1 + r.below(500) as u16,
                bottom: top + 1 + r.below(500) as u16,
            }))
        }
        9 => {
            let texture = Texture {
                number: byte(r),
                log_width: r.below(7) as u8,
                log_height: r.below(7) as u8,
                form: form(r),
                levels: 1 + r.below(4) as u8,
                palette: byte(r),
                clamped: r.flag(),
                at: 0,
            };
            Item::Bulk(State::Texture(texture), words(r, texture.words()))
        }
        10 => {
            let count = 1 + r.below(256);
            let palette = Palette {
                number: byte(r),
                count: count as u16,
                at: 0,
            };
            Item::Bulk(State::Palette(palette), words(r, count))
        }
        11 => {
            let overlay = Overlay {
                left: r.next() as u16,
                top: r.next() as u16,
                width: 1 + r.below(40) as u16,
                height: 1 + r.below(40) as u16,
                form: form(r),
                additive: r.flag(),
                palette: byte(r),
                at: 0,
            };
            Item::Bulk(State::Overlay(overlay), words(r, overlay.words()))
        }
        12 => Item::State(State::Bounds(Bounds {
            centre: [0; 3].map(|_: i32| r.mantissa()),
            radius: r.mantissa().unsigned_abs() as i32,
            exponent: r.below(225) as i16 - 128,
            words: 0,
        })),
        13 if r.flag() => Item::State(State::Cone(Cone {
            apex: [0; 3].map(|_: i32| r.next() as i32),
            axis: [0; 3].map(|_: i16| r.next() as i16),
            spread: r.next() as u16,
            words: 0,
        })),
        13 => Item::Master(r.next()),
        14 => {
            let header = Header {
                shade: r.flag(),
                prsp: r.flag(),
                text: r.flag(),
                ..Header::of(Id::Table, r.below(300) as u16)
            };
            *kept = None;
            let data = words(r, format.table_words(header, header.count));
            Item::Vertices(header, data)
        }
        15 | 16 => {
            let wide = r.flag();
            let form = [None, Some(Form::Strip), Some(Form::Fan)][r.below(3) as usize];
            let most = if wide { 0xFFFF } else { 0xFF };
            let mut count = r.below(100);
            count -= if form.is_none() { count % 3 } else { 0 };
            let indices = (0..count)
                .map(|_| match form {
                    Some(_) if r.below(8) == 0 => None,
                    _ => Some(r.below(most) as u16),
                })
                .collect();
            Item::Indexed(form, wide, indices)
        }
        _ => {
            let id = [Id::Short, Id::Long, Id::Points, Id::Quads][r.below(4) as usize];
            let mut header = Header {
                shade: r.flag(),
                prsp: r.flag(),
                text: r.flag(),
                new: id != Id::Points,
                rm: id != Id::Points && r.flag(),
                low: if id == Id::Quads { r.below(2) as u8 } else { 0 },
                ..Header::of(id, 4 * r.below(20) as u16)
            };
            if let Some(before) = kept.filter(|_| r.flag()) {
                header = Header {
                    new: false,
                    count: header.count,
                    ..before
                };
            }
            *kept = match header.id {
                Id::Points => *kept,
                Id::Quads if !header.rm => None,
                _ => Some(header),
            };
            let each = if header.id == Id::Long {
                1 + u32::from(header.prsp) + u32::from(header.shade) + u32::from(header.text)
            } else {
                format.words(header)
            };
            Item::Vertices(header, words(r, each * u32::from(header.count)))
        }
    }
}

pub(super) fn write(writer: &mut ListWriter<'_>, item: &Item) -> Result<(), WriteError> {
    match item {
        Item::Flow(flow) => writer.flow(*flow),
        Item::State(state) => writer.state(state),
        Item::Bulk(state, data) => writer.bulk(state, data),
        Item::Vertices(header, data) => writer.vertices(*header, data),
        Item::Indexed(form, wide, indices) => writer.indexed(*form, *wide, indices.iter().copied()),
        Item::Master(register) => writer.master(*register),
    }
}

/// The block at `at` as an item again.
pub(super) fn item_of(list: &[u32], at: u32, parsed: &Parsed) -> Item {
    let data = |from: u32| list[from as usize..(at + parsed.words) as usize].to_vec();
    let run = |r: Run| Item::Vertices(r.header, data(r.at));
    match parsed.instruction {
        Instruction::Flow(flow) => Item::Flow(flow),
        Instruction::Master(register) => Item::Master(register),
        Instruction::Short(r)
        | Instruction::Long(r)
        | Instruction::Points(r)
        | Instruction::Quads(r)
        | Instruction::Table(r) => run(r),
        Instruction::Indexed(Run { header, at }) => {
            let wide = header.low & Header::WIDE != 0;
            let form = match (header.low & Header::SEPARATE != 0, header.rm) {
                (true, _) => None,
                (_, false) => Some(Form::Strip),
                _ => Some(Form::Fan),
            };
            let (each, bits, none) = if wide { (2, 16, 0xFFFF) } else { (4, 8, 0xFF) };
            let index = |n: u32| {
                let i = list[(at + n / each) as usize] >> (bits * (n % each)) & none;
                (i != none).then_some(i as u16)
            };
            Item::Indexed(
                form,
                wide,
                (0..u32::from(header.count)).map(index).collect(),
            )
        }
        Instruction::State(State::Texture(t)) => {
            Item::Bulk(State::Texture(Texture { at: 0, ..t }), data(t.at))
        }
        Instruction::State(State::Palette(p)) => {
            Item::Bulk(State::Palette(Palette { at: 0, ..p }), data(p.at))
        }
        Instruction::State(State::Overlay(o)) => {
            Item::Bulk(State::Overlay(Overlay { at: 0, ..o }), data(o.at))
        }
        Instruction::State(state) => Item::State(state),
        Instruction::Later => panic!("none was written"),
    }
}
