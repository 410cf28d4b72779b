//! Lines that cost no more than they may (X9).
//!
//! Each step asks first whether the line can pay for it, at the most that it can cost; [`Pace`] has the steps, and what
//! comes of it where it cannot. Here triangles begin, turn and end; in `runs` is what is seen of them, and its colours.
//!
//! All of that hangs on lines and costs alone, not on which line was drawn before: lines in any order give the same
//! picture.

use super::pace::{Pace, Paid};
use super::renderer::{LineError, Renderer, View};
use super::rival::deepen;
use super::runs::Runs;
use super::slot::Active;
use super::spans::Line;
use crate::active::Cache;
use crate::look::{Look, WordOf, fill_even};
use crate::num::{bit, take_first};
use crate::scene::{NONE, Object, Scene};

/// Draws a line, as [`Renderer::draw_known`] does.
type DrawPaced<L, const WORDS: usize> =
    fn(&mut Renderer<'_, L, WORDS>, &View<'_>, u16, &mut [WordOf<L>], WordOf<L>) -> bool;

/// What keeps lines within their cost, as functions: a program that names it nowhere does not have its code.
#[derive(Debug)]
pub(super) struct Pacer<L: Look, const WORDS: usize> {
    pub(super) draw: DrawPaced<L, WORDS>,
    /// Whether it can draw a scene.
    pub(super) check: fn(&Renderer<'_, L, WORDS>, &Scene<'_, '_, L>) -> Result<(), LineError>,
    pub(super) pace: Pace,
    pub(super) paid: Paid,
    /// What is left for the pixels of the line that was begun last.
    pub(super) left: u32,
    /// The line after the one whose triangles begin next, and the first of them.
    line: u16,
    rest: u16,
    /// Slots of triangles that have begun above their first line, by that line, and all of them: they are not active
    /// before it.
    ahead: [[u32; WORDS]; LINES as usize],
    withheld: [u32; WORDS],
}

/// How many lines' triangles have begun after each line, where there was time: its own, and those below.
const LINES: u16 = 8;

impl<L: Look, const WORDS: usize> Pacer<L, WORDS> {
    pub(super) fn new(pace: Pace) -> Self {
        Self {
            draw: |renderer, view, line, pixels, background| {
                let Some(mut pacer) = renderer.pacer.take() else {
                    return false;
                };
                let drawn = renderer.draw_paced(&mut pacer, view, line, pixels, background);
                renderer.pacer = Some(pacer);
                drawn
            },
            check: |renderer, scene| renderer.check_paced(scene),
            pace,
            paid: Paid::default(),
            left: 0,
            line: 0,
            rest: NONE,
            ahead: [[0; WORDS]; LINES as usize],
            withheld: [0; WORDS],
        }
    }

    /// Forgets all lines, to begin at the first.
    fn start(&mut self, first: u16) {
        *self = Self::new(self.pace);
        self.line = first;
    }

    /// Whether triangles that are on a line have not begun.
    fn waits(&self, line: u16) -> bool {
        self.line <= line || self.rest != NONE && self.line == line + 1
    }

    /// Notes what a line has cost in the end.
    fn note_cost(&mut self) {
        let cost = self.pace.most - self.left;
        self.paid.dearest = self.paid.dearest.max(cost);
    }

    /// Pays for something, if that leaves as much as is said.
    pub(super) fn pay(&mut self, cost: u32, leaves: u32) -> bool {
        let left = self.left.checked_sub(cost).filter(|&left| left >= leaves);
        self.left = left.unwrap_or(self.left);
        left.is_some()
    }

    /// Those of some slots whose sides the line can pay for; the others are given up.
    fn pay_each(&mut self, mut slots: u32) -> u32 {
        let mut paid = 0;
        while let Some(i) = take_first(&mut slots) {
            if self.pay(self.pace.turn.into(), 0) {
                paid |= bit(i);
            } else {
                self.paid.lost += 1;
            }
        }
        paid
    }

