//! What each line of a scene costs (X8), and pass one before it.
//!
//! The clock is read where a line arrives at the sink, one line a transfer, so a line's cost is all
//! that [`draw_frame`](scanbeam::draw_frame) does for it: draw, hand on. Frames are drawn
//! again from other places of a tick, so that a line is exact to about 5 instructions, not to 40.

use crate::console::Console;
use crate::count::{Counter, INSTRUCTIONS_PER_TICK, PHASES};
use crate::frames::{Receives, draw, draw_unhurried};
use crate::rooms::Rooms;
use core::fmt;
use core::hint::black_box;
use scenes::{Frame, HEIGHT, frames, unhurried};

/// Lines of a row that is printed.
const ROW: usize = 16;

/// The scenes that have a goal, and others, beside those of scene B.
const MEASURED: [&str; 5] = ["sphere", "teapot", "cube", "c_f2n", "c_n2f"];

/// Measures the lines of them.
pub(super) fn run(counter: &Counter, console: &mut Console, rooms: &mut Rooms) {
    for (name, frame) in frames() {
        if MEASURED.contains(&name) || matches!(frame, Frame::B(_)) {
            measure(name, frame, counter, console, rooms);
        }
    }
}

/// Instructions of the dearest line of a frame, to a tick.
pub(crate) fn worst_line(frame: Frame, counter: &Counter, rooms: &mut Rooms) -> u64 {
    let sink = clocked(1, counter, |to| draw(frame, 1, rooms, to));
    let worst = sink.lines.iter().max().copied().unwrap_or_default();
    u64::from(worst) * INSTRUCTIONS_PER_TICK
}

/// Prints what lines cost that may cost what they like, but pay, to a tick.
pub(crate) fn run_unhurried(counter: &Counter, console: &mut Console, rooms: &mut Rooms) {
    for (name, frame) in unhurried() {
        let sink = clocked(1, counter, |to| draw_unhurried(frame, rooms, to));
        print(name, &sink, console, |ticks| {
            u64::from(ticks) * INSTRUCTIONS_PER_TICK
        });
    }
}

/// Draws a frame from so many places of a tick.
fn clocked(phases: u32, counter: &Counter, mut draw: impl FnMut(&mut dyn Receives)) -> Clocked<'_> {
    let mut sink = Clocked::new(counter);
    for phase in 0..phases {
        counter.wait(phase);
        sink.last = counter.ticks();
        draw(&mut sink);
    }
    sink
}

/// Measures a frame, and prints it.
fn measure(name: &str, frame: Frame, counter: &Counter, console: &mut Console, rooms: &mut Rooms) {
    let sink = clocked(PHASES, counter, |to| draw(frame, 1, rooms, to));
    print(name, &sink, console, |ticks| {
        u64::from(ticks) * INSTRUCTIONS_PER_TICK / u64::from(PHASES)
    });
}

/// Prints what was measured, times what a tick is.
fn print(name: &str, sink: &Clocked<'_>, console: &mut Console, scale: fn(u32) -> u64) {
    let pass_one = scale(sink.pass_one);
    for (row, costs) in sink.lines.chunks(ROW).enumerate() {
        console.line(format_args!(
            "lines scene={name} pass_one={pass_one} first={} costs={}",
            row * ROW,
            Listed(costs, scale)
        ));
    }
}

/// Numbers with commas between them.
pub(crate) struct Listed<'a, F>(pub(crate) &'a [u32], pub(crate) F);

impl<F: Fn(u32) -> u64> fmt::Display for Listed<'_, F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, &ticks) in self.0.iter().enumerate() {
            let comma = if i == 0 { "" } else { "," };
            write!(f, "{comma}{}", (self.1)(ticks))?;
        }
        Ok(())
    }
}

/// A sink that notes when lines arrive.
struct Clocked<'c> {
    counter: &'c Counter,
    /// When the work began that is measured next.
    last: u64,
    /// Ticks of pass one, of all frames.
    pass_one: u32,
    /// Ticks of each line, of all frames.
    lines: [u32; HEIGHT as usize],
    /// The line that comes next.
    at: usize,
}

impl<'c> Clocked<'c> {
    fn new(counter: &'c Counter) -> Self {
        Self {
            counter,
            last: 0,
            pass_one: 0,
            lines: [0; HEIGHT as usize],
            at: 0,
        }
    }

    /// Ticks since the last call returned.
    fn lap(&mut self) -> u32 {
        let ticks = self.counter.ticks() - self.last;
        ticks.saturating_sub(self.counter.overhead()) as u32
    }
}

impl Receives for Clocked<'_> {
    fn begin(&mut self) {
        self.pass_one += self.lap();
        self.at = 0;
        self.last = self.counter.ticks();
    }

    fn transfer(&mut self, bytes: &[u8]) {
        let lap = self.lap();
        black_box(bytes);
        if let Some(sum) = self.lines.get_mut(self.at) {
            *sum += lap;
        }
        self.at += 1;
        self.last = self.counter.ticks();
    }
}
