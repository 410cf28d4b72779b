//! A span in perspective: exact places every few pixels, texels fetched along straight ways between.
//!
//! | span of | exact places | by |
//! |---|---|---|
//! | squares that repeat, at a coarse budget, up to the triangle's [`reach`] | at both ends | [`Perspective::between`] |
//! | likewise, up to twice that | at both ends and the middle | [`Perspective::between_three`] |
//! | all others | every [`Stride`] pixels, and at the end | [`Perspective::draw`] |
//!
//! 1/w, u/w and v/w are linear on the screen and share the triangle's exponent, which therefore
//! cancels in `u = (u/w) / (1/w)`. The reciprocal of 1/w has 16 bits: one division of 32 bits, or
//! two products and a small table where there is no divider, with the same bits. So a place is off
//! by 2^-15 of its distance from the base at most; the base is to be near the triangle's middle.
//!
//! Instructions a pixel of spans of 320 pixels, all in (rustc 1.95, opt-level 3, counted in QEMU), the
//! same bits on both cores; the choice of the stride takes 115 a span on the M4 and 360 on the M0+.
//!
//! | [`Stride`] | squares of words: M4 | M0+ | other words: M4 | M0+ | 8-bit indices: M4 | M0+ |
//! |---|---|---|---|---|---|---|
//! | `Sixteen` | 9.8 (9.4 a pixel) | 18.8 (17.9) | 19.7 | 37.8 | 22.6 | 40.0 |
//! | `Eight` | 12.3 (11.9) | 25.6 (24.6) | 27.1 | 52.0 | 30.1 | 54.4 |
//! | `Four` | 14.8 (14.2) | 44.2 (42.5) | as `One` | | | |
//! | `Two` | 19.9 (19.5) | 66.2 (65.0) | as `One` | | | |
//! | `One` | 27.2 (27.0) | 111.6 (111.1) | 59.2 | 158.5 | 61.1 | 160.5 |
//!
//! Of `draw`, 5 pixels take 190 on the M4 and 460 on the M0+ with two exact places, 40 to 200 more with others; `between`
//! has neither its calls nor its choice of a loop.
//! Loops of a square take 1.6 KB of code on the M4: 700 bytes for 8 and 16, 330 and 410 for 2 and 4,
//! 150 for 1.
//!
//! # Which stride keeps a budget
//! Between two pixels with 1/w of `q0` and `q1`, u is off from the straight way by at most
//! `|du| |dq| / (4 min q)`. In a span of `n` steps with that bound `e` for the whole, a part of `m`
//! steps has `dq m / n`, and a `du` of at most `m / n max q / min q` of the whole's. So its error is
//! at most `e (m / n)² max q / min q`. [`Perspective::stride`] asks so for a long span; [`reach`] asks once a triangle, for
//! all of its spans.

use super::fetch::{
    FRACTION, Uv, Way, copy, copy_exact, copy_part, copy_square, packed, packed_step, straight,
};
use crate::num::{leading_zeros, mul_17, mul_high, mul_high_unsigned, recip_16};
use crate::scene::{Budget, Square, Texture, Wrap};

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
struct Reciprocal {
    mantissa: u32,
    shift: u32,
}

impl Reciprocal {
    /// Within 2^-15 of itself, for `q` above 0.
    #[inline(always)]
    fn of(q: u32) -> Self {
        let shift = leading_zeros(q) & 31;
        // The top bit is set but where q is 0, where any number will do.
        let upper = (q << shift) >> 16 | 0x8000;
        Self {
            mantissa: recip_16(upper),
            shift,
        }
    }
}

impl Homogeneous {
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
        Uv {
            u: mul_17(self.s, r.mantissa) << r.shift,
            v: mul_17(self.t, r.mantissa) << r.shift,
        }
    }
}

/// Pixels from one exact place to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum Stride {
    /// Each pixel has its own.
    One,
    /// Every 2nd.
    Two,
    /// Every 4th.
    Four,
    /// Every 8th.
    Eight,
    /// Every 16th.
    Sixteen,
}

