//! Draw calls that come through input queues, one for each source (K17).
//!
//! Whoever says them is as fast as can be: each source says all that its queue has room for, the last source first, before
//! the scene takes a command. So queues are full all the time, and what is drawn comes in the order of sources all the same.

use crate::calls::{Call, CallError};
use core::task::Poll;
use scanbeam::input::{Command, Input, InputError, InputQueue, Refused, Source};
use scanbeam::look::Look;
use scanbeam::{Camera, Draw, Scene};

/// How many there are.
pub const SOURCES: usize = 4;
/// One more than the commands that a queue has room for.
const PLACES: usize = 3;

/// Who says some of the calls.
struct Producer<'q, 'c> {
    source: Source<'q, 'c, i32>,
    calls: &'c [Call<'c>],
    /// Whether it has said that there is nothing more.
    has_ended: bool,
}

impl<'c> Producer<'_, 'c> {
    /// Says all that there is room for.
    fn say(&mut self) {
        while let Some((call, rest)) = self.calls.split_first() {
            let own = call
                .said()
                .filter(|(source, _)| *source == self.source.id());
            if own.is_some_and(|(_, draw)| self.source.send(Command::Draw(*draw)).is_err()) {
                return;
            }
            self.calls = rest;
        }
        self.has_ended = self.has_ended || self.source.send(Command::EndOfFrame).is_ok();
    }
}

impl<'c> Call<'c> {
    /// Who says it, and what it draws, if it may come through a queue.
    fn said(&self) -> Option<(u8, &Draw<'c, 'c, i32>)> {
        match self {
            Self::Said(source, draw) => Some((*source, draw)),
            Self::Mesh(draw) => Some((0, draw)),
            Self::Volume(..) => None,
        }
    }
}

/// Begins a scene and draws calls, which are in the order of their sources.
///
/// # Errors
/// What the scene says, and of which call.
pub(crate) fn draw<'c, L: Look>(
    calls: &'c [Call<'c>],
    camera: &Camera,
    scene: &mut Scene<'_, 'c, L>,
) -> Result<(), CallError> {
    let mut queues = [const { InputQueue::<i32, PLACES>::new() }; SOURCES];
    let mut ids = 0..;
    let ends = queues
        .each_mut()
        .map(|queue| queue.split(ids.next().unwrap_or(0)));
    let [(a, x), (b, y), (c, z), (d, w)] = ends;
    let mut input = Input::new([x, y, z, w]);
    let mut producers = [a, b, c, d].map(|source| Producer {
        source,
        calls,
        has_ended: false,
    });
    let [first, ..] = &mut producers;
    // There is room in an empty queue.
    let _ = first.source.send(Command::Begin(*camera));
    for taken in 0.. {
        producers.iter_mut().rev().for_each(Producer::say);
        match input.drain(scene, 1) {
            Poll::Pending => {}
            Poll::Ready(Ok(())) => break,
            Poll::Ready(Err(InputError { source, error })) => {
                return Err(match error {
                    Refused::Begin(error) => CallError::Begin(error),
                    // Before it came the camera, and an end of each source before.
                    Refused::Draw(error) => CallError::Draw(taken - 1 - usize::from(source), error),
                });
            }
        }
    }
    Ok(())
}
