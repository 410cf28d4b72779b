//! What a look does, and what it is told.

use crate::geometry::Scale;
use crate::pixel::{MadeOf, PixelFormat};
pub(crate) use crate::scene::Place;
use crate::scene::{Blend, DrawError, DrawState, Draws, WordOfNormal};
use crate::span::{Size, Triangle};

/// How the planes of a triangle are evaluated; each look says what is where in its planes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fill {
    /// The cheapest way; most triangles have it.
    Plain,
    /// Small triangles that need more bits.
    Small,
    /// Any triangle that has planes.
    Wide,
    /// None: planes are made for each line, from both ends of the span.
    Thin,
}

/// How the triangles of a scene look: [`Gouraud`](super::Gouraud), [`Textured`](super::Textured),
/// [`Phong`](super::Phong), [`TexturedPhong`](super::TexturedPhong), or [`Shaded`](super::Shaded) by a
/// [`Shader`](super::Shader) of one's own.
///
/// What it does is the crate's own affair: what its functions are given has no name outside.
pub trait Look: Sized {
    /// The pixels of the line.
    type Pixel: PixelFormat;
    /// What a triangle keeps of its colours.
    type Planes: Copy + core::fmt::Debug;
    /// The planes of no triangle: zeros, so that no constant is copied.
    #[doc(hidden)]
    const EMPTY: Self::Planes;
    /// Whether vertices have texture places.
    #[doc(hidden)]
    const TEXTURED: bool;
    /// How a normal becomes the word of a vertex, where light falls on pixels.
    #[doc(hidden)]
    const LIT_AT_PIXELS: Option<WordOfNormal> = None;
    /// How levels of light become colours of vertices.
    #[doc(hidden)]
    const SCALE: Scale;

    /// The planes of a triangle.
    #[doc(hidden)]
    fn set_up(of: &Primitive<'_>, planes: &mut Self::Planes) -> Fill;

    /// The planes of a thin triangle on one line, of the kind [`Fill::Wide`], where there were none.
    #[doc(hidden)]
    fn set_up_thin(span: &ThinSpan<'_>, object: u16, draws: &Draws<'_>, planes: &mut Self::Planes);

    /// Colours a run of pixels; `at` is its first.
    #[doc(hidden)]
    fn fill(
        fill: Fill,
        planes: &Self::Planes,
        at: Place,
        draws: States<'_>,
        run: &mut [WordOf<Self>],
    );

    /// [`fill`](Look::fill) of [`Fill::Plain`].
    #[doc(hidden)]
    #[inline(always)]
    fn fill_plain(planes: &Self::Planes, at: Place, draws: States<'_>, run: &mut [WordOf<Self>]) {
        Self::fill(Fill::Plain, planes, at, draws, run);
    }

    /// [`fill`](Look::fill) of the whole span of a slot.
    #[doc(hidden)]
    #[inline(always)]
    fn fill_slot(
        fill: Fill,
        planes: &Self::Planes,
        at: Place,
        draws: States<'_>,
        run: &mut [WordOf<Self>],
    ) {
        Self::fill(fill, planes, at, draws, run);
    }

    /// How many halves of what most spans take one of so many pixels does, of a look with textures.
    #[doc(hidden)]
    fn halves(fill: Fill, _planes: &Self::Planes, _pixels: u32) -> u32 {
        match fill {
            Fill::Plain | Fill::Small => 2,
            Fill::Wide | Fill::Thin => 4,
        }
    }

    /// [`fill`](Look::fill), dithered or not, where pixels have 16 bits and the look dithers. Of a draw call whose texture
    /// has transparent texels, up to 32 pixels; a bit for each that is not a hole, the first the top one.
    #[doc(hidden)]
    fn fill_opaque(
        fill: Fill,
        planes: &Self::Planes,
        at: Place,
        draws: States<'_>,
        _dithers: bool,
        run: &mut [WordOf<Self>],
    ) -> u32 {
        Self::fill(fill, planes, at, draws, run);
        u32::MAX
    }

    /// Words of the mask of a draw call's texture, of the texels that a run of pixels shows; nothing where there is no
    /// mask.
    #[doc(hidden)]
    fn fill_mask(_planes: &Self::Planes, _at: Place, _: States<'_>, _run: &mut [u16]) {}

    /// Planes that keep enough of a triangle's colour for a dither, in place of those it has, where these do not.
    #[doc(hidden)]
    fn set_up_dithered(_triangle: &Triangle<'_>, _planes: &mut Self::Planes) -> Option<Fill> {
        None
    }
}

/// What draw calls say, by their numbers.
pub(crate) type States<'a> = &'a [DrawState<'a>];

/// A pixel of a line buffer.
pub type WordOf<L> = <<L as Look>::Pixel as crate::pixel::PixelFormat>::Word;

/// A triangle that is set up, with its number, and what draw calls say.
#[derive(Debug)]
pub struct Primitive<'a> {
    pub triangle: &'a Triangle<'a>,
    pub object: u16,
    pub size: Size,
    pub area: u32,
    pub draws: &'a Draws<'a>,
}

/// A span of a thin triangle: the parts that its corners have in its first pixel and in its last.
#[derive(Debug)]
pub struct ThinSpan<'a> {
    pub triangle: &'a Triangle<'a>,
    pub parts: [Parts; 2],
    pub start: u32,
    pub pixels: u32,
}

/// What the second and the third corner have in a place, in units of 2^-30; the first has the rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parts {
    pub second: u32,
    pub third: u32,
}

impl ThinSpan<'_> {
    /// The value at column 0 and the step of what has these values, within 2^32, at the corners: exact in the
    /// span's first pixel and in its last, linear between them.
    #[inline(never)]
    pub fn line(&self, value: [i64; 3]) -> [u32; 2] {
        let [a, b, c] = value;
        let at = |parts: Parts| {
            let rise = (b - a) * i64::from(parts.second) + (c - a) * i64::from(parts.third);
            a + ((rise + (1 << 29)) >> 30)
        };
        let (first, last) = (at(self.parts[0]), at(self.parts[1]));
        // Values lie between those of the corners, so they differ by less than 2^32.
        let rise = last - first;
        let step = rise.unsigned_abs() as u32 / self.pixels.saturating_sub(1).max(1);
        let step = if rise < 0 { step.wrapping_neg() } else { step };
        let at = (first as u32).wrapping_sub(step.wrapping_mul(self.start));
        [at, step]
    }
}

/// Numbers of a palette cannot be blended.
#[inline(always)]
pub(crate) fn check_blend<L: Look>(blend: Option<Blend>) -> Result<(), DrawError> {
    match (<L::Pixel as PixelFormat>::MADE_OF, blend) {
        (MadeOf::Index, Some(_)) => Err(DrawError::Indices),
        _ => Ok(()),
    }
}
