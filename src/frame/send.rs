//! All lines of a frame, each drawn while the one before is on its way (K12, X5).

use super::renderer::{LineError, Renderer, View};
use crate::active::CacheUse;
use crate::look::{Look, WordOf};
#[cfg(feature = "async")]
use crate::scan_out::{AsyncLineWriter, AsyncPump};
use crate::scan_out::{
    ContinuousPanel, FeedStats, LineBuf, Pump, ScanError, ScanStats, ScanoutDma, Window, feed_line,
};
use crate::scene::{Assembled, Scene};
use core::fmt;

/// Why a frame was not finished. The pump has its buffers back, and the next frame is whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum FrameError<E> {
    /// The sink failed.
    ScanOut(ScanError<E>),
    /// The renderer has too little memory.
    Line(LineError),
}

impl<E: crate::scan_out::Error> fmt::Display for FrameError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ScanOut(error) => error.fmt(f),
            Self::Line(error) => error.fmt(f),
        }
    }
}

impl<E: crate::scan_out::Error> core::error::Error for FrameError<E> {}

impl<E> From<ScanError<E>> for FrameError<E> {
    fn from(error: ScanError<E>) -> Self {
        Self::ScanOut(error)
    }
}

/// What a frame took, and what it was spared (M4, C8).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FrameUse {
    /// Pass one.
    pub assembled: Assembled,
    /// The object cache.
    pub cache: CacheUse,
    /// Lines that were skipped, since nothing is active there; that below an object without a slot may be looked at.
    pub lines_skipped: u32,
    /// What was sent.
    pub scan_out: ScanStats,
}

/// Draws all lines of `scene` over `background` and sends them through `pump`, so many lines a transfer; what
/// that took.
///
/// # Errors
/// When the sink fails, naming the line, or the renderer has too little memory.
pub fn draw_frame<L, D, const WORDS: usize>(
    scene: &Scene<'_, '_, L>,
    renderer: &mut Renderer<'_, L, WORDS>,
    pump: &mut Pump<D>,
    background: WordOf<L>,
    lines_per_transfer: u16,
) -> Result<FrameUse, FrameError<D::Error>>
where
    L: Look,
    D: ScanoutDma<Buf: LineBuf<Word = WordOf<L>>>,
{
    let none = |_, _: &mut [WordOf<L>]| {};
    draw_frame_overlaid(scene, renderer, pump, background, lines_per_transfer, none)
}

/// Draws and sends all lines of `scene` as [`draw_frame`] does, with what `overlay` paints over each of them (K14), of
/// sprites say: `|line, pixels| sprites.paint(line, pixels)`.
///
/// # Errors
/// When the sink fails, naming the line, or the renderer has too little memory.
pub fn draw_frame_overlaid<L, D, const WORDS: usize>(
    scene: &Scene<'_, '_, L>,
    renderer: &mut Renderer<'_, L, WORDS>,
    pump: &mut Pump<D>,
    background: WordOf<L>,
    lines_per_transfer: u16,
    overlay: impl FnMut(u16, &mut [WordOf<L>]),
) -> Result<FrameUse, FrameError<D::Error>>
where
    L: Look,
    D: ScanoutDma<Buf: LineBuf<Word = WordOf<L>>>,
{
    let mut lines = Lines::new(scene, background, overlay);
    let draw = |renderer: &mut Renderer<'_, L, WORDS>, line, pixels: &mut [WordOf<L>]| {
        Ok((lines.draw(renderer, line, pixels)?, true))
    };
    send(scene, renderer, pump, lines_per_transfer, Pump::begin, draw)
}

/// The lines of a frame as they are drawn: what they read of the scene, once a frame, what is behind them, and what
/// lies over them.
pub(super) struct Lines<'a, L: Look, O> {
    view: View<'a>,
    background: WordOf<L>,
    overlay: O,
}

impl<'a, L: Look, O: FnMut(u16, &mut [WordOf<L>])> Lines<'a, L, O> {
    pub(super) fn new(scene: &'a Scene<'_, '_, L>, background: WordOf<L>, overlay: O) -> Self {
        Self {
            view: View::of(scene),
            background,
            overlay,
        }
    }

    /// Draws a line of the scene by a renderer that [began](Renderer::begin_frame) with it; whether something is active
    /// there.
    #[inline(always)]
    pub(super) fn draw<const WORDS: usize>(
        &mut self,
        renderer: &mut Renderer<'_, L, WORDS>,
        line: u16,
        pixels: &mut [WordOf<L>],
    ) -> Result<bool, LineError> {
        let (needed, have) = (self.view.frame.width as usize, pixels.len());
        if have != needed {
            return Err(LineError::Pixels { needed, have });
        }
        let is_active = renderer.draw_known(&self.view, line, pixels, self.background);
        (self.overlay)(line, pixels);
        Ok(is_active)
    }
}

/// A pixel as a sink sends it.
pub(super) type SentBy<D> = <<D as ScanoutDma>::Buf as LineBuf>::Word;

