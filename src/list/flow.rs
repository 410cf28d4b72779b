//! Which block comes next: flow control, immediate commands and the work budget (H12, X7).
//!
//! The walker knows no scene: it hands over what is to be done. So a renderer, a disassembler and a check walk alike.

use super::block::{Flow, Instruction, Run, State};
use super::error::{ListError, Reason};
use super::format::VertexFormat;
use super::header::Id;
use super::reader::{Parsed, read_block};
use super::words::Words;
use crate::event::Event;
use core::sync::atomic::{AtomicU32, Ordering};

/// How much work a list may still cause. Each number goes down to 0, and there the list halts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Budget {
    /// Blocks.
    pub instructions: u32,
    /// Vertices and indices. A block that has more than are left is not begun: below 65,535 some
    /// lists can never go on.
    pub vertices: u32,
    /// Jumps that are taken.
    pub jumps: u32,
}

impl Budget {
    /// So many of each.
    #[must_use]
    pub const fn of(work: u32) -> Self {
        Self {
            instructions: work,
            vertices: work,
            jumps: work,
        }
    }
}

/// Immediate commands (H12).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum ListCommand {
    /// Begin at this word.
    Start(u32),
    /// Begin again where it began last.
    Restart,
    /// Go on where it halted.
    Resume,
    /// Stop before the next block.
    StopNow,
    /// Stop at the end of the list, where a ring would wait for more.
    StopAtEnd,
    /// Do one block, and stop.
    Step,
}

/// Commands that say no place, by their codes. What has another code is a start.
const PLAIN: [ListCommand; 5] = [
    ListCommand::Restart,
    ListCommand::Resume,
    ListCommand::StopNow,
    ListCommand::StopAtEnd,
    ListCommand::Step,
];

/// A letter box for commands from an interrupt or another core, by one sender to one player: one at a time, the last
/// counts. One that is replaced while it is taken may still be obeyed, before the last.
#[derive(Debug, Default)]
pub struct ListControl {
    /// The last command: its code in bits 2..0, and a running number, so that one who cannot swap words knows what is
    /// new. 0: none yet.
    sent: AtomicU32,
    /// The one that was taken last.
    taken: AtomicU32,
    start: AtomicU32,
}

impl ListControl {
    /// Empty.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            sent: AtomicU32::new(0),
            taken: AtomicU32::new(0),
            start: AtomicU32::new(0),
        }
    }

    /// Leaves a command; it is obeyed before the next block.
    pub fn send(&self, command: ListCommand) {
        if let ListCommand::Start(at) = command {
            self.start.store(at, Ordering::Release);
        }
        let code = PLAIN.iter().position(|plain| *plain == command);
        let number = (self.sent.load(Ordering::Relaxed) | 7).wrapping_add(1);
        let sent = number | code.unwrap_or(PLAIN.len()) as u32;
        self.sent.store(sent, Ordering::Release);
    }

    /// Takes the command.
    #[inline]
    pub fn take(&self) -> Option<ListCommand> {
        let sent = self.sent.load(Ordering::Acquire);
        if sent == self.taken.load(Ordering::Relaxed) {
            return None;
        }
        self.taken.store(sent, Ordering::Relaxed);
        let start = || ListCommand::Start(self.start.load(Ordering::Acquire));
        let plain = PLAIN.get(sent as usize & 7).copied();
        Some(plain.unwrap_or_else(start))
    }
}

/// Why a list does not go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Halt {
    /// It has ended; a [`ListCommand`] begins it again.
    End,
    /// PAUSE: [`ListCommand::Resume`] goes on.
    Paused,
    /// SYNC: draw what there is, begin the next scene, and call again.
    Sync,
    /// The reader has met the writer of a ring: call again.
    Waiting,
    /// It was stopped, or never started.
    Stopped,
    /// One block was done.
    Stepped,
    /// The budget is spent; the next call goes on.
    Budget,
    /// It reached for what is not its own, and the settings say to stop then.
    Violation,
}

/// What comes next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// Do this.
    Do(Instruction),
    /// An interrupt with this vector.
    Interrupt(u8),
    /// Nothing to do: a jump was taken, or a block passed over.
    Passed,
    /// A block of a later version was passed over.
    Later,
    /// The list reached for what is not its own; it was passed over.
    Violation,
    /// No block was read, or none comes.
    Halt(Halt),
}

