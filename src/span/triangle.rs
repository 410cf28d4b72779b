//! A triangle on its way into a slot: how large it is decides how it is set up (B).

use super::edge::{Edge, Frame, Kind, across, down};
use super::plane::Shares;
use crate::num::InverseArea;
use crate::scene::{ORIGIN, Object, TexturePlace, Vertex, first_line};

/// Corners of a triangle, the topmost first, clockwise, with a doubled area above 0.
#[derive(Clone, Copy, Debug)]
pub struct Triangle<'a> {
    pub(crate) vertex: [&'a Vertex; 3],
    /// The numbers of the corners, and the texture places of all vertices: looked up where a look asks.
    pub(crate) object: &'a Object,
    pub(crate) places: &'a [TexturePlace],
    pub(crate) frame: Frame,
}

/// The way of evaluating planes, from the cheapest on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// Within 28 pixels of the top corner and an area of two pixels at least, or 25 pixels and one.
    Tiny,
    /// Within 64 pixels, and an area of 8 pixels at least.
    Small,
    /// Within 25 pixels, and an area of a quarter of a pixel at least: for values that change little.
    Sharp,
    /// Too thin for the size that its box has, but small.
    Thin,
    /// All others.
    Large,
}

/// The lines that a triangle is on and turns on, counted from the picture's first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lines {
    /// That of the corner where a side gives way to the third one.
    pub(crate) turn: i32,
    /// The one after its last.
    pub(crate) end: i32,
}

/// How sides are evaluated, in three bits: 0 and 1 say the [`Kind`], 2 whether columns may lie beside the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Way(pub(crate) u8);

impl Way {
    /// Sides within the picture by one multiply-add.
    pub(crate) const PLAIN: Self = Self(0);
    /// The bits of all ways.
    pub(crate) const BITS: u8 = 7;
    /// Bits of which none is set where columns need no look at the picture's border.
    pub(crate) const INDIRECT: u8 = Self::CROSSES | Kind::Divided as u8;
    const CROSSES: u8 = 4;

    const fn new(kind: Kind, crosses: bool) -> Self {
        Self(kind as u8 | if crosses { Self::CROSSES } else { 0 })
    }

    #[inline(always)]
    pub(crate) fn kind(self) -> Kind {
        match self.0 & 3 {
            0 => Kind::Short,
            1 => Kind::Tall,
            _ => Kind::Divided,
        }
    }

    #[inline(always)]
    fn crosses(self) -> bool {
        self.0 & Self::CROSSES != 0
    }

    /// Whether columns need no look at the picture's border.
    #[inline(always)]
    pub(crate) fn is_direct(self) -> bool {
        self.0 & Self::INDIRECT == 0
    }
}

/// What a triangle is found to be as it begins: in two words, so that it comes back in registers.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// The doubled area, units of 1/64 pixel.
    pub(crate) area: u32,
    /// From the lowest bit on: 8 of the size, 8 of the way, 15 of the line of the next change, 1 whether a side
    /// turns on it. All are 0 where the triangle ends above, or has no pixel on its only line.
    bits: u32,
}

impl Entry {
    const TURNS: u32 = 1 << 31;

    #[inline(always)]
    pub(crate) fn size(self) -> Size {
        match self.bits & 0xFF {
            0 => Size::Tiny,
            1 => Size::Small,
            2 => Size::Sharp,
            3 => Size::Thin,
            _ => Size::Large,
        }
    }

    #[inline(always)]
    pub(crate) fn way(self) -> Way {
        Way((self.bits >> 8) as u8)
    }

    /// The line on which a side turns, or that after the last; 0 where nothing is left of the triangle.
    #[inline(always)]
    pub(crate) fn change(self) -> u16 {
        (self.bits >> 16) as u16 & 0x7FFF
    }

    /// Whether a side turns on it.
    #[inline(always)]
    pub(crate) fn turns(self) -> bool {
        self.bits & Self::TURNS != 0
    }
}

/// The sides on a line.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Sides {
    pub(crate) left: Edge,
    pub(crate) right: Edge,
}

