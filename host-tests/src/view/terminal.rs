//! The live loop on a terminal, and frames printed without one.

use super::{KEYS, Scenery, State, Step, half_blocks};
use crate::args::Size;
use crossterm::event::{self, Event, KeyCode, KeyEventKind, KeyModifiers};
use crossterm::terminal::{self, BeginSynchronizedUpdate, EndSynchronizedUpdate};
use crossterm::{cursor, execute};
use std::error::Error;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::io::{self, IsTerminal, Write};
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
/// Lines of text below the picture.
const TEXT: u16 = 3;
/// No more frames than this a second.
const SHORTEST: Duration = Duration::from_millis(16);

/// Prints frames, one below the other, each with its figures: the same text at every run.
pub fn print(
    scenery: &Scenery<'_>,
    mut state: State,
    size: Option<Size>,
    frames: u32,
) -> Result<(), Box<dyn Error>> {
    let size = size.unwrap_or(PRINTED);
    let mut out = io::stdout().lock();
    for _ in 0..frames {
        let shown = scenery.frame(&state, size.width, size.height)?;
        out.write_all(half_blocks(&shown.drawn.frame, "\n").as_bytes())?;
        writeln!(out, "{}\n{}", state.choices(), shown.figures())?;
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

/// Shows the model until a key ends it.
pub fn live(
    scenery: &Scenery<'_>,
    mut state: State,
    size: Option<Size>,
) -> Result<(), Box<dyn Error>> {
    if !io::stdout().is_terminal() || !io::stdin().is_terminal() {
        return Err("view needs a terminal; --frames N prints N frames without one".into());
    }
    let canvas = Canvas::take()?;
    let mut pace = Pace::new();
    loop {
        let frame_start = Instant::now();
        let (columns, rows) = terminal::size()?;
        let size = size.unwrap_or(Size {
            width: u32::from(columns.max(1)),
            height: 2 * u32::from(rows.saturating_sub(TEXT).max(1)),
        });
        let shown = scenery.frame(&state, size.width, size.height)?;
        let mut text = half_blocks(&shown.drawn.frame, "\r\n");
        let took = shown.took.as_secs_f64() * 1e3;
        let first = format!(
            "{:5.1} frames a second, {took:.1} ms: {}",
            pace.rate(),
            state.choices()
        );
        for (line, end) in [(&*first, "\r\n"), (&*shown.figures(), "\r\n"), (KEYS, "")] {
            let fits: String = line.chars().take(columns.into()).collect();
            write!(text, "{fits}\x1b[K{end}")?;
        }
        let mut out = io::stdout().lock();
        execute!(out, BeginSynchronizedUpdate, cursor::MoveTo(0, 0))?;
        out.write_all(text.as_bytes())?;
        execute!(out, EndSynchronizedUpdate)?;
        drop(out);
        loop {
            let rest = SHORTEST.saturating_sub(frame_start.elapsed());
            if !event::poll(rest)? {
                break;
            }
            if let Event::Key(key) = event::read()?
                && key.kind != KeyEventKind::Release
            {
                let interrupt =
                    key.modifiers.contains(KeyModifiers::CONTROL) && key.code == KeyCode::Char('c');
                if interrupt || state.key(key.code) == Step::End {
                    drop(canvas);
                    return Ok(());
                }
            }
        }
        state.spin(pace.frame().as_secs_f64() * SPEED);
    }
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

    /// A frame was shown: how long after the one before.
    pub(super) fn frame(&mut self) -> Duration {
        let took = self.last.elapsed();
        self.last = Instant::now();
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
