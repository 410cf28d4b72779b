//! One line: who is seen, and its pixels (K4, K8, X3).
//!
//! Where the last line had no overlap, spans are coloured as they are found, and inserted into a coverage
//! mask. Where two meet, all spans are found first; those that meet nobody are coloured, the others are sorted
//! by submission, and only they have their depth compared: where nobody has written before it is written alone.
//! Without depth they are drawn in that order. The background goes where the mask has nothing.

use super::renderer::{Active, LineError, Renderer, View};
use crate::active::next;
use crate::link::Link;
use crate::look::{Depths, End, Fill, Look, Place, ThinSpan, WordOf, write_depth};
use crate::num::take_first;
use crate::scene::{DrawState, Scene};
use crate::span::{Frame, Triangle};
use crate::visible::{Mask, Part};

/// What a line is drawn into, and how far.
struct Line<'a, W> {
    number: u32,
    pixels: &'a mut [W],
    /// Columns where two spans meet.
    over: Mask,
    /// Columns whose depth is written.
    written: Mask,
}

/// A span of a triangle on a line.
#[derive(Clone, Copy)]
struct Span {
    start: u32,
    end: u32,
}

impl<L: Look, const WORDS: usize> Renderer<'_, L, WORDS> {
    /// Draws a line of the picture over a background; `false` where nothing is active on it. Every pixel is
    /// written.
    ///
    /// # Errors
    /// When the memory does not suffice for the scene, or the line is not of the scene.
    pub fn draw_line(
        &mut self,
        scene: &Scene<'_, '_, L>,
        line: u16,
        pixels: &mut [WordOf<L>],
        background: WordOf<L>,
    ) -> Result<bool, LineError> {
        self.check(scene)?;
        let (needed, have) = (usize::from(scene.screen().width()), pixels.len());
        if have != needed {
            return Err(LineError::Pixels { needed, have });
        }
        if !scene.lines().contains(&line) {
            return Err(LineError::Line { line });
        }
        let view = View::of(scene);
        self.advance(scene, &view, line);
        if self.cache.is_empty() {
            <L::Pixel as crate::composite::PixelFormat>::fill(pixels, background);
            return Ok(false);
        }
        let mut out = Line {
            number: u32::from(line),
            pixels,
            over: Mask::EMPTY,
            written: Mask::EMPTY,
        };
        self.covered = Mask::EMPTY;
        let calm = !self.met && !self.cache.spilled.is_some();
        if !(calm && self.draw_calm(&view, &mut out)) {
            self.covered = Mask::EMPTY;
            self.met = self.find_spans(&view, &mut out);
            self.draw_found(&view, &mut out);
        }
        let width = u32::from(scene.screen().width());
        self.covered.take_free(0, width, |from, to| {
            if let Some(run) = out.pixels.get_mut(from as usize..to as usize) {
                <L::Pixel as crate::composite::PixelFormat>::fill(run, background);
            }
        });
        Ok(true)
    }

    /// Colours spans as they are found; `false` as soon as two meet.
    #[inline(never)]
    fn draw_calm(&mut self, view: &View<'_>, out: &mut Line<'_, WordOf<L>>) -> bool {
        for word in 0..WORDS {
            if !self.draw_plain(view, out, word) {
                return false;
            }
            let mut others = self.cache.used[word] & !self.cache.plain[word];
            while others != 0 {
                let slot = &self.cache.slots[word][take_first(&mut others) as usize & 31];
                let (start, end) = slot.item.sides.columns(out.number, view.frame);
                if start >= end {
                    continue;
                }
                if self.covered.cover(start, end) {
                    return false;
                }
                let (span, draw) = (Span { start, end }, view.draw(slot.draw));
                let triangle = slot.item.thin(view, slot.object);
                colour::<L>(&slot.item, triangle.as_ref(), span, draw, out);
            }
        }
        true
    }

    /// The commonest spans of a word of slots.
    #[inline(never)]
    fn draw_plain(&mut self, view: &View<'_>, out: &mut Line<'_, WordOf<L>>, word: usize) -> bool {
        let slots = &self.cache.slots[word];
        let mut plain = self.cache.plain[word];
        let line = out.number;
        while plain != 0 {
            let slot = &slots[take_first(&mut plain) as usize & 31];
            let sides = &slot.item.sides;
            let (start, end) = (sides.left.column(line), sides.right.column(line));
            if start >= end {
                continue;
            }
            if self.covered.cover(start, end) {
                return false;
            }
            let Some(run) = out.pixels.get_mut(start as usize..end as usize) else {
                return false;
            };
            let at = Place {
                column: start,
                line,
            };
            L::fill_plain(&slot.item.planes, at, view.draw(slot.draw), run);
        }
        true
    }

    /// The columns of all spans; whether two meet.
    #[inline(never)]
    fn find_spans(&mut self, view: &View<'_>, out: &mut Line<'_, WordOf<L>>) -> bool {
        let mut met = false;
        for word in 0..WORDS {
            let (slots, spans) = (&self.cache.slots[word], &mut self.cache.spans[word]);
            let mut used = self.cache.used[word];
            while used != 0 {
                let i = take_first(&mut used) as usize & 31;
                let (start, end) = slots[i].item.sides.columns(out.number, view.frame);
                spans[i] = start << 16 | end;
                if start < end {
                    met |= self.covered.cover_over(&mut out.over, start, end);
                }
            }
        }
        if self.cache.spilled.is_some() {
            met |= self.find_spilled(view, out);
        }
        met
    }

    /// The columns of what has no slot; what has ended leaves the chain.
    #[inline(never)]
    fn find_spilled(&mut self, view: &View<'_>, out: &mut Line<'_, WordOf<L>>) -> bool {
        let mut met = false;
        let (mut before, mut at) = (Link::NONE, self.cache.spilled);
        while let Some(triangle) = at.is_some().then(|| view.triangle(at.object())).flatten() {
            let after = next(self.links, at);
            let lines = triangle.lines();
            if lines.end <= out.number as i32 {
                self.cache.relink(before, after, self.links);
            } else {
                let sides = triangle.sides(out.number as i32, lines.turn);
                let (start, end) = sides.columns(out.number, view.frame);
                if start < end {
                    met |= self.covered.cover_over(&mut out.over, start, end);
                }
                self.counts.misses += 1;
                before = at;
            }
            at = after;
        }
        met
    }

    /// Draws what [`find_spans`](Renderer::find_spans) has found: what meets nobody at once, the rest in
    /// order of submission.
    #[inline(never)]
    fn draw_found(&mut self, view: &View<'_>, out: &mut Line<'_, WordOf<L>>) {
        let mut meeting = 0;
        for word in 0..WORDS {
            let mut used = self.cache.used[word];
            while used != 0 {
                let i = take_first(&mut used) as usize & 31;
                let (slot, span) = (
                    &self.cache.slots[word][i],
                    Span::of(self.cache.spans[word][i]),
                );
                if span.start >= span.end {
                    continue;
                }
                if out.over.meets(span.start, span.end) {
                    let key = u32::from(slot.object) << 16 | (word * 32 + i) as u32;
                    insert(self.cache.order.as_flattened_mut(), meeting, key);
                    meeting += 1;
                    continue;
                }
                let triangle = slot.item.thin(view, slot.object);
                colour::<L>(
                    &slot.item,
                    triangle.as_ref(),
                    span,
                    view.draw(slot.draw),
                    out,
                );
            }
        }
        let mut slow = self.cache.spilled;
        for k in 0..meeting {
            let key = self.cache.order.as_flattened().get(k).copied();
            let key = key.unwrap_or_default();
            // One comparison says whether what has no slot comes first (C3).
            while slow.is_some() && u32::from(slow.object()) < key >> 16 {
                slow = self.draw_spilled(view, slow, out);
            }
            self.draw_meeting(view, key as usize & 0xFFFF, out);
        }
        while slow.is_some() {
            slow = self.draw_spilled(view, slow, out);
        }
    }

    /// A span in a slot that meets others.
    #[inline(never)]
    fn draw_meeting(&mut self, view: &View<'_>, number: usize, out: &mut Line<'_, WordOf<L>>) {
        let (word, i) = (number >> 5, number & 31);
        let (Some(slots), Some(spans)) =
            (self.cache.slots.get_mut(word), self.cache.spans.get(word))
        else {
            return;
        };
        let (slot, span) = (&mut slots[i], Span::of(spans[i]));
        let draw = view.draw(slot.draw);
        if self.depth.is_empty() {
            let triangle = slot.item.thin(view, slot.object);
            return colour::<L>(&slot.item, triangle.as_ref(), span, draw, out);
        }
        let one = crate::num::bit(i as u32);
        if let Some(deep) = self.cache.deep.get_mut(word)
            && *deep & one == 0
        {
            *deep |= one;
            slot.item.depth = view.triangle(slot.object).and_then(|t| depth_plane(&t));
        }
        let triangle = if slot.item.depth.is_none() || slot.item.fill == Fill::Thin {
            view.triangle(slot.object)
        } else {
            None
        };
        nearer::<L>(&slot.item, triangle.as_ref(), span, draw, self.depth, out);
    }

    /// A span of what has no slot, set up for this line alone; the next of its kind.
    #[inline(never)]
    fn draw_spilled(&mut self, view: &View<'_>, at: Link, out: &mut Line<'_, WordOf<L>>) -> Link {
        let after = next(self.links, at);
        let object = at.object();
        let Some(triangle) = view.triangle(object) else {
            return Link::NONE;
        };
        let lines = triangle.lines();
        let sides = triangle.sides(out.number as i32, lines.turn);
        let (start, end) = sides.columns(out.number, view.frame);
        if start >= end {
            return after;
        }
        let (span, draw) = (Span { start, end }, view.draw(view.draw_of(object)));
        let mut planes = L::EMPTY;
        let area = triangle.area();
        let fill = L::set_up(&triangle, triangle.size(area), area, draw, &mut planes);
        self.counts.set_ups += 1;
        let mut item = Active {
            sides,
            fill,
            planes,
            depth: None,
        };
        if self.depth.is_empty() || !out.over.meets(start, end) {
            colour::<L>(&item, Some(&triangle), span, draw, out);
        } else {
            item.depth = depth_plane(&triangle);
            nearer::<L>(&item, Some(&triangle), span, draw, self.depth, out);
        }
        after
    }
}

