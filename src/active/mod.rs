//! Which objects are on a scanline (K1, C1-C7).
//!
//! `bucket` files objects under the first line they are on; `list` keeps those that are active,
//! in order of submission, in the cache or, where that is full, in slow memory.

mod bucket;
mod list;

pub use bucket::Buckets;
pub use list::{ActiveList, CacheCounts, Member, Slot, Visitor};
