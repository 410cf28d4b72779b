//! What each function of a board's program reads, and which are worth their bytes in RAM.
//!
//! A chip that runs from flash has a cache for it. What comes back to a function after a while has to be fetched
//! again, unless it lies in RAM: so functions stand in the order of such returns for each of their bytes, and the
//! bytes of all down to a row are what RAM for these takes.

use super::wire::Use;
use crate::firmware::Symbols;
use comfy_table::{CellAlignment, Table, presets::UTF8_FULL_CONDENSED};
use std::collections::BTreeMap;

/// Addresses of RAM and all above it.
pub const RAM: u64 = 0x2000_0000;

/// A function, or all that is read in flash and is none.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Function {
    /// As the source has it.
    pub name: String,
    /// Of its code; 0 of what is no function.
    pub bytes: u64,
    /// Whether it lies in RAM.
    pub is_in_ram: bool,
    /// Misses of the flash's cache in a frame.
    pub misses: u64,
    /// Lines of the cache that a frame comes back to after a while.
    pub returns: u64,
}

/// What each function read in so many frames, a frame of it, the one first that is worth its bytes most. What is read
/// in RAM and is no function is the program's data, and left out.
pub fn of(uses: &[Use], symbols: &Symbols, frames: u64) -> Vec<Function> {
    let mut found: BTreeMap<Option<u64>, Function> = BTreeMap::new();
    for used in uses {
        let symbol = symbols.at(used.address);
        if symbol.is_none() && used.address >= RAM {
            continue;
        }
        let start = symbol.map(|symbol| symbol.address);
        let function = found.entry(start).or_insert_with(|| Function {
            name: symbol.map_or_else(|| "constants".into(), |symbol| symbol.name.clone()),
            bytes: symbol.map_or(0, |symbol| symbol.bytes),
            is_in_ram: used.address >= RAM,
            misses: 0,
            returns: 0,
        });
        function.misses += used.misses;
        function.returns += used.returns;
    }
    let mut functions: Vec<_> = found.into_values().collect();
    // The greater share first, in returns for 64 KB; what has no bytes stands last.
    functions.sort_by_key(|function| {
        let share = (function.returns << 16).checked_div(function.bytes);
        (std::cmp::Reverse(share), function.name.clone())
    });
    for function in &mut functions {
        function.misses /= frames.max(1);
        function.returns /= frames.max(1);
    }
    functions
}

/// The functions for people, with the bytes of all down to each.
pub fn table(functions: &[Function]) -> Table {
    let mut table = Table::new();
    table.load_preset(UTF8_FULL_CONDENSED).set_header([
        "function", "in", "bytes", "so far", "misses", "returns", "a KB",
    ]);
    let mut bytes = 0;
    for function in functions {
        bytes += function.bytes;
        let share = (function.returns * 1024).checked_div(function.bytes);
        table.add_row([
            function.name.clone(),
            if function.is_in_ram { "RAM" } else { "flash" }.into(),
            function.bytes.to_string(),
            bytes.to_string(),
            function.misses.to_string(),
            function.returns.to_string(),
            share.map_or("-".into(), |share| share.to_string()),
        ]);
    }
    for column in table.column_iter_mut().skip(2) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}
