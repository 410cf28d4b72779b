//! The table of sizes.

use host_tests::bench::table::between;
use host_tests::firmware::{BOARDS, Section, Sections, Symbols};
use host_tests::sizes::*;
use std::collections::BTreeMap;

#[test]
fn a_row_has_what_the_head_names() {
    let section = |bytes| Section { address: 0, bytes };
    let sections = Sections {
        text: section(50_123),
        rodata: section(1_500),
        fast: section(5_236),
        dma: section(1_280),
        ..Sections::default()
    };
    let size = ProgramSize {
        program: PROGRAMS[0],
        boards: vec![sections; BOARDS.len()],
        symbols: vec![Symbols::default(); BOARDS.len()],
    };
    assert!(
        size.largest().contains("  50,123  0 others"),
        "{}",
        size.largest()
    );
    let cells = size.cells();
    assert_eq!(cells.len(), head().len());
    assert_eq!(cells[1], "50,123");
    assert_eq!(cells[1 + BOARDS.len()], "1,500 / 1,500 / 1,500");
    assert_eq!(cells[2 + BOARDS.len()], "6,516");
    assert_eq!(size.to_json(true)["fast_bytes"], 6_516);
    let written = markdown(std::slice::from_ref(&size));
    assert!(written.contains("| Gouraud, plain | 50,123 |"), "{written}");
    let readme = include_str!("../../figures/tables.md");
    let new = between(readme, MARKERS, &written).unwrap();
    assert_eq!(between(&new, MARKERS, &written).unwrap(), new);
    assert_eq!(thousands(1_002_003), "1,002,003");
}

/// Kills: a row of a program that went, or has another name.
#[test]
fn the_table_has_the_programs_that_there_are() {
    let table = include_str!("../../figures/tables.md");
    let (_, table) = table.split_once(MARKERS[0]).unwrap();
    let (table, _) = table.split_once(MARKERS[1]).unwrap();
    let rows = table.lines().filter(|line| line.starts_with("| ")).skip(2);
    let rows: Vec<&str> = rows.filter_map(|line| line.split(" | ").next()).collect();
    let names = PROGRAMS.map(|program| format!("| {}", program.name));
    assert_eq!(rows, names);
}

/// Kills: a program that says nothing, says another checksum, or a picture that is not known.
#[test]
fn pictures_of_programs_are_known() {
    let known = BTreeMap::from([("a", 0x12), ("b", 0xffff_ffff)]);
    let said = |lines: &[&str]| {
        draws(
            &known,
            &lines.iter().map(|l| (*l).to_owned()).collect::<Vec<_>>(),
        )
    };
    assert!(said(&["picture a 00000012", "picture b ffffffff"]));
    for wrong in [
        &[][..],
        &["picture a 00000013"],
        &["picture c 00000012"],
        &["picture a 00000012", "panic"],
    ] {
        assert!(!said(wrong), "{wrong:?}");
    }
}
