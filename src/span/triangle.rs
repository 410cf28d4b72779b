//! A triangle on its way into a slot: how large it is decides how it is set up (B).

use super::edge::{Edge, Frame, Kind, across, down, first_line};
use super::plane::Shares;
use crate::num::{InverseArea, Plane};
use crate::scene::{ORIGIN, TexturePlace, Vertex};

/// Corners of a triangle, the topmost first, clockwise, with a doubled area above 0.
#[derive(Clone, Copy, Debug)]
pub struct Triangle<'a> {
    pub(crate) vertex: [&'a Vertex; 3],
    /// Empty where the look has no textures.
    pub(crate) texture: [TexturePlace; 3],
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

/// How sides are evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Way {
    pub(crate) kind: Kind,
    /// Whether columns may lie beside the picture.
    pub(crate) crosses: bool,
}

impl Way {
    /// Sides within the picture by one multiply-add.
    pub(crate) const PLAIN: Self = Self {
        kind: Kind::Short,
        crosses: false,
    };

    /// Whether columns need no look at the picture's border.
    #[inline(always)]
    pub(crate) fn is_direct(self) -> bool {
        !self.crosses && self.kind != Kind::Divided
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

    /// How planes are made; `area` is the triangle's.
    #[inline(always)]
    pub(crate) fn size(&self, area: u32) -> Size {
        let [a, b, c] = self.places();
        let (d1, d2) = (b.wrapping_sub(a), c.wrapping_sub(a));
        let magnitude = |d: i32| d ^ (d >> 31);
        let way = |d: u32| magnitude(across(d)) + down(d);
        let far = way(d1).max(way(d2));
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
        let (b, c) = (first_line(self.place(1)), first_line(self.place(2)));
        Lines {
            turn: b.min(c) - ORIGIN,
            end: b.max(c) - ORIGIN,
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
        let holds = |d: u32| down(d) < 1024 || across(d) == 0;
        if holds(d1) && holds(d2) && magnitude(down(d3)) < 1024 {
            Kind::Tall
        } else {
            Kind::Divided
        }
    }

    /// The sides on `line` and below, up to the turn or the end.
    #[inline(always)]
    pub(crate) fn sides(&self, way: Way, line: i32, turn: i32) -> Sides {
        let mut sides = self.upper_sides(way);
        if line >= turn {
            sides.turn(self, way);
        }
        sides
    }

    /// The sides above the turn.
    #[inline(always)]
    fn upper_sides(&self, way: Way) -> Sides {
        let [a, b, c] = self.places();
        let origin = self.origin(way);
        if way.kind == Kind::Short {
            let (d1, d2) = (b.wrapping_sub(a), c.wrapping_sub(a));
            return Sides {
                left: Edge::short(a, across(d2), down(d2), origin),
                right: Edge::short(a, across(d1), down(d1), origin),
            };
        }
        Sides {
            left: Edge::of_kind(way.kind, a, c, origin),
            right: Edge::of_kind(way.kind, a, b, origin),
        }
    }

    /// How the sides are evaluated.
    #[inline(always)]
    pub(crate) fn way(&self, size: Size) -> Way {
        let (low, high) = (8 * ORIGIN, 8 * (ORIGIN + self.frame.width));
        let x = self.places().map(|p| (p & 0xFFFF) as i32);
        let inside = x.map(|x| (x - low) | (high - x));
        // Tiny and small triangles have short sides.
        let is_short = matches!(size, Size::Tiny | Size::Sharp | Size::Small);
        if is_short && inside[0] | inside[1] | inside[2] >= 0 {
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
        if crosses && (low < wide || high >= wide + 8 * 1023) {
            let kind = Kind::Divided;
            return Way { kind, crosses };
        }
        Way { kind, crosses }
    }

    #[inline(always)]
    fn origin(&self, way: Way) -> i32 {
        if way.crosses {
            self.frame.wide_left()
        } else {
            ORIGIN
        }
    }

    /// Planes of any triangle that is not too thin; on values below 2^31.
    #[inline(never)]
    pub(crate) fn wide_area(&self) -> Option<InverseArea> {
        InverseArea::new(self.places().map(super::edge::parts))
    }

    /// A plane of guard space, counted from the picture's first pixel.
    pub(crate) fn in_picture(&self, plane: Plane) -> [u32; 3] {
        let at = plane.at(ORIGIN, ORIGIN);
        [at, plane.dx, plane.dy].map(|v| v as u32)
    }
}

impl Sides {
    /// The third side, in place of the one that ends at the middle corner.
    #[inline(always)]
    pub(crate) fn turn(&mut self, triangle: &Triangle<'_>, way: Way) {
        let [_, b, c] = triangle.places();
        let origin = triangle.origin(way);
        let d = c.wrapping_sub(b);
        let to_right = down(d) > 0;
        let side = match (way.kind, to_right) {
            (Kind::Short, true) => Edge::short(b, across(d), down(d), origin),
            (Kind::Short, false) => Edge::short(c, -across(d), -down(d), origin),
            (kind, true) => Edge::of_kind(kind, b, c, origin),
            (kind, false) => Edge::of_kind(kind, c, b, origin),
        };
        if to_right {
            self.right = side;
        } else {
            self.left = side;
        }
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
            let column = if way.kind == Kind::Divided {
                edge.divided(line as i32 + ORIGIN) - ORIGIN
            } else {
                edge.column(line) as i32 + frame.wide_left() - ORIGIN
            };
            column.clamp(0, frame.width) as u32
        };
        (of(self.left), of(self.right))
    }
}
