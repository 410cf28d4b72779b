//! Set-up: from the corners of an object to what drawing a line of it needs (K4, K5).
//!
//! Done when an object becomes active, and again on each line for one that found no room in the
//! cache: the same function of the same corners, so the same bits.

use super::colour::Scale;
use super::object::{Object, SceneVertex};
use super::shading::Shading;
use crate::num::{Edge, GUARD_CENTRE, InverseArea, Plane, SmallArea, column_exact, first_at};
use core::ops::Range;

#[cfg(test)]
mod tests;

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
    /// The edge from the top to the bottom corner.
    long: Edge,
    /// The edges above and below the middle corner.
    short: [Edge; 2],
    /// The first line below the middle corner.
    turn: u16,
    /// First line below the triangle.
    end: u16,
    sides: Sides,
    /// Depth and its range are still to be made: see [`Object::deepen`].
    shallow: bool,
    /// See [`Drawable::range`].
    range: (u16, u16),
    /// Depth and colour.
    pub parameters: Parameters<L>,
}

/// How the columns of a triangle are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sides {
    /// All of it is on the picture: edges are counted from the picture's first column.
    Inside,
    /// Some of it may be beside the picture: edges are counted from the middle of guard space.
    Near,
    /// The edges are divided out on each line, from corners sorted from top to bottom, which
    /// are kept in place of the edges.
    Divided,
}

impl<L> Drawable<L> {
    /// What an empty slot holds.
    pub const EMPTY: Self = Self {
        long: Edge::NONE,
        short: [Edge::NONE; 2],
        turn: 0,
        end: 0,
        sides: Sides::Inside,
        shallow: false,
        range: (0, 0),
        parameters: Parameters::Corners,
    };

    /// First line of guard space below the triangle.
    #[inline(always)]
    #[must_use]
    pub const fn end(&self) -> u16 {
        self.end
    }

    /// The nearest and farthest depth of the corners in units of 2^15, the first rounded up, the
    /// other down.
    ///
    /// Planes err by 16,386 at most (see `num`), so of two triangles the first is nearer at every
    /// pixel if its farthest is at least 2 above the nearest of the other.
    #[inline(always)]
    #[must_use]
    pub const fn range(&self) -> (u16, u16) {
        self.range
    }

    /// Whether its depth is still to be made, by [`Object::deepen`].
    #[inline(always)]
    pub(crate) const fn is_shallow(&self) -> bool {
        self.shallow
    }

    /// Whether all of it is on the picture, so that [`inside`](Drawable::inside) has its columns.
    #[inline(always)]
    #[must_use]
    pub const fn is_inside(&self) -> bool {
        matches!(self.sides, Sides::Inside)
    }

    /// Whether a line is above (0) or below (1) the middle corner: the sign of a difference, which
    /// takes three instructions less than a comparison.
    #[inline(always)]
    const fn part(&self, line: i32) -> usize {
        ((self.turn as i32 - 1 - line) as u32 >> 31) as usize
    }

    /// First covered pixel of the picture on `line` and the first after the last; none is covered
    /// where they are the same.
    #[inline(always)]
    #[must_use]
    pub fn inside(&self, line: i32) -> (u32, u32) {
        let short = self.short[self.part(line)];
        let (a, b) = (self.long.right_of(line), short.right_of(line));
        (a.min(b), a.max(b))
    }

    /// First covered column of guard space on `line` and the first after the last, for a picture
    /// whose first column is `left`; none is covered where they are the same.
    #[must_use]
    pub fn columns(&self, line: i32, left: i32) -> (i32, i32) {
        let below = self.part(line);
        match self.sides {
            Sides::Inside => {
                let (from, to) = self.inside(line);
                (left + from as i32, left + to as i32)
            }
            Sides::Near => {
                let [a, b] = [self.long, self.short[below]].map(|e| GUARD_CENTRE + e.column(line));
                (a.min(b), a.max(b))
            }
            Sides::Divided => {
                let [top, middle, bottom] =
                    [self.long, self.short[0], self.short[1]].map(Edge::as_corner);
                let short = [(top, middle), (middle, bottom)][below];
                let a = column_exact(top, bottom, line);
                let b = column_exact(short.0, short.1, line);
                (a.min(b), a.max(b))
            }
        }
    }
}

