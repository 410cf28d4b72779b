//! Which triangles are on a line (C1-C8), and which lines are a renderer's own (B3, K16).
//!
//! `cache` keeps what is active in slots, or, where those are full, in slow memory; `interleave` shares lines out.

mod cache;
mod interleave;

pub use cache::Slot as CacheSlot;
pub use cache::{Cache, CacheUse};
pub(crate) use cache::{Change, next};
pub use interleave::Interleave;
