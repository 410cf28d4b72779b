//! What is known of faces before there are objects: their indices, and which of them can be seen.

use super::super::camera::Screen;
use super::super::mesh::{Faces, Mesh, QuadSplit};
use super::super::object::SceneVertex;
use super::MeshError;
use crate::num::{first_at, turn};
use core::ops::Range;

/// Which faces are dropped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Cull {
    /// Those seen from behind.
    #[default]
    Back,
    /// None.
    None,
}

/// The part of guard space that is the picture.
pub(super) struct Picture {
    pub(super) columns: Range<i32>,
    pub(super) lines: Range<i32>,
}

impl Picture {
    /// These lines of a screen.
    pub(super) fn new(screen: Screen, lines: Range<u16>) -> Self {
        let (left, top) = (screen.left(), screen.top());
        Self {
            columns: left..left + i32::from(screen.width()),
            lines: top + i32::from(lines.start)..top + i32::from(lines.end),
        }
    }
}

/// How many triangles there are.
pub(crate) fn triangles(faces: Faces<'_>) -> u32 {
    (match faces {
        Faces::Triangles(faces) => faces.len(),
        Faces::Quads(faces, _) => 2 * faces.len(),
        Faces::QuadStrip(strip, _) => strip.len().saturating_sub(2),
    }) as u32
}

/// Whether all slices agree and all indices exist.
pub(crate) fn check<C>(mesh: &Mesh<'_, C>) -> Result<(), MeshError> {
    check_known(mesh, usize::MAX)
}

/// The same where those indices exist that are known to be below a number of vertices that are
/// there.
pub(crate) fn check_known<C>(mesh: &Mesh<'_, C>, below: usize) -> Result<(), MeshError> {
    let count = mesh.positions.len();
    let fits = |len: usize| len == 0 || len == count;
    if !fits(mesh.normals.len()) || !fits(mesh.colours.len()) {
        return Err(MeshError::AttributeLength);
    }
    match mesh.faces {
        Faces::QuadStrip(strip, _) if strip.len() % 2 != 0 || strip.len() == 2 => {
            return Err(MeshError::StripLength);
        }
        _ => {}
    }
    if below <= count {
        return Ok(());
    }
    let good = |face: &[u16]| face.iter().all(|&i| usize::from(i) < count);
    if all_below(mesh.faces, count) {
        return Ok(());
    }
    let bad = match mesh.faces {
        Faces::Triangles(faces) => faces.iter().position(|f| !good(f)),
        Faces::Quads(faces, _) => faces.iter().position(|f| !good(f)),
        Faces::QuadStrip(strip, _) => strip
            .iter()
            .position(|&i| usize::from(i) >= count)
            .map(|i| i.saturating_sub(2) / 2),
    };
    match bad {
        Some(face) => Err(MeshError::Index { face: face as u32 }),
        None => Ok(()),
    }
}

/// Whether all indices are below `count`: three instructions each on a Cortex-M4.
#[inline]
fn all_below(faces: Faces<'_>, count: usize) -> bool {
    let indices = match faces {
        Faces::Triangles(faces) => faces.as_flattened(),
        Faces::Quads(faces, _) => faces.as_flattened(),
        Faces::QuadStrip(strip, _) => strip,
    };
    are_below(indices, count)
}

/// One copy of the loop, whatever the faces are.
#[inline(never)]
fn are_below(indices: &[u16], count: usize) -> bool {
    let last = count.min(1 << 16) as i32 - 1;
    // The sign of the least distance from the last.
    indices
        .iter()
        .fold(0, |all, &i| all | (last - i32::from(i)))
        >= 0
}

/// Calls `f` with face, corners and provoking vertex of each triangle.
#[inline]
pub(crate) fn each_triangle(faces: Faces<'_>, mut f: impl FnMut(u32, [u16; 3], u16)) {
    let mut quad = |face: u32, q: [u16; 4], split| {
        let [a, b, c, d] = q;
        match split {
            QuadSplit::Corner0To2 => {
                f(face, [a, b, c], a);
                f(face, [a, c, d], a);
            }
            QuadSplit::Corner1To3 => {
                f(face, [a, b, d], a);
                f(face, [b, c, d], a);
            }
        }
    };
    match faces {
        Faces::Triangles(faces) => {
            for (face, &corners) in (0..).zip(faces) {
                f(face, corners, corners[0]);
            }
        }
        Faces::Quads(faces, split) => {
            for (face, &q) in (0..).zip(faces) {
                quad(face, q, split);
            }
        }
        Faces::QuadStrip(strip, split) => {
            // Two new vertices reuse the last two and take their roles crosswise, so a constant
            // split gives a cross-hatch.
            for (face, p) in (0..).zip(strip.windows(4).step_by(2)) {
                let split = if face % 2 == 0 { split } else { split.other() };
                quad(face, [p[0], p[1], p[3], p[2]], split);
            }
        }
    }
}

/// The first line on which a triangle can be seen; `None` when it faces away, or covers no
/// pixel centre's line or column of the picture.
#[inline]
pub(super) fn first_line(p: [(u16, u16); 3], cull: Cull, picture: &Picture) -> Option<i32> {
    is_seen(p, cull).then(|| first_of(p, picture)).flatten()
}

/// Whether a triangle has an area, and does not face away where that is to be dropped.
#[inline(always)]
pub(super) fn is_seen(p: [(u16, u16); 3], cull: Cull) -> bool {
    // y points down, so a counter-clockwise face has a negative area.
    let area = turn(p);
    match cull {
        Cull::Back => area < 0,
        Cull::None => area != 0,
    }
}

/// [`first_line`] of a triangle that does not face away.
#[inline(always)]
pub(super) fn first_of(p: [(u16, u16); 3], picture: &Picture) -> Option<i32> {
    let Picture { columns, lines } = picture;
    let least = |a: u16, b: u16, c: u16| a.min(b).min(c);
    let most = |a: u16, b: u16, c: u16| a.max(b).max(c);
    let first = first_at(least(p[0].1, p[1].1, p[2].1)).max(lines.start);
    let end = first_at(most(p[0].1, p[1].1, p[2].1)).min(lines.end);
    let left = first_at(least(p[0].0, p[1].0, p[2].0)).max(columns.start);
    let right = first_at(most(p[0].0, p[1].0, p[2].0)).min(columns.end);
    (first < end && left < right).then_some(first)
}

/// How many of the first triangles are on the screen and are all `hidden`.
///
/// A function of its own: there its loop has the registers that it needs.
#[inline(never)]
pub(super) fn leading<A>(
    vertices: &[SceneVertex<A>],
    faces: &[[u16; 3]],
    hidden: impl Fn([(u16, u16); 3]) -> bool,
) -> usize {
    let passes = |&[a, b, c]: &[u16; 3]| {
        let at = |i: u16| vertices.get(usize::from(i));
        // The indices were checked; said so for the compiler.
        let (Some(a), Some(b), Some(c)) = (at(a), at(b), at(c)) else {
            return false;
        };
        // Depths on the screen are below 2^31.
        hidden([(a.x, a.y), (b.x, b.y), (c.x, c.y)]) && (a.depth | b.depth | c.depth) >> 31 == 0
    };
    faces
        .iter()
        .position(|face| !passes(face))
        .unwrap_or(faces.len())
}
