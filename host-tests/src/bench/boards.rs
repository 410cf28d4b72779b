//! The same scenes on Cortex-M in QEMU: the same programs, built for each board, counted in
//! instructions.
//!
//! A picture comes back to the host, where it is held against ours by the same limits as one that
//! was drawn here; ours has to be the host's bit by bit. What cannot be built or run for a board is
//! said with the reason, and all else is measured.

use super::{Compared, Entry, OURS, PACKAGES, Pictures, package, pixels, target};
use crate::firmware::run_words;
use crate::firmware::{BOARDS, Board, DEFAULT_TIMEOUT, FirmwareError, Package, Toolchain};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::thread;

/// Times [`DEFAULT_TIMEOUT`]: a frame may take 12,000,000,000 instructions where floats are made of
/// integers.
const PATIENCE: u32 = 6;

/// A renderer on a scene, on a board.
#[derive(Debug, Clone, PartialEq)]
pub struct OnBoard {
    /// Which board.
    pub board: Board,
    /// What was counted, or why nothing was.
    pub counted: Result<Counted, String>,
}

/// A frame on a board.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Counted {
    /// Its instructions.
    pub instructions: f64,
    /// Pixels of the picture that show the scene.
    pub pixels: usize,
    /// How many times as many instructions as ours it takes, where ours were counted.
    pub ratio: Option<f64>,
}

impl OnBoard {
    /// Million instructions, and times ours, for a table.
    pub fn cells(&self) -> [String; 2] {
        let Ok(counted) = &self.counted else {
            return ["-", "-"].map(str::to_owned);
        };
        let ratio = |ratio| format!("{ratio:.1}");
        [
            format!("{:.2}", counted.instructions / 1e6),
            counted.ratio.map_or("-".to_owned(), ratio),
        ]
    }

    /// What was counted, or why nothing was.
    pub fn to_json(&self) -> Value {
        match &self.counted {
            Ok(counted) => json!({
                "instructions_per_frame": counted.instructions,
                "instructions_per_shaded_pixel": counted.instructions / counted.pixels.max(1) as f64,
                "pixels": counted.pixels,
                "instructions_ratio_to_us": counted.ratio,
            }),
            Err(reason) => json!({ "missing": reason }),
        }
    }
}

/// A package for a board: its program, or why there is none.
type Program = Result<PathBuf, String>;

/// Measures every entry on every board, in the order of [`BOARDS`]; `folder` has the scenes.
///
/// # Errors
/// When something else is drawn.
pub(super) fn measure(
    entries: &[Entry],
    ours: &Pictures,
    folder: &Path,
) -> Result<Vec<Vec<OnBoard>>, String> {
    let toolchain = Toolchain::find();
    let programs = BOARDS.map(|board| {
        PACKAGES.map(|name| match &toolchain {
            Ok(toolchain) => build(toolchain, board, name).map_err(|error| reason(name, &error)),
            Err(error) => Err(error.to_string()),
        })
    });
    // Counts are the same however much runs beside them.
    let columns: Result<Vec<_>, String> = thread::scope(|scope| {
        let start = |(board, programs)| {
            scope.spawn(move || on_board(board, programs, entries, ours, folder))
        };
        let threads: Vec<_> = BOARDS.into_iter().zip(&programs).map(start).collect();
        let joined = threads.into_iter().map(|thread| match thread.join() {
            Ok(column) => column,
            Err(panic) => std::panic::resume_unwind(panic),
        });
        joined.collect()
    });
    let columns = columns?;
    let row = |entry: usize| columns.iter().map(|column| column[entry].clone()).collect();
    Ok((0..entries.len()).map(row).collect())
}

/// Measures every entry on a board.
fn on_board(
    board: Board,
    programs: &[Program; 2],
    entries: &[Entry],
    ours: &Pictures,
    folder: &Path,
) -> Result<Vec<OnBoard>, String> {
    let mut column: Vec<OnBoard> = Vec::new();
    for (index, entry) in entries.iter().enumerate() {
        let file = format!("{}-{index}", board.name);
        let program = &programs[usize::from(entry.package != PACKAGES[0])];
        let run = |elf: &PathBuf| run(board, elf, entry, folder, &file);
        let counted = match program.as_ref().map_err(String::clone).and_then(run) {
            Ok((instructions, picture)) => {
                let compared = Compared::new(entry, &picture, ours);
                let compared = compared.map_err(|error| format!("{}: {error}", board.name))?;
                if entry.renderer == OURS && ours.get(entry.scene.name()) != Some(&picture) {
                    let (board, scene) = (board.name, entry.scene.name());
                    return Err(format!("{board}: our picture of {scene} is not the host's"));
                }
                Ok(Counted {
                    instructions,
                    pixels: compared.shown,
                    ratio: None,
                })
            }
            Err(reason) => Err(reason),
        };
        column.push(OnBoard { board, counted });
    }
    compare(entries, &mut column);
    Ok(column)
}

/// Sets the ratios of a board's figures to ours of the same scene.
pub fn compare(entries: &[Entry], column: &mut [OnBoard]) {
    let ours: Vec<(&str, f64)> = entries
        .iter()
        .zip(column.iter())
        .filter(|(entry, _)| entry.renderer == OURS)
        .filter_map(|(entry, on)| {
            Some((entry.scene.name(), on.counted.as_ref().ok()?.instructions))
        })
        .collect();
    for (entry, on) in entries.iter().zip(column) {
        if let Ok(counted) = &mut on.counted {
            let of_scene = ours.iter().find(|(scene, _)| *scene == entry.scene.name());
            counted.ratio = of_scene.map(|(_, ours)| counted.instructions / ours);
        }
    }
}

/// Draws one frame: its instructions and its picture, which goes through `file`.
fn run(
    board: Board,
    elf: &Path,
    entry: &Entry,
    folder: &Path,
    file: &str,
) -> Result<(f64, Vec<u16>), String> {
    let mut words = vec![entry.package];
    words.extend(entry.words.iter().map(String::as_str));
    words.extend(["1", file]);
    let failed =
        |error: &dyn std::fmt::Display| format!("{} on {}: {error}", entry.renderer, board.name);
    let said = run_words(&board, elf, PATIENCE * DEFAULT_TIMEOUT, &words, folder);
    let said = said.map_err(|error| match error {
        FirmwareError::NoQemu => error.to_string(),
        other => failed(&other),
    })?;
    let instructions = said.first().and_then(|line| line.parse().ok());
    let instructions = instructions.ok_or_else(|| failed(&"it counted nothing"))?;
    let bytes = std::fs::read(folder.join(file)).map_err(|error| failed(&error))?;
    Ok((instructions, pixels(&bytes)))
}

/// Builds a package for a board.
fn build(toolchain: &Toolchain, board: Board, name: &str) -> Result<PathBuf, FirmwareError> {
    let package = Package {
        folder: package(name),
        target: target().join(toolchain.source.name()),
        crates: "core,alloc",
    };
    let target = package.build(toolchain, &[board], &["--release", "--locked"])?;
    Ok(target.join(board.target).join("release").join(name))
}

/// Why a package is not there, in one line.
pub fn reason(name: &str, error: &FirmwareError) -> String {
    match error {
        FirmwareError::Build {
            targets, stderr, ..
        } => {
            let first = stderr.lines().find(|line| line.starts_with("error"));
            let first = first.unwrap_or("cargo says nothing");
            format!("{name} does not build for {targets}: {first}")
        }
        other => other.to_string(),
    }
}
