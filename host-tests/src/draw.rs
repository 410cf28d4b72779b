//! A model through the whole pipeline into a mocked frame buffer, as firmware would draw it.

mod depth;
mod effects;
mod formats;
mod interp;
mod prepared;
mod scenes;
mod textured;

pub use depth::draw_by_depth;
pub use effects::{Effects, draw_effects};
pub use interp::{draw_by, draw_prepared};
pub use prepared::Prepared;
pub use scenes::{SceneParts, draw_scene_file};
pub use textured::{FilterArg, HostTexture, TextureSet, TextureSetError, draw_textured};

use crate::args::{DEFAULT_SLOTS, PixelFormatArg};
use crate::crew;
use crate::image_out::Frame;
use crate::lent::{LineRooms, SceneRooms};
use crate::mock::{HostLine, MockError, MockFrameBuffer};
use crate::model::Model;
use crate::reference::{Cull, Shade, View};
use scanbeam::blend::{Compositing, ShadowError};
use scanbeam::pipeline::{DepthUse, FlatDepth, GouraudDepth, Pipeline, WordOf};
use scanbeam::pixel::{PixelFormat, Rgb565Be, Rgb888};
use scanbeam::scan_out::Pump;
use scanbeam::stats::PassOne;
use scanbeam::{
    Camera, DrawError, Faces, FrameError, FrameStats, Instance, Light, Link, Mesh, Quality, Scene,
    Screen,
};
use scanbeam_model::{
    CornerColours, ModelFrameError, ModelRenderer, PipeMemory, SEGMENT, draw_model_frame,
};
use serde_json::json;
use std::ops::Range;

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
    /// The mocked display refused what the hardware model drew.
    #[error("display: {0:?}")]
    Model(ModelFrameError<MockError>),
    /// The frame did not arrive whole.
    #[error("display: {0:?}")]
    Incomplete(MockError),
}

/// Lines that have more triangles than an arena can hold: they show those that fit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Overfull {
    /// The first such line.
    pub line: u16,
    /// How many lines there are.
    pub lines: u32,
    /// How many triangles are left out, each on each of the lines.
    pub triangles: u32,
    /// What was full on the first line.
    pub first: DrawError,
}

impl std::fmt::Display for Overfull {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { line, first, .. } = self;
        write!(f, "line {line}: {first}; the rest is drawn")?;
        match self.lines {
            1 => Ok(()),
            n => write!(
                f,
                " ({n} lines are so, {} triangles in all)",
                self.triangles
            ),
        }
    }
}

/// How a picture was put together.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Bands {
    /// Bands of lines that were drawn one after the other.
    pub(crate) count: u32,
    /// What fits no band.
    pub(crate) overfull: Option<Overfull>,
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
        let chunk = &prepared.chunks[chunk];
        let done = chunk.draw(scene, (&setting.instance, &()), alone);
        done.map_err(ShadowError::Draw)
    };
    let steps = prepared.chunks.len();
    draw_scenes::<P>(
        (Some(prepared), &setting, rooms),
        (view, crew),
        (steps, build),
    )
}

