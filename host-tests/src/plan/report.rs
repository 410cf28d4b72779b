//! What a scene needs, as a table and as JSON.

use super::chips::CHIPS;
use super::{BOUND, FEW, OnBoard, Plan, Row};
use crate::flashed::memory::line_bytes;
use serde_json::{Value, json};
use std::error::Error;
use std::fmt::Display;
use std::path::Path;

/// Prints a plan.
pub(super) fn print(file: &Path, plan: &Plan, json: bool) -> Result<(), Box<dyn Error>> {
    if json {
        say!("{}", serde_json::to_string_pretty(&report(file, plan))?);
        return Ok(());
    }
    let shown = &plan.flashed.shown;
    let [width, height] = shown.head.sent();
    say!(
        "{}: {width} x {height}, {} draw calls of {} triangles; models and textures take {} bytes of flash",
        file.display(),
        shown.calls,
        shown.triangles,
        plan.flashed.flash_bytes()
    );
    match &plan.program {
        Some(program) => say!("program: {}; costs of {}", program.name, plan.release),
        None => say!("program: none on record; costs of {}", plan.release),
    }
    cores(plan);
    slots(plan);
    frames(plan);
    Ok(())
}

/// A figure, or a dash.
fn or_dash<T: Display>(figure: Option<T>) -> String {
    figure.map_or_else(|| "-".to_owned(), |figure| figure.to_string())
}

/// A row for each core.
fn cores(plan: &Plan) {
    let (slots, lines) = (plan.slots, line_bytes(&plan.flashed.shown.head));
    say!(
        "core    code bytes slow bytes fast bytes line buffers  instructions a frame, {slots} slots"
    );
    let at_most = if plan.flashed.is_list() { "<=" } else { "" };
    for board in &plan.boards {
        let slow = format!("{at_most}{}", board.slow_bytes);
        let reckoned = match (board.reckoned, plan.beyond) {
            (Some(reckoned), _) => {
                let bound = match reckoned.is_within {
                    true => format!("within {:.0} %", 100.0 * BOUND),
                    false => "no bound is known".to_owned(),
                };
                format!("{:.0}, {bound}", reckoned.instructions)
            }
            (None, what) => format!("not reckoned: {}", what.unwrap_or("no costs")),
        };
        say!(
            "{:7} {:>10} {slow:>10} {:>10} {lines:>12}  {reckoned}",
            board.name,
            or_dash(board.code),
            plan.fast_bytes,
        );
    }
}

/// A row for each number of slots, up to that with which none is missing.
fn slots(plan: &Plan) {
    say!(
        "slots   bytes   in use   spans without one, of {}",
        spans(plan)
    );
    for row in rows(plan) {
        let (slots, bytes, peak) = (row.slots, row.cache_bytes, row.peak);
        say!("{slots:>5} {bytes:>7} {peak:>8} {:>9}", row.without);
    }
    match plan.enough() {
        Some(row) => say!(
            "{} slots are enough: no more than {:.0} % of the spans are drawn without one",
            row.slots,
            100.0 * FEW
        ),
        None => say!("no number of slots is enough"),
    }
}

fn spans(plan: &Plan) -> u32 {
    plan.rows.first().map_or(0, |row| row.spans)
}

/// Those up to the first with which none is missing.
fn rows(plan: &Plan) -> &[Row] {
    let full = plan.rows.iter().position(|row| row.without == 0);
    let count = full.map_or(plan.rows.len(), |full| full + 1);
    plan.rows.get(..count).unwrap_or_default()
}

/// Frames a second on each chip.
fn frames(plan: &Plan) {
    say!(
        "frames a second, at most: at one instruction a cycle, and by the bus alone at 16 bits a pixel"
    );
    for chip in CHIPS {
        let bus = chip.by_bus(plan.flashed.shown.head.sent());
        let clock =
            instructions(plan, chip.core).map(|count| format!("{:.1}", chip.by_clock(count)));
        say!(
            "{}: {} at {} MHz, bus {bus:.1} at {:.1} MHz",
            chip.name,
            or_dash(clock),
            chip.clock / 1_000_000,
            f64::from(chip.bus) / 1e6
        );
    }
}

fn instructions(plan: &Plan, core: &str) -> Option<f64> {
    let board = plan.boards.iter().find(|board| board.name == core);
    board?.reckoned.map(|reckoned| reckoned.instructions)
}

/// All of it as JSON.
fn report(file: &Path, plan: &Plan) -> Value {
    let shown = &plan.flashed.shown;
    let rows = plan.rows.iter().map(|row| {
        json!({
            "slots": row.slots,
            "cache_bytes": row.cache_bytes,
            "peak": row.peak,
            "without_slot": row.without,
        })
    });
    let chips = CHIPS.iter().map(|chip| {
        json!({
            "chip": chip.name,
            "core": chip.core,
            "clock_hz": chip.clock,
            "bus_hz": chip.bus,
            "most_by_clock": instructions(plan, chip.core).map(|count| chip.by_clock(count)),
            "most_by_bus": chip.by_bus(shown.head.sent()),
        })
    });
    json!({
        "scene": file.display().to_string(),
        "toolchain": plan.release,
        "size": shown.head.sent(),
        "draw_calls": shown.calls,
        "triangles": shown.triangles,
        "vertices": shown.head.room.vertices,
        "objects": shown.head.room.objects,
        "flash_bytes": plan.flashed.flash_bytes(),
        "program": plan.program.as_ref().map(|program| program.name),
        "slots": plan.slots,
        "fast_bytes": plan.fast_bytes,
        "line_bytes": line_bytes(&shown.head),
        "slow_bytes_are_at_most": plan.flashed.is_list(),
        "not_reckoned": plan.beyond,
        "bound": BOUND,
        "spans": spans(plan),
        "enough_slots": plan.enough().map(|row| row.slots),
        "by_slots": rows.collect::<Vec<_>>(),
        "boards": plan.boards.iter().map(of_board).collect::<Vec<_>>(),
        "chips": chips.collect::<Vec<_>>(),
    })
}

fn of_board(board: &OnBoard) -> Value {
    json!({
        "board": board.name,
        "text_bytes": board.code,
        "slow_bytes": board.slow_bytes,
        "instructions": board.reckoned.map(|reckoned| reckoned.instructions.round()),
        "within_bound": board.reckoned.map(|reckoned| reckoned.is_within),
    })
}
