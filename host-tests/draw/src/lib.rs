//! A model through the whole pipeline into a mocked frame buffer, as firmware would draw it.

mod bands;
pub mod choice;
pub mod crew;
mod depth;
mod effects;
mod formats;
mod interp;
mod parts;
mod prepared;
pub mod scene_file;
mod scenes;
mod textured;
mod values;

pub use bands::{Bands, Overfull, Setting};
pub use depth::draw_by_depth;
pub use effects::{Effects, draw_effects};
pub use interp::{draw_by, draw_prepared};
pub use parts::Figures;
pub use prepared::Prepared;
pub use scenes::{SceneParts, draw_scene_file};
pub use textured::{FilterArg, HostTexture, Skins, TextureSet, TextureSetError, draw_textured};
pub use values::{Called, MOST_SLOTS, draw_by_calls};

use crate::choice::{DEFAULT_SLOTS, PixelFormatArg};
use host_support::image_out::Frame;
use host_support::lent::{LineRooms, SceneRooms};
use host_support::mock::{HostLine, MockError, MockFrameBuffer};
use host_support::model::Model;
use host_support::reference::{Shade, View};
use scanbeam::Link;
use scanbeam::pipeline::{
    DepthUse, FlatDepth, FrameError, FrameStats, GouraudDepth, Pipeline, Quality, Scene, WordOf,
};
use scanbeam::pixel::{PixelFormat, Rgb565Be, Rgb888};
use scanbeam::scan_out::Pump;
use scanbeam::stats::PassOne;
use scanbeam_model::{
    CornerColours, ModelFrameError, ModelRenderer, PipeMemory, SEGMENT, draw_model_frame,
};
use serde_json::json;

/// Who draws a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CrewSettings {
    /// Line renderers: one on this thread, or several on a thread each, at least 1.
    pub renderers: u16,
    /// Slots of each one's object cache.
    pub slots: usize,
    /// Bytes a line that each fetches ahead.
    pub prefetch: u32,
    /// How far the picture may be off where the method chooses.
    pub quality: Quality,
    /// When depth is compared, where there is any.
    pub depth_use: DepthUse,
}

impl Default for CrewSettings {
    fn default() -> Self {
        Self {
            renderers: 1,
            slots: usize::from(DEFAULT_SLOTS),
            prefetch: 0,
            quality: Quality::default(),
            depth_use: DepthUse::default(),
        }
    }
}

/// Lines that one transfer takes.
pub const LINES_PER_TRANSFER: u16 = 8;
/// Polls that the mocked display is late by, so that buffers are really swapped.
const LATE: u32 = 2;

/// Why a picture could not be drawn.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DrawFailure {
    /// The size, the camera or the light cannot be had in the crate's ranges.
    #[error("{0}")]
    View(String),
    /// The mocked display refused something.
    #[error("display: {0}")]
    Display(FrameError<MockError>),
    /// The same, of a picture by draw calls.
    #[error("display: {0}")]
    Calls(scanbeam::frame::FrameError<MockError>),
    /// The mocked display refused what the hardware model drew.
    #[error("display: {0:?}")]
    Model(ModelFrameError<MockError>),
    /// The frame did not arrive whole.
    #[error("display: {0:?}")]
    Incomplete(MockError),
}

/// A finished picture and what it took.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawn {
    /// The picture, converted back to 8-bit levels.
    pub frame: Frame,
    /// The figures, summed over bands. Those of `pass_one` are of the model and the whole picture:
    /// each triangle, object and vertex counts once whatever the bands.
    pub stats: FrameStats,
    /// Bands that the picture was put together from; 1 unless an arena was too small.
    pub bands: u32,
    /// What is left out.
    pub overfull: Option<Overfull>,
    /// Most bytes of slow memory in use: the scene and one link column.
    pub slow_bytes: usize,
    /// Bytes of fast memory: cache slots and line depth.
    pub fast_bytes: usize,
    /// Bytes of the two line buffers.
    pub line_bytes: usize,
}

