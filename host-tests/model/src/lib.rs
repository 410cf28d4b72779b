//! The hardware told bit for bit: a scanline renderer of tokens, as a pipeline of its own (K13).
//!
//! The fast path of `scanbeam` takes its ideas from a rendering device of three chips. This is
//! that device, to the bit: the widths, roundings and saturations of its circuits, the layouts
//! of its tokens, its two line buffers a unit. It is here to be measured against, and to be
//! read; it knows nothing of the fast kernels, and they nothing of it.
//!
//! | file | what | rows |
//! |---|---|---|
//! | `lirp` | the blend of selectors and adders | K7 |
//! | `weight` | the vertical divider, the circuit of W(X) | K5, K6 |
//! | `format` | input and processing formats, conversions | K15 |
//! | `block_fix` | depth in 16 bits: a range a triangle, and a significand | H2 |
//! | `vertex` | the loadable table that describes a vertex, the parameter memories | K15 |
//! | `layout` | charts A to L, field by field | K13 |
//! | `token` | tokens understood, encode and decode | K13 |
//! | `walker` | stage one: active edges, span ends, set-up and pixel tokens | K4-K6 |
//! | `stage` | stages two and three: depth, shadow counts, colour, compositing | K8, K9, K11 |
//! | `buffers` | double buffers and their DMA | K12 |
//! | `interpreter` | the pipeline, a token a clock | K12-K14 |
//! | `render` | whole scenes through it | S4, M1 |
//! | `cusp` | clipped triangles as a left and a right chain | P2 |
//! | `priority` | the contest of priorities, bit by bit | P6 |
//! | `exact` | where an edge meets a line, by division | K4 |
//! | `edge_function` | inside or outside by linear functions | B4 |
//! | `traverse` | a triangle by blocks, clusters and several renderers | B2, B3, B6 |
//!
//! Where the charts and the text leave something open, the file says what was chosen. Depth has
//! 32 bits and less is nearer. Levels have 8 bits outside, 9 in set-up tokens and 10 in pixels;
//! they grow by repeating their top bits, so full is full everywhere.

#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

mod block_fix;
mod buffers;
mod cusp;
mod edge_function;
mod exact;
mod format;
mod interpreter;
mod layout;
mod lirp;
mod priority;
#[cfg(test)]
mod random;
mod render;
mod stage;
#[cfg(test)]
mod tests;
mod token;
mod traverse;
mod vertex;
mod walker;
mod weight;

pub use block_fix::BlockFix16;
pub use buffers::{LineBuffers, Word40};
pub use cusp::{Cusp, CuspPolygon, CuspSide};
pub use edge_function::{EdgeFunction, EdgeFunctions};
pub use format::{InputFormat, ProcessingFormat, WORD_BITS, Word36, round_to_8, widen};
pub use interpreter::{Output, Pipe, PipeCounts, PipeMemory};
pub use layout::{CHARTS, CONTROL, Chart, Field, TOKEN_BITS, TokenBits};
pub use lirp::{EDGE_BITS, SPAN_BITS, lirp, lirp_by_selectors};
pub use priority::{Decision, Wins, priority_contest, priority_stage};
pub use render::{
    ModelError, ModelFrameError, ModelRenderer, SCENE_VERTEX, SEGMENT, draw_model_frame,
};
pub use stage::{CompositingUnit, ZUnit};
pub use token::{
    Argb10, GlobalMode, ParameterSetup, PixelToken, StartDma, Target, Token, TokenError, ZSetup,
};
pub use traverse::{Cluster, Grid, Traversal};
pub use vertex::{
    Entry, FormatError, FormatWord, PARAMETERS, PLACE, ParameterRam, STREAMS, VERTICES,
    VertexFormat,
};
pub use walker::{ActiveEdge, ModelSpan, Segment, ZFlags, draw};
pub use weight::{SpanWeight, divided_weight, vertical_weight};
