//! The tables of renderers.

use host_tests::bench::table::*;
use host_tests::bench::{Counted, OnBoard, Row};
use host_tests::figures::gate::Record;
use host_tests::firmware::BOARDS;

fn row(renderer: &'static str, instructions: f64) -> Row {
    Row {
        scene: "sphere",
        renderer,
        instructions: Some(instructions),
        pixels: 100,
        wall_ms: 1.0,
        ratio: 2.5,
        instructions_ratio: Some(2.0),
        boards: Vec::new(),
    }
}

/// On the first board counted, on the others not.
fn on_boards(row: Row, instructions: f64, ratio: f64) -> Row {
    let counted = |first: bool| {
        let counted = Counted {
            instructions,
            pixels: 100,
            ratio: Some(ratio),
        };
        first.then_some(counted).ok_or("no QEMU".to_owned())
    };
    let boards = BOARDS.map(|board| OnBoard {
        board,
        counted: counted(board == BOARDS[0]),
    });
    Row {
        boards: boards.to_vec(),
        ..row
    }
}

#[test]
fn boards_stand_beside_the_host() {
    let rows = [
        on_boards(row("scanbeam", 1.5e6), 2e6, 1.0),
        on_boards(row("other", 3e6), 9e6, 4.5),
    ];
    let text = text(&rows);
    assert!(text.contains("m4, M") && text.contains("4.5x"), "{text}");
    let inner = markdown(&rows, &Record::default());
    let line = "| A: sphere of 2,048 triangles | other | 9.00 | 4.5 | - | - | - | - |";
    assert!(inner.contains(line), "{inner}");
    assert_eq!(
        inner.matches("Not measured: no QEMU.").count(),
        1,
        "{inner}"
    );
    assert!(inner.contains("| other | 3.00 | 2.0 | 2.5 |"), "{inner}");
}

#[test]
fn tables_replace_what_is_between_the_markers() {
    let [open, close] = MARKERS;
    let rows = [row("scanbeam", 1.5e6), row("other", 3e6)];
    let inner = markdown(&rows, &Record::default());
    let text = format!("a\n{open}\nold\n{close}\nb\n");
    let new = between(&text, MARKERS, &inner).unwrap();
    assert!(new.starts_with("a\n") && new.ends_with("\nb\n") && !new.contains("old"));
    assert!(new.contains("| other | 3.00 | 2.0 | 2.5 |"), "{new}");
    assert_eq!(between(&new, MARKERS, &inner).unwrap(), new);
    assert!(between("nothing", MARKERS, &inner).is_err());
    let readme = include_str!("../../figures/tables.md");
    assert!(between(readme, MARKERS, &inner).is_ok());
}

#[test]
fn figures_stand_in_the_table() {
    let text = text(&[row("scanbeam", 1.5e6)]);
    assert!(
        text.contains("1500000") && text.contains("15000.0"),
        "{text}"
    );
}
