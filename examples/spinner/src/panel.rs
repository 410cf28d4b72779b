//! An ILI9341 in landscape, 320x240, 16 bits a pixel. Its kin differ in [`set_up`] alone.
//!
//! The boards' DMAs send lines; commands are a few bytes, and block. What [`set_up`]
//! sends lies in flash, which not every DMA reaches: a board sends it by the processor or copies it.

use embedded_hal::digital::OutputPin;
use scanbeam::scan_out::Window;

/// A command, its data, and how many milliseconds the panel wants after it.
const SET_UP: [(u8, &[u8], u32); 5] = [
    (0x01, &[], 120), // software reset: the panel may have been awake before the board was
    (0x11, &[], 120), // sleep out
    (0x3A, &[0x55], 1), // 16 bits a pixel
    (0x36, &[0x28], 1), // landscape, blue first
    (0x29, &[], 1),   // display on
];
/// Milliseconds from the panel's power-on until it listens.
const POWER_ON: u32 = 10;

/// Sends a command: the pin low for its byte, high for its data and for pixels. `send` returns when
/// the bus is idle, because the pin counts when the last bit of a byte arrives.
///
/// # Errors
/// Those of `send`, and `fallen` when the pin fails.
pub fn command<E>(
    dc: &mut impl OutputPin,
    fallen: E,
    (code, data): (u8, &[u8]),
    mut send: impl FnMut(&[u8]) -> Result<(), E>,
) -> Result<(), E> {
    if dc.set_low().is_err() {
        return Err(fallen);
    }
    send(&[code])?;
    if dc.set_high().is_err() {
        return Err(fallen);
    }
    if data.is_empty() { Ok(()) } else { send(data) }
}

/// Wakes the panel up. `each` sends a command; `wait` waits at least so many milliseconds.
///
/// # Errors
/// Those of `each`.
pub fn set_up<E>(
    mut each: impl FnMut((u8, &[u8])) -> Result<(), E>,
    mut wait: impl FnMut(u32),
) -> Result<(), E> {
    wait(POWER_ON);
    for (code, data, pause) in SET_UP {
        each((code, data))?;
        wait(pause);
    }
    Ok(())
}

/// Opens a rectangle: columns, lines, then pixels follow.
///
/// # Errors
/// Those of `each`, which sends a command.
pub fn open<E>(
    window: Window,
    mut each: impl FnMut((u8, &[u8])) -> Result<(), E>,
) -> Result<(), E> {
    let ends = |first: u16, len: u16| {
        let last = first.saturating_add(len.saturating_sub(1));
        let ([a, b], [c, d]) = (first.to_be_bytes(), last.to_be_bytes());
        [a, b, c, d]
    };
    each((0x2A, &ends(window.x, window.width)))?;
    each((0x2B, &ends(window.y, window.height)))?;
    each((0x2C, &[]))
}
