//! A parallelogram: a triangle with a fourth corner, whose sides are walked down from the top on either hand (K4).

use super::edge::{Edge, Kind};
use super::triangle::{Entry, Sides, Size, Triangle, Way};
use crate::scene::{ORIGIN, Object, TexturePlace, Vertex, first_line};

/// A corner that a triangle has besides its own, not above its first one.
#[derive(Clone, Copy, Debug)]
pub struct Fourth<'a> {
    pub(crate) vertex: &'a Vertex,
    /// Where it lies on its texture.
    pub(crate) texture: TexturePlace,
    /// Clockwise it comes behind this one of the triangle's corners.
    behind: usize,
}

/// The sides of a parallelogram on a line, and how long they are its sides.
pub(crate) struct Walked {
    pub(crate) sides: Sides,
    /// The line on which a side gives way to another, or that after the last.
    pub(crate) change: i32,
    /// Whether there is a side that it gives way to.
    pub(crate) turns: bool,
}

/// The line after the last of a side that ends at a place, counted from the picture's first.
fn end_of(place: u32) -> i32 {
    first_line(place) - ORIGIN
}

impl<'a> Triangle<'a> {
    /// The fourth corner, if there is one.
    #[inline(always)]
    pub(crate) fn fourth(&self) -> Option<Fourth<'a>> {
        self.fourth_of(self.second?)
    }

    /// The corner of a second record.
    #[inline(never)]
    fn fourth_of(&self, second: &Object) -> Option<Fourth<'a>> {
        let [number, from] = second.fourth();
        let place = self.tables.places.get(usize::from(number));
        Some(Fourth {
            vertex: self.tables.vertices.get(usize::from(number))?,
            texture: place.copied().unwrap_or_default(),
            behind: self.object.corner.iter().position(|&at| at == from)?,
        })
    }

    /// The places of all four corners, clockwise from the topmost on.
    fn four(&self, fourth: Fourth<'_>) -> [u32; 4] {
        let ([a, b, c], d) = (self.vertex.map(|v| v.place), fourth.vertex.place);
        match fourth.behind {
            0 => [a, d, b, c],
            1 => [a, b, d, c],
            _ => [a, b, c, d],
        }
    }

    /// The columns on a line.
    #[inline(never)]
    pub(crate) fn columns_of_quad(&self, fourth: Fourth<'_>, line: u32) -> (u32, u32) {
        let way = self.way_of_quad(fourth);
        let walked = self.sides_of_quad(fourth, way, line as i32);
        walked.sides.columns(way, line, self.frame)
    }

    #[inline(never)]
    pub(super) fn way_of_quad(&self, fourth: Fourth<'_>) -> Way {
        let places = self.four(fourth);
        let range = |of: fn(u32) -> u32| {
            let [a, b, c, d] = places.map(|place| of(place) as i32);
            [a.min(b).min(c).min(d), a.max(b).max(c).max(d)]
        };
        let ([left, right], [top, bottom]) = (range(|at| at & 0xFFFF), range(|at| at >> 16));
        let kind = match (right - left, bottom - top) {
            (..512, ..512) => Kind::Short,
            (_, ..1024) => Kind::Tall,
            _ => Kind::Divided,
        };
        Way::within(kind, left, right, self.frame)
    }

    #[inline(never)]
    pub(super) fn end_of_quad(&self, fourth: Fourth<'_>) -> i32 {
        let last = |most: u32, place: u32| most.max(place);
        end_of(self.four(fourth).into_iter().fold(0, last))
    }

    /// The sides on a line; any where it ends above.
    #[inline(never)]
    pub(crate) fn sides_of_quad(&self, fourth: Fourth<'_>, way: Way, line: i32) -> Walked {
        let [a, b, c, d] = self.four(fourth);
        let origin = self.origin(way);
        // The first side on either hand that does not end above the line.
        let walk = |chain: [u32; 4]| {
            let mut at = (chain[0], chain[3]);
            for side in chain.windows(2) {
                if end_of(side[1]) > line {
                    at = (side[0], side[1]);
                    break;
                }
            }
            at
        };
        let (right, left) = (walk([a, b, c, d]), walk([a, d, c, b]));
        let of = |(from, to): (u32, u32)| Edge::of_kind(way.kind(), from, to, origin);
        let end = self.end_of_quad(fourth);
        let change = match end > line {
            true => end_of(right.1).min(end_of(left.1)),
            false => end,
        };
        Walked {
            sides: Sides {
                left: of(left),
                right: of(right),
            },
            change,
            turns: change < end,
        }
    }

    /// [`enter`](Triangle::enter) of a parallelogram.
    #[inline(never)]
    pub(crate) fn enter_quad(&self, fourth: Fourth<'_>, line: u16, sides: &mut Sides) -> Entry {
        let way = self.way_of_quad(fourth);
        let walked = self.sides_of_quad(fourth, way, line.into());
        if walked.change <= i32::from(line) {
            return Entry::NONE;
        }
        *sides = walked.sides;
        let turns = if walked.turns { Entry::TURNS >> 16 } else { 0 };
        let change = walked.change as u32 | turns;
        Entry::new(self.area(), Size::Large, way, change)
    }
}
