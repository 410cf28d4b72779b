//! Lines with surfaces that have a finish: what is transparent is blended over what is opaque
//! (K11, H8, H9, P5).
//!
//! Such a line is drawn in parts, each a walk of the list: first what is opaque, with depth; last what is
//! transparent, tested but not kept in depth. Where spans overlap that do not just add, the line is
//! cut into stretches on which the same spans overlap, and each is drawn from back to front: that
//! is exact for surfaces that do not cross on the stretch. No memory is lent for it: so many spans
//! as fit on the stack are taken at a time, from the left, up to where the next one begins. Where
//! more than these lie one over the other, a stretch is drawn by itself, the farthest first.
//!
//! A line without such surfaces goes the usual way. Colours are found as always, into words on the
//! stack, so every shading and texture can be blended.

mod blend;

use blend::There;

use super::lines::LinePass;
use super::pile::{By, PILE, Pane, Pile};
use super::scene::Scene;
use super::spans::scale;
use crate::active::{ActiveList, Visitor};
use crate::geometry::{Finish, Parameters, Role, Shading, at_pixel};
use crate::pipeline::{DrawableOf, LevelsOf, Pipeline};
use crate::shade::Levels;
use crate::stats::SpanCounter;
use crate::visible::{DepthRamp, LineDepth, MOST};

/// When an object is drawn.
#[inline]
pub(super) fn role<P: Pipeline>(scene: &Scene<'_, P>, object: u16, body: &DrawableOf<P>) -> Role {
    match &body.parameters {
        Parameters::Planes(_, levels) => levels.finish().map_or(Role::Plain, |f| f.role),
        Parameters::Corners => scene
            .object(object)
            .and_then(|o| P::Shading::finish(&o.face))
            .map_or(Role::Plain, Finish::role),
    }
}

/// Whether lines with this object are not drawn in the usual way.
#[inline]
pub(super) fn is_special<P: Pipeline>(
    scene: &Scene<'_, P>,
    object: u16,
    body: &DrawableOf<P>,
) -> bool {
    role(scene, object, body) != Role::Plain
}

/// A part of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    /// All there is, in order of submission: without depth.
    Painted,
    /// What is opaque; and what else there is.
    Opaque,
    /// What is transparent, in order of submission.
    Unsorted,
    /// Some of what is transparent.
    Pile,
}

/// What there is on a line beside plain objects.
#[derive(Clone, Copy, Debug, Default)]
struct Found {
    sorted: bool,
    unsorted: bool,
}

/// No slot.
const SPILLED: usize = usize::MAX;

/// A walk of the list for one part of a line.
struct Walk<'w, 'a, 's, P: Pipeline> {
    pass: &'w mut LinePass<'a, 's, P>,
    part: Part,
    found: Found,
    pile: Option<&'w mut Pile>,
}

impl<P: Pipeline> Visitor<DrawableOf<P>> for Walk<'_, '_, '_, P> {
    fn set_up(&mut self, object: u16, body: &mut DrawableOf<P>) -> bool {
        self.pass.set_up(object, body)
    }

    fn visit(&mut self, object: u16, body: &DrawableOf<P>) {
        self.visit_slot(SPILLED, object, body);
    }

    fn visit_slot(&mut self, slot: usize, object: u16, body: &DrawableOf<P>) {
        let role = role(self.pass.brush.scene, object, body);
        if role == Role::Plain {
            if matches!(self.part, Part::Opaque | Part::Painted) {
                self.pass.visit(object, body);
            }
            return;
        }
        let Some(span) = self.pass.span(body) else {
            return;
        };
        match (self.part, role) {
            (Part::Painted, Role::Opaque | Role::Sorted | Role::Unsorted)
            | (Part::Opaque, Role::Opaque)
            | (Part::Unsorted, Role::Unsorted) => self.pass.draw_ruled(object, body, span),
            (Part::Opaque, Role::Sorted) => self.found.sorted = true,
            (Part::Opaque, Role::Unsorted) => self.found.unsorted = true,
            (Part::Pile, Role::Sorted | Role::Unsorted) => {
                if let Some(pile) = &mut self.pile {
                    pile.add(self.pass.pane((slot, object), body, span));
                }
            }
            _ => {}
        }
    }
}

