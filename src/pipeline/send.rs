//! Frames beyond [`draw_frame`](crate::pipeline::draw_frame): of lines that somebody else draws, of what has changed, of
//! palette indices.

pub use crate::renderer::{
    draw_frame_changed, draw_frame_changed_runs, draw_frame_indexed, send_changed,
    send_changed_runs, send_frame, send_frame_indexed,
};
