//! Pictures of models by presets, for the methods that draw calls do not have.

use crate::prepared::Chunk;
use crate::{CrewSettings, DrawFailure, Drawn, Figures, Prepared, Setting, display};
use host_support::image_out::Frame;
use host_support::lent::{LineRooms, SceneRooms};
use host_support::reference::View;
use scanbeam::frame::FrameUse;
use scanbeam::pipeline::parallel::{Crew, Interleave, LineSource};
use scanbeam::pipeline::send::send_frame;
use scanbeam::pipeline::{
    DrawError, FrameError, FrameStats, Instance, LineRenderer, Pipeline, RendererError, Scene,
    WordOf,
};
use scanbeam::pixel::PixelFormat;
use scanbeam::scan_out::{ErrorType, LineBuf, Pump, ScanoutDma};
use scanbeam::{Link, Screen};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};

/// Lines that a thread may be ahead of the sender.
const AHEAD: usize = 4;

/// The words of a line on its way to the sender.
type DrawnLine<W> = Result<Vec<W>, RendererError>;

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
    sender: &SyncSender<DrawnLine<WordOf<P>>>,
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
struct Threads<W>(Vec<(Interleave, Receiver<DrawnLine<W>>)>);

impl<P: Pipeline> LineSource<P> for Threads<WordOf<P>> {
    fn line(&mut self, line: u16, pixels: &mut [WordOf<P>]) -> Result<(), RendererError> {
        let owner = self.0.iter().find(|(lines, _)| lines.owns(line));
        let drawn = owner.and_then(|(_, lines)| lines.recv().ok());
        pixels.copy_from_slice(&drawn.ok_or(RendererError::Unowned { line })??);
        Ok(())
    }
}

impl Chunk {
    fn draw_by_preset<P: Pipeline>(
        &self,
        scene: &mut Scene<'_, P>,
        instance: &Instance,
    ) -> Result<(), DrawError> {
        scene.draw(&self.mesh(), instance).map(drop)
    }
}

/// Draws a prepared model with the pipeline `P`.
///
/// # Errors
/// See [`DrawFailure`].
pub fn draw_as<P: Pipeline<Textures: Sync>>(
    prepared: &Prepared,
    view: &View,
    crew: CrewSettings,
) -> Result<Drawn, DrawFailure> {
    let bad = |error: &dyn std::fmt::Display| DrawFailure::View(error.to_string());
    let setting = Setting::new(prepared, view)?;
    let instance = Instance {
        model: setting.model,
        cull: setting.cull,
        light: setting.light,
        colour: [255; 3],
    };
    let (width, height) = (view.width as u16, view.height as u16);
    let screen = Screen::new(width, height).map_err(|error| bad(&error))?;
    let mut rooms = rooms_for::<P>(prepared, height);
    let mut line_rooms: Vec<LineRooms<P>> = (0..crew.renderers.max(1))
        .map(|_| LineRooms::new(crew.slots.into(), rooms.objects(), width.into()))
        .collect();
    let fast_bytes = line_rooms.iter().map(LineRooms::fast_bytes).sum();
    let mut renderers = renderers(&mut line_rooms, crew);
    let (mut pump, lines) = display::<WordOf<P>>(width, height);
    let mut scene = rooms.scene(screen);
    scene.begin(&setting.camera).map_err(|error| bad(&error))?;
    for chunk in &prepared.chunks {
        chunk
            .draw_by_preset(&mut scene, &instance)
            .map_err(|error| bad(&error))?;
    }
    let background = P::Pixel::from_rgb8(view.background);
    let stats = draw_frame(&scene, &mut renderers, &mut pump, background, lines)
        .map_err(|error| DrawFailure::Method(error.to_string()))?;
    let (done, cache) = (&stats.pass_one, &stats.cache);
    let mut used = FrameUse {
        lines_skipped: stats.scanlines_skipped,
        scan_out: stats.scan_out,
        ..FrameUse::default()
    };
    (used.assembled.triangles, used.assembled.culled) = (done.triangles, done.culled);
    used.assembled.clipped = done.clipped;
    (used.cache.misses, used.cache.spilled, used.cache.peak) =
        (cache.misses, cache.spills, cache.peak_slots);
    used.cache.set_ups = cache.records_read();
    let pixels = pump.sink().frame().map_err(DrawFailure::Incomplete)?;
    let rgb = pixels.into_iter().flat_map(P::Pixel::to_rgb8).collect();
    let column = renderers.len() * size_of::<Link>();
    Ok(Drawn {
        frame: Frame::new(view.width, view.height, rgb)
            .ok_or_else(|| bad(&"the picture has another size"))?,
        used,
        spans: Some(stats.spans),
        slow_bytes: None,
        figures: Figures {
            parts: 1,
            objects: done.objects as usize,
            vertices: done.vertices as usize,
            slow_bytes: scene.bytes() + done.objects as usize * column,
            fast_bytes,
            line_bytes: 2 * usize::from(width) * usize::from(lines) * size_of::<WordOf<P>>(),
        },
        overfull: None,
    })
}

/// Memory for a model's scene.
fn rooms_for<P: Pipeline>(prepared: &Prepared, height: u16) -> SceneRooms<P> {
    let faces: usize = prepared.chunks.iter().map(|c| c.faces.len()).sum();
    let vertices: usize = prepared.chunks.iter().map(|c| c.positions.len()).sum();
    let objects = (4 * faces + 64).min(usize::from(Link::CACHED));
    SceneRooms::new(
        (vertices + 8 * faces + 64).min(1 << 16),
        objects,
        height.into(),
    )
}
