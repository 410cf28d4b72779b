//! Lines from other cores to the one that sends them, in order (K16, X6).
//!
//! Every worker has two single-producer queues: drawn lines go one way, empty buffers the other.
//! The desk asks for lines in the order of the picture and copies them into the pump's buffer (a
//! word a pixel; the buffers themselves belong to the DMA), so scan-out stays in order whoever
//! is faster, and a worker is at most as many lines ahead as it has buffers. Nobody shares
//! anything else but the scene, read-only.

use super::error::RendererError;
use super::frame::{FrameStats, LineSource};
use super::lines::LineRenderer;
use super::scene::Scene;
use crate::active::Interleave;
use crate::composite::PixelFormat;
use crate::pipeline::{Pipeline, WordOf};
use crate::scan_out::{LineBuf, ScanStats};
use core::task::Poll;
use heapless::spsc::{Consumer, Producer, Queue};

/// A line on its way from a worker to the desk.
#[derive(Debug)]
struct Drawn<B> {
    line: u16,
    /// Whether something is active on it, or why it could not be drawn.
    result: Result<bool, RendererError>,
    buf: B,
}

/// The queues between one worker and the desk, with room for `N - 1` line buffers.
#[derive(Debug)]
pub struct Relay<B, const N: usize> {
    drawn: Queue<Drawn<B>, N>,
    free: Queue<B, N>,
}

impl<B: LineBuf, const N: usize> Relay<B, N> {
    /// A relay that passes `buffers` to and fro. Those beyond `N - 1` are dropped.
    #[must_use]
    pub fn new(buffers: impl IntoIterator<Item = B>) -> Self {
        let mut free = Queue::new();
        for buf in buffers.into_iter().take(N.saturating_sub(1)) {
            // There is room.
            let _ = free.enqueue(buf);
        }
        Self {
            drawn: Queue::new(),
            free,
        }
    }

    /// The end for the core that draws, and the one for the core that sends.
    pub fn split(&mut self) -> (LineWorker<'_, B>, LineDesk<'_, B>) {
        let (to_desk, drawn) = self.drawn.split();
        let (to_worker, free) = self.free.split();
        let worker = LineWorker { to_desk, free };
        (worker, LineDesk { drawn, to_worker })
    }
}

/// The drawing end of a [`Relay`].
pub struct LineWorker<'q, B> {
    to_desk: Producer<'q, Drawn<B>>,
    free: Consumer<'q, B>,
}

impl<B: LineBuf> LineWorker<'_, B> {
    /// Draws `line` over `background` and hands it on; `Pending` when no buffer has come back yet
    /// (the desk is behind), and then nothing was done.
    pub fn step<P>(
        &mut self,
        scene: &Scene<'_, P>,
        renderer: &mut LineRenderer<'_, P>,
        background: WordOf<P>,
        line: u16,
    ) -> Poll<()>
    where
        P: Pipeline,
        B: LineBuf<Word = WordOf<P>>,
    {
        if !self.to_desk.ready() {
            return Poll::Pending;
        }
        let Some(mut buf) = self.free.dequeue() else {
            return Poll::Pending;
        };
        let needed = usize::from(scene.screen().width());
        let pixels = buf.pixels();
        let have = pixels.len();
        let result = match pixels.get_mut(..needed) {
            Some(pixels) => {
                P::Pixel::fill(pixels, background);
                renderer.draw_line(scene, line, pixels)
            }
            None => Err(RendererError::Pixels { needed, have }),
        };
        // There is room: `ready` said so, and nobody else fills this queue.
        let _ = self.to_desk.enqueue(Drawn { line, result, buf });
        Poll::Ready(())
    }

    /// Draws all of the renderer's own lines of `scene`; whenever the desk is behind, fetches
    /// ahead what [`set_prefetch`](LineRenderer::set_prefetch) allows, then calls `wait`, which
    /// may sleep until the other core stirs, and gives up when that says `false`.
    ///
    /// Whether every line was handed on. The log then gets, at trace level, how the renderer's cache
    /// has done.
    pub fn frame<P>(
        &mut self,
        scene: &Scene<'_, P>,
        renderer: &mut LineRenderer<'_, P>,
        background: WordOf<P>,
        mut wait: impl FnMut() -> bool,
    ) -> bool
    where
        P: Pipeline,
        B: LineBuf<Word = WordOf<P>>,
    {
        renderer.restart();
        for line in renderer.interleave().of(scene.lines()) {
            let mut fetched = false;
            while self.step(scene, renderer, background, line).is_pending() {
                if !core::mem::replace(&mut fetched, true) {
                    renderer.prefetch_for(scene, line);
                } else if !wait() {
                    return false;
                }
            }
        }
        #[cfg(feature = "defmt")]
        defmt::trace!("lines of a worker: {}", renderer.cache_counts());
        true
    }
}

