//! Lists executed into a scene of the rooms [`scene`](crate::scene), [`look`](crate::look) and
//! [`frame`](crate::frame) (H11-H13, H16, X7).
//!
//! A [`Player`] walks a [`list`](crate::list) block by block. Blocks of state change one [`Draw`](crate::scene::Draw)
//! value; what blocks of vertices hold is drawn with it, so a list gives the same bits as the same calls.
//!
//! | of a list | in a draw call |
//! |---|---|
//! | MATRIX | `model`: the list's, then that of the settings |
//! | LIGHT 0, white | `light` |
//! | MATERIAL | `colour`, `cull`, `blend` of its opacity; not lit: no light |
//! | TEXTURE, PALETTE | `texture`: texels where they lie, a palette as the panel has it; what has alpha 0 is transparent |
//! | PRSP | the budget of the settings for texture places, else 1/2 texel |
//! | WINDOW | `scissor` |
//! | nothing | `shading`, `depth`, `dither`, `priority`, `application`, `lamps`: those of the settings |
//!
//! **What a player does not have is refused, never left out**: [`Reason::Missing`](crate::list::Reason::Missing) says
//! what, and where. These are vertices that were set up beforehand, points, overlays, several levels of detail, texels
//! that are neither opaque nor transparent, places of 32 bits, coloured or several lights, highlights, and what the
//! look of the scene cannot have. A list that is started is walked once without drawing, as far as the budget reaches,
//! before any of it is drawn: what is malformed, missing or too large for the memory is an error then, and the scene
//! is as it was. [`ListCommand::Restart`](crate::list::ListCommand) plays the same list again without that walk.
//!
//! | file | there |
//! |---|---|
//! | `play` | the player: settings, commands, halts |
//! | `blocks` | what each block does |
//! | `state` | the draw call that blocks change |
//! | `textures` | textures of a list as values of the rooms |
//! | `gather` | vertices into meshes |
//! | `outcome` | what was done |

mod blocks;
mod gather;
mod outcome;
mod play;
mod state;
mod textures;

pub use gather::ListCoordinate;
pub(crate) use gather::{Gather, Gathered, Out, Places, Refusal, Unpacked, texels};
pub use outcome::{OnViolation, RunCounts};
pub use play::{Player, PlayerMemory, PlayerSettings};
pub use textures::TextureRoom;
