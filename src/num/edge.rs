//! Where an edge meets a scanline, exactly (K4, K5).
//!
//! An edge from `(x0, y0)` down to `(x1, y1)`, in units of 1/8 pixel, meets the centre of
//! scanline `j` (`Y = 8 j + 4`) at `x = x0 + (Y - y0) dx / dy`, a rational. A pixel is covered
//! when `min < x <= max` at its centre, so all that is ever asked is the first column whose
//! centre is right of the edge: `floor((x + 4) / 8)`. Both ends of a span ask the same
//! question, hence adjacent triangles leave no gap and hit no pixel twice.
//!
//! The floor is taken by one multiply-add: the true value is a multiple of `1 / (8 dy)`, so a
//! fixed-point line that starts a bias above it and errs by less than that bias has the same
//! floor. [`Edge`] does it in 32 bits for 1,023 columns and at most 127 lines, or a vertical edge
//! of any height; all others are divided out by [`column_exact`]. Both are evaluated for any line
//! alone, without state.

use super::short::{self, SHORT};

/// The first line or column whose centre lies beyond the 13.3 coordinate `at`.
///
/// A triangle from `top` to `bottom` is on the lines `first_at(top) .. first_at(bottom)`.
#[inline]
#[must_use]
pub const fn first_at(at: u16) -> i32 {
    (at as i32 + 4) >> 3
}

/// The first column right of the edge on scanline `line`, by an exact division.
///
/// The definition that the fast form is held against. `a` is the upper end (`a.1 < b.1`);
/// coordinates are 13.3. On the edge's upper 4,096 lines the division has 32 bits: one
/// instruction on a Cortex-M4, where one of 64 takes some hundred.
#[inline(never)]
pub const fn column_exact(a: (u16, u16), b: (u16, u16), line: i32) -> i32 {
    let dy = b.1 as i32 - a.1 as i32;
    let dx = b.0 as i32 - a.0 as i32;
    let down = 8 * line + 4 - a.1 as i32;
    // Whole units of the way, rounded down: what is cut off cannot reach the next column's centre.
    let way = if (down as u32) < 1 << 15 {
        (down * dx).div_euclid(dy)
    } else {
        (down as i64 * dx as i64).div_euclid(dy as i64) as i32
    };
    (a.0 as i32 + 4 + way) >> 3
}

/// `dx / dy` in units of 2^-22 column a line, by the reciprocal of a `dy` in 1 ..= 512.
#[inline(always)]
fn slope(dx: i32, dy: u32) -> i32 {
    if SHORT {
        short::side_times(dx, short::of_side(dy) as i32)
    } else {
        let recip = i32::MAX as u32 / dy;
        ((i64::from(dx) * i64::from(recip)) >> 9) as i32
    }
}

/// An edge as `column = (at + slope line) >> 22`, modulo 2^32, counted from an origin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    at: i32,
    slope: i32,
}

impl Edge {
    /// An edge that is never asked.
    pub const NONE: Self = Self { at: 0, slope: 0 };

    /// Whether the 32-bit form is exact for an edge with this difference.
    ///
    /// The columns themselves must also lie within what is read from it: 0 to 1,023 columns right
    /// of the origin for [`right_of`](Edge::right_of), 511 either way for
    /// [`column`](Edge::column).
    #[inline]
    #[must_use]
    pub const fn holds(dx: i32, dy: i32) -> bool {
        dy < 1024 || dx == 0
    }

    /// Sets up the edge from the 13.3 point `a` down by `(dx, dy)`, `dy` above 0, to be counted
    /// from the column `origin`.
    ///
    /// Error: the slope is a floor to 2^-22 column, so after 127 lines the line lies less than
    /// 130 units of 2^-22 below the truth; the bias is 256 and the truth a multiple of at least
    /// 512 of them.
    #[inline(always)]
    #[must_use]
    pub fn new(a: (u16, u16), (dx, dy): (i32, i32), origin: i32) -> Self {
        debug_assert!(dy > 0 && Self::holds(dx, dy));
        let start = ((i32::from(a.0) + 4 - 8 * origin) << 19).wrapping_add(256);
        if dx == 0 {
            return Self {
                at: start,
                slope: 0,
            };
        }
        // dy is above 0; said so that no check for it is compiled in.
        let height = dy.max(1);
        let mut whole = dx / height;
        let mut rest = dx - whole * height;
        if rest < 0 {
            whole -= 1;
            rest += height;
        }
        let part = ((rest as u32) << 22) / height as u32;
        let part = part as i32;
        let slope = (whole << 22).wrapping_add(part);
        let first = first_at(a.1);
        let down = 8 * first + 4 - i32::from(a.1);
        let at = start
            .wrapping_add(whole.wrapping_mul(down) << 19)
            .wrapping_add((part * down) >> 3);
        Self {
            at: at.wrapping_sub(slope.wrapping_mul(first)),
            slope,
        }
    }

    /// Sets up an edge of at most 512 units either way, as [`new`](Edge::new) does others, with
    /// one division.
    ///
    /// Error: the reciprocal is up to 1.01 units of 2^-31 below the truth, so the slope is less
    /// than 2 units of 2^-22 column off, and after 65 lines the line less than 140 units, either
    /// way; the bias is 256 and the truth a multiple of at least 1024 of them.
    #[inline(always)]
    #[must_use]
    pub fn small(a: (u16, u16), (dx, dy): (i32, i32), origin: i32) -> Self {
        debug_assert!(dy > 0 && dy <= 512 && dx.abs() <= 512);
        let start = ((i32::from(a.0) + 4 - 8 * origin) << 19).wrapping_add(256);
        // dy is above 0; said so that no check for it is compiled in.
        let slope = slope(dx, (dy as u32).max(1));
        let first = first_at(a.1);
        let down = 8 * first + 4 - i32::from(a.1);
        let way = if SHORT {
            short::eighth(slope, down)
        } else {
            ((i64::from(slope) * i64::from(down)) >> 3) as i32
        };
        let at = start.wrapping_add(way);
        Self {
            at: at.wrapping_sub(slope.wrapping_mul(first)),
            slope,
        }
    }

