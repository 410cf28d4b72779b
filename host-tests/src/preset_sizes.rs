//! `firmware --sizes`: what each preset takes of flash and RAM, on each core.
//!
//! The program is `host-tests/firmware/src/preset.rs`: the teapot at 320x240 by one preset, with a cache
//! of 43 slots and two buffers of a line, no formatting and no messages. It is built for each
//! preset and run, and refused where its picture is not the one that this machine draws by the
//! same preset. Records are what the types take; they are the same on all cores.

use crate::args::FirmwareArgs;
use crate::bench::table::{between, page};
use crate::firmware::{
    self, BOARDS, Board, DEFAULT_TIMEOUT, Profile, Sections, Symbol, Symbols, Toolchain,
};
use crate::frames::draw;
use crate::image_out::write_atomically;
use comfy_table::{CellAlignment, Table, presets::UTF8_FULL_CONDENSED};
use scanbeam::Link;
use scanbeam::pipeline::{CellOf, ObjectOf, Pipeline, SlotOf, VertexOf};
use scanbeam::pixel::Rgb565Be;
use scenes::Shot;
use serde_json::{Value, json};
use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;

/// What stands before and after the table in `host-tests/figures/tables.md`.
const MARKERS: [&str; 2] = [
    "<!-- sizes: written by `firmware --sizes --markdown` -->",
    "<!-- /sizes -->",
];
/// What the table says.
const INTRO: &str = "What each preset takes, in bytes: its code on each core, its constants (M4 / M3 / M0+; the teapot is 27,672 of them, and 20,604 where no normals are looked at), and the fast RAM for 320 pixels a line with 43 slots and two buffers of one line.
Then its records: a vertex, an object with its link, a slot of the cache, a pixel of depth.
Every row is a firmware that draws the teapot, built with `opt-level = 3`; presets in one program share much of their code.";
/// The program that is built.
const PROGRAM: &str = "preset";

/// A preset, before it is built.
struct Preset {
    name: &'static str,
    feature: &'static str,
    records: Records,
    /// CRC-32 of the teapot as it is drawn here.
    crc: u32,
}

/// Bytes of a preset's records.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Records {
    vertex: usize,
    object: usize,
    slot: usize,
    cell: usize,
}

impl Records {
    fn of<P: Pipeline>() -> Self {
        Self {
            vertex: size_of::<VertexOf<P>>(),
            // With the link that files it.
            object: size_of::<ObjectOf<P>>() + size_of::<Link>(),
            slot: size_of::<SlotOf<P>>(),
            cell: size_of::<CellOf<P>>(),
        }
    }
}

/// What a preset takes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PresetSize {
    name: &'static str,
    records: Records,
    /// Of each of [`BOARDS`].
    boards: Vec<Sections>,
    /// Its functions, on each of them.
    symbols: Vec<Symbols>,
}

/// Functions that are named for each preset and core.
const NAMED: usize = 20;

impl PresetSize {
    /// Cache, depth line and line buffers, bytes: the same on all cores.
    fn fast(&self) -> u64 {
        let first = self.boards.first().copied().unwrap_or_default();
        first.fast.bytes + first.dma.bytes
    }

    fn to_json(&self, with_symbols: bool) -> Value {
        let measured = self.boards.iter().zip(&self.symbols);
        let boards = BOARDS
            .iter()
            .zip(measured)
            .map(|(board, (sections, symbols))| {
                let mut one = json!({
                    "board": board.name,
                    "text_bytes": sections.text_bytes(),
                    "rodata_bytes": sections.rodata.bytes,
                });
                if with_symbols {
                    let each =
                        |symbol: &Symbol| json!({"name": symbol.name, "bytes": symbol.bytes});
                    one["symbols"] = symbols.by_size().into_iter().map(each).collect();
                }
                one
            });
        json!({
            "preset": self.name,
            "vertex_bytes": self.records.vertex,
            "object_bytes": self.records.object,
            "slot_bytes": self.records.slot,
            "depth_bytes": self.records.cell,
            "fast_bytes": self.fast(),
            "boards": boards.collect::<Vec<_>>(),
        })
    }

    /// The largest functions on each core, a line each, and how many bytes the others have.
    fn largest(&self) -> String {
        let mut text = String::new();
        for ((board, sections), symbols) in BOARDS.iter().zip(&self.boards).zip(&self.symbols) {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{} on {}:", self.name, board.name);
            let by_size = symbols.by_size();
            let named = &by_size[..by_size.len().min(NAMED)];
            for symbol in named {
                let _ = writeln!(text, "{:>8}  {}", thousands(symbol.bytes), symbol.name);
            }
            let known: u64 = named.iter().map(|symbol| symbol.bytes).sum();
            let rest = sections.text_bytes().saturating_sub(known);
            let others = by_size.len() - named.len();
            let _ = writeln!(text, "{:>8}  {others} others", thousands(rest));
        }
        text
    }

    /// The cells of its row: name, code of each core, constants of all, fast RAM, records.
    fn cells(&self) -> Vec<String> {
        let mut cells = vec![self.name.to_owned()];
        cells.extend(self.boards.iter().map(|s| thousands(s.text_bytes())));
        let constants = self.boards.iter().map(|s| thousands(s.rodata.bytes));
        cells.push(constants.collect::<Vec<_>>().join(" / "));
        cells.push(thousands(self.fast()));
        let Records { vertex, object, .. } = self.records;
        let Records { slot, cell, .. } = self.records;
        cells.extend([vertex, object, slot, cell].map(|bytes| bytes.to_string()));
        cells
    }
}

