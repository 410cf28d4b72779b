//! Pass two: the objects of a line into its pixels (K1, K5, K8).

use super::error::RendererError;
use super::order::{Doubt, Order};
use super::place::Place;
use super::scene::Scene;
use super::spans::Brush;
use super::transparent::is_special;
use crate::active::{ActiveList, Interleave, Member, Slot, Visitor};
use crate::composite::{Compositing, PixelFormat};
use crate::geometry::Drawable;
use crate::link::Link;
use crate::pipeline::{CellOf, DrawableOf, ObjectOf, Pipeline, SlotOf, VertexOf, WordOf};
use crate::shade::{Interpolation, Quality};
use crate::span::Span;
use crate::stats::CacheCounts;
use crate::stats::{SpanCounter, SpanCounts};
use crate::visible::{DepthCell, LineDepth};

/// The memory of one line renderer, lent by the application.
///
/// All of it belongs to this renderer alone; a second one over the same link column is refused:
/// ```compile_fail,E0499
/// # use scanbeam::pipeline::GouraudDepth;
/// # use scanbeam::pixel::Rgb888;
/// # use scanbeam::{Link, pipeline::{LineMemory, LineRenderer}};
/// let (mut links, mut depth, mut other) = ([Link::NONE; 9], [0; 9], [0; 9]);
/// let memory = LineMemory { slots: &mut [], links: &mut links, depth: &mut depth };
/// let one = LineRenderer::<GouraudDepth<Rgb888>>::new(memory);
/// let memory = LineMemory { slots: &mut [], links: &mut links, depth: &mut other };
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
}

