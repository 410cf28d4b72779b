//! The same in a window of its own, with the feature `window`.

use super::terminal::Pace;
use super::{KEYS, Scenery, State, Step};
use crate::args::Size;
use crossterm::event::KeyCode;
use minifb::{InputCallback, Key, ScaleMode, Window, WindowOptions};
use std::error::Error;
use std::sync::mpsc::{Sender, channel};

/// Radians a second.
const SPEED: f64 = 0.8;

/// Every press, also of a key that is up again before the next frame, which asking for keys that are
/// down would miss.
struct Presses(Sender<Key>);

impl InputCallback for Presses {
    fn add_char(&mut self, _: u32) {}

    fn set_key_state(&mut self, key: Key, is_down: bool) {
        if is_down {
            // Nobody listens once the window is closed.
            let _ = self.0.send(key);
        }
    }
}

/// Pixels of a side that are drawn, inclusive; a larger window shows them enlarged.
const SIDES: std::ops::RangeInclusive<u32> = 16..=1024;

/// Shows the model until the window is closed or a key ends it. The figures are in its title. Where
/// no size was asked for, the picture has that of the window.
pub fn run(
    scenery: &Scenery<'_>,
    mut state: State,
    size: Option<Size>,
) -> Result<(), Box<dyn Error>> {
    let first = size.unwrap_or(Size {
        width: 480,
        height: 360,
    });
    let options = WindowOptions {
        resize: true,
        scale_mode: ScaleMode::AspectRatioStretch,
        ..WindowOptions::default()
    };
    let (width, height) = (first.width as usize, first.height as usize);
    let mut window = Window::new("scanbeam", width, height, options).map_err(|error| {
        format!("{error}: a window needs a display, and on Linux libX11 and libXcursor")
    })?;
    window.set_target_fps(60);
    let (presses, pressed) = channel();
    window.set_input_callback(Box::new(Presses(presses)));
    say!("{KEYS}");
    let mut pace = Pace::new();
    let side = |pixels: usize| (pixels as u32).clamp(*SIDES.start(), *SIDES.end());
    while window.is_open() {
        for key in pressed.try_iter() {
            if code(key).is_some_and(|code| state.key(code) == Step::End) {
                return Ok(());
            }
        }
        let (width, height) = match size {
            Some(size) => (size.width, size.height),
            None => {
                let (width, height) = window.get_size();
                (side(width), side(height))
            }
        };
        let shown = scenery.frame(&state, width, height)?;
        let words: Vec<u32> = (shown.frame.rgb().chunks_exact(3))
            .map(|pixel| u32::from_be_bytes([0, pixel[0], pixel[1], pixel[2]]))
            .collect();
        let (rate, choices) = (pace.rate(), state.choices());
        window.set_title(&format!("{rate:.1} fps: {choices}; {}", shown.figures()));
        window.update_with_buffer(&words, width as usize, height as usize)?;
        let took = pace.frame(true);
        state.spin(took.as_secs_f64() * SPEED);
    }
    Ok(())
}

/// The key of a terminal that does the same.
fn code(key: Key) -> Option<KeyCode> {
    Some(match key {
        Key::Escape => KeyCode::Esc,
        Key::Left => KeyCode::Left,
        Key::Right => KeyCode::Right,
        Key::Up => KeyCode::Up,
        Key::Down => KeyCode::Down,
        Key::Space => KeyCode::Char(' '),
        Key::Equal | Key::NumPadPlus => KeyCode::Char('+'),
        Key::Minus | Key::NumPadMinus => KeyCode::Char('-'),
        Key::Q => KeyCode::Char('q'),
        Key::S => KeyCode::Char('s'),
        Key::C => KeyCode::Char('c'),
        Key::R => KeyCode::Char('r'),
        Key::F => KeyCode::Char('f'),
        Key::X => KeyCode::Char('x'),
        _ => return None,
    })
}
