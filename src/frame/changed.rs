//! Frames of which what the display shows already is not sent (X4).
//!
//! An overlay paints over each line between drawing and sending, so what counts as changed is a line with all that is
//! over it.

use super::renderer::Renderer;
use super::send::{FrameError, FrameUse, Lines, send, window};
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
    let mut lines = Lines::new(scene, background, overlay);
    let mut end = scene.lines().start;
    let draw = |renderer: &mut Renderer<'_, L, WORDS>, line, pixels: &mut [WordOf<L>]| {
        let is_active = lines.draw(renderer, line, pixels)?;
        end = line + 1;
        Ok((is_active, shown.replace(line, pixels)))
    };
    let begin = Pump::begin_in_parts;
    let sent = send(scene, renderer, pump, lines_per_transfer, begin, draw);
    if sent.is_err() {
        for line in scene.lines().start..end {
            shown.forget_line(line);
        }
    }
    sent
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
