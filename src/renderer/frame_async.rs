//! A whole frame on an awaited sink: lines are drawn while the band above them is sent (X5, feature `async`).

use super::frame::{Alone, FrameError, FrameStats, LineSource, window};
use super::lines::LineRenderer;
use super::scene::Scene;
use crate::pipeline::{Pipeline, WordOf};
use crate::scan_out::{AsyncLineWriter, AsyncPump, ErrorType, ScanStats};

/// Draws all lines of `scene` over `background` and sends them through `pump`, as
/// [`draw_frame`](crate::draw_frame) does. Between lines it is the turn of other tasks.
///
/// # Errors
/// When the sink fails, naming the line, or the renderer has too little memory.
pub async fn draw_frame_async<P, D>(
    scene: &Scene<'_, P>,
    renderer: &mut LineRenderer<'_, P>,
    pump: &mut AsyncPump<'_, D>,
    background: WordOf<P>,
    lines_per_transfer: u16,
) -> Result<FrameStats, FrameError<<D as ErrorType>::Error>>
where
    P: Pipeline,
    D: AsyncLineWriter<Word = WordOf<P>>,
{
    let mut source = Alone::new(scene, renderer, background)?;
    let scan_out = send_frame_async(scene, &mut source, pump, lines_per_transfer).await?;
    Ok(source.stats(scan_out))
}

/// Sends the lines of `scene` through `pump` in order, as `source` gives them: the awaited
/// twin of [`send_frame`](crate::send::send_frame).
///
/// # Errors
/// When the sink fails, naming the line, or the source does.
pub async fn send_frame_async<P, D>(
    scene: &Scene<'_, P>,
    source: &mut impl LineSource<P>,
    pump: &mut AsyncPump<'_, D>,
    lines_per_transfer: u16,
) -> Result<ScanStats, FrameError<<D as ErrorType>::Error>>
where
    P: Pipeline,
    D: AsyncLineWriter<Word = WordOf<P>>,
{
    pump.take_stats();
    let window = window(scene);
    pump.frame::<FrameError<_>>(window, lines_per_transfer, |below, pixels| {
        let line = window.y.saturating_add(below);
        source.line(line, pixels)?;
        source.idle(line.saturating_add(1));
        Ok(())
    })
    .await?;
    Ok(pump.stats())
}