impl Stride {
    /// All of them, the most exact one first.
    #[cfg(test)]
    pub const ALL: [Self; 5] = [Self::One, Self::Two, Self::Four, Self::Eight, Self::Sixteen];

    /// The power of two that it is.
    #[inline(always)]
    const fn log(self) -> u32 {
        self as u32
    }

    /// Pixels from one exact place to the next.
    #[inline(always)]
    #[must_use]
    pub const fn pixels(self) -> usize {
        1 << self.log()
    }

    /// The longest of at most so many steps.
    #[inline(always)]
    #[must_use]
    pub const fn within(steps: u8) -> Self {
        match steps {
            16.. => Self::Sixteen,
            8.. => Self::Eight,
            4.. => Self::Four,
            2.. => Self::Two,
            _ => Self::One,
        }
    }
}

/// Most steps from one exact place to the next.
const LONGEST: u8 = 64;

/// How many steps from one exact place to the next keep `budget` anywhere in a triangle: 1 to 64.
///
/// `least` is its least 1/w, whose step is `step`. With `K = d(u/w) - u d(1/w)`, u changes by `K / q` a pixel, and `K` is
/// extreme at a corner. The second derivative is `2 dq K / q^2`, so over `m` steps u is off from the straight way by
/// `m^2 |dq K| / (4 q^2)` at most.
#[inline(always)]
#[must_use]
pub fn reach(least: u32, step: i32, ways: [Range; 2], budget: Budget) -> u8 {
    let r = Reciprocal::of(least);
    let of = |range: &Range| {
        let turned = |place: i32| range.step.wrapping_sub(mul_high(place, step) << 2);
        let (low, high) = (turned(range.low), turned(range.high));
        (low ^ low >> 31).max(high ^ high >> 31) as u32 + 1
    };
    let most = of(&ways[0]).max(of(&ways[1]));
    let step = (step ^ step >> 31) as u32 + 1;
    if step > least >> 2 || most > least {
        return 1;
    }
    // Each by 1/w, times 2^30 and more by what the reciprocal may lack.
    let of = |value: u32| {
        let part = (mul_17(value as i32, r.mantissa) as u32) << r.shift;
        part + (part >> 14) + 1
    };
    // The product in units of 2^-19 texel, of which the budget has 2^11.
    let worst = mul_high_unsigned(of(step), of(most)) + 1;
    let twice = halvings(budget.for_curves() << 11, worst).min(12);
    ROOTS[twice as usize & 15]
}

/// How often `most` may be halved and be at least `least`, which is above 0.
#[inline(always)]
fn halvings(most: u32, least: u32) -> u32 {
    if most < least {
        return 0;
    }
    let times = leading_zeros(least) - leading_zeros(most);
    if most >> (times & 31) >= least {
        times
    } else {
        times - 1
    }
}

/// `floor(2^(i / 2))`.
static ROOTS: [u8; 16] = [1, 1, 2, 2, 4, 5, 8, 11, 16, 22, 32, 45, LONGEST, 0, 0, 0];

