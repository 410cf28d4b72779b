//! Triangles of vertices that were set up beforehand (H11): they end as objects of the scene like those of any mesh, so
//! caches, depth and order see no difference.

use super::super::camera::Screen;
use super::super::colour::Colour;
use super::super::object::{Object, SceneVertex};
use super::super::project::{DEPTH_MAX, DEPTH_MIN};
use super::super::shading::Shading;
use super::faces::Picture;
use super::{Assembled, Cull, Dropped, MeshError, Room, Store, Surfaced, first_line};
use core::ops::Range;

/// A vertex that was set up beforehand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct ScreenVertex {
    /// Column in 13.3 from the picture's left rim. What lies farther out than guard space, 4,080
    /// pixels from the picture's middle, is moved to its rim.
    pub x: i16,
    /// Line in 13.3 from the picture's top, likewise.
    pub y: i16,
    /// 1/w, the near plane at 2^31; 2^15 at least and 2^31 - 2^15 at most are kept.
    pub depth: u32,
    /// Colour, 0 to 255 a channel, red first.
    pub colour: [u8; 3],
}

/// Units of guard space that vertices keep from its rim, as the guard planes do.
const RIM: i32 = 128;

/// A coordinate within guard space.
fn guarded(v: i32) -> u16 {
    v.clamp(RIM, 0xFFFF - RIM) as u16
}

/// Triangles of vertices that are on the screen already.
pub(crate) struct ScreenMesh<'v> {
    pub(crate) vertices: &'v [ScreenVertex],
    pub(crate) faces: &'v [[u16; 3]],
    pub(crate) cull: Cull,
}

/// Takes triangles of vertices that are on the screen already; `file` as in
/// [`Assembler::mesh`].
///
/// # Errors
/// When an index or the skin does not fit; then nothing has been kept.
pub(crate) fn on_screen<S: Shading>(
    store: &mut Store<'_, S>,
    screen: Screen,
    lines: Range<u16>,
    surface: Surfaced<'_, '_, S>,
    mesh: ScreenMesh<'_>,
    mut file: impl FnMut(Object<S::Face>, i32) -> Option<()>,
) -> Result<Assembled, MeshError> {
    let Surfaced { scale, skin } = surface;
    let ScreenMesh {
        vertices,
        faces,
        cull,
    } = mesh;
    if !S::fits(&skin, vertices.len()) {
        return Err(MeshError::AttributeLength);
    }
    let misses = |f: &[u16; 3]| f.iter().any(|i| usize::from(*i) >= vertices.len());
    if let Some(face) = faces.iter().position(misses) {
        return Err(MeshError::Index { face: face as u32 });
    }
    let (left, top) = (screen.left(), screen.top());
    let picture = Picture::new(screen, lines);
    let set_up = |i: usize, v: &ScreenVertex| {
        let mut attribute = S::Vertex::default();
        if !S::PER_FACE {
            attribute = S::vertex(Colour::from_rgb8(v.colour, scale));
        }
        S::dress(&mut attribute, &skin, i);
        SceneVertex {
            x: guarded(i32::from(v.x) + 8 * left),
            y: guarded(i32::from(v.y) + 8 * top),
            depth: v.depth.clamp(DEPTH_MIN, DEPTH_MAX),
            attribute,
        }
    };
    let arena = &mut store.vertices;
    let base = arena.len();
    // Shared where all fit, as those of meshes are.
    let shared = match arena.append(vertices.len()) {
        Some(out) => {
            for (i, (slot, v)) in out.iter_mut().zip(vertices).enumerate() {
                *slot = set_up(i, v);
            }
            true
        }
        None => false,
    };
    let wide = S::may_be_plain(&skin);
    let mut done = Assembled {
        triangles: faces.len() as u32,
        ..Assembled::default()
    };
    for (n, corners) in (0..).zip(faces) {
        // The indices were checked.
        let corner = corners.map(|i| {
            let i = usize::from(i);
            vertices.get(i).map(|v| set_up(i, v))
        });
        let [Some(a), Some(b), Some(c)] = corner else {
            continue;
        };
        let place = [a, b, c].map(|v| (v.x, v.y));
        let Some(first) = first_line(place, cull, &picture) else {
            done.culled += 1;
            continue;
        };
        let before = arena.len();
        let mut index = corners.map(|i| (base as u16).wrapping_add(i));
        let mut room = Room::Objects;
        let mut fits = true;
        if !shared {
            for (slot, vertex) in index.iter_mut().zip([a, b, c]) {
                match arena.push(vertex) {
                    Some(at) => *slot = at,
                    None => (fits, room) = (false, Room::Vertices),
                }
            }
        }
        let mut face = S::Face::default();
        if let Some(v) = vertices
            .get(usize::from(corners[0]))
            .filter(|_| S::PER_FACE)
        {
            face = S::face(Colour::from_rgb8(v.colour, scale));
        }
        S::dress_face(&mut face, &skin);
        let object = Object::new(index, face);
        if fits && file(object, first).is_some() {
            done.kept += 1;
            let attributes = [&a.attribute, &b.attribute, &c.attribute];
            if wide && S::is_plain(&skin, attributes) {
                done.untextured += 1;
            }
            continue;
        }
        arena.truncate(before);
        let dropped = done.dropped.get_or_insert(Dropped {
            room,
            first_face: n,
            triangles: 0,
        });
        dropped.triangles += 1;
    }
    if done.kept == 0 {
        arena.truncate(base);
    }
    Ok(done)
}
