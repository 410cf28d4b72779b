//! Pass two: the objects of a line into its pixels (K1, K5, K8).

use super::place::Place;
use super::scene::Scene;
use super::spans::draw_span;
use crate::active::{ActiveList, CacheCounts, Interleave, Member, Slot, Visitor};
use crate::geometry::{Drawable, Parameters};
use crate::link::Link;
use crate::pipeline::{CellOf, DrawableOf, ObjectOf, Pipeline, SlotOf, VertexOf, WordOf};
use crate::shade::{Interpolation, Quality};
use crate::span::Span;
use crate::stats::{SpanCounter, SpanCounts};
use crate::visible::LineDepth;

/// The memory of one line renderer, lent by the application.
///
/// All of it belongs to this renderer alone; a second one over the same link column is refused:
/// ```compile_fail,E0499
/// # use scanbeam::{GouraudDepth, LineMemory, LineRenderer, Link, Rgb888};
/// let (mut links, mut depth, mut other) = ([Link::NONE; 9], [0; 9], [0; 9]);
/// let memory = LineMemory { slots: &mut [], links: &mut links, depth: &mut depth, spans: &mut [] };
/// let one = LineRenderer::<GouraudDepth<Rgb888>>::new(memory);
/// let memory = LineMemory { slots: &mut [], links: &mut links, depth: &mut other, spans: &mut [] };
/// let two = LineRenderer::<GouraudDepth<Rgb888>>::new(memory);
/// drop((one, two));
/// ```
pub struct LineMemory<'m, P: Pipeline> {
    /// The object cache, best in the fastest RAM there is. Any length: what finds no slot is
    /// served from slow memory, and the picture is the same.
    pub slots: &'m mut [SlotOf<P>],
    /// This renderer's column of links, one for each object of the scene; in slow memory.
    pub links: &'m mut [Link],
    /// The depth of one line, a cell a pixel; in fast RAM. Without depth a cell has no size, and
    /// `[(); 8192]` will do.
    pub depth: &'m mut [CellOf<P>],
    /// Spans of one line, in fast RAM. While a line has no more of them than this, and none
    /// overlap, it is drawn without depth. Any length, also 0, gives the same picture.
    pub spans: &'m mut [SpanRecord],
}

/// A span that waits until all of its line are known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SpanRecord {
    /// Slot of the cache.
    slot: u16,
    /// First pixel of the line.
    start: u16,
    /// Pixel after the last.
    end: u16,
}

/// A line renderer has less memory than the scene needs. Nothing was drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RendererError {
    /// Fewer links than the scene has objects.
    Links {
        /// Objects of the scene.
        needed: usize,
        /// Links of the renderer.
        have: usize,
    },
    /// Fewer depth cells than a line has pixels.
    Depth {
        /// Pixels a line.
        needed: usize,
        /// Depth cells of the renderer.
        have: usize,
    },
    /// The pixels lent for a line are not as many as a line has.
    Pixels {
        /// Pixels a line.
        needed: usize,
        /// Pixels lent.
        have: usize,
    },
    /// The line is not among those the scene was begun with.
    Line {
        /// The line.
        line: u16,
    },
    /// The line belongs to none of the renderers, or came out of turn from the one it belongs to.
    Unowned {
        /// The line.
        line: u16,
    },
    /// The frame was given up while another renderer still owed the line.
    Stopped {
        /// The line.
        line: u16,
    },
}

impl core::fmt::Display for RendererError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Links { needed, have } => {
                write!(
                    f,
                    "renderer: {needed} objects need as many links, there are {have}"
                )
            }
            Self::Depth { needed, have } => {
                write!(
                    f,
                    "renderer: a line of {needed} pixels has {have} depth cells"
                )
            }
            Self::Pixels { needed, have } => {
                write!(f, "renderer: a line of {needed} pixels was lent {have}")
            }
            Self::Line { line } => write!(f, "renderer: line {line} is not part of the scene"),
            Self::Unowned { line } => write!(f, "renderer: nobody draws line {line} in its turn"),
            Self::Stopped { line } => write!(f, "renderer: given up while line {line} was awaited"),
        }
    }
}