impl Drawn {
    /// The figures as `render --stats` writes them.
    ///
    /// `objects_in` is the number of the model's triangles, and `objects_culled` how many of them
    /// are on no line of the picture or show their back; `objects_skipped` are those of the culled
    /// that were not looked at, because their mesh is outside the view. `objects_kept` are the
    /// records made of the others, more where clipping cuts; `vertices_kept` are theirs.
    #[must_use]
    pub fn to_json(&self) -> serde_json::Value {
        let s = &self.stats;
        json!({
            "objects_in": s.pass_one.triangles,
            "objects_culled": s.pass_one.culled,
            "objects_clipped": s.pass_one.clipped,
            "objects_kept": s.pass_one.objects,
            "objects_skipped": s.pass_one.triangles_skipped,
            "meshes_skipped": s.pass_one.meshes_skipped,
            "vertices_kept": s.pass_one.vertices,
            "vertices_skipped": s.pass_one.vertices_skipped,
            "spans": s.spans.spans,
            "spans_hidden": s.spans.spans_hidden,
            "spans_untested": s.spans.spans_untested,
            "spans_flat": s.spans.spans_flat,
            "pixels_shaded": s.spans.pixels_shaded,
            "pixels_hidden": s.spans.pixels_hidden,
            "depth_tests": s.spans.depth_tests,
            "texture_fetches": s.spans.texture_fetches,
            "scanlines_skipped": s.scanlines_skipped,
            "bytes_sent": s.scan_out.bytes_sent,
            "lines_unsent": s.scan_out.lines_unsent,
            "bytes_unsent": s.scan_out.bytes_unsent,
            "transfers": s.scan_out.transfers,
            "bands": self.bands,
            "cache": {
                "hits": s.cache.hits,
                "misses": s.cache.misses,
                "spills": s.cache.spills,
                "hits_per_mille": s.cache.hits_per_mille(),
                "set_ups": s.cache.records_read(),
                "prefetched": s.cache.fetched,
                "prefetch_hits": s.cache.fetched_hits,
                "prefetch_in_vain": s.cache.fetched_in_vain,
                "prefetch_bytes": s.prefetch_bytes,
                "slow_read_bytes": s.slow_read_bytes,
                "slow_write_bytes": s.slow_write_bytes,
                "peak_slots": s.cache.peak_slots,
            },
            "ram": {
                "slow_bytes": self.slow_bytes,
                "fast_bytes": self.fast_bytes,
                "line_bytes": self.line_bytes,
            },
        })
    }
}

/// Draws a model with the pipeline that the view and the format ask for.
///
/// # Errors
/// See [`DrawFailure`].
pub fn draw(
    model: &Model,
    view: &View,
    format: PixelFormatArg,
    crew: CrewSettings,
) -> Result<Drawn, DrawFailure> {
    let prepared = Prepared::new(model);
    formats::draw_in(&prepared, view, format, crew)
}

