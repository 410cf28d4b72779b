//! Cusp polygons: a triangle clipped by a rectangle, as a left and a right chain (P2).
//!
//! Going down, each side of the polygon is a chain: from a cusp to the next it follows an edge of the
//! triangle or a side of the rectangle. Cusps are not rounded, as new corners would be: an entry says on
//! which line it takes over, and from there the edge itself says the column, exactly as without
//! clipping. So spans are those of the whole triangle, cut; what is linear on it is taken from its own
//! three corners, and clipping leaves no trace.
//!
//! Five entries are the most, three on the side of the middle corner and two on the other: with the lower
//! ends of both chains these are the seven corners that a clipped triangle can have.

use crate::exact::{column_exact, first_at};
use core::ops::Range;
use heapless::Vec;

/// What a chain follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CuspSide {
    /// The edge from one corner down to another, 13.3.
    Edge((u16, u16), (u16, u16)),
    /// A side of the rectangle: this column.
    Wall(i32),
}

impl CuspSide {
    /// The first column right of it on a line that it reaches.
    #[must_use]
    pub fn column(&self, line: i32) -> i32 {
        match *self {
            Self::Edge(from, to) => column_exact(from, to, line),
            Self::Wall(column) => column,
        }
    }
}

/// Where a chain begins to follow something else.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cusp {
    /// The first line of that.
    pub line: i32,
    /// What it follows from there on.
    pub side: CuspSide,
}

/// One side of a polygon, from top to bottom. Of four places three are used at most.
type Chain = Vec<Cusp, 4, u8>;

/// A triangle clipped by a rectangle.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CuspPolygon {
    lines: Range<i32>,
    left: Chain,
    right: Chain,
}

/// An edge and its lines.
type EdgeLines = (CuspSide, Range<i32>);

impl CuspPolygon {
    /// The triangle of these corners, 13.3, in a rectangle of columns and lines; `None` when it has
    /// nothing there.
    #[must_use]
    pub fn clipped(
        mut corners: [(u16, u16); 3],
        columns: &Range<i32>,
        lines: &Range<i32>,
    ) -> Option<Self> {
        corners.sort_unstable_by_key(|corner| corner.1);
        let [top, middle, bottom] = corners;
        let edge = |a: (u16, u16), b: (u16, u16)| -> EdgeLines {
            (CuspSide::Edge(a, b), first_at(a.1)..first_at(b.1))
        };
        let long = [edge(top, bottom)];
        let short = [edge(top, middle), edge(middle, bottom)];
        let to = |p: u16, q: u16| i64::from(q) - i64::from(p);
        let turn =
            to(top.0, bottom.0) * to(top.1, middle.1) - to(top.0, middle.0) * to(top.1, bottom.1);
        // Above 0 where the middle corner is left of the long edge.
        let (left, right): (&[_], &[_]) = if turn > 0 {
            (&short, &long)
        } else {
            (&long, &short)
        };
        let mut lines = first_at(top.1).max(lines.start)..first_at(bottom.1).min(lines.end);
        // Convex: what is beyond a wall is at the top or at the bottom.
        let beyond = |line: i32| {
            at(left, line).is_none_or(|c| c >= columns.end)
                || at(right, line).is_none_or(|c| c <= columns.start)
        };
        while !lines.is_empty() && beyond(lines.start) {
            lines.start += 1;
        }
        while !lines.is_empty() && beyond(lines.end - 1) {
            lines.end -= 1;
        }
        if lines.is_empty() {
            return None;
        }
        let (from, to) = (columns.start, columns.end);
        Some(Self {
            left: chain(left, &lines, from, &|column| column >= from),
            right: chain(right, &lines, to, &|column| column <= to),
            lines,
        })
    }

    /// The lines on which it is.
    #[must_use]
    pub fn lines(&self) -> Range<i32> {
        self.lines.clone()
    }

    /// The left chain, then the right one.
    #[must_use]
    pub fn chains(&self) -> [&[Cusp]; 2] {
        [&self.left, &self.right]
    }

    /// First covered column on a line and the first after the last, if any is.
    #[must_use]
    pub fn span(&self, line: i32) -> Option<(i32, i32)> {
        let column = |chain: &[Cusp]| {
            let cusp = chain.iter().rev().find(|cusp| cusp.line <= line)?;
            Some(cusp.side.column(line))
        };
        if !self.lines.contains(&line) {
            return None;
        }
        let (from, to) = (column(&self.left)?, column(&self.right)?);
        (from < to).then_some((from, to))
    }
}

/// The column of edges on a line.
fn at(edges: &[EdgeLines], line: i32) -> Option<i32> {
    let edge = edges.iter().find(|(_, lines)| lines.contains(&line))?;
    Some(edge.0.column(line))
}