impl Triangle<'_> {
    #[inline(always)]
    pub(crate) fn place(&self, corner: usize) -> u32 {
        self.vertex[corner].place
    }

    /// Where a corner lies on its texture.
    #[inline(always)]
    pub(crate) fn texture(&self, corner: usize) -> TexturePlace {
        let number = usize::from(self.object.corner[corner]);
        self.places.get(number).copied().unwrap_or_default()
    }

    /// Where the corners lie on their texture.
    #[inline(always)]
    pub(crate) fn textures(&self) -> [TexturePlace; 3] {
        [0, 1, 2].map(|i| self.texture(i))
    }

    #[inline(always)]
    fn places(&self) -> [u32; 3] {
        self.vertex.map(|v| v.place)
    }

    /// The doubled area, units of 1/64 pixel; sides are below 2^15 units.
    #[inline(always)]
    pub(crate) fn area(&self) -> u32 {
        let [a, b, c] = self.places();
        let (d1, d2) = (b.wrapping_sub(a), c.wrapping_sub(a));
        let plus = across(d1).wrapping_mul(down(d2));
        plus.wrapping_sub(across(d2).wrapping_mul(down(d1))) as u32
    }

    /// How the sides are evaluated.
    #[inline(always)]
    pub(crate) fn way(&self) -> Way {
        self.way_of(self.reach())
    }

    /// How planes are made; `area` is the triangle's.
    #[inline(always)]
    pub(crate) fn size(&self, area: u32) -> Size {
        self.size_of(area, self.reach())
    }

    /// The farthest way from the first corner to another, across and down.
    #[inline(always)]
    fn reach(&self) -> i32 {
        let [a, b, c] = self.places();
        let magnitude = |d: i32| d ^ (d >> 31);
        let way = |d: u32| magnitude(across(d)) + down(d);
        way(b.wrapping_sub(a)).max(way(c.wrapping_sub(a)))
    }

    #[inline(always)]
    fn size_of(&self, area: u32, far: i32) -> Size {
        if far < 224 && area >= 256 || far < 200 && area >= 128 {
            return Size::Tiny;
        }
        if far < 200 && area >= 32 {
            return Size::Sharp;
        }
        if self.kind() != Kind::Short {
            return Size::Large;
        }
        if area >= 1024 {
            Size::Small
        } else {
            Size::Thin
        }
    }

    #[inline(always)]
    pub(crate) fn shares(&self, area: u32) -> Shares {
        Shares::new(area, self.places())
    }

    /// The turn and the end.
    #[inline(always)]
    pub(crate) fn lines(&self) -> Lines {
        let (b, c) = (self.place(1), self.place(2));
        Lines {
            turn: first_line(b.min(c)) - ORIGIN,
            end: first_line(b.max(c)) - ORIGIN,
        }
    }

    #[inline(always)]
    fn kind(&self) -> Kind {
        let [a, b, c] = self.places();
        let (d1, d2) = (b.wrapping_sub(a), c.wrapping_sub(a));
        let d3 = c.wrapping_sub(b);
        let magnitude = |d: i32| d ^ (d >> 31);
        let size = |d: u32| magnitude(across(d)) | magnitude(down(d));
        if size(d1) | size(d2) | size(d3) < 512 {
            return Kind::Short;
        }
        let holds = |d: u32| down(d) <= Edge::TALLEST || across(d) == 0;
        if holds(d1) && holds(d2) && magnitude(down(d3)) <= Edge::TALLEST {
            Kind::Tall
        } else {
            Kind::Divided
        }
    }

    /// Measures a triangle, and sets its sides for `line` and below, up to the turn or the end.
    #[inline(never)]
    pub(crate) fn enter(&self, line: u16, sides: &mut Sides) -> Entry {
        let (area, far) = (self.area(), self.reach());
        let size = self.size_of(area, far);
        let way = self.way_of(far);
        *sides = if way == Way::PLAIN {
            self.plain_sides(false)
        } else {
            self.upper_sides_of_any(way)
        };
        // Later than it could be known, so that it keeps no register.
        let (line, lines) = (i32::from(line), self.lines());
        let mut change = lines.end as u32;
        if line >= lines.turn {
            if lines.end <= line {
                return Entry { area: 0, bits: 0 };
            }
            if way == Way::PLAIN {
                sides.turn_plain([self.place(1), self.place(2)]);
            } else {
                sides.turn(self, way);
            }
            if lines.end == line + 1 && way == Way::PLAIN && sides.is_empty(line as u32) {
                return Entry { area: 0, bits: 0 };
            }
        } else if lines.turn < lines.end {
            change = lines.turn as u32 | Entry::TURNS >> 16;
        }
        let bits = size as u32 | u32::from(way.0) << 8 | change << 16;
        Entry { area, bits }
    }

    /// The sides on `line` and below, up to the turn or the end.
    #[inline(always)]
    pub(crate) fn sides(&self, way: Way, line: i32, turn: i32) -> Sides {
        if way == Way::PLAIN {
            return self.plain_sides(line >= turn);
        }
        let mut sides = self.upper_sides_of_any(way);
        if line >= turn {
            sides.turn(self, way);
        }
        sides
    }

    /// The sides of [`Way::PLAIN`] above or below the turn: which two they are is found before either is made.
    #[inline(always)]
    fn plain_sides(&self, is_below: bool) -> Sides {
        let [a, b, c] = self.places();
        let (d1, d2, d3) = (b.wrapping_sub(a), c.wrapping_sub(a), c.wrapping_sub(b));
        let mut left = (a, across(d2), down(d2));
        let mut right = (a, across(d1), down(d1));
        if is_below {
            let (dx, dy) = (across(d3), down(d3));
            if dy > 0 {
                right = (b, dx, dy);
            } else {
                left = (c, -dx, -dy);
            }
        }
        let side = |(from, dx, dy)| Edge::short(from, dx, dy, ORIGIN);
        Sides {
            left: side(left),
            right: side(right),
        }
    }

    /// The sides above the turn.
    #[inline(never)]
    fn upper_sides_of_any(&self, way: Way) -> Sides {
        let [a, b, c] = self.places();
        let origin = self.origin(way);
        Sides {
            left: Edge::of_kind(way.kind(), a, c, origin),
            right: Edge::of_kind(way.kind(), a, b, origin),
        }
    }

    /// How the sides are evaluated, by the farthest way from the first corner.
    #[inline(always)]
    fn way_of(&self, far: i32) -> Way {
        let x = (self.place(0) & 0xFFFF) as i32 - 8 * ORIGIN;
        // Below 256 units no side is longer than 511 either way.
        if far < 256 && (x - far) | (8 * self.frame.width - x - far) >= 0 {
            return Way::PLAIN;
        }
        self.way_of_any()
    }

    #[inline(never)]
    fn way_of_any(&self) -> Way {
        let frame = self.frame;
        let x = self.places().map(|p| (p & 0xFFFF) as i32);
        let (low, high) = (x[0].min(x[1]).min(x[2]), x[0].max(x[1]).max(x[2]));
        let kind = self.kind();
        let crosses = low < 8 * ORIGIN || high > 8 * (ORIGIN + frame.width);
        let wide = 8 * frame.wide_left();
        let is_far = crosses && (low < wide || high >= wide + 8 * 1023);
        Way::new(if is_far { Kind::Divided } else { kind }, crosses)
    }

    #[inline(always)]
    fn origin(&self, way: Way) -> i32 {
        if way.crosses() {
            self.frame.wide_left()
        } else {
            ORIGIN
        }
    }

    /// Planes of any triangle that is not too thin; on values below 2^31.
    #[inline(never)]
    pub(crate) fn wide_area(&self) -> Option<InverseArea> {
        let [a, b, c] = self.places();
        let way = |to: u32| {
            let d = to.wrapping_sub(a);
            [across(d), down(d)]
        };
        let first = [a & 0xFFFF, a >> 16].map(|at| at as i32 - 8 * ORIGIN);
        InverseArea::new(first, [way(b), way(c)])
    }
}

