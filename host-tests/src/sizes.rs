//! `firmware --sizes`: what a program with a look takes of flash and RAM, on each core.
//!
//! The programs are `host-tests/firmware/src/small.rs` and `looks.rs`: the teapot, or a textured sphere, at 320x240 with
//! a cache of 64 slots and two buffers of a line, no formatting and no messages. Each is run, and refused where its
//! picture is not the one that this machine draws. Records are what the types take; they are the same on all cores.

use crate::args::FirmwareArgs;
use crate::bench::table::{page, rewrite};
use crate::firmware::{
    self, BOARDS, Board, DEFAULT_TIMEOUT, Profile, Sections, Symbol, Symbols, Toolchain,
};
use crate::frames::{lamplit_frame, shot_frame, suite_frame, untextured_frame};
use comfy_table::{CellAlignment, Table, presets::UTF8_FULL_CONDENSED};
use scanbeam::Link;
use scanbeam::frame::FastMemory;
use scanbeam::look::Look;
use scanbeam::scene::{Object, Shading, TexturePlace, Vertex};
use scenes::{PhongLook, Shot, SmoothLook, Suite, TexturedLook, TexturedPhongLook};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;

/// What stands before and after the table in `host-tests/figures/tables.md`.
pub const MARKERS: [&str; 2] = [
    "<!-- sizes: written by `firmware --sizes --markdown` -->",
    "<!-- /sizes -->",
];
/// What the table says.
const INTRO: &str = "What a program takes, in bytes: its code on each core, its constants (M4 / M3 / M0+; the teapot is 27,672 of them, and 20,604 where no normals are looked at), and the fast RAM for 320 pixels a line with 64 slots and two buffers of one line.
Then its records: a vertex with its place on a texture, an object with its link, a slot of the cache, a pixel of depth.
Every row is a firmware that draws the teapot, or a textured sphere, built with `opt-level = 3`; `plain` is without the code for values that few draw calls have; `all looks` is one look whose draw calls are smooth or textured, lit at vertices or at pixels.";

/// A program, before it is built.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Program {
    /// What it is called in tables.
    pub name: &'static str,
    /// Its binary.
    pub binary: &'static str,
    /// Features of the package.
    pub features: &'static [&'static str],
    /// Bytes of a slot.
    slot: usize,
    /// Bytes of a vertex's place on a texture.
    place: usize,
}

const PLACE: usize = size_of::<TexturePlace>();

/// All of them.
pub const PROGRAMS: [Program; 7] = [
    program::<SmoothLook>("Gouraud, plain", &[], 0),
    program::<SmoothLook>("Gouraud, plain, flat faces", &["sized", "flat"], 0),
    program::<SmoothLook>("Gouraud", &["sized", "values"], 0),
    program::<TexturedLook>("Textured, plain", &["sized", "textured"], PLACE),
    program::<TexturedLook>("Textured", &["sized", "textured", "values"], PLACE),
    program::<PhongLook>("Phong, plain", &["sized", "phong"], 0),
    Program {
        binary: "looks",
        ..program::<TexturedPhongLook>("all looks, with shadows", &[], PLACE)
    },
];

const fn program<L: Look>(
    name: &'static str,
    features: &'static [&'static str],
    place: usize,
) -> Program {
    Program {
        name,
        binary: "small",
        features,
        slot: FastMemory::<L>::SLOT_BYTES,
        place,
    }
}

/// Checksums of the pictures that programs draw, as this machine draws them, by name.
///
/// # Errors
/// When one does not fit the memory that it asks for.
pub fn pictures() -> Result<BTreeMap<&'static str, u32>, Box<dyn Error>> {
    Ok(BTreeMap::from([
        ("teapot", suite_frame(Suite::Teapot)?.crc()),
        (
            "teapot_flat",
            shot_frame(Shot::Teapot, Shading::Flat)?.crc(),
        ),
        ("teapot_lamplit", lamplit_frame()?.crc()),
        ("teapot_untextured", untextured_frame()?.crc()),
        ("b", suite_frame(Suite::B)?.crc()),
    ]))
}

/// Whether all that a program has said is one of these pictures.
#[must_use]
pub fn draws(known: &BTreeMap<&str, u32>, said: &[String]) -> bool {
    let is_known = |line: &String| {
        let (name, crc) = line.strip_prefix("picture ")?.split_once(' ')?;
        (format!("{:08x}", known.get(name)?) == crc).then_some(())
    };
    !said.is_empty() && said.iter().all(|line| is_known(line).is_some())
}

