//! Meshes into objects: vertices transformed and lit once, faces culled, clipped and handed on
//! with the first line they are on (K1, K2).

use super::camera::{Camera, Screen};
use super::clip::{Corner, guard, near_far};
use super::colour::{Colour, Scale, Tint};
use super::light::{LightingModel, ModelLight};
use super::mesh::{Coordinate, Faces, Mesh, QuadSplit};
use super::object::{OUTSIDE, Object, SceneVertex};
use super::project::Projection;
use super::shading::Shading;
use super::transform::{Affine, unit};
use crate::arena::Arena;
use crate::num::{first_at, turn};
use core::ops::Range;

mod screen;

pub use screen::ScreenVertex;
pub(crate) use screen::on_screen;

/// Which faces are dropped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Cull {
    /// Those seen from behind.
    #[default]
    Back,
    /// None.
    None,
}

/// Which arena had no room.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Room {
    /// That of the vertices.
    Vertices,
    /// That of the objects.
    Objects,
}

/// Faces that could not be kept; all others are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Dropped {
    /// The arena that was full when the first was dropped.
    pub room: Room,
    /// Index of the first face that lost a triangle.
    pub first_face: u32,
    /// How many triangles were dropped, or lost a piece that clipping had made of them.
    pub triangles: u32,
}

/// A mesh that contradicts itself. Nothing of it is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum MeshError {
    /// An attribute slice is neither empty nor as long as the positions.
    AttributeLength,
    /// This face names a vertex that does not exist.
    Index {
        /// Index of the face.
        face: u32,
    },
    /// A quad strip has an odd number of indices, or two.
    StripLength,
}

/// What became of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Assembled {
    /// Triangles submitted.
    pub triangles: u32,
    /// Triangles that cannot be seen: outside, from behind, or between pixel centres.
    pub culled: u32,
    /// Triangles that crossed a near, far or guard plane.
    pub clipped: u32,
    /// Objects kept, pieces of clipped triangles included.
    pub kept: u32,
    /// What found no room.
    pub dropped: Option<Dropped>,
}

/// One mesh on its way to the screen.
pub(crate) struct Assembler<'a, 'm, 'k, S: Shading, L> {
    /// Where vertices go.
    vertices: &'a mut Arena<'m, SceneVertex<S::Vertex>>,
    pub(super) projection: Projection,
    /// Columns and lines of guard space that are drawn.
    columns: Range<i32>,
    lines: Range<i32>,
    cull: Cull,
    /// The light in model space.
    light: Option<L>,
    /// Colour of vertices without one.
    tint: Tint,
    /// What turns normals for the vertices that keep them.
    turn: S::Turn,
    /// A piece of the current triangle found no room.
    lost: bool,
    /// How levels become steps of the output.
    scale: &'a Scale,
    /// What the mesh brings beside its colours.
    pub(super) skin: S::Skin<'k>,
    pub(super) done: Assembled,
}

/// The arena in which pass one keeps vertices.
pub(crate) struct Store<'m, S: Shading> {
    pub(crate) vertices: Arena<'m, SceneVertex<S::Vertex>>,
}

impl<'a, 'm, 'k, S: Shading, L: ModelLight> Assembler<'a, 'm, 'k, S, L> {
    /// Prepares for meshes at `model` seen by `camera`; only objects on `lines` of the picture
    /// are kept.
    pub(crate) fn new<M: LightingModel<InModel = L>>(
        store: &'a mut Store<'m, S>,
        camera: &Camera,
        screen: Screen,
        lines: Range<u16>,
        model: &Affine,
        (cull, light, colour): (Cull, Option<M>, [u8; 3]),
        (scale, skin): (&'a Scale, S::Skin<'k>),
    ) -> Self {
        let light = light.map(|l| l.in_model(model, &camera.view));
        let (left, top) = (screen.left(), screen.top());
        Self {
            vertices: &mut store.vertices,
            projection: Projection::new(camera, screen, model),
            columns: left..left + i32::from(screen.width()),
            lines: top + i32::from(lines.start)..top + i32::from(lines.end),
            cull,
            light,
            tint: Tint::new(colour, scale),
            turn: S::turn(model, &camera.view),
            lost: false,
            scale,
            skin,
            done: Assembled::default(),
        }
    }