/// The line after the last of a triangle that ends at a place, counted from the picture's first.
#[inline(always)]
pub(crate) fn end_line(place: u32) -> u16 {
    (first_line(place) - ORIGIN) as u16
}

impl Sides {
    /// The third side of [`Way::PLAIN`], in place of the one that ends at the middle corner; the place where it
    /// ends.
    #[inline(always)]
    pub(crate) fn turn_plain(&mut self, [b, c]: [u32; 2]) -> u32 {
        let d = c.wrapping_sub(b);
        let (dx, dy) = (across(d), down(d));
        if dy > 0 {
            self.right = Edge::short(b, dx, dy, ORIGIN);
            c
        } else {
            self.left = Edge::short(c, -dx, -dy, ORIGIN);
            b
        }
    }

    /// The third side, in place of the one that ends at the middle corner.
    #[inline(never)]
    pub(crate) fn turn(&mut self, triangle: &Triangle<'_>, way: Way) {
        let [_, b, c] = triangle.places();
        let (kind, origin) = (way.kind(), triangle.origin(way));
        if down(c.wrapping_sub(b)) > 0 {
            self.right = Edge::of_kind(kind, b, c, origin);
        } else {
            self.left = Edge::of_kind(kind, c, b, origin);
        }
    }

    /// Whether sides of [`Way::PLAIN`] have no column between them on a line.
    #[inline(always)]
    fn is_empty(&self, line: u32) -> bool {
        self.left.column(line) >= self.right.column(line)
    }

