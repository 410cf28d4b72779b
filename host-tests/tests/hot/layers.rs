//! The order in which draw calls reach a pixel, and which of them do, for references that go from pixel to pixel.
//!
//! Where two depths are nearer to each other than depth may err, nobody knows.

use super::Corner;
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
