//! All lines of a frame, each drawn while the one before is on its way (K12).

use super::renderer::{LineError, Renderer};
use crate::active::CacheUse;
use crate::look::{Look, WordOf};
use crate::scan_out::{ErrorType, LineBuf, Pump, ScanError, ScanStats, ScanoutDma, Window};
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
    /// Lines on which nothing is active.
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
) -> Result<FrameUse, FrameError<<D as ErrorType>::Error>>
where
    L: Look,
    D: ScanoutDma<Buf: LineBuf<Word = WordOf<L>>>,
{
    renderer.check(scene).map_err(FrameError::Line)?;
    renderer.restart();
    let mut skipped = 0;
    let lines = scene.lines();
    let window = Window {
        x: 0,
        y: lines.start,
        width: scene.screen().width(),
        height: lines.len() as u16,
    };
    pump.take_stats();
    pump.begin(window, lines_per_transfer)?;
    for line in lines {
        let pixels = pump.line()?;
        let drawn = renderer.draw_line(scene, line, pixels, background);
        skipped += u32::from(!drawn.map_err(FrameError::Line)?);
        pump.line_done()?;
    }
    pump.finish()?;
    Ok(FrameUse {
        assembled: scene.assembled(),
        cache: renderer.counts(),
        lines_skipped: skipped,
        scan_out: pump.stats(),
    })
}
