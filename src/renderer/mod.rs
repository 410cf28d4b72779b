//! The conductor: pass one into a [`Scene`], pass two line by line out of it (K1, K12).

mod frame;
mod lines;
mod scene;
mod spans;

pub use frame::{FrameError, FrameStats, draw_frame};
pub use lines::{LineMemory, LineRenderer, RendererError, SpanRecord};
pub use scene::{DrawError, Instance, PassOne, Scene, SceneError, SceneMemory};
pub(crate) use spans::scale;
