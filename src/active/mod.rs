//! Which objects are on a scanline (K1, C1-C8).
//!
//! `bucket` files objects under the first line they are on; `list` keeps those that are active,
//! in order of submission, in the cache or, where that is full, in slow memory; `interleave` says which lines are a renderer's own.

mod bucket;
mod cache;
mod interleave;
mod list;
mod slot;

pub use bucket::Buckets;
pub use cache::Slot as CacheSlot;
pub use cache::{Cache, CacheUse};
pub(crate) use cache::{Change, next};
pub use interleave::Interleave;
pub use list::ActiveList;
pub use slot::{Member, Slot, Visitor};