/// Draws a model as [`draw`] does, through the hardware model.
///
/// # Errors
/// See [`DrawFailure`].
pub fn draw_model(
    model: &Model,
    view: &View,
    format: PixelFormatArg,
) -> Result<Drawn, DrawFailure> {
    let prepared = Prepared::new(model);
    match (view.shade, format) {
        (Shade::Flat, PixelFormatArg::Rgb888) => {
            draw_model_as::<FlatDepth<Rgb888>>(&prepared, view)
        }
        (Shade::Flat, PixelFormatArg::Rgb565) => {
            draw_model_as::<FlatDepth<Rgb565Be>>(&prepared, view)
        }
        (_, PixelFormatArg::Rgb888) => draw_model_as::<GouraudDepth<Rgb888>>(&prepared, view),
        (_, PixelFormatArg::Rgb565) => draw_model_as::<GouraudDepth<Rgb565Be>>(&prepared, view),
        _ => Err(formats::refused("the hardware model draws")),
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
    draw_with::<P>(prepared, view, crew, P::Textures::default())
}

/// Draws a prepared model with the pipeline `P` and its textures.
fn draw_with<P: Pipeline<Textures: Sync>>(
    prepared: &Prepared,
    view: &View,
    crew: CrewSettings,
    textures: P::Textures,
) -> Result<Drawn, DrawFailure> {
    let setting = Setting::new(prepared, view)?;
    let mut rooms = rooms_for::<P>(prepared, view.height as u16);
    rooms.textures = textures;
    let build = |scene: &mut Scene<'_, P>, chunk: usize, alone: bool| {
        prepared.chunks[chunk].draw(scene, &setting.instance, alone)
    };
    let steps = prepared.chunks.len();
    let (width, height) = (view.width as u16, view.height as u16);
    let links = rooms.objects();
    let mut line_rooms: Vec<LineRooms<P>> = (0..crew.renderers.max(1))
        .map(|_| LineRooms::new(crew.slots, links, width.into()))
        .collect();
    let fast_bytes = line_rooms.iter().map(LineRooms::fast_bytes).sum();
    let mut renderers = crew::renderers(&mut line_rooms, crew);
    // A link column for each renderer.
    let column_bytes = renderers.len() * size_of::<Link>();
    let background = P::Pixel::from_rgb8(view.background);
    let (mut pump, lines) = display::<WordOf<P>>(width, height);
    let mut total = FrameStats::default();
    let mut slow_bytes = 0;
    let bands = setting.bands_of((&mut rooms, 0..height), (steps, build), |scene| {
        let stats = crew::draw_frame(scene, &mut renderers, &mut pump, background, lines)
            .map_err(DrawFailure::Display)?;
        add(&mut total, &stats);
        slow_bytes = slow_bytes.max(scene.bytes() + stats.pass_one.objects as usize * column_bytes);
        Ok(())
    })?;
    if bands.count > 1 {
        setting.count_once(prepared, &mut rooms, &mut total.pass_one)?;
    }
    Ok(Drawn {
        frame: shown::<P::Pixel>(&pump, view)?,
        stats: total,
        bands: bands.count,
        overfull: bands.overfull,
        slow_bytes,
        fast_bytes,
        line_bytes: line_bytes::<P>(width, lines),
    })
}

/// Draws a prepared model with the pipeline `P` through the hardware model.
fn draw_model_as<P>(prepared: &Prepared, view: &View) -> Result<Drawn, DrawFailure>
where
    P: Pipeline<Shading: CornerColours>,
{
    let setting = Setting::new(prepared, view)?;
    let (width, height) = (view.width as u16, view.height as u16);
    let mut rooms = rooms_for::<P>(prepared, height);
    let mut lines_of_model = ModelLines::new(width);
    let mut renderer = lines_of_model.renderer();
    let background = P::Pixel::from_rgb8(view.background);
    let (mut pump, lines) = display::<WordOf<P>>(width, height);
    let mut total = FrameStats::default();
    let mut slow_bytes = 0;
    let bands = setting.bands(prepared, &mut rooms, 0..height, |scene| {
        draw_model_frame(scene, &mut renderer, &mut pump, background, lines)
            .map_err(DrawFailure::Model)?;
        let band = FrameStats {
            pass_one: scene.pass_one(),
            scan_out: pump.stats(),
            ..FrameStats::default()
        };
        add(&mut total, &band);
        slow_bytes = slow_bytes.max(scene.bytes());
        Ok(())
    })?;
    if bands.count > 1 {
        setting.count_once(prepared, &mut rooms, &mut total.pass_one)?;
    }
    let counts = renderer.counts();
    total.spans.pixels_shaded = (counts.pixels - counts.hidden) as u32;
    total.spans.pixels_hidden = counts.hidden as u32;
    total.spans.depth_tests = counts.pixels as u32;
    Ok(Drawn {
        frame: shown::<P::Pixel>(&pump, view)?,
        stats: total,
        bands: bands.count,
        overfull: bands.overfull,
        slow_bytes,
        fast_bytes: lines_of_model.bytes(),
        line_bytes: line_bytes::<P>(width, lines),
    })
}

