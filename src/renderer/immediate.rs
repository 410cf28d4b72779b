//! Drawing from plain slices, for those who want neither a list nor a [`Mesh`].
//!
//! Thin over [`Scene::draw`]: the same vertices give the same pixels in every way. What has no
//! indices is drawn in pieces of 64 faces, because a mesh needs some.

use super::error::DrawError;
use super::instance::Instance;
use super::scene::Scene;
use crate::geometry::{Assembled, Coordinate, Dropped, Faces, Mesh, QuadSplit};
use crate::pipeline::Pipeline;

/// Vertices as parallel slices: what a [`Mesh`] is, without its faces.
#[derive(Clone, Copy, Debug)]
pub struct Vertices<'a, C = i16> {
    /// Places in model space.
    pub positions: &'a [[C; 3]],
    /// Unit normals in Q1.14; empty: not lit.
    pub normals: &'a [[i16; 3]],
    /// Colours, 0 to 255 a channel, red first; empty: the instance's.
    pub colours: &'a [[u8; 3]],
}

impl<'a, C> Vertices<'a, C> {
    fn mesh(self, faces: Faces<'a>) -> Mesh<'a, C> {
        Mesh {
            positions: self.positions,
            normals: self.normals,
            colours: self.colours,
            faces,
        }
    }

    /// The vertices of some faces; an attribute that is not there stays so, one that is too short
    /// stays too short.
    fn part(self, from: usize, to: usize) -> Self {
        fn cut<T>(slice: &[T], from: usize, to: usize) -> &[T] {
            let len = slice.len();
            slice.get(from.min(len)..to.min(len)).unwrap_or(&[])
        }
        Self {
            positions: cut(self.positions, from, to),
            normals: cut(self.normals, from, to),
            colours: cut(self.colours, from, to),
        }
    }

    /// Whether each attribute is as long as the positions, or empty.
    fn agree(self) -> bool {
        let fits = |len| len == 0 || len == self.positions.len();
        fits(self.normals.len()) && fits(self.colours.len())
    }
}

/// Faces a piece.
const PIECE: usize = 64;

/// Indices of faces that share no vertex.
const fn separate<const N: usize>() -> [[u16; N]; PIECE] {
    let mut faces = [[0; N]; PIECE];
    let mut i = 0;
    while i < PIECE * N {
        faces[i / N][i % N] = i as u16;
        i += 1;
    }
    faces
}

static TRIANGLES: [[u16; 3]; PIECE] = separate();
static QUADS: [[u16; 4]; PIECE] = separate();

impl<P: Pipeline> Scene<'_, P> {
    /// Draws triangles of three vertices each, counter-clockwise seen from outside; one or two
    /// vertices left over are not drawn.
    ///
    /// # Errors
    /// As [`draw`](Scene::draw); [`DrawError::Full`] sums up the whole call.
    pub fn draw_triangles<C: Coordinate>(
        &mut self,
        vertices: Vertices<'_, C>,
        instance: &Instance,
    ) -> Result<Assembled, DrawError> {
        self.pieces(vertices, 3, instance, |n| {
            Faces::Triangles(TRIANGLES.get(..n).unwrap_or(&TRIANGLES))
        })
    }

    /// Draws quads of four vertices each, in order around the face, all split alike (K2); up to
    /// three vertices left over are not drawn.
    ///
    /// # Errors
    /// As [`draw_triangles`](Scene::draw_triangles).
    pub fn draw_quads<C: Coordinate>(
        &mut self,
        vertices: Vertices<'_, C>,
        split: QuadSplit,
        instance: &Instance,
    ) -> Result<Assembled, DrawError> {
        self.pieces(vertices, 4, instance, |n| {
            Faces::Quads(QUADS.get(..n).unwrap_or(&QUADS), split)
        })
    }

    /// Draws triangles by indices into the vertices.
    ///
    /// # Errors
    /// As [`draw`](Scene::draw).
    pub fn draw_indexed<C: Coordinate>(
        &mut self,
        vertices: Vertices<'_, C>,
        triangles: &[[u16; 3]],
        instance: &Instance,
    ) -> Result<Assembled, DrawError> {
        self.draw(&vertices.mesh(Faces::Triangles(triangles)), instance)
    }

    fn pieces<'f, C: Coordinate>(
        &mut self,
        vertices: Vertices<'f, C>,
        corners: usize,
        instance: &Instance,
        faces: impl Fn(usize) -> Faces<'f>,
    ) -> Result<Assembled, DrawError> {
        if !vertices.agree() {
            // The mesh says so in its own words.
            return self.draw(&vertices.mesh(Faces::Triangles(&[])), instance);
        }
        let mut sum = Assembled::default();
        let all = vertices.positions.len() / corners;
        for first in (0..all).step_by(PIECE) {
            let n = (all - first).min(PIECE);
            let part = vertices.part(first * corners, (first + n) * corners);
            let before = self.pass_one();
            match self.draw(&part.mesh(faces(n)), instance) {
                Ok(_) => {}
                Err(DrawError::Full(dropped)) => {
                    let of_all = sum.dropped.get_or_insert(Dropped {
                        first_face: dropped.first_face + first as u32,
                        triangles: 0,
                        ..dropped
                    });
                    of_all.triangles += dropped.triangles;
                }
                Err(error) => return Err(error),
            }
            let after = self.pass_one();
            sum.triangles += after.triangles - before.triangles;
            sum.culled += after.culled - before.culled;
            sum.clipped += after.clipped - before.clipped;
            sum.kept += after.objects - before.objects;
        }
        match sum.dropped {
            Some(dropped) => Err(DrawError::Full(dropped)),
            None => Ok(sum),
        }
    }
}
