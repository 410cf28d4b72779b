//! The records of the slow arena: shared vertices and the objects that index them (S3, C1).

use super::shading::Empty;
use crate::link::Link;

/// A vertex on the screen, shared by the objects around it.
///
/// `A` is what the shading keeps at a vertex ([`Shading::Vertex`](super::Shading::Vertex)).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct SceneVertex<A> {
    /// Column in 13.3 of guard space; an outcode when its depth says so.
    pub(crate) x: u16,
    /// Line in 13.3 of guard space.
    pub(crate) y: u16,
    /// 1/w with the near plane at 2^31; [`OUTSIDE`]: not on the screen.
    pub(crate) depth: u32,
    /// What the shading keeps.
    pub(crate) attribute: A,
}

impl<A: Empty> SceneVertex<A> {
    /// What fresh memory is filled with, also that of a static.
    #[must_use]
    pub const fn empty() -> Self {
        Self {
            x: 0,
            y: 0,
            depth: 0,
            attribute: A::EMPTY,
        }
    }
}

impl<A> SceneVertex<A> {
    /// The planes that a vertex lies beyond which has to be clipped, 0 for one on the screen.
    pub(super) fn outcode(&self) -> u16 {
        if self.depth == OUTSIDE { self.x } else { 0 }
    }
}

/// The depth that marks a vertex which has to be clipped, never referred to by an object.
pub(super) const OUTSIDE: u32 = u32::MAX;

/// A triangle in the slow arena: three corners by index, and the next object that becomes
/// active on the same scanline.
///
/// `F` is what the shading keeps for a face ([`Shading::Face`](super::Shading::Face)).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[repr(C)]
pub struct Object<F> {
    /// Indices of the corners.
    pub(crate) corner: [u16; 3],
    /// Chain of the activation bucket (K1); written once, in pass one.
    chain: Link,
    /// What the shading keeps.
    pub(crate) face: F,
}

/// A triangle read back from a scene: its corners on the screen, and what its shading keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Filed<A, F> {
    /// Column and line of each corner in 13.3 of guard space.
    pub places: [(u16, u16); 3],
    /// 1/w of each corner with the near plane at 2^31.
    pub depths: [u32; 3],
    /// What the shading keeps at each corner.
    pub attributes: [A; 3],
    /// What the shading keeps for the face.
    pub face: F,
}

impl<F: Empty> Object<F> {
    /// What fresh memory is filled with, also that of a static.
    #[must_use]
    pub const fn empty() -> Self {
        Self {
            corner: [0; 3],
            // All zeros.
            chain: Link::slow(0),
            face: F::EMPTY,
        }
    }
}

impl<F> Object<F> {
    /// An object that is in no bucket yet.
    pub(crate) const fn new(corner: [u16; 3], face: F) -> Self {
        Self {
            corner,
            chain: Link::NONE,
            face,
        }
    }

    /// Chains the object to the one filed before it under the same line.
    #[inline]
    pub(crate) fn chain(&mut self, link: Link) {
        self.chain = link;
    }

    /// The object filed before this one under the same line.
    #[inline]
    pub(crate) fn next(&self) -> Link {
        self.chain
    }
}

// These two fill the slow arena: a triangle with colours at shared corners costs 8 + 6 bytes in
// a closed mesh (half a vertex a triangle), a flat one 12.
const _: () = assert!(size_of::<SceneVertex<super::Colour>>() == 12);
const _: () = assert!(size_of::<SceneVertex<()>>() == 8);
const _: () = assert!(size_of::<Object<()>>() == 8);
const _: () = assert!(size_of::<Object<super::Colour>>() == 12);
