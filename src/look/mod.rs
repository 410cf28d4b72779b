//! What colours a span: one file a look, readable from top to bottom.
//!
//! | file | there |
//! |---|---|
//! | `paint` | what a look does, and what it is told |
//! | `gouraud` | colours linear between vertices |
//! | `fields` | the fields of words of colour |
//! | `course` | a colour along a span |
//! | `textured`, `textured_wide` | texels times such colours, in pixels of 16 bits and of more |
//! | `shades` | the planes of those colours, and what they are along a span |
//! | `phong`, `textured_phong` | normals linear between vertices, lit at each pixel; texels lit so |
//! | `shaded` | pixels by a function of one's own, from parameters of vertices |
//! | `ramp` | the loops over pixels that all looks share |
//! | `mapping` | texture coordinates of a triangle: affine or in perspective, and its planes |
//! | `word_plane` | both coordinates of a small affine triangle in one word |
//! | `fetch` | texels along a way that is linear on the texture |
//! | `bent` | texels along a parabola |
//! | `perspective` | a span in perspective: exact places at its ends or every 16 to 1 pixels, fetched between |
//! | `stride` | how far these exact places may be apart |
//! | `sampling` | levels of detail: where each begins along a span |
//! | `linear` | the weighted mean of four texels, and levels of detail made of means |
//! | `tint` | texels times a shade, in place |
//!
//! A textured span is a sum of two passes over its pixels: a fetcher writes plain texels, then a
//! tint multiplies them by the shade, where that is not full light. Neither knows of the other, so
//! code is a sum of the two and not a product, and neither spills registers.

mod area;
mod bent;
mod course;
mod dither;
mod fetch;
mod fields;
mod gouraud;
mod linear;
mod mapping;
mod paint;
mod perspective;
mod phong;
mod ramp;
mod sampling;
mod shaded;
mod shades;
mod stride;
#[cfg(test)]
mod tests;
mod textured;
mod textured_phong;
mod textured_wide;
mod tint;
mod word_plane;

pub use gouraud::Gouraud;
pub use linear::halved;
pub use paint::Look;
pub(crate) use paint::{Fill, Parts, Place, Primitive, States, ThinSpan, WordOf, check_blend};
pub use phong::Phong;
pub(crate) use ramp::fill_even;
pub use shaded::{Shaded, Shader};
pub use textured::Textured;
pub use textured_phong::TexturedPhong;
