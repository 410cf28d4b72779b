//! Who is seen on a [paced](super::paced) line, run by run (X9).
//!
//! Runs are found before any pixel is coloured, so what the colours cost is known. They lie in the cells of depth, a
//! word each: no column has two.

use super::near::{Field, NUMBER, Taken, insert, nearer, number_of};
use super::paced::Pacer;
use super::renderer::Renderer;
use super::rival::{rival_of, slope_of};
use super::slot::Flags;
use super::spans::{Line, Span, columns_of};
use crate::look::{Fill, Look};
use crate::num::{bit, take_first};

/// Runs of pixels, and what they cost with all of their colours.
pub(super) struct Runs<'c> {
    cells: &'c mut [u32],
    pub(super) count: usize,
    pub(super) cost: u32,
}

/// A run of pixels of what is in a slot.
pub(super) struct Run {
    pub(super) number: usize,
    pub(super) columns: Span,
}

impl<'c> Runs<'c> {
    pub(super) fn of(cells: &'c mut [u32]) -> Self {
        Self {
            cells,
            count: 0,
            cost: 0,
        }
    }

    /// Adds a run that costs so much. Columns and slots have fewer than 1,024.
    #[inline(always)]
    fn add(&mut self, slot: usize, columns: Span, cost: u32) {
        if let Some(cell) = self.cells.get_mut(self.count) {
            *cell = (slot as u32) << 20 | columns.start << 10 | columns.end;
            self.count += 1;
            self.cost = self.cost.saturating_add(cost);
        }
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = Run> {
        let cells = self.cells.get(..self.count).unwrap_or_default();
        cells.iter().map(|cell| Run {
            number: (cell >> 20) as usize,
            columns: Span::new(cell >> 10 & 1023, cell & 1023),
        })
    }
}

/// Words of a mask that a span takes.
fn words_of(span: Span) -> u32 {
    (span.end >> 5).saturating_sub(span.start >> 5) + 1
}

impl<L: Look, const WORDS: usize> Renderer<'_, L, WORDS> {
    /// Finds the runs of all slots; `false` where the line cannot pay for finding them.
    #[inline(never)]
    pub(super) fn find_runs(
        &mut self,
        pacer: &mut Pacer<L, WORDS>,
        runs: &mut Runs<'_>,
        out: &Line<'_, '_, L>,
    ) -> bool {
        let found = self.cache.in_use() * u32::from(pacer.pace.span);
        if !pacer.pay(found, 0) {
            return false;
        }
        let words = self.find_columns(out);
        // Once to cover them, and once more to find who is seen.
        if !pacer.pay(2 * words * u32::from(pacer.pace.word), 0) {
            return false;
        }
        let met = self.cover_columns();
        let listed = self.add_alone(pacer, runs, met);
        if met {
            // So many spans cover columns in at most twice as many runs; what is compared pays for its own.
            if !pacer.pay(2 * listed * u32::from(pacer.pace.span), 0) {
                self.covered.clear();
                self.over.clear();
                return false;
            }
            self.over.clear();
            // As much for colours as for finding who is seen.
            let leaves = pacer.left / 2;
            let is_sorted = self.sort_met(pacer, leaves, out);
            self.add_met(pacer, leaves, runs, listed as usize, is_sorted, out);
            self.written.clear();
        }
        true
    }

    /// Finds the columns of all slots; how many words of masks they take.
    #[inline(never)]
    fn find_columns(&mut self, out: &Line<'_, '_, L>) -> u32 {
        let mut words = 0;
        for word in 0..WORDS {
            let (slots, spans) = (&self.cache.slots[word], &mut self.cache.spans[word]);
            let mut used = self.cache.used[word];
            while let Some(i) = take_first(&mut used) {
                let i = i as usize & 31;
                let span = columns_of::<L>(&slots[i], out);
                spans[i] = span.start << 16 | span.end;
                words += words_of(span);
            }
        }
        words
    }

