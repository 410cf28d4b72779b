//! Alpha that differs from vertex to vertex and from texel to texel, and what else a texel says of itself (K11, H7, H8,
//! H10).
//!
//! Alphas of vertices lie behind the vertices of their call, in records of the same memory: 8 alphas take 12 bytes. A
//! triangle with vertices of its own has a record of its own behind them. So no record of a vertex or of a triangle has
//! anything for it, and no look knows of it. A mask is a texture of the same places.

use super::{Form, Object, Texture, TextureError, Vertex};
use crate::num::{mul_high_unsigned, rolled};

/// What a mask says of the texel at its place: how opaque it is, whether it is dithered, whether it is added.
///
/// Masks are textures whose words are such [`word`](MaskTexel::word)s, or have a palette of them; see
/// [`Texture::masked`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MaskTexel(pub(crate) u16);

impl MaskTexel {
    /// Opaque, dithered where the call is, and blended as it is.
    pub const OPAQUE: Self = Self::alpha(255);

    const UNDITHERED: u16 = 1 << 8;
    const ADDED: u16 = 1 << 9;

    /// Of this alpha, 0 to 255 for 1.
    #[must_use]
    pub const fn alpha(alpha: u8) -> Self {
        Self(alpha as u16)
    }

    /// The same, never dithered: the pixel that the call would have without its dither (H10).
    #[must_use]
    pub const fn undithered(self) -> Self {
        Self(self.0 | Self::UNDITHERED)
    }

    /// The same, added times its alpha, whatever the blend of its call is (K11).
    #[must_use]
    pub const fn added(self) -> Self {
        Self(self.0 | Self::ADDED)
    }

    /// As it lies in a mask: alpha in bits 0 to 7, bit 8 where it is not dithered, bit 9 where it is added.
    #[must_use]
    pub const fn word(self) -> u16 {
        self.0
    }

    pub(crate) const fn is_undithered(self) -> bool {
        self.0 & Self::UNDITHERED != 0
    }

    pub(crate) const fn is_added(self) -> bool {
        self.0 & Self::ADDED != 0
    }
}

/// What a pixel is blended by, beside the blend of its call: the texel's word, and above it the alpha of the vertices,
/// 255 for 1. In one word, as runs of equal ones are looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PixelAlpha(u32);

impl PixelAlpha {
    pub(crate) const OPAQUE: Self = Self::new(255, MaskTexel::OPAQUE);

    #[inline(always)]
    pub(crate) const fn new(surface: u8, texel: MaskTexel) -> Self {
        Self((surface as u32) << 16 | texel.0 as u32)
    }

    /// That of the vertices.
    #[inline(always)]
    pub(super) const fn surface(self) -> u8 {
        (self.0 >> 16) as u8
    }

    /// What the texel says.
    #[inline(always)]
    pub(crate) const fn texel(self) -> MaskTexel {
        MaskTexel(self.0 as u16)
    }

    /// That of the texel, 255 for 1.
    #[inline(always)]
    pub(super) const fn of_texel(self) -> u8 {
        self.0 as u8
    }

    /// Both alphas and a third one, rounded once.
    #[inline(always)]
    pub(crate) const fn times(self, alpha: u8) -> u8 {
        let all = self.surface() as u32 * self.of_texel() as u32 * alpha as u32;
        // By 2^47 / 255^2, rounded up: the quotient is exact.
        (mul_high_unsigned(all + 255 * 255 / 2, 0x8101_8203) >> 15) as u8
    }
}

impl<'t> Texture<'t> {
    /// The same texture, of whose texels a mask says how opaque each is, and whether it is dithered or added (H7, H10,
    /// K11).
    ///
    /// A mask has the sides, the form and as many levels of detail as the texture, whose wrap and whose way of taking
    /// texels it gets; of a texture of indices it may be the same bytes with another palette. Its words are those of
    /// [`MaskTexel`]. Alphas are looked at where a call is blended by a mode that asks for them, filtered where colours
    /// are; whether a texel is dithered where the call is. Elsewhere, a mask costs nothing.
    ///
    /// # Errors
    /// A mask with other sides, another form, or another number of levels.
    pub const fn masked(mut self, mask: &'t Texture<'t>) -> Result<Self, TextureError> {
        if self.log_width() == mask.log_width()
            && self.log_height() == mask.log_height()
            && self.form.bits() == mask.form.bits()
            && self.levels() == mask.levels()
        {
            self.mask = Some(mask);
            return Ok(self);
        }
        Err(TextureError::Mask)
    }

