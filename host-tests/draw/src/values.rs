//! A model without textures by draw calls.

use crate::choice::PixelFormatArg;
use crate::formats::mono;
use crate::{DrawFailure, Prepared, Setting, display, shown};
use host_support::image_out::Frame;
use host_support::mock::{MockError, MockFrameBuffer};
use host_support::reference::{Shade, View};
use host_support::rooms::{LineRooms, Room, SceneRooms};
use scanbeam::frame::{CacheUse, FrameError, FrameUse, LineError, draw_frame};
use scanbeam::look::Gouraud;
use scanbeam::pixel::{Grey8, Pixel, Rgb565Be, Rgb888, Xrgb8888};
use scanbeam::scan_out::{Pump, Window};
use scanbeam::scene::{DrawError, LARGEST, Shading};
use scanbeam::{Draw, Link, Renderer, Scene};
use std::sync::mpsc::sync_channel;
use std::thread;

/// Words of 32 slots that the cache of a renderer has.
const WORDS: usize = 7;
/// Most slots that a renderer is lent, inclusive.
pub const MOST_SLOTS: u16 = 32 * WORDS as u16;
/// Lines that a thread may be ahead of the sender.
const AHEAD: usize = 4;

/// Why a frame did not arrive.
type Failed = FrameError<MockError>;

/// A picture by draw calls.
#[derive(Debug, Clone, PartialEq)]
pub struct Called {
    /// The picture, converted back to 8-bit levels.
    pub frame: Frame,
    /// What it took, all renderers together; of the most slots in use, those of the fullest cache.
    pub used: FrameUse,
}

/// Draws a model that was prepared without textures, each of its parts by a draw call: by one renderer on this thread,
/// or by several on a thread each, with so many slots of the cache each.
///
/// `None` is for what draw calls do not draw, or not at once: a side over [`LARGEST`] pixels, dithered pixels of 16 and
/// 24 bits, more than [`MOST_SLOTS`] slots, and models of which too much is seen for the memory of one scene.
///
/// # Errors
/// See [`DrawFailure`].
pub fn draw_by_calls(
    prepared: &Prepared,
    view: &View,
    format: PixelFormatArg,
    renderers: u16,
    slots: u16,
) -> Result<Option<Called>, DrawFailure> {
    if view.width.max(view.height) > u32::from(LARGEST) || slots > MOST_SLOTS {
        return Ok(None);
    }
    let draw = match format {
        PixelFormatArg::Rgb565 => draw_in::<Rgb565Be>,
        PixelFormatArg::Rgb888 => draw_in::<Rgb888>,
        PixelFormatArg::Xrgb8888 => draw_in::<Xrgb8888>,
        PixelFormatArg::Grey8 | PixelFormatArg::Mono => draw_in::<Grey8>,
        PixelFormatArg::Dithered565 | PixelFormatArg::Dithered888 => return Ok(None),
    };
    let mut called = draw(prepared, view, renderers.max(1), slots)?;
    if let (PixelFormatArg::Mono, Some(called)) = (format, &mut called) {
        called.used.scan_out.bytes_sent = mono(&mut called.frame)?;
    }
    Ok(called)
}