impl core::error::Error for RendererError {}

/// Draws lines of a scene: owns a cache, a link column and the depth of a line, and shares the
/// scene with any number of others (K16, X6).
///
/// What it owns it has as `&mut`, and what it shares as `&Scene`, so renderers on several cores
/// or threads cannot race: there is nothing that two of them write. `LineRenderer` is [`Send`]
/// and [`Scene`] is [`Sync`] for every pipeline of this crate.
///
/// A renderer that turns to another `Scene` value has to be told by
/// [`restart`](LineRenderer::restart); a scene that is begun anew it notices by itself.
pub struct LineRenderer<'m, P: Pipeline> {
    pub(super) list: ActiveList<'m, DrawableOf<P>>,
    depth: &'m mut [CellOf<P>],
    spans: &'m mut [SpanRecord],
    /// Whether depth cells are not all at their farthest.
    dirty: bool,
    /// Where an object is set up that has no slot.
    spare: DrawableOf<P>,
    /// How far which scene has been drawn; `None` before its first line.
    pub(super) place: Option<Place>,
    pub(super) interleave: Interleave,
    /// Bytes a line that are fetched ahead where the renderer has the time.
    pub(super) prefetch: u32,
    counter: P::Counter,
    interpolation: P::Interpolation,
}

impl<L> Member for Drawable<L> {
    #[inline(always)]
    fn end(&self) -> i32 {
        i32::from(Drawable::end(self))
    }
}

impl<'m, P: Pipeline> LineRenderer<'m, P> {
    /// A renderer that draws every line.
    #[must_use]
    pub fn new(memory: LineMemory<'m, P>) -> Self {
        Self {
            list: ActiveList::new(memory.slots, memory.links),
            depth: memory.depth,
            spans: memory.spans,
            dirty: true,
            spare: Drawable::EMPTY,
            place: None,
            interleave: Interleave::ALL,
            prefetch: 0,
            counter: P::Counter::default(),
            interpolation: P::Interpolation::default(),
        }
    }

    /// States how far the picture may be off; only pipelines that choose listen, such as those
    /// with [`Auto`](crate::Auto).
    pub fn set_quality(&mut self, quality: Quality) {
        self.interpolation.set_quality(quality);
    }

    /// An empty slot, to fill a cache with.
    #[must_use]
    pub const fn empty_slot() -> SlotOf<P> {
        SlotOf::<P>::new(Drawable::EMPTY)
    }

    /// Which lines this renderer draws: objects that end before its next line leave the cache at
    /// once. Any other line can be drawn too, with the same bits, but then it starts anew from
    /// the top.
    pub fn set_interleave(&mut self, interleave: Interleave) {
        self.interleave = interleave;
    }

    /// Which lines this renderer draws.
    #[must_use]
    pub fn interleave(&self) -> Interleave {
        self.interleave
    }

    /// Whether the memory suffices for `scene`.
    ///
    /// # Errors
    /// What is too short.
    pub fn check(&self, scene: &Scene<'_, P>) -> Result<(), RendererError> {
        let needed = scene.pass_one().objects as usize;
        let have = self.list.room();
        if have < needed {
            return Err(RendererError::Links { needed, have });
        }
        let needed = usize::from(scene.screen().width());
        let have = self.depth.len();
        if have < needed {
            return Err(RendererError::Depth { needed, have });
        }
        Ok(())
    }

    /// Forgets the lines drawn so far and starts counting anew.
    pub fn restart(&mut self) {
        self.place = None;
        self.counter = P::Counter::default();
    }

