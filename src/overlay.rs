//! What lies over the picture: sprites and painted lines.

#[cfg(feature = "embedded-graphics")]
pub use crate::composite::{Canvas, DrawnLines};
pub use crate::composite::{Ink, LineOverlay, ListOverlays, Overlay, Sprite, UnsortedSprites};
pub use crate::renderer::{Overlaid, draw_frame_overlaid, draw_frame_overlaid_changed};
