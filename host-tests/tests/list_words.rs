//! What is written is read back; what is damaged is refused or bounded.

use host_tests::lists::writer::{FieldPacker, Form, ListWriter, WriteError};
use scanbeam::list::*;

/// A small generator with no dependency: the same numbers everywhere.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u32 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let x = (self.0 >> 33) as u32 ^ (self.0 >> 45) as u32;
        x.wrapping_mul(0x9E37_79B9).rotate_left(13)
    }

    fn below(&mut self, n: u32) -> u32 {
        ((u64::from(self.next()) * u64::from(n)) >> 32) as u32
    }

    fn flag(&mut self) -> bool {
        self.below(2) == 1
    }

    fn mantissa(&mut self) -> i32 {
        (self.next() as i32) >> (2 + self.below(20))
    }
}

/// A block with its data, apart from where it lies.
#[derive(Clone, Debug, PartialEq)]
enum Item {
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

fn random_item(r: &mut Random, format: &mut VertexFormat, kept: &mut Option<Header>) -> Item {
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

fn write(writer: &mut ListWriter<'_>, item: &Item) -> Result<(), WriteError> {
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
fn item_of(list: &[u32], at: u32, parsed: &Parsed) -> Item {
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

#[test]
fn what_is_written_is_read_back() {
    let mut memory = std::vec![0; 1 << 17];
    let mut kinds = std::collections::HashSet::new();
    for seed in 0..300 {
        let mut r = Random(seed);
        let mut writer = ListWriter::new(&mut memory);
        let (mut format, mut kept) = (VertexFormat::default(), None);
        let mut items = Vec::new();
        for _ in 0..20 {
            let item = random_item(&mut r, &mut format, &mut kept);
            let before = writer.words().to_vec();
            match write(&mut writer, &item) {
                Ok(()) => items.push(item),
                Err(WriteError::Full { .. }) => {
                    assert_eq!(writer.words(), before);
                    break;
                }
                Err(other) => panic!("{item:?}: {other}"),
            }
        }
        let list = writer.words();
        let (mut at, mut format) = (0, VertexFormat::default());
        for item in &items {
            let parsed = read_block(list, at, &format).unwrap_or_else(|e| panic!("{item:?}: {e}"));
            assert_eq!(item_of(list, at, &parsed), *item);
            if let Instruction::State(State::Format(f)) = parsed.instruction {
                format = f;
            }
            kinds.insert(list[at as usize] >> 28);
            at += parsed.words;
        }
        assert_eq!(at as usize, list.len());
    }
    assert_eq!(kinds.len(), 9, "every kind was among them");
}

/// Walks until it halts for good or the budget is spent; how often it was called.
fn walk(list: &[u32], budget: Budget) -> (u32, Result<Halt, ListError>) {
    let mut walker = Walker::new();
    walker.command(ListCommand::Start(0));
    let mut left = budget;
    for calls in 1.. {
        match walker.step(list, &mut left) {
            Ok(Step::Halt(Halt::Sync)) => {}
            Ok(Step::Halt(Halt::Paused)) => walker.command(ListCommand::Resume),
            Ok(Step::Halt(halt)) => return (calls, Ok(halt)),
            Ok(_) => {}
            Err(error) => return (calls, Err(error)),
        }
    }
    unreachable!()
}

#[test]
fn damaged_lists_are_refused_or_end_within_the_budget() {
    let budget = Budget {
        instructions: 200,
        vertices: 100_000,
        jumps: 20,
    };
    let mut memory = std::vec![0; 1 << 17];
    let (mut cuts, mut refused, mut flips) = (0, 0, 0);
    for seed in 0..60 {
        let mut r = Random(1000 + seed);
        let mut writer = ListWriter::new(&mut memory);
        let (mut format, mut kept) = (VertexFormat::default(), None);
        for _ in 0..8 {
            let item = random_item(&mut r, &mut format, &mut kept);
            let _ = write(&mut writer, &item);
        }
        let list = writer.words().to_vec();
        let mut ends = std::collections::HashSet::new();
        let (mut at, mut format) = (0, VertexFormat::default());
        while let Ok(parsed) = read_block(&list[..], at, &format) {
            ends.insert(at as usize);
            if let Instruction::State(State::Format(f)) = parsed.instruction {
                format = f;
            }
            at += parsed.words;
        }
        assert_eq!(at as usize, list.len());
        for len in (0..list.len()).step_by(1 + list.len() / 3000) {
            cuts += 1;
            let (calls, end) = walk(&list[..len], budget);
            assert!(calls <= budget.instructions + 1);
            match end {
                Ok(Halt::End) => assert!(len == 0 || ends.contains(&len)),
                Err(error) => {
                    refused += 1;
                    assert!(error.offset as usize <= 4 * len, "{error}");
                    assert!(std::format!("{error}").starts_with("list: offset 0x"));
                }
                other => panic!("{other:?}"),
            }
        }
        for bit in 0..(32 * list.len()).min(4000) {
            flips += 1;
            let mut list = list.clone();
            list[bit / 32] ^= 1 << (bit % 32);
            let (calls, _) = walk(&list, budget);
            assert!(calls <= budget.instructions + 1);
        }
    }
    assert!(
        cuts > 10_000 && refused > 10_000 && flips > 100_000,
        "{cuts} {refused} {flips}"
    );
}

#[test]
fn jumps_stay_within_the_list_and_the_budget() {
    let mut memory = [0; 16];
    let mut writer = ListWriter::new(&mut memory);
    writer.flow(Flow::JumpRelative(1)).unwrap();
    writer.flow(Flow::Pause).unwrap();
    writer.flow(Flow::JumpRelative(-5)).unwrap();
    // Round and round past the PAUSE: 0, 3, 0, 3 ...
    let mut list = writer.words().to_vec();
    let (calls, halt) = walk(&list, Budget::of(50));
    assert_eq!((calls, halt), (51, Ok(Halt::Budget)));
    // Into the middle of a block, where a 1 stands.
    list[4] = -4i32 as u32;
    let error = walk(&list, Budget::of(50)).1.unwrap_err();
    assert_eq!((error.offset, error.reason), (4, Reason::Version(0)));
    for to in [6, 7, 1 << 30, u32::MAX] {
        let mut writer = ListWriter::new(&mut memory);
        writer.flow(Flow::Jump(to)).unwrap();
        writer.flow(Flow::End).unwrap();
        let list = writer.words().to_vec();
        let mut walker = Walker::new();
        walker.command(ListCommand::Start(0));
        let mut budget = Budget::of(9);
        let first = walker.step(&list[..], &mut budget);
        assert_eq!(first, Ok(Step::Violation), "{to}");
        let second = walker.step(&list[..], &mut budget);
        assert_eq!(second, Ok(Step::Halt(Halt::End)));
    }
    for by in [i32::MIN, -3, 1, i32::MAX] {
        let mut writer = ListWriter::new(&mut memory);
        writer.flow(Flow::JumpRelative(by)).unwrap();
        let list = writer.words().to_vec();
        let mut walker = Walker::new();
        walker.command(ListCommand::Start(0));
        let step = walker.step(&list[..], &mut Budget::of(9));
        assert_eq!(step, Ok(Step::Violation), "{by}");
    }
}

#[test]
fn commands_start_step_and_stop() {
    let mut memory = [0; 16];
    let mut writer = ListWriter::new(&mut memory);
    writer.flow(Flow::Interrupt(7)).unwrap();
    writer.flow(Flow::Interrupt(8)).unwrap();
    writer.flow(Flow::End).unwrap();
    let list = writer.words();
    let control = ListControl::new();
    let mut walker = Walker::new();
    let mut budget = Budget::of(100);
    let mut obey = |walker: &mut Walker, command| {
        control.send(command);
        walker.command(control.take().unwrap());
        assert_eq!(control.take(), None);
        walker.step(list, &mut budget).unwrap()
    };
    use ListCommand::{Restart, Resume, Start, Step as One, StopAtEnd, StopNow};
    assert_eq!(obey(&mut walker, StopNow), Step::Halt(Halt::Stopped));
    assert_eq!(obey(&mut walker, Start(1)), Step::Interrupt(8));
    assert_eq!(obey(&mut walker, StopNow), Step::Halt(Halt::Stopped));
    assert_eq!(obey(&mut walker, Resume), Step::Halt(Halt::End));
    assert_eq!(obey(&mut walker, Restart), Step::Interrupt(8));
    assert_eq!(obey(&mut walker, Start(0)), Step::Interrupt(7));
    assert_eq!(obey(&mut walker, One), Step::Interrupt(8));
    assert_eq!(obey(&mut walker, StopAtEnd), Step::Halt(Halt::Stepped));
    assert_eq!(obey(&mut walker, Resume), Step::Halt(Halt::End));
    assert_eq!(obey(&mut walker, Start(77)), Step::Violation);
}

#[test]
fn columns_hold_what_was_packed() {
    let mut r = Random(5);
    for form in FieldForm::ALL {
        for count in [0u16, 1, 2, 3, 4, 5, 8, 31] {
            let ranges: [(i64, i64); 3] = match form {
                FieldForm::U8x4 | FieldForm::U8x3 => [(0, 255); 3],
                FieldForm::S8x3 => [(-128, 127); 3],
                FieldForm::S10x3 => [(-1024, 1023), (-1024, 1023), (-512, 511)],
                FieldForm::S16x3 => [(-32768, 32767); 3],
                FieldForm::U16x2 => [(0, 65535), (0, 65535), (0, 0)],
                FieldForm::U32x1 => [(i64::from(i32::MIN), i64::from(i32::MAX)), (0, 0), (0, 0)],
                FieldForm::S32x3 => [(i64::from(i32::MIN), i64::from(i32::MAX)); 3],
            };
            let values: Vec<[i32; 3]> = (0..count)
                .map(|_| {
                    ranges.map(|(low, high)| {
                        let span = (high - low + 1) as u64;
                        let part = (u64::from(r.next()) * span) >> 32;
                        (low + part as i64) as i32
                    })
                })
                .collect();
            let (mut column, mut vertices) = (Vec::new(), Vec::new());
            let mut packer = FieldPacker::new(|w| column.push(w));
            for v in &values {
                packer.field(form, [v[0], v[1], v[2], 0]);
            }
            packer.align();
            let mut packer = FieldPacker::new(|w| vertices.push(w));
            for v in &values {
                packer.field(form, [v[0], v[1], v[2], 0]);
                packer.align();
            }
            assert_eq!(column.len() as u32, form.column_words(count));
            assert_eq!(vertices.len() as u32, form.words() * u32::from(count));
            let slot = Slot { form, word: 0 };
            let mut got = std::vec![[0; 3]; usize::from(count)];
            slot.column(&column[..], 0, &mut got, |_, v| v);
            assert_eq!(got, values, "{form:?}");
            let each = form.words();
            let got: Vec<_> = (0..u32::from(count))
                .map(|i| slot.field(&vertices[..], i * each))
                .collect();
            assert_eq!(got, values, "{form:?}");
        }
    }
}
