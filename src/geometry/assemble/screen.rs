//! What is made on the screen itself: triangles of vertices that were set up beforehand, and points
//! (H11).
//!
//! Both end as objects of the scene like those of any mesh, so caches, depth and order see no
//! difference. A point of one pixel is one triangle: corners 12 units of 1/8 pixel apart hold the
//! centre of that pixel and no other.

use super::super::camera::Screen;
use super::super::colour::Colour;
use super::super::light::ModelLight;
use super::super::mesh::{Coordinate, Faces, Mesh};
use super::super::object::{Object, SceneVertex};
use super::super::project::{DEPTH_MAX, DEPTH_MIN};
use super::super::shading::Shading;
use super::faces::Picture;
use super::{
    Assembled, Assembler, Cull, Dropped, MeshError, Room, Store, Surfaced, check_known, first_line,
};
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

/// A point as it is kept: what all of its corners have in common.
struct Point<S: Shading> {
    /// Index of its vertex.
    number: u32,
    depth: u32,
    attribute: S::Vertex,
    face: S::Face,
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
    mut file: impl FnMut(Object<S::Face>, i32, &[SceneVertex<S::Vertex>]) -> Option<u32>,
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
        let filed = fits.then(|| file(object, first, arena.as_slice()));
        if let Some(objects) = filed.flatten() {
            done.kept += objects;
            let attributes = [&a.attribute, &b.attribute, &c.attribute];
            if objects == 0 {
                done.culled += 1;
                arena.truncate(before);
            } else if wide && S::is_plain(&skin, attributes) {
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

impl<S: Shading, L: ModelLight> Assembler<'_, '_, '_, S, L> {
    /// Takes the vertices of a mesh as points of `size` pixels; its faces do not count.
    ///
    /// # Errors
    /// As [`mesh`](Assembler::mesh).
    pub(crate) fn points<C: Coordinate>(
        mut self,
        mesh: &Mesh<'_, C>,
        size: u8,
        mut file: impl FnMut(Object<S::Face>, i32, &[SceneVertex<S::Vertex>]) -> Option<u32>,
    ) -> Result<Assembled, MeshError> {
        let mesh = &Mesh {
            faces: Faces::Triangles(&[]),
            ..*mesh
        };
        check_known(mesh, 0)?;
        if !S::fits(&self.skin, mesh.positions.len()) {
            return Err(MeshError::AttributeLength);
        }
        // A triangle that holds the centre of one pixel, or the two of a square.
        let side = 8 * i32::from(size);
        let faces: &[[usize; 3]] = match size {
            0 => return Ok(self.done),
            1 => &[[0, 1, 2]],
            _ => &[[0, 1, 3], [1, 2, 3]],
        };
        for (i, position) in mesh.positions.iter().enumerate() {
            self.done.triangles += faces.len() as u32;
            let point = self.projection.transform(*position);
            if !self.projection.is_within(point) {
                self.done.culled += faces.len() as u32;
                continue;
            }
            let at = self.projection.project(point);
            // The square of whole pixels whose middle is nearest.
            let first = |v: u16| (i32::from(v) - (side >> 1) + 4) & !7;
            let (left, top) = (first(at.x), first(at.y));
            let far = if size == 1 { 12 } else { side };
            let third = if size == 1 { 0 } else { far };
            let place = [
                (left, top),
                (left, top + far),
                (left + far, top + third),
                (left + far, top),
            ]
            .map(|(x, y)| (guarded(x), guarded(y)));
            let colour = self.vertex_colour(mesh, i);
            let mut attribute = S::Vertex::default();
            let mut face_colour = S::Face::default();
            if S::PER_FACE {
                face_colour = S::face(colour);
            } else {
                attribute = S::vertex(colour);
            }
            S::dress(&mut attribute, &self.skin, i);
            S::dress_face(&mut face_colour, &self.skin);
            let point = Point {
                number: i as u32,
                depth: at.depth,
                attribute,
                face: face_colour,
            };
            self.point(point, faces, place, &mut file);
        }
        Ok(self.done)
    }

    /// One point.
    fn point(
        &mut self,
        point: Point<S>,
        faces: &[[usize; 3]],
        place: [(u16, u16); 4],
        file: &mut impl FnMut(Object<S::Face>, i32, &[SceneVertex<S::Vertex>]) -> Option<u32>,
    ) {
        let (before, kept) = (self.vertices.len(), self.done.kept);
        let mut index = [0; 4];
        let corners = if faces.len() == 1 { 3 } else { 4 };
        for (slot, (x, y)) in index.iter_mut().zip(place).take(corners) {
            let vertex = SceneVertex {
                x,
                y,
                depth: point.depth,
                attribute: point.attribute,
            };
            match self.vertices.push(vertex) {
                Some(at) => *slot = at,
                None => {
                    self.vertices.truncate(before);
                    self.dropped(Room::Vertices, point.number);
                    self.count_lost();
                    return;
                }
            }
        }
        for &[a, b, c] in faces {
            match self.first_line([place[a], place[b], place[c]]) {
                Some(first) => {
                    let object = Object::new([index[a], index[b], index[c]], point.face);
                    let kept = self.done.kept;
                    self.keep(object, first, point.number, file);
                    self.settle(kept);
                }
                None => self.done.culled += 1,
            }
        }
        if self.done.kept == kept {
            self.vertices.truncate(before);
        }
    }
}
