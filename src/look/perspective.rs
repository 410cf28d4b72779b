//! A span in perspective: exact places every few pixels, texels fetched along straight ways or parabolas between (H4, H5,
//! K18).
//!
//! | span of | exact places | by |
//! |---|---|---|
//! | squares that repeat, at a coarse budget, up to the triangle's [`Reach::line`] | at both ends | [`Perspective::between`] |
//! | likewise, up to its [`Reach::arc`] | at both ends, and a parabola through the exact middle | [`Perspective::arc`] |
//! | likewise, longer; of squares of indices, any | the same, every power of two of pixels | [`Perspective::arcs`] |
//! | all others | every 16, 8, 4 or 2 pixels or at each, and at the end | [`Perspective::draw`] |
//!
//! 1/w, u/w and v/w are linear on the screen and share the triangle's exponent, which therefore
//! cancels in `u = (u/w) / (1/w)`. The reciprocal of 1/w has 16 bits: one division of 32 bits, or
//! two products and a small table where there is no divider, with the same bits. So a place is off
//! by 2^-15 of its distance from the base at most; the base is to be near the triangle's middle.
//!
//! Instructions of the 27 cubes (rustc 1.95, opt-level 3, counted in QEMU; `firmware --profile f`), the same bits on
//! both cores:
//!
//! | | Cortex-M4 | Cortex-M0+ |
//! |---|---|---|
//! | a straight span, but for its texels | 99 | 256 |
//! | an arc, but for its texels | 137 | 388 |
//! | a texel of an arc, of eight; of up to seven that are left | 8.1; 11 | 13.1; 18 |
//!
//! # How far exact places may be apart
//! Between two pixels with 1/w of `q0` and `q1`, u is off from the straight way by at most
//! `|du| |dq| / (4 min q)`, and from the parabola by a fraction of that which falls with `|dq| / q`: an arc of 20 pixels
//! over which 1/w changes by a fifth is off by 1/26 of what a straight way is. [`reach`](super::stride::reach()) asks so once
//! a triangle for all of its spans, and once for a long span.

use super::bent::copy_arc;
use super::fetch::{Uv, Way, copy_exact, copy_from, packed_on, packed_step};
use super::stride::{Range, Reach, reach};
use crate::num::{few_leading_zeros, leading_zeros, mul_17, mul_high, recip_16};
use crate::scene::{Bent, Budget, Form, Square, Texture};

/// 1/w, u/w and v/w at a pixel, or their steps, in one triangle's exponent.
///
/// | field | format |
/// |---|---|
/// | `q` | 1/w in any unit that keeps it below 2^31; best at 2^29 to 2^30 at the nearest corner |
/// | `s`, `t` | u and v in texels beyond the base, times `q`, times 2^-11 |
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Homogeneous {
    /// 1/w, or its step modulo 2^32.
    pub q: u32,
    /// u/w.
    pub s: i32,
    /// v/w.
    pub t: i32,
}

/// About `2^(47 - shift) / q`, in 2^15 ..< 2^16.
#[derive(Clone, Copy)]
pub(super) struct Reciprocal {
    pub(super) mantissa: u32,
    pub(super) shift: u32,
}

impl Reciprocal {
    /// Within 2^-15 of itself, for `q` above 0.
    #[inline(always)]
    pub(super) fn of(q: u32) -> Self {
        let shift = few_leading_zeros(q) & 31;
        // The top bit is set but where q is 0, where any number will do.
        let upper = (q << shift) >> 16 | 0x8000;
        Self {
            mantissa: recip_16(upper),
            shift,
        }
    }
}

impl Homogeneous {
    /// Of the values of planes: u/w, v/w, 1/w.
    #[inline(always)]
    pub const fn of([s, t, q]: [u32; 3]) -> Self {
        let (s, t) = (s as i32, t as i32);
        Self { q, s, t }
    }

    /// The sum, modulo 2^32.
    #[inline(always)]
    #[must_use]
    pub const fn plus(self, by: Self) -> Self {
        Self {
            q: self.q.wrapping_add(by.q),
            s: self.s.wrapping_add(by.s),
            t: self.t.wrapping_add(by.t),
        }
    }

