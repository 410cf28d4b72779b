//! Streams that are right and streams with one fault each, what is read, and what is printed.

use host_tests::boards::chips::{Bench, CHIPS, Limits};
use host_tests::boards::outcome::Outcome;
use host_tests::boards::wire::{self, Event, Figures, Use};
use host_tests::boards::{Expected, table};

/// A window of this many bytes is the whole picture.
const FRAME_BYTES: usize = 320 * 240 * 2;

/// A frame that is different in each byte pair and each frame.
fn frame(number: usize) -> Vec<u8> {
    (0..FRAME_BYTES)
        .map(|i| (i / 2 * 7 + i + number) as u8)
        .collect()
}

fn hex(bytes: &[u8]) -> String {
    let digit = |value: u8| char::from(b"0123456789abcdef"[usize::from(value)]);
    let digits = bytes.iter().flat_map(|byte| [byte >> 4, byte & 15]);
    digits.map(digit).collect()
}

fn expected() -> Expected {
    let sum = |number| crc32fast::hash(&frame(number));
    Expected::of(vec![sum(0), sum(1)])
}

/// What an emulator prints of a board that does as it should: a line each.
fn good() -> Vec<String> {
    let mut lines = Vec::new();
    let mut micros = 10_000;
    let mut frames = (0..2).map(frame);
    let mut cycles = 0;
    for command in expected().commands {
        micros += 120_000;
        lines.push(format!("time {micros}"));
        if command[0] == 0x2C {
            lines.push(format!(
                "figures {cycles} {} {} {}",
                cycles / 2,
                cycles / 4,
                cycles / 100
            ));
            cycles += 1_000_000;
        }
        lines.push(format!("data 0 {:02x}", command[0]));
        if command.len() > 1 {
            lines.push(format!("data 1 {}", hex(&command[1..])));
        }
        let frame = if command[0] == 0x2C {
            frames.next()
        } else {
            None
        };
        if let Some(frame) = frame {
            let chunks = frame
                .chunks(4096)
                .map(|chunk| format!("data 1 {}", hex(chunk)));
            lines.extend(chunks);
        }
    }
    lines.extend(["clock 125000000", "note done", "end frames"].map(str::to_owned));
    lines
}

fn judged(lines: &[String]) -> Outcome {
    Outcome::of("board", &lines.join("\n"), &expected())
}

/// The good stream with its first line that is `from` replaced.
fn with(from: &str, to: &[&str]) -> Outcome {
    let mut lines = good();
    let at = lines.iter().position(|line| line == from);
    let at = at.unwrap_or_else(|| panic!("no line `{from}`"));
    lines.splice(at..=at, to.iter().map(|line| (*line).to_owned()));
    judged(&lines)
}

/// The good stream with the first frame's bytes changed.
fn with_frame(change: impl FnOnce(&mut Vec<u8>)) -> Outcome {
    let mut bytes = frame(0);
    change(&mut bytes);
    let mut lines = good();
    let first = lines.iter().position(|line| line.len() > 4096).unwrap();
    let count = FRAME_BYTES.div_ceil(4096);
    lines.splice(first..first + count, [format!("data 1 {}", hex(&bytes))]);
    judged(&lines)
}

fn complains_of(outcome: &Outcome, text: &str) {
    assert!(!outcome.is_good(), "{text}");
    let said = outcome
        .complaints
        .iter()
        .any(|complaint| complaint.contains(text));
    assert!(said, "`{text}` is not in {:?}", outcome.complaints);
}

#[test]
fn a_board_that_sends_what_it_should_is_good() {
    let outcome = judged(&good());
    assert!(outcome.is_good(), "{outcome:?}");
    assert_eq!(outcome.frames, 2);
    assert_eq!(outcome.cycles_per_frame, Some(1_000_000));
    assert_eq!(outcome.bus_cycles, Some(500_000));
    assert_eq!(outcome.wait_cycles, Some(250_000));
    assert_eq!(outcome.xip_misses, Some(10_000));
    assert_eq!(outcome.fps, Some(125.0));
    assert_eq!(outcome.notes, ["done"]);
}

#[test]
fn a_command_that_is_dropped_added_or_changed_is_seen() {
    for (from, to) in [
        ("data 0 11", &[][..]),
        ("data 0 29", &[]),
        ("data 1 55", &[]),
        ("data 1 28", &["data 1 48"]),
        ("data 0 36", &["data 0 36", "data 1 28", "data 0 36"]),
        ("data 1 000000ef", &["data 1 000000ee"]),
    ] {
        let outcome = with(from, to);
        assert!(
            !outcome.commands_match && !outcome.is_good(),
            "{from}: {outcome:?}"
        );
    }
}

