//! Scenes from data: instruction lists that are run ([`list`](crate::list) says what they are), and
//! commands that come through a queue.

pub use crate::renderer::{
    Command, EightLights, Input, InputError, InputQueue, ListCoordinate, ListLights, ListMemory,
    ListRunner, ListSettings, OnViolation, OneLight, RunCounts, Source, Stalled, Stream,
};
