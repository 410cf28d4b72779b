//! Scenes from data: instruction lists that are run ([`list`](crate::list) says what they are), and
//! commands that come through a queue.
//!
//! A [`Player`] executes a list where it lies, into a [`Scene`](crate::scene::Scene): see there.

pub use crate::player::{
    Command, Input, InputError, InputQueue, LightRoom, OnViolation, Player, PlayerMemory,
    PlayerSettings, Refused, RunCounts, Source, Stream, TextureRoom,
};
