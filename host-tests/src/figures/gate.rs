//! The gate: nothing may cost more than what is recorded in `host-tests/figures/firmware.json`.
//!
//! The record holds each compiler release apart (`rustc 1.95`), because the same source costs up to
//! several percent more or less from one release to the next, and a single tolerance that allows
//! for that would hide what the gate is for. Counts are exact and repeat, so [`TOLERANCE`] is what
//! one is willing to lose unseen, not noise. A release that has no record is held against the
//! nearest one by [`TOLERANCE_OTHER`], and the report says so: a new compiler does not stop the
//! work, and a step back that matters is still seen.
//!
//! What is recorded and no longer measured, or measured and not recorded, fails too: the record
//! would thin out unseen. `firmware --bench --bless` writes it anew for every complete compiler.

use super::Figure;
use crate::image_out::write_atomically;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;
use std::fmt;
use std::path::{Path, PathBuf};

/// What may be lost unseen, as a part of the figure.
pub const TOLERANCE: f64 = 0.02;
/// The same where the figure was recorded with another compiler.
pub const TOLERANCE_OTHER: f64 = 0.10;

/// Figures by name.
pub type Figures = BTreeMap<String, f64>;
/// Figures by board and name.
pub type Boards = BTreeMap<String, Figures>;

/// The recorded figures, by compiler release.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Record(
    /// Figures by board and name, of each release.
    pub BTreeMap<String, Boards>,
);

/// Something that does not pass.
#[derive(Clone, Debug, PartialEq)]
pub struct Refusal {
    /// Short name of the board.
    pub board: String,
    /// The figure's name.
    pub name: String,
    /// What is recorded.
    pub recorded: Option<f64>,
    /// What was measured.
    pub measured: Option<f64>,
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { board, name, .. } = self;
        match (self.recorded, self.measured) {
            (Some(recorded), Some(measured)) => write!(
                f,
                "{board}: {name}: {measured} where {recorded} is recorded, {:+.1} %",
                100.0 * (measured / recorded - 1.0)
            ),
            (None, _) => write!(f, "{board}: {name} is not recorded"),
            (_, None) => write!(f, "{board}: {name} is recorded and was not measured"),
        }
    }
}

/// The gate's answer.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Verdict {
    /// What is slower than recorded, or recorded or measured alone.
    pub refused: Vec<Refusal>,
    /// The release whose figures were used, where it is not the one that measured.
    pub other: Option<String>,
    /// Figures that are better than recorded by more than the tolerance.
    pub better: usize,
}

/// `rustc 1.95` of `rustc 1.95.0 (59807616e 2026-04-14)`.
pub fn release(version: &str) -> String {
    let number = version.split_whitespace().nth(1).unwrap_or(version);
    let parts: Vec<&str> = number.split('.').take(2).collect();
    format!("rustc {}", parts.join("."))
}

/// The minor number of a release.
pub fn minor(release: &str) -> i64 {
    let number = release.rsplit('.').next().unwrap_or_default();
    number.parse().unwrap_or_default()
}

impl Record {
    /// Where the record is.
    #[must_use]
    pub fn path() -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("figures/firmware.json")
    }

    /// Reads a record; a file that is not there is an empty one.
    ///
    /// # Errors
    /// When it cannot be read, or is no record.
    pub fn read(path: &Path) -> Result<Self, Box<dyn Error>> {
        match std::fs::read(path) {
            Ok(bytes) => serde_json::from_slice(&bytes)
                .map_err(|error| format!("{}: {error}", path.display()).into()),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(Self::default()),
            Err(error) => Err(format!("{}: {error}", path.display()).into()),
        }
    }

    /// Writes it.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), Box<dyn Error>> {
        let mut text = serde_json::to_string_pretty(self)?;
        text.push('\n');
        write_atomically(path, text.as_bytes())?;
        Ok(())
    }

    /// Takes in what a compiler's firmware was measured to cost, in place of what it had.
    pub fn bless(&mut self, version: &str, boards: &BTreeMap<String, Vec<Figure>>) {
        let rounded = |figures: &Vec<Figure>| -> Figures {
            let pairs = figures.iter();
            pairs
                .map(|f| (f.name.clone(), super::round(f.value)))
                .collect()
        };
        let boards = boards.iter();
        self.0.insert(
            release(version),
            boards
                .map(|(board, figures)| (board.clone(), rounded(figures)))
                .collect(),
        );
    }

    /// What is recorded of some boards.
    #[must_use]
    pub fn of_boards(mut self, is_of: impl Fn(&str) -> bool) -> Self {
        for boards in self.0.values_mut() {
            boards.retain(|name, _| is_of(name));
        }
        self
    }

    /// The boards that any compiler was measured for, by name.
    #[must_use]
    pub fn boards(&self) -> Vec<String> {
        let names: BTreeSet<&String> = self.0.values().flat_map(BTreeMap::keys).collect();
        names.into_iter().cloned().collect()
    }

    /// A figure as the latest compiler that has it was measured.
    #[must_use]
    pub fn latest(&self, board: &str, name: &str) -> Option<f64> {
        let mut releases: Vec<&String> = self.0.keys().collect();
        releases.sort_by_key(|release| -minor(release));
        let figure = |release: &&String| self.0[*release].get(board)?.get(name).copied();
        releases.iter().find_map(figure)
    }

    /// Holds what was measured against the record.
    #[must_use]
    pub fn judge(&self, version: &str, boards: &BTreeMap<String, Vec<Figure>>) -> Verdict {
        let own = release(version);
        let distance = |release: &&String| (minor(release) - minor(&own)).abs();
        let Some(used) = self.0.keys().min_by_key(distance) else {
            return Verdict {
                refused: all_unrecorded(boards),
                ..Verdict::default()
            };
        };
        let tolerance = if *used == own {
            TOLERANCE
        } else {
            TOLERANCE_OTHER
        };
        let mut verdict = Verdict {
            other: (*used != own).then(|| used.clone()),
            ..Verdict::default()
        };
        let none = Figures::new();
        for (board, figures) in boards {
            let recorded = self.0[used].get(board).unwrap_or(&none);
            for figure in figures {
                let Some(&old) = recorded.get(&figure.name) else {
                    verdict.refuse(board, &figure.name, None, Some(figure.value));
                    continue;
                };
                let new = super::round(figure.value);
                if new > old * (1.0 + tolerance) + figure.grain {
                    verdict.refuse(board, &figure.name, Some(old), Some(new));
                } else if new < old * (1.0 - tolerance) - figure.grain {
                    verdict.better += 1;
                }
            }
            for (name, &old) in recorded {
                if !figures.iter().any(|figure| figure.name == *name) {
                    verdict.refuse(board, name, Some(old), None);
                }
            }
        }
        for board in self.0[used]
            .keys()
            .filter(|board| !boards.contains_key(*board))
        {
            verdict.refuse(board, "everything", Some(0.0), None);
        }
        verdict
    }
}

impl Verdict {
    fn refuse(&mut self, board: &str, name: &str, recorded: Option<f64>, measured: Option<f64>) {
        self.refused.push(Refusal {
            board: board.to_owned(),
            name: name.to_owned(),
            recorded,
            measured,
        });
    }
}

fn all_unrecorded(boards: &BTreeMap<String, Vec<Figure>>) -> Vec<Refusal> {
    let mut verdict = Verdict::default();
    for (board, figures) in boards {
        for figure in figures {
            verdict.refuse(board, &figure.name, None, Some(figure.value));
        }
    }
    verdict.refused
}
