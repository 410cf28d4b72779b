//! How a texture's texels are taken where the nearest one is not enough: levels of detail and filters (H6).
//!
//! What they do is in room `look`. A texture leads there by a function, so that a program which names no
//! [`Sampling`] does not have the code.

use super::{Budget, Texture, TexturePlace, Vertex};

/// A way from places on a texture to colours, for [`Texture::sampled`].
#[derive(Clone, Copy, Debug)]
pub struct Sampling {
    pub(crate) draw: fn(&SampledSpan<'_>, &mut [u16]),
    /// How places of a small triangle become one word, where such have fraction bits enough.
    pub(crate) word: Option<WordOf>,
}

/// From a triangle's corners to its plane and its level.
pub(crate) type WordOf =
    fn([&Vertex; 3], &[TexturePlace; 3], &Texture<'_>, Budget) -> Option<[u32; 4]>;

/// How texture coordinates are found along a span.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub(crate) enum Method {
    /// Affine: one plane of one word, v above u, 16 bits of the period each; then the level of a texture that has some.
    #[default]
    Word,
    /// Affine: planes of u and v.
    Wide,
    /// Planes of u/w, v/w and 1/w.
    Perspective,
}

/// What the words of a texture are, to what has to know.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Words {
    /// Pixels of 5, 6 and 5 bits as numbers.
    Numbers,
    /// The same with their bytes in the other order.
    Swapped,
    /// What a mask says of texels.
    Masks,
}

/// A span of a textured triangle, and a run of its pixels.
#[derive(Debug)]
pub(crate) struct SampledSpan<'a> {
    pub(crate) texture: &'a Texture<'a>,
    pub(crate) words: Words,
    pub(crate) method: Method,
    /// Steps from one exact place to the next, where each has its own 1/w.
    pub(crate) steps: u8,
    /// Whole texels that come on top of what the planes give.
    pub(crate) base: [i32; 2],
    /// Values at the picture's first pixel, steps to the right, steps down.
    pub(crate) planes: &'a [[u32; 3]; 3],
    pub(crate) place: Place,
}

/// Where a run of pixels begins: the columns of its span, its own first one, and the line.
///
/// Colours are reckoned from the ends of the span, so that a pixel has the same bits in whatever runs its span is
/// coloured.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// The first column of the span.
    pub span: u32,
    /// The column after its last.
    pub end: u32,
    pub column: u32,
    pub line: u32,
}

impl Place {
    /// The span's first pixel.
    #[inline(always)]
    pub fn first(self) -> Self {
        Self {
            column: self.span,
            ..self
        }
    }

    /// The value here of a plane: at the picture's first pixel, and its steps to the right and down.
    #[inline(always)]
    pub fn value(self, [at, right, below]: [u32; 3]) -> u32 {
        at.wrapping_add(right.wrapping_mul(self.column))
            .wrapping_add(below.wrapping_mul(self.line))
    }

    /// Pixels of the span before the run.
    #[inline(always)]
    pub fn skipped(self) -> u32 {
        self.column.wrapping_sub(self.span)
    }

    /// Pixels of the span.
    #[inline(always)]
    pub fn pixels(self) -> u32 {
        self.end.wrapping_sub(self.span)
    }
}
