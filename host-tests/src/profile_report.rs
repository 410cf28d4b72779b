//! `firmware --profile FRAME`: where the instructions of a frame go, of the firmware or of a scene file.

use crate::args::{FirmwareArgs, is_list, is_scene};
use crate::firmware::profile::{FunctionCost, Stepped, step};
use crate::firmware::{BOARDS, M4, Toolchain};
use crate::flashed::Flashed;
use comfy_table::{CellAlignment, Table, presets::UTF8_FULL_CONDENSED};
use serde_json::{Value, json};
use std::error::Error;
use std::path::Path;

/// Functions that the table has; the rest is one row.
const ROWS: usize = 40;

/// Steps through a frame and prints.
///
/// # Errors
/// When the firmware cannot be built or run, or has no such frame or function.
pub fn run(frame: &str, args: &FirmwareArgs) -> Result<(), Box<dyn Error>> {
    let name = args.board.as_deref().unwrap_or(M4.name);
    let board = BOARDS.iter().find(|board| board.name == name);
    let board = board.ok_or_else(|| format!("there is no board {name}"))?;
    let toolchain = Toolchain::find()?;
    let file = Path::new(frame);
    let stepped = match is_scene(file) || is_list(file) {
        true => Flashed::load(file)?.step(&toolchain, board, file)?,
        false => step(&toolchain, board, frame)?,
    };
    // Before anything is printed: it may be refused.
    let words = args.function.as_deref();
    let listing = words.map(|words| stepped.listing(words)).transpose()?;
    if args.json {
        let text = serde_json::to_string_pretty(&to_json(frame, board.name, &stepped))?;
        say!("{text}");
    } else {
        let all = stepped.instructions();
        say!("{frame} on {}: {all} instructions", board.name);
        say!("{}", table(&stepped));
    }
    if let Some(listing) = listing {
        say!("{}", listing.trim_end());
    }
    Ok(())
}

fn part(instructions: u64, all: u64) -> String {
    format!("{:.1}", 100.0 * instructions as f64 / all.max(1) as f64)
}

fn table(stepped: &Stepped) -> Table {
    let all = stepped.instructions();
    let mut table = Table::new();
    table.load_preset(UTF8_FULL_CONDENSED).set_header([
        "function",
        "instructions",
        "%",
        "calls",
        "a call",
    ]);
    let shown = stepped.functions.len().min(ROWS);
    for FunctionCost {
        symbol,
        instructions,
        calls,
    } in &stepped.functions[..shown]
    {
        // What is jumped into has no calls.
        let each = instructions.checked_div(*calls);
        table.add_row([
            symbol.name.clone(),
            instructions.to_string(),
            part(*instructions, all),
            calls.to_string(),
            each.map_or_else(String::new, |each| each.to_string()),
        ]);
    }
    let named: u64 = stepped.functions[..shown]
        .iter()
        .map(|f| f.instructions)
        .sum();
    let rest = stepped.functions.len() - shown;
    if all > named {
        let text = format!("{rest} others, and code of no function");
        let cells = [text, (all - named).to_string(), part(all - named, all)];
        table.add_row(cells);
    }
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}

fn to_json(frame: &str, board: &str, stepped: &Stepped) -> Value {
    let functions = stepped.functions.iter().map(|function| {
        json!({
            "function": function.symbol.name,
            "address": function.symbol.address,
            "bytes": function.symbol.bytes,
            "instructions": function.instructions,
            "calls": function.calls,
        })
    });
    json!({
        "frame": frame,
        "board": board,
        "instructions": stepped.instructions(),
        "functions": functions.collect::<Vec<Value>>(),
    })
}
