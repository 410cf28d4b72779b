//! Shadow volumes: the silhouette of a mesh seen from an infinite light, drawn out away from it
//! (K9).
//!
//! The faces that look at the light cast the shadow, and the border of them all is the
//! silhouette: an edge is on it when exactly one of its two faces looks at the light. Each edge is
//! drawn out into a quad, and so the volume is closed whatever the mesh is, for a border is always
//! made of closed loops. Faces are decided by integers, each once.
//!
//! The light's own faces and their far copies are part of the volume too, but never in front of
//! what is seen where their mesh is drawn, and so not counted. They are needed where the near
//! plane cuts the volume: the cut is its border in the plane, from which triangles to one point
//! of it, each with its own sign, give the same count as the cut itself. So the eye may be inside a
//! shadow.

use super::faces::{each_triangle, wide_normal};
use super::mesh::{Coordinate, Mesh, place_of};
use super::transform::Affine;
use crate::num::I2F14;

/// Which light casts a shadow, and how far it is drawn out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShadowLight {
    /// The light's number, below [`Shadow::LIGHTS`](crate::scene::Shadow::LIGHTS).
    pub light: u8,
    /// Unit vector towards the light, world space.
    pub direction: [I2F14; 3],
    /// A shadow is 2^reach units of model space long, 1 to 12: past all that is seen.
    pub reach: u8,
}

/// A side of a face that looks at the light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct ShadowEdge {
    /// The corners, by vertex of the mesh; the lower first.
    ends: [u16; 2],
    /// Whether the face goes from the lower to the higher.
    rises: bool,
}

impl ShadowEdge {
    /// From where to where the face goes.
    pub(crate) const fn directed(self) -> [u16; 2] {
        let [low, high] = self.ends;
        if self.rises { [low, high] } else { [high, low] }
    }
}

/// Memory for one shadow volume, used while it is drawn.
#[derive(Debug)]
pub struct ShadowMemory<'m> {
    /// Three for each triangle that looks at the light.
    pub edges: &'m mut [ShadowEdge],
    /// Two for each edge of the silhouette.
    pub positions: &'m mut [[i32; 3]],
    /// Two for each edge of the silhouette.
    pub faces: &'m mut [[u16; 3]],
}

/// Which part of [`ShadowMemory`] is too short.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum ShadowRoom {
    /// The edges.
    Edges,
    /// The positions, or there are more than 65,536.
    Positions,
    /// The faces.
    Faces,
}

impl core::fmt::Display for ShadowRoom {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::Edges => "edges",
            Self::Positions => "positions",
            Self::Faces => "faces",
        })
    }
}

/// How a mesh is drawn out: model space to that of the volume.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extrusion {
    /// Towards the light, model space, Q1.14.
    direction: [i64; 3],
    reach: u32,
}

impl Extrusion {
    /// Of a mesh that stands at `model`.
    pub(crate) fn new(light: &ShadowLight, model: &Affine) -> Self {
        let direction = model.direction_to_model(light.direction);
        Self {
            direction: direction.map(|c| i64::from(c.to_bits())),
            reach: u32::from(light.reach.clamp(1, 12)),
        }
    }

    /// Space of the volume to world space.
    pub(crate) fn model(&self, model: &Affine) -> Affine {
        let mut model = *model;
        model.linear.exponent += self.reach as i32;
        model
    }

    /// A position of the mesh, and the one it casts its shadow to.
    pub(crate) fn ends<C: Coordinate>(&self, position: [C; 3]) -> [[i32; 3]; 2] {
        let near = position.map(|c| c.to_q30() >> self.reach);
        // Below 1 and 1: no sum leaves 2.
        let far = [0, 1, 2].map(|i| near[i] - (self.direction[i] << 16) as i32);
        [near, far]
    }

    /// Whether a face looks at the light.
    #[inline(never)]
    fn is_lit(&self, corners: [[i32; 3]; 3]) -> bool {
        // With the direction, no sum reaches 2^60. Exact for coordinates of 16 bits.
        let normal = wide_normal(corners, 20);
        let dot = |i: usize| normal[i] * self.direction[i];
        dot(0) + dot(1) + dot(2) > 0
    }

