//! The two sides of a triangle on a line, exactly (K4, K5).
//!
//! A side meets the centre of a line at a rational; what is asked is the first column whose centre
//! lies right of it. The truth is a multiple of 1/(8 dy) column, so a fixed-point line that starts a
//! bias above it and errs by less has the same floor.
//!
//! | kind | of sides | set-up, M4 | a line |
//! |---|---|---|---|
//! | [`Kind::Short`] | up to 511 units of 1/8 pixel either way | 11 instructions, from a table | one multiply-add |
//! | [`Kind::Tall`] | up to 2,032 units of height, or upright | three divisions; on a Cortex-M0+ three digits | one multiply-add |
//! | [`Kind::Divided`] | all others, and what lies too far beside the picture | none | one division |
//!
//! Short: the slope is `round(dx 2^19 / dy)` a unit of height by a reciprocal of 31 bits, less than
//! 0.63 units of 2^-22 column off; after 511 units it is 322 off, the bias is 512, and the truth a
//! multiple of 1,024 of them.

use crate::num::{of_height, quotient_16, slope_and_rest, slope_of};
use crate::scene::ORIGIN;

/// What the picture's place in guard space is to edges and planes: it begins at [`ORIGIN`], either way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frame {
    /// Columns of the picture.
    pub(crate) width: i32,
    /// Its lines.
    pub(crate) height: i32,
}

impl Frame {
    /// The column from which crossing triangles count: as much room to the left as to the right.
    pub(crate) const fn wide_left(self) -> i32 {
        ORIGIN - (1023 - self.width) / 2
    }
}

/// How the sides of a triangle are evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Short,
    Tall,
    Divided,
}

/// A side: `column = (at + slope line) >> 22` modulo 2^32; divided ones keep both ends instead.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Edge {
    at: u32,
    slope: u32,
}

/// Units across from `a` to `b`, places with the line in the upper half.
#[inline(always)]
pub(crate) fn across(difference: u32) -> i32 {
    i32::from(difference as i16)
}

/// Units down, of a difference of two places.
#[inline(always)]
pub(crate) fn down(difference: u32) -> i32 {
    difference.wrapping_add(0x8000) as i32 >> 16
}

impl Edge {
    /// Units of height up to which a side that leans is exact with a slope.
    pub(crate) const TALLEST: i32 = 2032;

    /// A side that is never asked.
    pub(crate) const NONE: Self = Self { at: 0, slope: 0 };

    /// A side of at most 511 units either way, from the place `a` down by `(dx, dy)`; columns count
    /// from `origin`, lines from the picture's first.
    #[inline(always)]
    pub(crate) fn short(a: u32, dx: i32, dy: i32, origin: i32) -> Self {
        let slope = slope_of(dx, of_height(dy as u32)) as u32;
        let (x, y) = (a & 0xFFFF, a >> 16);
        let start = (x << 19).wrapping_add(((4 - 8 * origin) << 19) as u32 + 512);
        let way = ((4 + 8 * ORIGIN) as u32).wrapping_sub(y);
        Self {
            at: start.wrapping_add(slope.wrapping_mul(way)),
            slope: slope << 3,
        }
    }

    /// A side of any kind from the place `a` down to `b`.
    #[inline(never)]
    pub(crate) fn of_kind(kind: Kind, a: u32, b: u32, origin: i32) -> Self {
        let d = b.wrapping_sub(a);
        let (dx, dy) = (across(d), down(d));
        match kind {
            Kind::Divided => Self { at: a, slope: b },
            _ if dy <= 0 => Self::NONE,
            Kind::Short => Self::short(a, dx, dy, origin),
            Kind::Tall => Self::tall(a, dx, dy, origin),
        }
    }

    /// A side of at most [`TALLEST`](Self::TALLEST) units of height, or a vertical one of any, `dy` above 0.
    ///
    /// Error: the slope is within half a unit of 2^-22 column of the truth, and the start is rounded down, so after
    /// 254 lines the line lies at most 127 units above the truth, or 128 below; the bias is 129, and the truth a multiple
    /// of at least 258 of them.
    fn tall(a: u32, dx: i32, dy: i32, origin: i32) -> Self {
        let (x, y) = ((a & 0xFFFF) as i32, (a >> 16) as i32);
        let start = ((x + 4 - 8 * origin) << 19).wrapping_add(129);
        // dy is above 0; said so that no check for it is compiled in.
        let (whole, part) = slope_and_rest(dx, dy.max(1));
        let first = (y + 4) >> 3;
        let slope = (whole << 22).wrapping_add(part);
        let down = 8 * first + 4 - y;
        let at = start
            .wrapping_add(whole.wrapping_mul(down) << 19)
            .wrapping_add((part * down) >> 3);
        Self {
            at: at.wrapping_add(slope.wrapping_mul(ORIGIN - first)) as u32,
            slope: slope as u32,
        }
    }

