//! The program that draws a scene, as far as it is on record: the smallest of those of `firmware --sizes`.

use crate::bench::table::page;
use crate::firmware::BOARDS;
use scene_flash::Kind;
use std::error::Error;

/// A program, and what its code takes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Program {
    /// Its name in `host-tests/figures/tables.md`.
    pub name: &'static str,
    /// Bytes of its code, on each of [`BOARDS`].
    pub code: [u64; BOARDS.len()],
}

/// The program of scenes of a kind, which have values that few have or none; `None` where there is none on record.
///
/// # Errors
/// When the table cannot be read, or has no such row.
pub fn program(kind: Kind, is_usual: bool) -> Result<Option<Program>, Box<dyn Error>> {
    let name = match (kind, is_usual) {
        (Kind::Smooth, true) => "Gouraud, plain",
        (Kind::Smooth, false) => "Gouraud",
        (Kind::Textured, true) => "Textured, plain",
        (Kind::Textured, false) => "Textured",
        (Kind::Phong | Kind::TexturedPhong, _) => "all looks, with shadows",
        (Kind::Indexed | Kind::ListSmooth | Kind::ListTextured, _) => return Ok(None),
    };
    let path = page();
    let said = |why: &dyn std::fmt::Display| format!("{}: {why}", path.display());
    let text = std::fs::read_to_string(&path).map_err(|error| said(&error))?;
    let code = code_of(&text, name).ok_or_else(|| said(&format!("no sizes of `{name}`")))?;
    Ok(Some(Program { name, code }))
}

/// The bytes of a program's code, of its row in a table.
#[must_use]
pub fn code_of(table: &str, name: &str) -> Option<[u64; BOARDS.len()]> {
    let start = format!("| {name} | ");
    let row = table.lines().find_map(|line| line.strip_prefix(&start))?;
    let mut cells = row
        .split(" | ")
        .map(|cell| cell.replace(',', "").parse().ok());
    let mut code = [0; BOARDS.len()];
    for bytes in &mut code {
        *bytes = cells.next()??;
    }
    Some(code)
}
