//! Formats of pixels beside the two common ones: 32 bits, grey, and one bit.

use super::{CrewSettings, DrawFailure, Drawn, Prepared, draw_as};
use crate::choice::PixelFormatArg;
use host_support::image_out::Frame;
use host_support::reference::{Shade, View};
use scanbeam::pipeline::{Counted, FlatDepth, GouraudDepth};
use scanbeam::pixel::{Grey8, PixelFormat, Rgb565Be, Rgb888, Xrgb8888, mono_row};

/// Draws a model with the pipeline that the view and the format ask for.
pub(super) fn draw_in(
    prepared: &Prepared,
    view: &View,
    format: PixelFormatArg,
    crew: CrewSettings,
) -> Result<Drawn, DrawFailure> {
    match format {
        PixelFormatArg::Rgb888 => shaded::<Rgb888>(prepared, view, crew),
        PixelFormatArg::Rgb565 => shaded::<Rgb565Be>(prepared, view, crew),
        PixelFormatArg::Dithered565 => Err(refused("methods can be chosen")),
        PixelFormatArg::Xrgb8888 => shaded::<Xrgb8888>(prepared, view, crew),
        PixelFormatArg::Grey8 => shaded::<Grey8>(prepared, view, crew),
        PixelFormatArg::Mono => {
            let mut drawn = shaded::<Grey8>(prepared, view, crew)?;
            drawn.stats.scan_out.bytes_sent = mono(&mut drawn.frame)?;
            Ok(drawn)
        }
    }
}

fn shaded<F: PixelFormat>(
    prepared: &Prepared,
    view: &View,
    crew: CrewSettings,
) -> Result<Drawn, DrawFailure> {
    match view.shade {
        Shade::Flat => draw_as::<Counted<FlatDepth<F>>>(prepared, view, crew),
        _ => draw_as::<Counted<GouraudDepth<F>>>(prepared, view, crew),
    }
}

/// Makes of a grey picture what a display of one bit shows of it, whose lines are packed; how many bytes they are.
pub(super) fn mono(frame: &mut Frame) -> Result<u64, DrawFailure> {
    let (width, height) = (frame.width(), frame.height());
    let grey: Vec<u8> = frame.rgb().iter().step_by(3).copied().collect();
    let mut packed = vec![0; width.div_ceil(8) as usize];
    let mut rgb = Vec::new();
    let mut sent = 0;
    for (line, grey) in (0..).zip(grey.chunks(width as usize)) {
        mono_row(grey, line, &mut packed);
        sent += packed.len();
        for x in 0..width as usize {
            let white = packed[x / 8] >> (7 - x % 8) & 1;
            rgb.extend([255 * white; 3]);
        }
    }
    *frame = Frame::new(width, height, rgb)
        .ok_or_else(|| DrawFailure::View("the picture has another size".into()))?;
    Ok(sent as u64)
}

/// What draws in the two common formats alone says of another.
pub(super) fn refused(what: &str) -> DrawFailure {
    DrawFailure::View(format!("{what} with --format rgb888 or rgb565 alone"))
}
