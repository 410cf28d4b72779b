//! The cut of a shadow volume by the near plane, as objects (K9).

use super::super::clip::{Corner, guard, near_ends};
use super::super::light::ModelLight;
use super::super::mesh::{Coordinate, Mesh};
use super::super::object::{Object, SceneVertex};
use super::super::project::ClipPoint;
use super::super::shading::Shading;
use super::super::shadow::{Extrusion, Sides};
use super::{Assembled, Assembler};

impl<S: Shading, L: ModelLight> Assembler<'_, '_, '_, S, L> {
    /// Whether the shadow volume of a mesh may reach in front of the near plane.
    pub(crate) fn is_near<C: Coordinate>(&self, extrusion: &Extrusion, mesh: &Mesh<'_, C>) -> bool {
        mesh.positions.iter().any(|&position| {
            let ends = extrusion.ends(position);
            ends.iter()
                .any(|&p| self.projection.transform(p).z < self.projection.near)
        })
    }

    /// Closes a shadow volume at the near plane: `file` keeps the pieces.
    pub(crate) fn near_cap<C: Coordinate>(
        mut self,
        extrusion: &Extrusion,
        mesh: &Mesh<'_, C>,
        sides: &Sides<'_>,
        mut file: impl FnMut(Object<S::Face>, i32, &[SceneVertex<S::Vertex>]) -> Option<u32>,
    ) -> Assembled {
        let mut hub = None;
        extrusion.each_lit(mesh, |_, corners| {
            let [a, b, c] = corners.map(|corner| extrusion.ends(corner));
            self.near_cut(&mut hub, [a[0], b[0], c[0]], &mut file);
            self.near_cut(&mut hub, [c[1], b[1], a[1]], &mut file);
        });
        for face in sides.faces {
            let at = |i: usize| sides.positions.get(usize::from(face[i])).copied();
            if let (Some(a), Some(b), Some(c)) = (at(0), at(1), at(2)) {
                self.near_cut(&mut hub, [a, b, c], &mut file);
            }
        }
        self.done
    }

    /// Where the near plane cuts a triangle of the volume: the triangle from there to the hub.
    fn near_cut(
        &mut self,
        hub: &mut Option<ClipPoint>,
        corners: [[i32; 3]; 3],
        file: &mut impl FnMut(Object<S::Face>, i32, &[SceneVertex<S::Vertex>]) -> Option<u32>,
    ) {
        let corner = |point| Corner {
            point,
            attribute: S::Vertex::default(),
        };
        let points = corners.map(|p| corner(self.projection.transform(p)));
        // The border of the cut goes against the way of the triangle.
        let Some([to, from]) = near_ends::<S>(points, &self.projection) else {
            return;
        };
        self.done.triangles += 1;
        let hub = *hub.get_or_insert(from);
        let mut face = S::Face::default();
        S::dress_face(&mut face, &self.skin);
        let part = guard::<S>([hub, from, to].map(corner), &self.projection);
        for k in 2..part.len() {
            self.piece([part[0], part[k - 1], part[k]], face, 0, file);
        }
        self.count_lost();
    }
}
