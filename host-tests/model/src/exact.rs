//! Where an edge meets a scanline, by one exact division (K4).
//!
//! An edge from `(x0, y0)` down to `(x1, y1)`, in units of 1/8 pixel, meets the centre of line `j`
//! (`Y = 8 j + 4`) at `x0 + (Y - y0) dx / dy`. A pixel is covered when its centre lies right of the
//! left edge, or right of none and on the right one: both ends of a span are the first column whose
//! centre is right of an edge.

/// The first line or column whose centre is not above or left of the 13.3 coordinate `at`.
pub(crate) fn first_at(at: u16) -> i32 {
    (i32::from(at) + 4) >> 3
}

/// The first column right of the edge from `a` down to `b` (`a.1 < b.1`) on a line.
pub(crate) fn column_exact(a: (u16, u16), b: (u16, u16), line: i32) -> i32 {
    let [dx, dy] = [(a.0, b.0), (a.1, b.1)].map(|(from, to)| i64::from(to) - i64::from(from));
    let down = i64::from(8 * line + 4) - i64::from(a.1);
    let x = i64::from(a.0) + (down * dx).div_euclid(dy);
    ((x + 4) >> 3) as i32
}
