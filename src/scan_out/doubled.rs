//! Lines and columns doubled on their way out: a quarter of the pixels is drawn, all are sent (S7, X5).
//!
//! A drawn pixel becomes four. Each of the four lies a quarter of a drawn pixel away from its centre, so it is made
//! of the four drawn pixels around it with weights 9, 3, 3 and 1 of 16; at the rim, where some are missing, the
//! pixel that is nearest stands for them. So nothing moves, and what is linear over the picture stays linear.
//!
//! The error, in steps of the format and for each channel: what is sent is the weighted mean of the drawn pixels,
//! rounded to the nearest step, halves up; it differs from that mean by half a step at most. No channel leaves
//! the range of the four drawn pixels. What the picture loses is what lies between drawn pixels: edges and texels
//! are as wide as a drawn pixel.
//!
//! Between two drawn lines lie two that are sent, which need both; so the lines that are sent come one pair behind.
//! How pixels are mixed is the room's of pixels: here it is a function.

use super::dma::{ScanoutDma, Window};
use super::pump::{Pump, ScanError, WordOf};

/// Draws a window and sends it with twice its lines and columns, at twice its place, so many sent lines a
/// transfer.
///
/// `draw` writes a line, which counts from 0 at the top of the window; lines come in order. `memory` holds two drawn
/// lines. `mix` makes a sent line of the drawn line that it lies in and of the one on its other side: the
/// [`mix_lines`](crate::pixel::PixelFormat::mix_lines) of a pixel format, or what the panel needs instead.
///
/// ```
/// use scanbeam::pixel::{PixelFormat, Rgb565};
/// use scanbeam::scan_out::{Pump, ScanError, ScanoutDma, Window, send_doubled};
///
/// fn grey_ramp<D>(pump: &mut Pump<D>) -> Result<(), ScanError<D::Error>>
/// where
///     D: ScanoutDma<Buf = &'static mut [u16]>,
/// {
///     let window = Window { x: 0, y: 0, width: 160, height: 120 };
///     let (mut one, mut other) = ([0; 160], [0; 160]);
///     send_doubled(pump, window, 4, [&mut one, &mut other], Rgb565::mix_lines, |line, pixels| {
///         pixels.fill(line >> 2);
///         Ok(())
///     })
/// }
/// ```
///
/// # Errors
/// `Empty` when the window has no pixels or its double is wider, higher or farther away than displays are;
/// `BufferTooShort` when a line of `memory` is shorter than a drawn one; what the sink and `draw` say. The pump has
/// its buffers back then.
pub fn send_doubled<D, E>(
    pump: &mut Pump<D>,
    window: Window,
    lines_per_transfer: u16,
    memory: [&mut [WordOf<D>]; 2],
    mix: impl Fn(&[WordOf<D>], &[WordOf<D>], &mut [WordOf<D>]),
    mut draw: impl FnMut(u16, &mut [WordOf<D>]) -> Result<(), E>,
) -> Result<(), E>
where
    D: ScanoutDma,
    E: From<ScanError<D::Error>>,
{
    let sent = doubled(window).ok_or(ScanError::Empty)?;
    let needed = usize::from(window.width);
    let mut lines = memory.map(|line| (line.len(), line.get_mut(..needed)));
    let [(_, Some(above)), (_, Some(below))] = &mut lines else {
        let have = lines.iter().map(|(len, _)| *len).min().unwrap_or(0);
        return Err(ScanError::BufferTooShort { needed, have }.into());
    };
    pump.begin(sent, lines_per_transfer)?;
    let send = |pump: &mut Pump<D>, near: &[_], far: &[_]| {
        mix(near, far, pump.line()?);
        pump.line_done()
    };
    let mut draw =
        |pump: &mut Pump<D>, line, to: &mut _| draw(line, to).inspect_err(|_| pump.give_up());
    draw(pump, 0, above)?;
    send(pump, above, above)?;
    for line in 1..window.height {
        draw(pump, line, below)?;
        send(pump, above, below)?;
        send(pump, below, above)?;
        core::mem::swap(above, below);
    }
    send(pump, above, above)?;
    Ok(pump.finish()?)
}

/// Twice a window, if there is a display for it.
fn doubled(window: Window) -> Option<Window> {
    let twice = |n: u16| n.checked_mul(2);
    Some(Window {
        x: twice(window.x)?,
        y: twice(window.y)?,
        width: twice(window.width).filter(|&n| n > 0)?,
        height: twice(window.height).filter(|&n| n > 0)?,
    })
}