impl Span {
    #[inline(always)]
    fn of(word: u32) -> Self {
        Self {
            start: word >> 16,
            end: word & 0xFFFF,
        }
    }
}

impl<P> Active<P> {
    /// The corners, where pixels cannot be coloured without them.
    #[inline(always)]
    fn thin<'a>(&self, view: &View<'a>, object: u16) -> Option<Triangle<'a>> {
        if self.fill == Fill::Thin {
            view.triangle(object)
        } else {
            None
        }
    }
}

impl<'a> View<'a> {
    #[inline(always)]
    pub(super) fn of<L>(scene: &'a Scene<'_, '_, L>) -> Self {
        let screen = scene.screen();
        Self {
            vertices: scene.vertices.as_slice(),
            places: scene.places,
            objects: scene.objects.as_slice(),
            draws: scene.draws.as_slice(),
            frame: Frame {
                left: screen.left(),
                top: screen.top(),
                width: i32::from(screen.width()),
            },
        }
    }
}

/// Inserts a key among the first `count`, which rise.
#[inline(always)]
fn insert(keys: &mut [u32], count: usize, key: u32) {
    if let Some(run) = keys.get_mut(..=count) {
        let mut after = run.iter_mut().rev();
        if let Some(mut to) = after.next() {
            for from in after {
                if *from < key {
                    break;
                }
                *to = *from;
                to = from;
            }
            *to = key;
        }
    }
}

