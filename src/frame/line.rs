//! One line: who is seen, and its pixels (K4, K8, X3).
//!
//! Where the last line had no overlap, spans are coloured as they are found, and inserted into a coverage
//! mask. Where two meet, all are sorted: from the nearest on, or without depth from the one submitted last on. Each
//! is coloured where nobody has been before (`near`). The background goes where the mask has nothing.

use super::evenly::fill_columns;
use super::renderer::{LineError, Renderer, View};
use super::spans::{Drawn, Line, Span, colour, columns_of};
use crate::look::{Look, WordOf, fill_even};
use crate::num::take_first;
use crate::scene::Scene;
use core::hint::black_box;

impl<L: Look, const WORDS: usize> Renderer<'_, L, WORDS> {
    /// Draws a line of the picture over a background; `false` only where that is all that is on it. Every pixel is
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
        if let Some(pacer) = &self.pacer {
            return (pacer.draw)(self, view, line, pixels, background);
        }
        self.advance(view, line);
        if self.cache.is_empty() {
            fill_even::<L::Pixel>(pixels, background);
            return false;
        }
        let mut out = Line {
            deep: !self.depth.is_empty() && view.deep,
            nearest_first: false,
            dither: self.dither,
            view,
            number: u32::from(line),
            pixels,
        };
        let values = self.values.filter(|_| view.has_values);
        if values.is_some_and(|draw| draw(self, &mut out, background)) {
            return true;
        }
        if let Some(counter) = &self.counter {
            (counter.line)(self, &out);
        }
        let has_guests = self.cache.spilled.is_some();
        self.lasting &= !self.changed && !has_guests;
        if self.lasting {
            if self.draw_as_before(&mut out) {
                return true;
            }
        } else if self.met {
            self.draw_sorted(&mut out);
        } else if !self.draw_calm(&mut out) || has_guests && !self.draw_all_alone(&mut out) {
            self.covered.clear();
            self.draw_sorted(&mut out);
        }
        self.fill_rest(out.pixels, background);
        true
    }

    /// The background, where nothing is.
    #[inline(never)]
    pub(super) fn fill_rest(&mut self, pixels: &mut [WordOf<L>], background: WordOf<L>) {
        self.covered.take_free(pixels.len() as u32, |from, to| {
            fill_columns::<L>(from, to, background, pixels);
        });
    }

    /// Colours spans as they are found; `false` as soon as two meet.
    #[inline(always)]
    pub(super) fn draw_calm(&mut self, out: &mut Line<'_, '_, L>) -> bool {
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
    fn draw_plain(&mut self, out: &mut Line<'_, '_, L>, word: usize, mut plain: u32) -> u32 {
        // Unknown to the compiler, which would else reckon from the cache's beginning, and load word by word.
        let slots = black_box(&self.cache.slots[word]);
        let line = out.number;
        while let Some(i) = take_first(&mut plain) {
            let slot = &slots[i as usize & 31];
            let sides = &slot.item.sides;
            let (start, end) = (sides.left.column(line), sides.right.column(line));
            if start >= end {
                continue;
            }
            let met = self.covered.cover(start, end);
            if met != 0 {
                return met;
            }
            let Some(run) = out.pixels.get_mut(start as usize..end as usize) else {
                continue;
            };
            let at = Span { start, end }.place(start, line);
            L::fill_plain(&slot.item.planes, at, out.view.draws.states, run);
        }
        0
    }

    /// The other spans of a word of slots; not 0 as soon as one meets another.
    #[inline(never)]
    fn draw_others(&mut self, out: &mut Line<'_, '_, L>, word: usize, mut others: u32) -> u32 {
        let slots = black_box(&self.cache.slots[word]);
        while let Some(i) = take_first(&mut others) {
            let slot = &slots[i as usize & 31];
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
}
