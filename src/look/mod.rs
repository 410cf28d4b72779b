//! What colours a span: one file a look, readable from top to bottom.
//!
//! | file | there |
//! |---|---|
//! | `paint` | what a look does, and what it is told |
//! | `gouraud` | colours linear between vertices |
//! | `ramp` | the loops over pixels that all looks share, with depth and without |

mod gouraud;
mod paint;
mod ramp;

pub use gouraud::Gouraud;
pub(crate) use paint::{Depths, Fill, Paint, Parts, Place, ThinSpan, WordOf};
pub(crate) use ramp::write_depth;

/// How the triangles of a scene look: [`Gouraud`].
pub trait Look: Paint {}

impl<T: Paint> Look for T {}
