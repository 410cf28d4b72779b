//! The laboratory: ways to draw that the renderer does not take, since another is cheaper or more exact at once.
//!
//! Their errors and costs are measured beside the renderer's own (`scanbeam accuracy`), and some of them can be
//! seen (`render --interp`, `render --depth`).
//!
//! | file | there | rows |
//! |---|---|---|
//! | `format.rs` | pixels of 16 and 24 bits, and channels packed into words that step | P4 |
//! | `colours.rs` | colours along a span: values and steps | P3 |
//! | `method.rs` | which method takes colours from pixel to pixel, and the choice by a budget | X2 |
//! | `paint.rs` | each method's loop | K6, K7, P3 |
//! | `kept.rs` | colours of spans that are kept from line to line | P3 |
//! | `lirp.rs` | LIRP from end to end of a span | K6, K7 |
//! | `depth.rs` | what is kept of 1/w, and lines of it | H2, K8 |
//! | `reciprocal.rs`, `perspective.rs` | texture places along spans | H4, H5, K18 |
//! | `lines.rs` | lines of triangles by any of these methods | K4, K5 |
//! | `bits.rs` | all of it as one number, for other targets | X1 |
//!
//! All of it is fixed point, the same bits on every target.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

pub mod bits;
pub mod colours;
pub mod depth;
pub mod format;
pub mod kept;
pub mod lines;
mod lirp;
pub mod method;
pub mod paint;
pub mod perspective;
mod reciprocal;
#[cfg(test)]
mod tests;

pub use colours::Colours;
pub use depth::DepthMethod;
pub use format::Format;
pub use lines::{Counts, Triangle, draw_line};
pub use method::Method;
pub use paint::paint;
