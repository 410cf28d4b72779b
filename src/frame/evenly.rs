//! The colours of runs, as well as a [paced](super::paced) line can pay for them (X9).

use super::paced::Pacer;
use super::renderer::Renderer;
use super::runs::{Run, Runs};
use super::spans::{Drawn, Line, Span, colour_run};
use crate::look::{Look, WordOf, fill_even};
use crate::num::leading_zeros;

/// Classes of runs by width: 1 column, 2 to 3, 4 to 7, and so on to 1,023; the first is class 1.
const CLASSES: usize = 11;

/// The class of a run that is not empty.
fn class_of(run: Span) -> usize {
    32 - leading_zeros(run.end - run.start) as usize
}

/// What all runs of each class cost together.
#[derive(Default)]
struct Costs([u32; CLASSES]);

impl Costs {
    fn add(&mut self, run: Span, cost: u32) {
        if let Some(sum) = self.0.get_mut(class_of(run)) {
            *sum = sum.saturating_add(cost);
        }
    }

    /// The widest class that cannot be paid for, once the wider ones are; 0 where all can. What is left is less by those.
    fn pay(&self, left: &mut u32) -> usize {
        for (class, cost) in self.0.iter().enumerate().rev() {
            match left.checked_sub(*cost) {
                Some(rest) => *left = rest,
                None => return class,
            }
        }
        0
    }
}

impl<L: Look, const WORDS: usize> Renderer<'_, L, WORDS> {
    /// How runs are coloured, so that the line can pay for them: up to a class they join what is left of them, up to
    /// another they have one colour.
    #[inline(never)]
    fn choose(&self, pacer: &mut Pacer<L, WORDS>, runs: &Runs<'_>) -> (usize, usize) {
        if pacer.pay(runs.cost, 0) {
            return (0, 0);
        }
        if !pacer.pay(runs.count as u32 * u32::from(pacer.pace.span), 0) {
            return (CLASSES, CLASSES);
        }
        let (mut one, mut more) = (Costs::default(), Costs::default());
        for Run { number, columns } in runs.iter() {
            one.add(columns, self.cost_of(pacer, number, 1));
            let width = columns.end - columns.start;
            more.add(columns, self.cost_of_others(pacer, number, width));
        }
        let joined = one.pay(&mut pacer.left);
        let even = match joined {
            0 => more.pay(&mut pacer.left),
            _ => CLASSES,
        };
        (joined, even)
    }

    /// What it costs to colour so many pixels of a slot, beyond the first.
    #[inline(always)]
    fn cost_of_others(&self, pacer: &Pacer<L, WORDS>, number: usize, width: u32) -> u32 {
        self.cost_of(pacer, number, width) - self.cost_of(pacer, number, 1)
    }

    /// Colours runs, as well as the line can pay for, and the background.
    #[inline(never)]
    pub(super) fn colour_runs(
        &mut self,
        pacer: &mut Pacer<L, WORDS>,
        runs: &Runs<'_>,
        out: &mut Line<'_, '_, L>,
        background: WordOf<L>,
    ) {
        let (joined, even) = self.choose(pacer, runs);
        for Run { number, columns } in runs.iter() {
            let (width, class) = (columns.end - columns.start, class_of(columns));
            if class < joined || class == joined && !pacer.pay(self.cost_of(pacer, number, 1), 0) {
                self.over.cover(columns.start, columns.end);
                pacer.paid.joined += width;
                continue;
            }
            let Some((slot, span)) = self.cache.at(number) else {
                continue;
            };
            let (drawn, span) = (Drawn::of(slot), Span::of(span));
            if class > even
                || class == even && pacer.pay(self.cost_of_others(pacer, number, width), 0)
            {
                colour_run::<L>(drawn, span, columns, out);
            } else {
                colour_evenly::<L>(drawn, span, columns, out);
                pacer.paid.even += width - 1;
            }
        }
        self.fill_rest(out.pixels, background);
        if joined > 0 {
            let width = out.pixels.len() as u32;
            self.over.take_covered(width, |from, to| {
                let before = out.pixels.get(from.wrapping_sub(1) as usize);
                let colour = before.copied().unwrap_or(background);
                fill_columns::<L>(from, to, colour, out.pixels);
            });
        }
    }
}

/// The colour of its middle for a run.
#[inline(never)]
fn colour_evenly<L: Look>(
    drawn: Drawn<'_, L::Planes>,
    span: Span,
    run: Span,
    out: &mut Line<'_, '_, L>,
) {
    let middle = (run.start + run.end) / 2;
    let one = Span::new(middle, middle + 1);
    colour_run::<L>(drawn, span, one, out);
    if let Some(&colour) = out.pixels.get(middle as usize) {
        fill_columns::<L>(run.start, run.end, colour, out.pixels);
    }
}

/// One colour for columns.
#[inline(always)]
pub(super) fn fill_columns<L: Look>(
    start: u32,
    end: u32,
    colour: WordOf<L>,
    pixels: &mut [WordOf<L>],
) {
    if let Some(pixels) = pixels.get_mut(start as usize..end as usize) {
        fill_even::<L::Pixel>(pixels, colour);
    }
}
