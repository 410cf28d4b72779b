//! The looks that the scenes are drawn with.

use scanbeam::look::{Gouraud, Textured};
use scanbeam::pixel::Rgb565Be;

/// Smooth colours, as an SPI panel takes them.
pub type SmoothLook = Gouraud<Rgb565Be>;

/// What scenes with a texture are drawn with.
pub type TexturedLook = Textured<Rgb565Be>;
