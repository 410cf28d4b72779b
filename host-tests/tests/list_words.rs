//! What is written is read back; what is damaged is refused or bounded.

mod items;

use host_tests::lists::writer::{FieldPacker, ListWriter, WriteError};
use items::{Random, item_of, random_item, write};
use scanbeam::list::*;

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
