//! Frames of indices: each line becomes colours by its own palette on the way to the sink (H18).
//!
//! The sink's buffers have its own pixels; the renderer draws into a lent line of bytes, best in fast RAM, and from there
//! each pixel is looked up.

use super::renderer::{LineError, Renderer};
use super::send::{FrameError, FrameUse, Lines, SentBy, send};
use crate::look::Look;
use crate::pixel::Indexed;
use crate::scan_out::{Pump, ScanoutDma};
use crate::scene::Scene;

/// Draws and sends all lines of `scene` as [`draw_frame`](super::draw_frame) does, over the index `background`. `indices`
/// has a byte for each pixel of a line; `expand` is given a line's number and bytes and writes what they mean there, mostly
/// by [`expand_indices`](crate::pixel::expand_indices). Lines come in the order in which they are drawn, so a palette may
/// change as they go.
///
/// # Errors
/// When the sink fails, naming the line, or the renderer has too little memory, or `indices` is shorter than a line.
pub fn draw_frame_indexed<L, D, const N: usize, const WORDS: usize>(
    scene: &Scene<'_, '_, L>,
    renderer: &mut Renderer<'_, L, WORDS>,
    pump: &mut Pump<D>,
    background: u8,
    lines_per_transfer: u16,
    indices: &mut [u8],
    mut expand: impl FnMut(u16, &[u8], &mut [SentBy<D>]),
) -> Result<FrameUse, FrameError<D::Error>>
where
    L: Look<Pixel = Indexed<N>>,
    D: ScanoutDma,
{
    let (needed, have) = (usize::from(scene.screen().width()), indices.len());
    let short = FrameError::Line(LineError::Pixels { needed, have });
    let indices = indices.get_mut(..needed).ok_or(short)?;
    let mut lines = Lines::new(scene, background, |_, _| {});
    let draw = |renderer: &mut Renderer<'_, L, WORDS>, line, pixels: &mut [SentBy<D>]| {
        let is_active = lines.draw(renderer, line, indices)?;
        expand(line, indices, pixels);
        Ok((is_active, true))
    };
    send(scene, renderer, pump, lines_per_transfer, Pump::begin, draw)
}
