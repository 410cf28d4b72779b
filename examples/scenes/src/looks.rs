//! The looks that the scenes are drawn with.

use scanbeam::look::{Gouraud, Textured};
use scanbeam::pixel::{Rgb565Be, Rgb888};

/// Smooth colours, as an SPI panel takes them.
pub type SmoothLook = Gouraud<Rgb565Be>;

/// What scenes with a texture are drawn with.
pub type TexturedLook = Textured<Rgb565Be>;

/// Smooth colours of 24 bits.
pub type TrueColourLook = Gouraud<Rgb888>;

/// What scenes with a texture are drawn with in 24 bits.
pub type TrueColourTexturedLook = Textured<Rgb888>;
