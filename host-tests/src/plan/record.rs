//! What works take, on record: `host-tests/figures/plan.json`, written by `plan --bless`.

use super::model::{Costs, Equations, Measured, Parts, reckon, works};
use super::samples::{Sample, Source, samples, write};
use crate::figures::gate::{minor, release};
use crate::firmware::{BOARDS, Toolchain};
use crate::flashed::memory::slow_bytes;
use crate::flashed::tally::Tally;
use crate::flashed::{Flashed, host};
use crate::image_out::write_atomically;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::error::Error;
use std::path::{Path, PathBuf};

/// Slots that samples are measured with.
pub const SLOTS: u16 = 64;

/// A sample on a board.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Known {
    /// Instructions of its frame.
    pub measured: f64,
    /// The same, reckoned from all other samples.
    pub reckoned_without: f64,
    /// Which part of that large triangles take.
    pub large: f64,
    /// Which part what has no slot takes.
    pub without_slot: f64,
}

impl Known {
    /// Whether it is said to be within the bound.
    #[must_use]
    pub fn is_bounded(&self) -> bool {
        let parts = Parts {
            large: self.large,
            without_slot: self.without_slot,
        };
        parts.are_small()
    }
}

/// What is known of a board.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct OfBoard {
    /// Bytes of the state of a draw call.
    pub draw_bytes: usize,
    /// Instructions of one work.
    pub costs: Costs,
    /// What they are of.
    pub samples: BTreeMap<String, Known>,
}

/// What is known of boards, by name, for each release of the compiler.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Record(pub BTreeMap<String, BTreeMap<String, OfBoard>>);

impl Record {
    /// Where it is.
    #[must_use]
    pub fn path() -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("figures/plan.json")
    }

    /// Reads it.
    ///
    /// # Errors
    /// When it cannot be read, or is none.
    pub fn read(path: &Path) -> Result<Self, Box<dyn Error>> {
        let text = std::fs::read(path).map_err(|error| format!("{}: {error}", path.display()))?;
        serde_json::from_slice(&text).map_err(|error| format!("{}: {error}", path.display()).into())
    }

    /// The newest release, and what is known of its boards.
    #[must_use]
    pub fn latest(&self) -> Option<(&str, &BTreeMap<String, OfBoard>)> {
        let newest = self.0.iter().max_by_key(|(release, _)| minor(release));
        newest.map(|(release, boards)| (release.as_str(), boards))
    }
}

/// A sample: what it does, and what it takes on each board.
struct Taken {
    name: String,
    tally: Tally,
    /// By the board's name.
    measured: BTreeMap<String, Measured>,
    /// Bytes of slow memory that its draw calls take, by the board's name, and how many there are.
    draw_bytes: BTreeMap<String, usize>,
    draws: usize,
}

/// A sample, read from a file in a folder.
///
/// # Errors
/// When it cannot be drawn.
pub fn load(folder: &Path, sample: &Sample) -> Result<Flashed, Box<dyn Error>> {
    let (name, bytes) = match &sample.source {
        Source::Scene(scene) => ("sample.json", scene.to_string().into_bytes()),
        Source::List(list) => ("sample.list", list.to_bytes(folder)?),
    };
    let file = folder.join(name);
    std::fs::write(&file, bytes)?;
    Flashed::load(&file).map_err(|error| format!("{}: {error}", sample.name).into())
}

/// What a scene does with so many slots.
///
/// # Errors
/// When it cannot be drawn.
pub fn tally(flashed: &Flashed, slots: &[u16]) -> Result<Vec<Tally>, Box<dyn Error>> {
    let room = flashed.shown.head.room;
    Ok(host::surveyed(&flashed.words, &[], room, slots)?.tallies)
}

/// Measures all samples and writes the record of this compiler anew.
///
/// # Errors
/// When a sample cannot be drawn or run, or a board draws something else.
pub fn bless() -> Result<(), Box<dyn Error>> {
    let toolchain = Toolchain::find()?;
    let folder = tempfile::tempdir()?;
    let all = samples(folder.path());
    write(folder.path(), &all)?;
    let taken: Result<Vec<Taken>, _> = all
        .iter()
        .map(|sample| take(folder.path(), sample, &toolchain))
        .collect();
    let taken = taken?;
    let path = Record::path();
    let mut record = if path.exists() {
        Record::read(&path)?
    } else {
        Record::default()
    };
    let boards = BOARDS
        .iter()
        .map(|board| (board.name.to_owned(), of_board(board.name, &taken)));
    record
        .0
        .insert(release(&toolchain.version), boards.collect());
    let mut text = serde_json::to_string_pretty(&record)?;
    text.push('\n');
    write_atomically(&path, text.as_bytes())?;
    Ok(())
}

/// Draws a sample here and on all boards.
fn take(folder: &Path, sample: &Sample, toolchain: &Toolchain) -> Result<Taken, Box<dyn Error>> {
    let flashed = load(folder, sample)?;
    let tally = tally(&flashed, &[SLOTS])?;
    let boards = flashed.measure(toolchain, &BOARDS, folder)?;
    let (mut measured, mut draw_bytes) = (BTreeMap::new(), BTreeMap::new());
    for board in &boards {
        let name = board.board.name.to_owned();
        let (Some(frame), Some(lines)) = (board.output.frames.first(), board.output.lines.first())
        else {
            return Err(format!("{name}: {}: no frame", sample.name).into());
        };
        if !flashed.matches(board) {
            return Err(format!("{name}: {}: the frame differs", sample.name).into());
        }
        let slow = board.output.figures.get("slow_bytes").copied();
        let rest = slow_bytes(&flashed.shown.head, 0);
        draw_bytes.insert(
            name.clone(),
            (slow.unwrap_or_default() as usize).saturating_sub(rest),
        );
        let one = Measured {
            pass_one: lines.pass_one as f64,
            lines: lines.costs.iter().map(|cost| *cost as f64).collect(),
            frame: frame.instructions as f64,
        };
        measured.insert(name, one);
    }
    Ok(Taken {
        name: sample.name.clone(),
        tally: tally.into_iter().next().ok_or("nothing was counted")?,
        measured,
        draw_bytes,
        draws: flashed.shown.head.room.draws as usize,
    })
}

/// What samples tell of a board.
fn of_board(board: &str, taken: &[Taken]) -> OfBoard {
    let of = |taken: &Taken| Equations::of(&taken.tally, &taken.measured[board]);
    let each: Vec<Equations> = taken.iter().map(of).collect();
    let without = |left_out: Option<usize>| {
        let mut all = Equations::default();
        let others = (0..).zip(&each).filter(|(at, _)| Some(*at) != left_out);
        others.for_each(|(_, more)| all.join(more));
        all.solve()
    };
    let known = |(at, taken): (usize, &Taken)| {
        let (costs, works) = (without(Some(at)), works(&taken.tally));
        let parts = Parts::of(&costs, &works);
        let known = Known {
            measured: taken.measured[board].frame,
            reckoned_without: reckon(&costs, &works).round(),
            large: to_thousandths(parts.large),
            without_slot: to_thousandths(parts.without_slot),
        };
        (taken.name.clone(), known)
    };
    let round = |(name, cost): (String, f64)| (name, to_thousandths(cost));
    OfBoard {
        draw_bytes: taken
            .first()
            .map_or(0, |one| one.draw_bytes[board] / one.draws.max(1)),
        costs: without(None).into_iter().map(round).collect(),
        samples: taken.iter().enumerate().map(known).collect(),
    }
}

fn to_thousandths(value: f64) -> f64 {
    (value * 1000.0).round() / 1000.0
}