    /// Its mask, which is read as it is itself.
    pub(crate) fn mask(&self) -> Option<Texture<'t>> {
        let mut mask = *self.mask?;
        (mask.wrap, mask.key) = (self.wrap, None);
        (mask.sampling, mask.spare) = (self.sampling, self.spare);
        Some(mask)
    }
}

impl Form<'_> {
    /// Bits of a texel in memory; none where it is computed.
    const fn bits(&self) -> u32 {
        match self {
            Self::Words(_) => 16,
            Self::Index8(..) => 8,
            Self::Index4(..) => 4,
            Self::Index2(..) => 2,
            Self::Index1(..) => 1,
            Self::Computed(..) => 0,
        }
    }
}

/// Alphas that a record has.
pub(super) const A_RECORD: usize = 8;

/// Where the vertices of a call have their alphas.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Alphas {
    /// The first vertex of the mesh, and that after its last: there the records begin. What lies behind them are
    /// triangles with vertices and records of their own.
    base: u16,
    end: u16,
}

impl Alphas {
    /// Of a mesh of which so many vertices are in memory.
    pub(super) fn new(base: usize, shared: usize) -> Self {
        Self {
            base: base as u16,
            end: (base + shared) as u16,
        }
    }

    /// Those of a triangle's corners, with 8 fraction bits.
    pub(crate) fn of(self, object: &Object, vertices: &[Vertex]) -> [u16; 3] {
        let record = |at: usize| {
            let record = vertices.get(at).copied().unwrap_or(Vertex::EMPTY);
            bytemuck::cast::<_, [u8; A_RECORD]>([record.depth, record.colour])
        };
        if object.corner[0] >= self.end {
            let bytes = record(usize::from(object.corner[0]) + 3);
            return [0, 2, 4].map(|i| u16::from_ne_bytes([bytes[i], bytes[i + 1]]));
        }
        object.corner.map(|corner| {
            let vertex = usize::from(corner.saturating_sub(self.base));
            let bytes = record(usize::from(self.end) + vertex / A_RECORD);
            u16::from(bytes[vertex % A_RECORD]) << 8
        })
    }
}

/// A record: on no line.
fn record(bytes: [u8; A_RECORD]) -> Vertex {
    let [depth, colour] = bytemuck::cast(bytes);
    Vertex::new(Vertex::OUTSIDE, depth, colour)
}

/// Keeps the alphas of a mesh's vertices.
#[inline(never)]
pub(super) fn keep(alphas: &[u8], records: &mut [Vertex]) {
    for (alphas, slot) in alphas.chunks(A_RECORD).zip(records) {
        rolled();
        let mut bytes = [0; A_RECORD];
        bytes[..alphas.len()].copy_from_slice(alphas);
        *slot = record(bytes);
    }
}

/// The record of a triangle with vertices of its own, of alphas with 8 fraction bits.
pub(super) fn own_record(alphas: [u16; 3]) -> Vertex {
    let [a, b, c] = alphas;
    record(bytemuck::cast([a, b, c, 0]))
}

#[cfg(test)]
mod tests {
    use super::{MaskTexel, PixelAlpha};

    /// Kills: a factor that is one less, a half that is one less.
    #[test]
    fn three_alphas_are_rounded_once() {
        for surface in 0..=255 {
            for texel in 0..=surface {
                let both = PixelAlpha::new(surface, MaskTexel(texel.into()));
                for alpha in 0..=texel {
                    let all = u32::from(surface) * u32::from(texel) * u32::from(alpha);
                    let exact = (all + 255 * 255 / 2) / (255 * 255);
                    assert_eq!(
                        u32::from(both.times(alpha)),
                        exact,
                        "{surface} {texel} {alpha}"
                    );
                }
            }
        }
    }
}
