//! What the application hands in: vertices as parallel slices, faces as indices (K2, H16).
//!
//! Attributes are separate slices, so that a mesh without normals, say, has no bytes for them.

use crate::num::{mul_16, mul_high};

/// A coordinate of model space: `i16` in Q1.14 or `i32` in Q1.30.
pub trait Coordinate: Copy + Send + Sync {
    /// The product with a matrix entry: `entry / 4 x` for the real value x of the coordinate,
    /// rounded down. One multiplication on a Cortex-M4 for either type.
    fn times(self, entry: i32) -> i32;

    /// The coordinate in Q1.30, for what is done once a face or rarer.
    fn to_q30(self) -> i32;
}

impl Coordinate for i16 {
    #[inline(always)]
    fn times(self, entry: i32) -> i32 {
        mul_16(entry, self)
    }

    fn to_q30(self) -> i32 {
        i32::from(self) << 16
    }
}

impl Coordinate for i32 {
    #[inline(always)]
    fn times(self, entry: i32) -> i32 {
        mul_high(entry, self)
    }

    fn to_q30(self) -> i32 {
        self
    }
}

/// A mesh, borrowed from flash or RAM.
///
/// `C` is the coordinate type: `i16` in Q1.14 or `i32` in Q1.30, both in `-2.0 ..< 2.0`; the
/// model matrix carries the real size. An attribute slice is either empty or as long as
/// [`positions`](Mesh::positions).
///
/// All vertices of the slices are moved, lit and projected, and take their place in the scene's
/// memory, whether a face uses them or not: some 140 instructions each on a Cortex-M4. So a few faces
/// of a large table cost the whole table; give them slices of their own vertices instead. A large mesh that is closed is
/// cheaper in parts ([`Meshlets`](crate::mesh::Meshlets)), of which what is turned away is not moved.
#[derive(Clone, Copy, Debug)]
pub struct Mesh<'a, C = i16> {
    /// Vertex positions in model space.
    pub positions: &'a [[C; 3]],
    /// Unit normals in Q1.14; empty: the mesh is not lit.
    pub normals: &'a [[i16; 3]],
    /// Colours, 0 to 255 a channel, red first; empty: white.
    pub colours: &'a [[u8; 3]],
    /// The faces, counter-clockwise seen from outside.
    pub faces: Faces<'a>,
}

impl<C> Mesh<'_, C> {
    /// Nothing.
    pub(crate) const EMPTY: Self = Self {
        positions: &[],
        normals: &[],
        colours: &[],
        faces: Faces::Triangles(&[]),
    };
}

/// Where a vertex lies, in Q1.30; the middle, where there is none.
#[inline(always)]
pub(crate) fn place_of<C: Coordinate>(positions: &[[C; 3]], i: usize) -> [i32; 3] {
    positions.get(i).map_or([0; 3], |at| at.map(C::to_q30))
}

/// The faces of a mesh, as indices into its vertices.
#[derive(Clone, Copy, Debug)]
pub enum Faces<'a> {
    /// Three corners each.
    Triangles(&'a [[u16; 3]]),
    /// Four corners each, in order around the face. Split along the axis from corner 0 to
    /// corner 2, or from 1 to 3 where the flag says so (K2).
    Quads(&'a [[u16; 4]], QuadSplit),
    /// A strip: two vertices, then two more for each quad (K2). The quad made by vertices
    /// `a, b` and the next two `c, d` has the corners `a, b, d, c`; every other quad is split
    /// the other way, so that the strip is cross-hatched.
    QuadStrip(&'a [u16], QuadSplit),
}

/// Which diagonal splits a quad into two triangles (K2).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum QuadSplit {
    /// From the first corner to the third.
    #[default]
    Corner0To2,
    /// From the second corner to the fourth.
    Corner1To3,
}

impl QuadSplit {
    /// The other diagonal.
    #[must_use]
    pub const fn other(self) -> Self {
        match self {
            Self::Corner0To2 => Self::Corner1To3,
            Self::Corner1To3 => Self::Corner0To2,
        }
    }
}
