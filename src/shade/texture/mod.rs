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
//! | `sample` | textures: size, wrap, mirror, clamp, nearest, bilinear | H6 |
//! | `lod` | four levels of detail, built | H6 |
//! | `block` | layouts of texture memory, runs inside a block | B1, B5 |
//! | `cache` | a small cache of blocks, with counters | B5 |
//! | `procedural` | textures that are computed | H17 |
//!
//! Everything that can vary is a type, so what a pipeline does not name has no code: a texture is
//! anything that is [`Texels`].

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
    Budget, Corner, Corners, Detail, FRACTION, Homogeneous, LEVELS, LevelEnds, Quality, Skin,
    TexturePlanes, Textured, Uv,
};
pub use block::{BlockRun, BlockRuns, Blocked, Layout, Linear};
pub use cache::{BlockCache, CacheError, CacheReads};
pub use format::{Rgb565Texel, Rgb888Texel, Rgba5551, Rgba8871, Rgbd5551, Texel, TexelFormat};
pub use lod::{Level, Levels, build_level, level_words};
pub use perspective::{AllSeen, PaintRun, PerspectiveSpan, Stride};
pub use procedural::{Checker, Gradient};
pub use sample::{
    Address, Bilinear, Clamp, MAX_SIDE, Mirror, Size, Square, Texture, TextureError, Wrap,
};
pub use tlut::{Indexed, Store, Words};

/// A texture: what colour is where.
///
/// Only [`at`](Texels::at) has to be there, as for a texture that is computed (H17). One that lies
/// in memory says with [`run`](Texels::run) how it is best read along a straight way.
pub trait Texels {
    /// What is found at a place: a word of the display, an expanded [`Texel`], a level.
    type Texel: Copy;

    /// The colour at a place.
    fn at(&self, place: Uv) -> Self::Texel;

    /// Stored texels that [`at`](Texels::at) reads.
    #[inline(always)]
    fn fetches(&self) -> u32 {
        1
    }

    /// Gives `each` the pixels in turn, each with the colour at its place: the first at `from`,
    /// the next a `step` further on.
    ///
    /// A texture may take the steps in coarser units, as long as it is nowhere off by more than 1/16
    /// texel.
    #[inline(always)]
    fn run<W>(
        &self,
        pixels: &mut [W],
        from: Uv,
        step: Uv,
        mut each: impl FnMut(&mut W, Self::Texel),
    ) {
        let mut place = from;
        for pixel in pixels {
            each(pixel, self.at(place));
            place = place.plus(step);
        }
    }
}

impl<T: Texels + ?Sized> Texels for &T {
    type Texel = T::Texel;

    #[inline(always)]
    fn at(&self, place: Uv) -> T::Texel {
        (**self).at(place)
    }

    #[inline(always)]
    fn fetches(&self) -> u32 {
        (**self).fetches()
    }

    #[inline(always)]
    fn run<W>(&self, pixels: &mut [W], from: Uv, step: Uv, each: impl FnMut(&mut W, T::Texel)) {
        (**self).run(pixels, from, step, each);
    }
}