/// The least and the most of the places on one axis, as in [`Uv`], and the step of them over w to the next pixel.
#[derive(Clone, Copy, Debug)]
pub struct Range {
    pub low: i32,
    pub high: i32,
    pub step: i32,
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

/// One step of a way of `steps` of them, at most [`LONGEST`]; rounded down.
#[inline(always)]
fn nth(way: Uv, steps: usize) -> Uv {
    let n = PARTS[steps & 127];
    Uv {
        u: mul_high(way.u, n) << 1,
        v: mul_high(way.v, n) << 1,
    }
}

impl Perspective {
    /// The longest stride that keeps `budget` along `pixels` pixels, 2 ..= 1024 of them; of more,
    /// one that keeps it too.
    #[inline(never)]
    #[must_use]
    pub fn stride(&self, pixels: usize, budget: Budget) -> Stride {
        let steps = pixels.saturating_sub(1);
        let last = self.at.plus(self.step.times(steps));
        let way = last.place().minus(self.at.place());
        let (low, high) = (self.at.q.min(last.q), self.at.q.max(last.q));
        // max q / min q with 8 fraction bits, rounded up, below 16.
        let r = Reciprocal::of(low);
        let ratio = mul_17(high as i32, r.mantissa) as u32;
        if low == 0 || r.shift > 22 || ratio >> 4 >> (30 - r.shift) != 0 {
            return Stride::One;
        }
        let ratio = (ratio >> (22 - r.shift)) + 2;
        // (ratio - 1) ratio, likewise, times the way with 8 fraction bits: at most 2^29.
        let curve = (((ratio - 256) * ratio) >> 8) + 1;
        let furthest = way.u.unsigned_abs().max(way.v.unsigned_abs());
        let worst = mul_high_unsigned(((furthest >> 11) + 1) << 10, curve << 14) + 1;
        // worst / 4 (m / n)² <= budget
        let steps = steps.min(1023) as u32;
        // 16 texels are as good as more.
        let may = budget.for_curves().min(4095) * steps * steps;
        match () {
            () if worst <= may >> 6 && budget.is_coarse() => Stride::Sixteen,
            () if worst <= may >> 4 && budget.is_coarse() => Stride::Eight,
            () if worst <= may >> 2 => Stride::Four,
            () if worst <= may => Stride::Two,
            () => Stride::One,
        }
    }

    /// Copies a square's texels into `run`, of 1 to [`LONGEST`] + 1 pixels, with exact places at both ends.
    #[inline(always)]
    pub fn between(&self, run: &mut [u16], texture: &Texture<'_>) {
        let steps = run.len().saturating_sub(1);
        let from = self.at.place();
        let way = self.at.plus(self.step.times(steps)).place().minus(from);
        let side = texture.log_width();
        let (at, step) = (packed(from, side), packed_step(nth(way, steps), side));
        copy(run, texture, at, step);
    }

    /// Copies a square's texels into `run`, of 3 to 129 pixels, with exact places at both ends and at the middle one.
    #[inline(always)]
    pub fn between_three(&self, run: &mut [u16], texture: &Texture<'_>) {
        let steps = run.len().saturating_sub(1);
        let half = steps >> 1;
        let from = self.at.place();
        let middle = self.at.plus(self.step.times(half)).place();
        let to = self.at.plus(self.step.times(steps)).place();
        let side = texture.log_width();
        let (first, second) = run.split_at_mut(half);
        let step = packed_step(nth(middle.minus(from), half), side);
        copy_part(first, texture, packed(from, side), step);
        let step = packed_step(nth(to.minus(middle), steps - half), side);
        copy_part(second, texture, packed(middle, side), step);
    }

    /// Copies the span's texels into `run`, with exact places at every `stride` pixels and at the
    /// last one. What is no square that repeats has one at each pixel where others have one at
    /// every 2nd or 4th: that is not dearer.
    #[inline(never)]
    pub fn draw(&self, run: &mut [u16], texture: &Texture<'_>, stride: Stride) {
        let square = texture.square().filter(|_| texture.wrap() == Wrap::Repeat);
        match (square, stride) {
            (Some(Square::Side32(t)), _) => self.square(run, t, stride),
            (Some(Square::Side64(t)), _) => self.square(run, t, stride),
            (Some(Square::Side128(t)), _) => self.square(run, t, stride),
            (Some(Square::Side256(t)), _) => self.square(run, t, stride),
            (None, Stride::Eight | Stride::Sixteen) => self.any(run, texture, stride),
            (None, _) => self.singly(run, texture),
        }
    }

    /// [`draw`](Self::draw) from a square that repeats, whose side divides the base.
    #[inline(always)]
    fn square<const N: usize>(&self, run: &mut [u16], t: &[[u16; N]; N], stride: Stride) {
        match stride {
            Stride::Sixteen | Stride::Eight => self.eights(run, t, stride),
            Stride::Four => self.few::<2, N>(run, t),
            Stride::Two => self.few::<1, N>(run, t),
            Stride::One => self.exact(run, t),
        }
    }

