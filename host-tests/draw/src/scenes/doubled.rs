//! Scenes that are drawn at half their size and interpolated on their way to the display (S7, X5).

use crate::{DrawFailure, Drawn, display};
use host_support::image_out::Frame;
use scanbeam::frame::FrameError;
use scanbeam::pixel::PixelFormat;
use scanbeam::scan_out::{Window, send_doubled};

/// Half of a side, which is odd where somebody asks for another size than the file's.
pub(super) fn half(side: u32) -> u32 {
    side.div_ceil(2)
}

/// Sends a picture with twice its lines and columns, of which these are shown.
///
/// # Errors
/// What the display says.
pub(super) fn doubled<F: PixelFormat>(
    drawn: Drawn,
    [columns, lines]: [u32; 2],
) -> Result<Drawn, DrawFailure> {
    let other = || DrawFailure::View("the picture has another size".into());
    let side = |side: u32| u16::try_from(side).map_err(|_| other());
    let (width, height) = (side(drawn.frame.width())?, side(drawn.frame.height())?);
    let twice = |side: u16| side.checked_mul(2).ok_or_else(other);
    let (mut pump, lines_per_transfer) = display::<F::Word>(twice(width)?, twice(height)?);
    let window = Window {
        x: 0,
        y: 0,
        width,
        height,
    };
    let row = 3 * usize::from(width);
    let mut memory = [(); 2].map(|()| vec![F::Word::default(); width.into()]);
    let [above, below] = &mut memory;
    send_doubled(
        &mut pump,
        window,
        lines_per_transfer,
        [above, below],
        F::mix_lines,
        |line, pixels| {
            let rgb = drawn.frame.rgb().chunks_exact(row).nth(line.into());
            let drawn = rgb.unwrap_or_default().chunks_exact(3);
            for (pixel, rgb) in pixels.iter_mut().zip(drawn) {
                *pixel = F::from_rgb8([rgb[0], rgb[1], rgb[2]]);
            }
            Ok(())
        },
    )
    .map_err(|error| DrawFailure::Display(FrameError::ScanOut(error)))?;
    let words = pump.sink().frame().map_err(DrawFailure::Incomplete)?;
    let sent = words.chunks(2 * usize::from(width)).take(lines as usize);
    let shown = sent.flat_map(|row| row.iter().take(columns as usize));
    let rgb = shown.flat_map(|&word| F::to_rgb8(word)).collect();
    let mut doubled = drawn;
    doubled.frame = Frame::new(columns, lines, rgb).ok_or_else(other)?;
    doubled.used.scan_out = pump.stats();
    let line = usize::from(width) * size_of::<F::Word>();
    // Two buffers of lines that are sent, and two lines that are drawn.
    doubled.figures.line_bytes = 4 * line * usize::from(lines_per_transfer) + 2 * line;
    Ok(doubled)
}
