//! What triangles have that a plane serves, and those that are too thin for one (H1, K5).

use super::spans::Span;
use crate::look::{Parts, ThinSpan};
use crate::num::divide;
use crate::scene::ORIGIN;
use crate::span::{Size, Triangle};

/// What all depths are raised by, more than a plane may err.
pub(super) const MARGIN: u32 = 1 << 14;

/// The plane of 1/w, from the picture's first pixel on; `None` where the triangle is too thin for one.
///
/// What planes may err is kept from 0, the farthest.
#[inline(never)]
pub(super) fn depth_plane(triangle: &Triangle<'_>) -> Option<[u32; 3]> {
    let depth = triangle.vertex.map(|v| v.depth);
    let area = triangle.area();
    let plane = if triangle.size(area) == Size::Tiny {
        let rise = |i: usize| depth[i].wrapping_sub(depth[0]) as i32;
        let steep = triangle.shares(area).steep(rise(1), rise(2));
        steep.map(|[at, dx, dy]| [at.wrapping_add(depth[0]), dx, dy])
    } else {
        None
    };
    let [at, dx, dy] = match plane {
        Some(plane) => plane,
        None => {
            let values = depth.map(|d| d.min(i32::MAX as u32) as i32);
            let area = triangle.wide_area();
            area.as_ref()?.plane(values)?
        }
    };
    Some([at.wrapping_add(MARGIN), dx, dy])
}

/// What the corners have in the first and in the last pixel of a span.
#[inline(never)]
pub(super) fn thin_span<'a>(triangle: &'a Triangle<'a>, span: Span, line: u32) -> ThinSpan<'a> {
    let first = parts_at(triangle, span.start, line);
    let last = if span.end - span.start > 1 {
        parts_at(triangle, span.end - 1, line)
    } else {
        first
    };
    ThinSpan {
        triangle,
        parts: [first, last],
        start: span.start,
        pixels: span.end - span.start,
    }
}

/// What the corners have in a pixel that the triangle covers: areas across from them.
fn parts_at(triangle: &Triangle<'_>, column: u32, line: u32) -> Parts {
    let [a, b, c] = [0, 1, 2].map(|i| {
        let place = triangle.place(i);
        [(place & 0xFFFF) as i32, (place >> 16) as i32]
    });
    let x = 8 * (column as i32 + ORIGIN) + 4 - a[0];
    let y = 8 * (line as i32 + ORIGIN) + 4 - a[1];
    let area = triangle.area();
    let part = |doubled: i32| part_of((doubled.max(0) as u32).min(area), area);
    let across = |to: [i32; 2]| {
        let [dx, dy] = [to[0] - a[0], to[1] - a[1]];
        x.wrapping_mul(dy).wrapping_sub(y.wrapping_mul(dx))
    };
    Parts {
        second: part(across(c)),
        third: part(across(b).wrapping_neg()),
    }
}

/// `part / whole` in units of 2^-30, to 21 bits where the whole has 10; a part is at most the whole.
fn part_of(part: u32, whole: u32) -> u32 {
    if whole < 1 << 10 {
        return ((part << 21) / whole.max(1)) << 9;
    }
    divide(u64::from(part) << 30, whole)
}
