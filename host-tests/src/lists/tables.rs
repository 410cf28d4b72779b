//! Runs into tables: which vertices lie together, so that an index of a table takes a byte.

use super::strips::Runs;
use std::collections::HashMap;

/// A table and the runs over it, in its own indices.
#[derive(Default)]
pub(super) struct Table {
    pub(super) vertices: Vec<u32>,
    pub(super) strips: Vec<Vec<u16>>,
    pub(super) fans: Vec<Vec<u16>>,
    pub(super) separate: Vec<[u16; 3]>,
}

impl Table {
    /// Indices, with those that end strips.
    pub(super) fn indices(&self) -> usize {
        let runs = self.strips.iter().chain(&self.fans);
        runs.map(|r| r.len() + 1).sum::<usize>() + 3 * self.separate.len()
    }
}

/// Fills tables one after the other; a run that does not fit is cut, or begins a new one.
struct Tables {
    most: usize,
    done: Vec<Table>,
    index: HashMap<u32, u16>,
}

impl Tables {
    fn open(&mut self) -> &mut Table {
        if self.done.is_empty() {
            self.done.push(Table::default());
        }
        let last = self.done.len() - 1;
        &mut self.done[last]
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

/// Splits runs into tables of at most `most` vertices. Runs that share vertices with what is in a
/// table already go first, so that few vertices are in several.
pub(super) fn tables(runs: &Runs, most: usize) -> Vec<Table> {
    enum Piece<'a> {
        Strip(&'a [u32]),
        Fan(Vec<u32>),
        Separate([u32; 3]),
    }
    let mut pieces = Vec::new();
    // Cut so that each fits a table of its own. A strip's pieces share two vertices and begin at
    // even places, so that no triangle turns over; a fan's share its middle and one more.
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

    let mut tables = Tables {
        most,
        done: Vec::new(),
        index: HashMap::new(),
    };
    fn corners<'a>(piece: &'a Piece<'_>) -> &'a [u32] {
        match piece {
            Piece::Strip(run) => run,
            Piece::Fan(run) => run,
            Piece::Separate(t) => t,
        }
    }
    let all_fit = most > 255;
    pieces.reverse();
    while !pieces.is_empty() {
        // The piece with the fewest new vertices for its length; all are as good in one table.
        let last = pieces.len() - 1;
        let best = if all_fit {
            last
        } else {
            let new = |p: &Piece<'_>| {
                let run = corners(p);
                let new = run.iter().filter(|v| !tables.index.contains_key(v)).count();
                1000 * new / run.len()
            };
            // Of many only the last are looked at, so that large models take their time too.
            let near = last.saturating_sub(4096);
            let found = (near..=last).min_by_key(|n| new(&pieces[*n]));
            found.unwrap_or(last)
        };
        let piece = pieces.swap_remove(best);
        tables.make_room(corners(&piece));
        let indices = tables.indices(corners(&piece));
        let table = tables.open();
        match piece {
            Piece::Strip(_) => table.strips.push(indices),
            Piece::Fan(_) => table.fans.push(indices),
            Piece::Separate(_) => table.separate.push([indices[0], indices[1], indices[2]]),
        }
    }
    tables.done
}
