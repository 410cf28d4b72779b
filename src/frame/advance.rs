//! From line to line: triangles begin, turn and end (K1, C1-C5).

use super::renderer::{Renderer, View};
use super::slot::Flags;
use crate::active::{Change, next};
use crate::link::Link;
use crate::look::{Look, Primitive};
use crate::num::{bit, take_first};
use crate::scene::{NONE, Object};
use crate::span::{Way, end_line};

impl<L: Look, const WORDS: usize> Renderer<'_, L, WORDS> {
    /// Brings the cache to a line of the picture.
    #[inline(always)]
    pub(super) fn advance(&mut self, view: &View<'_>, line: u16) {
        if self.content != Some(view.content) || self.next > line + 1 {
            self.start_anew(view);
        }
        self.changed = false;
        while self.next <= line {
            let now = self.next;
            self.next = now + 1;
            if self.cache.enter_line(now) {
                self.change(view);
            }
            let bin = usize::from(now.wrapping_sub(view.first));
            let head = view.bins.get(bin).copied().unwrap_or(NONE);
            if head != NONE || self.cache.spilled.is_some() {
                self.begin(view, head, line);
            }
        }
    }

    /// Forgets all lines, to begin at the first.
    #[inline(never)]
    pub(super) fn start_anew(&mut self, view: &View<'_>) {
        if let Some(fetcher) = &self.fetcher {
            (fetcher.forget)(self);
        }
        self.cache.clear();
        self.met = false;
        self.content = Some(view.content);
        self.next = view.first;
    }

    /// What turns or ends on a line.
    #[inline(never)]
    fn change(&mut self, view: &View<'_>) {
        if self.cache.begins_block() {
            self.ask_changes(view);
        }
        for word in 0..WORDS {
            let changes = self.cache.take_changes(word);
            self.changed |= changes.ended != 0;
            if changes.turning != 0 {
                self.turn_all(view, word, changes.turning);
            }
        }
    }

    /// What changes in a block of lines that begins, line by line.
    #[inline(never)]
    fn ask_changes(&mut self, view: &View<'_>) {
        for word in 0..WORDS {
            let waiting = self.cache.take_block(word);
            for (mut slots, turns) in waiting.into_iter().zip([true, false]) {
                while let Some(i) = take_first(&mut slots) {
                    self.ask_change(view, word, i, turns);
                }
            }
        }
    }

    /// Slots of a word of which a side turns.
    #[inline(never)]
    pub(super) fn turn_all(&mut self, view: &View<'_>, word: usize, mut turning: u32) {
        while let Some(i) = take_first(&mut turning) {
            self.turn(view, word, i);
        }
    }

    /// A side of a slot gives way to the third one.
    #[inline(always)]
    fn turn(&mut self, view: &View<'_>, word: usize, i: u32) {
        let slot = &mut self.cache.slots[word][i as usize & 31];
        let Some(object) = view.objects.get(usize::from(slot.object)) else {
            return;
        };
        let way = Flags::of(slot).way();
        let end = if way == Way::PLAIN {
            let [_, b, c] = object.corner;
            let at = |i: u16| view.vertices.get(usize::from(i)).map(|v| v.place);
            let (Some(b), Some(c)) = (at(b), at(c)) else {
                return;
            };
            end_line(slot.item.sides.turn_plain([b, c]))
        } else {
            let Some(triangle) = view.triangle(object) else {
                return;
            };
            slot.item.sides.turn(&triangle, way);
            triangle.lines().end as u16
        };
        let turns = false;
        self.cache
            .await_change(word, bit(i), Change { line: end, turns });
    }

    /// A slot whose side turns, or that ends, far down: asks its triangle for the line.
    #[inline(never)]
    pub(super) fn ask_change(&mut self, view: &View<'_>, word: usize, i: u32, turns: bool) {
        let slot = &self.cache.slots[word][i as usize & 31];
        if let Some(triangle) = view.triangle_of(slot.object) {
            let lines = triangle.lines();
            let line = if turns { lines.turn } else { lines.end } as u16;
            self.cache
                .await_change(word, bit(i), Change { line, turns });
        }
    }

    /// What begins, after what found no slot before; what ends before `line` is passed over.
    #[inline(never)]
    fn begin(&mut self, view: &View<'_>, mut head: u16, line: u16) {
        self.changed = true;
        if let Some(fetcher) = &self.fetcher {
            head = (fetcher.arrive)(self, head);
        }
        let mut made = 0;
        while self.cache.spilled.is_some() {
            let Some(slot) = self.cache.free() else {
                break;
            };
            let number = self.cache.spilled.object();
            let after = next(self.links, self.cache.spilled);
            self.cache.take_spilled(Link::NONE, after, self.links);
            self.counts.moved_in += 1;
            if let Some(object) = view.objects.get(usize::from(number)) {
                made += self.take_in(view, slot, number, object, line);
            }
        }
        let (mut at, mut hits) = (head, 0);
        while let Some(object) = view.objects.get(usize::from(at)) {
            if let Some(slot) = self.cache.free() {
                hits += 1;
                made += self.take_in(view, slot, at, object, line);
            } else {
                self.counts.spilled += 1;
                self.cache.spill(at, self.links);
            }
            at = object.next;
        }
        self.counts.hits += hits;
        self.count_set_ups(made);
        self.counts.peak = self.counts.peak.max(self.cache.in_use());
    }

    /// Counts set-ups as [`take_in`](Renderer::take_in) tells them.
    #[inline(always)]
    pub(super) fn count_set_ups(&mut self, made: u32) {
        self.counts.set_ups += made & 0xFFFF;
        self.counts.turning += made >> 16;
    }

    /// An object into a slot; its link leads there from now on (C3). 1 if there is something of it to be drawn, and 1
    /// in the upper half if a side turns farther down.
    #[inline(never)]
    pub(super) fn take_in(
        &mut self,
        view: &View<'_>,
        slot: usize,
        number: u16,
        object: &Object,
        line: u16,
    ) -> u32 {
        let (Some(kept), Some(triangle)) = (self.cache.slot(slot), view.triangle(object)) else {
            return 0;
        };
        let entry = triangle.enter(line, &mut kept.item.sides);
        if entry.change() == 0 {
            return 0;
        }
        let planes = &mut kept.item.planes;
        let of = Primitive {
            triangle: &triangle,
            object: number,
            size: entry.size(),
            area: entry.area,
            draws: &view.draws,
        };
        let fill = L::set_up(&of, planes);
        let flags = Flags::new(fill, entry.way());
        kept.object = number;
        kept.known = flags.0.into();
        let change = Change {
            line: entry.change(),
            turns: entry.turns(),
        };
        self.cache.keep(slot, flags.is_plain(), change);
        if let Some(link) = self.links.get_mut(usize::from(number)) {
            *link = Link::cached(slot);
        }
        1 | u32::from(entry.turns()) << 16
    }
}
