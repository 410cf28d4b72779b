//! From line to line: triangles begin, turn and end (K1, C1-C5).

use super::renderer::{Active, Renderer, View};
use crate::active::next;
use crate::link::Link;
use crate::look::{Fill, Look};
use crate::scene::{NONE, Scene};
use crate::span::Kind;

impl<L: Look, const WORDS: usize> Renderer<'_, L, WORDS> {
    /// Brings the cache to a line of the picture.
    #[inline(always)]
    pub(super) fn advance(&mut self, scene: &Scene<'_, '_, L>, view: &View<'_>, line: u16) {
        let first = scene.lines().start;
        let from = match self.place {
            Some((generation, next)) if generation == scene.generation && next <= line + 1 => next,
            _ => {
                self.cache.clear();
                self.met = false;
                first
            }
        };
        for now in from..=line {
            self.change(view, now);
            let bin = usize::from(now - first);
            let head = scene.bins.get(bin).copied().unwrap_or(NONE);
            if head != NONE || self.cache.spilled.is_some() {
                self.begin(view, head, line);
            }
        }
        self.place = Some((scene.generation, line + 1));
    }

    /// What turns or ends on a line.
    #[inline(always)]
    fn change(&mut self, view: &View<'_>, line: u16) {
        let mut at = self.cache.events(line);
        while let Some(after) = self.cache.after(at) {
            self.change_slot(view, usize::from(at), line);
            at = after;
        }
    }

    #[inline(always)]
    fn change_slot(&mut self, view: &View<'_>, number: usize, line: u16) {
        let Some(slot) = self.cache.slot(number) else {
            return;
        };
        if slot.event != line {
            let event = slot.event;
            self.cache.await_event(number, event);
            return;
        }
        let Some(triangle) = view.triangle(slot.object) else {
            return;
        };
        let end = triangle.lines().end;
        if end <= i32::from(line) {
            self.cache.free_slot(number);
        } else {
            slot.item.sides.turn(&triangle);
            self.cache.await_event(number, end as u16);
        }
    }

    /// What begins, after what found no slot before; what ends before `line` is passed over.
    #[inline(never)]
    fn begin(&mut self, view: &View<'_>, head: u16, line: u16) {
        while self.cache.spilled.is_some() {
            let Some(slot) = self.cache.free() else {
                break;
            };
            let object = self.cache.spilled.object();
            self.cache.spilled = next(self.links, self.cache.spilled);
            self.counts.moved_in += 1;
            self.take_in(view, slot, object, line);
        }
        let mut at = head;
        while let Some(object) = view.objects.get(usize::from(at)) {
            match self.cache.free() {
                Some(slot) => {
                    self.counts.hits += 1;
                    self.take_in(view, slot, at, line);
                }
                None => {
                    self.counts.spilled += 1;
                    self.cache.spill(at, self.links);
                }
            }
            at = object.next;
        }
        self.counts.peak = self.counts.peak.max(self.cache.in_use());
    }

    /// An object into a slot; its link leads there from now on (C3).
    #[inline(always)]
    fn take_in(&mut self, view: &View<'_>, slot: usize, object: u16, line: u16) {
        let Some(triangle) = view.triangle(object) else {
            return;
        };
        let lines = triangle.lines();
        if lines.end <= i32::from(line) {
            return;
        }
        let draw = view.draw_of(object);
        let Some(kept) = self.cache.slot(slot) else {
            return;
        };
        kept.object = object;
        kept.draw = draw;
        let item: &mut Active<L::Planes> = &mut kept.item;
        let area = triangle.area();
        let fill = L::set_up(
            &triangle,
            triangle.size(area),
            area,
            view.draw(draw),
            &mut item.planes,
        );
        item.fill = fill;
        item.sides = triangle.sides(i32::from(line), lines.turn);
        let sides = &item.sides;
        let plain = fill == Fill::Plain && !sides.crosses && sides.kind != Kind::Divided;
        let turns = lines.turn > i32::from(line);
        let event = if turns { lines.turn } else { lines.end };
        self.cache.keep(slot, plain, event as u16);
        self.counts.set_ups += 1;
        if let Some(link) = self.links.get_mut(usize::from(object)) {
            *link = Link::cached(slot);
        }
    }
}