    /// Gives up slots of a word, active or not.
    fn give_up(&mut self, cache: &mut Cache<Active<L::Planes>, WORDS>, word: usize, slots: u32) {
        cache.give_up(word, slots);
        self.withheld[word] &= !slots;
        for line in &mut self.ahead {
            line[word] &= !slots;
        }
    }

    /// Withholds a slot until a line.
    fn withhold(&mut self, cache: &mut Cache<Active<L::Planes>, WORDS>, slot: usize, line: u16) {
        let (word, one) = (slot >> 5, bit(slot as u32));
        cache.used[word] &= !one;
        self.withheld[word] |= one;
        self.ahead[usize::from(line % LINES)][word] |= one;
    }

    /// What was withheld until a line is active from now on.
    fn arrive(&mut self, cache: &mut Cache<Active<L::Planes>, WORDS>, line: u16) {
        for word in 0..WORDS {
            let slots = core::mem::take(&mut self.ahead[usize::from(line % LINES)][word]);
            cache.used[word] |= slots;
            self.withheld[word] &= !slots;
        }
    }
}

impl<L: Look, const WORDS: usize> Renderer<'_, L, WORDS> {
    /// The same, and no line costs more than its pace allows (X9): where one would, quality is lowered, in the order that
    /// [`Pace`] tells, and [`paid`](Renderer::paid) says what it was. Where nothing is lowered, pictures are the same.
    ///
    /// It wants cells for depth, and as many slots as there are triangles on a line: what finds no slot begins when one
    /// is free. It refuses draw calls with values that few have, and neither fetches ahead nor counts:
    /// [`LineError::Paced`]. Costs are those of lines drawn one after the other from the top; one that is drawn
    /// further down has the same picture, and takes the time of what begins and ends above it.
    ///
    /// A program that names this nowhere does not have the code.
    #[must_use]
    pub fn paced(mut self, pace: Pace) -> Self {
        self.pacer = Some(Pacer::new(pace));
        self
    }

    /// What a [paced](Renderer::paced) renderer has paid since it began a frame, or went back to a line above the last; all
    /// 0 of another.
    #[must_use]
    pub fn paid(&self) -> Paid {
        let pacer = self.pacer.as_ref();
        pacer.map_or(Paid::default(), |pacer| pacer.paid)
    }

    /// Whether a paced renderer can draw a scene.
    fn check_paced(&self, scene: &Scene<'_, '_, L>) -> Result<(), LineError> {
        if scene.has_values || self.fetcher.is_some() || self.counter.is_some() {
            return Err(LineError::Paced);
        }
        self.check_depth(scene.screen().width())
    }

    /// Draws a line, as well as it can pay for; `false` where nothing is active on it or waits for it.
    #[inline(never)]
    fn draw_paced(
        &mut self,
        pacer: &mut Pacer<L, WORDS>,
        view: &View<'_>,
        line: u16,
        pixels: &mut [WordOf<L>],
        background: WordOf<L>,
    ) -> bool {
        self.advance_paced(pacer, view, line);
        self.counts.peak = self.counts.peak.max(self.cache.in_use());
        let waits = pacer.waits(line);
        if self.cache.in_use() == 0 && !waits {
            fill_even::<L::Pixel>(pixels, background);
            pacer.note_cost();
            return false;
        }
        let (before, left) = (pacer.paid, pacer.left);
        let mut out = Line {
            deep: view.deep,
            nearest_first: false,
            dither: self.dither,
            view,
            number: u32::from(line),
            pixels,
        };
        let depth = core::mem::take(&mut self.depth);
        let mut runs = Runs::of(&mut *depth);
        if self.find_runs(pacer, &mut runs, &out) {
            self.colour_runs(pacer, &runs, &mut out, background);
        } else {
            pacer.paid.left_out += out.pixels.len() as u32;
            fill_even::<L::Pixel>(out.pixels, background);
        }
        self.depth = depth;
        let is_lowered = pacer.paid != before;
        pacer.note_cost();
        pacer.left = left;
        pacer.paid.lines += u32::from(waits || is_lowered);
        true
    }

