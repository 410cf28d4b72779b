//! Several line renderers of one scene, each on a thread of its own (K16, X6).
//!
//! Threads share the scene by reference and nothing else; what each draws comes back through a
//! channel, and this thread sends it in order.

use scanbeam::frame::{self, FrameError, FrameUse, Interleave, LineError};
use scanbeam::look::Look;
use scanbeam::pixel::PixelFormat;
use scanbeam::scan_out::{LineBuf, Pump, ScanoutDma, Window};
use scanbeam::{Renderer, Scene};
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread;

/// Lines that a thread may be ahead of the sender.
const AHEAD: usize = 4;

/// The pixels of a line on its way to the sender, and whether anything is active there.
type Drawn<W> = Result<(Vec<W>, bool), LineError>;

/// Draws a frame: alone by [`scanbeam::draw_frame`], or by a thread for each renderer, which share the lines in turns.
///
/// # Errors
/// When the sink fails, naming the line, or a renderer has too little memory.
pub fn draw_frame<L, F, D, const WORDS: usize>(
    scene: &Scene<'_, '_, L>,
    renderers: &mut [Renderer<'_, L, WORDS>],
    pump: &mut Pump<D>,
    background: F::Word,
    lines_per_transfer: u16,
) -> Result<FrameUse, FrameError<D::Error>>
where
    L: Look<Pixel = F, Planes: Send> + Sync,
    F: PixelFormat + Sync,
    D: ScanoutDma<Buf: LineBuf<Word = F::Word>>,
{
    if let [renderer] = renderers {
        return frame::draw_frame(scene, renderer, pump, background, lines_per_transfer);
    }
    let (width, all, count) = (scene.screen().width(), scene.lines(), renderers.len());
    let turns =
        |first: usize| Interleave::lines(count as u16, first as u16).unwrap_or(Interleave::ALL);
    let mut used = FrameUse {
        assembled: scene.assembled(),
        ..FrameUse::default()
    };
    thread::scope(|threads| {
        let mut drawn = Vec::new();
        for (first, renderer) in renderers.iter_mut().enumerate() {
            let (sender, lines) = sync_channel(AHEAD);
            drawn.push(lines);
            let own = turns(first).of(scene.lines());
            threads.spawn(move || draw_lines(scene, renderer, own, background, &sender));
        }
        let window = Window {
            x: 0,
            y: all.start,
            width,
            height: all.len() as u16,
        };
        pump.take_stats();
        pump.begin(window, lines_per_transfer)?;
        let first = turns(0);
        for line in scene.lines() {
            let lines = &drawn[usize::from(first.owner(line))];
            let arrived = lines.recv().unwrap_or(Err(LineError::Stopped { line }));
            let (pixels, is_active) = arrived.map_err(FrameError::Line)?;
            used.lines_skipped += u32::from(!is_active);
            pump.line()?.copy_from_slice(&pixels);
            pump.line_done()?;
        }
        pump.finish()?;
        Ok::<_, FrameError<D::Error>>(())
    })?;
    for renderer in renderers {
        used.cache += renderer.counts();
    }
    used.scan_out = pump.stats();
    Ok(used)
}

/// Draws a renderer's own lines of a scene, and fetches ahead after each, until nobody takes them: those of a frame that
/// has failed.
fn draw_lines<L, F, const WORDS: usize>(
    scene: &Scene<'_, '_, L>,
    renderer: &mut Renderer<'_, L, WORDS>,
    own: impl Iterator<Item = u16>,
    background: F::Word,
    sender: &SyncSender<Drawn<F::Word>>,
) where
    L: Look<Pixel = F>,
    F: PixelFormat,
{
    renderer.restart();
    for line in own {
        let mut pixels = vec![background; scene.screen().width().into()];
        let is_active = renderer.draw_line(scene, line, &mut pixels, background);
        let sent = sender.send(is_active.map(|is| (pixels, is)));
        if sent.is_err() || renderer.fetch_ahead(scene).is_err() {
            break;
        }
    }
}