/// The sending end of a [`Relay`].
pub struct LineDesk<'q, B> {
    drawn: Consumer<'q, Drawn<B>>,
    to_worker: Producer<'q, B>,
}

impl<B: LineBuf> LineDesk<'_, B> {
    /// Copies the worker's next line, which has to be `line`, into `pixels`; `Pending` when it is
    /// not drawn yet. `true`: something is active on it.
    ///
    /// # Errors
    /// What the worker's renderer said, or [`RendererError::Unowned`] when it is another line.
    pub fn take(&mut self, line: u16, pixels: &mut [B::Word]) -> Poll<Result<bool, RendererError>> {
        let Some(mut drawn) = self.drawn.dequeue() else {
            return Poll::Pending;
        };
        let mut result = drawn.result;
        let (needed, words) = (pixels.len(), drawn.buf.pixels());
        let have = words.len();
        match words.get(..needed) {
            _ if drawn.line != line => result = Err(RendererError::Unowned { line }),
            Some(words) => pixels.copy_from_slice(words),
            None => result = result.and(Err(RendererError::Pixels { needed, have })),
        }
        // There is room for every buffer of the relay.
        let _ = self.to_worker.enqueue(drawn.buf);
        Poll::Ready(result)
    }

    /// Throws away what the worker has drawn so far: after a frame that failed, while the worker
    /// finishes or gives up, and before the next one begins.
    pub fn discard(&mut self) {
        while let Some(drawn) = self.drawn.dequeue() {
            let _ = self.to_worker.enqueue(drawn.buf);
        }
    }
}

/// Several renderers of one scene as a source of lines: those that draw here, each at its turn,
/// and the desks of those elsewhere. A line goes to the first whose interleave owns it.
pub struct Crew<'a, 'm, 'r, 'q, P: Pipeline, B, W> {
    /// What is drawn.
    pub scene: &'a Scene<'m, P>,
    /// The renderers of this core.
    pub here: &'a mut [LineRenderer<'r, P>],
    /// The desks of other cores' workers, and which lines they draw.
    pub desks: &'a mut [(Interleave, LineDesk<'q, B>)],
    /// The colour where nothing is.
    pub background: WordOf<P>,
    /// Called while a line is awaited; `false` gives the frame up.
    pub wait: W,
    /// Lines on which nothing is active.
    pub skipped: u32,
}

impl<P: Pipeline, B, W> Crew<'_, '_, '_, '_, P, B, W> {
    /// What a frame took that was sent as `scan_out` says, with what the renderers of this core have
    /// done since their restart; the log gets it at trace level. Lines without anything active are
    /// counted anew from here on. Workers elsewhere log what theirs have done;
    /// [`FrameStats::add_renderer`] adds it where they can be reached.
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

impl<P, B, W> LineSource<P> for Crew<'_, '_, '_, '_, P, B, W>
where
    P: Pipeline,
    B: LineBuf<Word = WordOf<P>>,
    W: FnMut() -> bool,
{
    fn line(&mut self, line: u16, pixels: &mut [WordOf<P>]) -> Result<(), RendererError> {
        let active = if let Some(here) = self.here.iter_mut().find(|r| r.interleave().owns(line)) {
            P::Pixel::fill(pixels, self.background);
            here.draw_line(self.scene, line, pixels)?
        } else if let Some((_, desk)) = self.desks.iter_mut().find(|d| d.0.owns(line)) {
            loop {
                match desk.take(line, pixels) {
                    Poll::Ready(result) => break result?,
                    Poll::Pending if (self.wait)() => {}
                    Poll::Pending => return Err(RendererError::Stopped { line }),
                }
            }
        } else {
            return Err(RendererError::Unowned { line });
        };
        self.skipped += u32::from(!active);
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
