//! Faces of one colour each, lit by their own normals (K10).
//!
//! Each face that is kept gets copies of its vertices with its colour: no record of a triangle or of a vertex has
//! anything for it, and pass two does not know of it.

use super::pass::{Own, Pass};
use super::{Scene, TexturePlace, Vertex};
use crate::geometry::{Coordinate, Mesh, Scale, each_triangle, face_normal};

impl<L> Scene<'_, '_, L> {
    /// Files all faces of a mesh, whose indices exist.
    #[inline(never)]
    pub(super) fn file_flat<C: Coordinate>(&mut self, mesh: &Mesh<'_, C>, pass: &mut Pass<'_>) {
        let scale = self.scale;
        each_triangle(mesh.faces, |face, corners, provoking| {
            let colour = |pass: &Pass<'_>| colour_of(mesh, corners, provoking, pass, &scale);
            let Some(places) = self.places_of(corners, pass) else {
                if self.leaves_out(corners, pass) {
                    return;
                }
                let colour = Some(colour(pass));
                return self.file_one(mesh, face, corners, colour, pass);
            };
            let before = self.objects.len();
            if pass.order(places).is_some() {
                let colour = colour(pass);
                let own = corners.map(|i| self.copy_of(i, colour, pass));
                if let Err(memory) = self.file_own(&own, pass) {
                    return pass.lost.lose(memory, face);
                }
            }
            if self.objects.len() == before {
                pass.culled += 1;
            }
        });
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

/// The colour of a face, lit if it is to be.
fn colour_of<C: Coordinate>(
    mesh: &Mesh<'_, C>,
    corners: [u16; 3],
    provoking: u16,
    pass: &Pass<'_>,
    scale: &Scale,
) -> u32 {
    let normal = face_normal(corners.map(|i| mesh.place(i.into())));
    pass.lit(mesh, usize::from(provoking), Some(normal), scale)
}