/// The plane of 1/w, from the picture's first pixel on; `None` where the triangle is too thin for one.
///
/// What planes may err is kept from 0, the farthest.
#[inline(never)]
fn depth_plane(triangle: &Triangle<'_>) -> Option<[u32; 3]> {
    /// More than a plane may err.
    const MARGIN: u32 = 1 << 14;
    let depth = triangle.vertex.map(|v| v.depth);
    let area = triangle.area();
    let plane = if triangle.size(area) == crate::span::Size::Tiny {
        let rise = |i: usize| depth[i].wrapping_sub(depth[0]) as i32;
        let steep = triangle.shares(area).steep(rise(1), rise(2));
        steep.map(|[at, dx, dy]| [at.wrapping_add(depth[0]), dx, dy])
    } else {
        None
    };
    let plane = match plane {
        Some(plane) => plane,
        None => {
            let values = depth.map(|d| d.min(i32::MAX as u32) as i32);
            triangle.in_picture(triangle.wide_area()?.plane(values)?)
        }
    };
    let [at, dx, dy] = plane;
    Some([at.wrapping_add(MARGIN), dx, dy])
}

/// Where the ends of a line lie on a triangle's sides.
#[inline(never)]
fn thin_span<'a>(triangle: &'a Triangle<'a>, span: Span, line: u32) -> ThinSpan<'a> {
    let y = (8 * (line as i32 + triangle.frame.top) + 4) as i64;
    let [b, c] = [1, 2].map(|i| crate::span::first_line(triangle.place(i)) - triangle.frame.top);
    let end = |from: usize, to: usize| {
        let [top, bottom] = [from, to].map(|i| i64::from(triangle.place(i) >> 16));
        let way = ((y - top) << 16) / (bottom - top).max(1);
        End {
            from,
            to,
            way: way.clamp(0, 1 << 16) as u32,
        }
    };
    let line = line as i32;
    ThinSpan {
        triangle,
        ends: [
            if line < c { end(0, 2) } else { end(2, 1) },
            if line < b { end(0, 1) } else { end(1, 2) },
        ],
        start: span.start,
        pixels: span.end - span.start,
    }
}

