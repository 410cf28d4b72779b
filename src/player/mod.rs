//! Lists executed into a scene of the rooms [`scene`](crate::scene), [`look`](crate::look) and
//! [`frame`](crate::frame) (H11-H13, H16, X7).
//!
//! A [`Player`] walks a [`list`](crate::list) block by block. Blocks of state change one [`Draw`](crate::scene::Draw)
//! value; what blocks of vertices hold is drawn with it, so a list gives the same bits as the same calls. What a player
//! does not have is an error that names the block, before anything of the list is drawn.
//!
//! | file | there |
//! |---|---|
//! | `play` | the player: settings, commands, halts |
//! | `blocks` | what each block does |
//! | `state` | the draw call that blocks change |
//! | `textures` | textures of a list as values of the rooms |
//! | `gather` | vertices into meshes |
//! | `long` | vertices that were set up beforehand |
//! | `lights` | several lights, whose code only a player that has room for them brings in |
//! | `shadows` | shadows that what is drawn casts, likewise |
//! | `outcome` | what was done |
//! | `queue` | draw calls and cameras that come through queues, without a list |

mod blocks;
mod gather;
mod lights;
mod long;
mod outcome;
mod play;
mod queue;
mod shadows;
mod state;
#[cfg(test)]
mod tests;
mod textures;

pub use lights::LightRoom;
pub use outcome::{OnViolation, RunCounts};
pub use play::{Player, PlayerMemory, PlayerSettings};
pub use queue::{Command, Input, InputError, InputQueue, Refused, Source, Stream};
pub use textures::TextureRoom;
