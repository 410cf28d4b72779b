//! Several line renderers of one scene, each on a thread of its own (K16, X6).
//!
//! Threads share the scene by reference and nothing else; what each draws comes back through a
//! relay, and this thread sends it in order.

use crate::CrewSettings;
use host_support::lent::LineRooms;
use host_support::mock::HostLine;
use scanbeam::parallel::{Crew, Interleave, Relay};
use scanbeam::pipeline::{Pipeline, WordOf};
use scanbeam::scan_out::{ErrorType, LineBuf, Pump, ScanoutDma};
use scanbeam::send::send_frame;
use scanbeam::{FrameError, FrameStats, LineRenderer, Scene};
use std::sync::atomic::{AtomicBool, Ordering};

/// Line buffers between a thread and the sender, and one more, as the queues keep one free.
const QUEUE: usize = 5;

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

/// Draws a frame: alone by [`scanbeam::draw_frame`], or by a thread for each renderer.
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
        return scanbeam::draw_frame(scene, renderer, pump, background, lines_per_transfer);
    }
    let width = usize::from(scene.screen().width());
    let mut relays: Vec<Relay<HostLine<WordOf<P>>, QUEUE>> = (0..renderers.len())
        .map(|_| Relay::new((1..QUEUE).map(|_| HostLine::new(width))))
        .collect();
    // Whether the workers may go on: not when the sink has failed.
    let go_on = AtomicBool::new(true);
    let go_on = &go_on;
    let sent = std::thread::scope(|threads| {
        let mut desks = Vec::new();
        for (renderer, relay) in renderers.iter_mut().zip(&mut relays) {
            let (mut worker, desk) = relay.split();
            desks.push((renderer.interleave(), desk));
            threads.spawn(move || {
                worker.frame(scene, renderer, background, || {
                    std::thread::yield_now();
                    go_on.load(Ordering::Relaxed)
                })
            });
        }
        let mut crew = Crew {
            scene,
            here: &mut [],
            desks: &mut desks,
            background,
            wait: || {
                std::thread::yield_now();
                true
            },
            skipped: 0,
        };
        let sent = send_frame(scene, &mut crew, pump, lines_per_transfer);
        go_on.store(false, Ordering::Relaxed);
        sent.map(|sent| crew.stats(sent))
    });
    let mut stats = sent?;
    for renderer in renderers {
        stats.add_renderer(renderer);
    }
    Ok(stats)
}
