//! Coverage, three ways: the model's spans, the fast path's, and edge functions (K4, B4).

use super::{EdgeFunctions, ModelSpan};
use crate::geometry::{Drawable, Gouraud, Object, Scale, SceneVertex};
use crate::num::random::Rng;

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

#[test]
fn spans_are_those_of_the_fast_path() {
    let mut rng = Rng(5);
    let (mut covered, mut lines) = (0, 0);
    for i in 0..60_000 {
        let (size, grid) = KINDS[i % KINDS.len()];
        let p = triangle(&mut rng, size, grid);
        let vertices = p.map(|(x, y)| SceneVertex {
            x,
            y,
            ..SceneVertex::empty()
        });
        let object = Object::new([0, 1, 2], ());
        // Pictures that hold the triangle wholly, in part, or not at all.
        let left = i32::from(p[0].0 >> 3) - rng.below(300) as i32;
        let picture = left..left + [10, 300, 1023, 8192][i / 8 % 4];
        let (top, bottom) = p.iter().fold((8191, 0), |(top, bottom), p| {
            let line = i32::from(p.1 >> 3);
            (line.min(top), line.max(bottom))
        });
        let step = ((bottom - top) / 20).max(1) as usize;
        for line in (top..=bottom).step_by(step) {
            let y = 8 * line + 4;
            let below = p.iter().filter(|p| i32::from(p.1) >= y).count();
            let mut drawable = Drawable::EMPTY;
            let here = matches!(below, 1 | 2)
                && object.set_up::<Gouraud>(
                    &vertices,
                    &Scale::new([255; 3]),
                    (line, &picture, false),
                    &mut drawable,
                );
            let fast = here
                .then(|| drawable.columns(line, picture.start))
                .filter(|(from, to)| from < to);
            assert_eq!(spans(p, line), fast, "{p:?} line {line}");
            lines += 1;
            covered += usize::from(fast.is_some());
        }
    }
    assert!(covered > 200_000, "{covered} of {lines}");
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
