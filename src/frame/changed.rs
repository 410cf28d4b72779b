//! Frames of which what the display shows already is not sent (X4).
//!
//! An overlay paints over each line between drawing and sending, so what counts as changed is a line with all that is
//! over it.

use super::renderer::Renderer;
use super::send::{FrameError, FrameUse, Lines, window};
use crate::look::{Look, WordOf};
use crate::scan_out::{LineBuf, Pump, ScanoutDma, ShownLines, ShownRuns};
use crate::scene::Scene;

/// Draws all lines of `scene` with `overlay` over them, and sends those that differ from what `shown` knows the
/// display to show. [`ScanStats`](crate::scan_out::ScanStats) counts the others, and the bytes not sent.
///
/// # Errors
/// Those of [`draw_frame_overlaid`](super::draw_frame_overlaid); the lines that were reached count as not shown then.
pub fn draw_frame_changed<L, D, const WORDS: usize>(
    scene: &Scene<'_, '_, L>,
    renderer: &mut Renderer<'_, L, WORDS>,
    pump: &mut Pump<D>,
    background: WordOf<L>,
    lines_per_transfer: u16,
    shown: &mut ShownLines<'_>,
    overlay: impl FnMut(u16, &mut [WordOf<L>]),
) -> Result<FrameUse, FrameError<D::Error>>
where
    L: Look,
    D: ScanoutDma<Buf: LineBuf<Word = WordOf<L>>>,
{
    renderer.begin_frame(scene).map_err(FrameError::Line)?;
    let mut lines = Lines::new(scene, background, overlay);
    let (mut end, mut skipped) = (scene.lines().start, 0);
    let mut send = || {
        pump.take_stats();
        pump.begin_in_parts(window(scene), lines_per_transfer)?;
        for line in scene.lines() {
            let pixels = pump.line()?;
            let drawn = lines.draw(renderer, line, pixels);
            skipped += u32::from(!drawn.map_err(FrameError::Line)?);
            end = line + 1;
            if shown.replace(line, pixels) {
                pump.line_done()?;
            } else {
                pump.line_left_out()?;
            }
            renderer.fetch_known(scene);
        }
        pump.finish()?;
        Ok(pump.stats())
    };
    let sent = send();
    if sent.is_err() {
        for line in scene.lines().start..end {
            shown.forget_line(line);
        }
    }
    sent.map(|sent| FrameUse::told(scene, renderer, skipped, sent))
}

/// The same for the cells of lines that differ. Rectangles that are sent begin and end at edges of cells, whose size
/// `shown` sets.
///
/// # Errors
/// Those of [`draw_frame_changed`], and [`ScanError::Misaligned`](crate::scan_out::ScanError::Misaligned) when the
/// scene's lines do not begin at the edge of a cell. What an unfinished frame has reached counts as not shown.
pub fn draw_frame_changed_runs<L, D, const WORDS: usize>(
    scene: &Scene<'_, '_, L>,
    renderer: &mut Renderer<'_, L, WORDS>,
    pump: &mut Pump<D>,
    background: WordOf<L>,
    lines_per_transfer: u16,
    shown: &mut ShownRuns<'_>,
    overlay: impl FnMut(u16, &mut [WordOf<L>]),
) -> Result<FrameUse, FrameError<D::Error>>
where
    L: Look,
    D: ScanoutDma<Buf: LineBuf<Word = WordOf<L>>>,
{
    renderer.begin_frame(scene).map_err(FrameError::Line)?;
    let mut lines = Lines::new(scene, background, overlay);
    let mut skipped = 0;
    pump.take_stats();
    let mut frame = pump.begin_in_runs(window(scene), lines_per_transfer, shown)?;
    for line in scene.lines() {
        let pixels = frame.line()?;
        let drawn = lines.draw(renderer, line, pixels);
        skipped += u32::from(!drawn.map_err(FrameError::Line)?);
        frame.line_done()?;
        renderer.fetch_known(scene);
    }
    frame.finish()?;
    Ok(FrameUse::told(scene, renderer, skipped, pump.stats()))
}