#[test]
fn a_panel_that_stays_dark_complains() {
    complains_of(&with("data 0 11", &[]), "sleeps");
    complains_of(&with("data 0 29", &[]), "switched off");
    complains_of(&with("data 1 55", &["data 1 66"]), "format");
    complains_of(&with("data 0 29", &["data 0 29", "data 0 01"]), "sleeps");
    complains_of(&with("data 1 28", &["data 1 2828"]), "2 bytes of data");
    complains_of(&with("data 0 36", &["data 0 37"]), "unknown command 37");
    complains_of(&with("data 1 0000013f", &["data 1 00000140"]), "0 to 320");
    complains_of(&with("data 1 0000013f", &["data 1 013f0000"]), "319 to 0");
}

#[test]
fn a_command_that_comes_too_early_is_complained_of() {
    complains_of(&with("time 130000", &["time 4000"]), "01 comes too early");
    complains_of(&with("time 250000", &["time 249999"]), "11 comes too early");
    complains_of(&with("time 370000", &["time 254000"]), "3a comes too early");
}

#[test]
fn pixels_beyond_short_or_halved_are_complained_of() {
    complains_of(&with_frame(|bytes| bytes.push(0)), "beyond the window");
    complains_of(
        &with_frame(|bytes| bytes.truncate(2000)),
        "short of 75800 pixels",
    );
    complains_of(
        &with_frame(|bytes| bytes.truncate(FRAME_BYTES - 1)),
        "half a pixel",
    );
}

#[test]
fn pixels_in_another_order_are_not_the_hosts() {
    let swapped = with_frame(|bytes| bytes.chunks_exact_mut(2).for_each(<[u8]>::reverse));
    let late = with_frame(|bytes| bytes.rotate_right(1));
    for outcome in [swapped, late] {
        assert!(!outcome.crc_match && !outcome.is_good());
        assert!(
            outcome.commands_match && outcome.complaints.is_empty(),
            "{outcome:?}"
        );
    }
}

#[test]
fn a_panel_that_is_fed_from_memory_gets_pictures_alone() {
    let wanted = expected().without_commands();
    let lines = |size: &str, first: &[u8]| {
        let second = hex(&frame(1));
        format!(
            "picture {size} {}\npicture 320 240 {second}\nend frames",
            hex(first)
        )
    };
    let judged = |text: &str| Outcome::of("board", text, &wanted);
    let good = judged(&lines("320 240", &frame(0)));
    assert!(good.is_good() && good.frames == 2, "{good:?}");
    let other = judged(&lines("320 240", &frame(2)));
    assert!(!other.crc_match && !other.is_good());
    complains_of(&judged(&lines("240 320", &frame(0))), "240 x 320 pixels");
    complains_of(
        &judged(&lines("320 240", &frame(0)[2..])),
        "in 153598 bytes",
    );
    let told = format!("data 0 29\n{}", lines("320 240", &frame(0)));
    assert!(!judged(&told).commands_match);
}

#[test]
fn a_run_that_ends_early_or_says_nonsense_is_not_good() {
    complains_of(&with("end frames", &[]), "cut short");
    complains_of(
        &with("end frames", &["end nothing more came"]),
        "nothing more came",
    );
    complains_of(
        &with("data 0 29", &["data 0 29", "fault D/C changed"]),
        "D/C changed",
    );
    complains_of(&with("data 0 29", &["data 0 29", "oops"]), "unknown word");
    let last = with("time 130000", &["end frames"]);
    assert!(last.commands_match, "what comes after the end counts");
    assert!(!judged(&[]).is_good() && judged(&[]).frames == 0);
    // A frame fewer than asked for.
    let lines = good();
    let end = lines.iter().rposition(|line| line.len() > 4096).unwrap();
    let outcome = judged(&[&lines[..end], &["end frames".into()]].concat());
    assert!(!outcome.crc_match && !outcome.is_good());
}

#[test]
fn what_is_read_is_kept() {
    let outcome = with("note done", &["use 16 1 2", "use 24 3 4"]);
    let addresses: Vec<u64> = outcome.uses.iter().map(|used| used.address).collect();
    assert_eq!(addresses, [16, 24]);
}