    /// Draws a line of the picture into `pixels`, over what is there; `false` when nothing is
    /// active on it.
    ///
    /// Any line can be drawn alone, in any order, with the same bits (K5); going down is fast,
    /// going back starts anew from the top.
    ///
    /// # Errors
    /// When the memory does not suffice for the scene, or the line is not of the scene.
    pub fn draw_line(
        &mut self,
        scene: &Scene<'_, P>,
        line: u16,
        pixels: &mut [WordOf<P>],
    ) -> Result<bool, RendererError> {
        let screen = scene.screen();
        let width = usize::from(screen.width());
        self.check(scene)?;
        if pixels.len() != width {
            return Err(RendererError::Pixels {
                needed: width,
                have: pixels.len(),
            });
        }
        if !scene.lines().contains(&line) {
            return Err(RendererError::Line { line });
        }
        let (left, top) = (screen.left(), screen.top());
        let now = top + i32::from(line);
        // No picture has lines that far down.
        let next = top
            + self
                .interleave
                .at_or_after(u32::from(line) + 1)
                .min(1 << 14) as i32;
        let mut place = match self.place {
            Some(place) if place.serves(scene.content(), now) => place,
            _ => {
                self.list.clear();
                Place::above(scene)
            }
        };
        for bucket in place.admitted + 1..=now {
            let rest = place.rest.take().unwrap_or_else(|| {
                self.list.counts.buckets += 1;
                scene.bucket(bucket)
            });
            self.list.admit(scene.chain(rest));
        }
        (place.last, place.next, place.admitted) = (now, next, now);
        self.place = Some(place);
        if self.list.is_empty() {
            return Ok(false);
        }
        let Some(cells) = self.depth.get_mut(..width) else {
            return Ok(false);
        };
        let mut pass = LinePass {
            scene,
            pixels,
            cells,
            records: &mut *self.spans,
            count: 0,
            together: P::Depth::TESTS,
            dirty: &mut self.dirty,
            line: now,
            left,
            thin: 0,
            counter: &mut self.counter,
            interpolation: self.interpolation,
        };
        if P::Depth::TESTS {
            pass.clear();
        }
        self.list.walk((now, next), &mut self.spare, &mut pass);
        let thin = pass.finish(self.list.slots());
        self.list.counts.set_ups += thin;
        Ok(true)
    }

    /// Bytes of an object and its corners in slow memory.
    pub const RECORD_BYTES: usize = size_of::<ObjectOf<P>>() + 3 * size_of::<VertexOf<P>>();

    /// How the cache has done in the current frame (C8).
    #[must_use]
    pub fn cache_counts(&self) -> CacheCounts {
        self.list.counts
    }

    /// What has been counted along spans since [`take_span_counts`](Self::take_span_counts).
    pub fn take_span_counts(&mut self) -> SpanCounts {
        core::mem::take(&mut self.counter).counts()
    }
}

impl<P: Pipeline> Visitor<DrawableOf<P>> for LinePass<'_, '_, P> {
    #[inline(always)]
    fn set_up(&mut self, object: u16, body: &mut DrawableOf<P>) -> bool {
        self.scene.set_up(object, self.line, body)
    }

    #[inline(always)]
    fn visit(&mut self, index: usize, slot: &mut Slot<DrawableOf<P>>) -> bool {
        let Some(span) = self.span(slot.body_mut()) else {
            return true;
        };
        if !self.together {
            self.draw(slot.object(), slot.body(), span, P::Depth::TESTS);
            return true;
        }
        let Some(record) = self.records.get_mut(self.count) else {
            return false;
        };
        *record = SpanRecord {
            slot: index as u16,
            start: span.start as u16,
            end: span.end as u16,
        };
        self.count += 1;
        if let Some(cell) = self.cells.get_mut(span.start) {
            P::Depth::mark(cell, span.end as u16);
        }
        true
    }

    #[cold]
    #[inline(never)]
    fn flush(&mut self, slots: &[Slot<DrawableOf<P>>]) {
        self.part(slots);
    }

    #[cold]
    #[inline(never)]
    fn visit_spilled(
        &mut self,
        object: u16,
        body: &mut DrawableOf<P>,
        slots: &[Slot<DrawableOf<P>>],
    ) {
        if self.together {
            self.part(slots);
        }
        if let Some(span) = self.span(body) {
            self.draw(object, body, span, P::Depth::TESTS);
        }
    }
}