    /// `pixels` times this step.
    #[inline(always)]
    #[must_use]
    pub const fn times(self, pixels: usize) -> Self {
        Self {
            q: self.q.wrapping_mul(pixels as u32),
            s: self.s.wrapping_mul(pixels as i32),
            t: self.t.wrapping_mul(pixels as i32),
        }
    }

    /// The place beyond the base: off by 2^-15 of itself at most, and by `2^11 / q` texels for a
    /// unit of `s`. Where `q` is 0, which is outside of every triangle, any place.
    #[inline(always)]
    #[must_use]
    pub fn place(self) -> Uv {
        let r = Reciprocal::of(self.q);
        // s / q 2^30 = s mantissa 2^(shift - 17)
        let of = |value: i32| mul_17(value, r.mantissa) << r.shift;
        Uv::new(of(self.s), of(self.t))
    }
}

/// A span of a triangle in perspective.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Perspective {
    /// Whole texels to the right and down that come on top of `at`: multiples of 256, or of the
    /// side where that is less.
    pub base: [i32; 2],
    /// At the first pixel's centre.
    pub at: Homogeneous,
    /// To the next pixel.
    pub step: Homogeneous,
}

/// `2^31 / n`, rounded down, for runs that end early.
static PARTS: [i32; 128] = {
    let mut parts = [i32::MAX; 128];
    parts[0] = 0;
    let mut n = 2;
    while n < 128 {
        parts[n] = ((1u32 << 31) / n as u32) as i32;
        n += 1;
    }
    parts
};

/// One step of a way of `steps` of them, at most 64; rounded down.
#[inline(always)]
fn nth(way: Uv, steps: usize) -> Uv {
    let of = |way: i32| mul_high(way, PARTS[steps & 127]) << 1;
    Uv::new(of(way.u), of(way.v))
}

impl Perspective {
    /// How far exact places may be apart along `pixels` pixels, at most 1,024, of a texture of `2^log` texels a side.
    #[inline(never)]
    #[must_use]
    pub fn reach(&self, pixels: usize, budget: Budget, log: u32) -> Reach {
        let last = self.at.plus(self.step.times(pixels.saturating_sub(1)));
        let least = self.at.q.min(last.q);
        if least == 0 || self.at.q.max(last.q) >> 31 != 0 {
            return Reach::NONE;
        }
        let (from, to) = (self.at.place(), last.place());
        let of = |a: i32, b: i32, step: i32| {
            let (low, high) = (a.min(b), a.max(b));
            Range { low, high, step }
        };
        let ways = [of(from.u, to.u, self.step.s), of(from.v, to.v, self.step.t)];
        reach(least, self.step.q as i32, ways, budget, log)
    }

    /// Copies a square's texels into a run of a span of 1 to 65 pixels, with exact places at both ends.
    #[inline(always)]
    pub fn between(&self, run: &mut [u16], within: Within, square: Square<'_>) {
        let steps = within.steps();
        let from = self.at.place();
        let way = self.at.plus(self.step.times(steps)).place().minus(from);
        let side = square.log();
        let step = packed_step(nth(way, steps), side);
        let at = packed_on(from, step, within.skipped, side);
        copy_from(run, square, at, step);
    }

    /// Copies a square's texels into a run of a span of up to 65 pixels along a parabola, with exact places at both ends.
    #[inline(always)]
    pub fn arc(&self, run: &mut [u16], within: Within, square: Square<'_>) {
        let rest = self.rest(run, within, 0);
        let piece = rest.last(self.step);
        piece.copy_arc(rest.run, self.step.q, Bent::Words(square));
    }

