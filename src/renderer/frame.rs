//! A whole frame: every line drawn and sent while the one before is on its way (K12).

use super::error::RendererError;
use super::lines::LineRenderer;
use super::scene::Scene;
use crate::active::Interleave;
use crate::composite::PixelFormat;
use crate::event::{Event, EventSet};
use crate::pipeline::{Pipeline, WordOf};
use crate::scan_out::{ErrorType, LineBuf, Pump, ScanError, ScanStats, ScanoutDma, Window};
use crate::stats::CacheCounts;
use crate::stats::PassOne;
use crate::stats::SpanCounts;

/// Why a frame was not finished. The pump has its buffers back, and the next frame is whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum FrameError<E> {
    /// The sink failed.
    ScanOut(ScanError<E>),
    /// The line renderer has too little memory.
    Renderer(RendererError),
}

impl<E> From<RendererError> for FrameError<E> {
    fn from(error: RendererError) -> Self {
        Self::Renderer(error)
    }
}

impl<E> From<ScanError<E>> for FrameError<E> {
    fn from(error: ScanError<E>) -> Self {
        Self::ScanOut(error)
    }
}

impl<E: crate::scan_out::Error> core::fmt::Display for FrameError<E> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::ScanOut(error) => error.fmt(f),
            Self::Renderer(error) => error.fmt(f),
        }
    }
}

impl<E: crate::scan_out::Error> core::error::Error for FrameError<E> {}

/// What a frame took, and what it was spared (M4, C8).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FrameStats {
    /// Pass one.
    pub pass_one: PassOne,
    /// Spans and pixels; all 0 where the pipeline does not count.
    pub spans: SpanCounts,
    /// The object cache.
    pub cache: CacheCounts,
    /// Bytes read from records in slow memory: objects, vertices and links.
    pub slow_read_bytes: u64,
    /// Of these, bytes of records that were read ahead of their line.
    pub prefetch_bytes: u64,
    /// Bytes written to slow memory while lines were drawn: links alone.
    pub slow_write_bytes: u64,
    /// Lines on which nothing is active: cleared and sent, but not drawn.
    pub scanlines_skipped: u32,
    /// What was sent.
    pub scan_out: ScanStats,
}

impl FrameStats {
    /// Adds what a line renderer has done since its restart, and starts its span counts anew.
    pub fn add_renderer<P: Pipeline>(&mut self, renderer: &mut LineRenderer<'_, P>) {
        let cache = renderer.cache_counts();
        let record = LineRenderer::<P>::RECORD_BYTES;
        let ahead = u64::from(cache.fetched + cache.fetched_in_vain);
        self.slow_read_bytes += cache.slow_read_bytes(record);
        self.prefetch_bytes += ahead * record as u64;
        self.slow_write_bytes += cache.slow_write_bytes();
        self.cache += cache;
        self.spans += renderer.take_span_counts();
    }
}

/// Draws all lines of `scene` over `background` and sends them through `pump`, so many lines a
/// transfer. Between lines, while a transfer runs, the renderer fetches ahead what
/// [`set_prefetch`](LineRenderer::set_prefetch) allows. Its interleave becomes
/// [`ALL`](Interleave::ALL).
///
/// Returns what the frame took: [`FrameStats`] has the counts of pass one, the hits, misses and
/// spills of the object cache and the most slots that were in use at once, bytes to and from slow
/// memory, and what was sent. Spans and pixels are in it where the pipeline is
/// [`Counted`](crate::pipeline::Counted); to count costs instructions.
///
/// # Errors
/// When the sink fails, naming the line, or the renderer has too little memory.
pub fn draw_frame<P, D>(
    scene: &Scene<'_, P>,
    renderer: &mut LineRenderer<'_, P>,
    pump: &mut Pump<D>,
    background: WordOf<P>,
    lines_per_transfer: u16,
) -> Result<FrameStats, FrameError<<D as ErrorType>::Error>>
where
    P: Pipeline,
    D: ScanoutDma<Buf: LineBuf<Word = WordOf<P>>>,
{
    let mut source = Alone::new(scene, renderer, background)?;
    let scan_out = send_frame(scene, &mut source, pump, lines_per_transfer)?;
    Ok(source.stats(scan_out))
}

