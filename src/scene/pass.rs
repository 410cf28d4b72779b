//! What is known of a draw call while its faces are filed: how they are seen, and what falls on them (K1, K10).

use super::project::View;
use super::texgen::Generated;
use super::{Full, TexturePlace, Vertex};
use crate::geometry::{
    Affine, Colour, Coordinate, Cull, LampsInModel, Light, Mesh, Scale, Tint, place_of,
};
use crate::num::rolled;

/// A corner of a triangle that has vertices of its own.
#[derive(Clone, Copy)]
pub(super) struct Own {
    pub(super) vertex: Vertex,
    pub(super) place: TexturePlace,
    /// With 8 fraction bits.
    pub(super) alpha: u16,
}

impl Own {
    /// Nothing yet.
    pub(super) const EMPTY: Self = Self {
        vertex: Vertex::EMPTY,
        place: TexturePlace::EMPTY,
        alpha: 0,
    };
}

/// The word of a normal, turned from its model to the camera; and of what has none.
pub(crate) type WordOfNormal = fn(&Affine, Option<[i16; 3]>) -> u32;

/// What is known of a draw call while its faces are filed.
pub(super) struct Pass<'a> {
    pub(super) view: View,
    /// The light in model space.
    pub(super) light: Option<Light>,
    /// Several lights, likewise, in place of the one.
    pub(super) lamps: Option<&'a LampsInModel>,
    /// Normals in place of colours: the turn from the model to the camera, and what makes words of them.
    pub(super) normals: Option<(Affine, WordOfNormal)>,
    pub(super) scale: Scale,
    pub(super) tint: Tint,
    /// The word of all vertices, where they have the same.
    pub(super) one: Option<u32>,
    pub(super) cull: Cull,
    /// Texture places of the mesh's vertices; `None` without a texture.
    pub(super) texels: Option<&'a [[i32; 2]]>,
    /// Those that are made in place of them.
    pub(super) generated: Option<&'a Generated<'a>>,
    /// Alphas of the mesh's vertices; none where they are not looked at.
    pub(super) alphas: &'a [u8],
    /// The first of the mesh's vertices in memory.
    pub(super) base: usize,
    /// How many of them are there: all or none.
    pub(super) shared: usize,
    /// Whether they all lie within the planes.
    pub(super) within: bool,
    pub(super) culled: u32,
    pub(super) clipped: u32,
    /// Triangles that found no room, and which memory the first of them found full, by its face.
    pub(super) lost: u32,
    pub(super) first_lost: Option<(Full, u32)>,
}

/// The corners from the topmost on (of two the left one), clockwise; `None` where nothing is covered or the
/// face is seen from behind and `culls`.
#[inline(always)]
pub(super) fn top_first(
    culls: bool,
    corner: [u16; 3],
    [a, mut b, mut c]: [u32; 3],
) -> Option<([u16; 3], [u32; 3])> {
    let [i, mut j, mut k] = corner;
    let (d1, d2) = (b.wrapping_sub(a), c.wrapping_sub(a));
    let x = |d: u32| i32::from(d as i16);
    let y = |d: u32| d.wrapping_add(0x8000) as i32 >> 16;
    // Faces go counter-clockwise seen from outside, and clockwise in a picture whose lines go down.
    let (one, other) = (x(d1).wrapping_mul(y(d2)), x(d2).wrapping_mul(y(d1)));
    if one >= other {
        if culls || one == other {
            return None;
        }
    } else {
        (b, c, j, k) = (c, b, k, j);
    }
    if a < b {
        if a < c {
            Some(([i, j, k], [a, b, c]))
        } else {
            Some(([k, i, j], [c, a, b]))
        }
    } else if b < c {
        Some(([j, k, i], [b, c, a]))
    } else {
        Some(([k, i, j], [c, a, b]))
    }
}

