//! Several renderers that draw one scene, each its own lines.

pub use crate::active::Interleave;
pub use crate::renderer::{Crew, LineSource, Prefetched};
