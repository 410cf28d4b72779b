//! A model by draw calls.

use crate::choice::PixelFormatArg;
use crate::formats::mono;
use crate::parts::{Figures, Job, WORDS, add_cache, draw_parts, room_for};
use crate::textured::{Skins, Texels16};
use crate::{DrawFailure, Overfull, Prepared, Setting};
use host_support::image_out::Frame;
use host_support::mock::{MockError, MockFrameBuffer};
use host_support::reference::{Shade, View};
use scanbeam::frame::{FrameError, FrameUse, LineError};
use scanbeam::look::{Gouraud, Look, Textured};
use scanbeam::pixel::{Grey8, Pixel, PixelFormat, Rgb565, Rgb565Be, Rgb888, Xrgb8888};
use scanbeam::scan_out::{Pump, Window};
use scanbeam::scene::{Budget, LARGEST, Shading, Skin, Texture};
use scanbeam::{Draw, Renderer, Scene};
use serde_json::json;
use std::sync::mpsc::sync_channel;
use std::thread;

/// Most slots that a renderer is lent, inclusive.
pub const MOST_SLOTS: u16 = 224;
/// Lines that a thread may be ahead of the sender.
const AHEAD: usize = 4;

/// Why a frame did not arrive.
type Failed = FrameError<MockError>;

/// A picture by draw calls.
#[derive(Debug, Clone, PartialEq)]
pub struct Called {
    /// The picture, converted back to 8-bit levels.
    pub frame: Frame,
    /// What it took, all parts and renderers together; of the most slots in use and of the triangles without their
    /// texture, those of the renderer that has most.
    pub used: FrameUse,
    /// Memory.
    pub figures: Figures,
    /// What is left out.
    pub overfull: Option<Overfull>,
}

impl Called {
    /// The figures as `render --stats` writes them, by the names that [`Drawn::to_json`](crate::Drawn::to_json) has.
    ///
    /// What draw calls do not count is left out: spans, pixels, depth tests, texels fetched, what was skipped as a
    /// whole, bytes of slow memory that were moved, and what was fetched ahead; of a picture in several parts or with
    /// shadows, what is culled, clipped and kept, since a triangle may be drawn more than once.
    #[must_use]
    pub fn to_json(&self) -> serde_json::Value {
        let (done, cache, sent) = (&self.used.assembled, &self.used.cache, &self.used.scan_out);
        let figures = &self.figures;
        let mut all = json!({
            "objects_in": done.triangles,
            "scanlines_skipped": self.used.lines_skipped,
            "bytes_sent": sent.bytes_sent,
            "lines_unsent": sent.lines_unsent,
            "bytes_unsent": sent.bytes_unsent,
            "transfers": sent.transfers,
            "bands": figures.parts,
            "cache": {
                "hits": cache.hits,
                "misses": cache.misses,
                "spills": cache.spilled,
                "set_ups": cache.set_ups,
                "peak_slots": cache.peak,
            },
            "ram": {
                "slow_bytes": figures.slow_bytes,
                "fast_bytes": figures.fast_bytes,
                "line_bytes": figures.line_bytes,
            },
        });
        if figures.parts == 1 && figures.once {
            all["objects_culled"] = json!(done.culled);
            all["objects_clipped"] = json!(done.clipped);
            all["objects_kept"] = json!(figures.objects);
            all["vertices_kept"] = json!(figures.vertices);
        }
        all
    }
}

/// Draws a model, each of its parts by a draw call: by one renderer on this thread, or by several on a thread each, with
/// so many slots of the cache each. `skins` are the textures that it was prepared with.
///
/// Texels have 16 bits whatever the format: the levels of a picture are rounded to 5, 6 and 5 bits.
///
/// A picture that is larger than a scene can be, or shows more than the memory of one holds, is put together from parts.
/// `None` is for what draw calls do not draw: textures in grey and in one bit, and more than [`MOST_SLOTS`] slots.
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
    if slots > MOST_SLOTS {
        return Ok(None);
    }
    let asked = Asked {
        prepared,
        view,
        renderers: renderers.max(1),
        slots,
        dither: format == PixelFormatArg::Dithered565,
    };
    if let Some(skins) = skins.filter(|skins| !skins.set.is_empty()) {
        return match format {
            PixelFormatArg::Rgb565 | PixelFormatArg::Dithered565 => {
                skinned::<Textured<Rgb565Be>, _, Rgb565Be>(&asked, skins)
            }
            PixelFormatArg::Rgb888 => skinned::<Textured<Rgb888>, _, Rgb565>(&asked, skins),
            PixelFormatArg::Xrgb8888 => skinned::<Textured<Xrgb8888>, _, Rgb565>(&asked, skins),
            _ => Ok(None),
        };
    }
    let draw = match format {
        PixelFormatArg::Rgb565 | PixelFormatArg::Dithered565 => draw_in::<Gouraud<Rgb565Be>, _>,
        PixelFormatArg::Rgb888 => draw_in::<Gouraud<Rgb888>, _>,
        PixelFormatArg::Xrgb8888 => draw_in::<Gouraud<Xrgb8888>, _>,
        PixelFormatArg::Grey8 | PixelFormatArg::Mono => draw_in::<Gouraud<Grey8>, _>,
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
    dither: bool,
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
    let job = Job {
        size: [view.width, view.height],
        most: LARGEST,
        camera: setting.camera,
        background: view.background,
        renderers: asked.renderers,
        slots: asked.slots,
        shadows: false,
        room: room_for(
            prepared.chunks.iter(),
            !textures.is_empty(),
            view.shade == Shade::Flat,
        ),
    };
    draw_parts::<L, F>(&job, prepared.chunks.len(), |scene, _, number| {
        let chunk = &prepared.chunks[number];
        let texture = chunk
            .texture
            .and_then(|number| textures.get(usize::from(number)));
        scene.draw(&Draw {
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
            dither: asked.dither,
            ..Draw::new(chunk.mesh())
        })
    })
    .map(Some)
}

/// Draws a frame by a thread for each renderer, which share the lines in turns; this one sends them.
pub(crate) fn draw_shared<L, F>(
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
    let (width, all) = (scene.screen().width(), scene.lines());
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
            y: all.start,
            width,
            height: all.len() as u16,
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
        add_cache(&mut used.cache, &renderer.counts());
    }
    used.scan_out = pump.stats();
    Ok(used)
}
