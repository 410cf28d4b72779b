//! Pass two: lines, and whole frames of them (K1, K5, K12, K16).
//!
//! | file | there |
//! |---|---|
//! | `renderer` | what draws lines: its memory, its errors |
//! | `advance` | from line to line: which triangles begin, turn and end |
//! | `ahead` | triangles set up before their line comes |
//! | `alone` | a triangle without a slot |
//! | `line` | one line: who is seen, and its pixels |
//! | `scene` | a scene made for a look |
//! | `slot` | a triangle in a slot of the cache |
//! | `thin` | planes of depth, and what is too thin for planes |
//! | `near` | spans that meet others, from the nearest on |
//! | `meet` | where spans meet |
//! | `plan` | an order that lasts from line to line |
//! | `guests` | of these, what has no slot |
//! | `dense` | lines with many of these |
//! | `rival` | who of two spans is seen |
//! | `spans` | the pixels of a span |
//! | `values` | lines with draw calls that have values few have |
//! | `rank` | the order of their spans |
//! | `spilled` | what of them has no slot |
//! | `ruled` | pixels of such a span |
//! | `alpha` | the alpha of vertices along it |
//! | `shadow` | shadow volumes, and what their lights fall on |
//! | `translucent` | spans that what is behind shines through, from far to near |
//! | `tally` | spans and pixels, counted |
//! | `send` | all lines of a frame, with overlays, through a pump, awaited, or to a panel with a clock of its own |
//! | `changed` | likewise, what has changed alone |
//! | `pace`, `paced` | lines that cost no more than they may |
//! | `runs` | who is seen on them, run by run |
//! | `evenly` | the colours of these runs, all or one |
//! | `palette` | likewise, of pixels that are numbers of a palette |
//! | `relay` | a frame of two cores |

mod advance;
mod ahead;
mod alone;
mod alpha;
mod changed;
mod dense;
mod evenly;
mod guests;
mod line;
mod meet;
mod near;
mod pace;
mod paced;
mod palette;
mod plan;
mod rank;
mod relay;
mod renderer;
mod rival;
mod ruled;
mod runs;
mod scene;
mod send;
mod shadow;
mod slot;
mod spans;
mod spilled;
mod tally;
#[cfg(test)]
mod tests;
mod thin;
mod translucent;
mod values;

pub use crate::active::{CacheUse, Interleave};
pub use changed::{draw_frame_changed, draw_frame_changed_runs};
pub use pace::{Pace, Paid};
pub use palette::draw_frame_indexed;
pub use relay::{Desk, Peer, Relay, Worker, draw_frame_shared};
pub use renderer::{FastMemory, LineError, Memory, Renderer};
#[cfg(feature = "async")]
pub use send::draw_frame_async;
pub use send::{FrameError, FrameUse, draw_continuous, draw_frame, draw_frame_overlaid};