/// When depth is compared, in pipelines that have any. The picture is the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum DepthUse {
    /// On lines where spans overlap.
    #[default]
    WhereNeeded,
    /// On every line.
    Always,
}

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
    /// Whether depth cells are not all at their farthest.
    dirty: bool,
    depth_use: DepthUse,
    /// Of lines on which no spans overlap.
    apart: Doubt,
    /// Whether slots may hold objects without their depth.
    shallow: bool,
    order: Order,
    /// Where an object is set up that has no slot.
    spare: DrawableOf<P>,
    /// The first line below all objects in slots that are not drawn in the usual way.
    pub(super) special_end: i32,
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
            dirty: true,
            depth_use: DepthUse::WhereNeeded,
            apart: Doubt::default(),
            shallow: false,
            order: Order::default(),
            spare: Drawable::EMPTY,
            special_end: 0,
            place: None,
            interleave: Interleave::ALL,
            prefetch: 0,
            counter: P::Counter::default(),
            interpolation: P::Interpolation::default(),
        }
    }

    /// States how far the picture may be off; only pipelines that choose listen, such as those
    /// with [`Auto`](crate::pipeline::Auto).
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

    /// When depth is compared; [`DepthUse::WhereNeeded`] at first.
    pub fn set_depth_use(&mut self, depth_use: DepthUse) {
        self.depth_use = depth_use;
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
                self.special_end = 0;
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
        let shallow = self.leaves_depth();
        let Some(cells) = self.depth.get_mut(..width) else {
            return Ok(false);
        };
        let mut pass = LinePass {
            brush: Brush {
                scene,
                reads: 0,
                counter: &mut self.counter,
                interpolation: self.interpolation,
            },
            pixels,
            cells,
            dirty: &mut self.dirty,
            order: &mut self.order,
            special_end: &mut self.special_end,
            shallow,
            line: now,
            left,
        };
        if self.list.update(now, &mut pass) {
            pass.order.forget();
        }
        if self.list.is_empty() {
            return Ok(false);
        }
        if P::Compositing::BLENDS && (now < *pass.special_end || self.list.has_spilled()) {
            pass.draw_composited(&mut self.list, next, &mut self.spare);
            self.list.counts.set_ups += pass.brush.reads;
            return Ok(true);
        }
        let whole =
            P::Depth::TESTS && self.depth_use == DepthUse::WhereNeeded && !self.list.has_spilled();
        let mut drawn = whole && pass.order.is_known();
        if drawn {
            pass.draw_ordered(self.list.slots());
        }
        if whole && !drawn && self.apart.tries() {
            drawn = pass.draw_apart(&self.list);
            self.apart.learn(drawn);
        }
        if P::Depth::TESTS && !drawn {
            pass.shallow = false;
            if self.shallow {
                let reads = &mut pass.brush.reads;
                self.list.change_members(|object, body| {
                    *reads += u32::from(scene.deepen(object, body));
                });
                // What was fetched ahead is not yet among them.
                self.shallow = self.prefetch > 0;
            }
        }
        if P::Depth::ORDERS && whole && !drawn && pass.find_order(&self.list) {
            pass.draw_ordered(self.list.slots());
            drawn = true;
        }
        if P::Depth::DEFERS && !drawn && !self.list.has_spilled() {
            drawn = pass.draw_deferred(&self.list);
        }
        if P::Depth::WORDS && P::Pixel::HALVES && !drawn {
            pass.draw_words(&mut self.list, next, &mut self.spare);
            drawn = true;
        }
        if !drawn {
            pass.begin_together();
            self.list.visit_all(next, &mut self.spare, &mut pass);
        }
        self.list.counts.set_ups += pass.brush.reads;
        Ok(true)
    }

    /// Whether what is set up now is left without its depth, since lines do well without.
    #[inline(always)]
    pub(super) fn leaves_depth(&mut self) -> bool {
        let apart = self.depth_use == DepthUse::WhereNeeded
            && self.apart.is_calm()
            && !self.list.has_spilled();
        let leaves = !P::Compositing::BLENDS && (apart || !P::Depth::TESTS);
        self.shallow |= leaves;
        leaves
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

/// One line on its way from objects to pixels.
///
/// Where no two spans of a line overlap, no depth has to be compared, stored or cleared. So each
/// span first leaves a mark, its slot and its end, in the depth cell of its first pixel. Walking
/// from mark to mark, drawing, then meets all of them exactly if none overlap; if not, or if an
/// object has no slot, all are drawn anew with depth.
pub(super) struct LinePass<'a, 's, P: Pipeline> {
    pub(super) brush: Brush<'a, 's, P>,
    pub(super) pixels: &'a mut [WordOf<P>],
    pub(super) cells: &'a mut [CellOf<P>],
    /// Whether depth cells are not all at their farthest.
    pub(super) dirty: &'a mut bool,
    pub(super) order: &'a mut Order,
    /// See [`LineRenderer::special_end`].
    pub(super) special_end: &'a mut i32,
    /// Whether objects may be set up without their depth.
    shallow: bool,
    pub(super) line: i32,
    pub(super) left: i32,
}

impl<P: Pipeline> Visitor<DrawableOf<P>> for LinePass<'_, '_, P> {
    #[inline(always)]
    fn set_up(&mut self, object: u16, body: &mut DrawableOf<P>) -> bool {
        let how = (self.line, self.shallow);
        let there = self.brush.scene.set_up(object, how, body);
        if P::Compositing::BLENDS && there && is_special(self.brush.scene, object, body) {
            *self.special_end = (*self.special_end).max(i32::from(body.end()));
        }
        there
    }

    #[inline]
    fn visit(&mut self, object: u16, body: &DrawableOf<P>) {
        let Some((start, end)) = self.span(body) else {
            return;
        };
        let at = (self.left + start as i32, self.line);
        let cells = if P::Depth::TESTS {
            self.cells.get_mut(start..end)
        } else {
            None
        };
        let Some(pixels) = self.pixels.get_mut(start..end) else {
            return;
        };
        self.brush.draw(object, body, at, pixels, cells);
    }
}

impl<P: Pipeline> LinePass<'_, '_, P> {
    /// Sets all depth cells to their farthest, if they are not.
    #[inline]
    pub(super) fn clear(&mut self) {
        if *self.dirty {
            self.cells.fill(P::Depth::FARTHEST);
            *self.dirty = false;
            self.order.forget();
        }
    }

    /// Spans to come may overlap.
    pub(super) fn begin_together(&mut self) {
        if P::Depth::TESTS {
            self.clear();
            *self.dirty = true;
        }
    }

    /// The pixels of an object on this line, if there are any.
    #[inline(always)]
    pub(super) fn span(&self, body: &DrawableOf<P>) -> Option<(usize, usize)> {
        if body.is_inside() {
            let (start, end) = body.inside(self.line);
            return (start < end).then_some((start as usize, end as usize));
        }
        self.clipped(body)
    }

    #[cold]
    #[inline(never)]
    fn clipped(&self, body: &DrawableOf<P>) -> Option<(usize, usize)> {
        let columns = body.columns(self.line, self.left);
        Span::clipped(self.line, columns, self.left, self.pixels.len()).map(|s| (s.start, s.end))
    }

    /// Draws all objects without depth, if no two of their spans overlap; if some do, what was
    /// drawn has to be drawn over.
    #[inline]
    fn draw_apart(&mut self, list: &ActiveList<'_, DrawableOf<P>>) -> bool {
        self.clear();
        let (reads, counter) = (self.brush.reads, *self.brush.counter);
        let apart = match self.mark(list) {
            Some((first, count)) => self.draw_marked(list.slots(), first, count),
            None => false,
        };
        if !apart {
            *self.dirty = true;
            (self.brush.reads, *self.brush.counter) = (reads, counter);
        }
        apart
    }

    /// Marks all spans: the first pixel of any, and how many there are. `None` when two begin at
    /// the same pixel.
    ///
    /// The hot loop of pass two: about 35 instructions an object on a Cortex-M4.
    #[inline(never)]
    fn mark(&mut self, list: &ActiveList<'_, DrawableOf<P>>) -> Option<(usize, u32)> {
        let (mut first, mut count) = (usize::MAX, 0);
        for (index, slot) in list.members() {
            let Some((start, end)) = self.span(slot.body()) else {
                continue;
            };
            let cell = self.cells.get_mut(start)?;
            if cell.number() != 0 {
                return None;
            }
            cell.set_number((index as u32) << 16 | end as u32);
            first = first.min(start);
            count += 1;
        }
        Some((first, count))
    }

    /// Draws what is marked, without depth; whether that was all.
    #[inline(never)]
    fn draw_marked(&mut self, slots: &[Slot<DrawableOf<P>>], first: usize, mut count: u32) -> bool {
        let (line, left) = (self.line, self.left);
        let cells = &mut *self.cells;
        let pixels = &mut *self.pixels;
        let mut start = first;
        while count > 0 {
            let Some(cell) = cells.get_mut(start) else {
                return false;
            };
            let mark = cell.number();
            cell.set_number(0);
            if mark == 0 {
                start += 1;
                continue;
            }
            count -= 1;
            let end = usize::from(mark as u16);
            let (Some(slot), Some(pixels)) =
                (slots.get((mark >> 16) as usize), pixels.get_mut(start..end))
            else {
                return false;
            };
            let at = (left + start as i32, line);
            self.brush
                .draw(slot.object(), slot.body(), at, pixels, None);
            start = end;
        }
        true
    }
}
