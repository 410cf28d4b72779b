//! A model by draw calls.

use crate::choice::PixelFormatArg;
use crate::formats::mono;
use crate::textured::{Skins, Texels16};
use crate::{DrawFailure, Prepared, Setting, display, shown};
use host_support::image_out::Frame;
use host_support::mock::{MockError, MockFrameBuffer};
use host_support::reference::{Shade, View};
use host_support::rooms::{LineRooms, Room, SceneRooms};
use scanbeam::frame::{CacheUse, FastMemory, FrameError, FrameUse, LineError, draw_frame};
use scanbeam::look::{Gouraud, Look, Textured};
use scanbeam::pixel::{Grey8, Pixel, PixelFormat, Rgb565, Rgb565Be, Rgb888, Xrgb8888};
use scanbeam::scan_out::{Pump, Window};
use scanbeam::scene::{
    Budget, DrawError, DrawState, LARGEST, Object, Shading, Skin, Texture, TexturePlace, Vertex,
};
use scanbeam::{Draw, Link, Renderer, Scene};
use serde_json::json;
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
    /// What it took, all renderers together; of the most slots in use and of the triangles without their texture, those
    /// of the renderer that has most.
    pub used: FrameUse,
    /// Triangles in memory: more than are seen where clipping cuts.
    pub objects: usize,
    /// Vertices in memory.
    pub vertices: usize,
    /// Bytes of slow memory in use: the scene, and a column of links for each renderer.
    pub slow_bytes: usize,
    /// Bytes of fast memory: slots of the caches and depth of a line, for each renderer.
    pub fast_bytes: usize,
    /// Bytes of the two line buffers.
    pub line_bytes: usize,
}

impl Called {
    /// The figures as `render --stats` writes them, by the names that [`Drawn::to_json`](crate::Drawn::to_json) has.
    ///
    /// What draw calls do not count is left out: spans, pixels, depth tests, texels fetched, what was skipped as a
    /// whole, bytes of slow memory that were moved, and what was fetched ahead.
    #[must_use]
    pub fn to_json(&self) -> serde_json::Value {
        let (done, cache, sent) = (&self.used.assembled, &self.used.cache, &self.used.scan_out);
        json!({
            "objects_in": done.triangles,
            "objects_culled": done.culled,
            "objects_clipped": done.clipped,
            "objects_kept": self.objects,
            "vertices_kept": self.vertices,
            "scanlines_skipped": self.used.lines_skipped,
            "bytes_sent": sent.bytes_sent,
            "lines_unsent": sent.lines_unsent,
            "bytes_unsent": sent.bytes_unsent,
            "transfers": sent.transfers,
            "bands": 1,
            "cache": {
                "hits": cache.hits,
                "misses": cache.misses,
                "spills": cache.spilled,
                "set_ups": cache.set_ups,
                "peak_slots": cache.peak,
            },
            "ram": {
                "slow_bytes": self.slow_bytes,
                "fast_bytes": self.fast_bytes,
                "line_bytes": self.line_bytes,
            },
        })
    }
}

/// Draws a model, each of its parts by a draw call: by one renderer on this thread, or by several on a thread each, with
/// so many slots of the cache each. `skins` are the textures that it was prepared with.
///
/// Texels have 16 bits whatever the format: the levels of a picture are rounded to 5, 6 and 5 bits.
///
/// `None` is for what draw calls do not draw, or not at once: a side over [`LARGEST`] pixels, dithered pixels of 16 and
/// 24 bits, textures in grey and in one bit, more than [`MOST_SLOTS`] slots, and models of which too much is seen for
/// the memory of one scene.
///
/// # Errors
/// See [`DrawFailure`].
pub fn draw_by_calls(
    prepared: &Prepared,
    skins: Option<Skins<'_>>,
    view: &View,
    format: PixelFormatArg,
    renderers: u16,
    slots: u16,
) -> Result<Option<Called>, DrawFailure> {
    if view.width.max(view.height) > u32::from(LARGEST) || slots > MOST_SLOTS {
        return Ok(None);
    }
    let asked = Asked {
        prepared,
        view,
        renderers: renderers.max(1),
        slots,
    };
    if let Some(skins) = skins.filter(|skins| !skins.set.is_empty()) {
        return match format {
            PixelFormatArg::Rgb565 => skinned::<Textured<Rgb565Be>, _, Rgb565Be>(&asked, skins),
            PixelFormatArg::Rgb888 => skinned::<Textured<Rgb888>, _, Rgb565>(&asked, skins),
            PixelFormatArg::Xrgb8888 => skinned::<Textured<Xrgb8888>, _, Rgb565>(&asked, skins),
            _ => Ok(None),
        };
    }
    let draw = match format {
        PixelFormatArg::Rgb565 => draw_in::<Gouraud<Rgb565Be>, _>,
        PixelFormatArg::Rgb888 => draw_in::<Gouraud<Rgb888>, _>,
        PixelFormatArg::Xrgb8888 => draw_in::<Gouraud<Xrgb8888>, _>,
        PixelFormatArg::Grey8 | PixelFormatArg::Mono => draw_in::<Gouraud<Grey8>, _>,
        PixelFormatArg::Dithered565 | PixelFormatArg::Dithered888 => return Ok(None),
    };
    let mut called = draw(&asked, &[], Budget::default())?;
    if let (PixelFormatArg::Mono, Some(called)) = (format, &mut called) {
        called.used.scan_out.bytes_sent = mono(&mut called.frame)?;
    }
    Ok(called)
}

