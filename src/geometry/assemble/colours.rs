//! The lit colours of vertices, and the normals of faces.

use super::super::colour::{Colour, Scale, Tint};
use super::super::light::ModelLight;
use super::super::mesh::{Coordinate, Mesh};
use super::super::shading::Shading;
use super::super::transform::unit;
use super::Assembler;

impl<S: Shading, L: ModelLight> Assembler<'_, '_, '_, S, L> {
    /// The lit colour of a vertex.
    pub(super) fn vertex_colour<C: Coordinate>(&self, mesh: &Mesh<'_, C>, i: usize) -> Colour {
        let colours = Colours {
            light: self.light,
            tint: self.tint,
            scale: self.scale,
        };
        colours.vertex(mesh, i)
    }

    /// The lit colour of a face, by its own normal.
    #[inline]
    pub(super) fn face_colour<C: Coordinate>(
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
pub(super) struct Colours<'a, L> {
    /// The light in model space.
    pub(super) light: Option<L>,
    /// Colour of vertices without one.
    pub(super) tint: Tint,
    pub(super) scale: &'a Scale,
}

impl<L: ModelLight> Colours<'_, L> {
    /// The lit colour of a vertex.
    #[inline]
    pub(super) fn vertex<C: Coordinate>(&self, mesh: &Mesh<'_, C>, i: usize) -> Colour {
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
