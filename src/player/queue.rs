//! The input queues between producers and a scene (K17).
//!
//! Every source (an interrupt, another core, a parser of lists) has a bounded queue of its own
//! with one producer and one consumer, so that it needs no lock. A full queue stalls its source:
//! the command is handed back, nothing is lost. A scene drains the sources one after the
//! other, each to its end of the frame, so that the order of submission, and with it the picture,
//! depends on what was said and never on who was faster. Commands are whole: draw calls with all that they have, and
//! cameras.

use crate::geometry::{Camera, Coordinate};
use crate::look::Look;
use crate::scene::{BeginError, Draw, DrawError, Scene};
use core::task::Poll;
use heapless::spsc::{Consumer, Producer, Queue};

/// What a source can say.
#[derive(Clone, Copy, Debug)]
pub enum Command<'c, C: Coordinate = i16> {
    /// Begin the scene anew, seen by a camera: of several sources the first one says so first.
    Begin(Camera),
    /// A draw call: what it names stays where it is.
    Draw(Draw<'c, 'c, C>),
    /// This source has nothing more for this frame.
    EndOfFrame,
}

/// The queue of one source, with room for `N - 1` commands.
#[derive(Debug)]
pub struct InputQueue<'c, C: Coordinate, const N: usize>(Queue<Command<'c, C>, N>);

impl<'c, C: Coordinate, const N: usize> InputQueue<'c, C, N> {
    /// An empty queue.
    #[must_use]
    pub const fn new() -> Self {
        Self(Queue::new())
    }

    /// The end for the producer, which is source `id`, and the one for the scene.
    pub fn split(&mut self, id: u8) -> (Source<'_, 'c, C>, Stream<'_, 'c, C>) {
        let (producer, consumer) = self.0.split();
        (Source { id, producer }, Stream { id, consumer })
    }
}

impl<C: Coordinate, const N: usize> Default for InputQueue<'_, C, N> {
    fn default() -> Self {
        Self::new()
    }
}

/// The producer's end of an [`InputQueue`].
pub struct Source<'q, 'c, C: Coordinate = i16> {
    id: u8,
    producer: Producer<'q, Command<'c, C>>,
}

impl<'c, C: Coordinate> Source<'_, 'c, C> {
    /// The number that errors name this source by.
    #[must_use]
    pub fn id(&self) -> u8 {
        self.id
    }

    /// STALL: whether the next command would be handed back.
    #[must_use]
    pub fn stall(&self) -> bool {
        !self.producer.ready()
    }

    /// EMPTY: whether everything was taken.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.producer.is_empty()
    }

    /// Sends a command.
    ///
    /// # Errors
    /// When the queue is full: the command comes back, to be sent again later.
    #[expect(
        clippy::result_large_err,
        reason = "the command comes back whole, and there is no heap to keep it in"
    )]
    pub fn send(&mut self, command: Command<'c, C>) -> Result<(), Command<'c, C>> {
        self.producer.enqueue(command)
    }
}

/// The scene's end of an [`InputQueue`].
pub struct Stream<'q, 'c, C: Coordinate = i16> {
    id: u8,
    consumer: Consumer<'q, Command<'c, C>>,
}

impl<C: Coordinate> Stream<'_, '_, C> {
    /// EMPTY: whether nothing waits.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.consumer.is_empty()
    }
}

/// What a scene refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Refused {
    /// To be begun.
    Begin(BeginError),
    /// A draw call, or some of it.
    Draw(DrawError),
}

/// A command that could not be executed, and whose it was. It has been taken from its queue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct InputError {
    /// The source.
    pub source: u8,
    /// Why.
    pub error: Refused,
}

impl core::fmt::Display for InputError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "source {}: ", self.source)?;
        match self.error {
            Refused::Begin(error) => error.fmt(f),
            Refused::Draw(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for InputError {}

/// The streams of `S` sources, in the order in which their objects are submitted.
pub struct Input<'q, 'c, C: Coordinate, const S: usize> {
    streams: [Stream<'q, 'c, C>; S],
    /// The stream whose turn it is; those before it have ended the frame. Below `S`, or 0.
    at: usize,
}

impl<'q, 'c, C: Coordinate, const S: usize> Input<'q, 'c, C, S> {
    /// Of the streams, the first goes first.
    #[must_use]
    pub const fn new(streams: [Stream<'q, 'c, C>; S]) -> Self {
        Self { streams, at: 0 }
    }

    /// EMPTY: whether no source has anything waiting.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.streams.iter().all(Stream::is_empty)
    }

    /// Executes at most `budget` of the commands that wait in `scene`; `Ready` when every source
    /// has ended the frame, and the next call begins with the next frame's commands.
    ///
    /// # Errors
    /// When the scene cannot be begun, or a call cannot be drawn, or not whole; calling again goes on with the next
    /// command.
    pub fn drain<L: Look>(
        &mut self,
        scene: &mut Scene<'_, 'c, L>,
        budget: u32,
    ) -> Poll<Result<(), InputError>> {
        for _ in 0..budget {
            let Some(stream) = self.streams.get_mut(self.at) else {
                break;
            };
            let done = match stream.consumer.dequeue() {
                Some(Command::Begin(camera)) => scene.begin(&camera).map_err(Refused::Begin),
                Some(Command::Draw(draw)) => scene.draw(&draw).map_err(Refused::Draw),
                Some(Command::EndOfFrame) => {
                    self.at += 1;
                    if self.at == S {
                        self.at = 0;
                        return Poll::Ready(Ok(()));
                    }
                    Ok(())
                }
                None => return Poll::Pending,
            };
            if let Err(error) = done {
                let source = stream.id;
                return Poll::Ready(Err(InputError { source, error }));
            }
        }
        if S == 0 {
            return Poll::Ready(Ok(()));
        }
        Poll::Pending
    }
}