    /// What lies behind so many pixels.
    #[inline(always)]
    fn rest<'r>(&self, run: &'r mut [u16], within: Within, first: usize) -> Rest<'r> {
        let at = self.at.plus(self.step.times(first));
        Rest {
            run,
            skipped: within.skipped - first,
            steps: within.steps() - first,
            from: at.place(),
            at,
        }
    }

    /// Copies texels into a run of the span, with exact places at every `2^log` pixels and at the
    /// last one. What is no square that repeats has one at each pixel where others have one at
    /// every 2nd or 4th: that is not dearer.
    #[inline(never)]
    pub fn draw(&self, run: &mut [u16], within: Within, texture: &Texture<'_>, log: u32) {
        let side = texture.repeated();
        match (texture.form, log) {
            (_, 3..) => self.any(run, within, texture, log),
            (Form::Words(texels), _) if side > 0 => {
                self.few(run, within, Rows { texels, log: side }, log);
            }
            _ => self.singly(run, within, texture),
        }
    }

    /// Copies a square's texels into a run of the span along parabolas, with exact places at both ends of each: one
    /// every power of two of steps that is at most `arc`.
    #[inline(never)]
    pub fn arcs(&self, run: &mut [u16], within: Within, square: Bent<'_>, arc: u8) {
        let copy = |run: &mut [u16], piece: Piece| piece.copy_arc(run, self.step.q, square);
        let log = 31 - leading_zeros(u32::from(arc) | 1);
        let rest = self.pieces(run, within, log, copy);
        if !rest.run.is_empty() {
            copy(rest.run, rest.last(self.step));
        }
    }

    /// Calls `draw` for each part of a run that lies between two exact places `2^log` pixels from each other. What is left
    /// of the run is at the end of the span.
    #[inline(always)]
    fn pieces<'r>(
        &self,
        run: &'r mut [u16],
        within: Within,
        log: u32,
        mut draw: impl FnMut(&mut [u16], Piece),
    ) -> Rest<'r> {
        let length = 1usize << log;
        let first = within.skipped >> log << log;
        let ahead = self.step.times(length);
        let mut rest = self.rest(run, within, first);
        while rest.steps >= length && !rest.run.is_empty() {
            let at = rest.at.plus(ahead);
            let piece = rest.piece_to(at, length);
            let pixels = (length - rest.skipped).min(rest.run.len());
            let (now, more) = rest.run.split_at_mut(pixels);
            draw(now, piece);
            rest = Rest {
                run: more,
                skipped: 0,
                steps: rest.steps - length,
                from: piece.from.plus(piece.way),
                at,
            };
        }
        rest
    }

    /// Places every pixel, or every 2nd or 4th, between them in two words; the last ones each have their own.
    #[inline(never)]
    fn few(&self, run: &mut [u16], within: Within, rows: Rows<'_>, log: u32) {
        if log == 0 {
            return self.exact(run, within.skipped, rows);
        }
        let rest = self.pieces(run, within, log, |run, piece| {
            let step = piece.way.part(log);
            let mut at = piece.from.plus(step.times(piece.skipped));
            for pixel in run {
                *pixel = rows.texel(at);
                at = at.plus(step);
            }
        });
        let at = rest.at;
        Self { at, ..*self }.exact(rest.run, rest.skipped, rows);
    }

    /// A place at each pixel.
    #[inline(never)]
    fn exact(&self, run: &mut [u16], skipped: usize, rows: Rows<'_>) {
        let mut at = self.at.plus(self.step.times(skipped));
        for pixel in run {
            if at.q == 0 {
                // Outside of the triangle. The compiler makes shorter code of what is not 0.
                return;
            }
            *pixel = rows.texel(at.place());
            at = at.plus(self.step);
        }
    }

    /// A place at each pixel, from any form and size, with any wrap.
    #[inline(never)]
    fn singly(&self, run: &mut [u16], within: Within, texture: &Texture<'_>) {
        let mut at = self.at.plus(self.step.times(within.skipped));
        for pixel in run {
            let Some(texel) = texture.at(self.base, at.place()) else {
                return;
            };
            *pixel = texel;
            at = at.plus(self.step);
        }
    }

    /// Places every 8 or 16 pixels, from any form and size, with any wrap.
    #[inline(never)]
    fn any(&self, run: &mut [u16], within: Within, texture: &Texture<'_>, log: u32) {
        self.ways(run, within, log, |run, way| copy_exact(run, texture, way));
    }

    /// Calls `draw` for the parts of a run between exact places, which are taken as straight.
    #[inline(always)]
    pub(super) fn ways(
        &self,
        run: &mut [u16],
        within: Within,
        log: u32,
        mut draw: impl FnMut(&mut [u16], Way),
    ) {
        let base = self.base;
        let mut along = |run: &mut [u16], piece: Piece, step: Uv| {
            let at = piece.from;
            draw(run, Way { base, at, step }.skip(piece.skipped));
        };
        let rest = self.pieces(run, within, log, |run, piece| {
            along(run, piece, piece.way.part(log));
        });
        if !rest.run.is_empty() {
            let piece = rest.last(self.step);
            along(rest.run, piece, nth(piece.way, piece.steps));
        }
    }
}