    /// Covers the columns of all slots; whether two share one.
    #[inline(never)]
    fn cover_columns(&mut self) -> bool {
        let mut met = 0;
        for word in 0..WORDS {
            let mut used = self.cache.used[word];
            while let Some(i) = take_first(&mut used) {
                let i = i as usize & 31;
                let Span { start, end } = Span::of(self.cache.spans[word][i]);
                if start < end {
                    met |= self.covered.cover_over(&mut self.over, start, end);
                }
            }
        }
        met != 0
    }

    /// The columns of a slot.
    #[inline(always)]
    fn columns(&self, number: usize) -> Span {
        let span = self.cache.spans.as_flattened().get(number).copied();
        Span::of(span.unwrap_or_default())
    }

    /// Adds spans that meet nobody, and lists the others; how many these are.
    #[inline(never)]
    fn add_alone(&mut self, pacer: &Pacer<L, WORDS>, runs: &mut Runs<'_>, met: bool) -> u32 {
        let mut all = 0;
        for word in 0..WORDS {
            let mut used = self.cache.used[word];
            let mut listed = 0;
            while let Some(i) = take_first(&mut used) {
                let number = word * 32 + i as usize;
                let span = Span::of(self.cache.spans[word][i as usize & 31]);
                if span.start >= span.end {
                    continue;
                }
                if met && self.over.meets(span.start, span.end) {
                    listed |= bit(i);
                    all += 1;
                } else {
                    let cost = self.cost_of(pacer, number, span.end - span.start);
                    runs.add(number, span, cost);
                }
            }
            self.cache.listed[word] = listed;
        }
        all
    }

    /// What it costs to colour so many pixels of a slot.
    #[inline(always)]
    pub(super) fn cost_of(&self, pacer: &Pacer<L, WORDS>, number: usize, width: u32) -> u32 {
        let pace = &pacer.pace;
        let cost = u32::from(pace.run) + u32::from(pace.pixel) * width;
        match self.flags(number).fill() {
            // Planes are made anew each time.
            Fill::Thin => 2 * cost + u32::from(pace.large),
            fill if L::TEXTURED => cost * self.halves(number, fill) / 2,
            Fill::Plain | Fill::Small => cost,
            Fill::Wide => 2 * cost,
        }
    }

    /// How many halves of what most spans take that of a slot does.
    fn halves(&self, number: usize, fill: Fill) -> u32 {
        let slot = self.cache.slots.as_flattened().get(number);
        let Span { start, end } = self.columns(number);
        slot.map_or(2, |slot| L::halves(fill, &slot.item.planes, end - start))
    }

    /// What is more where a slot without a plane of depth is compared.
    fn if_thin(&self, pacer: &Pacer<L, WORDS>, number: usize) -> u32 {
        let is_thin = self.flags(number).lacks_depth();
        if is_thin { pacer.pace.large.into() } else { 0 }
    }

    #[inline(always)]
    fn flags(&self, number: usize) -> Flags {
        let slot = self.cache.slots.as_flattened().get(number);
        slot.map_or(Flags(0), Flags::of)
    }

    /// Sorts the slots that are listed from the nearest on, if the line can pay for it, whatever their order was
    /// on another line; whether they are sorted.
    #[inline(never)]
    fn sort_met(
        &mut self,
        pacer: &mut Pacer<L, WORDS>,
        leaves: u32,
        out: &Line<'_, '_, L>,
    ) -> bool {
        let step = u32::from(pacer.pace.step);
        let (mut slots, mut is_sorted) = (0, true);
        for word in 0..WORDS {
            let mut listed = self.cache.listed[word];
            while let Some(i) = take_first(&mut listed) {
                let number = word * 32 + i as usize;
                let most = leaves + slots as u32 * step;
                is_sorted &= pacer.pay(self.if_thin(pacer, number), most);
                if is_sorted {
                    let key = self.find_key(number, out);
                    let keys = self.cache.order.as_flattened_mut();
                    pacer.left -= step * insert(keys, slots, key, |other| other > key);
                } else if let Some(to) = self.cache.order.as_flattened_mut().get_mut(slots) {
                    *to = number as u32;
                }
                slots += 1;
            }
        }
        is_sorted
    }