/// Bits of the header that a block which goes on with a strip shares with the one before: ID, SHADE, PRSP and TEXT.
const KEPT: u32 = 0xF000_00E0;

/// Where a list is being read.
#[derive(Clone, Debug, Default)]
pub struct Walker {
    at: u32,
    start: u32,
    running: bool,
    stop_at_end: bool,
    /// Blocks until it stops: 1, or 2 when that is done, 0 for no end.
    single: u8,
    /// Position of the block that was read last, or could not be read.
    block: u32,
    /// The end at which a ring's reader met the writer last.
    met: Option<u32>,
    format: VertexFormat,
    /// What vertices that a strip goes on with were like: the bits [`KEPT`] of their header.
    kept: Option<u32>,
    table: Option<u16>,
}

impl Walker {
    /// At word 0, stopped.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Obeys a command.
    pub fn command(&mut self, command: ListCommand) {
        match command {
            ListCommand::Start(at) => self.start_at(at),
            ListCommand::Restart => self.start_at(self.start),
            ListCommand::Resume => self.running = true,
            ListCommand::StopNow => self.running = false,
            ListCommand::StopAtEnd => self.stop_at_end = true,
            ListCommand::Step => {
                self.running = true;
                self.single = 1;
            }
        }
    }

    fn start_at(&mut self, at: u32) {
        *self = Self {
            at,
            start: at,
            running: true,
            ..Self::new()
        };
    }

    /// Position of the next block: what a ring's producer may overwrite ends here.
    #[must_use]
    pub fn position(&self) -> u32 {
        self.at
    }

    /// Byte offset of the block that was read last, or could not be read.
    #[must_use]
    pub fn offset(&self) -> u32 {
        self.block.wrapping_mul(4)
    }

    /// Whether it goes on when it is called.
    #[must_use]
    pub fn is_running(&self) -> bool {
        self.running
    }

    /// The vertex format in force.
    #[must_use]
    pub fn format(&self) -> &VertexFormat {
        &self.format
    }

    /// Vertices of the table in force.
    #[must_use]
    pub fn table(&self) -> Option<u16> {
        self.table
    }

    /// Stops, for a reason of the caller's.
    pub fn stop(&mut self) {
        self.running = false;
    }

    /// An error of the block that was read last, at which the list stops.
    pub fn fail(&mut self, block: Id, reason: Reason) -> ListError {
        self.running = false;
        ListError::at(self.block, Some(block), reason)
    }

