//! Meshes into objects: vertices transformed and lit once, faces culled, clipped and handed on
//! with the first line they are on (K1, K2).

use super::camera::{Camera, Screen};
use super::clip::{Corner, guard, near_far};
use super::colour::{Colour, Scale, Tint};
use super::light::{LightingModel, ModelLight};
use super::mesh::{Coordinate, Faces, Mesh};
use super::object::{OUTSIDE, Object, SceneVertex};
use super::project::Projection;
use super::shading::Shading;
use super::transform::{Affine, unit};
use crate::arena::Arena;
use core::ops::Range;

mod faces;
mod screen;

pub(crate) use faces::{check, check_known as check_mesh, each_triangle, triangles};
use faces::{check_known, first_line, first_of, is_seen, leading};
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
    /// Of the triangles kept, those that are drawn without their texture, as they stretch over too
    /// many of its texels.
    pub untextured: u32,
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
    /// Triangles have to be asked whether they can have their texture.
    wide: bool,
    /// A piece of the current triangle cannot.
    plain: bool,
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
            wide: S::may_be_plain(&skin),
            plain: false,
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
        check_known(mesh, below)?;
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
            Faces::Triangles(faces) if shared && !self.wide => {
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
        self.done.untextured += u32::from(core::mem::take(&mut self.plain));
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
            let codes = [a.outcode(), b.outcode(), c.outcode()];
            return if self.projection.hides(codes) {
                Look::Culled
            } else {
                Look::Outside
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
        if self.projection.hides(codes) {
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
            Some(objects) => {
                self.done.kept += objects;
                if self.wide && objects > 0 {
                    let corners = object.corners(self.vertices.as_slice());
                    let corners = corners.map(|c| c.map(|vertex| &vertex.attribute));
                    self.plain |= corners.is_some_and(|c| S::is_plain(&self.skin, c));
                }
            }
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
pub(crate) fn face_normal(p: [[i32; 3]; 3]) -> [i16; 3] {
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
