//! The looks that the scenes are drawn with.

use scanbeam::look::{Gouraud, Textured, TexturedPhong};
use scanbeam::pixel::{Grey8, Rgb565, Rgb565Be, Rgb888, Xrgb8888};

/// Smooth colours, as an SPI panel takes them.
pub type SmoothLook = Gouraud<Rgb565Be>;

/// What scenes with a texture are drawn with.
pub type TexturedLook = Textured<Rgb565Be>;

/// Smooth colours of 24 bits.
pub type TrueColourLook = Gouraud<Rgb888>;

/// What scenes with a texture are drawn with in 24 bits.
pub type TrueColourTexturedLook = Textured<Rgb888>;

/// Texels lit at each pixel in 24 bits.
pub type LitBytesLook = TexturedPhong<Rgb888>;
/// The same in words of 32 bits.
pub type LitWordsLook = TexturedPhong<Xrgb8888>;
/// Smooth grey.
pub type GreyLook = Gouraud<Grey8>;
/// Smooth colours in numbers of 16 bits.
pub type NumbersLook = Gouraud<Rgb565>;