    /// The nearest depth of a slot's span, or what stands for it, and its number; the farthest is kept.
    fn find_key(&mut self, number: usize, out: &Line<'_, '_, L>) -> u32 {
        let Some((slot, span)) = self.cache.at(number) else {
            return number as u32;
        };
        let span = Span::of(span);
        let [near, far] = slope_of::<L>(slot, span, out).range(span);
        if let Some(kept) = self.cache.far.as_flattened_mut().get_mut(number) {
            *kept = far;
        }
        near & !NUMBER | number as u32
    }

    /// Adds what is seen of so many slots in the order of the cache. If that is from the nearest on, those that may lie
    /// across what comes later are compared, while half of what the line has is left.
    #[inline(never)]
    fn add_met(
        &mut self,
        pacer: &mut Pacer<L, WORDS>,
        leaves: u32,
        runs: &mut Runs<'_>,
        slots: usize,
        is_sorted: bool,
        out: &Line<'_, '_, L>,
    ) {
        let mut free = out.pixels.len() as u32;
        let cache = &*self.cache;
        let field = Field::of(cache, slots);
        for (k, &key) in field.later(0).iter().enumerate() {
            let (number, span) = (number_of::<WORDS>(key), field.span(key));
            let far = cache.far.as_flattened().get(number);
            let (Some((slot, _)), Some(&far)) = (cache.at(number), far) else {
                return;
            };
            if free == 0 {
                break;
            }
            if self.written.has_all(span.start, span.end) {
                continue;
            }
            let after = Taken {
                slots: k + 1,
                guests: 0,
            };
            let later = nearer(field.later(after.slots), far);
            let rivals = match is_sorted {
                true => self.pay_rivals(pacer, &field, later, span, leaves),
                false => Rivals::TooMany,
            };
            let mut rest = span;
            if let Rivals::Paid = rivals {
                let mut taken = self.written.part(span.start, span.end);
                let rival = rival_of::<L>(slot, span, out);
                field.hide(rival, far, after, out, &mut taken);
                while let Some(run) = rest.take_run(&mut taken) {
                    self.written.cover(run.start, run.end);
                    free -= run.end - run.start;
                    let cost = self.cost_of(pacer, number, run.end - run.start);
                    runs.add(number, run, cost);
                }
                continue;
            }
            while let Some(run) = rest.take_run(&mut self.written) {
                let width = run.end - run.start;
                free -= width;
                runs.add(number, run, self.cost_of(pacer, number, width));
                if let Rivals::TooMany = rivals {
                    pacer.paid.unsorted += width;
                }
            }
        }
    }

    /// Pays for comparing a span with what comes later and may be seen before it.
    fn pay_rivals(
        &self,
        pacer: &mut Pacer<L, WORDS>,
        field: &Field<'_, L, WORDS>,
        later: impl Iterator<Item = u32>,
        span: Span,
        leaves: u32,
    ) -> Rivals {
        let (pair, step) = (u32::from(pacer.pace.pair), u32::from(pacer.pace.step));
        let (mut cost, mut meets) = (0u32, false);
        for key in later {
            if !pacer.pay(step, leaves) {
                return Rivals::TooMany;
            }
            if field.span(key).meets(span) {
                meets = true;
                cost += pair + self.if_thin(pacer, number_of::<WORDS>(key));
            }
        }
        match meets {
            false => Rivals::None,
            true if pacer.pay(cost, leaves) => Rivals::Paid,
            true => Rivals::TooMany,
        }
    }
}

/// What comes later than a span and may be seen before it.
enum Rivals {
    /// Nothing.
    None,
    /// It is compared.
    Paid,
    /// More than the line can pay for.
    TooMany,
}