impl<F: Copy> Object<F> {
    /// The object's corners.
    #[inline]
    pub(crate) fn corners<'v, A>(
        &self,
        vertices: &'v [SceneVertex<A>],
    ) -> Option<[&'v SceneVertex<A>; 3]> {
        let at = |i: u16| vertices.get(usize::from(i));
        Some([
            at(self.corner[0])?,
            at(self.corner[1])?,
            at(self.corner[2])?,
        ])
    }

    /// Sets the object up in `out` for `line` and all below, and for a picture of these columns
    /// of guard space; `false` when the object does not exist in this arena or ends above.
    ///
    /// Where it may be `shallow`, depth is left to [`deepen`](Object::deepen) if that surely finds
    /// a plane: most lines of most scenes never ask for it.
    #[inline(never)]
    pub(crate) fn set_up<S: Shading<Face = F>>(
        &self,
        vertices: &[SceneVertex<S::Vertex>],
        scale: &Scale,
        (line, picture, shallow): (i32, &Range<i32>, bool),
        out: &mut Drawable<S::Levels>,
    ) -> bool {
        let Some(corners) = self.corners(vertices) else {
            return false;
        };
        let place = corners.map(|c| (c.x, c.y));
        let Some(area) = SmallArea::new(place) else {
            return self.set_up_large::<S>(corners, scale, (line, picture), out);
        };
        if !edges(place, true, line, picture, out) {
            return false;
        }
        let (attributes, depths) = (corners.map(|c| c.attribute), corners.map(|c| c.depth));
        let Some(levels) = S::set_up_small(&area, attributes, depths, self.face, scale) else {
            out.parameters = large::<S>(corners, self.face, scale);
            out.range = range(depths);
            out.shallow = false;
            return true;
        };
        let depths = depths.map(|d| d as i32);
        out.shallow = shallow && area.is_gentle(depths);
        if out.shallow {
            out.parameters = Parameters::Planes(Plane::ZERO, levels);
            return true;
        }
        out.range = range(depths.map(|d| d as u32));
        let depth = match area.wide_plane(depths) {
            Some(depth) => Some(depth),
            None => exact_plane(place, depths),
        };
        out.parameters = match depth {
            Some(depth) => Parameters::Planes(depth, levels),
            None => Parameters::Corners,
        };
        true
    }

    /// The same for one that is larger than 64 pixels or has next to no area.
    #[cold]
    #[inline(never)]
    fn set_up_large<S: Shading<Face = F>>(
        &self,
        corners: [&SceneVertex<S::Vertex>; 3],
        scale: &Scale,
        (line, picture): (i32, &Range<i32>),
        out: &mut Drawable<S::Levels>,
    ) -> bool {
        let place = corners.map(|c| (c.x, c.y));
        if !edges(place, false, line, picture, out) {
            return false;
        }
        out.parameters = large::<S>(corners, self.face, scale);
        out.range = range(corners.map(|c| c.depth));
        out.shallow = false;
        true
    }

    /// Makes the depth of `out`, in which this object was set up without it.
    #[cold]
    #[inline(never)]
    pub(crate) fn deepen<A, L>(&self, vertices: &[SceneVertex<A>], out: &mut Drawable<L>) {
        let Some(corners) = self.corners(vertices) else {
            return;
        };
        let (place, depths) = (corners.map(|c| (c.x, c.y)), corners.map(|c| c.depth));
        out.shallow = false;
        out.range = range(depths);
        let depths = depths.map(|d| d as i32);
        let plane = SmallArea::new(place).and_then(|area| area.wide_plane(depths));
        if let Parameters::Planes(depth, _) = &mut out.parameters {
            *depth = match plane {
                Some(plane) => plane,
                None => exact_plane(place, depths).unwrap_or_default(),
            };
        }
    }
}

/// The plane of a triangle that may be large or thin; `None`: it is too thin for one.
#[cold]
#[inline(never)]
fn exact_plane(place: [(u16, u16); 3], value: [i32; 3]) -> Option<Plane> {
    InverseArea::new(place)?.plane(value)
}

/// See [`Drawable::range`].
#[inline(always)]
fn range([a, b, c]: [u32; 3]) -> (u16, u16) {
    (
        ((a.max(b).max(c) >> 15) as u16).saturating_add(1),
        (a.min(b).min(c) >> 15) as u16,
    )
}

