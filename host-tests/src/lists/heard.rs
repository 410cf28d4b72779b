//! What players tell of lists, counted by kind.

use scanbeam::event::{Event, Notice};
use std::fmt::Display;

/// Kinds of events, the offset of the first of each, and how many there are.
pub type Heard = Vec<(Event, u32, u32)>;

/// Counts a notice.
pub fn hear(heard: &mut Heard, notice: Notice) {
    match heard.iter_mut().find(|kind| kind.0 == notice.event) {
        Some(known) => known.2 += 1,
        None => heard.push((notice.event, notice.offset, 1)),
    }
}

/// What is worth telling: a list ends, and triangles are cut, in every picture.
pub fn keep_unusual(heard: &mut Heard) {
    heard.retain(|kind| !matches!(kind.0, Event::ListEnd | Event::Clipped));
}

/// Tells them of a file, a line a kind.
pub fn tell_all(file: impl Display, heard: &Heard) {
    for (event, offset, times) in heard {
        tell!("warning: {file}: {event:?}, first at offset {offset:#x}, {times} times");
    }
}
