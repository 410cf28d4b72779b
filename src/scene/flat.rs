//! Faces of one colour each, lit by their own normals (K10).
//!
//! Each face that is kept gets copies of its vertices with its colour: no record of a triangle or of a vertex has
//! anything for it, and pass two does not know of it.

use super::pass::{Own, Pass};
use super::{DrawError, Scene, TexturePlace, Vertex};
use crate::geometry::{Coordinate, Mesh, each_triangle, face_normal, place_of};

impl<L> Scene<'_, '_, L> {
    /// Files all faces of a mesh, whose indices exist.
    #[inline(never)]
    pub(super) fn file_flat<C: Coordinate>(
        &mut self,
        mesh: &Mesh<'_, C>,
        pass: &mut Pass<'_>,
    ) -> Result<(), DrawError> {
        each_triangle(mesh.faces, |face, corners, provoking| {
            let places = self.places_of(corners, pass);
            match places.map(|places| pass.order(places).is_some()) {
                Some(false) => {
                    pass.culled += 1;
                    return;
                }
                None if self.leaves_out(corners, pass) => return,
                _ => {}
            }
            let normal = face_normal(corners.map(|i| place_of(mesh.positions, i.into())));
            let colour = pass.lit(mesh, provoking.into(), Some(normal));
            if places.is_none() {
                return self.file_one(mesh, face, corners, Some(colour), pass);
            }
            let own = corners.map(|i| self.copy_of(i, colour, pass));
            self.file_whole(face, &own, pass);
        });
        Ok(())
    }

    /// Where a face's vertices are on the screen; `None` where they are not there, or have to be clipped.
    #[inline(always)]
    fn places_of(&mut self, corners: [u16; 3], pass: &Pass<'_>) -> Option<[u32; 3]> {
        let vertices = self.shared(pass);
        let at = |i: u16| {
            let place = vertices.get(usize::from(i))?.place;
            (place != Vertex::OUTSIDE).then_some(place)
        };
        let [a, b, c] = corners;
        Some([at(a)?, at(b)?, at(c)?])
    }

    /// A copy of a vertex on the screen, of a colour; out of line, since a face has three.
    #[inline(never)]
    fn copy_of(&self, i: u16, colour: u32, pass: &Pass<'_>) -> Own {
        let at = pass.base + usize::from(i);
        let vertex = self.vertices.as_slice().get(at).copied();
        Own {
            vertex: Vertex {
                colour,
                ..vertex.unwrap_or(Vertex::EMPTY)
            },
            place: self.places.get(at).copied().unwrap_or(TexturePlace::EMPTY),
            alpha: pass.alpha(i.into()),
        }
    }
}