/// What lies between two exact places.
#[derive(Clone, Copy)]
struct Piece {
    from: Uv,
    /// To the other place.
    way: Uv,
    /// 1/w at both places, added up.
    q: u32,
    /// How many steps it has.
    steps: usize,
    /// How many pixels of it lie before the run.
    skipped: usize,
}

impl Piece {
    /// Copies a square's texels into a run along a parabola through both places and the exact middle, where `u` is
    /// `(s0 + s1) / (q0 + q1)`: with `k` for `dq` by 1/w in the middle and `w` for the way by its steps, the step grows by
    /// `-2 w k`.
    #[inline(always)]
    fn copy_arc(&self, run: &mut [u16], dq: u32, square: Bent<'_>) {
        let log = square.log();
        let middle = Reciprocal::of(self.q);
        // Times 2^30.
        let k = mul_17((dq << 1) as i32, middle.mantissa) << middle.shift;
        let w = nth(self.way, self.steps);
        let turn = |w: i32| (1i32 << log >> 1).wrapping_sub(mul_high(w, k)) >> log;
        let turns = [turn(w.u), turn(w.v)];
        // So that the last pixel has its place, however the turn was rounded.
        let less = self.steps.saturating_sub(1) as i32;
        let step = |w: i32, turn: i32| {
            let half = (turn << (2 + log)).wrapping_mul(less);
            w.wrapping_sub(half).wrapping_add(4 << log) >> (3 + log)
        };
        let join = |[u, v]: [i32; 2]| (v << 16).wrapping_add(u) as u32;
        let (step, turn) = (
            join([step(w.u, turns[0]), step(w.v, turns[1])]),
            join(turns),
        );
        // From so many pixels on.
        let n = self.skipped as u32;
        let turned = n.wrapping_mul(n.wrapping_sub(1)) >> 1;
        let at =
            packed_on(self.from, step, self.skipped, log).wrapping_add(turn.wrapping_mul(turned));
        copy_arc(
            run,
            square,
            at,
            [step.wrapping_add(turn.wrapping_mul(n)), turn],
        );
    }
}

/// What of a run lies behind the last whole piece of its span, or the beginning of that.
struct Rest<'r> {
    run: &'r mut [u16],
    /// Pixels from `at` to the run.
    skipped: usize,
    /// Pixels from `at` to the last one of the span.
    steps: usize,
    from: Uv,
    at: Homogeneous,
}

impl Rest<'_> {
    /// The piece from here to the span's last pixel.
    #[inline(always)]
    fn last(&self, step: Homogeneous) -> Piece {
        self.piece_to(self.at.plus(step.times(self.steps)), self.steps)
    }

    /// The piece from here to a place so many steps on.
    #[inline(always)]
    fn piece_to(&self, to: Homogeneous, steps: usize) -> Piece {
        Piece {
            from: self.from,
            way: to.place().minus(self.from),
            q: self.at.q.wrapping_add(to.q),
            steps,
            skipped: self.skipped,
        }
    }
}

/// Which pixels of a span a run has: those behind so many, of so many.
#[derive(Clone, Copy, Debug)]
pub struct Within {
    pub skipped: usize,
    pub pixels: usize,
}

impl Within {
    /// All of a span.
    #[cfg(test)]
    pub fn whole(run: &[u16]) -> Self {
        Self {
            skipped: 0,
            pixels: run.len(),
        }
    }

    /// From the span's first pixel to its last one.
    #[inline(always)]
    fn steps(self) -> usize {
        self.pixels.saturating_sub(1)
    }
}

/// The texels of a square of `2^log` a side, which repeats.
#[derive(Clone, Copy)]
struct Rows<'t> {
    texels: &'t [u16],
    log: u32,
}

impl Rows<'_> {
    /// The texel at a place.
    #[inline(always)]
    fn texel(self, at: Uv) -> u16 {
        let row = (at.v as u32) << (13 - self.log) >> (32 - self.log);
        let column = (at.u as u32) << (13 - self.log) >> (32 - self.log);
        let texel = self.texels.get((row << self.log | column) as usize);
        texel.copied().unwrap_or_default()
    }
}
