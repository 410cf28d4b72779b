//! Frames with an overlay: each line is painted over between drawing and sending (K14).
//!
//! A source of lines is wrapped, so it does not matter who draws, and lines that have not changed
//! are still known by all that is on them (X4).

use super::error::RendererError;
use super::frame::{Alone, FrameError, FrameStats, LineSource, send_changed, send_frame};
use super::lines::LineRenderer;
use super::scene::Scene;
use crate::composite::LineOverlay;
use crate::pipeline::{Pipeline, WordOf};
use crate::scan_out::{ErrorType, LineBuf, LineWord, Pump, ScanoutDma, ShownLines};

/// Lines of a source, and an overlay over them.
#[derive(Debug)]
pub struct Overlaid<S, O> {
    /// Where the lines come from.
    pub source: S,
    /// What is over them.
    pub overlay: O,
}

impl<P: Pipeline, S: LineSource<P>, O: LineOverlay<P::Pixel>> LineSource<P> for Overlaid<S, O> {
    #[inline]
    fn line(&mut self, line: u16, pixels: &mut [WordOf<P>]) -> Result<(), RendererError> {
        self.source.line(line, pixels)?;
        self.overlay.paint(line, pixels);
        Ok(())
    }

    #[inline]
    fn idle(&mut self, line: u16) {
        self.source.idle(line);
    }
}

/// Draws and sends all lines of `scene` as [`draw_frame`](crate::pipeline::draw_frame) does, with `overlay`
/// over them.
///
/// # Errors
/// When the sink fails, naming the line, or the renderer has too little memory.
pub fn draw_frame_overlaid<P, D>(
    scene: &Scene<'_, P>,
    renderer: &mut LineRenderer<'_, P>,
    pump: &mut Pump<D>,
    background: WordOf<P>,
    lines_per_transfer: u16,
    overlay: impl LineOverlay<P::Pixel>,
) -> Result<FrameStats, FrameError<<D as ErrorType>::Error>>
where
    P: Pipeline,
    D: ScanoutDma<Buf: LineBuf<Word = WordOf<P>>>,
{
    let source = Alone::new(scene, renderer, background)?;
    let mut source = Overlaid { source, overlay };
    let scan_out = send_frame(scene, &mut source, pump, lines_per_transfer)?;
    Ok(source.source.stats(scan_out))
}

/// The same, and only lines that differ from what `shown` knows are sent, as
/// [`draw_frame_changed`](crate::pipeline::send::draw_frame_changed) does: what counts is the line with all that
/// is over it.
///
/// # Errors
/// Those of [`draw_frame_overlaid`]; the lines that were reached count as not shown then.
pub fn draw_frame_overlaid_changed<P, D>(
    scene: &Scene<'_, P>,
    renderer: &mut LineRenderer<'_, P>,
    pump: &mut Pump<D>,
    (background, lines_per_transfer): (WordOf<P>, u16),
    shown: &mut ShownLines<'_>,
    overlay: impl LineOverlay<P::Pixel>,
) -> Result<FrameStats, FrameError<<D as ErrorType>::Error>>
where
    P: Pipeline,
    WordOf<P>: LineWord,
    D: ScanoutDma<Buf: LineBuf<Word = WordOf<P>>>,
{
    let source = Alone::new(scene, renderer, background)?;
    let mut source = Overlaid { source, overlay };
    let scan_out = send_changed(scene, &mut source, pump, lines_per_transfer, shown)?;
    Ok(source.source.stats(scan_out))
}