    /// The columns of the picture on a line of it: from the first to before the second.
    #[inline(always)]
    pub(crate) fn columns(&self, way: Way, line: u32, frame: Frame) -> (u32, u32) {
        if way.is_direct() {
            return (self.left.column(line), self.right.column(line));
        }
        self.clipped(way, line, frame)
    }

    /// The same of any sides.
    #[inline(never)]
    pub(crate) fn clipped(&self, way: Way, line: u32, frame: Frame) -> (u32, u32) {
        let of = |edge: Edge| {
            let column = if way.kind() == Kind::Divided {
                edge.divided(line as i32 + ORIGIN) - ORIGIN
            } else {
                edge.column(line) as i32 + frame.wide_left() - ORIGIN
            };
            column.min(frame.width).max(0) as u32
        };
        (of(self.left), of(self.right))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::random::Rng;
    use crate::scene::NONE;

    /// What is said of a triangle with its first corner so far from the picture's first pixel, and the others so far from
    /// there.
    fn ask<T>(first: i32, to: [[i32; 2]; 2], of: impl Fn(&Triangle<'_>) -> T) -> T {
        let vertices = [[0; 2], to[0], to[1]].map(|[x, y]| Vertex {
            place: ((8 * ORIGIN + y) << 16 | (8 * ORIGIN + first + x)) as u32,
            depth: 0,
            colour: 0,
        });
        of(&Triangle {
            vertex: [&vertices[0], &vertices[1], &vertices[2]],
            object: &Object {
                corner: [0, 1, 2],
                next: NONE,
            },
            places: &[],
            frame: Frame {
                width: 320,
                height: 240,
            },
        })
    }

    /// Kills: sides that are longer than 511 units and told to be plain, and a border of the picture that is not looked at.
    #[test]
    fn how_sides_are_evaluated_is_told_by_the_farthest_corner_as_by_all() {
        let mut rng = Rng(31);
        let mut is_plain = [0; 2];
        for _ in 0..200_000 {
            let mut way = || [rng.below(700) as i32 - 350, rng.below(300) as i32];
            let to = [way(), way()];
            let first = rng.below(8 * 320) as i32;
            let got = ask(first, to, |t| t.way());
            assert_eq!(got, ask(first, to, |t| t.way_of_any()), "{first} {to:?}");
            is_plain[usize::from(got == Way::PLAIN)] += 1;
        }
        assert!(is_plain.iter().all(|&some| some > 20_000), "{is_plain:?}");
        for (end, want) in [(255, Way::PLAIN), (256, Way::new(Kind::Tall, false))] {
            assert_eq!(ask(800, [[end, 0], [-end - 1, 0]], |t| t.way()), want);
        }
    }

    /// Kills: other limits of an area, of the way to a corner, and of sides.
    #[test]
    fn sizes_end_where_they_say() {
        for (to, want) in [
            ([[223, 0], [0, 2]], Size::Tiny),
            ([[224, 0], [0, 2]], Size::Thin),
            ([[220, 1], [184, 2]], Size::Tiny),
            ([[220, 1], [185, 2]], Size::Thin),
            ([[199, 0], [0, 1]], Size::Tiny),
            ([[200, 0], [0, 1]], Size::Thin),
            ([[128, 0], [0, 1]], Size::Tiny),
            ([[127, 0], [0, 1]], Size::Sharp),
            ([[32, 0], [0, 1]], Size::Sharp),
            ([[31, 0], [0, 1]], Size::Thin),
            ([[256, 0], [0, 4]], Size::Small),
            ([[341, 0], [0, 3]], Size::Thin),
            ([[511, 0], [0, 8]], Size::Small),
            ([[512, 0], [0, 8]], Size::Large),
            ([[0, 512], [8, 512]], Size::Large),
        ] {
            assert_eq!(ask(0, to, |t| t.size(t.area())), want, "{to:?}");
        }
    }
}
