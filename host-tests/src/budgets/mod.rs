//! `budgets`: what the crate takes of flash and of a reader's time, against limits that fail.
//!
//! The limits are in `host-tests/figures/budgets.txt`, a line each: what may be, what is wanted, and
//! of what. Nothing may go above its limit. A limit is lowered by `budgets --tighten` to what is
//! measured, and raised by hand alone.
//!
//! | file | there |
//! |---|---|
//! | `lexer.rs` | words of Rust, without comments and tests |
//! | `source.rs` | counts of the source |

mod lexer;
pub mod source;

use crate::args::BudgetsArgs;
use crate::figures::gate::{TOLERANCE_OTHER, release};
use crate::firmware::{self, BOARDS, Profile, Sections, Symbols, Toolchain, workspace};
use crate::image_out::write_atomically;
use crate::stdio;
use comfy_table::{CellAlignment, Table, presets::UTF8_FULL_CONDENSED};
use scanbeam::frame::FastMemory;
use scanbeam::scene::Object;
use scenes::{SmoothLook, TexturedLook};
use std::collections::BTreeMap;
use std::error::Error;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// What stands at the head of the record.
const HEAD: &str = "\
# Limits that fail (first column), what is wanted (second; - where nothing is said), and of what.
# `scanbeam budgets` holds the project against them; `scanbeam budgets --tighten` lowers them.
";
/// The compiler whose code the limits of code are of.
const COMPILER: &str = "rustc 1.95";

/// A limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Budget {
    /// What it may be at most.
    pub limit: u64,
    /// What is wanted, where that is said.
    pub goal: Option<u64>,
}

/// Limits by what they are of.
pub type Budgets = BTreeMap<String, Budget>;
/// Measured figures by what they are of.
pub type Figures = BTreeMap<String, u64>;

/// Where the limits are.
#[must_use]
pub fn path() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("figures/budgets.txt")
}

/// Reads limits.
///
/// # Errors
/// A file that cannot be read, and a line that is no limit, or names one again.
pub fn read(path: &Path) -> Result<Budgets, Box<dyn Error>> {
    let text = std::fs::read_to_string(path)
        .map_err(|error| format!("{}: {}", path.display(), stdio::reason(&error)))?;
    let mut budgets = Budgets::new();
    for (number, line) in (1..).zip(text.lines()) {
        if line.starts_with('#') {
            continue;
        }
        let is_new = limit(line).is_some_and(|(name, one)| budgets.insert(name, one).is_none());
        if !is_new {
            return Err(format!("{}:{number}: no new limit", path.display()).into());
        }
    }
    Ok(budgets)
}

fn limit(line: &str) -> Option<(String, Budget)> {
    let mut words = line.split_whitespace();
    let limit = words.next()?.parse().ok()?;
    let goal = match words.next()? {
        "-" => None,
        goal => Some(goal.parse().ok()?),
    };
    let name: Vec<&str> = words.collect();
    (!name.is_empty()).then(|| (name.join(" "), Budget { limit, goal }))
}

/// Writes limits.
///
/// # Errors
/// When the file cannot be written.
pub fn write(path: &Path, budgets: &Budgets) -> Result<(), Box<dyn Error>> {
    let mut text = HEAD.to_owned();
    for (name, Budget { limit, goal }) in budgets {
        let goal = goal.map_or_else(|| "-".to_owned(), |goal| goal.to_string());
        writeln!(text, "{limit:>7} {goal:>6}  {name}")?;
    }
    write_atomically(path, text.as_bytes())?;
    Ok(())
}

/// Bytes that code may differ by from one folder to another: the compiler orders some symbols by names that have it in
/// them. A program of 106,056 bytes was seen with 4 less.
pub const FOLDER: u64 = 16;

/// Whether a figure is of what the compiler makes.
fn is_compiled(name: &str) -> bool {
    ["text ", "constants "]
        .iter()
        .any(|kind| name.starts_with(kind))
}

/// What does not hold: figures above their limits, and those that have no limit. Code may be larger by `FOLDER`, that
/// of another compiler than `COMPILER` by `TOLERANCE_OTHER`.
#[must_use]
pub fn broken(budgets: &Budgets, figures: &Figures, compiler: &str) -> Vec<String> {
    let is_other = !compiler.is_empty() && release(compiler) != COMPILER;
    let most = |name: &str, limit: u64| match is_compiled(name) {
        true if is_other => (limit as f64 * (1.0 + TOLERANCE_OTHER)) as u64,
        true => limit + FOLDER,
        false => limit,
    };
    let wrong = |(name, &figure): (&String, &u64)| match budgets.get(name) {
        Some(budget) if figure > most(name, budget.limit) => Some(format!(
            "{name}: {figure}, where {} is the limit",
            budget.limit
        )),
        Some(_) => None,
        None => Some(format!("{name}: {figure}, and there is no limit")),
    };
    figures.iter().filter_map(wrong).collect()
}

