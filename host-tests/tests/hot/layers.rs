//! The order in which draw calls reach a pixel, and which of them do, for references that go from pixel to pixel.
//!
//! Where two depths are nearer to each other than depth may err, nobody knows.

use super::Corner;
use super::exact::doubled_area;
use super::values::{Function, passes};
use crate::hot_path_depth::{bound, exact};
use std::cmp::Ordering;

/// What of a call decides where it is seen, at a pixel that it covers.
pub struct Layer<'a> {
    pub corners: &'a [Corner; 3],
    /// Where it is seen, and where its depth is kept.
    pub test: [Function; 2],
    /// Whether what is behind shines through.
    pub is_translucent: bool,
}

/// A depth that is there: nothing, or that of a triangle.
#[derive(Clone, Copy)]
struct There<'a> {
    of: Option<&'a [Corner; 3]>,
    depth: f64,
    off: f64,
}

impl<'a> There<'a> {
    const FARTHEST: Self = Self {
        of: None,
        depth: 0.0,
        off: 0.0,
    };

    fn of(corners: &'a [Corner; 3], [x, y]: [u16; 2]) -> Self {
        Self {
            of: Some(corners),
            depth: exact(corners, x.into(), y),
            off: bound(corners),
        }
    }

    /// How it compares with what is there; `None` where that is not known. A triangle is as far as itself.
    fn compare(self, there: Self) -> Option<Ordering> {
        let same = |a: &[Corner; 3], b: &[Corner; 3]| {
            (0..3).all(|i| a[i].at == b[i].at && a[i].w == b[i].w)
        };
        if let (Some(a), Some(b)) = (self.of, there.of) {
            if same(a, b) {
                return Some(Ordering::Equal);
            }
        }
        let apart = self.depth - there.depth;
        (apart.abs() > self.off + there.off).then(|| apart.total_cmp(&0.0))
    }
}

/// How a face of a shadow volume compares with what is there (K9): of what it may be nearer or farther by, 1/64 pixel of
/// its way and 256 units, it is nearer where it is seen from outside, and farther from inside.
pub fn compare_face(
    face: &[Corner; 3],
    there: Option<&[Corner; 3]>,
    at: [u16; 2],
) -> Option<Ordering> {
    let (here, [x, y]) = (There::of(face, at), at);
    let there = there.map_or(There::FARTHEST, |there| There::of(there, at));
    let right = There::of(face, [x + 1, y]).depth - here.depth;
    let down = There::of(face, [x, y + 1]).depth - here.depth;
    // Thin triangles have no step down, those that are too steep for a plane the one of their span, which may be of one
    // pixel; and sums are rounded.
    let is_steep = right.abs().max(down.abs()) > f64::from(1 << 29);
    let range = [
        if is_steep { 0.0 } else { right.abs() * 0.98 },
        right.abs() * 1.02 + down.abs() * 1.02,
    ];
    let [least, most] = [range[0] / 64.0 + 252.0, range[1] / 64.0 + 260.0];
    // Clockwise is from inside.
    let is_back = doubled_area(face.map(|corner| corner.at)) > 0;
    let apart = here.depth - there.depth;
    let off = if here.compare(there) == Some(Ordering::Equal) {
        0.0
    } else {
        here.off + there.off
    };
    let [below, above] = if is_back {
        [least, most]
    } else {
        [-most, -least]
    };
    match () {
        () if apart > above + off => Some(Ordering::Greater),
        () if apart < below - off => Some(Ordering::Less),
        () => None,
    }
}

/// Calls `lay` with each call that is seen at a pixel, from the first to be laid on; `None` where that hangs on what
/// depth may err, or `lay` says so. Calls come in order of priority, those that cover the pixel alone.
pub fn lay_all<'a, C: Copy>(
    calls: impl IntoIterator<Item = (Layer<'a>, C)>,
    at: [u16; 2],
    by_depth: bool,
    mut lay: impl FnMut(C) -> Option<()>,
) -> Option<()> {
    let mut there = There::FARTHEST;
    let mut waiting: Vec<(C, Function, There<'_>)> = Vec::new();
    for (layer, call) in calls {
        if !by_depth {
            lay(call)?;
            continue;
        }
        let here = There::of(layer.corners, at);
        if layer.is_translucent {
            // From far to near; what is as far as another comes after it.
            let mut place = waiting.len();
            for (i, (_, _, other)) in waiting.iter().enumerate().rev() {
                if here.compare(*other)? == Ordering::Less {
                    place = i;
                }
            }
            waiting.insert(place, (call, layer.test[0], here));
            continue;
        }
        let order = here.compare(there)?;
        if passes(layer.test[0], order) {
            lay(call)?;
        }
        if passes(layer.test[1], order) {
            there = here;
        }
    }
    for (call, seen_if, here) in waiting {
        if passes(seen_if, here.compare(there)?) {
            lay(call)?;
        }
    }
    Some(())
}
