//! A scene of the tool as words in flash: the host writes them, the host and the firmware draw them, by the same calls.
//!
//! All words are little-endian. First comes a [`Head`], [`Head::WORDS`] of them; then what its [`Kind`] has:
//!
//! | kind | what follows |
//! |---|---|
//! | smooth, textured, indexed | draw calls: see `calls.rs` |
//! | a list | an instruction list, and what its player is lent: see `list.rs` |
//!
//! Tables of a mesh are read where they lie. An instruction list alone would not do: it has no depth functions, no
//! blends that add or take away, no priorities and no dither, all of which a scene file has.
#![no_std]
#![forbid(unsafe_code)]

mod calls;
mod head;
mod list;
mod reader;

pub use calls::{CallMemory, Calls, Counts, Palette, code};
pub use head::{FLASH_AT, FLASH_BYTES, Head, Kind, Room};
pub use list::{List, ListRoom, PlayError};
pub use reader::{FlashError, Reader};
