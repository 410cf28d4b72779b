//! What each line of a scene costs (X8), and pass one before it.
//!
//! The clock is read where a line arrives at the sink, one line a transfer, so a line's cost is all
//! that [`draw_frame`](scanbeam::pipeline::draw_frame) does for it: clear, draw, hand on. Frames are drawn
//! again from other places of a tick, so that a line is exact to about 5 instructions, not to 40.

use crate::choices::draw_b;
use crate::console::Console;
use crate::count::{Counter, INSTRUCTIONS_PER_TICK, PHASES};
use crate::frames::{Smooth, draw_as};
use crate::rooms::{Rooms, SLOTS};
use core::convert::Infallible;
use core::fmt;
use core::task::Poll;
use scanbeam::pipeline::texture::Textures;
use scanbeam::scan_out::{ErrorType, Pump, ScanoutDma, Window};
use scenes::{HEIGHT, LookB, SCENES_B, STACKS, Shot, TEXTURES_B, Variant};

/// Lines of a row that is printed.
const ROW: usize = 16;

/// Measures the lines of all scenes that have a goal, and of the other models.
pub(super) fn run(counter: &Counter, console: &mut Console, rooms: &mut Rooms) {
    let shots = [Shot::Sphere, Shot::Teapot, Shot::Cube];
    for shot in shots.into_iter().chain(STACKS) {
        let how = Variant {
            name: shot.name(),
            shot,
            slots: SLOTS,
            renderers: 1,
            prefetch: 0,
        };
        measure(shot.name(), counter, console, rooms, |rooms, pump| {
            draw_as::<Smooth, _>(&how, &mut rooms.smooth, pump, 1);
        });
    }
    for scene in SCENES_B {
        measure(scene.name, counter, console, rooms, |rooms, pump| {
            let textures = Textures(&TEXTURES_B[..]);
            draw_b::<LookB, _>(scene, textures, &mut rooms.textured, pump, 1);
        });
    }
}

/// Measures a scene that `draw` draws, and prints it.
fn measure<'c>(
    name: &str,
    counter: &'c Counter,
    console: &mut Console,
    rooms: &mut Rooms,
    draw: impl Fn(&mut Rooms, &mut Pump<Clocked<'c>>),
) {
    let mut sink = Clocked::new(counter);
    for phase in 0..PHASES {
        let buffers = rooms.lines.take().expect("the last frame gave them back");
        counter.wait(phase);
        sink.last = counter.ticks();
        let mut pump = Pump::new(sink, buffers);
        draw(rooms, &mut pump);
        let lines;
        (sink, lines) = pump.release();
        if let [Some(a), Some(b)] = lines {
            rooms.lines = Some([a, b]);
        }
    }
    let scale = |ticks: u32| u64::from(ticks) * INSTRUCTIONS_PER_TICK / u64::from(PHASES);
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
struct Listed<'a, F>(&'a [u32], F);

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
    sent: Option<&'static mut [u16]>,
}

impl<'c> Clocked<'c> {
    fn new(counter: &'c Counter) -> Self {
        Self {
            counter,
            last: 0,
            pass_one: 0,
            lines: [0; HEIGHT as usize],
            at: 0,
            sent: None,
        }
    }

    /// Ticks since the last call returned.
    fn lap(&mut self) -> u32 {
        let ticks = self.counter.ticks() - self.last;
        ticks.saturating_sub(self.counter.overhead()) as u32
    }
}

impl ErrorType for Clocked<'_> {
    type Error = Infallible;
}

impl ScanoutDma for Clocked<'_> {
    type Buf = &'static mut [u16];

    fn begin(&mut self, _: Window) -> Result<(), Infallible> {
        self.pass_one += self.lap();
        self.at = 0;
        self.last = self.counter.ticks();
        Ok(())
    }

    fn start(&mut self, line: Self::Buf, _: usize) -> Result<(), (Infallible, Self::Buf)> {
        let lap = self.lap();
        if let Some(sum) = self.lines.get_mut(self.at) {
            *sum += lap;
        }
        self.at += 1;
        self.sent = Some(line);
        self.last = self.counter.ticks();
        Ok(())
    }

    fn poll(&mut self) -> Poll<Result<Option<Self::Buf>, Infallible>> {
        Poll::Ready(Ok(self.sent.take()))
    }

    fn end(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}