    /// Brings the cache to a line, as far as each line up to it can pay for.
    fn advance_paced(&mut self, pacer: &mut Pacer<L, WORDS>, view: &View<'_>, line: u16) {
        if self.content != Some(view.content) || self.next > line + 1 {
            self.start_anew(view);
            pacer.start(view.first);
        }
        let most = pacer.pace.for_spans(view.frame.width as u32);
        while self.next <= line {
            let now = self.next;
            self.next = now + 1;
            pacer.left = most;
            if self.cache.enter_line(now) {
                self.change_paced(pacer, view);
            }
            pacer.arrive(self.cache, now);
            self.begin_paced(pacer, view, now, most / 2);
        }
    }

    /// What turns or ends on a line.
    #[inline(never)]
    fn change_paced(&mut self, pacer: &mut Pacer<L, WORDS>, view: &View<'_>) {
        if self.cache.begins_block() {
            for word in 0..WORDS {
                for (slots, turns) in self.cache.take_block(word).into_iter().zip([true, false]) {
                    let mut asked = pacer.pay_each(slots);
                    pacer.give_up(self.cache, word, slots & !asked);
                    while let Some(i) = take_first(&mut asked) {
                        self.ask_change(view, word, i, turns);
                    }
                }
            }
        }
        for word in 0..WORDS {
            let turning = self.cache.take_changes(word).turning;
            let turned = pacer.pay_each(turning);
            pacer.give_up(self.cache, word, turning & !turned);
            self.turn_all(view, word, turned);
        }
    }

    /// What begins on a line, after what began above it and had to wait, and before what begins on lines below, as far as
    /// the line has time for it.
    #[inline(never)]
    fn begin_paced(
        &mut self,
        pacer: &mut Pacer<L, WORDS>,
        view: &View<'_>,
        now: u16,
        mut leaves: u32,
    ) {
        let mut is_ahead = false;
        loop {
            if pacer.rest != NONE && pacer.line > now + 1 && !is_ahead {
                is_ahead = true;
                let width = view.frame.width as u32;
                leaves = pacer.pace.of_active(self.cache.in_use(), width);
            }
            while let Some(object) = view.objects.get(usize::from(pacer.rest)) {
                if !self.begin_one(pacer, view, now, leaves, object) {
                    return;
                }
                pacer.rest = object.next;
            }
            if pacer.line >= now + LINES {
                return;
            }
            let bin = usize::from(pacer.line.wrapping_sub(view.first));
            pacer.rest = view.bins.get(bin).copied().unwrap_or(NONE);
            pacer.line += 1;
        }
    }

    /// Begins the triangle that is next, if that leaves as much as is said, and it has not ended; whether nobody has to
    /// wait for it.
    fn begin_one(
        &mut self,
        pacer: &mut Pacer<L, WORDS>,
        view: &View<'_>,
        now: u16,
        leaves: u32,
        object: &Object,
    ) -> bool {
        let Some(triangle) = view.triangle(object) else {
            return false;
        };
        let (first, is_late) = (pacer.line - 1, pacer.line <= now);
        if triangle.lines().end <= i32::from(now) {
            let tells = pacer.pay(pacer.pace.span.into(), 0);
            pacer.paid.lost += u32::from(tells && is_late);
            return tells;
        }
        let Some(slot) = self.cache.free_beside(&pacer.withheld) else {
            return false;
        };
        if !pacer.pay(pacer.pace.of_begin(&triangle), leaves) {
            return false;
        }
        let made = self.take_in(view, slot, pacer.rest, object, first.max(now));
        if made != 0 {
            self.count_set_ups(made);
            self.counts.hits += 1;
            pacer.paid.late += u32::from(is_late);
            if let Some(slot) = self.cache.slot(slot).filter(|_| view.deep) {
                deepen::<L>(slot, view);
            }
            if first > now {
                pacer.withhold(self.cache, slot, first);
            }
        }
        true
    }
}