/// Parameters of a triangle that is large or thin; of its depth, where it has one, that by its
/// small area.
#[cold]
#[inline(never)]
fn large<S: Shading>(
    corners: [&SceneVertex<S::Vertex>; 3],
    face: S::Face,
    scale: &Scale,
) -> Parameters<S::Levels> {
    let place = corners.map(|c| (c.x, c.y));
    let planes = || {
        let area = InverseArea::new(place)?;
        let depths = corners.map(|c| c.depth as i32);
        let depth = match SmallArea::new(place).and_then(|small| small.wide_plane(depths)) {
            Some(depth) => depth,
            None => area.plane(depths)?,
        };
        let levels = S::set_up(
            &area,
            corners.map(|c| c.attribute),
            corners.map(|c| c.depth),
            face,
            scale,
        )?;
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
///
/// `small` says that no side is longer than 512 units.
#[inline(always)]
fn edges<L>(
    p: [(u16, u16); 3],
    small: bool,
    line: i32,
    picture: &Range<i32>,
    out: &mut Drawable<L>,
) -> bool {
    let [top, middle, bottom] = sorted(p);
    let turn = first_at(middle.1);
    let end = first_at(bottom.1);
    if line >= end {
        return false;
    }
    let long = difference(top, bottom);
    let upper = difference(top, middle);
    let lower = difference(middle, bottom);
    // The pixels of the picture, not counting its last column, are `8 left - 4 .. 8 right - 4`.
    let low = 8 * picture.start - 4;
    let width = picture.end - picture.start;
    let inside = width <= 1023
        && p.iter()
            .all(|p| (i32::from(p.0) - low) as u32 <= 8 * width as u32);
    out.end = end as u16;
    out.turn = turn as u16;
    if !(small && inside) {
        return wide_edges([top, middle, bottom], inside, picture.start, out);
    }
    out.sides = Sides::Inside;
    out.long = Edge::small(top, long, picture.start);
    if line < turn {
        out.short[0] = Edge::small(top, upper, picture.start);
    }
    if turn < end {
        out.short[1] = Edge::small(middle, lower, picture.start);
    }
    true
}

/// The edges of a triangle that is large or may reach beside the picture.
#[cold]
#[inline(never)]
fn wide_edges<L>(
    [top, middle, bottom]: [(u16, u16); 3],
    inside: bool,
    left: i32,
    out: &mut Drawable<L>,
) -> bool {
    const LOW: u16 = 8 * (GUARD_CENTRE - 511) as u16;
    const SPAN: u16 = 8 * 1022;
    let sides =
        [(top, bottom), (top, middle), (middle, bottom)].map(|(a, b)| (a, difference(a, b)));
    let near = inside
        || [top, middle, bottom]
            .iter()
            .all(|p| p.0.wrapping_sub(LOW) < SPAN);
    if !near || sides.iter().any(|(_, (dx, dy))| !Edge::holds(*dx, *dy)) {
        out.sides = Sides::Divided;
        [out.long, out.short[0], out.short[1]] = [top, middle, bottom].map(Edge::from_corner);
        return true;
    }
    let origin = if inside {
        out.sides = Sides::Inside;
        left
    } else {
        out.sides = Sides::Near;
        GUARD_CENTRE
    };
    // A level edge is never asked.
    [out.long, out.short[0], out.short[1]] = sides.map(|(from, (dx, dy))| {
        if dy > 0 {
            Edge::new(from, (dx, dy), origin)
        } else {
            Edge::NONE
        }
    });
    true
}

/// From one point to another.
#[inline(always)]
fn difference(a: (u16, u16), b: (u16, u16)) -> (i32, i32) {
    (
        i32::from(b.0) - i32::from(a.0),
        i32::from(b.1) - i32::from(a.1),
    )
}

/// Depth and levels of a thin triangle at a pixel of guard space, from exact weights.
///
/// The weights are at least 0 and their sum is at most 1, so the result lies between the
/// corners' values, always.
pub(crate) fn at_pixel<S: Shading>(
    corners: [&SceneVertex<S::Vertex>; 3],
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
    let levels = S::weighted(
        [w1, w2],
        corners.map(|c| c.attribute),
        corners.map(|c| c.depth),
        face,
        scale,
    );
    (depth as u32, levels)
}
