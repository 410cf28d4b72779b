//! What is exact at a pixel: coverage from whole numbers, the parts of corners from f64.

use super::Place;
use std::ops::Range;

/// Positive for a triangle that is clockwise to the eye (y goes down).
pub fn doubled_area([a, b, c]: [Place; 3]) -> i64 {
    let d = |p: i32, q: i32| i64::from(q) - i64::from(p);
    d(a.0, b.0) * d(a.1, c.1) - d(a.0, c.0) * d(a.1, b.1)
}

/// The columns of a triangle on a line, of a picture that has all columns, from the words of the fill
/// rule: an edge counts where `Ytop < Y <= Ybottom`, and a pixel lies between two that count where
/// `min < x <= max` is its centre.
pub fn columns(triangle: [Place; 3], line: i32) -> Range<i32> {
    let y = i64::from(8 * line + 4);
    let mut found = [i64::MAX, i64::MIN];
    for k in 0..3 {
        let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
        let (a, b) = if a.1 <= b.1 { (a, b) } else { (b, a) };
        let [ax, ay, bx, by] = [a.0, a.1, b.0, b.1].map(i64::from);
        if ay < y && y <= by {
            // The first column with 8 c + 4 > ax + (y - ay) dx / dy.
            let dy = by - ay;
            let first = ((y - ay) * (bx - ax) + (ax - 4) * dy).div_euclid(8 * dy) + 1;
            found = [found[0].min(first), found[1].max(first)];
        }
    }
    if found[0] > found[1] {
        return 0..0;
    }
    found[0] as i32..found[1] as i32
}

/// [`columns`] within a picture so wide.
pub fn within(triangle: [Place; 3], line: i32, width: u16) -> Range<usize> {
    let all = columns(triangle, line);
    let cut = |c: i32| c.clamp(0, width.into()) as usize;
    cut(all.start)..cut(all.end)
}

/// The parts of the corners at a pixel's centre, and their steps to the next column.
pub fn weights(p: [Place; 3], column: i32, line: i32) -> ([f64; 3], [f64; 3]) {
    let at = |column: i32| {
        let at = (8 * column + 4, 8 * line + 4);
        let area = doubled_area(p) as f64;
        [[at, p[1], p[2]], [p[0], at, p[2]], [p[0], p[1], at]]
            .map(|t| doubled_area(t) as f64 / area)
    };
    let (here, next) = (at(column), at(column + 1));
    (here, [0, 1, 2].map(|k| next[k] - here[k]))
}
