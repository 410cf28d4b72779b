//! The suite as a table: ours and the best of others, on every board.
//!
//! README has it between two markers; `firmware --bench --bless` writes it, and a test says that it is what the
//! record has.

use super::gate::Record;
use crate::bench::table::rewrite;
use crate::firmware::{BOARDS, workspace};
use scenes::{SUITE, Suite};
use std::error::Error;
use std::fmt::Write as _;

/// What stands before and after the table in the README.
pub const MARKERS: [&str; 2] = [
    "<!-- suite: written by `firmware --bench --bless` -->",
    "<!-- /suite -->",
];

/// What the best of other renderers take for a scene of the suite, in million instructions: with
/// floating point on an M4F, in integers on an M3 and in M0+ code. Their pictures are less exact.
const BEST_PEERS: [(&str, [f64; 3]); 7] = [
    ("a", [1.83, 2.99, 7.21]),
    ("b", [2.66, 3.95, 9.07]),
    ("b_unlit", [1.97, 3.59, 12.7]),
    ("c_f2n", [34.0, 34.3, 57.1]),
    ("c_n2f", [16.7, 15.9, 25.5]),
    ("f", [2.43, 4.08, 8.96]),
    ("g", [4.33, 7.14, 18.2]),
];

/// A scene of the suite on one board: million instructions, where they are known.
struct Cell {
    /// Ours.
    ours: Option<f64>,
    /// The best other renderer.
    peer: Option<f64>,
}

impl Cell {
    fn text(&self) -> String {
        let some = |value: Option<f64>| value.map_or("-".to_owned(), |v| format!("{v:.2}"));
        let mut out = format!("**{}**", some(self.ours));
        if let Some(peer) = self.peer {
            // Writing to a string cannot fail.
            let _ = write!(out, " / {peer:?}");
        }
        out
    }
}

/// What a scene is, for people.
pub fn title(scene: &str) -> &'static str {
    match scene {
        "a" => "A: sphere of 2,048 triangles, tilted",
        "b" => "B: the same, textured and lit",
        "b_unlit" => "B unlit",
        "c_f2n" => "C: 16 quads, far to near",
        "c_n2f" => "C: near to far",
        "f" => "F: 27 textured cubes",
        "g" => "G: sphere of 8,192 triangles",
        "teapot" => "teapot of 2,256 triangles",
        "inside" => "inside a room, with the teapot",
        _ => "another scene",
    }
}

/// The head and a row for each scene.
#[must_use]
pub fn rows(record: &Record) -> Vec<Vec<String>> {
    let row = |suite: Suite| {
        let scene = suite.name();
        let peers = BEST_PEERS.iter().find(|(name, _)| *name == scene);
        let cells = (0..).zip(BOARDS).map(|(at, board)| {
            let figure = record.latest(board.name, &format!("frame {scene}"));
            let cell = Cell {
                ours: figure.map(|instructions| instructions / 1e6),
                peer: peers.map(|(_, best)| best[at]),
            };
            cell.text()
        });
        let title = [title(scene).to_owned()];
        title.into_iter().chain(cells).collect()
    };
    let head = ["scene", "Cortex-M4", "Cortex-M3", "M0+ code"].map(str::to_owned);
    let rows = SUITE.into_iter().map(row);
    [head.to_vec()].into_iter().chain(rows).collect()
}

/// The table, of what is recorded.
pub fn markdown(record: &Record) -> String {
    let mut out = String::new();
    for (at, row) in rows(record).iter().enumerate() {
        // Writing to a string cannot fail.
        let _ = writeln!(out, "| {} |", row.join(" | "));
        if at == 0 {
            let _ = writeln!(out, "|{}", " --- |".repeat(row.len()));
        }
    }
    out
}

/// Writes the table of the README anew.
///
/// # Errors
/// When the README has no markers, or cannot be read or written.
pub fn write(record: &Record) -> Result<(), Box<dyn Error>> {
    rewrite(&workspace().join("README.md"), MARKERS, &markdown(record))
}
