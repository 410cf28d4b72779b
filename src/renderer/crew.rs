//! Several renderers of one scene, each with lines of its own (K16, X6).

use super::error::RendererError;
use super::frame::{FrameStats, LineSource};
use super::lines::LineRenderer;
use super::scene::Scene;
use crate::composite::PixelFormat;
use crate::pipeline::{Pipeline, WordOf};
use crate::scan_out::ScanStats;

/// Several renderers of one scene as a source of lines, each at its turn. A line goes to the first whose interleave owns
/// it.
pub struct Crew<'a, 'm, 'r, P: Pipeline> {
    /// What is drawn.
    pub scene: &'a Scene<'m, P>,
    /// The renderers.
    pub here: &'a mut [LineRenderer<'r, P>],
    /// The colour where nothing is.
    pub background: WordOf<P>,
    /// Lines on which nothing is active.
    pub skipped: u32,
}

impl<P: Pipeline> Crew<'_, '_, '_, P> {
    /// What a frame took that was sent as `scan_out` says, with what the renderers have done since their restart; the log
    /// gets it at trace level. Lines without anything active are counted anew from here on.
    pub fn stats(&mut self, scan_out: ScanStats) -> FrameStats {
        let mut stats = FrameStats {
            pass_one: self.scene.pass_one(),
            scanlines_skipped: core::mem::take(&mut self.skipped),
            scan_out,
            ..FrameStats::default()
        };
        for renderer in self.here.iter_mut() {
            stats.add_renderer(renderer);
        }
        #[cfg(feature = "defmt")]
        defmt::trace!("frame: {}", stats);
        stats
    }
}

impl<P: Pipeline> LineSource<P> for Crew<'_, '_, '_, P> {
    fn line(&mut self, line: u16, pixels: &mut [WordOf<P>]) -> Result<(), RendererError> {
        let owner = self.here.iter_mut().find(|r| r.interleave().owns(line));
        let owner = owner.ok_or(RendererError::Unowned { line })?;
        P::Pixel::fill(pixels, self.background);
        self.skipped += u32::from(!owner.draw_line(self.scene, line, pixels)?);
        Ok(())
    }

    fn idle(&mut self, line: u16) {
        for renderer in self.here.iter_mut() {
            if renderer.interleave().owns(line) {
                renderer.prefetch_for(self.scene, line);
            }
        }
    }
}
