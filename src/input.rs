//! Scenes from data: instruction lists that are run ([`list`](crate::list) says what they are), and
//! commands that come through a queue.
//!
//! A list is executed where it lies:
//!
//! ```
//! use scanbeam::event::Notice;
//! use scanbeam::input::{ListMemory, ListRunner, ListSettings};
//! use scanbeam::list::{Budget, words_of};
//! use scanbeam::pipeline::{Pipeline, Scene};
//!
//! /// `bytes` come from `include_list!("teapot.list")`; the memory is for one table of the list.
//! fn draw<P: Pipeline>(
//!     scene: &mut Scene<P>,
//!     bytes: &'static [u8],
//! ) -> Result<(), Box<dyn std::error::Error>> {
//!     let memory = ListMemory {
//!         positions: &mut [[0i16; 3]; 255],
//!         normals: &mut [[0; 3]; 255],
//!         indices: &mut [0; 1536],
//!         ..ListMemory::default()
//!     };
//!     let mut runner = ListRunner::new(memory, ListSettings::default());
//!     runner.start(0);
//!     let mut budget = Budget::of(10_000);
//!     // Notices say what was left out; an error says which block is malformed, and where.
//!     runner.run(words_of(bytes)?, scene, &mut budget, &mut |notice: Notice| println!("{notice:?}"))?;
//!     Ok(())
//! }
//! ```
//!
//! A [`Player`] does the same for a [`scene::Scene`](crate::scene::Scene): see there.

pub use crate::player::{
    LightRoom, ListCoordinate, OnViolation, Player, PlayerMemory, PlayerSettings, RunCounts,
    TextureRoom,
};
pub use crate::renderer::{
    Command, EightLights, Input, InputError, InputQueue, ListLights, ListMemory, ListRunner,
    ListSettings, OneLight, Source, Stalled, Stream,
};
