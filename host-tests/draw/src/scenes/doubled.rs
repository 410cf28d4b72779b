//! Scenes that are drawn at half their size and interpolated on their way to the display (S7, X5).

use crate::{DrawFailure, Drawn, display};
use host_support::image_out::Frame;
use scanbeam::frame::FrameError;
use scanbeam::pixel::PixelFormat;
use scanbeam::scan_out::{ScanStats, Window, send_doubled};

/// Half of a side, which is odd where somebody asks for another size than the file's.
pub(super) fn half(side: u32) -> u32 {
    side.div_ceil(2)
}

/// A picture that was sent with twice its lines and columns.
pub struct Twice<W> {
    /// Its pixels.
    pub words: Vec<W>,
    /// What that took.
    stats: ScanStats,
    lines_per_transfer: u16,
}

/// Sends a picture of so many columns with twice its lines and columns.
///
/// # Errors
/// What the display says.
pub fn twice<F: PixelFormat>(
    picture: &[F::Word],
    width: u16,
) -> Result<Twice<F::Word>, DrawFailure> {
    let other = || DrawFailure::View("the picture has another size".into());
    let row = usize::from(width);
    let height = u16::try_from(picture.len() / row.max(1)).map_err(|_| other())?;
    let twice = |side: u16| side.checked_mul(2).ok_or_else(other);
    let (mut pump, lines_per_transfer) = display::<F::Word>(twice(width)?, twice(height)?);
    let window = Window {
        x: 0,
        y: 0,
        width,
        height,
    };
    let mut memory = [(); 2].map(|()| vec![F::Word::default(); row]);
    let [above, below] = &mut memory;
    send_doubled(
        &mut pump,
        window,
        lines_per_transfer,
        [above, below],
        F::mix_lines,
        |line, pixels| {
            let drawn = picture.chunks_exact(row).nth(line.into());
            pixels.copy_from_slice(drawn.unwrap_or_default());
            Ok(())
        },
    )
    .map_err(|error| DrawFailure::Display(FrameError::ScanOut(error)))?;
    Ok(Twice {
        words: pump.sink().frame().map_err(DrawFailure::Incomplete)?,
        stats: pump.stats(),
        lines_per_transfer,
    })
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
    let width = u16::try_from(drawn.frame.width()).map_err(|_| other())?;
    let rgb = drawn.frame.rgb().chunks_exact(3);
    let picture: Vec<F::Word> = rgb.map(|c| F::from_rgb8([c[0], c[1], c[2]])).collect();
    let sent = twice::<F>(&picture, width)?;
    let rows = sent
        .words
        .chunks(2 * usize::from(width))
        .take(lines as usize);
    let shown = rows.flat_map(|row| row.iter().take(columns as usize));
    let rgb = shown.flat_map(|&word| F::to_rgb8(word)).collect();
    let mut doubled = drawn;
    doubled.frame = Frame::new(columns, lines, rgb).ok_or_else(other)?;
    doubled.used.scan_out = sent.stats;
    let line = usize::from(width) * size_of::<F::Word>();
    // Two buffers of lines that are sent, and two lines that are drawn.
    doubled.figures.line_bytes = 4 * line * usize::from(sent.lines_per_transfer) + 2 * line;
    Ok(doubled)
}