    /// Takes a mesh; `file` keeps an object that is first seen on a line of guard space, with its
    /// vertices, and says as how many objects, or that it has no room for it. Indices that are known to be below a number are not looked at
    /// where there are as many vertices.
    ///
    /// # Errors
    /// When the mesh contradicts itself; then nothing of it has been kept.
    pub(crate) fn mesh<C: Coordinate>(
        mut self,
        (mesh, below): (&Mesh<'_, C>, usize),
        mut file: impl FnMut(Object<S::Face>, i32, &[SceneVertex<S::Vertex>]) -> Option<u32>,
    ) -> Result<Assembled, MeshError> {
        check(mesh, below)?;
        if !S::fits(&self.skin, mesh.positions.len()) {
            return Err(MeshError::AttributeLength);
        }
        let base = self.vertices.len();
        // Where all vertices fit they are transformed and lit once and shared; where they do
        // not, each face brings its own, and only those of kept faces take room.
        let shared = self.shared_vertices(mesh);
        if S::SKINNED && shared {
            let vertices = self.vertices.as_mut_slice().get_mut(base..);
            for (i, vertex) in vertices.unwrap_or_default().iter_mut().enumerate() {
                S::dress(&mut vertex.attribute, &self.skin, i);
            }
        }
        if S::NORMALS && shared {
            let vertices = self.vertices.as_mut_slice().get_mut(base..);
            for (vertex, &normal) in vertices.unwrap_or_default().iter_mut().zip(mesh.normals) {
                S::set_normal(&mut vertex.attribute, &self.turn, normal);
            }
        }
        self.done.triangles = triangles(mesh.faces);
        match mesh.faces {
            Faces::Triangles(faces) if shared => {
                let mut face = 0;
                while face < faces.len() {
                    face = self.on_screen_faces(mesh, (faces, face), base, &mut file);
                    if let Some(&corners) = faces.get(face) {
                        let triangle = (face as u32, corners, corners[0]);
                        self.triangle(mesh, triangle, (base, shared), &mut file);
                    }
                    face += 1;
                }
            }
            _ => each_triangle(mesh.faces, |face, corners, provoking| {
                self.triangle(mesh, (face, corners, provoking), (base, shared), &mut file);
            }),
        }
        if self.done.kept == 0 {
            self.vertices.truncate(base);
        }
        Ok(self.done)
    }

    /// Takes all vertices of a mesh into the arena; `false` when there is no room for them.
    ///
    /// Position and colour each have a loop of their own, so that what either needs stays in
    /// registers.
    fn shared_vertices<C: Coordinate>(&mut self, mesh: &Mesh<'_, C>) -> bool {
        let projection = self.projection;
        let Some(vertices) = self.vertices.append(mesh.positions.len()) else {
            return false;
        };
        for (vertex, &position) in vertices.iter_mut().zip(mesh.positions) {
            let point = projection.transform(position);
            let (x, y, depth) = if projection.is_within(point) {
                let p = projection.project_within(point);
                (p.x, p.y, p.depth)
            } else {
                (projection.outcode(point), 0, OUTSIDE)
            };
            (vertex.x, vertex.y, vertex.depth) = (x, y, depth);
        }
        if S::PER_FACE {
            for vertex in vertices {
                vertex.attribute = S::Vertex::default();
            }
            return true;
        }
        match &self.light {
            Some(light) if !mesh.normals.is_empty() && mesh.colours.is_empty() => {
                let (light, tint, scale) = (*light, self.tint, self.scale);
                for (i, (vertex, &normal)) in vertices.iter_mut().zip(mesh.normals).enumerate() {
                    let place = || mesh.positions[i];
                    vertex.attribute = S::vertex(light.lit(&tint, scale, normal, place));
                }
            }
            _ => {
                let colours = Colours {
                    light: self.light,
                    tint: self.tint,
                    scale: self.scale,
                };
                for (i, vertex) in vertices.iter_mut().enumerate() {
                    vertex.attribute = S::vertex(colours.vertex(mesh, i));
                }
            }
        }
        true
    }

    /// Takes triangles from the face `from` on up to the first that has a corner beyond a plane,
    /// or no room: the index of that face, or how many there are.
    ///
    /// About 40 instructions for one that faces away on a Cortex-M4, as half of a closed mesh do.
    #[inline(always)]
    fn on_screen_faces<C: Coordinate>(
        &mut self,
        mesh: &Mesh<'_, C>,
        (faces, from): (&[[u16; 3]], usize),
        base: usize,
        file: &mut impl FnMut(Object<S::Face>, i32, &[SceneVertex<S::Vertex>]) -> Option<u32>,
    ) -> usize {
        let all = self.vertices.as_slice();
        let vertices = all.get(base..).unwrap_or_default();
        let (mut kept, mut seen) = (0, 0);
        let mut face = from;
        loop {
            let rest = faces.get(face..).unwrap_or_default();
            face += match self.cull {
                Cull::Back => leading(vertices, rest, |p| !is_seen(p, Cull::Back)),
                Cull::None => leading(vertices, rest, |p| !is_seen(p, Cull::None)),
            };
            let Some(&corners) = faces.get(face) else {
                break;
            };
            let at = |i: usize| vertices.get(usize::from(corners[i]));
            let (Some(a), Some(b), Some(c)) = (at(0), at(1), at(2)) else {
                // The indices were checked; said so for the compiler.
                break;
            };
            // Depths on the screen are below 2^31.
            if (a.depth | b.depth | c.depth) >> 31 != 0 {
                break;
            }
            let place = [(a.x, a.y), (b.x, b.y), (c.x, c.y)];
            if let Some(first) = first_of(place, (&self.columns, &self.lines)) {
                let index = corners.map(|c| base as u16 + c);
                let object = Object::new(index, self.face_colour(mesh, corners, corners[0]));
                let Some(objects) = file(object, first, all) else {
                    break;
                };
                kept += objects;
                seen += u32::from(objects > 0);
            }
            face += 1;
        }
        self.done.kept += kept;
        self.done.culled += (face - from) as u32 - seen;
        face
    }

    /// A triangle that may be seen.
    #[inline(never)]
    fn triangle<C: Coordinate>(
        &mut self,
        mesh: &Mesh<'_, C>,
        (face, corners, provoking): (u32, [u16; 3], u16),
        (base, shared): (usize, bool),
        file: &mut impl FnMut(Object<S::Face>, i32, &[SceneVertex<S::Vertex>]) -> Option<u32>,
    ) {
        let look = if shared {
            self.look(base, corners)
        } else {
            Look::Outside
        };
        match look {
            Look::Culled => self.done.culled += 1,
            Look::Seen(first) => {
                let index = corners.map(|c| base as u16 + c);
                let face_colour = self.face_colour(mesh, corners, provoking);
                let kept = self.done.kept;
                self.keep(Object::new(index, face_colour), first, face, file);
                self.settle(kept);
            }
            Look::Outside => {
                let kept = self.done.kept;
                let before = self.vertices.len();
                self.alone(mesh, (face, corners, provoking), file);
                if self.done.kept == kept {
                    self.vertices.truncate(before);
                }
                self.settle(kept);
            }
        }
    }

    /// Counts the current triangle among the dropped, if a piece of it was.
    #[inline]
    pub(super) fn count_lost(&mut self) -> bool {
        let lost = core::mem::take(&mut self.lost);
        if let Some(dropped) = self.done.dropped.as_mut().filter(|_| lost) {
            dropped.triangles += 1;
        }
        lost
    }

    /// Counts the current triangle once, whatever pieces it was cut into: among the dropped if one
    /// of them was, or among the culled if there are still as many objects as were `kept` before.
    #[inline(always)]
    pub(super) fn settle(&mut self, kept: u32) {
        if !self.count_lost() && self.done.kept == kept {
            self.done.culled += 1;
        }
    }

    /// What is known of a triangle whose vertices lie in the arena from `base` on.
    #[inline]
    fn look(&self, base: usize, corners: [u16; 3]) -> Look {
        let vertices = self.vertices.as_slice();
        let at = |i: usize| vertices.get(base + usize::from(corners[i]));
        // The indices were checked; said so for the compiler.
        let (Some(a), Some(b), Some(c)) = (at(0), at(1), at(2)) else {
            return Look::Culled;
        };
        // Depths on the screen are below 2^31.
        if (a.depth | b.depth | c.depth) >> 31 != 0 {
            let all = a.outcode() & b.outcode() & c.outcode();
            return if all == 0 {
                Look::Outside
            } else {
                Look::Culled
            };
        }
        match self.first_line([(a.x, a.y), (b.x, b.y), (c.x, c.y)]) {
            Some(first) => Look::Seen(first),
            None => Look::Culled,
        }
    }

    /// A triangle that brings its own vertices, clipped where needed.
    #[cold]
    #[inline(never)]
    fn alone<C: Coordinate>(
        &mut self,
        mesh: &Mesh<'_, C>,
        (face, corners, provoking): (u32, [u16; 3], u16),
        file: &mut impl FnMut(Object<S::Face>, i32, &[SceneVertex<S::Vertex>]) -> Option<u32>,
    ) {
        let corner = corners.map(|i| {
            let i = usize::from(i);
            let mut attribute = if S::PER_FACE {
                S::Vertex::default()
            } else {
                S::vertex(self.vertex_colour(mesh, i))
            };
            S::dress(&mut attribute, &self.skin, i);
            if let Some(&normal) = mesh.normals.get(i).filter(|_| S::NORMALS) {
                S::set_normal(&mut attribute, &self.turn, normal);
            }
            Corner {
                point: self.projection.transform(mesh.positions[i]),
                attribute,
            }
        });
        let codes = corner.map(|c| self.projection.outcode(c.point));
        if codes[0] & codes[1] & codes[2] != 0 {
            return;
        }
        let face_colour = self.face_colour(mesh, corners, provoking);
        if codes == [0; 3] {
            self.piece(corner, face_colour, face, file);
            return;
        }
        self.done.clipped += 1;
        let cut = near_far::<S>(corner, &self.projection);
        for i in 2..cut.len() {
            let part = guard::<S>([cut[0], cut[i - 1], cut[i]], &self.projection);
            for k in 2..part.len() {
                self.piece([part[0], part[k - 1], part[k]], face_colour, face, file);
            }
        }
    }

    /// A triangle within all planes.
    pub(super) fn piece(
        &mut self,
        corner: [Corner<S::Vertex>; 3],
        face_colour: S::Face,
        face: u32,
        file: &mut impl FnMut(Object<S::Face>, i32, &[SceneVertex<S::Vertex>]) -> Option<u32>,
    ) {
        let place = corner.map(|c| self.projection.project(c.point));
        let Some(first) = self.first_line(place.map(|p| (p.x, p.y))) else {
            return;
        };
        let before = self.vertices.len();
        let mut index = [0; 3];
        for i in 0..3 {
            let vertex = SceneVertex {
                x: place[i].x,
                y: place[i].y,
                depth: place[i].depth,
                attribute: corner[i].attribute,
            };
            match self.vertices.push(vertex) {
                Some(at) => index[i] = at,
                None => {
                    self.vertices.truncate(before);
                    self.dropped(Room::Vertices, face);
                    return;
                }
            }
        }
        self.keep(Object::new(index, face_colour), first, face, file);
    }

    #[inline]
    fn keep(
        &mut self,
        object: Object<S::Face>,
        first: i32,
        face: u32,
        file: &mut impl FnMut(Object<S::Face>, i32, &[SceneVertex<S::Vertex>]) -> Option<u32>,
    ) {
        match file(object, first, self.vertices.as_slice()) {
            Some(objects) => self.done.kept += objects,
            None => self.dropped(Room::Objects, face),
        }
    }

    #[cold]
    fn dropped(&mut self, room: Room, face: u32) {
        self.lost = true;
        self.done.dropped.get_or_insert(Dropped {
            room,
            first_face: face,
            triangles: 0,
        });
    }

    /// [`first_line`] of a triangle of this mesh.
    #[inline]
    fn first_line(&self, p: [(u16, u16); 3]) -> Option<i32> {
        first_line(p, self.cull, (&self.columns, &self.lines))
    }

    /// The lit colour of a vertex.
    fn vertex_colour<C: Coordinate>(&self, mesh: &Mesh<'_, C>, i: usize) -> Colour {
        let colours = Colours {
            light: self.light,
            tint: self.tint,
            scale: self.scale,
        };
        colours.vertex(mesh, i)
    }

    /// The lit colour of a face, by its own normal.
    #[inline]
    fn face_colour<C: Coordinate>(
        &self,
        mesh: &Mesh<'_, C>,
        corners: [u16; 3],
        provoking: u16,
    ) -> S::Face {
        let mut face = self.face_lit(mesh, corners, provoking);
        S::dress_face(&mut face, &self.skin);
        face
    }

    #[inline]
    fn face_lit<C: Coordinate>(
        &self,
        mesh: &Mesh<'_, C>,
        corners: [u16; 3],
        provoking: u16,
    ) -> S::Face {
        if !S::PER_FACE {
            return S::Face::default();
        }
        let tint = match mesh.colours.get(usize::from(provoking)) {
            Some(&colour) => Tint::new(colour, self.scale),
            None => self.tint,
        };
        S::face(match &self.light {
            Some(light) => {
                let p = corners.map(|i| mesh.positions[usize::from(i)].map(C::to_q30));
                let place = || mesh.positions[usize::from(provoking)];
                light.lit(&tint, self.scale, face_normal(p), place)
            }
            None => tint.lit(1 << 15),
        })
    }
}

/// The first line on which a triangle can be seen; `None` when it faces away, or covers no
/// pixel centre's line or column of the picture.
#[inline]
fn first_line(p: [(u16, u16); 3], cull: Cull, picture: (&Range<i32>, &Range<i32>)) -> Option<i32> {
    is_seen(p, cull).then(|| first_of(p, picture)).flatten()
}

/// Whether a triangle has an area, and does not face away where that is to be dropped.
#[inline(always)]
fn is_seen(p: [(u16, u16); 3], cull: Cull) -> bool {
    // y points down, so a counter-clockwise face has a negative area.
    let area = turn(p);
    match cull {
        Cull::Back => area < 0,
        Cull::None => area != 0,
    }
}

/// [`first_line`] of a triangle that does not face away.
#[inline(always)]
fn first_of(p: [(u16, u16); 3], (columns, lines): (&Range<i32>, &Range<i32>)) -> Option<i32> {
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
fn leading<A>(
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

/// What lights the vertices of a mesh.
struct Colours<'a, L> {
    /// The light in model space.
    light: Option<L>,
    /// Colour of vertices without one.
    tint: Tint,
    scale: &'a Scale,
}

impl<L: ModelLight> Colours<'_, L> {
    /// The lit colour of a vertex.
    #[inline]
    fn vertex<C: Coordinate>(&self, mesh: &Mesh<'_, C>, i: usize) -> Colour {
        let tint = match mesh.colours.get(i) {
            Some(&colour) => Tint::new(colour, self.scale),
            None => self.tint,
        };
        match (&self.light, mesh.normals.get(i)) {
            (Some(light), Some(&normal)) => {
                light.lit(&tint, self.scale, normal, || mesh.positions[i])
            }
            _ => tint.lit(1 << 15),
        }
    }
}

/// The unit normal of a face in Q1.14, from corners in Q1.30; counter-clockwise is outside.
fn face_normal(p: [[i32; 3]; 3]) -> [i16; 3] {
    let d = |a: usize, i: usize| i64::from(p[a][i]) - i64::from(p[0][i]);
    // Shifted together until they have 30 bits, so that the products fit, and small faces keep
    // all of theirs.
    let mut bits = 1;
    for i in 0..3 {
        bits |= d(1, i).unsigned_abs() | d(2, i).unsigned_abs();
    }
    let down = 34u32.saturating_sub(bits.leading_zeros());
    let e = |a: usize, i: usize| d(a, i) >> down;
    let axis = |i: usize, k: usize| e(1, i) * e(2, k) - e(1, k) * e(2, i);
    let n = [axis(1, 2), axis(2, 0), axis(0, 1)];
    let bits = n.iter().fold(1, |b, c| b | c.unsigned_abs());
    let down = 32u32.saturating_sub(bits.leading_zeros());
    unit(n.map(|c| c >> down)).map(|c| c.to_bits())
}

/// What a look at a triangle tells.
enum Look {
    /// It cannot be seen.
    Culled,
    /// It is first seen on this line of guard space.
    Seen(i32),
    /// A corner is beyond a plane, or its vertices are not in the arena.
    Outside,
}

/// How many triangles there are.
pub(crate) fn triangles(faces: Faces<'_>) -> u32 {
    (match faces {
        Faces::Triangles(faces) => faces.len(),
        Faces::Quads(faces, _) => 2 * faces.len(),
        Faces::QuadStrip(strip, _) => strip.len().saturating_sub(2),
    }) as u32
}

/// Whether all slices agree and all indices exist, which those do that are known to be below a
/// number of vertices that are there.
fn check<C>(mesh: &Mesh<'_, C>, below: usize) -> Result<(), MeshError> {
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
    let last = count.min(1 << 16) as i32 - 1;
    // The sign of the least distance from the last.
    indices
        .iter()
        .fold(0, |all, &i| all | (last - i32::from(i)))
        >= 0
}

/// Calls `f` with face, corners and provoking vertex of each triangle.
#[inline]
pub(super) fn each_triangle(faces: Faces<'_>, mut f: impl FnMut(u32, [u16; 3], u16)) {
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
