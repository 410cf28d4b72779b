//! Coverage of set-up triangles against the definition of a covered pixel (K4).

use super::super::{Gouraud, Scale, SceneVertex};
use super::{Drawable, Object};
use crate::num::random::Rng;

/// Sizes and grids that random triangles are made on: on coarse grids centres lie on edges, and
/// corners fall together.
const KINDS: [(u32, u32); 6] = [(9, 1), (64, 4), (200, 1), (400, 4), (4000, 1), (65_536, 1)];

/// Three corners in a square of `size` eighths of a pixel, on a grid of `grid` of them.
fn triangle(rng: &mut Rng, size: u32, grid: u32) -> [(u16, u16); 3] {
    let base = [(); 2].map(|()| rng.below(65_536 - size));
    [(); 3].map(|()| {
        let [x, y] = base.map(|base| (base + rng.below(size)) / grid * grid);
        (x as u16, y as u16)
    })
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

#[test]
fn spans_are_those_of_the_definition() {
    let mut rng = Rng(5);
    let (mut seen, mut lines) = (0, 0);
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
            let above = p.iter().filter(|p| i32::from(p.1) < y).count();
            let mut drawable = Drawable::EMPTY;
            let here = matches!(above, 1 | 2)
                && object.set_up::<Gouraud>(
                    &vertices,
                    &Scale::new([255; 3]),
                    (line, &picture, false),
                    &mut drawable,
                );
            let fast = here
                .then(|| drawable.columns(line, picture.start))
                .filter(|(from, to)| from < to);
            assert_eq!(covered(p, line), fast, "{p:?} line {line}");
            lines += 1;
            seen += usize::from(fast.is_some());
        }
    }
    assert!(seen > 200_000, "{seen} of {lines}");
}
