//! Frames beyond [`draw_frame`](crate::draw_frame): of lines that somebody else draws, of what has
//! changed, of palette indices, without end, or awaited.

pub use crate::renderer::{
    draw_continuous, draw_frame_changed, draw_frame_changed_runs, draw_frame_indexed, send_changed,
    send_changed_runs, send_frame, send_frame_indexed,
};
#[cfg(feature = "async")]
pub use crate::renderer::{draw_frame_async, send_frame_async};
