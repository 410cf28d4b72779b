//! One line: who is seen, and its pixels (K4, K8, X3).
//!
//! Where the last line had no overlap, spans are coloured as they are found, and inserted into a coverage
//! mask. Where two meet, all spans are found first; those that meet nobody are coloured, the others are drawn from
//! the nearest on (`near`). A look that needs its spans whole, and a line with more spans without a slot than there
//! are cells of depth for, have them sorted by submission, and their depth compared pixel by pixel: where nobody has
//! written before it is written alone. Without depth they are drawn in that order. The background goes where the
//! mask has nothing.

use super::plan::Plan;
use super::renderer::{LineError, Renderer, View};
use super::rival::find_depth;
use super::slot::Active;
use super::spans::{Drawn, Known, Line, Span, colour, colour_run, columns_of, nearer};
use crate::active::{CacheSlot, next};
use crate::link::Link;
use crate::look::{Look, Place, WordOf, fill_even};
use crate::num::{bit, take_first};
use crate::scene::Scene;
use core::hint::black_box;

impl<L: Look, const WORDS: usize> Renderer<'_, L, WORDS> {
    /// Draws a line of the picture over a background; `false` where nothing is active on it. Every pixel is
    /// written.
    ///
    /// # Errors
    /// When the renderer cannot draw the scene (see [`check`](Renderer::check)), or the line is not of the scene.
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
        Ok(self.draw_known(&View::of(scene), line, pixels, background))
    }

    /// [`draw_line`](Renderer::draw_line) of a line of the scene, into as many pixels as it has, where the memory
    /// suffices.
    #[inline(never)]
    pub(super) fn draw_known(
        &mut self,
        view: &View<'_>,
        line: u16,
        pixels: &mut [WordOf<L>],
        background: WordOf<L>,
    ) -> bool {
        self.advance(view, line);
        if self.cache.is_empty() {
            fill_line::<L>(pixels, background);
            return false;
        }
        let mut out = Line {
            view,
            number: u32::from(line),
            pixels,
        };
        if view.values
            && self
                .values
                .is_some_and(|draw| draw(self, &mut out, background))
        {
            return true;
        }
        let spilled = self.cache.spilled.is_some();
        if let (Plan::NearFirst(slots), false) = (self.plan, spilled) {
            if self.draw_near_first(usize::from(slots), &mut out) {
                self.covered.clear();
                return true;
            }
        } else {
            self.guests = 0;
            if !self.met {
                if self.draw_calm(&mut out) && (!spilled || self.draw_all_alone(&mut out)) {
                    self.fill_rest(out.pixels, background);
                    return true;
                }
                self.covered.clear();
            }
            let met = spilled && self.find_spilled(&mut out);
            self.draw_meeting_spans(met, &mut out);
        }
        self.fill_rest(out.pixels, background);
        true
    }

    /// Draws all spans where some meet, or some have no slot, which `met` others.
    fn draw_meeting_spans(&mut self, met: bool, out: &mut Line<'_, '_, WordOf<L>>) {
        if !self.draw_crowded(out) {
            self.met = self.find_spans(out) | met;
            if !self.met || !self.draw_near(out) {
                self.draw_found(out);
            }
            self.over.clear();
            self.written.clear();
        }
        if self.met {
            self.find_plan(out.view);
        }
    }

    /// Colours spans from the nearest on, where nobody has been before, up to a line that is full;
    /// whether it is.
    #[inline(never)]
    fn draw_near_first(&mut self, slots: usize, out: &mut Line<'_, '_, WordOf<L>>) -> bool {
        let mut left = out.pixels.len() as u32;
        for k in 0..slots {
            let number = self.cache.order.as_flattened().get(k).copied();
            let number = number.unwrap_or_default() as usize & 0xFF;
            let Some(slots) = self.cache.slots.get(number >> 5) else {
                return false;
            };
            let slot = &slots[number & 31];
            let Span { start, end } = columns_of::<L>(slot, out);
            if start >= end {
                continue;
            }
            let drawn = Drawn::of(slot);
            left -= self.covered.cover_free(start, end, |from, to| {
                let run = Span {
                    start: from,
                    end: to,
                };
                colour_run::<L>(drawn, Span { start, end }, run, out);
            });
            if left == 0 {
                return true;
            }
        }
        false
    }

    /// The background, where nothing is.
    #[inline(never)]
    pub(super) fn fill_rest(&mut self, pixels: &mut [WordOf<L>], background: WordOf<L>) {
        self.covered.take_free(pixels.len() as u32, |from, to| {
            if let Some(run) = pixels.get_mut(from as usize..to as usize) {
                fill_line::<L>(run, background);
            }
        });
    }

    /// Colours spans as they are found; `false` as soon as two meet.
    #[inline(always)]
    pub(super) fn draw_calm(&mut self, out: &mut Line<'_, '_, WordOf<L>>) -> bool {
        for word in 0..WORDS {
            let plain = self.cache.plain[word];
            if plain != 0 && self.draw_plain(out, word, plain) != 0 {
                return false;
            }
            let others = self.cache.used[word] & !plain;
            if others != 0 && self.draw_others(out, word, others) != 0 {
                return false;
            }
        }
        true
    }

    /// The commonest spans of a word of slots; not 0 as soon as one meets another.
    #[inline(never)]
    fn draw_plain(
        &mut self,
        out: &mut Line<'_, '_, WordOf<L>>,
        word: usize,
        mut plain: u32,
    ) -> u32 {
        // Unknown to the compiler, which would else reckon from the cache's beginning, and load word by word.
        let slots = black_box(&self.cache.slots[word]);
        let line = out.number;
        while plain != 0 {
            let slot = &slots[take_first(&mut plain) as usize & 31];
            let sides = &slot.item.sides;
            let (column, end) = (sides.left.column(line), sides.right.column(line));
            if column >= end {
                continue;
            }
            let met = self.covered.cover(column, end);
            if met != 0 {
                return met;
            }
            let Some(run) = out.pixels.get_mut(column as usize..end as usize) else {
                continue;
            };
            let at = Place {
                span: column,
                end,
                column,
                line,
            };
            L::fill_plain(&slot.item.planes, at, out.view.draws, run);
        }
        0
    }

    /// The other spans of a word of slots; not 0 as soon as one meets another.
    #[inline(never)]
    fn draw_others(
        &mut self,
        out: &mut Line<'_, '_, WordOf<L>>,
        word: usize,
        mut others: u32,
    ) -> u32 {
        let slots = black_box(&self.cache.slots[word]);
        while others != 0 {
            let slot = &slots[take_first(&mut others) as usize & 31];
            let Span { start, end } = columns_of::<L>(slot, out);
            if start < end {
                let met = self.covered.cover(start, end);
                if met != 0 {
                    return met;
                }
                colour::<L>(Drawn::of(slot), Span { start, end }, out);
            }
        }
        0
    }

    /// The columns of all spans; whether two meet.
    #[inline(never)]
    pub(super) fn find_spans(&mut self, out: &mut Line<'_, '_, WordOf<L>>) -> bool {
        let mut met = false;
        for word in 0..WORDS {
            let (slots, spans) = (&self.cache.slots[word], &mut self.cache.spans[word]);
            let mut used = self.cache.used[word];
            while used != 0 {
                let i = take_first(&mut used) as usize & 31;
                let Span { start, end } = columns_of::<L>(&slots[i], out);
                spans[i] = start << 16 | end;
                if start < end {
                    met |= self.covered.cover_over(&mut self.over, start, end);
                }
            }
        }
        met
    }

    /// The columns of what has no slot; what has ended leaves the chain.
    #[inline(never)]
    pub(super) fn find_spilled(&mut self, out: &mut Line<'_, '_, WordOf<L>>) -> bool {
        let mut met = false;
        let line = out.number as i32;
        let (mut before, mut at) = (Link::NONE, self.cache.spilled);
        while at.is_some() {
            let Some(triangle) = out.view.triangle_of(at.object()) else {
                break;
            };
            let after = next(self.links, at);
            let lines = triangle.lines();
            if lines.end <= line {
                self.cache.relink(before, after, self.links);
            } else {
                let way = triangle.way();
                let sides = triangle.sides(way, line, lines.turn);
                let (start, end) = sides.columns(way, out.number, out.view.frame);
                if start < end {
                    met |= self.covered.cover_over(&mut self.over, start, end);
                    self.keep_guest(at.object(), Span { start, end });
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
    fn draw_found(&mut self, out: &mut Line<'_, '_, WordOf<L>>) {
        let mut meeting = self.keep_order();
        for word in 0..WORDS {
            let mut used = self.cache.used[word] & !self.cache.listed[word];
            while used != 0 {
                let i = take_first(&mut used) as usize & 31;
                let (slot, span) = (
                    &self.cache.slots[word][i],
                    Span::of(self.cache.spans[word][i]),
                );
                if span.start >= span.end {
                    continue;
                }
                if self.met && self.over.meets(span.start, span.end) {
                    let key = u32::from(slot.object) << 16 | (word * 32 + i) as u32;
                    insert(self.cache.order.as_flattened_mut(), meeting, key);
                    meeting += 1;
                    continue;
                }
                colour::<L>(Drawn::of(slot), span, out);
            }
        }
        self.ordered = meeting as u16;
        let mut slow = self.cache.spilled;
        for k in 0..meeting {
            let key = self.cache.order.as_flattened().get(k).copied();
            let key = key.unwrap_or_default();
            // One comparison says whether what has no slot comes first (C3).
            while slow.is_some() && u32::from(slow.object()) < key >> 16 {
                slow = self.draw_spilled(slow, out);
            }
            self.draw_meeting(key as usize & 0xFFFF, out);
        }
        while slow.is_some() {
            slow = self.draw_spilled(slow, out);
        }
    }

    /// Keeps of the last line's order what meets others again; how many spans that are.
    #[inline(never)]
    fn keep_order(&mut self) -> usize {
        self.cache.listed = [0; WORDS];
        let mut kept = 0;
        for k in 0..usize::from(self.ordered) {
            let key = self.cache.order.as_flattened().get(k).copied();
            let key = key.unwrap_or_default();
            let (word, i) = ((key & 0xFFFF) as usize >> 5, key as usize & 31);
            let Some(slots) = self.cache.slots.get(word) else {
                continue;
            };
            let span = Span::of(self.cache.spans[word][i]);
            let stays = self.cache.used[word] & bit(i as u32) != 0
                && u32::from(slots[i].object) == key >> 16;
            if stays && span.start < span.end && self.over.meets(span.start, span.end) {
                self.cache.listed[word] |= bit(i as u32);
                if let Some(to) = self.cache.order.as_flattened_mut().get_mut(kept) {
                    *to = key;
                }
                kept += 1;
            }
        }
        kept
    }

    /// A span in a slot that meets others.
    #[inline(never)]
    pub(super) fn draw_meeting(&mut self, number: usize, out: &mut Line<'_, '_, WordOf<L>>) {
        let (word, i) = (number >> 5, number & 31);
        let (Some(slots), Some(spans), Some(deep)) = (
            self.cache.slots.get_mut(word),
            self.cache.spans.get(word),
            self.cache.deep.get_mut(word),
        ) else {
            return;
        };
        let (slot, span) = (&mut slots[i], Span::of(spans[i]));
        if self.depth.is_empty() {
            return colour::<L>(Drawn::of(slot), span, out);
        }
        deepen::<L>(slot, deep, bit(i as u32), out.view);
        let drawn = Drawn::of(slot);
        let known = Known {
            plane: slot.item.depth,
            cells: self.depth,
            written: &mut self.written,
        };
        nearer::<L>(drawn, span, out, known);
    }

    /// A span of what has no slot, set up for this line alone; the next of its kind.
    #[inline(never)]
    pub(super) fn draw_spilled(&mut self, at: Link, out: &mut Line<'_, '_, WordOf<L>>) -> Link {
        let after = next(self.links, at);
        let Some(mut alone) = self.set_up_alone(at.object(), out) else {
            return after;
        };
        let Span { start, end } = alone.span;
        if !self.depth.is_empty() && self.met && self.over.meets(start, end) {
            let known = Known {
                plane: Self::find_depth(&mut alone, out.view),
                cells: self.depth,
                written: &mut self.written,
            };
            nearer::<L>(alone.drawn(), alone.span, out, known);
        } else {
            colour::<L>(alone.drawn(), alone.span, out);
        }
        after
    }
}

/// Pixels of one colour.
#[inline(always)]
pub(super) fn fill_line<L: Look>(pixels: &mut [WordOf<L>], colour: WordOf<L>) {
    fill_even::<L::Pixel>(pixels, colour);
}

/// Finds the depth of a slot, unless it is among those whose depth is known.
#[inline(always)]
pub(super) fn deepen<L: Look>(
    slot: &mut CacheSlot<Active<L::Planes>>,
    deep: &mut u32,
    one: u32,
    view: &View<'_>,
) {
    if *deep & one == 0 {
        *deep |= one;
        find_depth::<L>(slot, view);
    }
}

/// Inserts a key among the first `count`, which rise.
#[inline(always)]
pub(super) fn insert(keys: &mut [u32], count: usize, key: u32) {
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