/// Sets slow objects up, so that those leave the list that end before the next line.
pub(super) struct Leave<'w, 'a, 's, P: Pipeline>(pub(super) &'w mut LinePass<'a, 's, P>);

impl<P: Pipeline> Visitor<DrawableOf<P>> for Leave<'_, '_, '_, P> {
    fn set_up(&mut self, object: u16, body: &mut DrawableOf<P>) -> bool {
        self.0.set_up(object, body)
    }

    fn visit(&mut self, _: u16, _: &DrawableOf<P>) {}
}

impl<P: Pipeline> LinePass<'_, '_, P> {
    /// Draws a line on which there may be surfaces that are not plain. `next` is the line that
    /// will come after, `spare` takes what has no slot.
    #[inline(never)]
    pub(super) fn draw_composited(
        &mut self,
        list: &mut ActiveList<'_, DrawableOf<P>>,
        next: i32,
        spare: &mut DrawableOf<P>,
    ) {
        self.begin_together();
        let first = match P::Depth::TESTS {
            true => Part::Opaque,
            false => Part::Painted,
        };
        let found = self.walk(list, spare, first);
        if found.sorted {
            self.draw_sorted(list, spare);
        } else if found.unsorted {
            self.walk(list, spare, Part::Unsorted);
        }
        if list.has_spilled() {
            list.visit_all(next, spare, &mut Leave(self));
        }
    }

    /// Goes through all that is active. Nothing leaves the list.
    fn walk(
        &mut self,
        list: &mut ActiveList<'_, DrawableOf<P>>,
        spare: &mut DrawableOf<P>,
        part: Part,
    ) -> Found {
        let line = self.line;
        let mut walk = Walk {
            pass: self,
            part,
            found: Found::default(),
            pile: None,
        };
        list.visit_all(line, spare, &mut walk);
        walk.found
    }

    /// Draws what is transparent from back to front.
    fn draw_sorted(&mut self, list: &mut ActiveList<'_, DrawableOf<P>>, spare: &mut DrawableOf<P>) {
        let mut pile = Pile::default();
        let mut pixel = 0;
        while pixel < u16::MAX {
            self.gather(list, spare, &mut pile, By::Start(pixel));
            let Some(first) = pile.panes[..pile.count].first() else {
                break;
            };
            let first = first.start.max(pixel);
            let limit = pile.limit();
            if first < limit {
                let mut order = [0; PILE];
                while let Some((start, end, count)) = pile.stretch(pixel, &mut order) {
                    for &index in &order[..count] {
                        let pane = pile.panes[usize::from(index)];
                        self.draw_pane(list, spare, pane, (start, end));
                    }
                    pixel = end;
                }
                pixel = limit;
            } else if first > pixel {
                pixel = first;
            } else {
                let end = pile.edge;
                self.draw_deep(list, spare, &mut pile, (pixel, end));
                pixel = end;
            }
        }
    }

    /// Fills a pile.
    fn gather(
        &mut self,
        list: &mut ActiveList<'_, DrawableOf<P>>,
        spare: &mut DrawableOf<P>,
        pile: &mut Pile,
        by: By,
    ) {
        pile.begin(by);
        let line = self.line;
        let mut walk = Walk {
            pass: self,
            part: Part::Pile,
            found: Found::default(),
            pile: Some(pile),
        };
        list.visit_all(line, spare, &mut walk);
    }

    /// Draws a stretch that more panes cover than a pile holds: the farthest first.
    #[cold]
    fn draw_deep(
        &mut self,
        list: &mut ActiveList<'_, DrawableOf<P>>,
        spare: &mut DrawableOf<P>,
        pile: &mut Pile,
        (start, end): (u16, u16),
    ) {
        let mut after = None;
        loop {
            self.gather(list, spare, pile, By::Depth(start, end, after));
            for i in 0..pile.count {
                self.draw_pane(list, spare, pile.panes[i], (start, end));
            }
            let last = pile.panes[..pile.count].last();
            after = last.and_then(|pane| pile.by.key(pane));
            if pile.left_out.is_none() || after.is_none() {
                return;
            }
        }
    }

