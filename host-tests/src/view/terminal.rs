//! The live loop on a terminal, and frames printed without one.

use super::screen::Screen;
use super::{Colours, KEYS, Scenery, State, Step, half_blocks};
use crate::args::Size;
use crossterm::event::{self, Event, KeyCode, KeyEventKind, KeyModifiers};
use crossterm::{cursor, execute, terminal};
use signal_hook::consts::TERM_SIGNALS;
use signal_hook::{flag, low_level};
use std::error::Error;
use std::f64::consts::TAU;
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// What `--frames` draws when nothing is said.
const PRINTED: Size = Size {
    width: 80,
    height: 48,
};
/// Frames of a turn that is printed.
const PRINTED_TURN: f64 = 64.0;
/// Radians a second.
const SPEED: f64 = 0.8;
/// No more frames than this a second.
const SHORTEST: Duration = Duration::from_millis(16);
/// How long keys are waited for while nothing moves, before signals and the size are looked at.
const IDLE: Duration = Duration::from_millis(100);
/// The size of a terminal that does not tell it.
const UNKNOWN: (u16, u16) = (80, 24);

/// Prints frames, one below the other, each with its figures: the same text at every run. A reader
/// that has seen enough ends it.
pub fn print(
    scenery: &Scenery<'_>,
    mut state: State,
    size: Option<Size>,
    colours: Colours,
    frames: u32,
) -> Result<(), Box<dyn Error>> {
    let size = size.unwrap_or(PRINTED);
    let mut out = io::stdout().lock();
    for _ in 0..frames {
        let shown = scenery.frame(&state, size.width, size.height)?;
        let mut lines = half_blocks(&shown.frame, colours);
        lines.extend([state.choices(), shown.figures()]);
        match writeln!(out, "{}", lines.join("\n")) {
            Err(error) if error.kind() == ErrorKind::BrokenPipe => break,
            done => done?,
        }
        state.spin(TAU / PRINTED_TURN);
    }
    Ok(())
}

/// The terminal as a canvas; as it was when dropped, whatever happened.
struct Canvas;

impl Canvas {
    fn take() -> io::Result<Self> {
        terminal::enable_raw_mode()?;
        let canvas = Self;
        execute!(io::stdout(), terminal::EnterAlternateScreen, cursor::Hide)?;
        Ok(canvas)
    }
}

impl Drop for Canvas {
    fn drop(&mut self) {
        // Nobody is left to be told of an error.
        let _ = execute!(io::stdout(), terminal::LeaveAlternateScreen, cursor::Show);
        let _ = terminal::disable_raw_mode();
    }
}

/// Shows the model until a key or a signal ends it.
pub fn live(
    scenery: &Scenery<'_>,
    state: State,
    size: Option<Size>,
    colours: Colours,
) -> Result<(), Box<dyn Error>> {
    let dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
    if dumb || !io::stdout().is_terminal() || !io::stdin().is_terminal() {
        return Err("view needs a terminal; --frames N prints N frames without one".into());
    }
    // Signals end it as they would anyway, but with the terminal as it was.
    let signal = Arc::new(AtomicUsize::new(0));
    for &one in TERM_SIGNALS {
        flag::register_usize(one, Arc::clone(&signal), one as usize)?;
    }
    let canvas = Canvas::take()?;
    let done = turn(scenery, state, size, colours.of_terminal(), &signal);
    drop(canvas);
    if let Ok(signal @ 1..) = i32::try_from(signal.load(Ordering::Relaxed)) {
        low_level::emulate_default_handler(signal)?;
    }
    done
}

/// Frames and keys in turn, until a key says the end or there has been a signal.
fn turn(
    scenery: &Scenery<'_>,
    mut state: State,
    size: Option<Size>,
    colours: Colours,
    signal: &AtomicUsize,
) -> Result<(), Box<dyn Error>> {
    let mut screen = Screen::default();
    let mut pace = Pace::new();
    // What the figures of the last frame said: the text decides about the picture's size.
    let mut figures = String::new();
    let mut drawn = None;
    while signal.load(Ordering::Relaxed) == 0 {
        let frame_start = Instant::now();
        let (columns, rows) = terminal::size().unwrap_or(UNKNOWN);
        screen.set_size(columns, rows);
        let now = (state.clone(), columns, rows);
        let moves = state.spins || drawn.as_ref() != Some(&now);
        if moves {
            // Twice where the text of this frame takes more lines than any before.
            loop {
                screen.text(&[(&figures, ", "), (KEYS, "  ")]);
                let (columns, rows) = screen.left();
                let fits = Size {
                    width: columns.into(),
                    height: 2 * u32::from(rows),
                };
                let size = size.unwrap_or(fits);
                let (width, height) = (size.width.min(fits.width), size.height.min(fits.height));
                let shown = scenery.frame(&state, width, height)?;
                figures = format!(
                    "{:5.1} frames a second, {:.1} ms, {}, {}",
                    pace.rate(),
                    shown.took.as_secs_f64() * 1e3,
                    state.choices(),
                    shown.figures()
                );
                let text = screen.text(&[(&figures, ", "), (KEYS, "  ")]);
                if screen.left() == (columns, rows) {
                    let mut out = Vec::new();
                    screen.show(&mut out, half_blocks(&shown.frame, colours), text)?;
                    let mut stdout = io::stdout().lock();
                    stdout.write_all(&out)?;
                    stdout.flush()?;
                    break;
                }
            }
            drawn = Some(now);
        }
        loop {
            let whole = if moves { SHORTEST } else { IDLE };
            if !event::poll(whole.saturating_sub(frame_start.elapsed()))? {
                break;
            }
            let key = match event::read()? {
                Event::Key(key) if key.kind != KeyEventKind::Release => key,
                _ => continue,
            };
            let control = key.modifiers.contains(KeyModifiers::CONTROL);
            let interrupt = control && key.code == KeyCode::Char('c');
            if interrupt || !control && state.key(key.code) == Step::End {
                return Ok(());
            }
            if !moves {
                break;
            }
        }
        let took = pace.frame(state.spins);
        state.spin(took.as_secs_f64() * SPEED);
    }
    Ok(())
}

/// Frames a second, over the last second or so.
pub(super) struct Pace {
    last: Instant,
    /// Smoothed seconds of a frame.
    seconds: f64,
}

impl Pace {
    pub(super) fn new() -> Self {
        Self {
            last: Instant::now(),
            seconds: 0.0,
        }
    }

    /// A frame was shown, or waited for a key: how long after the one before. What was waited does
    /// not count.
    pub(super) fn frame(&mut self, counts: bool) -> Duration {
        let took = self.last.elapsed();
        self.last = Instant::now();
        if !counts {
            return took;
        }
        let weight = if self.seconds == 0.0 { 1.0 } else { 0.1 };
        self.seconds += (took.as_secs_f64() - self.seconds) * weight;
        took
    }

    pub(super) fn rate(&self) -> f64 {
        if self.seconds > 0.0 {
            1.0 / self.seconds
        } else {
            0.0
        }
    }
}
