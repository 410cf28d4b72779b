//! Spans that what is behind shines through: from far to near, pixel by pixel, any number of them (K11, H9).
//!
//! They are drawn after all that is opaque. The panes of a line are gathered into a pile, and drawn by stretches, which
//! are as long as few panes share them. Of each two of a stretch one is behind at the first column that they have in
//! common; where it no longer is, as depth is linear along a line, the stretch ends. Then one after the other is drawn of
//! which none that is behind it waits. Where there is none such, the stretch is halved; a single column always has an
//! order. Where a pile does not hold all, it takes those of fewer columns, and of a single column as many piles as it
//! takes are drawn. Of equal depths the one submitted first is behind.
//!
//! No memory is lent for this: a pile lies on the stack.

use super::alone::{Alone, set_up_stray};
use super::guests::Stray;
use super::renderer::Renderer;
use super::rival::{Key, Rival, Slope, deepen, rival_of};
use super::ruled::{Ruled, draw_ruled};
use super::spans::{Drawn, Known, Line, Span};
use crate::look::Look;
use crate::num::{bit, rolled, take_first};
use crate::scene::DrawState;

/// Columns of a stretch that many panes share.
const STRETCH: u32 = 32;
/// So many are few.
const FEW: u32 = 16;
/// Panes of a pile: a word has a bit for each.
const PANES: usize = 32;
/// No slot.
const NO_SLOT: u16 = u16::MAX;

/// A span that waits to be drawn.
#[derive(Clone, Copy)]
struct Pane {
    rival: Rival,
    slot: u16,
}

impl Pane {
    /// Where there is none: zeros, so that no constant is copied.
    const NONE: Self = Self {
        rival: Rival {
            span: Span::new(0, 0),
            slope: Slope { at: 0, step: 0 },
            object: 0,
        },
        slot: 0,
    };
}

/// Which panes a pile takes.
#[derive(Clone, Copy)]
enum Take {
    /// Those that have columns of a window.
    Window(Span),
    /// Those of a column that are in front of what has been drawn, from the farthest on.
    Column(u32, Option<Key>),
}

/// Panes of some columns.
struct Pile {
    panes: [Pane; PANES],
    count: usize,
    /// Whether some found no place.
    is_short: bool,
    /// Numbers of panes, those behind first.
    order: [u8; PANES],
}

impl Pile {
    const EMPTY: Self = Self {
        panes: [Pane::NONE; PANES],
        count: 0,
        is_short: false,
        order: [0; PANES],
    };

