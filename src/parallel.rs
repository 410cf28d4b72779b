//! Several renderers that draw one scene, on cores or threads, and the queues between them.

pub use crate::active::Interleave;
pub use crate::renderer::{Crew, LineDesk, LineSource, LineWorker, Prefetched, Relay};
