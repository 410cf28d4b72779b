//! What lies over the picture: sprites and painted lines.

#[cfg(feature = "embedded-graphics")]
pub use crate::composite::{Canvas, DrawnLines};
pub use crate::composite::{Ink, LineOverlay, ListOverlays, Overlay, Sprite, UnsortedSprites};
