//! The conductor: pass one into a [`Scene`], pass two line by line out of it (K1, K12).
//!
//! `lines` draws, `order` from front to back where it can (X3), and
//! `words` draws depth and colour in one word (K8), `place` fetches ahead (C4), `transparent` draws what has a finish
//! (K11); `frame` sends what one renderer draws, `crew` what several do in turn (K16, X6).

mod crew;
mod deferred;
mod error;
mod filing;
mod frame;
mod instance;
mod lines;
mod order;
mod pile;
mod place;
mod scene;
mod spans;
mod transparent;
mod words;

pub use crew::Crew;
pub use error::{DrawError, RendererError, SceneError};
pub use frame::{FrameError, FrameStats, LineSource, draw_frame, send_frame};
pub use instance::Instance;
pub use lines::{DepthUse, LineMemory, LineRenderer};
pub use place::Prefetched;
pub use scene::{Scene, SceneMemory};
