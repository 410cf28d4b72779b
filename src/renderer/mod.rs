//! The conductor: pass one into a [`Scene`], pass two line by line out of it (K1, K12).
//!
//! `input` feeds pass one from queues (K17), `immediate` from plain slices; `lines` draws, `order` from front to back where it can (X3), and
//! `words` draws depth and colour in one word (K8), `place` fetches ahead (C4), `transparent` draws what has a finish (K11, K9), `priority` what has
//! priorities (P1); `frame` sends what one renderer draws, `overlay` with what is painted over it
//! (K14), `palette` by way of a palette for each line (H18), `crew` what several do in turn (K16, X6).

mod crew;
mod deferred;
mod error;
mod filing;
mod frame;
mod immediate;
mod input;
mod instance;
mod lines;
mod order;
mod overlay;
mod palette;
mod pile;
mod place;
mod priority;
mod scene;
mod shadow;
mod spans;
mod transparent;
mod words;

pub use crew::Crew;
pub use error::{DrawError, RendererError, SceneError};
pub use frame::{
    FrameError, FrameStats, LineSource, draw_frame, draw_frame_changed, draw_frame_changed_runs,
    send_changed, send_changed_runs, send_frame,
};
pub use immediate::Vertices;
pub use input::{Command, Input, InputError, InputQueue, Source, Stalled, Stream};
pub use instance::Instance;
pub use lines::{DepthUse, LineMemory, LineRenderer};
pub use overlay::{Overlaid, draw_frame_overlaid, draw_frame_overlaid_changed};
pub use palette::{draw_frame_indexed, send_frame_indexed};
pub use place::Prefetched;
pub use scene::{Scene, SceneMemory};
pub use shadow::ShadowError;
