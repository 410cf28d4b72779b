//! Pass two: lines, and whole frames of them (K1, K5, K12, K16).
//!
//! | file | there |
//! |---|---|
//! | `renderer` | what draws lines: its memory, its errors |
//! | `advance` | from line to line: which triangles begin, turn and end |
//! | `line` | one line: who is seen, and its pixels |
//! | `scene` | a scene made for a look |
//! | `slot` | a triangle in a slot of the cache |
//! | `thin` | planes of depth, and what is too thin for planes |
//! | `plan` | the order in which a line is drawn |
//! | `near` | spans that meet others, from the nearest on |
//! | `rival` | who of two spans is seen |
//! | `spans` | the pixels of a span |
//! | `send` | all lines of a frame through a pump |

mod advance;
mod line;
mod near;
mod plan;
mod renderer;
mod rival;
mod scene;
mod send;
mod slot;
mod spans;
mod thin;

pub use renderer::{FastMemory, LineError, Memory, Renderer};
pub use send::{FrameError, FrameUse, draw_frame};
