//! The formats of pixels that pictures are drawn in.

use super::{DrawFailure, Drawn};
use crate::choice::PixelFormatArg;
use host_support::image_out::Frame;
use scanbeam::look::{Look, Textured, TexturedPhong};
use scanbeam::pixel::{Grey8, PixelFormat, Rgb565, Rgb565Be, Rgb888, Xrgb8888, mono_row};

/// What is drawn in any format.
pub(super) trait Picture {
    /// Whether it has textures.
    fn is_textured(&self) -> bool;

    /// Draws it without textures.
    fn plain<F: PixelFormat + Sync>(&self) -> Result<Drawn, DrawFailure>;

    /// Draws it with textures whose texels are pixels of the format `T`.
    fn textured<F, T>(&self) -> Result<Drawn, DrawFailure>
    where
        F: PixelFormat + Sync,
        T: PixelFormat<Word = u16>,
        Textured<F>: Look<Pixel = F, Planes: Send>,
        TexturedPhong<F>: Look<Pixel = F, Planes: Send>;
}

/// Draws a picture in a format; whether it is dithered is for itself to know.
pub(super) fn draw_in(
    picture: &impl Picture,
    format: PixelFormatArg,
) -> Result<Drawn, DrawFailure> {
    use PixelFormatArg as Arg;
    match (format, picture.is_textured()) {
        (Arg::Rgb888, false) => picture.plain::<Rgb888>(),
        (Arg::Xrgb8888, false) => picture.plain::<Xrgb8888>(),
        (Arg::Rgb565 | Arg::Dithered565, false) => picture.plain::<Rgb565Be>(),
        (Arg::Grey8, false) => picture.plain::<Grey8>(),
        (Arg::Mono, false) => {
            let mut drawn = picture.plain::<Grey8>()?;
            drawn.used.scan_out.bytes_sent = mono(&mut drawn.frame)?;
            Ok(drawn)
        }
        (Arg::Rgb888, true) => picture.textured::<Rgb888, Rgb565>(),
        (Arg::Xrgb8888, true) => picture.textured::<Xrgb8888, Rgb565>(),
        (Arg::Rgb565 | Arg::Dithered565, true) => picture.textured::<Rgb565Be, Rgb565Be>(),
        (Arg::Grey8 | Arg::Mono, true) => Err(DrawFailure::View(
            "textures are drawn with --format rgb888, rgb565 or xrgb8888 alone".into(),
        )),
    }
}

/// Makes of a grey picture what a display of one bit shows of it, whose lines are packed; how many bytes they are.
fn mono(frame: &mut Frame) -> Result<u64, DrawFailure> {
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
