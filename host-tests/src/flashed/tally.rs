//! What a scene does, counted on this machine: in pass one, and on its lines with so many slots.

use super::shape::{self, Shares};
use crate::draw::MOST_SLOTS;
use crate::rooms::LineRooms;
use scanbeam::Scene;
use scanbeam::frame::{CacheUse, LineError};
use scanbeam::look::Look;
use scanbeam::pixel::PixelFormat;
use scanbeam::stats::SpanCounts;

/// Words of 32 slots of the largest cache. All that is drawn here has such a one, so that renderers are compiled once.
pub(super) const WORDS: usize = MOST_SLOTS as usize / 32;

/// What meshes of draw calls have.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Meshes {
    /// Vertices.
    pub vertices: u32,
    /// Those that are lit.
    pub lit: u32,
    /// Those that have a place on a texture.
    pub placed: u32,
    /// Lights of the scene.
    pub lights: u32,
}

/// What was put into a scene.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Built {
    /// States of draw calls.
    pub draws: u32,
    /// What they are of.
    pub meshes: Meshes,
    /// Where a list was played.
    pub listed: Option<Listed>,
}

/// What a player of a list does beside that.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Listed {
    /// Blocks.
    pub blocks: u32,
    /// Triangles.
    pub triangles: u32,
    /// Vertices that one white light falls on.
    pub white: u32,
    /// What the list has that has no costs on record.
    pub beyond: Option<&'static str>,
}

/// What pass one does.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct PassOne {
    /// Draw calls.
    pub draws: u32,
    /// What they are of.
    pub meshes: Meshes,
    /// Triangles that cannot be seen.
    pub culled: u32,
    /// Triangles that crossed a near, far or guard plane.
    pub clipped: u32,
    /// Vertices in memory beyond those of meshes: of what was cut.
    pub own: u32,
    /// Triangles that were filed.
    pub filed: u32,
    /// Where a list is played.
    pub listed: Option<Listed>,
}

impl PassOne {
    /// Of a scene that was built.
    #[must_use]
    pub fn of<L: Look>(scene: &Scene<'_, '_, L>, built: Built) -> Self {
        let all = scene.assembled();
        let Built {
            draws,
            meshes,
            listed,
        } = built;
        Self {
            draws,
            meshes,
            listed,
            culled: all.culled,
            clipped: all.clipped,
            own: (scene.vertices() as u32).saturating_sub(meshes.vertices),
            filed: scene.objects() as u32,
        }
    }
}

/// What a line does.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct LineTally {
    /// Along its spans.
    pub spans: SpanCounts,
    /// In the cache.
    pub cache: CacheUse,
}

/// What a frame does.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Tally {
    /// The most slots that were used.
    pub slots: u16,
    /// Slots that were in use at a time.
    pub peak: u32,
    /// Pixels of a line.
    pub width: u16,
    /// In pass one.
    pub pass_one: PassOne,
    /// On each line.
    pub lines: Vec<LineTally>,
    /// Triangles of each kind, on each line.
    pub shares: Vec<Shares>,
}

impl Tally {
    /// Draws a scene with each of these numbers of slots, over a background.
    ///
    /// # Errors
    /// When a line cannot be drawn.
    pub fn count_all<L: Look>(
        scene: &Scene<'_, '_, L>,
        pass_one: PassOne,
        slots: &[u16],
        background: <L::Pixel as PixelFormat>::Word,
    ) -> Result<Vec<Self>, LineError> {
        if slots.is_empty() {
            return Ok(Vec::new());
        }
        let shares = shape::shares(scene);
        let one = |slots: &u16| {
            let of_none = Self {
                slots: *slots,
                peak: 0,
                width: scene.screen().width(),
                pass_one,
                lines: Vec::new(),
                shares: shares.clone(),
            };
            of_none.count(scene, background)
        };
        slots.iter().map(one).collect()
    }

    /// With what lines do.
    fn count<L: Look>(
        self,
        scene: &Scene<'_, '_, L>,
        background: <L::Pixel as PixelFormat>::Word,
    ) -> Result<Self, LineError> {
        let rooms = LineRooms::<L, WORDS>::new(scene.objects(), self.width);
        let mut rooms = rooms.with_counts().with_limit(self.slots);
        let mut renderer = rooms.renderer().counting();
        let mut line = vec![background; self.width.into()];
        let (mut lines, mut before) = (Vec::new(), LineTally::default());
        for y in scene.lines() {
            renderer.draw_line(scene, y, &mut line, background)?;
            let now = LineTally {
                spans: renderer.spans(),
                cache: renderer.counts(),
            };
            lines.push(now.since(&before));
            before = now;
        }
        Ok(Self {
            peak: before.cache.peak,
            lines,
            ..self
        })
    }
}

/// What was done along spans since another count.
#[must_use]
pub fn spans_since(now: &SpanCounts, was: &SpanCounts) -> SpanCounts {
    SpanCounts {
        spans: now.spans - was.spans,
        spans_hidden: now.spans_hidden - was.spans_hidden,
        spans_untested: now.spans_untested - was.spans_untested,
        pixels_shaded: now.pixels_shaded - was.pixels_shaded,
        pixels_hidden: now.pixels_hidden - was.pixels_hidden,
        depth_tests: now.depth_tests - was.depth_tests,
        texture_fetches: now.texture_fetches - was.texture_fetches,
    }
}

impl LineTally {
    /// What was done since another count.
    fn since(&self, before: &Self) -> Self {
        let (cache, had) = (&self.cache, &before.cache);
        Self {
            spans: spans_since(&self.spans, &before.spans),
            cache: CacheUse {
                hits: cache.hits - had.hits,
                spilled: cache.spilled - had.spilled,
                moved_in: cache.moved_in - had.moved_in,
                misses: cache.misses - had.misses,
                set_ups: cache.set_ups - had.set_ups,
                turning: cache.turning - had.turning,
                ..*cache
            },
        }
    }
}
