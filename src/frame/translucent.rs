//! Spans that what is behind shines through: from far to near, pixel by pixel, any number of them (K11, H9).
//!
//! They are drawn after all that is opaque, by stretches of at most 32 columns. The panes of a stretch are put into
//! one order if they have one on all of it, by their depths at both ends of what two have in common: depth is linear
//! along a line. Where they cross, or are more than a pile holds, the stretch is halved; a single column always has an
//! order, and there as many piles as it takes are drawn. Of equal depths the one submitted first is behind.
//!
//! No memory is lent for this: a pile lies on the stack.

use super::renderer::Renderer;
use super::rival::deepen;
use super::ruled::{Ruled, depth_on_line, draw_ruled};
use super::slot::Flags;
use super::spans::{Drawn, Known, Line, Span};
use crate::active::next;
use crate::look::{Look, WordOf};
use crate::num::take_first;
use crate::scene::DrawState;
use core::cmp::Ordering;

/// Columns of a stretch.
const STRETCH: u32 = 32;
/// Panes of a pile.
const PANES: usize = 16;
/// No slot.
const NO_SLOT: u16 = u16::MAX;

/// A span that waits to be drawn.
#[derive(Clone, Copy)]
struct Pane {
    span: Span,
    /// Depth at the picture's first column, and its step.
    depth: [u32; 2],
    object: u16,
    slot: u16,
}

/// Where a pane stands among those of a column: what is less is behind.
type Key = (u32, u16);

impl Pane {
    const NONE: Self = Self {
        span: Span { start: 0, end: 0 },
        depth: [0; 2],
        object: 0,
        slot: NO_SLOT,
    };

    fn key(&self, column: u32) -> Key {
        let [at, step] = self.depth;
        (at.wrapping_add(step.wrapping_mul(column)), self.object)
    }

    /// Whether this pane is behind another on all that they have in common of a stretch; `None` where they cross.
    /// Panes that have nothing in common have no order, which is equal.
    fn order(&self, other: &Self, stretch: Span) -> Option<Ordering> {
        let first = self.span.start.max(other.span.start).max(stretch.start);
        let end = self.span.end.min(other.span.end).min(stretch.end);
        if first >= end {
            return Some(Ordering::Equal);
        }
        let at = |column: u32| self.key(column).cmp(&other.key(column));
        let order = at(first);
        (order == at(end - 1)).then_some(order)
    }
}

/// Which panes a pile takes.
#[derive(Clone, Copy)]
enum Take {
    /// Those that have columns of a stretch.
    Stretch(Span),
    /// Those of a column that are in front of what has been drawn, from the farthest on.
    Column(u32, Option<Key>),
}

/// The panes of a stretch.
struct Pile {
    panes: [Pane; PANES],
    count: usize,
    /// Whether some found no place.
    is_short: bool,
}

impl Pile {
    const EMPTY: Self = Self {
        panes: [Pane::NONE; PANES],
        count: 0,
        is_short: false,
    };

    /// Takes a pane, if it is to be taken.
    fn add(&mut self, pane: Pane, take: Take) {
        let mut at = self.count;
        match take {
            Take::Stretch(stretch) => {
                if pane.span.end <= stretch.start || pane.span.start >= stretch.end {
                    return;
                }
            }
            Take::Column(column, after) => {
                let key = pane.key(column);
                let is_drawn = after.is_some_and(|after| key <= after);
                if column < pane.span.start || column >= pane.span.end || is_drawn {
                    return;
                }
                let before = |pane: &Pane| pane.key(column) < key;
                at = self.panes().partition_point(before);
            }
        }
        if self.count == PANES {
            self.is_short = true;
        } else {
            self.count += 1;
        }
        // What comes after moves up; of a full pile the last goes.
        let mut moved = pane;
        for place in self.panes.iter_mut().take(self.count).skip(at) {
            core::mem::swap(place, &mut moved);
        }
    }

    fn panes(&mut self) -> &mut [Pane] {
        self.panes.get_mut(..self.count).unwrap_or_default()
    }

    /// Brings the panes into order from far to near; `false` where they have none on all of a stretch.
    fn sort(&mut self, stretch: Span) -> bool {
        if self.is_short {
            return false;
        }
        let mut rest = self.panes();
        while !rest.is_empty() {
            // What nobody is behind comes first.
            let is_first = |pane: &Pane| {
                let mut orders = rest.iter().map(|other| pane.order(other, stretch));
                orders.all(|order| order.is_some_and(|order| order != Ordering::Greater))
            };
            let Some(first) = rest.iter().position(is_first) else {
                return false;
            };
            // Not `swap` of a slice, which allows for one pane twice and takes a function of 1.5 KB for it.
            let Some((head, others)) = core::mem::take(&mut rest).split_first_mut() else {
                return true;
            };
            if let Some(pane) = first.checked_sub(1).and_then(|i| others.get_mut(i)) {
                core::mem::swap(head, pane);
            }
            rest = others;
        }
        true
    }
}

