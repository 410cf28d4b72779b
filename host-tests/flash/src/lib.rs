//! A scene of the tool as words in flash: the host writes them, the host and the firmware draw them, by the same calls.
//!
//! All words are little-endian. First comes a [`Head`], [`Head::WORDS`] of them; then what its [`Kind`] has:
//!
//! | kind | what follows |
//! |---|---|
//! | draw calls | lights, palettes, textures and draw calls: see `calls.rs`, `lights.rs` and `textures.rs` |
//! | a list | an instruction list, and what its player is lent: see `list.rs` |
//!
//! Tables of a mesh are read where they lie. An instruction list alone would not do: it has no depth functions, no
//! blends that add or take away, no priorities and no dither, all of which a scene file has.
#![no_std]
#![forbid(unsafe_code)]

mod calls;
mod head;
mod lights;
mod list;
mod reader;
mod sources;
mod textures;

pub use calls::{Call, CallError, CallMemory, Calls, Counts, Palette, VolumeMemory, code};
pub use head::{FLASH_AT, FLASH_BYTES, Head, Kind, Room};
pub use lights::{LightCounts, LightMemory, Lights};
pub use list::{List, ListRoom, PlayError};
pub use reader::{FlashError, Reader};
pub use sources::SOURCES;
pub use textures::{CACHED, Level, Sheet, TextureCounts, TextureMemory, Textures, form};
