//! The same in a window of its own, with the feature `window`.

use super::terminal::Pace;
use super::{Scenery, State, Step};
use crate::args::Size;
use crossterm::event::KeyCode;
use minifb::{Key, KeyRepeat, Window, WindowOptions};
use std::error::Error;

/// Radians a second.
const SPEED: f64 = 0.8;

/// Shows the model until the window is closed or a key ends it. The figures are in its title.
pub fn run(
    scenery: &Scenery<'_>,
    mut state: State,
    size: Option<Size>,
) -> Result<(), Box<dyn Error>> {
    let Size { width, height } = size.unwrap_or(Size {
        width: 480,
        height: 360,
    });
    let options = WindowOptions {
        resize: true,
        ..WindowOptions::default()
    };
    let mut window = Window::new("scanbeam", width as usize, height as usize, options)?;
    window.set_target_fps(60);
    let mut pace = Pace::new();
    while window.is_open() {
        for key in window.get_keys_pressed(KeyRepeat::Yes) {
            if code(key).is_some_and(|code| state.key(code) == Step::End) {
                return Ok(());
            }
        }
        let shown = scenery.frame(&state, width, height)?;
        let words: Vec<u32> = (shown.drawn.frame.rgb().chunks_exact(3))
            .map(|pixel| u32::from_be_bytes([0, pixel[0], pixel[1], pixel[2]]))
            .collect();
        let (rate, choices) = (pace.rate(), state.choices());
        window.set_title(&format!("{rate:.1} fps: {choices}; {}", shown.figures()));
        window.update_with_buffer(&words, width as usize, height as usize)?;
        state.spin(pace.frame().as_secs_f64() * SPEED);
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