/// Draws the scenes that `build` makes, step by step; of one prepared model, its triangles are
/// counted once.
fn draw_scenes<P: Pipeline<Textures: Sync>>(
    (prepared, setting, mut rooms): (Option<&Prepared>, &Setting, SceneRooms<P>),
    (view, crew): (&View, CrewSettings),
    (steps, build): (
        usize,
        impl FnMut(&mut Scene<'_, P>, usize, bool) -> Result<(), ShadowError>,
    ),
) -> Result<Drawn, DrawFailure> {
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
    let (mut pump, lines) = display::<P>(width, height);
    let mut total = FrameStats::default();
    let mut slow_bytes = 0;
    let bands = setting.bands_of((&mut rooms, 0..height), (steps, build), |scene| {
        let stats = crew::draw_frame(scene, &mut renderers, &mut pump, background, lines)
            .map_err(DrawFailure::Display)?;
        add(&mut total, &stats);
        slow_bytes = slow_bytes.max(scene.bytes() + stats.pass_one.objects as usize * column_bytes);
        Ok(())
    })?;
    if let Some(prepared) = prepared.filter(|_| bands.count > 1 || P::Compositing::BLENDS) {
        // Volumes, and what is drawn twice, are none of the model's triangles.
        setting.count_once(prepared, &mut rooms, &mut total.pass_one)?;
    }
    Ok(Drawn {
        frame: shown::<P>(&pump, view)?,
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
    let (mut pump, lines) = display::<P>(width, height);
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
        frame: shown::<P>(&pump, view)?,
        stats: total,
        bands: bands.count,
        overfull: bands.overfull,
        slow_bytes,
        fast_bytes: lines_of_model.bytes(),
        line_bytes: line_bytes::<P>(width, lines),
    })
}

/// The scanlines that the hardware model works in.
pub(crate) struct ModelLines([Vec<u64>; 4]);

impl ModelLines {
    /// As wide as a picture, or as the widest segment.
    pub(crate) fn new(width: u16) -> Self {
        let line = vec![0; usize::from(width).min(SEGMENT)];
        Self([line.clone(), line.clone(), line.clone(), line])
    }

    /// A renderer over them.
    pub(crate) fn renderer(&mut self) -> ModelRenderer<'_> {
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
fn display<P: Pipeline>(width: u16, height: u16) -> (Pump<MockFrameBuffer<WordOf<P>>>, u16) {
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
fn shown<P: Pipeline>(
    pump: &Pump<MockFrameBuffer<WordOf<P>>>,
    view: &View,
) -> Result<Frame, DrawFailure> {
    let pixels = pump.sink().frame().map_err(DrawFailure::Incomplete)?;
    let rgb = pixels.into_iter().flat_map(P::Pixel::to_rgb8).collect();
    Frame::new(view.width, view.height, rgb)
        .ok_or_else(|| DrawFailure::View("the picture has another size".into()))
}

/// What stays the same for all bands of a picture.
pub(crate) struct Setting {
    screen: Screen,
    camera: Camera,
    instance: Instance,
}

impl Setting {
    /// In the crate's number formats.
    pub(crate) fn new(prepared: &Prepared, view: &View) -> Result<Self, DrawFailure> {
        let bad = |error: &dyn std::fmt::Display| DrawFailure::View(error.to_string());
        let screen = Screen::new(view.width as u16, view.height as u16).map_err(|e| bad(&e))?;
        let focal = f64::from(view.height) / 2.0 / (view.fov.to_radians() / 2.0).tan();
        let far = prepared
            .centre
            .iter()
            .fold(0.0f64, |far, c| far.max(c.abs()));
        if far.max(prepared.scale) > 2f64.powi(90) {
            return Err(bad(
                &"the model is too large, or too far away: its coordinates must be below 2^90",
            ));
        }
        // The model's middle is the origin, so that floats are spent on distances that matter.
        let from_centre = |p: [f64; 3]| [0, 1, 2].map(|i| (p[i] - prepared.centre[i]) as f32);
        let unit = |v: [f64; 3]| {
            let largest = v.iter().fold(0.0f64, |m, c| m.max(c.abs()));
            v.map(|c| (c / largest) as f32)
        };
        let camera = Camera::look_at(
            from_centre(view.eye),
            from_centre(view.at),
            unit(view.up),
            focal as f32,
            view.near as f32,
            view.far as f32,
        )
        .map_err(|e| bad(&e))?;
        let light = Light::new(unit(view.light), view.ambient as f32);
        let instance = Instance {
            model: prepared
                .model_matrix()
                .ok_or_else(|| bad(&"the model is too large"))?,
            cull: match view.cull {
                Cull::Back => scanbeam::Cull::Back,
                Cull::None => scanbeam::Cull::None,
            },
            light: light.filter(|_| view.shade != Shade::None),
            colour: [255; 3],
        };
        Ok(Self {
            screen,
            camera,
            instance,
        })
    }

    /// Builds the scene of `lines` of a model and hands it to `draw`; see
    /// [`bands_of`](Self::bands_of).
    pub(crate) fn bands<P: Pipeline>(
        &self,
        prepared: &Prepared,
        rooms: &mut SceneRooms<P>,
        lines: Range<u16>,
        draw: impl FnMut(&Scene<'_, P>) -> Result<(), DrawFailure>,
    ) -> Result<Bands, DrawFailure> {
        let build = |scene: &mut Scene<'_, P>, chunk: usize, alone: bool| {
            let done = prepared.chunks[chunk].draw(scene, (&self.instance, &()), alone);
            done.map_err(ShadowError::Draw)
        };
        self.bands_of((rooms, lines), (prepared.chunks.len(), build), draw)
    }

    /// Builds the scene of `lines` and hands it to `draw`; in several bands from top to bottom
    /// where it does not fit the arenas as a whole. A line that does not fit by itself shows what
    /// does.
    fn bands_of<P: Pipeline>(
        &self,
        (rooms, lines): (&mut SceneRooms<P>, Range<u16>),
        (steps, mut build): (
            usize,
            impl FnMut(&mut Scene<'_, P>, usize, bool) -> Result<(), ShadowError>,
        ),
        mut draw: impl FnMut(&Scene<'_, P>) -> Result<(), DrawFailure>,
    ) -> Result<Bands, DrawFailure> {
        let mut scene = rooms.scene(self.screen);
        let mut bands = Bands::default();
        let mut start = lines.start;
        let mut count = lines.len() as u16;
        // Chunks whose triangles bring their own vertices.
        let mut alone = vec![false; steps];
        while start < lines.end {
            count = count.min(lines.end - start);
            scene
                .begin_band(&self.camera, start..start + count)
                .map_err(|error| DrawFailure::View(error.to_string()))?;
            let mut full = None;
            let mut changed = false;
            for (step, alone) in alone.iter_mut().enumerate() {
                let before = scene.pass_one();
                match build(&mut scene, step, *alone) {
                    Ok(()) => {}
                    Err(ShadowError::Draw(error @ DrawError::Full(_))) => {
                        full.get_or_insert(error);
                        if count > 1 {
                            break;
                        }
                    }
                    Err(error) => return Err(DrawFailure::View(error.to_string())),
                }
                let after = scene.pass_one();
                let (vertices, objects) = (
                    after.vertices - before.vertices,
                    after.objects - before.objects,
                );
                // A chunk most of which lies outside the band takes less room without sharing.
                if !*alone && vertices > 3 * objects {
                    *alone = true;
                    changed = true;
                }
            }
            if let Some(error) = full {
                if changed {
                    continue;
                }
                if count > 1 {
                    // Fewer lines have fewer triangles.
                    count = count.div_ceil(2);
                    continue;
                }
                let overfull = bands.overfull.get_or_insert(Overfull {
                    line: start,
                    lines: 0,
                    triangles: 0,
                    first: error,
                });
                overfull.lines += 1;
                overfull.triangles += scene.pass_one().dropped;
            }
            draw(&scene)?;
            bands.count += 1;
            start += count;
        }
        Ok(bands)
    }

    /// Replaces the sums over bands by counts of the whole picture, in which a triangle that is
    /// on several bands is one. Pass one runs again for that, a few thousand triangles at a time,
    /// so that they fit.
    fn count_once<P: Pipeline>(
        &self,
        prepared: &Prepared,
        rooms: &mut SceneRooms<P>,
        counts: &mut PassOne,
    ) -> Result<(), DrawFailure> {
        // With the vertices of a chunk and 8 more for each that is clipped: below 65,536.
        const TRIANGLES: usize = 7000;
        *counts = PassOne {
            dropped: counts.dropped,
            untextured: counts.untextured,
            ..PassOne::default()
        };
        let mut scene = rooms.scene(self.screen);
        for chunk in &prepared.chunks {
            // Parts of a chunk share its vertices, and are skipped together.
            let shared = chunk.positions.len() as u32;
            let (mut is_kept, mut is_skipped) = (false, false);
            for faces in chunk.faces.chunks(TRIANGLES) {
                scene
                    .begin(&self.camera)
                    .map_err(|error| DrawFailure::View(error.to_string()))?;
                let mesh = Mesh {
                    faces: Faces::Triangles(faces),
                    ..chunk.mesh()
                };
                match scene.draw_within(&mesh, &self.instance, &chunk.sphere) {
                    // What found no room was not culled, and only that is asked here.
                    Ok(_) | Err(DrawError::Full(_)) => {}
                    Err(error) => return Err(DrawFailure::View(error.to_string())),
                }
                let done = scene.pass_one();
                counts.triangles += done.triangles;
                counts.culled += done.culled;
                counts.clipped += done.clipped;
                counts.objects += done.objects;
                counts.vertices += done.vertices.saturating_sub(shared);
                counts.triangles_skipped += done.triangles_skipped;
                is_kept |= done.vertices > 0;
                is_skipped |= done.meshes_skipped > 0;
            }
            if is_kept {
                counts.vertices += shared;
            }
            if is_skipped {
                counts.meshes_skipped += 1;
                counts.vertices_skipped += shared;
            }
        }
        Ok(())
    }
}

/// Memory for a model's scene.
pub(crate) fn rooms_for<P: Pipeline>(prepared: &Prepared, height: u16) -> SceneRooms<P> {
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