    /// Calls `f` with the corners of each face that looks at the light; the indices of the mesh
    /// were checked.
    pub(crate) fn each_lit<C: Coordinate>(
        &self,
        mesh: &Mesh<'_, C>,
        mut f: impl FnMut([u16; 3], [[i32; 3]; 3]),
    ) {
        each_triangle(mesh.faces, |_, corners, _| {
            let places = corners.map(|i| place_of(mesh.positions, i.into()));
            if self.is_lit(places) {
                f(corners, places);
            }
        });
    }

    /// Finds the silhouette of a mesh and draws it out.
    ///
    /// # Errors
    /// The first room that is too short.
    pub(crate) fn sides<'m, C: Coordinate>(
        &self,
        mesh: &Mesh<'_, C>,
        memory: &'m mut ShadowMemory<'_>,
    ) -> Result<ShadowMemory<'m>, ShadowRoom> {
        let edges = self.silhouette(mesh, memory.edges)?;
        let count = edges.len();
        let positions = memory.positions.get_mut(..2 * count);
        let positions = positions.filter(|p| p.len() <= 1 << 16);
        let positions = positions.ok_or(ShadowRoom::Positions)?;
        let faces = memory.faces.get_mut(..2 * count).ok_or(ShadowRoom::Faces)?;
        // A silhouette is made of loops: each vertex on it begins an edge.
        edges.sort_unstable_by_key(|edge| edge.directed());
        for (i, edge) in edges.iter().enumerate() {
            let [a, b] = edge.directed();
            let at = place_of(mesh.positions, a.into());
            let next = edges.partition_point(|other| other.directed()[0] < b);
            let (a, b) = (2 * i as u16, 2 * next as u16);
            positions[2 * i..2 * i + 2].copy_from_slice(&self.ends(at));
            faces[2 * i] = [b, a, a + 1];
            faces[2 * i + 1] = [b, a + 1, b + 1];
        }
        Ok(ShadowMemory {
            edges,
            positions,
            faces,
        })
    }

    /// The edges of the silhouette, at the front of `edges`.
    fn silhouette<'e, C: Coordinate>(
        &self,
        mesh: &Mesh<'_, C>,
        edges: &'e mut [ShadowEdge],
    ) -> Result<&'e mut [ShadowEdge], ShadowRoom> {
        let mut count = 0;
        let mut fits = true;
        self.each_lit(mesh, |[a, b, c], _| {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                match edges.get_mut(count) {
                    Some(edge) if from != to => {
                        *edge = ShadowEdge {
                            ends: [from.min(to), from.max(to)],
                            rises: from < to,
                        };
                        count += 1;
                    }
                    Some(_) => {}
                    None => fits = false,
                }
            }
        });
        let edges = edges.get_mut(..count).filter(|_| fits);
        let edges = edges.ok_or(ShadowRoom::Edges)?;
        edges.sort_unstable_by_key(|edge| edge.ends);
        // Of those between the same vertices, what one way has more than the other.
        let (mut kept, mut i) = (0, 0);
        while let Some(&edge) = edges.get(i) {
            let mut more = 0i32;
            while let Some(other) = edges.get(i).filter(|other| other.ends == edge.ends) {
                more += if other.rises { 1 } else { -1 };
                i += 1;
            }
            for _ in 0..more.unsigned_abs() {
                edges[kept] = ShadowEdge {
                    rises: more > 0,
                    ..edge
                };
                kept += 1;
            }
        }
        Ok(&mut edges[..kept])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Kills: other limits of how far a shadow reaches.
    #[test]
    fn shadows_reach_a_power_of_two_of_1_to_12() {
        for (said, reach) in [(0, 1), (1, 1), (2, 2), (12, 12), (13, 12), (255, 12)] {
            let light = ShadowLight {
                light: 0,
                direction: [I2F14::ZERO, I2F14::ONE, I2F14::ZERO],
                reach: said,
            };
            assert_eq!(Extrusion::new(&light, &Affine::IDENTITY).reach, reach);
        }
    }
}