/// The scanlines that the hardware model works in.
pub struct ModelLines([Vec<u64>; 4]);

impl ModelLines {
    /// As wide as a picture, or as the widest segment.
    #[must_use]
    pub fn new(width: u16) -> Self {
        let line = vec![0; usize::from(width).min(SEGMENT)];
        Self([line.clone(), line.clone(), line.clone(), line])
    }

    /// A renderer over them.
    pub fn renderer(&mut self) -> ModelRenderer<'_> {
        let [z0, z1, c0, c1] = &mut self.0;
        ModelRenderer::new(PipeMemory {
            z: [z0, z1],
            rgb: [c0, c1],
        })
    }

    fn bytes(&self) -> usize {
        self.0.iter().map(|line| size_of_val(line.as_slice())).sum()
    }
}

/// A mocked display and its pump, and the lines of a transfer.
fn display<W: Copy + Default + 'static>(
    width: u16,
    height: u16,
) -> (Pump<MockFrameBuffer<W>>, u16) {
    let lines = LINES_PER_TRANSFER.min(height);
    let words = usize::from(width) * usize::from(lines);
    let sink = MockFrameBuffer::new(width, height).late_by(LATE);
    let pump = Pump::new(sink, [HostLine::new(words), HostLine::new(words)]);
    (pump, lines)
}

/// Bytes of the two line buffers.
fn line_bytes<P: Pipeline>(width: u16, lines: u16) -> usize {
    2 * usize::from(width) * usize::from(lines) * size_of::<WordOf<P>>()
}

/// The picture that has arrived.
fn shown<F: PixelFormat>(
    pump: &Pump<MockFrameBuffer<F::Word>>,
    view: &View,
) -> Result<Frame, DrawFailure> {
    let pixels = pump.sink().frame().map_err(DrawFailure::Incomplete)?;
    let rgb = pixels.into_iter().flat_map(F::to_rgb8).collect();
    Frame::new(view.width, view.height, rgb)
        .ok_or_else(|| DrawFailure::View("the picture has another size".into()))
}

/// Memory for a model's scene.
#[must_use]
pub fn rooms_for<P: Pipeline>(prepared: &Prepared, height: u16) -> SceneRooms<P> {
    let faces: usize = prepared.chunks.iter().map(|c| c.faces.len()).sum();
    let vertices: usize = prepared.chunks.iter().map(|c| c.positions.len()).sum();
    // Clipping can make several triangles of one; a scene that needs more is drawn in bands.
    let objects = (4 * faces + 64).min(usize::from(Link::CACHED));
    SceneRooms::new(
        (vertices + 8 * faces + 64).min(1 << 16),
        objects,
        height.into(),
    )
}

/// Adds the figures of a band.
fn add(total: &mut FrameStats, band: &FrameStats) {
    let (a, b): (&mut PassOne, &PassOne) = (&mut total.pass_one, &band.pass_one);
    a.triangles += b.triangles;
    a.culled += b.culled;
    a.clipped += b.clipped;
    a.objects += b.objects;
    a.vertices += b.vertices;
    a.dropped += b.dropped;
    // One that is on several bands is told of in each.
    a.untextured += b.untextured;
    a.meshes_skipped += b.meshes_skipped;
    a.triangles_skipped += b.triangles_skipped;
    a.vertices_skipped += b.vertices_skipped;
    total.spans += band.spans;
    total.cache += band.cache;
    total.prefetch_bytes += band.prefetch_bytes;
    total.slow_read_bytes += band.slow_read_bytes;
    total.slow_write_bytes += band.slow_write_bytes;
    total.scanlines_skipped += band.scanlines_skipped;
    total.scan_out.bytes_sent += band.scan_out.bytes_sent;
    total.scan_out.transfers += band.scan_out.transfers;
    total.scan_out.stall_polls += band.scan_out.stall_polls;
    total.scan_out.lines_unsent += band.scan_out.lines_unsent;
    total.scan_out.bytes_unsent += band.scan_out.bytes_unsent;
}