/// Colours a span; the triangle has to be there where it is thin.
#[inline(always)]
fn colour<L: Look>(
    item: &Active<L::Planes>,
    triangle: Option<&Triangle<'_>>,
    span: Span,
    draw: &DrawState<'_>,
    out: &mut Line<'_, WordOf<L>>,
) {
    let Some(run) = out.pixels.get_mut(span.start as usize..span.end as usize) else {
        return;
    };
    let at = Place {
        column: span.start,
        line: out.number,
    };
    match (item.fill, triangle) {
        (Fill::Thin, Some(triangle)) => {
            let mut planes = L::EMPTY;
            L::set_up_thin(&thin_span(triangle, span, out.number), draw, &mut planes);
            L::fill(Fill::Wide, &planes, at, draw, run);
        }
        (fill, _) => L::fill(fill, &item.planes, at, draw, run),
    }
}

/// Colours those pixels of a span that are at least as near as what is there; the triangle has to be there where
/// it has no plane of depth or is thin.
#[inline(never)]
fn nearer<L: Look>(
    item: &Active<L::Planes>,
    triangle: Option<&Triangle<'_>>,
    span: Span,
    draw: &DrawState<'_>,
    cells: &mut [u32],
    out: &mut Line<'_, WordOf<L>>,
) {
    let at = Place {
        column: span.start,
        line: out.number,
    };
    let plane = item.depth.or_else(|| {
        let [at, dx] =
            thin_span(triangle?, span, out.number).line(triangle?.vertex.map(|v| v.depth));
        Some([at, dx, 0])
    });
    let [first, dx, dy] = plane.unwrap_or_default();
    let first = first
        .wrapping_add(dx.wrapping_mul(at.column))
        .wrapping_add(dy.wrapping_mul(at.line));
    let part = out.written.cover_part(span.start, span.end, |column| {
        if let Some(cell) = cells.get_mut(column) {
            *cell = 0;
        }
    });
    let columns = span.start as usize..span.end as usize;
    let Some(cells) = cells.get_mut(columns.clone()) else {
        return;
    };
    let mut depth = Depths {
        cells,
        at: first,
        step: dx,
    };
    if part == Part::None {
        write_depth(&mut depth);
        return colour::<L>(item, triangle, span, draw, out);
    }
    let Some(run) = out.pixels.get_mut(columns) else {
        return;
    };
    match (item.fill, triangle) {
        (Fill::Thin, Some(triangle)) => {
            let mut planes = L::EMPTY;
            L::set_up_thin(&thin_span(triangle, span, out.number), draw, &mut planes);
            L::fill_nearer(Fill::Wide, &planes, at, draw, run, depth);
        }
        (fill, _) => L::fill_nearer(fill, &item.planes, at, draw, run, depth),
    }
}
