//! Runs into tables: which vertices lie together, so that an index of a table takes a byte.

use super::parts::Part;
use super::strips::Runs;
use scanbeam::list::Cone;
use std::collections::HashMap;

/// A table and what is drawn of it.
#[derive(Default)]
pub(super) struct Table {
    pub(super) vertices: Vec<u32>,
    pub(super) parts: Vec<TablePart>,
}

/// A part, or what of it is drawn of one table, in the indices of that.
#[derive(Default)]
pub(super) struct TablePart {
    pub(super) cone: Option<Cone>,
    pub(super) strips: Vec<Vec<u16>>,
    pub(super) fans: Vec<Vec<u16>>,
    pub(super) separate: Vec<[u16; 3]>,
}

impl Table {
    /// Indices, with those that end strips.
    pub(super) fn indices(&self) -> usize {
        let of = |part: &TablePart| {
            let runs = part.strips.iter().chain(&part.fans);
            runs.map(|r| r.len() + 1).sum::<usize>() + 3 * part.separate.len()
        };
        self.parts.iter().map(of).sum()
    }
}

/// Fills tables one after the other; a run that does not fit is cut, or begins a new one.
struct Tables {
    most: usize,
    done: Vec<Table>,
    index: HashMap<u32, u16>,
    /// That of the part whose runs come.
    cone: Option<Cone>,
}

impl Tables {
    /// The table that is open.
    fn open(&mut self) -> &mut Table {
        if self.done.is_empty() {
            self.done.push(Table::default());
        }
        let last = self.done.len() - 1;
        &mut self.done[last]
    }

    /// The part that is open, of that table.
    fn part(&mut self) -> &mut TablePart {
        if self.open().parts.is_empty() {
            self.begin();
        }
        let parts = &mut self.open().parts;
        let last = parts.len() - 1;
        &mut parts[last]
    }

    /// Begins a part of the table that is open.
    fn begin(&mut self) {
        let cone = self.cone;
        self.open().parts.push(TablePart {
            cone,
            ..TablePart::default()
        });
    }

    /// Whether the vertices fit the table that is open; else another is opened.
    fn make_room(&mut self, run: &[u32]) {
        let mut new: Vec<u32> = run
            .iter()
            .copied()
            .filter(|v| !self.index.contains_key(v))
            .collect();
        new.sort_unstable();
        new.dedup();
        if self.open().vertices.len() + new.len() > self.most {
            self.done.push(Table::default());
            self.index.clear();
        }
    }

    fn indices(&mut self, run: &[u32]) -> Vec<u16> {
        let mut indices = Vec::with_capacity(run.len());
        for &v in run {
            let next = self.open().vertices.len() as u16;
            let index = *self.index.entry(v).or_insert(next);
            if index == next {
                self.open().vertices.push(v);
            }
            indices.push(index);
        }
        indices
    }
}

/// A run that fits a table of its own.
enum Piece<'a> {
    Strip(&'a [u32]),
    Fan(Vec<u32>),
    Separate([u32; 3]),
}

impl Piece<'_> {
    fn corners(&self) -> &[u32] {
        match self {
            Self::Strip(run) => run,
            Self::Fan(run) => run,
            Self::Separate(t) => t,
        }
    }
}

/// Cuts runs so that each piece fits a table of `most` vertices. A strip's pieces share two vertices and begin at even
/// places, so that no triangle turns over; a fan's share its middle and one more.
fn pieces(runs: &Runs, most: usize) -> Vec<Piece<'_>> {
    let mut pieces = Vec::new();
    let longest = (most.min(60_000) / 2) & !1;
    for strip in &runs.strips {
        let mut at = 0;
        while at + 2 < strip.len() {
            let end = (at + longest).min(strip.len());
            pieces.push(Piece::Strip(&strip[at..end]));
            at = end - 2;
        }
    }
    for fan in &runs.fans {
        let mut at = 1;
        while at + 1 < fan.len() {
            let end = (at + longest).min(fan.len());
            let mut piece = vec![fan[0]];
            piece.extend(&fan[at..end]);
            pieces.push(Piece::Fan(piece));
            at = end - 1;
        }
    }
    pieces.extend(runs.separate.iter().map(|t| Piece::Separate(*t)));
    pieces
}

/// Splits parts into tables of at most `most` vertices. Parts follow one another, and one that does not fit begins a
/// table; runs of a part that share vertices with what is in a table already go first, so that few vertices are in several.
pub(super) fn tables(parts: &[Part], most: usize) -> Vec<Table> {
    let mut tables = Tables {
        most,
        done: Vec::new(),
        index: HashMap::new(),
        cone: None,
    };
    for part in parts {
        tables.cone = part.cone;
        let pieces = pieces(&part.runs, most);
        if pieces.is_empty() {
            continue;
        }
        if parts.len() > 1 {
            let all: Vec<u32> = pieces.iter().flat_map(|p| p.corners()).copied().collect();
            tables.make_room(&all);
        }
        tables.begin();
        tables.fill(pieces);
    }
    tables.done
}

impl Tables {
    fn fill(&mut self, mut pieces: Vec<Piece<'_>>) {
        let all_fit = self.most > 255;
        pieces.reverse();
        while !pieces.is_empty() {
            // The piece with the fewest new vertices for its length; all are as good in one table.
            let last = pieces.len() - 1;
            let best = if all_fit {
                last
            } else {
                let new = |p: &Piece<'_>| {
                    let run = p.corners();
                    let new = run.iter().filter(|v| !self.index.contains_key(v)).count();
                    1000 * new / run.len()
                };
                // Of many only the last are looked at, so that large models take their time too.
                let near = last.saturating_sub(4096);
                let found = (near..=last).min_by_key(|n| new(&pieces[*n]));
                found.unwrap_or(last)
            };
            let piece = pieces.swap_remove(best);
            self.make_room(piece.corners());
            let indices = self.indices(piece.corners());
            let part = self.part();
            match piece {
                Piece::Strip(_) => part.strips.push(indices),
                Piece::Fan(_) => part.fans.push(indices),
                Piece::Separate(_) => part.separate.push([indices[0], indices[1], indices[2]]),
            }
        }
    }
}