/// Lowers limits to what was measured; how many.
pub fn tighten(budgets: &mut Budgets, figures: &Figures) -> usize {
    let mut lowered = 0;
    for (name, budget) in budgets.iter_mut() {
        if let Some(&figure) = figures.get(name).filter(|figure| **figure < budget.limit) {
            budget.limit = figure;
            lowered += 1;
        }
    }
    lowered
}

/// Measures, prints the table, and fails where a limit is broken: `false`.
///
/// # Errors
/// When something cannot be counted or built.
pub fn run(args: &BudgetsArgs) -> Result<bool, Box<dyn Error>> {
    let path = path();
    let mut budgets = read(&path)?;
    let mut figures = of_source()?;
    let mut compiler = String::new();
    if !args.source {
        let toolchain = Toolchain::find()?;
        compiler.clone_from(&toolchain.version);
        figures.extend(of_code(&toolchain)?);
        let gone = budgets.keys().filter(|name| !figures.contains_key(*name));
        let gone: Vec<&str> = gone.map(String::as_str).collect();
        if !gone.is_empty() {
            return Err(format!("limits of what is not measured: {}", gone.join(", ")).into());
        }
    }
    say!("{}", table(&budgets, &figures));
    let broken = broken(&budgets, &figures, &compiler);
    for line in &broken {
        tell!("broken: {line}");
    }
    if args.tighten {
        if release(&compiler) != COMPILER {
            figures.retain(|name, _| !is_compiled(name));
        }
        let lowered = tighten(&mut budgets, &figures);
        write(&path, &budgets)?;
        tell!("note: {lowered} limits were lowered");
    }
    Ok(broken.is_empty())
}

/// Counts of the source, and sizes of records, which are the same on all cores.
///
/// # Errors
/// When a file cannot be read.
pub fn of_source() -> Result<Figures, Box<dyn Error>> {
    let counts = source::count(&workspace().join("src"))?;
    let figures = [
        ("source lines of code in src", counts.code_lines),
        ("source traits", counts.traits),
        ("source boolean constants of traits", counts.bools),
        ("source names at the root", counts.root_names),
        ("source names in all", counts.names),
        ("source files over 500 lines in src", counts.long_files),
        (
            "source functions of 8 and more values",
            counts.wide_functions,
        ),
        ("source functions that take a tuple", counts.tuple_functions),
        ("record object", size_of::<Object>()),
        ("record slot, smooth", <FastMemory<SmoothLook>>::SLOT_BYTES),
        (
            "record slot, textured",
            <FastMemory<TexturedLook>>::SLOT_BYTES,
        ),
    ];
    let owned = |(name, value): (&str, usize)| (name.to_owned(), value as u64);
    Ok(figures.into_iter().map(owned).collect())
}

/// A program of `host-tests/firmware`, its features, and what it is called here. The first two have no code for values
/// that few draw calls have.
const PROGRAMS: [(&str, &[&str], &str); 3] = [
    ("small", &[], "smooth with depth"),
    ("small", &["sized", "textured"], "textured with depth"),
    ("looks", &[], "all looks in one program"),
];

/// What functions are called that panic, in all of these programs together.
const PANICS: &str = "functions that panic, in these programs";

/// Whether a function is one of `core` that panics: a program has it where something of it might.
#[must_use]
pub fn is_panic(name: &str) -> bool {
    let is_failure = name.ends_with("_failed") || name.ends_with("_fail");
    name.starts_with("core::") && (is_failure || name.starts_with("core::panicking::"))
}

/// Bytes of code and of constants, by program and core, and what of the code panics.
fn of_code(toolchain: &Toolchain) -> Result<Figures, Box<dyn Error>> {
    let mut figures = Figures::new();
    for (program, features, name) in PROGRAMS {
        let folder =
            firmware::build_all(toolchain, &BOARDS, Profile::Release, &[program], features)?;
        for board in &BOARDS {
            let release = folder.join(board.target).join(Profile::Release.name());
            let elf = release.join(program);
            let sections = Sections::read(&elf)?;
            let constants = sections.rodata.bytes + sections.data.bytes;
            figures.insert(
                format!("text {name}, {}", board.name),
                sections.text_bytes(),
            );
            figures.insert(format!("constants {name}, {}", board.name), constants);
            let symbols = Symbols::read(&elf)?;
            let panics = symbols.iter().filter(|symbol| is_panic(&symbol.name));
            *figures.entry(PANICS.to_owned()).or_default() += panics.count() as u64;
        }
    }
    Ok(figures)
}

fn table(budgets: &Budgets, figures: &Figures) -> Table {
    let mut table = Table::new();
    table
        .load_preset(UTF8_FULL_CONDENSED)
        .set_header(["", "now", "limit", "wanted"]);
    let dash = || "-".to_owned();
    for (name, figure) in figures {
        let budget = budgets.get(name);
        let limit = budget.map_or_else(dash, |budget| budget.limit.to_string());
        let goal = budget.and_then(|budget| budget.goal);
        let goal = goal.map_or_else(dash, |goal| goal.to_string());
        table.add_row([name.clone(), figure.to_string(), limit, goal]);
    }
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}