impl<L: Look, const WORDS: usize> Renderer<'_, L, WORDS> {
    /// Draws all translucent spans of a line that is drawn by depth.
    #[inline(never)]
    pub(super) fn draw_translucent(&mut self, out: &mut Line<'_, '_, WordOf<L>>) {
        let count = self.list_translucent(out);
        let mut from = 0;
        while let Some(stretch) = self.next_stretch(count, from, out) {
            from = self.draw_stretch(count, stretch, out);
        }
    }

    /// Lists the slots of translucent spans, and finds their depth; how many there are.
    fn list_translucent(&mut self, out: &Line<'_, '_, WordOf<L>>) -> usize {
        let mut count = 0;
        for word in 0..WORDS {
            let mut others = self.cache.used[word] & !self.cache.plain[word];
            while others != 0 {
                let i = take_first(&mut others);
                let slot = &mut self.cache.slots[word][i as usize & 31];
                let span = Span::of(self.cache.spans[word][i as usize & 31]);
                if !Flags(slot.flags).has_values() || span.start >= span.end {
                    continue;
                }
                let state = out.view.state(slot.object);
                if state.is_some_and(DrawState::is_translucent) {
                    deepen::<L>(slot, out.view);
                    if let Some(place) = self.cache.order.as_flattened_mut().get_mut(count) {
                        *place = word as u32 * 32 + i;
                        count += 1;
                    }
                }
            }
        }
        count
    }

    /// Calls `f` with each pane of the line.
    #[inline(never)]
    fn each_pane(&mut self, count: usize, out: &Line<'_, '_, WordOf<L>>, f: &mut dyn FnMut(Pane)) {
        for k in 0..count {
            let number = self.cache.order.as_flattened().get(k).copied();
            let number = number.unwrap_or_default() as usize;
            let (Some(slots), Some(spans)) = (
                self.cache.slots.get(number >> 5),
                self.cache.spans.get(number >> 5),
            ) else {
                return;
            };
            let (slot, span) = (&slots[number & 31], Span::of(spans[number & 31]));
            f(Pane {
                span,
                depth: depth_on_line::<L>(Drawn::of(slot), slot.item.depth, span, out),
                object: slot.object,
                slot: number as u16,
            });
        }
        let mut at = self.cache.spilled;
        while at.is_some() {
            let object = at.object();
            let state = out.view.state(object);
            if state.is_some_and(DrawState::is_translucent) {
                if let Some(mut alone) = self.set_up_alone(object, out) {
                    let plane = Self::find_depth(&mut alone, out.view);
                    f(Pane {
                        span: alone.span,
                        depth: depth_on_line::<L>(alone.drawn(), plane, alone.span, out),
                        object,
                        slot: NO_SLOT,
                    });
                }
            }
            at = next(self.links, at);
        }
    }

    /// The next columns that panes have, from `from` on; `None` where there are none.
    fn next_stretch(
        &mut self,
        count: usize,
        from: u32,
        out: &Line<'_, '_, WordOf<L>>,
    ) -> Option<Span> {
        let (mut start, mut end) = (u32::MAX, 0);
        self.each_pane(count, out, &mut |pane| {
            if pane.span.end > from {
                start = start.min(pane.span.start.max(from));
                end = end.max(pane.span.end);
            }
        });
        let end = end.min(start.saturating_add(STRETCH));
        (start < end).then_some(Span { start, end })
    }

    /// Draws the panes of a stretch, or of what it has to be cut to; where that ends.
    fn draw_stretch(
        &mut self,
        count: usize,
        stretch: Span,
        out: &mut Line<'_, '_, WordOf<L>>,
    ) -> u32 {
        let Span { start, mut end } = stretch;
        while end - start > 1 {
            let part = Span { start, end };
            let mut pile = self.pile(count, Take::Stretch(part), out);
            if pile.sort(part) {
                for pane in pile.panes() {
                    self.draw_pane(*pane, part, out);
                }
                return end;
            }
            end -= (end - start) / 2;
        }
        let mut after = None;
        loop {
            let mut pile = self.pile(count, Take::Column(start, after), out);
            for pane in pile.panes() {
                self.draw_pane(*pane, Span { start, end }, out);
                after = Some(pane.key(start));
            }
            if !pile.is_short {
                return end;
            }
        }
    }

    fn pile(&mut self, count: usize, take: Take, out: &Line<'_, '_, WordOf<L>>) -> Pile {
        let mut pile = Pile::EMPTY;
        self.each_pane(count, out, &mut |pane| pile.add(pane, take));
        pile
    }

    /// Draws some columns of a pane.
    fn draw_pane(&mut self, pane: Pane, part: Span, out: &mut Line<'_, '_, WordOf<L>>) {
        let Some(state) = out.view.state(pane.object) else {
            return;
        };
        let span = pane.span;
        let number = usize::from(pane.slot);
        let mut alone;
        let (drawn, plane) = if let Some(slots) = self.cache.slots.get(number >> 5) {
            let slot = &slots[number & 31];
            (Drawn::of(slot), slot.item.depth)
        } else {
            let Some(found) = self.set_up_alone(pane.object, out) else {
                return;
            };
            alone = found;
            let plane = Self::find_depth(&mut alone, out.view);
            (alone.drawn(), plane)
        };
        let known = Known {
            plane,
            cells: self.depth,
            written: &mut self.written,
        };
        draw_ruled::<L>(Ruled { drawn, span, state }, part, out, Some(known));
    }
}
