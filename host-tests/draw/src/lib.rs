//! A model through the whole pipeline into a mocked frame buffer, as firmware would draw it.

pub mod choice;
mod counted;
pub mod crew;
mod depth;
mod effects;
mod flash;
mod formats;
mod hardware;
mod interp;
mod models;
mod pace;
mod parts;
pub mod places;
mod prepared;
pub mod scene_file;
mod scenes;
mod setting;
mod textured;
mod words;

pub use depth::draw_by_depth;
pub use effects::{Effects, draw_effects};
pub use flash::{camera_words, flash_words};
pub use hardware::{ModelLines, draw_model, trace_model_line};
pub use interp::{draw_by, draw_by_methods};
pub use models::{draw, draw_prepared, draw_textured};
pub use prepared::Prepared;
pub use scenes::{SceneParts, Twice, draw_scene_file, twice};
pub use setting::Setting;
pub use textured::{FilterArg, Skins, TextureSet, TextureSetError};

use crate::choice::{DEFAULT_SLOTS, DepthArg};
use host_support::image_out::Frame;
use host_support::mock::{HostLine, MockError, MockFrameBuffer};
use scanbeam::frame::{FrameError, FrameUse, Paid};
use scanbeam::scan_out::Pump;
use scanbeam::scene::CacheReads;
use scanbeam::stats::SpanCounts;
use serde_json::json;

/// Most slots that a renderer's cache has, inclusive: more are as good as these, as far as the picture goes.
pub const MOST_SLOTS: u16 = 224;

/// Who draws a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CrewSettings {
    /// Line renderers: one on this thread, or several on a thread each, at least 1.
    pub renderers: u16,
    /// Slots of each one's object cache, of which up to [`MOST_SLOTS`] are used.
    pub slots: u16,
    /// Bytes a line that each fetches ahead.
    pub prefetch: u32,
    /// Whether spans and pixels are counted, for which lines take longer.
    pub counts: bool,
    /// How what is seen is found.
    pub depth: DepthArg,
    /// The most that a line may cost, in instructions of M4 code, if there is a limit.
    pub pace: Option<u32>,
}

impl Default for CrewSettings {
    fn default() -> Self {
        Self {
            renderers: 1,
            slots: DEFAULT_SLOTS,
            prefetch: 0,
            counts: false,
            depth: DepthArg::Auto,
            pace: None,
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
    /// What a laboratory method drew did not arrive, or it has too little memory.
    #[error("display: {0}")]
    Method(String),
    /// The frame did not arrive whole.
    #[error("display: {0:?}")]
    Incomplete(MockError),
}

/// Lines that have more triangles than memory can hold: they show those that fit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Overfull {
    /// The first such line.
    pub line: u16,
    /// How many lines there are.
    pub lines: u32,
    /// How many triangles are left out, each on each of the lines.
    pub triangles: u32,
    /// What was full on the first line.
    pub first: String,
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

/// Memory that a picture takes: that of the part with the most of each.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Figures {
    /// Parts that the picture is put together from.
    pub parts: u32,
    /// Records of triangles, more than are seen where clipping cuts: of the whole picture, whatever its parts are.
    pub objects: usize,
    /// Vertices of the whole picture, likewise.
    pub vertices: usize,
    /// Bytes that a renderer reads of a triangle with its corners.
    pub record_bytes: u32,
    /// Most bytes of slow memory in use: the scene, and a column of links for each renderer.
    pub slow_bytes: usize,
    /// Bytes of fast memory: slots of the caches and depth of a line, for each renderer.
    pub fast_bytes: usize,
    /// Bytes of the two line buffers.
    pub line_bytes: usize,
}

/// A finished picture and what it took.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawn {
    /// The picture, converted back to 8-bit levels.
    pub frame: Frame,
    /// What it took, all parts and renderers together; of the most slots in use, those of the renderer that has most.
    /// Figures of pass one are of the model and the whole picture: each triangle counts once whatever the parts.
    pub used: FrameUse,
    /// Spans and pixels, likewise together, where they were counted.
    pub spans: Option<SpanCounts>,
    /// Memory.
    pub figures: Figures,
    /// What is left out.
    pub overfull: Option<Overfull>,
    /// What caches of texels did, all together; `None` where there are none.
    pub texels: Option<CacheReads>,
    /// What was paid for lines not to cost too much; `None` where there is no limit.
    pub paid: Option<Paid>,
}

impl Drawn {
    /// The figures as `render --stats` writes them.
    ///
    /// `objects_in` is the number of the model's triangles, and `objects_culled` how many of them are on no line of the
    /// picture or show their back. `objects_kept` are the records made of the others, more where clipping cuts, and in
    /// a picture of more than 1016 columns or lines more where parts of it share a triangle; `vertices_kept` are
    /// theirs. What was `skipped`, since its part of the model is out of sight, counts in each part of the picture. Of the cache, `hits` are spans drawn from a slot, and `misses` those that were set up for their line.
    #[must_use]
    pub fn to_json(&self) -> serde_json::Value {
        let (done, cache, sent) = (&self.used.assembled, &self.used.cache, &self.used.scan_out);
        let figures = &self.figures;
        let mut all = json!({
            "objects_in": done.triangles,
            "objects_culled": done.culled,
            "objects_clipped": done.clipped,
            "objects_kept": figures.objects,
            "vertices_kept": figures.vertices,
            "objects_skipped": done.triangles_skipped,
            "meshes_skipped": done.meshes_skipped,
            "vertices_skipped": done.vertices_skipped,
            "scanlines_skipped": self.used.lines_skipped,
            "bytes_sent": sent.bytes_sent,
            "lines_unsent": sent.lines_unsent,
            "bytes_unsent": sent.bytes_unsent,
            "transfers": sent.transfers,
            "bands": figures.parts,
            "cache": {
                "found_slot": cache.hits,
                "misses": cache.misses,
                "spills": cache.spilled,
                "moved_in": cache.moved_in,
                "set_ups": cache.set_ups,
                "prefetched": cache.fetched,
                "prefetch_bytes": cache.fetched_bytes,
                "slow_read_bytes": cache.slow_read_bytes(figures.record_bytes),
                "slow_write_bytes": cache.slow_write_bytes(),
                "peak_slots": cache.peak,
            },
            "ram": {
                "slow_bytes": figures.slow_bytes,
                "fast_bytes": figures.fast_bytes,
                "line_bytes": figures.line_bytes,
            },
        });
        if let Some(paid) = &self.paid {
            all["paid"] = pace::to_json(paid);
        }
        if let Some(texels) = &self.texels {
            all["texel_cache"] = json!({
                "reads": texels.reads,
                "page_changes": texels.page_changes,
                "misses": texels.misses,
            });
        }
        if let Some(spans) = &self.spans {
            all["spans"] = json!(spans.spans);
            all["spans_hidden"] = json!(spans.spans_hidden);
            all["spans_untested"] = json!(spans.spans_untested);
            all["pixels_shaded"] = json!(spans.pixels_shaded);
            all["pixels_hidden"] = json!(spans.pixels_hidden);
            all["depth_tests"] = json!(spans.depth_tests);
            all["texture_fetches"] = json!(spans.texture_fetches);
            let hits = spans.spans.saturating_sub(cache.misses);
            let share = 1000 * u64::from(hits) / u64::from(spans.spans.max(1));
            all["cache"]["hits"] = json!(hits);
            all["cache"]["hits_per_mille"] = json!(share);
        }
        all
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