    /// Draws a stretch of a pane.
    fn draw_pane(
        &mut self,
        list: &mut ActiveList<'_, DrawableOf<P>>,
        spare: &mut DrawableOf<P>,
        pane: Pane,
        (start, end): (u16, u16),
    ) {
        let span = (usize::from(start), usize::from(end));
        if let Some(slot) = list.slots().get(usize::from(pane.slot)) {
            self.draw_ruled(pane.object, slot.body(), span);
        } else if self
            .brush
            .scene
            .set_up(pane.object, (self.line, false), spare)
        {
            list.counts.misses += 1;
            self.draw_ruled(pane.object, spare, span);
        }
    }

    /// A transparent span, as it is sorted.
    fn pane(
        &mut self,
        (slot, object): (usize, u16),
        body: &DrawableOf<P>,
        (start, end): (usize, usize),
    ) -> Pane {
        let column = self.left + start as i32;
        let (depth, step) = match &body.parameters {
            Parameters::Planes(plane, _) => (plane.at(column, self.line) as u32, plane.dx as u32),
            Parameters::Corners => {
                let middle = self.left + ((start + end - 1) / 2) as i32;
                let depth = thin::<P>(self.brush.scene, object, (middle, self.line));
                (depth.map_or(0, |(depth, _)| depth), 0)
            }
        };
        Pane {
            start: start as u16,
            end: end as u16,
            object,
            slot: slot as u16,
            depth,
            step,
        }
    }

    /// Draws a span of an object by the rules of its finish.
    #[inline(never)]
    pub(super) fn draw_ruled(
        &mut self,
        object: u16,
        body: &DrawableOf<P>,
        (start, end): (usize, usize),
    ) {
        let (Some(pixels), Some(cells)) = (
            self.pixels.get_mut(start..end),
            self.cells.get_mut(start..end),
        ) else {
            return;
        };
        let (column, line) = (self.left + start as i32, self.line);
        let all = pixels.len() as u32;
        let mut seen = 0;
        let grain = P::Depth::grain(body.range().0);
        match &body.parameters {
            Parameters::Planes(plane, levels) => {
                let parts = pixels.chunks_mut(MOST).zip(cells.chunks_mut(MOST));
                for ((pixels, cells), column) in parts.zip((column..).step_by(MOST)) {
                    let there = There {
                        cells,
                        depth: DepthRamp::of(plane, column, line),
                        grain,
                    };
                    seen += self.brush.blend(levels, (column, line), pixels, there);
                }
            }
            Parameters::Corners => {
                self.brush.reads += 1;
                let parts = pixels.chunks_mut(1).zip(cells.chunks_mut(1));
                for ((pixels, cells), column) in parts.zip(column..) {
                    let at = (column, line);
                    if let Some((depth, levels)) = thin::<P>(self.brush.scene, object, at) {
                        let there = There {
                            cells,
                            depth: DepthRamp::single(depth),
                            grain,
                        };
                        seen += self.brush.blend(&levels, at, pixels, there);
                    }
                }
            }
        }
        let tested = P::Depth::TESTS;
        self.brush.counter.span(seen, all - seen, tested);
    }
}

/// Depth and levels of an object without planes at a pixel of guard space.
#[cold]
#[inline(never)]
fn thin<P: Pipeline>(
    scene: &Scene<'_, P>,
    object: u16,
    at: (i32, i32),
) -> Option<(u32, LevelsOf<P>)> {
    let object = scene.object(object)?;
    let corners = object.corners(scene.vertices())?;
    Some(at_pixel::<P::Shading>(
        corners,
        object.face,
        scale::<P>(),
        at,
    ))
}
