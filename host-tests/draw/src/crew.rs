//! Several line renderers of one scene, each on a thread of its own (K16, X6).
//!
//! Threads share the scene by reference and nothing else; what each draws comes back through a
//! channel, and this thread sends it in order.

use crate::CrewSettings;
use host_support::lent::LineRooms;
use scanbeam::pipeline::parallel::{Crew, Interleave, LineSource};
use scanbeam::pipeline::send::send_frame;
use scanbeam::pipeline::{
    FrameError, FrameStats, LineRenderer, Pipeline, RendererError, Scene, WordOf,
};
use scanbeam::scan_out::{ErrorType, LineBuf, Pump, ScanoutDma};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};

/// Lines that a thread may be ahead of the sender.
const AHEAD: usize = 4;

/// The words of a line on its way to the sender.
type Drawn<W> = Result<Vec<W>, RendererError>;

/// A renderer in each of the rooms, which share the lines of the picture.
pub fn renderers<P: Pipeline>(
    rooms: &mut [LineRooms<P>],
    settings: CrewSettings,
) -> Vec<LineRenderer<'_, P>> {
    let count = rooms.len() as u16;
    let mut renderers: Vec<_> = rooms.iter_mut().map(LineRooms::renderer).collect();
    for (renderer, offset) in renderers.iter_mut().zip(0..) {
        renderer.set_interleave(Interleave::lines(count, offset).unwrap_or_default());
        renderer.set_prefetch(settings.prefetch);
        renderer.set_quality(settings.quality);
        renderer.set_depth_use(settings.depth_use);
    }
    renderers
}

/// Draws a frame: alone by [`scanbeam::pipeline::draw_frame`], or by a thread for each renderer.
///
/// # Errors
/// When the sink fails, naming the line, or a renderer has too little memory.
pub fn draw_frame<P, D>(
    scene: &Scene<'_, P>,
    renderers: &mut [LineRenderer<'_, P>],
    pump: &mut Pump<D>,
    background: WordOf<P>,
    lines_per_transfer: u16,
) -> Result<FrameStats, FrameError<<D as ErrorType>::Error>>
where
    P: Pipeline<Textures: Sync>,
    D: ScanoutDma<Buf: LineBuf<Word = WordOf<P>>>,
{
    if let [renderer] = renderers {
        return scanbeam::pipeline::draw_frame(
            scene,
            renderer,
            pump,
            background,
            lines_per_transfer,
        );
    }
    let mut stats = std::thread::scope(|threads| {
        let mut lines = Vec::new();
        let mut drawing = Vec::new();
        for renderer in renderers.iter_mut() {
            let (sender, drawn) = sync_channel(AHEAD);
            lines.push((renderer.interleave(), drawn));
            drawing.push(threads.spawn(move || draw_lines(scene, renderer, background, &sender)));
        }
        let sent = send_frame(scene, &mut Threads(lines), pump, lines_per_transfer);
        // The channels are gone: threads end, as nobody takes their lines.
        let skipped = drawing.into_iter().map(|thread| match thread.join() {
            Ok(skipped) => skipped,
            Err(panic) => std::panic::resume_unwind(panic),
        });
        let scanlines_skipped = skipped.sum();
        sent.map(|scan_out| FrameStats {
            pass_one: scene.pass_one(),
            scanlines_skipped,
            scan_out,
            ..FrameStats::default()
        })
    })?;
    for renderer in renderers {
        stats.add_renderer(renderer);
    }
    Ok(stats)
}

/// Draws a renderer's own lines of a scene, until nobody takes them; on how many of them nothing is active.
fn draw_lines<P: Pipeline>(
    scene: &Scene<'_, P>,
    renderer: &mut LineRenderer<'_, P>,
    background: WordOf<P>,
    sender: &SyncSender<Drawn<WordOf<P>>>,
) -> u32 {
    let width = usize::from(scene.screen().width());
    renderer.restart();
    let own = renderer.interleave();
    let mut crew = Crew {
        scene,
        here: std::slice::from_mut(renderer),
        background,
        skipped: 0,
    };
    for line in own.of(scene.lines()) {
        let mut pixels = vec![background; width];
        let drawn = crew.line(line, &mut pixels).map(|()| pixels);
        let sent = match sender.try_send(drawn) {
            Err(TrySendError::Full(drawn)) => {
                crew.idle(line);
                sender.send(drawn).is_ok()
            }
            sent => sent.is_ok(),
        };
        if !sent {
            break;
        }
    }
    crew.skipped
}

/// The lines of threads, in order.
struct Threads<W>(Vec<(Interleave, Receiver<Drawn<W>>)>);

impl<P: Pipeline> LineSource<P> for Threads<WordOf<P>> {
    fn line(&mut self, line: u16, pixels: &mut [WordOf<P>]) -> Result<(), RendererError> {
        let owner = self.0.iter().find(|(lines, _)| lines.owns(line));
        let drawn = owner.and_then(|(_, lines)| lines.recv().ok());
        pixels.copy_from_slice(&drawn.ok_or(RendererError::Unowned { line })??);
        Ok(())
    }
}
