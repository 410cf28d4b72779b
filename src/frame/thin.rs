//! What triangles have that a plane serves, and those that are too thin for one (H1, K5).

use super::line::Span;
use crate::look::{End, ThinSpan};
use crate::span::{Size, Triangle, first_line};

/// The plane of 1/w, from the picture's first pixel on; `None` where the triangle is too thin for one.
///
/// What planes may err is kept from 0, the farthest.
#[inline(never)]
pub(super) fn depth_plane(triangle: &Triangle<'_>) -> Option<[u32; 3]> {
    /// More than a plane may err.
    const MARGIN: u32 = 1 << 14;
    let depth = triangle.vertex.map(|v| v.depth);
    let area = triangle.area();
    let plane = if triangle.size(area) == Size::Tiny {
        let rise = |i: usize| depth[i].wrapping_sub(depth[0]) as i32;
        let steep = triangle.shares(area).steep(rise(1), rise(2));
        steep.map(|[at, dx, dy]| [at.wrapping_add(depth[0]), dx, dy])
    } else {
        None
    };
    let plane = match plane {
        Some(plane) => plane,
        None => {
            let values = depth.map(|d| d.min(i32::MAX as u32) as i32);
            triangle.in_picture(triangle.wide_area()?.plane(values)?)
        }
    };
    let [at, dx, dy] = plane;
    Some([at.wrapping_add(MARGIN), dx, dy])
}

/// Where the ends of a line lie on a triangle's sides.
#[inline(never)]
pub(super) fn thin_span<'a>(triangle: &'a Triangle<'a>, span: Span, line: u32) -> ThinSpan<'a> {
    let y = i64::from(8 * (line as i32 + triangle.frame.top) + 4);
    let [b, c] = [1, 2].map(|i| first_line(triangle.place(i)) - triangle.frame.top);
    let end = |from: usize, to: usize| {
        let [top, bottom] = [from, to].map(|i| i64::from(triangle.place(i) >> 16));
        let way = ((y - top) << 16) / (bottom - top).max(1);
        End {
            from,
            to,
            way: way.clamp(0, 1 << 16) as u32,
        }
    };
    let line = line as i32;
    ThinSpan {
        triangle,
        ends: [
            if line < c { end(0, 2) } else { end(2, 1) },
            if line < b { end(0, 1) } else { end(1, 2) },
        ],
        start: span.start,
        pixels: span.end - span.start,
    }
}
