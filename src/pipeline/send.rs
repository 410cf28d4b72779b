//! Frames beyond [`draw_frame`](crate::pipeline::draw_frame): of lines that somebody else draws.

pub use crate::renderer::send_frame;