    /// Takes a pane, if it is to be taken.
    #[inline(never)]
    fn add(&mut self, pane: Pane, take: Take) {
        let mut at = self.count;
        match take {
            Take::Window(window) => {
                if !pane.rival.span.meets(window) {
                    return;
                }
            }
            Take::Column(column, after) => {
                let key = pane.rival.key(column);
                let is_drawn = after.is_some_and(|after| key <= after);
                let Span { start, end } = pane.rival.span;
                if column < start || column >= end || is_drawn {
                    return;
                }
                let panes = self.panes.get(..self.count).unwrap_or_default();
                at = panes.partition_point(|pane| pane.rival.key(column) < key);
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

    /// The next columns that panes have, from `from` on, and these panes as a set; `None` where there are none.
    #[inline(never)]
    fn next_stretch(&self, from: u32, until: u32) -> Option<(Span, u32)> {
        let (mut ahead, mut start) = (0, u32::MAX);
        for (number, pane) in (0..).zip(self.panes.iter().take(self.count)) {
            rolled();
            if pane.rival.span.end > from {
                ahead |= bit(number);
                start = start.min(pane.rival.span.start);
            }
        }
        let mut part = Span::new(start.max(from), until);
        while part.start < part.end {
            let (mut set, mut rest) = (ahead, ahead);
            while let Some(number) = take_first(&mut rest) {
                rolled();
                if self.panes[number as usize % PANES].rival.span.start >= part.end {
                    set &= !bit(number);
                }
            }
            let columns = part.end - part.start;
            if columns <= STRETCH || set.count_ones() <= FEW {
                return Some((part, set));
            }
            part.end = part.start + STRETCH.max(columns / 2);
        }
        None
    }

    /// The next columns that panes have, from `from` on, of which these are in order, and how many they are.
    fn next_part(&mut self, from: u32, until: u32) -> Option<(Span, usize)> {
        let (mut part, set) = self.next_stretch(from, until)?;
        while part.start < part.end {
            let end = part.end;
            if let Some(count) = self.sort(set, &mut part) {
                return Some((part, count));
            }
            // Where it ends sooner now, panes may have been told apart behind that.
            if part.end == end {
                part.end -= ((end - part.start) / 2).max(1);
            }
        }
        None
    }

    /// Brings those of a set into order from far to near, and ends a stretch before two of them cross; how many they
    /// are, or `None` where they have no order on all of it.
    #[inline(never)]
    fn sort(&mut self, set: u32, part: &mut Span) -> Option<usize> {
        let mut behind = [0; PANES];
        if set & set.wrapping_sub(1) != 0 {
            self.find_behind(set, part, &mut behind);
        }
        let (mut rest, mut tried, mut count) = (set, set, 0);
        while let Some(number) = take_first(&mut tried) {
            rolled();
            if behind[number as usize % PANES] & rest == 0 {
                rest &= !bit(number);
                tried = rest;
                *self.order.get_mut(count)? = number as u8;
                count += 1;
            }
        }
        (rest == 0).then_some(count)
    }

    /// Finds the panes of a set that are behind each, a bit for each, and ends a stretch before any two cross.
    fn find_behind(&self, set: u32, part: &mut Span, behind: &mut [u32; PANES]) {
        let mut rest = set;
        while let Some(i) = take_first(&mut rest) {
            let a = i as usize % PANES;
            let (rival, mut others) = (self.panes[a].rival, rest);
            while let Some(i) = take_first(&mut others) {
                let b = i as usize % PANES;
                let other = self.panes[b].rival;
                let Span { start, end } = rival.span.within(other.span).within(*part);
                if start >= end {
                    continue;
                }
                let is_before = rival.hides(other, start);
                if is_before != rival.hides(other, end - 1) {
                    part.end = rival.turned(other, is_before, Span { start, end });
                }
                if is_before {
                    behind[a] |= bit(b as u32);
                } else {
                    behind[b] |= bit(a as u32);
                }
            }
        }
    }
}

impl<L: Look, const WORDS: usize> Renderer<'_, L, WORDS> {
    /// Draws all translucent spans of a line that is drawn by depth.
    #[inline(never)]
    pub(super) fn draw_translucent(&mut self, out: &mut Line<'_, '_, L>) {
        let count = self.list_translucent(out);
        if let Some(counter) = &self.counter {
            (counter.panes)(self, count, out);
        }
        if count > 0 || self.cache.spilled.is_some() {
            self.draw_piles(count, out);
        }
    }

    /// Draws the panes of so many slots that are listed, and of what has no slot.
    #[inline(never)]
    fn draw_piles(&mut self, count: usize, out: &mut Line<'_, '_, L>) {
        let until = out.pixels.len() as u32;
        let mut pile = Pile::EMPTY;
        let mut window = Span::new(0, until);
        while window.start < window.end {
            self.gather_panes(&mut pile, count, Take::Window(window), out);
            if !pile.is_short {
                self.draw_pile(&mut pile, window, out);
            } else if window.end - window.start > 1 {
                window.end -= (window.end - window.start) / 2;
                continue;
            } else {
                self.draw_column(&mut pile, count, window, out);
            }
            window = Span::new(window.end, until);
        }
    }

    /// Lists the slots of translucent spans behind those in order, and finds their depth; how many there are.
    fn list_translucent(&mut self, out: &Line<'_, '_, L>) -> usize {
        let (mut count, first) = (0, usize::from(self.nearest));
        for word in 0..WORDS {
            let mut others = self.cache.used[word] & !self.cache.plain[word];
            while let Some(i) = self.next_with_values(word, &mut others) {
                let slot = &mut self.cache.slots[word][i as usize & 31];
                let state = out.view.state_of(slot);
                if state.is_some_and(DrawState::is_translucent) {
                    deepen::<L>(slot, out.view);
                    if let Some(place) = self.cache.order.as_flattened_mut().get_mut(first + count)
                    {
                        *place = word as u32 * 32 + i;
                        count += 1;
                    }
                }
            }
        }
        count
    }

    /// Fills a pile.
    #[inline(never)]
    fn gather_panes(&mut self, pile: &mut Pile, count: usize, take: Take, out: &Line<'_, '_, L>) {
        (pile.count, pile.is_short) = (0, false);
        for k in 0..count {
            let number = self.number_at(usize::from(self.nearest) + k);
            let Some((slot, span)) = self.cache.at(number) else {
                return;
            };
            let rival = rival_of::<L>(slot, Span::of(span), out);
            let slot = number as u16;
            pile.add(Pane { rival, slot }, take);
        }
        let mut at = self.first_spilled();
        while let Some(found) = self.spilled_of(at, out.view, &|state| state.is_translucent()) {
            if let Some(stray) = self.spilled_stray(found.at, out) {
                let rival = stray.rival(stray.slope::<L>(out));
                let slot = NO_SLOT;
                pile.add(Pane { rival, slot }, take);
            }
            at = self.after(found.at);
        }
    }

    /// Draws the panes of a window that a pile holds.
    fn draw_pile(&mut self, pile: &mut Pile, window: Span, out: &mut Line<'_, '_, L>) {
        let mut start = window.start;
        while let Some((part, count)) = pile.next_part(start, window.end) {
            for number in pile.order.iter().take(count) {
                let pane = &pile.panes[usize::from(*number) % PANES];
                if pane.rival.span.meets(part) {
                    self.draw_pane(pane, part, out);
                }
            }
            start = part.end;
        }
    }

    /// Draws the panes of a column that are more than a pile holds.
    fn draw_column(
        &mut self,
        pile: &mut Pile,
        count: usize,
        column: Span,
        out: &mut Line<'_, '_, L>,
    ) {
        let mut after = None;
        loop {
            self.gather_panes(pile, count, Take::Column(column.start, after), out);
            for pane in pile.panes.iter().take(pile.count) {
                self.draw_pane(pane, column, out);
                after = Some(pane.rival.key(column.start));
            }
            if !pile.is_short {
                return;
            }
        }
    }

    /// Draws some columns of a pane.
    #[inline(never)]
    fn draw_pane(&mut self, pane: &Pane, part: Span, out: &mut Line<'_, '_, L>) {
        let (span, object) = (pane.rival.span, pane.rival.object);
        let number = usize::from(pane.slot);
        let mut alone;
        let (drawn, state) = if let Some((slot, _)) = self.cache.at(number) {
            (Drawn::of(slot), out.view.state_of(slot))
        } else {
            let Some(stray) = Stray::of(object, out.view, out.number) else {
                return;
            };
            alone = Alone::empty(L::EMPTY);
            set_up_stray::<L>(&stray, &mut alone, &mut self.counts, out);
            (alone.drawn(), out.view.draws.state(object))
        };
        let Some(state) = state else {
            return;
        };
        let known = Known::new(pane.rival.slope, self.depth, &mut self.written);
        draw_ruled::<L>(Ruled { drawn, span, state }, part, out, Some(known));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::random::Rng;
    use std::vec::Vec;

    /// Kills: a stretch that does not end where two panes cross, and one that is given up, with all that is behind it,
    /// where panes were told apart behind its new end.
    #[test]
    fn each_column_has_all_its_panes_in_order() {
        let mut rng = Rng(21);
        let mut parts = 0;
        for round in 0..20_000 {
            let mut pile = Pile::EMPTY;
            for object in 0..[3, 6, 12][round % 3] {
                let start = rng.below(12);
                let span = Span {
                    start,
                    end: start + 1 + rng.below(12),
                };
                let slope = Slope {
                    at: (1 << 20) + rng.below(64),
                    step: rng.below(17).wrapping_sub(8),
                };
                let rival = Rival {
                    span,
                    slope,
                    object,
                };
                pile.add(
                    Pane { rival, slot: 0 },
                    Take::Window(Span { start: 0, end: 24 }),
                );
            }
            let mut order = [(); 24].map(|()| Vec::new());
            let mut from = 0;
            while let Some((part, count)) = pile.next_part(from, 24) {
                for column in part.start..part.end {
                    for &number in &pile.order[..count] {
                        let pane = pile.panes[usize::from(number)];
                        if pane.rival.span.start <= column && column < pane.rival.span.end {
                            order[column as usize].push(pane.rival.key(column));
                        }
                    }
                }
                from = part.end;
                parts += 1;
            }
            for (column, order) in (0..).zip(order) {
                let panes = pile.panes[..pile.count].iter();
                let has = |pane: &&Pane| {
                    let Span { start, end } = pane.rival.span;
                    start <= column && column < end
                };
                let mut want: Vec<Key> = panes
                    .filter(has)
                    .map(|pane| pane.rival.key(column))
                    .collect();
                want.sort();
                assert_eq!(order, want, "{round} {column}");
            }
        }
        assert!(parts > 30_000, "{parts}");
    }
}