/// Sends lines of `scene` in a frame that `begin` begins, each as `draw` writes it, which says whether something is active
/// there, and whether the line is sent.
#[inline(always)]
pub(super) fn send<'m, L: Look, D: ScanoutDma, const WORDS: usize>(
    scene: &Scene<'_, '_, L>,
    renderer: &mut Renderer<'m, L, WORDS>,
    pump: &mut Pump<D>,
    lines_per_transfer: u16,
    begin: impl FnOnce(&mut Pump<D>, Window, u16) -> Result<(), ScanError<D::Error>>,
    mut draw: impl FnMut(
        &mut Renderer<'m, L, WORDS>,
        u16,
        &mut [SentBy<D>],
    ) -> Result<(bool, bool), LineError>,
) -> Result<FrameUse, FrameError<D::Error>> {
    renderer.begin_frame(scene).map_err(FrameError::Line)?;
    let mut skipped = 0;
    pump.take_stats();
    begin(pump, window(scene), lines_per_transfer)?;
    for line in scene.lines() {
        let pixels = pump.line()?;
        let drawn = draw(renderer, line, pixels).inspect_err(|_| pump.give_up());
        let (is_active, is_sent) = drawn.map_err(FrameError::Line)?;
        skipped += u32::from(!is_active);
        if is_sent {
            pump.line_done()?;
        } else {
            pump.line_left_out()?;
        }
        renderer.fetch_known(scene);
    }
    pump.finish()?;
    Ok(FrameUse::told(scene, renderer, skipped, pump.stats()))
}

/// Draws the lines of `scene` for a panel that reads them by its own clock. A line whose deadline is over is
/// counted and left out, and the picture goes on at the next.
///
/// # Errors
/// When the renderer has too little memory, or the panel a line of another width.
pub fn draw_continuous<L, C, const WORDS: usize>(
    scene: &Scene<'_, '_, L>,
    renderer: &mut Renderer<'_, L, WORDS>,
    panel: &mut C,
    background: WordOf<L>,
) -> Result<(FeedStats, FrameUse), LineError>
where
    L: Look,
    C: ContinuousPanel<Word = WordOf<L>>,
{
    renderer.begin_frame(scene)?;
    let mut lines = Lines::new(scene, background, |_, _| {});
    let mut skipped = 0;
    let mut fed = FeedStats::default();
    for line in scene.lines() {
        fed.count(feed_line(panel, line, |line, pixels| {
            skipped += u32::from(!lines.draw(renderer, line, pixels)?);
            Ok(())
        })?);
        renderer.fetch_known(scene);
    }
    let sent = ScanStats::default();
    Ok((fed, FrameUse::told(scene, renderer, skipped, sent)))
}

/// Draws all lines of `scene` over `background` and sends them through `pump`, as [`draw_frame`] does. Between lines it
/// is the turn of other tasks.
///
/// # Errors
/// When the sink fails, naming the line, or the renderer has too little memory.
#[cfg(feature = "async")]
pub async fn draw_frame_async<L, D, const WORDS: usize>(
    scene: &Scene<'_, '_, L>,
    renderer: &mut Renderer<'_, L, WORDS>,
    pump: &mut AsyncPump<'_, D>,
    background: WordOf<L>,
    lines_per_transfer: u16,
) -> Result<FrameUse, FrameError<D::Error>>
where
    L: Look,
    D: AsyncLineWriter<Word = WordOf<L>>,
{
    renderer.begin_frame(scene).map_err(FrameError::Line)?;
    let mut lines = Lines::new(scene, background, |_, _| {});
    let mut skipped = 0;
    pump.take_stats();
    let window = window(scene);
    pump.frame(window, lines_per_transfer, |below, pixels| {
        let line = window.y.saturating_add(below);
        let drawn = lines.draw(renderer, line, pixels);
        skipped += u32::from(!drawn.map_err(FrameError::Line)?);
        // The band above is on its way.
        renderer.fetch_known(scene);
        Ok::<_, FrameError<_>>(())
    })
    .await?;
    Ok(FrameUse::told(scene, renderer, skipped, pump.stats()))
}

/// The part of the display that a scene fills.
pub(super) fn window<L>(scene: &Scene<'_, '_, L>) -> Window {
    let lines = scene.lines();
    Window {
        x: 0,
        y: lines.start,
        width: scene.screen().width(),
        height: lines.len() as u16,
    }
}

impl FrameUse {
    /// What a frame took; the log gets it at trace level.
    pub(super) fn told<L: Look, const WORDS: usize>(
        scene: &Scene<'_, '_, L>,
        renderer: &Renderer<'_, L, WORDS>,
        lines_skipped: u32,
        scan_out: ScanStats,
    ) -> Self {
        let told = Self {
            assembled: scene.assembled(),
            cache: renderer.counts(),
            lines_skipped,
            scan_out,
        };
        #[cfg(feature = "defmt")]
        defmt::trace!("frame: {}", told);
        told
    }
}
