//! What a scene costs on the boards, as a table and as JSON.

use super::Flashed;
use crate::firmware::{Measured, Toolchain};
use scene_flash::Kind;
use serde_json::{Value, json};
use std::error::Error;
use std::fmt::Display;
use std::path::Path;

/// Prints what was measured.
pub(super) fn print(
    file: &Path,
    flashed: &Flashed,
    toolchain: &Toolchain,
    boards: &[Measured],
    json: bool,
) -> Result<(), Box<dyn Error>> {
    if json {
        let report = report(file, flashed, toolchain, boards);
        say!("{}", serde_json::to_string_pretty(&report)?);
        return Ok(());
    }
    let shown = &flashed.shown;
    let [width, height] = shown.head.sent();
    say!("{}", toolchain.version);
    say!(
        "{}: {width} x {height}, {}, {} draw calls of {} triangles; models and textures take {} bytes of flash",
        file.display(),
        kind(shown.head.kind),
        shown.calls,
        shown.triangles,
        flashed.flash_bytes()
    );
    row(
        "board",
        [
            "instructions",
            "pass one",
            "median line",
            "worst line",
            "which",
            "slow bytes",
            "fast bytes",
            "line buffers",
        ],
        "",
    );
    for board in boards {
        let costs = Costs::of(board);
        let figure = |name| board.output.figures.get(name).copied().unwrap_or_default();
        let numbers = [
            costs.frame,
            costs.pass_one,
            costs.median,
            costs.worst.1,
            costs.worst.0 as u64,
            figure("slow_bytes"),
            figure("fast_bytes"),
            figure("line_bytes"),
        ];
        let verdict = match flashed.matches(board) {
            true => "same bits",
            false => "DIFFERS",
        };
        row(board.board.name, numbers, verdict);
    }
    Ok(())
}

/// Prints a row of the table.
fn row<T: Display>(name: &str, cells: [T; 8], verdict: &str) {
    let [a, b, c, d, e, f, g, h] = cells;
    let row = format!(
        "{name:7} {a:>12} {b:>10} {c:>11} {d:>10} {e:>5} {f:>10} {g:>10} {h:>12}  {verdict}"
    );
    say!("{}", row.trim_end());
}

/// All of it as JSON.
fn report(file: &Path, flashed: &Flashed, toolchain: &Toolchain, boards: &[Measured]) -> Value {
    let (shown, room) = (&flashed.shown, flashed.shown.head.room);
    let boards: Vec<Value> = boards.iter().map(|board| to_json(board, flashed)).collect();
    json!({
        "scene": file.display().to_string(),
        "toolchain": toolchain.version,
        "size": shown.head.sent(),
        "kind": kind(shown.head.kind),
        "draw_calls": shown.calls,
        "triangles": shown.triangles,
        "objects": room.objects,
        "vertices": room.vertices,
        "flash_bytes": flashed.flash_bytes(),
        "boards": boards,
    })
}

fn kind(kind: Kind) -> &'static str {
    match kind {
        Kind::Smooth => "smooth colours",
        Kind::Textured => "textures",
        Kind::Indexed => "palettes",
        Kind::Phong => "colours lit at each pixel",
        Kind::TexturedPhong => "textures lit at each pixel",
        Kind::ListSmooth => "a list of smooth colours",
        Kind::ListTextured => "a list with textures",
    }
}

/// Instructions, a line a transfer.
#[derive(Default)]
struct Costs {
    frame: u64,
    pass_one: u64,
    median: u64,
    /// Which line, and its instructions.
    worst: (usize, u64),
}

impl Costs {
    fn of(board: &Measured) -> Self {
        let frame = board.output.frames.first();
        let Some(run) = board.output.lines.first() else {
            return Self::default();
        };
        let mut costs = run.costs.clone();
        costs.sort_unstable();
        // Of several as dear the first.
        let worst = (run.costs.iter().copied().enumerate()).rev();
        Self {
            frame: frame.map_or(0, |frame| frame.instructions),
            pass_one: run.pass_one,
            median: costs.get(costs.len() / 2).copied().unwrap_or_default(),
            worst: worst.max_by_key(|(_, cost)| *cost).unwrap_or_default(),
        }
    }
}

fn to_json(board: &Measured, flashed: &Flashed) -> Value {
    let costs = Costs::of(board);
    let crc = board.output.frames.first().map(|frame| frame.crc);
    let figures = &board.output.figures;
    json!({
        "board": board.board.name,
        "target": board.board.target,
        "machine": board.board.machine,
        "crc_host": format!("{:08x}", flashed.shown.crc()),
        "crc_target": crc.map(|crc| format!("{crc:08x}")),
        "match": flashed.matches(board),
        "instructions": costs.frame,
        "pass_one": costs.pass_one,
        "median_line": costs.median,
        "worst_line": costs.worst.1,
        "worst_line_number": costs.worst.0,
        "slow_bytes": figures.get("slow_bytes"),
        "fast_bytes": figures.get("fast_bytes"),
        "line_bytes": figures.get("line_bytes"),
    })
}