/// Where the lines of a frame come from: one renderer here, or several anywhere.
pub trait LineSource<P: Pipeline> {
    /// Writes every pixel of `line` of the picture.
    ///
    /// # Errors
    /// When it cannot be drawn; the frame ends there.
    fn line(&mut self, line: u16, pixels: &mut [WordOf<P>]) -> Result<(), RendererError>;

    /// A line was handed on, and a transfer may be running: a moment to prepare `line`, the next.
    fn idle(&mut self, line: u16) {
        let _ = line;
    }
}

/// Sends the lines of `scene` through `pump` in order, so many a transfer, as `source` gives
/// them: the conductor of [`draw_frame`], for those who have the lines drawn in their own way.
///
/// # Errors
/// When the sink fails, naming the line, or the source does.
pub fn send_frame<P, D>(
    scene: &Scene<'_, P>,
    source: &mut impl LineSource<P>,
    pump: &mut Pump<D>,
    lines_per_transfer: u16,
) -> Result<ScanStats, FrameError<<D as ErrorType>::Error>>
where
    P: Pipeline,
    D: ScanoutDma<Buf: LineBuf<Word = WordOf<P>>>,
{
    pump.take_stats();
    pump.begin(window(scene), lines_per_transfer)?;
    for line in scene.lines() {
        source.line(line, pump.line()?)?;
        pump.line_done()?;
        source.idle(line + 1);
    }
    pump.finish()?;
    Ok(pump.stats())
}

/// The part of the display that a scene fills.
fn window<P: Pipeline>(scene: &Scene<'_, P>) -> Window {
    let lines = scene.lines();
    Window {
        x: 0,
        y: lines.start,
        width: scene.screen().width(),
        height: lines.len() as u16,
    }
}

/// One renderer that draws every line itself.
pub(super) struct Alone<'a, 'm, 'r, P: Pipeline> {
    scene: &'a Scene<'m, P>,
    renderer: &'a mut LineRenderer<'r, P>,
    background: WordOf<P>,
    skipped: u32,
}

impl<'a, 'm, 'r, P: Pipeline> Alone<'a, 'm, 'r, P> {
    pub(super) fn new(
        scene: &'a Scene<'m, P>,
        renderer: &'a mut LineRenderer<'r, P>,
        background: WordOf<P>,
    ) -> Result<Self, RendererError> {
        renderer.set_interleave(Interleave::ALL);
        renderer.check(scene)?;
        renderer.restart();
        Ok(Self {
            scene,
            renderer,
            background,
            skipped: 0,
        })
    }

    /// What the frame took, which the log gets at trace level.
    pub(super) fn stats(self, scan_out: ScanStats) -> FrameStats {
        let mut stats = FrameStats {
            pass_one: self.scene.pass_one(),
            scanlines_skipped: self.skipped,
            scan_out,
            ..FrameStats::default()
        };
        stats.add_renderer(self.renderer);
        #[cfg(feature = "defmt")]
        defmt::trace!("frame: {}", stats);
        stats
    }
}

impl<P: Pipeline> LineSource<P> for Alone<'_, '_, '_, P> {
    #[inline]
    fn line(&mut self, line: u16, pixels: &mut [WordOf<P>]) -> Result<(), RendererError> {
        P::Pixel::fill(pixels, self.background);
        if !self.renderer.draw_line(self.scene, line, pixels)? {
            self.skipped += 1;
        }
        Ok(())
    }

    #[inline]
    fn idle(&mut self, line: u16) {
        self.renderer.prefetch_for(self.scene, line);
    }
}

impl FrameStats {
    /// The events of a frame that was drawn (H14). Those of pixels need a pipeline that counts.
    #[must_use]
    pub fn events(&self) -> EventSet {
        let spans = &self.spans;
        let is_drawn = spans.pixels_shaded > 0;
        EventSet::of([
            (Event::PixelRendered, is_drawn),
            (Event::Clipped, self.pass_one.clipped > 0),
            (Event::DepthPassed, spans.depth_tests > 0 && is_drawn),
            (Event::DepthFailed, spans.pixels_hidden > 0),
            (Event::Full, self.pass_one.dropped > 0),
            (Event::Untextured, self.pass_one.untextured > 0),
        ])
    }
}
