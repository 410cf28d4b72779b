//! Frames of indices: each line becomes colours by its own palette on the way to the sink (H18).
//!
//! The sink's buffers have its own pixels; the renderer draws into a lent line of bytes, best in
//! fast RAM, and from there each pixel is looked up. Whatever gives lines can be sent so: several
//! renderers, and what is [`Overlaid`](super::Overlaid) with sprites of indices.

use super::error::RendererError;
use super::frame::{Alone, FrameError, FrameStats, LineSource, window};
use super::lines::LineRenderer;
use super::scene::Scene;
use crate::composite::{Indexed, LinePalettes, expand_indices};
use crate::pipeline::Pipeline;
use crate::scan_out::{ErrorType, LineBuf, Pump, ScanStats, ScanoutDma};

/// Sends the lines of `scene` as [`send_frame`](crate::pipeline::send::send_frame) does. `source` gives their
/// indices, for which `indices` has a byte a pixel, and `palettes` say what these mean on a line.
///
/// # Errors
/// When the sink fails, naming the line, or the source does, or `indices` is shorter than a line.
pub fn send_frame_indexed<P, D, const N: usize>(
    scene: &Scene<'_, P>,
    source: &mut impl LineSource<P>,
    pump: &mut Pump<D>,
    lines_per_transfer: u16,
    (indices, palettes): (&mut [u8], impl LinePalettes<<D::Buf as LineBuf>::Word, N>),
) -> Result<ScanStats, FrameError<<D as ErrorType>::Error>>
where
    P: Pipeline<Pixel = Indexed<N>>,
    D: ScanoutDma,
{
    let mut palettes = palettes;
    let (needed, have) = (usize::from(scene.screen().width()), indices.len());
    let Some(indices) = indices.get_mut(..needed) else {
        return Err(RendererError::Pixels { needed, have }.into());
    };
    pump.take_stats();
    pump.begin(window(scene), lines_per_transfer)?;
    for line in scene.lines() {
        source.line(line, indices)?;
        expand_indices(indices, palettes.palette(line), pump.line()?);
        pump.line_done()?;
        source.idle(line + 1);
    }
    pump.finish()?;
    Ok(pump.stats())
}

/// Draws all lines of `scene` over the index `background` and sends them as
/// [`send_frame_indexed`] does.
///
/// # Errors
/// Those of [`send_frame_indexed`], and when the renderer has too little memory.
pub fn draw_frame_indexed<P, D, const N: usize>(
    scene: &Scene<'_, P>,
    renderer: &mut LineRenderer<'_, P>,
    pump: &mut Pump<D>,
    background: u8,
    lines_per_transfer: u16,
    by: (&mut [u8], impl LinePalettes<<D::Buf as LineBuf>::Word, N>),
) -> Result<FrameStats, FrameError<<D as ErrorType>::Error>>
where
    P: Pipeline<Pixel = Indexed<N>>,
    D: ScanoutDma,
{
    let mut source = Alone::new(scene, renderer, background)?;
    let scan_out = send_frame_indexed(scene, &mut source, pump, lines_per_transfer, by)?;
    Ok(source.stats(scan_out))
}
