//! Set-up: from the corners of an object to what drawing a line of it needs (K4, K5).
//!
//! Done when an object becomes active, and again on each line for one that found no room in the
//! cache: the same function of the same corners, so the same bits.

use super::object::{Object, SceneVertex};
use super::shading::Shading;
use crate::num::{Edge, GUARD_CENTRE, InverseArea, Plane, WideEdge, first_at};

/// The edges of a triangle, for any of its lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edges {
    /// All three in 32 bits: the long one, the upper and the lower short one.
    Narrow([Edge; 3]),
    /// The long one and the short one of either the upper or the lower part, in 64 bits as
    /// words; the other is set up when the scan comes to it.
    Wide([[i32; 4]; 2]),
}

/// How colour and depth are found at a pixel.
#[derive(Clone, Copy, Debug)]
pub enum Parameters<L> {
    /// Depth plane and levels.
    Planes(Plane, L),
    /// Too thin for planes: weights are taken at each pixel from the object's corners.
    Corners,
}

/// A triangle, ready to be drawn on any of its lines.
#[derive(Clone, Copy, Debug)]
pub struct Drawable<L> {
    edges: Edges,
    /// Depth and colour.
    pub parameters: Parameters<L>,
    /// First line below the middle corner, guard space.
    middle: u16,
    /// First line below the triangle.
    end: u16,
    /// The long edge is the left one.
    long_left: bool,
}

impl<L> Drawable<L> {
    /// What an empty slot holds.
    pub const EMPTY: Self = Self {
        edges: Edges::Narrow([Edge::NONE; 3]),
        parameters: Parameters::Corners,
        middle: 0,
        end: 0,
        long_left: false,
    };

    /// First line of guard space below the triangle.
    #[inline]
    #[must_use]
    pub const fn end(&self) -> u16 {
        self.end
    }

    /// First covered column of guard space on `line`, and the first column after the last.
    ///
    /// Right of the first is never left of it by more than rounding gives: an empty span has
    /// `end <= start`.
    #[inline]
    #[must_use]
    pub fn columns(&self, line: i32) -> (i32, i32) {
        let (long, short) = match &self.edges {
            Edges::Narrow([long, upper, lower]) => {
                let short = if line < i32::from(self.middle) {
                    upper
                } else {
                    lower
                };
                (long.column(line), short.column(line))
            }
            Edges::Wide([long, short]) => (
                WideEdge::from_words(*long).column(line),
                WideEdge::from_words(*short).column(line),
            ),
        };
        if self.long_left {
            (long + GUARD_CENTRE, short + GUARD_CENTRE)
        } else {
            (short + GUARD_CENTRE, long + GUARD_CENTRE)
        }
    }

    /// Whether the edges have to be set up again before `line` is drawn, because the scan has
    /// come from `last` past the middle corner of a wide triangle.
    #[inline]
    #[must_use]
    pub const fn stale(&self, last: i32, line: i32) -> bool {
        let middle = self.middle as i32;
        matches!(self.edges, Edges::Wide(_)) && last < middle && line >= middle
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

    /// Sets the object up for `line`; right for all further lines until
    /// [`stale`](Drawable::stale).
    ///
    /// `None` when the object does not exist in this arena or covers nothing.
    #[inline]
    pub(crate) fn set_up<S: Shading<Face = F>>(
        &self,
        vertices: &[SceneVertex<S::Vertex>],
        steps: [u16; 3],
        line: i32,
    ) -> Option<Drawable<S::Levels>> {
        let corners = self.corners(vertices)?;
        let place = corners.map(|c| (c.x, c.y));
        let area = InverseArea::new(place)?;
        let parameters = parameters::<S>(&area, corners, self.face, steps)
            .map_or(Parameters::Corners, |(depth, levels)| {
                Parameters::Planes(depth, levels)
            });
        let [top, middle, bottom] = sorted(place);
        Some(Drawable {
            edges: edges([top, middle, bottom], line),
            parameters,
            middle: first_at(middle.1) as u16,
            end: first_at(bottom.1) as u16,
            long_left: long_is_left(top, middle, bottom),
        })
    }
}

#[inline]
fn parameters<S: Shading>(
    area: &InverseArea,
    corners: [SceneVertex<S::Vertex>; 3],
    face: S::Face,
    steps: [u16; 3],
) -> Option<(Plane, S::Levels)> {
    let depth = area.plane(corners.map(|c| c.depth as i32))?;
    let levels = S::set_up(area, corners.map(|c| c.attribute), face, steps)?;
    Some((depth, levels))
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

/// Whether the middle corner lies right of the edge from top to bottom.
#[inline]
fn long_is_left(top: (u16, u16), middle: (u16, u16), bottom: (u16, u16)) -> bool {
    let d = |a: u16, b: u16| i64::from(b) - i64::from(a);
    d(top.0, middle.0) * d(top.1, bottom.1) > d(top.0, bottom.0) * d(top.1, middle.1)
}

/// The edges between corners sorted from top to bottom; of a wide triangle those on `line`.
#[inline]
fn edges(p: [(u16, u16); 3], line: i32) -> Edges {
    const LOW: u16 = 8 * (GUARD_CENTRE - 511) as u16;
    const HIGH: u16 = 8 * (GUARD_CENTRE + 511) as u16;
    let [top, middle, bottom] = p;
    let holds = |a: (u16, u16), b: (u16, u16)| {
        Edge::holds(
            i32::from(b.0) - i32::from(a.0),
            i32::from(b.1) - i32::from(a.1),
        )
    };
    let inside = p.iter().all(|p| p.0 >= LOW && p.0 < HIGH);
    if inside && holds(top, bottom) && holds(top, middle) && holds(middle, bottom) {
        let edge = |a: (u16, u16), b: (u16, u16)| {
            if first_at(a.1) < first_at(b.1) {
                Edge::new(a, b)
            } else {
                Edge::NONE
            }
        };
        return Edges::Narrow([edge(top, bottom), edge(top, middle), edge(middle, bottom)]);
    }
    let long = WideEdge::new(top, bottom).words();
    let short = if line < first_at(middle.1) {
        WideEdge::new(top, middle)
    } else if middle.1 < bottom.1 {
        WideEdge::new(middle, bottom)
    } else {
        // No line below the middle corner.
        return Edges::Wide([long, long]);
    };
    Edges::Wide([long, short.words()])
}

/// Depth and levels of a thin triangle at a pixel of guard space, from exact weights.
///
/// The weights are at least 0 and their sum is at most 1, so the result lies between the
/// corners' values, always.
pub(crate) fn at_pixel<S: Shading>(
    corners: [SceneVertex<S::Vertex>; 3],
    face: S::Face,
    steps: [u16; 3],
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
    let levels = S::weighted([w1, w2], corners.map(|c| c.attribute), face, steps);
    (depth as u32, levels)
}