fn draw_in<F: Pixel + Send + Sync>(
    prepared: &Prepared,
    view: &View,
    renderers: u16,
    slots: u16,
) -> Result<Option<Called>, DrawFailure> {
    let setting = Setting::new(prepared, view)?;
    let (width, height) = (setting.screen.width(), setting.screen.height());
    let bad = |error: &dyn std::fmt::Display| DrawFailure::View(error.to_string());
    let room = room(prepared, view.shade);
    let mut memory = SceneRooms::new(room, height);
    let mut scene = memory.scene::<Gouraud<F>>(setting.screen);
    scene.begin(&setting.camera).map_err(|e| bad(&e))?;
    for chunk in &prepared.chunks {
        let call = Draw {
            model: setting.instance.model,
            cull: setting.instance.cull,
            light: setting.instance.light,
            shading: match view.shade {
                Shade::Flat => Shading::Flat,
                Shade::None | Shade::Gouraud => Shading::Smooth,
            },
            ..Draw::new(chunk.mesh())
        };
        match scene.draw(&call) {
            Err(DrawError::Full { .. }) => return Ok(None),
            done => done.map_err(|e| bad(&e))?,
        }
    }
    let mut lines: Vec<LineRooms<Gouraud<F>, WORDS>> = (0..renderers)
        .map(|_| LineRooms::new(scene.objects(), width).with_limit(slots))
        .collect();
    let mut crew: Vec<_> = lines.iter_mut().map(LineRooms::renderer).collect();
    let (mut pump, band) = display::<F::Word>(width, height);
    let background = F::from_rgb8(view.background);
    let used = match &mut crew[..] {
        [alone] => draw_frame(&scene, alone, &mut pump, background, band),
        several => draw_shared(&scene, several, &mut pump, background, band),
    };
    Ok(Some(Called {
        used: used.map_err(DrawFailure::Calls)?,
        frame: shown::<F>(&pump, view)?,
    }))
}

/// Room for a model; what needs more is not drawn at once.
fn room(prepared: &Prepared, shade: Shade) -> Room {
    let faces: usize = prepared.chunks.iter().map(|c| c.faces.len()).sum();
    let vertices: usize = prepared.chunks.iter().map(|c| c.positions.len()).sum();
    // Those of clipped triangles, and where faces are flat three more for each.
    let more = if shade == Shade::Flat { 20 } else { 8 };
    Room {
        vertices: (vertices + more * faces + 64).min(1 << 16),
        places: 0,
        objects: (4 * faces + 64).min(usize::from(Link::CACHED)),
        draws: prepared.chunks.len(),
    }
}

/// Draws a frame by a thread for each renderer, which share the lines in turns; this one sends them.
fn draw_shared<F: Pixel + Send + Sync>(
    scene: &Scene<'_, '_, Gouraud<F>>,
    renderers: &mut [Renderer<'_, Gouraud<F>, WORDS>],
    pump: &mut Pump<MockFrameBuffer<F::Word>>,
    background: F::Word,
    lines_per_transfer: u16,
) -> Result<FrameUse, Failed> {
    let (width, height) = (scene.screen().width(), scene.screen().height());
    let count = renderers.len();
    let mut used = FrameUse {
        assembled: scene.assembled(),
        ..FrameUse::default()
    };
    thread::scope(|threads| {
        let mut drawn = Vec::new();
        for (first, renderer) in renderers.iter_mut().enumerate() {
            let (sender, lines) = sync_channel(AHEAD);
            drawn.push(lines);
            threads.spawn(move || {
                for line in scene.lines().skip(first).step_by(count) {
                    let mut pixels = vec![background; width.into()];
                    let is_active = renderer.draw_line(scene, line, &mut pixels, background);
                    // Nobody takes the lines of a frame that has failed.
                    if sender.send(is_active.map(|is| (pixels, is))).is_err() {
                        break;
                    }
                }
            });
        }
        let window = Window {
            x: 0,
            y: 0,
            width,
            height,
        };
        pump.begin(window, lines_per_transfer)?;
        for (line, lines) in scene.lines().zip(drawn.iter().cycle()) {
            let arrived = lines.recv().unwrap_or(Err(LineError::Stopped { line }));
            let (pixels, is_active) = arrived.map_err(Failed::Line)?;
            used.lines_skipped += u32::from(!is_active);
            pump.line()?.copy_from_slice(&pixels);
            pump.line_done()?;
        }
        pump.finish()?;
        Ok::<_, Failed>(())
    })?;
    for renderer in renderers {
        add(&mut used.cache, &renderer.counts());
    }
    used.scan_out = pump.stats();
    Ok(used)
}

/// Adds what another cache has done.
fn add(all: &mut CacheUse, one: &CacheUse) {
    all.hits += one.hits;
    all.spilled += one.spilled;
    all.moved_in += one.moved_in;
    all.misses += one.misses;
    all.set_ups += one.set_ups;
    all.peak = all.peak.max(one.peak);
    all.untextured += one.untextured;
}