fn head() -> Vec<String> {
    let mut head = vec!["preset".to_owned()];
    let name = |board: &Board| board.name.replace("plus", "+").to_uppercase();
    head.extend(BOARDS.iter().map(|board| format!("code {}", name(board))));
    head.extend(["constants", "fast RAM", "vertex", "object", "slot", "depth"].map(str::to_owned));
    head
}

fn thousands(value: u64) -> String {
    match value {
        0..1000 => value.to_string(),
        _ => format!("{},{:03}", thousands(value / 1000), value % 1000),
    }
}

/// All presets.
fn presets() -> Result<Vec<Preset>, Box<dyn Error>> {
    fn preset<P: Pipeline<Pixel = Rgb565Be>>(
        feature: &'static str,
        name: &'static str,
    ) -> Result<Preset, Box<dyn Error>> {
        Ok(Preset {
            name,
            feature,
            records: Records::of::<P>(),
            crc: crc32fast::hash(&draw::<P>(Shot::Teapot)?),
        })
    }
    macro_rules! all {
        ($($feature:literal, $name:literal, $look:ty;)*) => {
            [$(preset::<$look>($feature, $name)),*]
        };
    }
    scenes::sized!(all).into_iter().collect()
}

/// Builds and runs each preset on each core.
///
/// # Errors
/// When one cannot be built or run, or draws something else.
pub fn measure() -> Result<Vec<PresetSize>, Box<dyn Error>> {
    let toolchain = Toolchain::find()?;
    let measured = presets()?.into_iter().map(|preset| {
        let features = ["sized", preset.feature];
        let folder =
            firmware::build_all(&toolchain, &BOARDS, Profile::Release, &[PROGRAM], &features)?;
        let (mut boards, mut symbols) = (Vec::new(), Vec::new());
        for board in &BOARDS {
            let elf = folder
                .join(board.target)
                .join(Profile::Release.name())
                .join(PROGRAM);
            let said = firmware::run(board, &elf, DEFAULT_TIMEOUT)?;
            if said != [format!("picture teapot {:08x}", preset.crc)] {
                let (board, name) = (board.name, preset.name);
                return Err(format!("{board}: {name} draws something else: {said:?}").into());
            }
            boards.push(Sections::read(&elf)?);
            symbols.push(Symbols::read(&elf)?);
        }
        Ok(PresetSize {
            name: preset.name,
            records: preset.records,
            boards,
            symbols,
        })
    });
    measured.collect()
}

/// Measures, prints, and writes the table where that is asked.
///
/// # Errors
/// As [`measure`], and where the table cannot be written.
pub(crate) fn run(args: &FirmwareArgs) -> Result<(), Box<dyn Error>> {
    let sizes = measure()?;
    if args.json {
        let list: Vec<Value> = sizes
            .iter()
            .map(|size| size.to_json(args.symbols))
            .collect();
        say!("{}", serde_json::to_string_pretty(&list)?);
    } else {
        say!("{}", text(&sizes));
        for size in sizes.iter().filter(|_| args.symbols) {
            say!("{}", size.largest().trim_end());
        }
    }
    if args.markdown {
        write(&page(), &sizes)?;
    }
    Ok(())
}

/// For the terminal.
fn text(sizes: &[PresetSize]) -> Table {
    let mut table = Table::new();
    table.load_preset(UTF8_FULL_CONDENSED).set_header(head());
    for size in sizes {
        table.add_row(size.cells());
    }
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}

/// Rewrites what stands between the markers of a file.
///
/// # Errors
/// When there are no markers, or the file cannot be read or written.
pub(crate) fn write(path: &Path, sizes: &[PresetSize]) -> Result<(), Box<dyn Error>> {
    let text = std::fs::read_to_string(path)?;
    let new = between(&text, MARKERS, &markdown(sizes))?;
    write_atomically(path, new.as_bytes())?;
    Ok(())
}

fn markdown(sizes: &[PresetSize]) -> String {
    let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    let head = head();
    let mut rule = vec!["---:".to_owned(); head.len()];
    rule[0] = "---".to_owned();
    let mut out = format!("{INTRO}\n\n") + &line(head) + &line(rule);
    for size in sizes {
        let mut cells = size.cells();
        cells[0] = format!("`{}`", cells[0]);
        // Writing to a string cannot fail.
        let _ = write!(out, "{}", line(cells));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::firmware::Section;

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
        let size = PresetSize {
            name: "GouraudDepth",
            records: Records::of::<scanbeam::pipeline::GouraudDepth<Rgb565Be>>(),
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
        assert!(written.contains("| `GouraudDepth` | 50,123 |"), "{written}");
        let readme = include_str!("../figures/tables.md");
        let new = between(readme, MARKERS, &written).unwrap();
        assert_eq!(between(&new, MARKERS, &written).unwrap(), new);
        assert_eq!(thousands(1_002_003), "1,002,003");
    }

    /// Kills: a row of a preset that went.
    #[test]
    fn the_table_has_the_presets_that_there_are() {
        let table = include_str!("../figures/tables.md");
        let rows = table.lines();
        let rows = rows.filter_map(|line| line.strip_prefix("| `")?.split_once('`'));
        let rows: Vec<&str> = rows.map(|(name, _)| name).collect();
        let presets = presets().unwrap();
        let names: Vec<&str> = presets.iter().map(|preset| preset.name).collect();
        assert_eq!(rows, names);
    }
}
