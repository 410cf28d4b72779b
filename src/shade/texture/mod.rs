//! Texture: texels along a span, in perspective and by blocks (H1-H7, H17, B1, B5, K18, X2).
//!
//! ```text
//!  Corners ──► planes of 1/w, u/w, v/w ──► PerspectiveSpan ──► runs of (u, v) ──► Texels ──► words
//!  exponent,   set-up                      select: how many    affine within      memory,
//!  bound                                   pixels a division   a run              palette, filter
//! ```
//!
//! | file | what | rows |
//! |---|---|---|
//! | `perspective` | (u, v) along a span: exact, every 2nd, linear over 4, 8, 16 pixels, affine | H4, H5, K18 |
//! | `select` | which of these keeps an error budget | X2 |
//! | `format` | texel formats and their expansion | H7 |
//! | `tlut` | texels in memory: whole words, and 1 to 8 bits through a lookup table | H7 |
//! | `sample` | textures: size, wrap, mirror, clamp, nearest | H6 |
//! | `bilinear` | the four nearest texels | H6 |
//! | `lod` | four levels of detail, built | H6 |
//! | `block` | layouts of texture memory, runs inside a block | B1, B5 |
//! | `cache` | a small cache of blocks, with counters | B5 |
//! | `procedural` | textures that are computed | H17 |
//!
//! Everything that can vary is a type, so what a pipeline does not name has no code: a texture is
//! anything that is [`Texels`].

mod bilinear;
mod block;
mod cache;
mod format;
mod lod;
mod perspective;
mod procedural;
mod sample;
mod select;
#[cfg(test)]
mod tests;
mod tlut;

pub use crate::geometry::texturing::{
    Budget, Corner, Corners, Detail, FRACTION, Homogeneous, LEVELS, LevelEnds, Period, Quality,
    Skin, TexturePlanes, Textured, Uv,
};
pub use bilinear::Bilinear;
pub use block::{BlockRun, BlockRuns, Blocked, Layout, Linear};
pub use cache::{BlockCache, CacheError, CacheReads};
pub use format::{Rgb565Texel, Rgb888Texel, Rgba5551, Rgba8871, Rgbd5551, Texel, TexelFormat};
pub use lod::{Level, Levels, build_level, level_words};
pub use perspective::{AllSeen, PaintRun, PerspectiveSpan, Stride};
pub use procedural::{Checker, Gradient};
pub use sample::{
    Address, Clamp, Fetch, MAX_SIDE, Mirror, Size, Square, Square64, Square128, Square256, Texture,
    TextureError, Whole, Wrap,
};
pub use tlut::{Indexed, Store, Words};

use crate::visible::{Everywhere, Visible};

/// A texture: what colour is where.
///
/// Only [`at`](Texels::at) has to be there, as for a texture that is computed (H17). One that lies
/// in memory says with [`along`](Texels::along) how it is best read along a straight way.
pub trait Texels {
    /// What is found at a place: a word of the display, an expanded [`Texel`], a level.
    type Texel: Copy;

    /// Whether a texel takes so long that the loop along a run is there once, for all ways along a
    /// span.
    const LONG: bool = false;

    /// The colour at a place.
    fn at(&self, place: Uv) -> Self::Texel;

    /// How it goes on beyond its sides: what may be taken off places without being seen. By it
    /// places are kept near the first texel, where they are the most precise.
    fn period(&self) -> Period {
        Period::Long
    }

    /// Stored texels that [`at`](Texels::at) reads.
    #[inline(always)]
    fn fetches(&self) -> u32 {
        1
    }

    /// Gives `each` the pixels in turn, each with the colour at its place where it is seen: the
    /// first at `from`, the next a `step` further on.
    ///
    /// A texture may take the steps in coarser units, as long as it is nowhere off by more than 1/16
    /// texel, and the places are the same whatever is seen.
    #[inline(always)]
    fn along<W>(
        &self,
        pixels: &mut [W],
        from: Uv,
        step: Uv,
        visible: &mut impl Visible,
        each: impl FnMut(&mut W, Option<Self::Texel>),
    ) {
        self.singly(pixels, from, step, visible, each);
    }

    /// [`along`](Self::along) for an `each` that takes long: with one loop, in which that is there
    /// once.
    #[inline(always)]
    fn singly<W>(
        &self,
        pixels: &mut [W],
        from: Uv,
        step: Uv,
        visible: &mut impl Visible,
        each: impl FnMut(&mut W, Option<Self::Texel>),
    ) {
        place_by_place(pixels, (from, step), visible, |place| self.at(place), each);
    }

    /// [`along`](Self::along) with all pixels seen.
    #[inline(always)]
    fn run<W>(
        &self,
        pixels: &mut [W],
        from: Uv,
        step: Uv,
        mut each: impl FnMut(&mut W, Self::Texel),
    ) {
        self.along(pixels, from, step, &mut Everywhere, |pixel, texel| {
            if let Some(texel) = texel {
                each(pixel, texel);
            }
        });
    }
}

/// Gives `each` the pixels in turn, each with what is `at` its place where it is seen: the first at
/// `from`, the next a `step` further on.
#[inline(always)]
pub(crate) fn place_by_place<W, T>(
    pixels: &mut [W],
    (from, step): (Uv, Uv),
    visible: &mut impl Visible,
    mut at: impl FnMut(Uv) -> T,
    mut each: impl FnMut(&mut W, Option<T>),
) {
    let mut place = from;
    visible.each(pixels, |pixel, shown| {
        each(pixel, shown.then(|| at(place)));
        place = place.plus(step);
    });
}

impl<T: Texels + ?Sized> Texels for &T {
    type Texel = T::Texel;
    const LONG: bool = T::LONG;

    #[inline(always)]
    fn at(&self, place: Uv) -> T::Texel {
        (**self).at(place)
    }

    fn period(&self) -> Period {
        (**self).period()
    }

    #[inline(always)]
    fn fetches(&self) -> u32 {
        (**self).fetches()
    }

    #[inline(always)]
    fn along<W>(
        &self,
        pixels: &mut [W],
        from: Uv,
        step: Uv,
        visible: &mut impl Visible,
        each: impl FnMut(&mut W, Option<T::Texel>),
    ) {
        (**self).along(pixels, from, step, visible, each);
    }

    #[inline(always)]
    fn singly<W>(
        &self,
        pixels: &mut [W],
        from: Uv,
        step: Uv,
        visible: &mut impl Visible,
        each: impl FnMut(&mut W, Option<T::Texel>),
    ) {
        (**self).singly(pixels, from, step, visible, each);
    }
}
