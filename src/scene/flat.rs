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
            let colour = || colour_of(mesh, corners, provoking, pass, &scale);
            let Some(mut own) = self.copies(corners, pass) else {
                let colour = colour();
                return self.file_one(mesh, face, corners, Some(colour), pass);
            };
            let before = self.objects.len();
            if pass.order(own.map(|own| own.vertex.place)).is_some() {
                let colour = colour();
                for own in &mut own {
                    own.vertex.colour = colour;
                }
                if let Err(memory) = self.file_own(own, pass) {
                    return pass.lost.lose(memory, face);
                }
            }
            if self.objects.len() == before {
                pass.culled += 1;
            }
        });
    }

    /// Copies of a face's vertices; `None` where they are not there, or have to be clipped.
    fn copies(&self, corners: [u16; 3], pass: &Pass<'_>) -> Option<[Own; 3]> {
        let vertices = self.vertices.as_slice().get(pass.base..)?;
        let copy = |i: u16| {
            let vertex = vertices.get(usize::from(i)).filter(|_| pass.shared > 0)?;
            let place = self.places.get(pass.base + usize::from(i)).copied();
            (vertex.place != Vertex::OUTSIDE).then_some(Own {
                vertex: *vertex,
                place: place.unwrap_or(TexturePlace::EMPTY),
                alpha: pass.alpha(i.into()),
            })
        };
        let [a, b, c] = corners;
        Some([copy(a)?, copy(b)?, copy(c)?])
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
    let normal = face_normal(corners.map(|i| mesh.positions[usize::from(i)].map(C::to_q30)));
    pass.lit(mesh, usize::from(provoking), Some(normal), scale)
}
