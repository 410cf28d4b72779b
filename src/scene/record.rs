//! The records that pass one leaves in slow memory (S3, C1).

/// The column and the line of guard space at which each picture begins.
///
/// A multiple of 1,024, so that it drops out of columns of 10 bits; the guard band reaches 2,048 pixels from the
/// middle of the picture, so places of up to [`LARGEST`](super::LARGEST) pixels stay within their 13 bits.
pub(crate) const ORIGIN: i32 = 3072;

/// A vertex on the screen, shared by the triangles around it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Vertex {
    /// Line above column, 13.3 each, of guard space; [`Vertex::OUTSIDE`] where the vertex has to be
    /// clipped.
    pub(crate) place: u32,
    /// 1/w in units of 2^-31, a power of two below the near plane's at most; where the vertex has to be
    /// clipped, the planes that it lies beyond.
    pub(crate) depth: u32,
    /// The colour: 11, 10 and 11 bits of red, blue and green.
    pub(crate) colour: u32,
}

impl Vertex {
    /// What fresh memory is filled with: zeros, so that a static takes no flash.
    pub const EMPTY: Self = Self::new(0, 0, 0);

    /// The colour of a vertex that no triangle has used, and of one that waits to be lit.
    const UNUSED: u32 = 0;
    const USED: u32 = 1;

    /// A vertex that is not transformed yet: it has to be clipped, and lies beyond no plane.
    pub(super) const WAITING: Self = Self::unused(Self::OUTSIDE, 0);

    #[inline(always)]
    pub(super) const fn new(place: u32, depth: u32, colour: u32) -> Self {
        Self {
            place,
            depth,
            colour,
        }
    }

    /// Whether a vertex is not transformed yet.
    #[inline(always)]
    pub(super) fn is_waiting(self) -> bool {
        self.place == Self::OUTSIDE && self.depth == 0
    }

    /// A vertex on the screen, which no triangle has used.
    #[inline(always)]
    pub(super) const fn unused(place: u32, depth: u32) -> Self {
        Self::new(place, depth, Self::UNUSED)
    }

    /// Says that a triangle that is kept has the vertex.
    #[inline(always)]
    pub(super) fn mark_used(&mut self) {
        self.colour = Self::USED;
    }

    /// Whether a triangle that is kept has the vertex.
    #[inline(always)]
    pub(super) fn is_used(self) -> bool {
        self.colour != Self::UNUSED
    }

    /// The place of a vertex that has to be clipped. No place on the screen is as far down.
    pub(crate) const OUTSIDE: u32 = u32::MAX;
}

/// Where a vertex lies on its texture, and the fraction of its place that coverage does not use (X13).
///
/// Upper 29 bits: texels with 11 fraction bits, modulo 2^18 texels. Lower 3 bits: units of 1/64 pixel beyond
/// the vertex's place, -4 to 3.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[repr(transparent)]
pub struct TexturePlace(pub(crate) [u32; 2]);

impl TexturePlace {
    /// What fresh memory is filled with.
    pub const EMPTY: Self = Self([0; 2]);

    /// Fraction bits of texels beyond the 8 of meshes: corners that are cut are not rounded to those.
    pub(crate) const FINER: u32 = 6;

    /// From texels with 14 fraction bits, of which 11 are kept, and units of 1/64 pixel.
    #[inline(always)]
    pub(crate) fn new(texel: [i32; 2], fine: [i32; 2]) -> Self {
        Self([0, 1].map(|i| (texel[i].wrapping_add(4) & !7 | fine[i] & 7) as u32))
    }

    /// From texels with 8 fraction bits, as meshes have them.
    #[inline(always)]
    pub(crate) fn of_mesh(texel: [i32; 2], fine: [i32; 2]) -> Self {
        Self([0, 1].map(|i| (texel[i] << Self::FINER | fine[i] & 7) as u32))
    }

    /// Texels with 14 fraction bits: across and down, modulo 2^18 texels.
    #[inline(always)]
    pub(crate) fn texel(self) -> [i32; 2] {
        self.0.map(|w| (w & !7) as i32)
    }

    /// Units of 1/64 pixel beyond the vertex's place: across and down.
    #[inline(always)]
    pub(crate) fn fine(self) -> [i32; 2] {
        self.0.map(|w| (w << 29) as i32 >> 29)
    }
}

/// How far a triangle stretches on its texture, in texels with 14 fraction bits.
pub(crate) struct Stretch {
    /// On each axis, the least and the most of the ways from the first corner.
    pub(crate) ways: [[i32; 2]; 2],
    /// The longer of both sides.
    pub(crate) width: u32,
}

impl Stretch {
    /// Of the places at the corners; `None` where it is above 4,096 texels.
    #[inline(never)]
    pub(crate) fn of(texels: &[[i32; 2]; 3]) -> Option<Self> {
        let [a, b, c] = texels;
        let (mut ways, mut width) = ([[0; 2]; 2], 0);
        for axis in 0..2 {
            let [b, c] = [b, c].map(|other| other[axis].wrapping_sub(a[axis]));
            let [low, high] = [b.min(c).min(0), b.max(c).max(0)];
            ways[axis] = [low, high];
            width = width.max(high.wrapping_sub(low) as u32);
        }
        (width <= 4096 << 14).then_some(Self { ways, width })
    }
}

/// The first line whose centre lies at or below a place, in guard space.
#[inline(always)]
pub(crate) fn first_line(place: u32) -> i32 {
    (place.wrapping_add(4 << 16) >> 19) as i32
}

/// A triangle in slow memory, and the next one that begins on the same line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Object {
    /// Vertices, the topmost first (of two the left one), clockwise on the screen.
    pub(crate) corner: [u16; 3],
    /// The triangle that was filed under the same line before this one, or [`NONE`].
    pub(crate) next: u16,
}

impl Object {
    /// What fresh memory is filled with: zeros, so that a static takes no flash.
    pub const EMPTY: Self = Self {
        corner: [0; 3],
        next: 0,
    };
}

/// The end of a chain of objects.
pub(crate) const NONE: u16 = 0xFFFF;

const _: () = assert!(size_of::<Vertex>() == 12 && size_of::<Object>() == 8);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_texture_place_keeps_texels_and_fractions() {
        for texel in [0, 8, -8, 1 << 30, -(1 << 30), 987_654_320] {
            for fine in -4..4 {
                let place = TexturePlace::new([texel, -texel], [fine, -1 - fine]);
                assert_eq!(place.texel(), [texel, -texel]);
                assert_eq!(place.fine(), [fine, -1 - fine]);
                let rounded = TexturePlace::new([texel - 4, texel + 3], [fine; 2]);
                assert_eq!(rounded.texel(), [texel; 2]);
            }
        }
    }
}