/// What is drawn, and by how many.
struct Asked<'a> {
    prepared: &'a Prepared,
    view: &'a View,
    /// At least 1.
    renderers: u16,
    slots: u16,
}

/// Draws with textures whose texels are pixels of the format `T`.
fn skinned<L, F, T>(asked: &Asked<'_>, skins: Skins<'_>) -> Result<Option<Called>, DrawFailure>
where
    L: Look<Pixel = F, Planes: Send> + Sync,
    F: Pixel + Sync,
    T: PixelFormat<Word = u16>,
{
    let bad = |error| DrawFailure::View(format!("a texture: {error}"));
    let texels = Texels16::of::<T>(skins.set);
    let coarser = texels.coarser().map_err(bad)?;
    let textures = texels.textures(&coarser, skins).map_err(bad)?;
    draw_in::<L, F>(asked, &textures, skins.budget())
}

fn draw_in<L, F>(
    asked: &Asked<'_>,
    textures: &[Texture<'_>],
    budget: Budget,
) -> Result<Option<Called>, DrawFailure>
where
    L: Look<Pixel = F, Planes: Send> + Sync,
    F: Pixel + Sync,
{
    let (prepared, view) = (asked.prepared, asked.view);
    let setting = Setting::new(prepared, view)?;
    let (width, height) = (setting.screen.width(), setting.screen.height());
    let bad = |error: &dyn std::fmt::Display| DrawFailure::View(error.to_string());
    let room = room(asked, !textures.is_empty());
    let mut memory = SceneRooms::new(room, height);
    let mut scene = memory.scene::<L>(setting.screen);
    scene.begin(&setting.camera).map_err(|e| bad(&e))?;
    for chunk in &prepared.chunks {
        let texture = chunk
            .texture
            .and_then(|number| textures.get(usize::from(number)));
        let call = Draw {
            model: setting.instance.model,
            cull: setting.instance.cull,
            light: setting.instance.light,
            shading: match view.shade {
                Shade::Flat => Shading::Flat,
                Shade::None | Shade::Gouraud => Shading::Smooth,
            },
            texture: texture.map(|texture| Skin {
                texture,
                places: &chunk.places,
                budget,
            }),
            ..Draw::new(chunk.mesh())
        };
        match scene.draw(&call) {
            Err(DrawError::Full { .. }) => return Ok(None),
            done => done.map_err(|e| bad(&e))?,
        }
    }
    let mut lines: Vec<LineRooms<L, WORDS>> = (0..asked.renderers)
        .map(|_| LineRooms::new(scene.objects(), width).with_limit(asked.slots))
        .collect();
    let mut crew: Vec<_> = lines.iter_mut().map(LineRooms::renderer).collect();
    let (mut pump, band) = display::<F::Word>(width, height);
    let background = F::from_rgb8(view.background);
    let used = match &mut crew[..] {
        [alone] => draw_frame(&scene, alone, &mut pump, background, band),
        several => draw_shared(&scene, several, &mut pump, background, band),
    };
    let line = usize::from(width);
    let fast = usize::from(asked.slots) * FastMemory::<L, WORDS>::SLOT_BYTES + line * 4;
    Ok(Some(Called {
        used: used.map_err(DrawFailure::Calls)?,
        frame: shown::<F>(&pump, view)?,
        objects: scene.objects(),
        vertices: scene.vertices(),
        slow_bytes: slow_bytes(&scene, asked),
        fast_bytes: usize::from(asked.renderers) * fast,
        line_bytes: 2 * line * usize::from(band) * size_of::<F::Word>(),
    }))
}

/// Bytes of slow memory that a scene takes, with the links of its renderers.
fn slow_bytes<L: Look>(scene: &Scene<'_, '_, L>, asked: &Asked<'_>) -> usize {
    let place = match L::TEXTURED {
        true => size_of::<TexturePlace>(),
        false => 0,
    };
    let object = size_of::<Object>() + usize::from(asked.renderers) * size_of::<Link>();
    scene.vertices() * (size_of::<Vertex>() + place)
        + scene.objects() * object
        + scene.lines().len() * size_of::<u16>()
        + asked.prepared.chunks.len() * size_of::<DrawState<'_>>()
}

/// Room for a model; what needs more is not drawn at once.
fn room(asked: &Asked<'_>, textured: bool) -> Room {
    let prepared = asked.prepared;
    let faces: usize = prepared.chunks.iter().map(|c| c.faces.len()).sum();
    let vertices: usize = prepared.chunks.iter().map(|c| c.positions.len()).sum();
    // Those of clipped triangles, and where faces are flat three more for each.
    let more = if asked.view.shade == Shade::Flat {
        20
    } else {
        8
    };
    let vertices = (vertices + more * faces + 64).min(1 << 16);
    Room {
        vertices,
        places: if textured { vertices } else { 0 },
        objects: (4 * faces + 64).min(usize::from(Link::CACHED)),
        draws: prepared.chunks.len(),
    }
}

/// Draws a frame by a thread for each renderer, which share the lines in turns; this one sends them.
fn draw_shared<L, F>(
    scene: &Scene<'_, '_, L>,
    renderers: &mut [Renderer<'_, L, WORDS>],
    pump: &mut Pump<MockFrameBuffer<F::Word>>,
    background: F::Word,
    lines_per_transfer: u16,
) -> Result<FrameUse, Failed>
where
    L: Look<Pixel = F, Planes: Send> + Sync,
    F: Pixel + Sync,
{
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
    // One that is on lines of several is one.
    all.untextured = all.untextured.max(one.untextured);
}
