//! Triangles that cross the near, far or guard planes, cut plane by plane (K1).
//!
//! Near and far cut in space, so colours and texture places follow the edge linearly. The guard band cuts
//! on the screen, where colour is linear, so there colours follow the projected edge, and cutting leaves the
//! shading as if nothing had been cut; texture places are linear in space in either case. Each cut is
//! reckoned from the inner to the outer end, so two triangles that share an edge get the same new vertex. Points have
//! all bits of x and y while they are cut: near the eye those would be seen that a vertex can do without.

use super::project::{Point, View, beyond};
use crate::geometry::Colour;
use crate::num::{divide, mul_wide};
use core::hint::black_box;
use heapless::Vec;

/// A corner on its way through the planes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Corner {
    pub(super) point: Point,
    pub(super) colour: u32,
    /// Texels with 14 fraction bits, modulo 2^18.
    pub(super) texel: [i32; 2],
    /// The alpha, with 8 fraction bits: it follows edges as the colour does.
    pub(super) alpha: u16,
    /// The vertex of the mesh; [`Corner::CUT`] where a plane made the corner.
    pub(super) vertex: u16,
}

impl Corner {
    /// No vertex, or the last that a mesh can have.
    pub(super) const CUT: u16 = u16::MAX;

    /// A corner that a plane made, of nothing but a colour.
    pub(super) fn cut(point: Point, colour: u32) -> Self {
        Self {
            point,
            colour,
            ..Self::of_vertex(Self::CUT)
        }
    }

    /// A vertex of the mesh, of which nothing else is known yet.
    pub(super) fn of_vertex(vertex: u16) -> Self {
        Self {
            vertex,
            ..Self::default()
        }
    }
}

/// A convex polygon: a triangle gains at most one corner a plane.
type Polygon = Vec<Corner, 7, u8>;

/// Calls `f` with triangles that are what lies within all planes of `beyond`, of corners whose points are finer.
///
/// What near and far leave is parted into triangles before the guard band cuts each of them: four corners have no plane
/// of colour in common, so how they are parted is seen, and must not hang on where the guard band is.
#[inline(never)]
pub(super) fn cut_all(
    corners: &[Corner; 3],
    view: &View,
    beyond: u32,
    f: &mut dyn FnMut(&[Corner; 3]),
) {
    let depth = [beyond::NEAR, beyond::FAR].map(|plane| plane & beyond);
    cut_by(corners, view, &depth, &mut |piece| {
        // A cut at the near plane may reach beyond the guard band where no corner does.
        if piece.iter().all(|corner| view.is_between(corner.point)) {
            return f(piece);
        }
        let sides = [beyond::RIGHT, beyond::LEFT, beyond::BOTTOM, beyond::TOP];
        cut_by(piece, view, &sides, f);
    });
}

/// Calls `f` with the triangles of what lies within some planes: a convex polygon in the order of the corners, as a fan
/// around the first.
#[inline(never)]
fn cut_by(corners: &[Corner; 3], view: &View, planes: &[u32], f: &mut dyn FnMut(&[Corner; 3])) {
    // Polygons are large: each plane's is made beside that of the one before.
    let (mut polygon, mut kept) = (Polygon::new(), Polygon::new());
    let (mut polygon, mut kept) = (&mut polygon, &mut kept);
    // Three of seven places: it cannot be full.
    let _ = polygon.extend_from_slice(corners);
    // One copy of the loop, for any number of them.
    for &plane in black_box(planes) {
        let is_within = |corner: &Corner| view.within(plane, corner.point) >= 0;
        if plane != 0 && !polygon.iter().all(is_within) {
            cut(polygon, view, plane, kept);
            (polygon, kept) = (kept, polygon);
        }
    }
    if let [first, rest @ ..] = polygon.as_slice() {
        for pair in rest.windows(2) {
            f(&[*first, pair[0], pair[1]]);
        }
    }
}

/// Where a triangle goes out through the near plane, and where it comes in again: the points that [`cut_all`] makes;
/// `None` where it does not.
pub(super) fn near_ends(points: [Point; 3], view: &View) -> Option<[Point; 2]> {
    let within = points.map(|point| view.within(beyond::NEAR, point));
    let end = |inner: usize, outer: usize| {
        let [from, to] = [inner, outer].map(|i| Corner::cut(points[i], 0));
        Some(between(&from, &to, [within[inner], within[outer]], false).point)
    };
    let (mut out, mut back) = (None, None);
    for (i, next) in [(0, 1), (1, 2), (2, 0)] {
        match (within[i] >= 0, within[next] >= 0) {
            (true, false) => out = end(i, next),
            (false, true) => back = end(next, i),
            _ => {}
        }
    }
    Some([out?, back?])
}

/// Keeps what lies within one plane. It begins with the first corner within, or the new one before it.
#[inline(never)]
fn cut(polygon: &[Corner], view: &View, plane: u32, kept: &mut Polygon) {
    kept.clear();
    for (i, this) in polygon.iter().enumerate() {
        let next = polygon.get(i + 1).or(polygon.first()).unwrap_or(this);
        let [within, next_within] = [this, next].map(|corner| view.within(plane, corner.point));
        if within >= 0 {
            // A convex polygon crosses a plane twice and loses a corner for the two that it gains.
            let _ = kept.push(*this);
        }
        if (within < 0) != (next_within < 0) {
            let guard = plane > beyond::FAR;
            let (inner, outer, far) = if within < 0 {
                (next, this, [next_within, within])
            } else {
                (this, next, [within, next_within])
            };
            let _ = kept.push(between(inner, outer, far, guard));
        }
    }
}

/// The point where the edge from `inner` to `outer` meets the plane that they lie so far within.
fn between(inner: &Corner, outer: &Corner, [near, far]: [i64; 2], on_screen: bool) -> Corner {
    // t = near / (near - far) in 2^-30; both are below 2^33.
    let whole = near.unsigned_abs() + far.unsigned_abs();
    let down = 31u32.saturating_sub(whole.leading_zeros());
    let whole = ((whole >> down) as u32).max(1);
    let t = divide((near.unsigned_abs() >> down) << 30, whole);
    let (a, b) = (inner.point, outer.point);
    let [x, y, z] = [(a.x, b.x), (a.y, b.y), (a.z, b.z)].map(|(a, b)| mix(a, b, t));
    let point = Point { x, y, z };
    // On the screen the same point is at t zb / z of the projected edge.
    let along = if on_screen && point.z > 0 {
        let part = mul_wide((t >> 1) as i32, b.z.max(0)) as u64;
        let z = point.z as u32;
        // Whole at most, but for what the point was rounded by.
        divide(part, z).min(1 << 29) << 1
    } else {
        t
    };
    let colour =
        Colour::from_word(inner.colour).lerp(Colour::from_word(outer.colour), along.into());
    Corner {
        point,
        colour: colour.word(),
        texel: [0, 1].map(|i| {
            let from = inner.texel[i];
            from.wrapping_add(mix(0, outer.texel[i].wrapping_sub(from), t))
        }),
        alpha: mix(inner.alpha.into(), outer.alpha.into(), along) as u16,
        vertex: Corner::CUT,
    }
}

/// The value so far from one to another, in 2^-30.
#[inline(never)]
fn mix(a: i32, b: i32, t: u32) -> i32 {
    let rise = (i64::from(b) - i64::from(a)) * i64::from(t);
    (i64::from(a) + ((rise + (1 << 29)) >> 30)) as i32
}
