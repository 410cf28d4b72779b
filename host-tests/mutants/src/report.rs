//! What was found, as a table by room.

use crate::site::Mutant;
use crate::trial::{Fate, Tried};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

/// Counts of a room.
#[derive(Debug, Default, Clone, PartialEq)]
pub struct Row {
    /// Those that compile.
    pub mutants: usize,
    /// Those that were tried.
    pub tried: usize,
    /// Noticed by a test that failed.
    pub killed: usize,
    /// Noticed by arithmetic that is checked in tests alone.
    pub overflowed: usize,
    /// Noticed by a test that took too long.
    pub late: usize,
    /// Noticed by the firmware alone.
    pub dearer: usize,
    /// Lived, and nothing can notice them.
    pub equal: usize,
    /// Lived.
    pub lived: usize,
    /// Lived so far.
    pub open: usize,
    /// Reached by no test.
    pub unreached: usize,
}

impl Row {
    fn count(&mut self, fate: Fate, is_known: bool) {
        self.tried += 1;
        *match fate {
            Fate::Killed => &mut self.killed,
            Fate::Overflowed => &mut self.overflowed,
            Fate::Late => &mut self.late,
            Fate::Dearer => &mut self.dearer,
            Fate::Lived | Fate::Open | Fate::Unreached if is_known => &mut self.equal,
            Fate::Lived => &mut self.lived,
            Fate::Open => &mut self.open,
            Fate::Unreached => &mut self.unreached,
        } += 1;
    }

    fn add(&mut self, other: &Row) {
        self.mutants += other.mutants;
        self.tried += other.tried;
        self.killed += other.killed;
        self.overflowed += other.overflowed;
        self.late += other.late;
        self.dearer += other.dearer;
        self.equal += other.equal;
        self.lived += other.lived;
        self.open += other.open;
        self.unreached += other.unreached;
    }

    /// How many of those tried that can be noticed were, in percent, and the standard error of that
    /// as a sample of all. `None` where none was tried.
    #[must_use]
    pub fn rate(&self) -> Option<Rate> {
        let count = self.tried - self.equal;
        if count == 0 {
            return None;
        }
        let noticed = self.killed + self.overflowed + self.late + self.dearer;
        let part = noticed as f64 / count as f64;
        // Of a whole room nothing is left to chance.
        let left = 1.0 - self.tried as f64 / self.mutants.max(1) as f64;
        let variance = part * (1.0 - part) / count as f64 * left.max(0.0);
        Some(Rate {
            percent: 100.0 * part,
            error: 100.0 * variance.sqrt(),
        })
    }

    fn cells(&self) -> [String; 11] {
        let rate = match self.rate() {
            Some(rate) => format!("{:.1} ± {:.1}", rate.percent, rate.error),
            None => "-".to_owned(),
        };
        [
            self.mutants.to_string(),
            self.tried.to_string(),
            self.killed.to_string(),
            self.overflowed.to_string(),
            self.late.to_string(),
            self.dearer.to_string(),
            self.equal.to_string(),
            self.lived.to_string(),
            self.open.to_string(),
            self.unreached.to_string(),
            rate,
        ]
    }
}

/// How many mutants were noticed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rate {
    /// In percent.
    pub percent: f64,
    /// Standard error, in percent.
    pub error: f64,
}

/// The heads of the columns.
const HEADS: [&str; 12] = [
    "room",
    "mutants",
    "tried",
    "failed",
    "overflow",
    "by time",
    "by firmware",
    "equal",
    "lived",
    "open",
    "not reached",
    "noticed, %",
];

/// Rows by room, and one of them all.
#[must_use]
pub fn rows(
    mutants: &[Mutant],
    is_live: impl Fn(usize) -> bool,
    tried: &[Tried],
    known: &BTreeSet<String>,
) -> Vec<(String, Row)> {
    let mut rooms: BTreeMap<&str, Row> = BTreeMap::new();
    for (id, mutant) in mutants.iter().enumerate() {
        if is_live(id) {
            rooms.entry(mutant.room()).or_default().mutants += 1;
        }
    }
    for one in tried {
        let mutant = &mutants[one.id];
        let row = rooms.entry(mutant.room()).or_default();
        row.count(one.fate, known.contains(&mutant.name()));
    }
    let mut all = Row::default();
    for row in rooms.values() {
        all.add(row);
    }
    let mut rows: Vec<_> = (rooms.into_iter())
        .map(|(room, row)| (room.to_owned(), row))
        .collect();
    rows.push(("all".to_owned(), all));
    rows
}

/// The table in Markdown, which is read as plain text as well.
#[must_use]
pub fn table(rows: &[(String, Row)]) -> String {
    let mut lines = vec![HEADS.map(str::to_owned)];
    for (room, row) in rows {
        let mut cells = row.cells().into_iter();
        let mut name = Some(room.clone());
        lines.push(std::array::from_fn(|_| {
            name.take().or_else(|| cells.next()).unwrap_or_default()
        }));
    }
    let width = |column: usize| {
        let cells = lines.iter().map(|line| line[column].chars().count());
        cells.max().unwrap_or(0)
    };
    let widths: [usize; 12] = std::array::from_fn(width);
    let mut text = String::new();
    for (number, line) in lines.iter().enumerate() {
        for (column, cell) in line.iter().enumerate() {
            let width = widths[column];
            let _ = match column {
                0 => write!(text, "| {cell:<width$} |"),
                _ => write!(text, " {cell:>width$} |"),
            };
        }
        text.push('\n');
        if number == 0 {
            for (column, width) in widths.iter().enumerate() {
                let (start, end) = if column == 0 {
                    ("| ", " |")
                } else {
                    (" ", ": |")
                };
                let dashes = if column == 0 { *width } else { width - 1 };
                let _ = write!(text, "{start}{}{end}", "-".repeat(dashes));
            }
            text.push('\n');
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Kills: equal mutants among those that can be noticed, and a standard error of a whole room.
    #[test]
    fn rates_are_of_what_can_be_noticed() {
        let mut row = Row {
            mutants: 200,
            ..Row::default()
        };
        assert_eq!(row.rate(), None);
        for _ in 0..80 {
            row.count(Fate::Killed, false);
        }
        for _ in 0..10 {
            row.count(Fate::Late, false);
            row.count(Fate::Lived, true);
        }
        for _ in 0..5 {
            row.count(Fate::Unreached, false);
            row.count(Fate::Overflowed, false);
        }
        // 95 of 100; 110 of 200 were tried, so 45 % of the variance is left.
        let rate = row.rate().unwrap();
        assert!((rate.percent - 95.0).abs() < 1e-9, "{rate:?}");
        assert!(
            (rate.error - (0.05_f64 * 0.95 * 45.0).sqrt()).abs() < 1e-9,
            "{rate:?}"
        );
        row.mutants = 110;
        assert_eq!(row.rate().unwrap().error, 0.0);
    }
}