/// Edges where `keeps` has their columns, and the wall elsewhere.
fn chain(edges: &[EdgeLines], lines: &Range<i32>, wall: i32, keeps: &dyn Fn(i32) -> bool) -> Chain {
    let mut chain = Chain::new();
    let mut follow = |line: i32, inside: bool, edge: CuspSide| {
        let side = if inside { edge } else { CuspSide::Wall(wall) };
        if chain.last().is_none_or(|cusp: &Cusp| cusp.side != side) {
            // There is a place, as said above.
            let _ = chain.push(Cusp { line, side });
        }
    };
    for (edge, reach) in edges {
        let (start, end) = (reach.start.max(lines.start), reach.end.min(lines.end));
        if start >= end {
            continue;
        }
        let inside = |line| keeps(edge.column(line));
        let (first, last) = (inside(start), inside(end - 1));
        follow(start, first, *edge);
        if first != last {
            // An edge goes one way, so it crosses the wall once.
            let (mut before, mut after) = (start, end - 1);
            while after - before > 1 {
                let line = before + (after - before) / 2;
                if inside(line) == first {
                    before = line;
                } else {
                    after = line;
                }
            }
            follow(after, last, *edge);
        }
    }
    chain
}

#[cfg(test)]
mod tests {
    use super::super::ModelSpan;
    use super::*;
    use crate::random::Rng;

    /// What the whole triangle has on a line, by vertex sort.
    fn whole(corners: [(u16, u16); 3], line: i32) -> Option<(i32, i32)> {
        let [a, b, c] = corners;
        let y = (8 * line + 4) as u16;
        Some(ModelSpan::new([(0, a), (1, b), (2, c)], y)?.columns())
    }

    fn random(rng: &mut Rng, size: u32) -> [(u16, u16); 3] {
        [(); 3].map(|()| {
            let at = |rng: &mut Rng| (2_000 + rng.below(size)) as u16;
            (at(rng), at(rng))
        })
    }

    #[test]
    fn spans_are_those_of_the_whole_triangle_cut() {
        let mut rng = Rng(21);
        let (mut spans, mut longest, mut counts) = (0, 0, [0; 6]);
        for round in 0..60_000 {
            let size = [9, 60, 400, 3_000][round % 4];
            let mut corners = random(&mut rng, size);
            if round % 7 == 0 {
                corners[1].1 = corners[0].1;
            }
            let mut side = || {
                let end = |rng: &mut Rng| 248 + rng.below(size / 8 + 4) as i32;
                let (a, b) = (end(&mut rng), end(&mut rng));
                a.min(b)..a.max(b)
            };
            let (columns, lines) = (side(), side());
            let polygon = CuspPolygon::clipped(corners, &columns, &lines);
            for line in 245..255 + size as i32 / 8 {
                let cut = whole(corners, line)
                    .filter(|_| lines.contains(&line))
                    .map(|(from, to)| (from.max(columns.start), to.min(columns.end)))
                    .filter(|(from, to)| from < to);
                let span = polygon.as_ref().and_then(|p| p.span(line));
                assert_eq!(span, cut, "{corners:?} {columns:?} {lines:?} {line}");
                spans += u32::from(cut.is_some());
            }
            if let Some(polygon) = polygon {
                let [left, right] = polygon.chains().map(<[Cusp]>::len);
                assert!(left.max(right) <= 3 && left.min(right) >= 1);
                assert!(left + right <= 5);
                longest = longest.max(left + right);
                counts[left + right] += 1;
                for chain in polygon.chains() {
                    assert_eq!(chain[0].line, polygon.lines().start);
                    assert!(chain.is_sorted_by(|a, b| a.line < b.line));
                    assert!(
                        chain
                            .iter()
                            .all(|cusp| polygon.lines().contains(&cusp.line))
                    );
                }
            }
        }
        assert!(spans > 200_000, "{spans}");
        assert_eq!(longest, 5);
        assert!(counts[2..].iter().all(|n| *n > 100), "{counts:?}");
    }

    #[test]
    fn a_triangle_cut_at_all_four_sides_has_seven_corners() {
        let corners = [(4_000, 1_000), (800, 3_000), (4_400, 4_000)];
        let walls = |chain: &[Cusp]| {
            let is_wall = |cusp: &&Cusp| matches!(cusp.side, CuspSide::Wall(_));
            chain.iter().filter(is_wall).count()
        };
        // Cut at the top, the left and the bottom: two corners, two and two.
        let polygon = CuspPolygon::clipped(corners, &(150..560), &(160..450)).unwrap();
        assert_eq!(polygon.chains().map(<[Cusp]>::len), [3, 1]);
        assert_eq!(polygon.chains().map(walls), [1, 0]);
        // And at the right, across the edge: one more.
        let polygon = CuspPolygon::clipped(corners, &(150..530), &(160..450)).unwrap();
        assert_eq!(polygon.chains().map(<[Cusp]>::len), [3, 2]);
        assert_eq!(polygon.chains().map(walls), [1, 1]);
    }
}
