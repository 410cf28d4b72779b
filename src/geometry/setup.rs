//! Set-up: from the corners of an object to what drawing a line of it needs (K4, K5).
//!
//! Done when an object becomes active, and again on each line for one that found no room in the
//! cache: the same function of the same corners, so the same bits.

use super::colour::Scale;
use super::object::{Object, SceneVertex};
use super::shading::Shading;
use crate::num::{Edge, GUARD_CENTRE, InverseArea, Plane, SmallArea, column_exact, first_at};

/// How colour and depth are found at a pixel.
#[derive(Clone, Copy, Debug)]
pub enum Parameters<L> {
    /// Depth plane and levels.
    Planes(Plane, L),
    /// Too thin for planes: weights are taken at each pixel from the object's corners.
    Corners,
}

/// A triangle, ready to be drawn on any of its lines from the one it was set up for on.
#[derive(Clone, Copy, Debug)]
pub struct Drawable<L> {
    /// The edges at the left and at the right of the part that is being drawn, and the one that
    /// takes over from one of them below the middle corner.
    left: Edge,
    right: Edge,
    third: Edge,
    /// The first line for which `left` and `right` are not right any more: that below the middle
    /// corner, 0 for a triangle that no 32-bit edge can hold, the largest when nothing more comes.
    turn: u16,
    /// First line below the triangle.
    end: u16,
    sides: Sides,
    /// Depth and colour.
    pub parameters: Parameters<L>,
}

/// What happens at [`Drawable::turn`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sides {
    /// The third edge goes on at the left.
    ThirdLeft,
    /// The third edge goes on at the right.
    ThirdRight,
    /// The edges are divided out on each line, from corners sorted from top to bottom, which
    /// are kept in place of the edges.
    Divided {
        /// The edge from top to bottom is the left one.
        long_left: bool,
    },
}

impl<L> Drawable<L> {
    /// What an empty slot holds.
    pub const EMPTY: Self = Self {
        left: Edge::NONE,
        right: Edge::NONE,
        third: Edge::NONE,
        turn: u16::MAX,
        end: 0,
        sides: Sides::ThirdLeft,
        parameters: Parameters::Corners,
    };

    /// First line of guard space below the triangle.
    #[inline(always)]
    #[must_use]
    pub const fn end(&self) -> u16 {
        self.end
    }

    /// First covered column on `line` and the first after the last, counted from the middle
    /// column of guard space; the span is empty where the second is not above the first.
    ///
    /// Lines must not go up.
    #[inline(always)]
    #[must_use]
    pub fn columns(&mut self, line: i32) -> (i32, i32) {
        if line >= i32::from(self.turn) {
            if let Sides::Divided { long_left } = self.sides {
                return self.divided(line, long_left);
            }
            self.take_turn();
        }
        (self.left.column(line), self.right.column(line))
    }

    #[inline(always)]
    fn take_turn(&mut self) {
        if self.sides == Sides::ThirdLeft {
            self.left = self.third;
        } else {
            self.right = self.third;
        }
        self.turn = u16::MAX;
    }

    #[cold]
    #[inline(never)]
    fn divided(&self, line: i32, long_left: bool) -> (i32, i32) {
        let [top, middle, bottom] = [self.left, self.right, self.third].map(Edge::as_corner);
        let long = column_exact(top, bottom, line) - GUARD_CENTRE;
        let short = if line < first_at(middle.1) {
            column_exact(top, middle, line)
        } else {
            column_exact(middle, bottom, line)
        } - GUARD_CENTRE;
        if long_left {
            (long, short)
        } else {
            (short, long)
        }
    }
}

impl<F: Copy> Object<F> {
    /// The object's corners.
    #[inline]
    pub(crate) fn corners<A: Copy>(
        &self,
        vertices: &[SceneVertex<A>],
    ) -> Option<[SceneVertex<A>; 3]> {
        let at = |i: u16| vertices.get(usize::from(i)).copied();
        Some([
            at(self.corner[0])?,
            at(self.corner[1])?,
            at(self.corner[2])?,
        ])
    }

    /// Sets the object up in `out` for `line` and all below; `false` when the object does not
    /// exist in this arena or ends above.
    #[inline(never)]
    pub(crate) fn set_up<S: Shading<Face = F>>(
        &self,
        vertices: &[SceneVertex<S::Vertex>],
        scale: &Scale,
        line: i32,
        out: &mut Drawable<S::Levels>,
    ) -> bool {
        let Some(corners) = self.corners(vertices) else {
            return false;
        };
        let place = corners.map(|c| (c.x, c.y));
        if !edges(place, line, out) {
            return false;
        }
        out.parameters = match SmallArea::new(place) {
            Some(area) => {
                let depth = area.wide_plane(corners.map(|c| c.depth as i32));
                let levels = S::set_up_small(&area, corners.map(|c| c.attribute), self.face, scale);
                match (depth, levels) {
                    (Some(depth), Some(levels)) => Parameters::Planes(depth, levels),
                    _ => large::<S>(corners, self.face, scale),
                }
            }
            None => large::<S>(corners, self.face, scale),
        };
        true
    }
}

