//! Coverage, three ways: the model's spans, the definition, and edge functions (K4, B4).

use super::{EdgeFunctions, ModelSpan};
use crate::random::Rng;

/// Three corners in a square of `size` eighths of a pixel, on a grid of `grid` of them.
fn triangle(rng: &mut Rng, size: u32, grid: u32) -> [(u16, u16); 3] {
    let base = [(); 2].map(|()| rng.below(65_536 - size));
    [(); 3].map(|()| {
        let [x, y] = base.map(|base| (base + rng.below(size)) / grid * grid);
        (x as u16, y as u16)
    })
}

/// Sizes and grids that random triangles are made on: on coarse grids centres lie on edges, and
/// corners fall together.
const KINDS: [(u32, u32); 6] = [(9, 1), (64, 4), (200, 1), (400, 4), (4000, 1), (65_536, 1)];

fn spans(p: [(u16, u16); 3], line: i32) -> Option<(i32, i32)> {
    let [a, b, c] = p;
    let y = (8 * line + 4) as u16;
    let (from, to) = ModelSpan::new([(0, a), (1, b), (2, c)], y)?.columns();
    (from < to).then_some((from, to))
}

/// The columns whose centres lie right of one edge and not right of the other, by division.
fn covered(p: [(u16, u16); 3], line: i32) -> Option<(i32, i32)> {
    let y = 8 * i64::from(line) + 4;
    let p = p.map(|(x, y)| (i64::from(x), i64::from(y)));
    let (mut from, mut to) = (i32::MAX, i32::MIN);
    for (a, b) in [(p[0], p[1]), (p[1], p[2]), (p[2], p[0])] {
        let (a, b) = if a.1 < b.1 { (a, b) } else { (b, a) };
        if a.1 < y && b.1 >= y {
            // The edge is at `x / dy`; a column's centre at `8 column + 4`.
            let dy = b.1 - a.1;
            let x = a.0 * dy + (y - a.1) * (b.0 - a.0);
            let column = ((x - 4 * dy).div_euclid(8 * dy) + 1) as i32;
            (from, to) = (from.min(column), to.max(column));
        }
    }
    (from < to).then_some((from, to))
}

// The fast path is held against the same definition, in `scanbeam` itself.
#[test]
fn spans_are_those_of_the_definition() {
    let mut rng = Rng(5);
    let (mut seen, mut lines) = (0, 0);
    for i in 0..60_000 {
        let (size, grid) = KINDS[i % KINDS.len()];
        let p = triangle(&mut rng, size, grid);
        let (top, bottom) = p.iter().fold((8191, 0), |(top, bottom), p| {
            let line = i32::from(p.1 >> 3);
            (line.min(top), line.max(bottom))
        });
        let step = ((bottom - top) / 20).max(1) as usize;
        for line in (top..=bottom).step_by(step) {
            let found = spans(p, line);
            assert_eq!(found, covered(p, line), "{p:?} line {line}");
            lines += 1;
            seen += usize::from(found.is_some());
        }
    }
    assert!(seen > 200_000, "{seen} of {lines}");
}

#[test]
fn edge_functions_cover_the_same_pixels_stepped_and_from_scratch() {
    let mut rng = Rng(6);
    let (mut covered, mut on_edges) = (0, 0);
    for i in 0..30_000 {
        let (size, grid) = KINDS[i % 4];
        let p = triangle(&mut rng, size, grid);
        let column = p.iter().map(|p| i32::from(p.0 >> 3)).min().unwrap_or(0);
        let line = p.iter().map(|p| i32::from(p.1 >> 3)).min().unwrap_or(0);
        let reach = (size / 8 + 2) as i32;
        let Some(first) = EdgeFunctions::new(p, (column, line)) else {
            assert!((line..line + reach).all(|line| spans(p, line).is_none()));
            continue;
        };
        let mut start = first;
        for y in line..line + reach {
            let (from, to) = spans(p, y).unwrap_or((0, 0));
            let mut stepped = start;
            for x in column..column + reach {
                let anew = EdgeFunctions::new(p, (x, y));
                assert_eq!(Some(stepped), anew, "{p:?} pixel {x}, {y}");
                assert_eq!(first.moved(x - column, y - line), stepped);
                let inside = (from..to).contains(&x);
                assert_eq!(stepped.covers(), inside, "{p:?} pixel {x}, {y}");
                covered += usize::from(inside);
                on_edges += usize::from(inside && lies_on_an_edge(p, (x, y)));
                stepped.step_right();
            }
            start.step_down();
        }
    }
    assert!(covered > 1_000_000, "{covered}");
    assert!(on_edges > 1_000, "{on_edges}");
}

fn lies_on_an_edge(p: [(u16, u16); 3], (x, y): (i32, i32)) -> bool {
    let (x, y) = (8 * i64::from(x) + 4, 8 * i64::from(y) + 4);
    [(0, 1), (1, 2), (2, 0)].into_iter().any(|(a, b)| {
        let (a, b) = (p[a], p[b]);
        let d = |from: u16, to: u16| i64::from(to) - i64::from(from);
        d(a.0, b.0) * (y - i64::from(a.1)) == d(a.1, b.1) * (x - i64::from(a.0))
    })
}
