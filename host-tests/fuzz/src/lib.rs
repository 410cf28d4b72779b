//! What the fuzz targets try, as plain functions of bytes, so that tests can run them too.
//!
//! | file | bytes become | what must hold |
//! |---|---|---|
//! | `frames.rs` | a screen, a camera, matrices, light, some triangles, memory sizes | set-up to pixels: no panic, the same picture in every memory and order, no colour outside its corners |
//! | `formats.rs` | tokens, format RAM, vertices of the hardware model | decode is total, `encode(decode(x))` is stable |
//! | `files.rs` | a model file and its material file | a model in which all is in range, or one line that says where it is wrong |
//! | `list.rs` | the words of an instruction list | no panic, and no more work than the budget has |
//!
//! With cargo-fuzz, in `host-tests`: `cargo +nightly fuzz run frames`. Without it, on stable:
//! `bash .ci/fuzz 60` builds the targets and runs each for so many seconds, as CI does.
//!
//! `host-tests/tests/fuzz.rs` runs the same functions on random bytes and on everything that was ever found.

// Overflow checks go with them: both are set for release in this package.
const _: () = assert!(cfg!(debug_assertions), "build with debug assertions");

pub mod files;
pub mod formats;
pub mod frames;
pub mod list;
// What the reader of models says, where it says something.
#[macro_use]
#[path = "../../support/src/stdio.rs"]
pub mod stdio;
// The file itself, not the package: its dependencies would take longer to build than the rest.
#[path = "../../support/src/model/mod.rs"]
pub mod model;
