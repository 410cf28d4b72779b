//! A whole frame: every line drawn and sent while the one before is on its way (K12).

use super::lines::{LineRenderer, RendererError};
use super::scene::{PassOne, Scene};
use crate::active::CacheCounts;
use crate::composite::PixelFormat;
use crate::pipeline::{ObjectOf, Pipeline, VertexOf, WordOf};
use crate::scan_out::{ErrorType, LineBuf, Pump, ScanError, ScanStats, ScanoutDma, Window};
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

/// What a frame took, and what it was spared (M4).
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
    /// Bytes written to slow memory while lines were drawn: links alone.
    pub slow_write_bytes: u64,
    /// Lines on which nothing is active: cleared and sent, but not drawn.
    pub scanlines_skipped: u32,
    /// What was sent.
    pub scan_out: ScanStats,
}

/// Draws all lines of `scene` over `background` and sends them through `pump`, so many lines a
/// transfer.
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
    let lines = scene.lines();
    let window = Window {
        x: 0,
        y: lines.start,
        width: scene.screen().width(),
        height: lines.len() as u16,
    };
    renderer.check(scene)?;
    renderer.restart();
    pump.take_stats();
    pump.begin(window, lines_per_transfer)?;
    let mut skipped = 0;
    for line in lines {
        let pixels = pump.line()?;
        P::Pixel::fill(pixels, background);
        // The pump lends whole lines and the scene was checked, so this does not fail.
        if !renderer.draw_line(scene, line, pixels)? {
            skipped += 1;
        }
        pump.line_done()?;
    }
    pump.finish()?;
    let cache = renderer.cache_counts();
    let record = size_of::<ObjectOf<P>>() + 3 * size_of::<VertexOf<P>>();
    let link = size_of::<crate::link::Link>();
    Ok(FrameStats {
        pass_one: scene.pass_one(),
        spans: renderer.take_span_counts(),
        cache,
        slow_read_bytes: u64::from(cache.set_ups) * record as u64
            + u64::from(cache.link_reads) * link as u64,
        slow_write_bytes: u64::from(cache.link_writes) * link as u64,
        scanlines_skipped: skipped,
        scan_out: pump.stats(),
    })
}