    /// The first column right of the side, 0 to 1,023 right of the origin; not of divided ones.
    #[inline(always)]
    pub(crate) fn column(self, line: u32) -> u32 {
        self.at.wrapping_add(self.slope.wrapping_mul(line)) >> 22
    }

    /// The first column of guard space right of a divided side.
    pub(crate) fn divided(self, line: i32) -> i32 {
        let (a, d) = (self.at, self.slope.wrapping_sub(self.at));
        let dy = down(d);
        if dy <= 0 {
            return 0;
        }
        // Units of the way, rounded down: what is cut off cannot reach the next column's centre. A line that the side
        // is on is fewer than 2^15 units below its upper end, and neither end is farther across.
        let below = 8 * line + 4 - (a >> 16) as i32;
        let way = quotient_16(below.wrapping_mul(across(d)), dy);
        ((a & 0xFFFF) as i32 + 4 + way) >> 3
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::random::Rng;
    use crate::scene::first_line;

    /// Column and line of a place, in units of 1/8 pixel.
    fn parts(place: u32) -> (u16, u16) {
        (place as u16, (place >> 16) as u16)
    }

    fn exact(a: (u16, u16), b: (u16, u16), line: i32) -> i64 {
        let dy = i64::from(b.1) - i64::from(a.1);
        let dx = i64::from(b.0) - i64::from(a.0);
        let down = 8 * i64::from(line) + 4 - i64::from(a.1);
        ((i64::from(a.0) + 4) * dy + down * dx).div_euclid(8 * dy)
    }

    #[test]
    fn short_sides_are_exact_for_all_differences() {
        let (origin, top) = (ORIGIN, ORIGIN);
        for dy in 1..=511i32 {
            for dx in -511..=511i32 {
                let x = 8 * (origin + 100) + (dx * 7 + dy * 3) % 61;
                let y = 8 * top + 40 + (dx * 5 + dy) % 8;
                let a = (y << 16 | x) as u32;
                let edge = Edge::short(a, dx, dy, origin);
                let (pa, pb) = ((x as u16, y as u16), ((x + dx) as u16, (y + dy) as u16));
                // Both ends and the middle: the error is linear in between.
                let (first, end) = (first_line(a), (y + dy + 4) >> 3);
                for line in [first, (first + end) / 2, end - 1] {
                    if line >= first && line < end {
                        let column = edge.column((line - top) as u32) as i32 + origin;
                        assert_eq!(i64::from(column), exact(pa, pb, line), "{dx} {dy}");
                    }
                }
            }
        }
    }

    /// Kills: other places of the first column that crossing triangles may have.
    #[test]
    fn crossing_triangles_have_as_much_room_on_both_sides() {
        for width in [1, 2, 319, 320, 1022, 1023] {
            let left = Frame { width, height: 1 }.wide_left();
            let beside = [ORIGIN - left, left + 1023 - (ORIGIN + width)];
            assert!((0..=1).contains(&(beside[1] - beside[0])), "{beside:?}");
        }
    }

    #[test]
    fn every_kind_finds_the_same_columns() {
        let mut rng = Rng(77);
        let mut asked = 0;
        for _ in 0..20_000 {
            let mut at = |low: i32, size: u32| (8 * low + rng.below(size) as i32) as u32;
            let (xa, xb) = (at(ORIGIN, 2560), at(ORIGIN, 2560));
            let ya = at(ORIGIN - 20, 1900);
            let yb = ya + 1 + rng.below(Edge::TALLEST as u32);
            let (a, b) = (ya << 16 | xa, yb << 16 | xb);
            let tall = Edge::of_kind(Kind::Tall, a, b, ORIGIN);
            let divided = Edge::of_kind(Kind::Divided, a, b, ORIGIN);
            for line in first_line(a)..first_line(b) {
                let want = exact(parts(a), parts(b), line);
                let column = tall.column((line - ORIGIN) as u32) as i32 + ORIGIN;
                assert_eq!(i64::from(column), want);
                assert_eq!(i64::from(divided.divided(line)), want);
                asked += 1;
            }
        }
        assert!(asked > 500_000);
    }
}
