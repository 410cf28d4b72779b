//! Meshes into objects: vertices transformed and lit once, faces culled, clipped and handed on
//! with the first line they are on (K1, K2).

use super::camera::{Camera, Screen};
use super::clip::{Corner, guard, near_far};
use super::colour::{Scale, Tint};
use super::light::{LightingModel, ModelLight};
use super::mesh::{Coordinate, Faces, Mesh};
use super::object::{OUTSIDE, Object, SceneVertex};
use super::project::Projection;
use super::shading::Shading;
use super::transform::Affine;
use crate::arena::Arena;
use core::ops::Range;

mod colours;
mod faces;
mod outcome;
mod screen;

use colours::Colours;
pub(crate) use colours::face_normal;

pub use faces::Cull;
use faces::{Picture, check_known, first_line, first_of, is_seen, leading};
pub(crate) use faces::{check, check_known as check_mesh, each_triangle, triangles};
pub use outcome::{Assembled, Dropped, MeshError, Room};
pub use screen::ScreenVertex;
pub(crate) use screen::{ScreenMesh, on_screen};

/// One mesh on its way to the screen.
pub(crate) struct Assembler<'a, 'm, 'k, S: Shading, L> {
    /// Where vertices go.
    vertices: &'a mut Arena<'m, SceneVertex<S::Vertex>>,
    pub(super) projection: Projection,
    /// What of guard space is the picture.
    picture: Picture,
    cull: Cull,
    /// The light in model space.
    light: Option<L>,
    /// Colour of vertices without one.
    tint: Tint,
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

/// What a mesh is lit by, and which of its faces are dropped.
pub(crate) struct Looks<M> {
    pub(crate) cull: Cull,
    pub(crate) light: Option<M>,
    /// Colour of vertices that have none of their own.
    pub(crate) colour: [u8; 3],
}

/// What a mesh brings beside its colours, and how levels become steps of the output.
pub(crate) struct Surfaced<'a, 'k, S: Shading> {
    pub(crate) scale: &'a Scale,
    pub(crate) skin: S::Skin<'k>,
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
        looks: Looks<M>,
        surface: Surfaced<'a, 'k, S>,
    ) -> Self {
        let Surfaced { scale, skin } = surface;
        let light = looks.light.map(|l| l.in_model(model, &camera.view));
        Self {
            vertices: &mut store.vertices,
            projection: Projection::new(camera, screen, model),
            picture: Picture::new(screen, lines),
            cull: looks.cull,
            light,
            tint: Tint::new(looks.colour, scale),
            lost: false,
            wide: S::may_be_plain(&skin),
            plain: false,
            scale,
            skin,
            done: Assembled::default(),
        }
    }

    /// Takes a mesh; `file` keeps an object that is first seen on a line of guard space, or says that it has no room for
    /// it. Indices that are known to be below a number are not looked at where there are as many vertices.
    ///
    /// # Errors
    /// When the mesh contradicts itself; then nothing of it has been kept.
    pub(crate) fn mesh<C: Coordinate>(
        mut self,
        (mesh, below): (&Mesh<'_, C>, usize),
        mut file: impl FnMut(Object<S::Face>, i32) -> Option<()>,
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
        self.done.triangles = triangles(mesh.faces);
        match mesh.faces {
            Faces::Triangles(faces) if shared && !self.wide => {
                let mut face = 0;
                while face < faces.len() {
                    face = self.on_screen_faces(mesh, faces, face, base, &mut file);
                    if let Some(&corners) = faces.get(face) {
                        let face = Face {
                            number: face as u32,
                            corners,
                            provoking: corners[0],
                        };
                        self.triangle(mesh, face, Some(base), &mut file);
                    }
                    face += 1;
                }
            }
            _ => each_triangle(mesh.faces, |number, corners, provoking| {
                let face = Face {
                    number,
                    corners,
                    provoking,
                };
                self.triangle(mesh, face, shared.then_some(base), &mut file);
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
        faces: &[[u16; 3]],
        from: usize,
        base: usize,
        file: &mut impl FnMut(Object<S::Face>, i32) -> Option<()>,
    ) -> usize {
        let vertices = self.vertices.as_slice().get(base..).unwrap_or_default();
        let mut kept = 0;
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
            if let Some(first) = first_of(place, &self.picture) {
                let index = corners.map(|c| base as u16 + c);
                let object = Object::new(index, self.face_colour(mesh, corners, corners[0]));
                if file(object, first).is_none() {
                    break;
                }
                kept += 1;
            }
            face += 1;
        }
        self.done.kept += kept;
        self.done.culled += (face - from) as u32 - kept;
        face
    }

    /// A triangle that may be seen; where its vertices are shared they lie from `base` on.
    #[inline(never)]
    fn triangle<C: Coordinate>(
        &mut self,
        mesh: &Mesh<'_, C>,
        face: Face,
        base: Option<usize>,
        file: &mut impl FnMut(Object<S::Face>, i32) -> Option<()>,
    ) {
        let look = base.map_or(Look::Outside, |base| self.look(base, face.corners));
        match look {
            Look::Culled => self.done.culled += 1,
            Look::Seen(first) => {
                let index = face.corners.map(|c| base.unwrap_or_default() as u16 + c);
                let face_colour = self.face_colour(mesh, face.corners, face.provoking);
                let kept = self.done.kept;
                self.keep(Object::new(index, face_colour), first, face.number, file);
                self.settle(kept);
            }
            Look::Outside => {
                let kept = self.done.kept;
                let before = self.vertices.len();
                self.alone(mesh, face, file);
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
        face: Face,
        file: &mut impl FnMut(Object<S::Face>, i32) -> Option<()>,
    ) {
        let corner = face.corners.map(|i| {
            let i = usize::from(i);
            let mut attribute = if S::PER_FACE {
                S::Vertex::default()
            } else {
                S::vertex(self.vertex_colour(mesh, i))
            };
            S::dress(&mut attribute, &self.skin, i);
            Corner {
                point: self.projection.transform(mesh.positions[i]),
                attribute,
            }
        });
        let codes = corner.map(|c| self.projection.outcode(c.point));
        if self.projection.hides(codes) {
            return;
        }
        let face_colour = self.face_colour(mesh, face.corners, face.provoking);
        if codes == [0; 3] {
            self.piece(corner, face_colour, face.number, file);
            return;
        }
        self.done.clipped += 1;
        let cut = near_far::<S>(corner, &self.projection);
        for i in 2..cut.len() {
            let part = guard::<S>([cut[0], cut[i - 1], cut[i]], &self.projection);
            for k in 2..part.len() {
                self.piece(
                    [part[0], part[k - 1], part[k]],
                    face_colour,
                    face.number,
                    file,
                );
            }
        }
    }

    /// A triangle within all planes.
    pub(super) fn piece(
        &mut self,
        corner: [Corner<S::Vertex>; 3],
        face_colour: S::Face,
        face: u32,
        file: &mut impl FnMut(Object<S::Face>, i32) -> Option<()>,
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
        file: &mut impl FnMut(Object<S::Face>, i32) -> Option<()>,
    ) {
        match file(object, first) {
            Some(()) => {
                self.done.kept += 1;
                if self.wide {
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
        first_line(p, self.cull, &self.picture)
    }
}

/// A triangle of a mesh.
#[derive(Clone, Copy)]
struct Face {
    /// Index of its face.
    number: u32,
    corners: [u16; 3],
    /// The vertex that says what colour it has.
    provoking: u16,
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
