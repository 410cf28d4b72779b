//! The error budget that a caller states (X2).

use fixed::types::U8F8;

/// How far a picture may be off what its objects' planes say, beyond the rounding of the output.
///
/// The planes themselves err too, and no budget changes that: with the rounding of a vertex's
/// colour to its fields by at most 0.56 levels in triangles of up to 64 x 64 pixels; in larger
/// ones by 1/8 of a step of the output where they are thin, and half a unit of 2^-16 step for
/// each column and line that they are large.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quality {
    /// Colour, 8-bit levels.
    pub levels: U8F8,
    /// Place in a texture, texels.
    pub texels: U8F8,
}

impl Quality {
    /// 4 levels and 1/2 texel: what moves hides it.
    #[must_use]
    pub const fn fast() -> Self {
        Self {
            levels: U8F8::from_bits(4 << 8),
            texels: U8F8::from_bits(1 << 7),
        }
    }

    /// 1.5 levels and 1/4 texel: less than a step of 16-bit colour.
    #[must_use]
    pub const fn balanced() -> Self {
        Self {
            levels: U8F8::from_bits(3 << 7),
            texels: U8F8::from_bits(1 << 6),
        }
    }

    /// Nothing beyond planes and rounding.
    #[must_use]
    pub const fn exact() -> Self {
        Self {
            levels: U8F8::ZERO,
            texels: U8F8::ZERO,
        }
    }
}

impl Default for Quality {
    fn default() -> Self {
        Self::balanced()
    }
}
