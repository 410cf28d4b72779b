//! What lies over the picture: sprites and painted lines (K14).

#[cfg(feature = "embedded-graphics")]
mod canvas;
mod listed;
mod sprites;

#[cfg(feature = "embedded-graphics")]
pub use canvas::Canvas;
pub use listed::ListOverlays;
pub use sprites::{Ink, Overlay, Pixels, Sprite, UnsortedSprites};