/// What a program takes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ProgramSize {
    /// The program.
    pub program: Program,
    /// Of each of [`BOARDS`].
    pub boards: Vec<Sections>,
    /// Its functions, on each of them.
    pub symbols: Vec<Symbols>,
}

/// A triangle, with the link that files it.
const OBJECT: usize = size_of::<Object>() + size_of::<Link>();
/// Functions that are named for each program and core.
const NAMED: usize = 20;

impl ProgramSize {
    /// Cache, depth line and line buffers, bytes: the same on all cores.
    fn fast(&self) -> u64 {
        let first = self.boards.first().copied().unwrap_or_default();
        first.fast.bytes + first.dma.bytes
    }

    /// A vertex, with its place where there are textures.
    const fn vertex(&self) -> usize {
        size_of::<Vertex>() + self.program.place
    }

    /// As `firmware --sizes --json` prints it, with its functions or without.
    pub fn to_json(&self, with_symbols: bool) -> Value {
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
            "program": self.program.name,
            "vertex_bytes": self.vertex(),
            "object_bytes": OBJECT,
            "slot_bytes": self.program.slot,
            "depth_bytes": size_of::<u32>(),
            "fast_bytes": self.fast(),
            "boards": boards.collect::<Vec<_>>(),
        })
    }

    /// The largest functions on each core, a line each, and how many bytes the others have.
    pub fn largest(&self) -> String {
        let mut text = String::new();
        for ((board, sections), symbols) in BOARDS.iter().zip(&self.boards).zip(&self.symbols) {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{} on {}:", self.program.name, board.name);
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
    pub fn cells(&self) -> Vec<String> {
        let mut cells = vec![self.program.name.to_owned()];
        cells.extend(self.boards.iter().map(|s| thousands(s.text_bytes())));
        let constants = self.boards.iter().map(|s| thousands(s.rodata.bytes));
        cells.push(constants.collect::<Vec<_>>().join(" / "));
        cells.push(thousands(self.fast()));
        let (slot, cell) = (self.program.slot, size_of::<u32>());
        cells.extend([self.vertex(), OBJECT, slot, cell].map(|bytes| bytes.to_string()));
        cells
    }
}

/// The cells of the head.
pub fn head() -> Vec<String> {
    let mut head = vec!["program".to_owned()];
    let name = |board: &Board| board.name.replace("plus", "+").to_uppercase();
    head.extend(BOARDS.iter().map(|board| format!("code {}", name(board))));
    head.extend(["constants", "fast RAM", "vertex", "object", "slot", "depth"].map(str::to_owned));
    head
}

/// A number with its thousands apart.
pub fn thousands(value: u64) -> String {
    match value {
        0..1000 => value.to_string(),
        _ => format!("{},{:03}", thousands(value / 1000), value % 1000),
    }
}

/// Builds and runs each program on each core.
///
/// # Errors
/// When one cannot be built or run, or draws something else.
pub fn measure() -> Result<Vec<ProgramSize>, Box<dyn Error>> {
    let toolchain = Toolchain::find()?;
    let known = pictures()?;
    let measured = PROGRAMS.into_iter().map(|program| {
        let Program {
            name,
            binary,
            features,
            ..
        } = program;
        let folder =
            firmware::build_all(&toolchain, &BOARDS, Profile::Release, &[binary], features)?;
        let (mut boards, mut symbols) = (Vec::new(), Vec::new());
        for board in &BOARDS {
            let release = folder.join(board.target).join(Profile::Release.name());
            let elf = release.join(binary);
            let said = firmware::run(board, &elf, DEFAULT_TIMEOUT)?;
            if !draws(&known, &said) {
                let board = board.name;
                return Err(format!("{board}: {name} draws something else: {said:?}").into());
            }
            boards.push(Sections::read(&elf)?);
            symbols.push(Symbols::read(&elf)?);
        }
        Ok(ProgramSize {
            program,
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
fn text(sizes: &[ProgramSize]) -> Table {
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
pub(crate) fn write(path: &Path, sizes: &[ProgramSize]) -> Result<(), Box<dyn Error>> {
    rewrite(path, MARKERS, &markdown(sizes))
}

/// For the page.
pub fn markdown(sizes: &[ProgramSize]) -> String {
    let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    let head = head();
    let mut rule = vec!["---:".to_owned(); head.len()];
    rule[0] = "---".to_owned();
    let mut out = format!("{INTRO}\n\n") + &line(head) + &line(rule);
    for size in sizes {
        out.push_str(&line(size.cells()));
    }
    out
}