/// One line on its way from objects to pixels.
///
/// Where no two spans of a line overlap, no depth has to be compared, stored or cleared. So
/// spans are only noted at first, each marked in the depth cell of its first pixel with its end.
/// Walking from mark to mark then meets all of them exactly if none overlap; if not, or if
/// there are too many, or one has no slot, they are drawn with depth.
struct LinePass<'a, 's, P: Pipeline> {
    scene: &'a Scene<'s, P>,
    pixels: &'a mut [WordOf<P>],
    cells: &'a mut [CellOf<P>],
    records: &'a mut [SpanRecord],
    /// Records in use.
    count: usize,
    /// Whether spans are noted, not yet drawn.
    together: bool,
    dirty: &'a mut bool,
    line: i32,
    left: i32,
    /// Triangles drawn from their corners in slow memory.
    thin: u32,
    counter: &'a mut P::Counter,
    interpolation: P::Interpolation,
}

impl<P: Pipeline> LinePass<'_, '_, P> {
    /// Sets all depth cells to their farthest, if they are not.
    #[inline]
    fn clear(&mut self) {
        if *self.dirty {
            self.cells.fill(P::Depth::FARTHEST);
            *self.dirty = false;
        }
    }

    /// The pixels of an object on this line.
    #[inline(always)]
    fn span(&self, body: &mut DrawableOf<P>) -> Option<Span> {
        let columns = body.columns(self.line);
        Span::clipped(self.line, columns, self.left, self.pixels.len())
    }

    /// Draws what was noted with depth; what comes will be drawn at once.
    #[cold]
    #[inline(never)]
    fn part(&mut self, slots: &[Slot<DrawableOf<P>>]) {
        self.together = false;
        self.cells.fill(P::Depth::FARTHEST);
        *self.dirty = true;
        self.draw_noted(slots, true);
    }

    /// Draws what was noted: without depth if no two spans overlap; how many triangles were too
    /// thin for planes.
    #[inline(always)]
    fn finish(mut self, slots: &[Slot<DrawableOf<P>>]) -> u32 {
        if self.together {
            if self.disjoint() {
                self.draw_noted(slots, false);
            } else {
                self.part(slots);
            }
        }
        self.thin
    }

    /// Whether no two noted spans overlap; then their marks are gone.
    #[inline(always)]
    fn disjoint(&mut self) -> bool {
        let (mut at, mut end) = (self.cells.len(), 0);
        for record in self.records.iter().take(self.count) {
            at = at.min(usize::from(record.start));
            end = end.max(usize::from(record.end));
        }
        let mut met = 0;
        while at < end {
            match self.cells.get_mut(at).map_or(0, P::Depth::unmark) {
                0 => at += 1,
                next => {
                    met += 1;
                    at = usize::from(next);
                }
            }
        }
        met == self.count
    }

    #[inline(always)]
    fn draw_noted(&mut self, slots: &[Slot<DrawableOf<P>>], tested: bool) {
        for i in 0..self.count {
            let record = self.records[i];
            let slot = &slots[usize::from(record.slot)];
            let (start, end) = (usize::from(record.start), usize::from(record.end));
            let span = Span {
                column: self.left + start as i32,
                line: self.line,
                start,
                end,
            };
            self.draw(slot.object(), slot.body(), span, tested);
        }
    }

    #[inline(always)]
    fn draw(&mut self, object: u16, body: &DrawableOf<P>, span: Span, tested: bool) {
        let cells = if tested {
            self.cells.get_mut(span.start..span.end)
        } else {
            None
        };
        if matches!(body.parameters, Parameters::Corners) {
            self.thin += 1;
        }
        if let Some(pixels) = self.pixels.get_mut(span.start..span.end) {
            draw_span::<P>(
                self.scene,
                object,
                body,
                span,
                (pixels, cells),
                (self.interpolation, self.counter),
            );
        }
    }
}
