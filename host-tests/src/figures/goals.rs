//! What frames and single things cost beside what they were meant to, as a table.
//!
//! `figures/goals.md` has it between two markers; `firmware --bench --bless` writes it, and a test says that it is what
//! the record has.

use super::gate::Record;
use crate::bench::table::rewrite;
use crate::firmware::{BOARDS, workspace};
use std::error::Error;
use std::fmt::Write as _;

/// What stands before and after the table.
pub const MARKERS: [&str; 2] = [
    "<!-- goals: written by `firmware --bench --bless` -->",
    "<!-- /goals -->",
];

/// A goal on the boards M4, M3 and M0+; none where none was said.
type Goal = (&'static str, &'static str, [Option<f64>; 3]);

/// Frames, in million instructions.
const FRAMES: [Goal; 9] = [
    ("frame a", "A", [Some(0.88), Some(0.92), Some(1.6)]),
    ("frame b", "B, lit", [Some(1.6), Some(1.65), Some(2.8)]),
    (
        "frame b_unlit",
        "B, unlit",
        [Some(1.1), Some(1.15), Some(2.2)],
    ),
    (
        "frame c_f2n",
        "C, far to near",
        [Some(0.6), Some(0.6), Some(1.0)],
    ),
    (
        "frame c_n2f",
        "C, near to far",
        [Some(0.6), Some(0.6), Some(1.0)],
    ),
    ("frame f", "F", [Some(1.3), Some(1.35), Some(2.9)]),
    ("frame g", "G", [Some(2.4), Some(2.5), Some(4.6)]),
    (
        "frame teapot",
        "teapot",
        [Some(1.6), Some(1.65), Some(2.75)],
    ),
    ("frame inside", "inside", [Some(5.0), Some(5.0), Some(10.0)]),
];

/// Single things, in instructions.
const THINGS: [Goal; 9] = [
    (
        "unit vertex",
        "a vertex: moved, projected, lit",
        [Some(100.0), None, Some(235.0)],
    ),
    (
        "unit triangle_culled",
        "a face that is turned away",
        [Some(35.0), None, None],
    ),
    (
        "unit triangle_filed",
        "a face that is filed",
        [Some(85.0), None, None],
    ),
    (
        "unit triangle_setup_small",
        "set-up of a small triangle",
        [Some(260.0), None, Some(480.0)],
    ),
    (
        "unit triangle_setup_textured",
        "set-up of a textured one",
        [Some(310.0), None, None],
    ),
    (
        "unit span",
        "a span, but for its pixels",
        [Some(56.0), None, Some(66.0)],
    ),
    (
        "unit slotless_line",
        "a triangle without a slot, a line",
        [Some(500.0), None, Some(795.0)],
    ),
    (
        "kernel texel_lit_565 pixel",
        "a texel in white light",
        [Some(12.6), None, Some(33.6)],
    ),
    (
        "kernel flat_565_large pixel",
        "a pixel of one colour",
        [Some(0.4), None, None],
    ),
];

fn rows(out: &mut String, record: &Record, goals: &[Goal], unit: f64, digits: usize) {
    for (name, title, wanted) in goals {
        let cells = BOARDS.iter().zip(wanted).map(|(board, wanted)| {
            let number = |value: f64| format!("{value:.digits$}");
            let now = record.latest(board.name, name).map(|value| value / unit);
            let now = now.map_or("-".to_owned(), number);
            wanted.map_or(now.clone(), |wanted| format!("{now} / {}", number(wanted)))
        });
        let cells: Vec<String> = cells.collect();
        // Writing to a string cannot fail.
        let _ = writeln!(out, "| {title} | {} |", cells.join(" | "));
    }
}

/// The table, of what is recorded.
pub fn markdown(record: &Record) -> String {
    let head =
        |what: &str| format!("| {what} | M4 | M3 | M0+ code |\n| --- | ---: | ---: | ---: |\n");
    let mut out = head("frame, million instructions");
    rows(&mut out, record, &FRAMES, 1e6, 2);
    out += "\n";
    out += &head("instructions");
    rows(&mut out, record, &THINGS, 1.0, 1);
    out
}

/// Writes the tables anew.
///
/// # Errors
/// When the file has no markers, or cannot be read or written.
pub fn write(record: &Record) -> Result<(), Box<dyn Error>> {
    let path = workspace().join("host-tests/figures/goals.md");
    rewrite(&path, MARKERS, &markdown(record))
}