    /// The line's value on line 0 and its step, for those who count lines from elsewhere.
    #[must_use]
    pub const fn at_and_slope(self) -> (i32, i32) {
        (self.at, self.slope)
    }

    /// A corner kept in place of an edge, for triangles that are divided out.
    #[must_use]
    pub fn from_corner((x, y): (u16, u16)) -> Self {
        Self {
            at: i32::from(x),
            slope: i32::from(y),
        }
    }

    /// The corner of [`from_corner`](Edge::from_corner).
    #[must_use]
    pub const fn as_corner(self) -> (u16, u16) {
        (self.at as u16, self.slope as u16)
    }

    /// The first column right of the edge on scanline `line`, within 511 of the origin.
    #[inline(always)]
    #[must_use]
    pub const fn column(self, line: i32) -> i32 {
        self.at.wrapping_add(self.slope.wrapping_mul(line)) >> 22
    }

    /// The first column right of the edge on scanline `line`, 0 to 1,023 right of the origin.
    #[inline(always)]
    #[must_use]
    pub const fn right_of(self, line: i32) -> u32 {
        self.at.wrapping_add(self.slope.wrapping_mul(line)) as u32 >> 22
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::GUARD_CENTRE;
    use crate::num::random::Rng;

    #[test]
    fn a_column_is_the_floor_of_the_rational() {
        let mut rng = Rng(5);
        let mut tall = 0u64;
        for _ in 0..40_000 {
            let mut at = || rng.below(65_536) as u16;
            let (mut a, mut b) = ((at(), at()), (at(), at()));
            if a.1 > b.1 {
                (a, b) = (b, a);
            }
            let (first, end) = (first_at(a.1), first_at(b.1));
            for line in [first, (first + end) / 2, end - 1] {
                if line < first || line >= end {
                    continue;
                }
                let [x, dx] = [i64::from(a.0), i64::from(b.0) - i64::from(a.0)];
                let dy = i64::from(b.1) - i64::from(a.1);
                let down = 8 * i64::from(line) + 4 - i64::from(a.1);
                // floor((x + 4 + down dx / dy) / 8)
                let whole = ((x + 4) * dy + down * dx).div_euclid(8 * dy);
                assert_eq!(
                    i64::from(column_exact(a, b, line)),
                    whole,
                    "{a:?} {b:?} {line}"
                );
                tall += u64::from(down >= 1 << 15);
            }
        }
        assert!(tall > 5_000, "{tall}");
    }

    #[test]
    fn narrow_edges_are_exact() {
        let mut rng = Rng(1);
        let low = 8 * (GUARD_CENTRE - 511);
        let mut asked = 0u64;
        for i in 0..400_000 {
            let (range, height) = match i % 4 {
                0 => (8176, 1023),
                1 => (64, 1023),
                2 => (8176, 16),
                _ => (200, 200),
            };
            let x0 = (low as u32 + rng.below(range)) as u16;
            let x1 = (low as u32 + rng.below(range)) as u16;
            let y0 = rng.below(64_000) as u16;
            let y1 = y0 + 1 + rng.below(height) as u16;
            let edge = Edge::new(
                (x0, y0),
                (i32::from(x1) - i32::from(x0), i32::from(y1) - i32::from(y0)),
                GUARD_CENTRE,
            );
            let left = Edge::new(
                (x0, y0),
                (i32::from(x1) - i32::from(x0), i32::from(y1) - i32::from(y0)),
                GUARD_CENTRE - 511,
            );
            for line in first_at(y0)..first_at(y1) {
                let exact = column_exact((x0, y0), (x1, y1), line);
                assert_eq!(
                    edge.column(line) + GUARD_CENTRE,
                    exact,
                    "{x0},{y0} {x1},{y1} {line}"
                );
                assert_eq!(left.right_of(line) as i32 + GUARD_CENTRE - 511, exact);
                asked += 1;
            }
        }
        assert!(asked > 5_000_000);
    }

    #[test]
    fn small_edges_are_exact() {
        let mut asked = 0u64;
        for dy in 1..=512u16 {
            for dx in -512..=512i32 {
                // Any place and any start below a pixel's centre gives the same fractions.
                let x0 = (8 * GUARD_CENTRE + (dx * 7 + i32::from(dy) * 3) % 64) as u16;
                let y0 = 20_000 + (dx.unsigned_abs() as u16 + dy * 5) % 8;
                let x1 = (i32::from(x0) + dx) as u16;
                let edge = Edge::small((x0, y0), (dx, i32::from(dy)), GUARD_CENTRE - 200);
                for line in first_at(y0)..first_at(y0 + dy) {
                    let exact = column_exact((x0, y0), (x1, y0 + dy), line);
                    assert_eq!(
                        edge.right_of(line) as i32 + GUARD_CENTRE - 200,
                        exact,
                        "{x0},{y0} {dx},{dy} {line}"
                    );
                    asked += 1;
                }
            }
        }
        assert!(asked > 15_000_000);
    }

    #[test]
    fn vertical_edges_of_any_height_are_narrow() {
        let a = (8 * 4200 + 4, 3);
        let edge = Edge::new(a, (0, 65_000 - 3), GUARD_CENTRE);
        for line in [1, 100, 5000, 8000] {
            assert_eq!(edge.column(line), 4201 - GUARD_CENTRE);
        }
    }
}