    /// Whether `to` is within the list, its end included.
    fn within<'w>(words: impl Words<'w>, to: u32) -> bool {
        let first = words.first();
        to.wrapping_sub(first) <= words.end().wrapping_sub(first)
    }

    /// Goes on at `to`; `false` where that is not within the list.
    pub fn jump<'w>(&mut self, words: impl Words<'w>, to: u32) -> bool {
        let good = Self::within(words, to);
        if good {
            self.at = to;
        }
        good
    }

    /// Reads the next block.
    ///
    /// # Errors
    /// When it is malformed; the walker stops there, and its position stays.
    #[inline]
    pub fn step<'w>(
        &mut self,
        words: impl Words<'w>,
        budget: &mut Budget,
    ) -> Result<Step, ListError> {
        if self.single == 2 {
            self.single = 0;
            return Ok(self.halt(Halt::Stepped));
        }
        if !self.running {
            return Ok(Step::Halt(Halt::Stopped));
        }
        if !Self::within(words, self.at) {
            // Started outside the list.
            self.running = false;
            return Ok(Step::Violation);
        }
        if self.at == words.end() {
            return Ok(Step::Halt(self.meet(words)));
        }
        if budget.instructions == 0 {
            return Ok(Step::Halt(Halt::Budget));
        }
        let parsed = match read_block(words, self.at, &self.format) {
            Ok(parsed) => parsed,
            // The producer is at it.
            Err(ListError {
                reason: Reason::Truncated { .. },
                ..
            }) if words.room().is_some() && !self.stop_at_end => {
                return Ok(Step::Halt(self.meet(words)));
            }
            Err(error) => {
                (self.block, self.running) = (self.at, false);
                return Err(error);
            }
        };
        let run = parsed.instruction.run();
        let cost = run.map_or(0, |run| u32::from(run.header.count));
        let jumps = u32::from(matches!(
            parsed.instruction,
            Instruction::Flow(Flow::Jump(_) | Flow::JumpRelative(_))
        ));
        if cost > budget.vertices || jumps > budget.jumps {
            return Ok(Step::Halt(Halt::Budget));
        }
        budget.instructions -= 1;
        budget.vertices -= cost;
        budget.jumps -= jumps;
        self.block = self.at;
        self.met = None;
        let step = self.take(words, parsed);
        if self.single == 1 {
            self.single = 2;
        }
        step
    }

    /// The reader has met the writer, or the end.
    #[cold]
    fn meet<'w>(&mut self, words: impl Words<'w>) -> Halt {
        if words.room().is_some() && !self.stop_at_end {
            return Halt::Waiting;
        }
        self.running = false;
        Halt::End
    }

    /// What a halt is to those who wait for events, if it is one to them.
    pub fn event_of<'w>(&mut self, halt: Halt, words: impl Words<'w>) -> Option<Event> {
        let end = Some(words.end());
        // A wait at the same end of a ring is an event once.
        let is_new = halt == Halt::Waiting && core::mem::replace(&mut self.met, end) != end;
        match halt {
            Halt::End => Some(Event::ListEnd),
            Halt::Waiting if is_new => Some(Event::ListEnd),
            Halt::Paused => Some(Event::Paused),
            Halt::Sync => Some(Event::Sync),
            _ => None,
        }
    }

    /// A block that was read: checks it against what came before, and walks on.
    #[inline]
    fn take<'w>(&mut self, words: impl Words<'w>, parsed: Parsed) -> Result<Step, ListError> {
        let next = self.at.wrapping_add(parsed.words);
        let step = match parsed.instruction {
            Instruction::Flow(flow) => return Ok(self.flow(words, flow, next)),
            Instruction::Later => Step::Later,
            Instruction::Master(_) => Step::Violation,
            instruction => {
                self.check(words, instruction, next)?;
                Step::Do(instruction)
            }
        };
        self.at = next;
        Ok(step)
    }

    #[inline]
    fn check<'w>(
        &mut self,
        words: impl Words<'w>,
        instruction: Instruction,
        next: u32,
    ) -> Result<(), ListError> {
        if let Some(Run { header, .. }) = instruction.run() {
            let kept = match header.id {
                Id::Points | Id::Table => None,
                Id::Quads if !header.rm => None,
                _ => Some(header.to_word() & KEPT),
            };
            match header.id {
                Id::Table => self.table = Some(header.count),
                Id::Indexed if self.table.is_none() => {
                    return Err(self.fail(header.id, Reason::NoTable));
                }
                _ if kept.is_some() && !header.new && self.kept != kept => {
                    return Err(self.fail(header.id, Reason::Continue));
                }
                _ => {}
            }
            self.kept = kept;
        } else if let Instruction::State(State::Format(format)) = instruction {
            (self.format, self.kept) = (format, None);
        } else {
            let (left, value) = (words.end().wrapping_sub(next), instruction.reach());
            if words.room().is_none() && value > left {
                return Err(self.fail(Id::State, Reason::Value { word: 6, value }));
            }
        }
        Ok(())
    }

    /// Stops, and says so.
    fn halt(&mut self, halt: Halt) -> Step {
        self.running = false;
        Step::Halt(halt)
    }

    fn flow<'w>(&mut self, words: impl Words<'w>, flow: Flow, next: u32) -> Step {
        self.at = next;
        let to = match flow {
            Flow::End => return self.halt(Halt::End),
            Flow::Pause => return self.halt(Halt::Paused),
            Flow::Sync => return Step::Halt(Halt::Sync),
            Flow::Interrupt(vector) => return Step::Interrupt(vector),
            Flow::LoadTexture { at, .. } => {
                let texture = read_block(words, at, &self.format).map(|p| p.instruction);
                return match texture {
                    Ok(Instruction::State(State::Texture(_))) if Self::within(words, at) => {
                        Step::Do(Instruction::Flow(flow))
                    }
                    _ => Step::Violation,
                };
            }
            Flow::Jump(to) => to,
            // Of a list without a ring, positions do not wrap: nor may a jump.
            Flow::JumpRelative(by) => match next.checked_add_signed(by) {
                Some(to) => to,
                None if words.room().is_some() => next.wrapping_add_signed(by),
                None => return Step::Violation,
            },
        };
        if self.jump(words, to) {
            Step::Passed
        } else {
            Step::Violation
        }
    }
}

#[cfg(test)]
mod tests;