    /// Places every 8 or 16 pixels, between them in one word.
    #[inline(never)]
    fn eights<const N: usize>(&self, run: &mut [u16], t: &[[u16; N]; N], stride: Stride) {
        let (log, side) = (stride.log(), N.trailing_zeros());
        let (runs, rest) = whole_runs(run, log);
        let ahead = self.step.times(stride.pixels());
        let (mut at, mut from) = (self.at, self.at.place());
        let (mut place, mut step, mut is_second) = (0, 0, false);
        for eight in runs.chunks_exact_mut(8) {
            if !is_second {
                at = at.plus(ahead);
                let to = at.place();
                place = packed(from, side);
                step = packed_step(to.minus(from).part(log), side);
                from = to;
            }
            if let Ok(eight) = <&mut [u16; 8]>::try_from(eight) {
                straight(eight, t, &mut place, step);
            }
            is_second = stride == Stride::Sixteen && !is_second;
        }
        if let Some(steps) = rest.len().checked_sub(1) {
            let to = at.plus(self.step.times(steps)).place();
            let step = nth(to.minus(from), steps);
            copy_square(rest, t, packed(from, side), packed_step(step, side));
        }
    }

    /// Places every `2^LOG` pixels, between them in two words; the last ones each have their own.
    #[inline(never)]
    fn few<const LOG: u32, const N: usize>(&self, run: &mut [u16], t: &[[u16; N]; N]) {
        let (runs, rest) = whole_runs(run, LOG);
        let ahead = self.step.times(1 << LOG);
        let (mut at, mut from) = (self.at, self.at.place());
        for run in runs.chunks_exact_mut(1 << LOG) {
            at = at.plus(ahead);
            if at.q == 0 {
                // As in `exact`.
                return;
            }
            let to = at.place();
            let step = to.minus(from).part(LOG);
            for pixel in run {
                *pixel = texel(t, from);
                from = from.plus(step);
            }
            from = to;
        }
        Self { at, ..*self }.exact(rest, t);
    }

    /// A place at each pixel.
    #[inline(never)]
    fn exact<const N: usize>(&self, run: &mut [u16], t: &[[u16; N]; N]) {
        let mut at = self.at;
        for pixel in run {
            if at.q == 0 {
                // Outside of the triangle. The compiler makes shorter code of what is not 0.
                return;
            }
            *pixel = texel(t, at.place());
            at = at.plus(self.step);
        }
    }

    /// A place at each pixel, from any form and size, with any wrap.
    #[inline(never)]
    fn singly(&self, run: &mut [u16], texture: &Texture<'_>) {
        let mut at = self.at;
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
    fn any(&self, run: &mut [u16], texture: &Texture<'_>, stride: Stride) {
        let ahead = self.step.times(stride.pixels());
        let (mut at, mut rest) = (self.at, run);
        let mut from = at.place();
        let copy = |run: &mut [u16], at: Uv, step: Uv| {
            let base = self.base;
            copy_exact(run, texture, Way { base, at, step });
        };
        while rest.len() > stride.pixels() {
            at = at.plus(ahead);
            let to = at.place();
            let (now, more) = rest.split_at_mut(stride.pixels());
            copy(now, from, to.minus(from).part(stride.log()));
            (rest, from) = (more, to);
        }
        if let Some(steps) = rest.len().checked_sub(1) {
            let to = at.plus(self.step.times(steps)).place();
            copy(rest, from, nth(to.minus(from), steps));
        }
    }
}

/// The runs of `2^log` pixels that have a pixel behind them, and the rest: at least 1, if there are
/// any.
#[inline(always)]
fn whole_runs(run: &mut [u16], log: u32) -> (&mut [u16], &mut [u16]) {
    let whole = run.len().saturating_sub(1) >> log << log;
    run.split_at_mut(whole)
}

/// A texel of a square that repeats.
#[inline(always)]
fn texel<const N: usize>(t: &[[u16; N]; N], at: Uv) -> u16 {
    t[(at.v >> FRACTION) as usize & (N - 1)][(at.u >> FRACTION) as usize & (N - 1)]
}
