//! Corners as a mapping wants them: fine places on the picture, and places on the texture (H3).

use crate::scene::{ORIGIN, TexturePlace, Vertex};
use crate::span::Triangle;

/// A corner of a triangle; corners go clockwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Corner {
    /// To the right of the centre of the picture's first pixel, 1/64 pixel, below 2^20 either way.
    pub x: i32,
    /// Down from there, likewise.
    pub y: i32,
    /// 1/w in any unit, 1 ..< 2^31.
    pub depth: u32,
    /// Place on the texture, to the right and down: texels with 14 fraction bits, modulo 2^18.
    pub texel: [i32; 2],
}

/// That of a vertex: fine places from the centre of the picture's first pixel.
#[inline(always)]
fn corner(vertex: &Vertex, texture: TexturePlace) -> Corner {
    const FIRST: i32 = 64 * ORIGIN + 32;
    let fine = texture.fine();
    Corner {
        x: 8 * (vertex.place & 0xFFFF) as i32 + fine[0] - FIRST,
        y: 8 * (vertex.place >> 16) as i32 + fine[1] - FIRST,
        depth: vertex.depth.clamp(1, i32::MAX as u32),
        texel: texture.texel(),
    }
}

/// The corners of a triangle, or of a parallelogram.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Corners {
    pub three: [Corner; 3],
    pub fourth: Option<Corner>,
}

impl Corners {
    #[inline(always)]
    pub(super) fn of(triangle: &Triangle<'_>) -> Self {
        let of = |i: usize| corner(triangle.vertex[i], triangle.texture(i));
        Self {
            three: [of(0), of(1), of(2)],
            fourth: triangle.fourth().map(|at| corner(at.vertex, at.texture)),
        }
    }
}