/// Each limit is held by itself, and a run that is silent of what is limited has not kept to it.
///
/// Kills: a limit that is not looked at, `<` in place of `<=`, a bus that may be slower, silence that is taken for good.
#[test]
fn limits_of_chips_are_held() {
    let said = ["bus 62500000", "stack 4096", "divisions 30"];
    let outcome = with("note done", &said);
    let frames = outcome.frames as u64;
    assert!(frames > 1 && 30 / frames > 1);
    let none = Limits::default();
    let misses = |most| Limits {
        misses: Some(most),
        ..none
    };
    let bus = |hertz| Limits {
        bus_hz: Some(hertz),
        ..none
    };
    let stack = |most| Limits {
        stack: Some(most),
        ..none
    };
    let divisions = |most| Limits {
        divisions: Some(most),
        ..none
    };
    // A frame has 10,000 misses.
    for (limits, is_good) in [
        (none, true),
        (misses(10_000), true),
        (misses(9_999), false),
        (bus(62_500_000), true),
        (bus(62_500_001), false),
        (bus(31_250_000), false),
        (stack(4_096), true),
        (stack(4_095), false),
        (divisions(30 / frames), true),
        (divisions(30 / frames - 1), false),
    ] {
        let mut held = outcome.clone();
        held.hold(limits);
        assert_eq!(held.is_good(), is_good, "{limits:?}");
    }
    let silent = with("note done", &[]);
    for limits in [bus(1), stack(u64::MAX), divisions(u64::MAX)] {
        let mut held = silent.clone();
        held.hold(limits);
        assert_eq!(held.complaints.len(), 1, "{limits:?}");
    }
    let mut without = Outcome::skipped("none", "it is missing".into());
    without.hold(stack(0));
    assert!(without.is_good());
}

#[test]
fn lines_are_read_whole_or_refused() {
    let figures = Figures {
        cycles: 1,
        bus: 2,
        wait: 3,
        misses: 4,
    };
    assert_eq!(wire::parse("figures 1 2 3 4"), Ok(Event::Figures(figures)));
    let used = Use {
        address: 0x1000_0000,
        misses: 2,
        returns: 3,
    };
    assert_eq!(wire::parse("use 268435456 2 3"), Ok(Event::Use(used)));
    let bytes = vec![0xAB, 0];
    let data = Event::Data {
        is_data: true,
        bytes,
    };
    assert_eq!(wire::parse("data 1 AB00"), Ok(data));
    for line in [
        "",
        "time",
        "time -1",
        "figures 1 2 3",
        "figures 1 2 3 4 5",
        "data 2 00",
        "data 1 0",
        "data 1 0g",
        "data 1 +1",
        "data",
        "Time 3",
        "picture 1 1",
        "picture 1 1 0",
        "picture 1 x 00",
        "use 1 2",
        "use 1 2 3 4",
        "use x 2 3",
    ] {
        assert!(wire::parse(line).is_err(), "{line}");
    }
}

#[test]
fn the_report_has_the_keys_that_it_promises() {
    let outcomes = [
        judged(&good()),
        Outcome::skipped("none", "it is missing".into()),
    ];
    assert!(outcomes[1].is_good() && !outcomes[1].ran);
    for outcome in &outcomes {
        let value = serde_json::to_value(outcome).unwrap();
        let keys: Vec<_> = value.as_object().unwrap().keys().cloned().collect();
        let mut wanted = [
            "board",
            "ran",
            "frames",
            "crc_match",
            "commands_match",
            "complaints",
            "cycles_per_frame",
            "bus_cycles",
            "wait_cycles",
            "xip_misses",
            "fps",
            "bus_hz",
            "stack_bytes",
            "divisions",
        ];
        wanted.sort_unstable();
        assert_eq!(keys, wanted);
        assert!(value["complaints"].is_array());
    }
    assert_eq!(
        serde_json::to_value(&outcomes[1]).unwrap()["fps"],
        serde_json::Value::Null
    );
    let text = table(&outcomes).to_string();
    assert!(
        text.contains("SKIPPED") && text.contains("125.00"),
        "{text}"
    );
}

#[test]
fn what_is_missing_is_named() {
    let nowhere = tempfile::tempdir().unwrap();
    let bench = Bench::new(Some(nowhere.path()), Some(nowhere.path()), 2, 56);
    for chip in CHIPS {
        let missing = chip.command(&bench).unwrap_err();
        assert!(
            missing.contains(chip.program) && missing.contains("not built"),
            "{missing}"
        );
        let elf = nowhere
            .path()
            .join(chip.target)
            .join("release")
            .join(chip.program);
        std::fs::create_dir_all(elf.parent().unwrap()).unwrap();
        std::fs::write(elf, []).unwrap();
    }
    let missing = |name| {
        let chip = CHIPS.into_iter().find(|chip| chip.name == name).unwrap();
        chip.command(&bench).unwrap_err()
    };
    assert_eq!(missing("stm32f4"), "unicorn is missing");
}
