//! The figures as a table for people, and as tables of `host-tests/figures/tables.md` between two markers.

use super::{OnBoard, Row, missing};
use crate::figures::gate::Record;
use crate::firmware::BOARDS;
use crate::image_out::write_atomically;
use std::error::Error;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// The page that the tables are on.
pub fn page() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("figures/tables.md")
}

/// What stands before and after the tables there.
pub const MARKERS: [&str; 2] = [
    "<!-- bench: written by `bench --markdown` -->",
    "<!-- /bench -->",
];

/// Frames, as the record and as people call them.
const FRAMES: [(&str, &str); 5] = [
    ("sphere", "A: sphere of 2,048 triangles"),
    ("c_f2n", "C: 16 quads over the picture, far to near"),
    ("c_n2f", "C: the same, near to far"),
    ("teapot", "teapot, 2,256 triangles"),
    ("cube", "cube, 12 triangles"),
];

/// For the terminal.
pub fn text(rows: &[Row]) -> String {
    let mut out = format!(
        "{:8} {:20} {:>14} {:>9} {:>10} {:>9} {:>9}\n",
        "scene", "renderer", "instr/frame", "a pixel", "ms", "by clock", "by instr"
    );
    let some = |value: Option<f64>, digits: usize| {
        value.map_or("-".to_owned(), |value| format!("{value:.digits$}"))
    };
    for row in rows {
        // Writing to a string cannot fail.
        let _ = writeln!(
            out,
            "{:8} {:20} {:>14} {:>9} {:>10.3} {:>8.2}x {:>8}x",
            row.scene,
            row.renderer,
            some(row.instructions, 0),
            some(row.per_pixel(), 1),
            row.wall_ms,
            row.ratio,
            some(row.instructions_ratio, 2)
        );
    }
    out + &boards_text(rows)
}

/// Millions of instructions and times ours, a column for each board; nothing where none was run.
fn boards_text(rows: &[Row]) -> String {
    let mut out = String::new();
    let Some(first) = rows.first().filter(|row| !row.boards.is_empty()) else {
        return out;
    };
    let _ = write!(out, "\n{:8} {:20}", "scene", "renderer");
    for on in &first.boards {
        let _ = write!(
            out,
            " {:>12} {:>8}",
            format!("{}, M", on.board.name),
            "by instr"
        );
    }
    for row in rows {
        let _ = write!(out, "\n{:8} {:20}", row.scene, row.renderer);
        for [count, ratio] in row.boards.iter().map(OnBoard::cells) {
            let _ = write!(out, " {count:>12} {ratio:>7}x");
        }
    }
    out + "\n"
}

/// Rewrites what stands between the markers of a file.
pub(super) fn write(path: &Path, rows: &[Row]) -> Result<(), Box<dyn Error>> {
    let record = Record::read(&Record::path())?;
    rewrite(path, MARKERS, &markdown(rows, &record))
}

/// Writes a file anew, with something else between its markers.
pub(crate) fn rewrite(path: &Path, markers: [&str; 2], inner: &str) -> Result<(), Box<dyn Error>> {
    let new = between(&std::fs::read_to_string(path)?, markers, inner)?;
    write_atomically(path, new.as_bytes())?;
    Ok(())
}

/// The text with something else between its markers.
pub fn between(text: &str, [open, close]: [&str; 2], inner: &str) -> Result<String, String> {
    let missing = || format!("there is no `{open}` followed by `{close}`");
    let (before, rest) = text.split_once(open).ok_or_else(missing)?;
    let (_, after) = rest.split_once(close).ok_or_else(missing)?;
    Ok(format!("{before}{open}\n\n{inner}\n{close}{after}"))
}

/// For the page, with what is recorded of frames.
pub fn markdown(rows: &[Row], record: &Record) -> String {
    let millions =
        |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{:.2}", value / 1e6));
    let mut out = String::from(
        "Million instructions a frame on a microcontroller, in QEMU, everything included:\n\n",
    );
    out += "| scene | Cortex-M4 | Cortex-M3 | M0+ code |\n| --- | ---: | ---: | ---: |\n";
    for (frame, title) in FRAMES {
        let of = |board: &str| millions(record.latest(board, &format!("frame {frame}")));
        let cells: Vec<String> = BOARDS.iter().map(|board| of(board.name)).collect();
        let _ = writeln!(out, "| {title} | {} |", cells.join(" | "));
    }
    let shared: Vec<(&Row, &str)> = rows
        .iter()
        .filter(|row| rows.iter().filter(|other| other.scene == row.scene).count() > 1)
        .filter_map(|row| {
            let (_, title) = FRAMES.iter().find(|(frame, _)| *frame == row.scene)?;
            Some((row, *title))
        })
        .collect();
    if shared.iter().any(|(row, _)| !row.boards.is_empty()) {
        out += "\nBeside other renderers in Rust on the same boards, million instructions a frame, and how many times as many as ours they take. Ours sends one line a transfer here. A Cortex-M3 and an M0+ have no floating point unit, which the others are made for. euc takes depth by fused multiply-adds, which without `std` are made of many instructions each.\n\n";
        out += "| scene | renderer | Cortex-M4 | times ours | Cortex-M3 | times ours | M0+ code | times ours |\n| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |\n";
        for (row, title) in &shared {
            let cells: Vec<String> = row.boards.iter().flat_map(OnBoard::cells).collect();
            let _ = writeln!(
                out,
                "| {title} | {} | {} |",
                row.renderer,
                cells.join(" | ")
            );
        }
        for reason in missing(rows) {
            let _ = writeln!(out, "\nNot measured: {reason}.");
        }
    }
    out += "\nThe same on x86-64, with the time that they take:\n\n";
    out += "| scene | renderer | instructions | times ours | time, times ours |\n| --- | --- | ---: | ---: | ---: |\n";
    for (row, title) in shared {
        let _ = writeln!(
            out,
            "| {title} | {} | {} | {} | {:.1} |",
            row.renderer,
            millions(row.instructions),
            row.instructions_ratio
                .map_or("-".to_owned(), |ratio| format!("{ratio:.1}")),
            row.ratio
        );
    }
    out
}