/// Colours of those vertices that triangles have, by one light and one colour.
#[inline(never)]
pub(super) fn light_all(light: &Light, tint: &Tint, normals: &[[i16; 3]], vertices: &mut [Vertex]) {
    let (light, tint) = (*light, *tint);
    let dark = tint.lit(light.ambient.to_bits()).word();
    for (vertex, &normal) in vertices.iter_mut().zip(normals) {
        if vertex.is_used() {
            vertex.colour = light.lit_or(dark, &tint, normal);
        }
    }
}

/// The same, each of its own colour.
#[inline(never)]
pub(super) fn light_each(
    light: &Light,
    scale: &Scale,
    normals: &[[i16; 3]],
    colours: &[[u8; 3]],
    vertices: &mut [Vertex],
) {
    let (light, scale) = (*light, *scale);
    for ((vertex, &normal), &colour) in vertices.iter_mut().zip(normals).zip(colours) {
        if vertex.is_used() {
            vertex.colour = light.lit(&Tint::new(colour, &scale), normal).word();
        }
    }
}

/// One colour for all of them.
#[inline(never)]
pub(super) fn colour_all(colour: u32, vertices: &mut [Vertex]) {
    for vertex in vertices {
        rolled();
        vertex.colour = colour;
    }
}

impl Pass<'_> {
    /// Counts a face that lost a piece, or of which nothing was filed.
    pub(super) fn count_face(&mut self, face: u32, filed: Result<(), Full>, is_gone: bool) {
        match filed {
            Err(memory) => {
                self.lost += 1;
                self.first_lost.get_or_insert((memory, face));
            }
            Ok(()) => self.culled += u32::from(is_gone),
        }
    }

    /// The texture place of a vertex, texels with 14 fraction bits.
    pub(super) fn texel(&self, i: usize) -> [i32; 2] {
        let texel = match (self.generated, self.texels.unwrap_or_default().get(i)) {
            (Some(generated), _) => generated.texel(i),
            (None, texel) => texel.copied().unwrap_or_default(),
        };
        texel.map(|t| t << TexturePlace::FINER)
    }

    /// The alpha of a vertex, with 8 fraction bits.
    pub(super) fn alpha(&self, i: usize) -> u16 {
        u16::from(self.alphas.get(i).copied().unwrap_or(255)) << 8
    }

    /// Whether a triangle may stretch over more than 4,096 texels: none does where all places lie within as many.
    #[inline(never)]
    pub(super) fn may_stretch(&self) -> bool {
        let places = self.texels.unwrap_or_default();
        let all = places.iter().fold(0, |all, [u, v]| all | u | v);
        self.generated.is_none() && (places.is_empty() || all as u32 >= 4096 << 8)
    }

    /// The order of corners from the topmost on, and their places in it; `None` where the face is not seen.
    pub(super) fn order(&self, places: [u32; 3]) -> Option<([u16; 3], [u32; 3])> {
        top_first(self.cull == Cull::Back, [0, 1, 2], places)
    }

    /// The word of a vertex of a mesh, with its normal, if it has one.
    pub(super) fn colour_of<C: Coordinate>(&self, mesh: &Mesh<'_, C>, i: usize) -> u32 {
        self.lit(mesh, i, mesh.normals.get(i).copied())
    }

    /// The word of a vertex: its colour, lit if there is a normal; or the normal itself. One copy for all who ask.
    #[inline(never)]
    pub(super) fn lit<C: Coordinate>(
        &self,
        mesh: &Mesh<'_, C>,
        i: usize,
        normal: Option<[i16; 3]>,
    ) -> u32 {
        if let Some((turn, word)) = &self.normals {
            return word(turn, normal);
        }
        let tint = match mesh.colours.get(i) {
            Some(&colour) => Tint::new(colour, &self.scale),
            None => self.tint,
        };
        let colour: Colour = match (normal, self.lamps, &self.light) {
            (Some(normal), Some(lamps), _) => (lamps.lit)(
                lamps,
                &tint,
                &self.scale,
                normal,
                place_of(mesh.positions, i),
            ),
            (Some(normal), None, Some(light)) => light.lit(&tint, normal),
            _ => tint.lit(1 << 15),
        };
        colour.word()
    }
}