/// Parameters of a triangle that is large or thin.
#[cold]
#[inline(never)]
fn large<S: Shading>(
    corners: [SceneVertex<S::Vertex>; 3],
    face: S::Face,
    scale: &Scale,
) -> Parameters<S::Levels> {
    let planes = || {
        let area = InverseArea::new(corners.map(|c| (c.x, c.y)))?;
        let depth = area.plane(corners.map(|c| c.depth as i32))?;
        let levels = S::set_up(&area, corners.map(|c| c.attribute), face, scale)?;
        Some(Parameters::Planes(depth, levels))
    };
    planes().unwrap_or(Parameters::Corners)
}

/// The corners from top to bottom; equal heights keep their order.
#[inline]
fn sorted(p: [(u16, u16); 3]) -> [(u16, u16); 3] {
    let [mut a, mut b, mut c] = p;
    if b.1 < a.1 {
        (a, b) = (b, a);
    }
    if c.1 < b.1 {
        (b, c) = (c, b);
        if b.1 < a.1 {
            (a, b) = (b, a);
        }
    }
    [a, b, c]
}

/// Sets up the edges of `out` for `line` and all below; `false` when the triangle ends above.
#[inline(always)]
fn edges<L>(p: [(u16, u16); 3], line: i32, out: &mut Drawable<L>) -> bool {
    const LOW: u16 = 8 * (GUARD_CENTRE - 511) as u16;
    const SPAN: u16 = 8 * 1022;
    let [top, middle, bottom] = sorted(p);
    let turn = first_at(middle.1);
    let end = first_at(bottom.1);
    out.end = end as u16;
    if line >= end {
        return false;
    }
    let d = |a: (u16, u16), b: (u16, u16)| {
        (
            i32::from(b.0) - i32::from(a.0),
            i32::from(b.1) - i32::from(a.1),
        )
    };
    let (long, upper, lower) = (d(top, bottom), d(top, middle), d(middle, bottom));
    let near = p.iter().all(|p| p.0.wrapping_sub(LOW) < SPAN);
    let flat_enough = long.1 < 1024
        || (Edge::holds(long.0, long.1)
            && Edge::holds(upper.0, upper.1)
            && Edge::holds(lower.0, lower.1));
    if !(near && flat_enough) {
        // The middle corner is right of the long edge, which is the left one then.
        let long_left =
            i64::from(upper.0) * i64::from(long.1) > i64::from(long.0) * i64::from(upper.1);
        out.sides = Sides::Divided { long_left };
        out.turn = 0;
        [out.left, out.right, out.third] = [top, middle, bottom].map(Edge::from_corner);
        return true;
    }
    // Products of 14 and 17 bits; a vertical edge may be that tall.
    let long_left = upper.0 * long.1 > long.0 * upper.1;
    let edge = Edge::new(top, long);
    let above = line < turn;
    let short = if above {
        Edge::new(top, upper)
    } else {
        Edge::new(middle, lower)
    };
    out.turn = u16::MAX;
    if above && turn < end {
        out.third = Edge::new(middle, lower);
        out.turn = turn as u16;
    }
    if long_left {
        (out.left, out.right, out.sides) = (edge, short, Sides::ThirdRight);
    } else {
        (out.left, out.right, out.sides) = (short, edge, Sides::ThirdLeft);
    }
    true
}

/// Depth and levels of a thin triangle at a pixel of guard space, from exact weights.
///
/// The weights are at least 0 and their sum is at most 1, so the result lies between the
/// corners' values, always.
pub(crate) fn at_pixel<S: Shading>(
    corners: [SceneVertex<S::Vertex>; 3],
    face: S::Face,
    scale: &Scale,
    (column, line): (i32, i32),
) -> (u32, S::Levels) {
    let (x, y) = (8 * i64::from(column) + 4, 8 * i64::from(line) + 4);
    let p = corners.map(|c| (i64::from(c.x), i64::from(c.y)));
    let cross = |a: (i64, i64), b: (i64, i64)| (b.0 - a.0) * (y - a.1) - (b.1 - a.1) * (x - a.0);
    let area = (p[1].0 - p[0].0) * (p[2].1 - p[0].1) - (p[1].1 - p[0].1) * (p[2].0 - p[0].0);
    let weight = |side: i64| {
        let side = if area < 0 { -side } else { side };
        // side <= |area| < 2^34 for a covered pixel
        ((side.max(0) << 29) / area.abs().max(1)).min(1 << 29) << 1
    };
    let w1 = weight(cross(p[2], p[0]));
    let w2 = weight(cross(p[0], p[1])).min((1 << 30) - w1);
    let d = corners.map(|c| i64::from(c.depth));
    let depth = d[0] + (((d[1] - d[0]) * w1 + (d[2] - d[0]) * w2) >> 30);
    let levels = S::weighted([w1, w2], corners.map(|c| c.attribute), face, scale);
    (depth as u32, levels)
}
