//! Plain texels into a run of pixels, along a way that is linear on the texture.
//!
//! | function | way | serves |
//! |---|---|---|
//! | [`copy`] | one word, v above u, 16 bits of the period each | small boxes on sides up to 256 |
//! | [`copy_wide`] | two words, texels with 19 fraction bits | all else |
//! | [`copy_exact`] | likewise | all else, without an error of its own |
//!
//! Instructions (rustc 1.95, opt-level 3, counted in QEMU), the same bits on both cores. A call
//! with nothing to do takes 40 to 90 on the M4 and 45 to 105 on the M0+, arguments included.
//!
//! | a texel | Cortex-M4 | Cortex-M0+ | 5 pixels, all in | code, M4 |
//! |---|---|---|---|---|
//! | `copy`, squares of 32, 64, 128, 256 words | 6.75 | 9.25 | 76; 115 | 462 bytes each |
//! | `copy`, words of other sizes | 12.0 | 23 | 131; 218 | 710 bytes, all forms |
//! | `copy`, indices of 8; 4 bits in squares of 32 to 128 | 12; 16 | 22; 27 | | 420 bytes, [`bent`](super::bent) |
//! | `copy`, other indices of 8; 4 to 1 bits | 15; 20 | 25; 30 | 142; 228 | |
//! | `copy_wide`, squares of words | 9.2 | 12.7 | 156; 225 | 446 bytes |
//! | `copy_exact`, words; 8 bits | 12.0; 15 | 23; 25 | 148; 239 | 102 bytes |
//! | the same with a step of 2/3 texel, 128 texels clamped | 14.0 | 26.6 | 294; 494 | 704 bytes |
//! | and 64 texels mirrored | 17.8 | 33.5 | 284; 446 | |

use super::bent::copy_indices;
use crate::scene::{Form, Square, TexelWay, Texture, Wrap};
use core::hint::black_box as unknown;

/// Fraction bits of a [`Uv`].
pub const FRACTION: u32 = 19;

/// A place on a texture, or a way: texels with [`FRACTION`] fraction bits, -4096 ..< 4096.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Uv {
    /// To the right.
    pub u: i32,
    /// Down.
    pub v: i32,
}

impl Uv {
    #[inline(always)]
    pub const fn new(u: i32, v: i32) -> Self {
        Self { u, v }
    }

    /// The place that is `by` further on.
    #[inline(always)]
    #[must_use]
    pub const fn plus(self, by: Self) -> Self {
        Self::new(self.u.wrapping_add(by.u), self.v.wrapping_add(by.v))
    }

    /// The way from `from` to here.
    #[inline(always)]
    #[must_use]
    pub const fn minus(self, from: Self) -> Self {
        Self::new(self.u.wrapping_sub(from.u), self.v.wrapping_sub(from.v))
    }

    /// This way `pixels` times.
    #[inline(always)]
    #[must_use]
    pub const fn times(self, pixels: usize) -> Self {
        let times = pixels as i32;
        Self::new(self.u.wrapping_mul(times), self.v.wrapping_mul(times))
    }

    /// One step of `2^log` on this way, rounded down.
    #[inline(always)]
    #[must_use]
    pub const fn part(self, log: u32) -> Self {
        Self::new(self.u >> log, self.v >> log)
    }
}

/// A straight way over a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Way {
    /// Whole texels to the right and down that come on top of `at`.
    pub base: [i32; 2],
    /// The place of the first pixel.
    pub at: Uv,
    /// The way to the next pixel.
    pub step: Uv,
}

impl Way {
    /// The way from so many pixels on.
    #[inline(always)]
    #[must_use]
    pub const fn skip(self, pixels: usize) -> Self {
        Self {
            at: self.at.plus(self.step.times(pixels)),
            ..self
        }
    }

    /// The first place modulo 8192 texels, as it is on a texture that repeats.
    #[inline(always)]
    const fn repeated(&self) -> Uv {
        let [u, v] = self.base;
        self.at.plus(Uv::new(u << FRACTION, v << FRACTION))
    }
}

/// A texel of a square by a place in one word. The row's address is a shifted addition, and no
/// index can be beyond an end.
#[inline(always)]
pub(super) fn texel<const N: usize>(t: &[[u16; N]; N], at: u32) -> u16 {
    let log = N.trailing_zeros();
    t[(at >> (32 - log)) as usize & (N - 1)][(at >> (16 - log)) as usize & (N - 1)]
}

/// The texels of `N` pixels, without an end test.
#[inline(always)]
fn straight<const N: usize, const SIDE: usize>(
    pixels: &mut [u16; N],
    t: &[[u16; SIDE]; SIDE],
    at: &mut u32,
    step: u32,
) {
    for pixel in pixels {
        *pixel = texel(t, *at);
        *at = at.wrapping_add(step);
    }
}

/// [`copy`] from a square.
#[inline(always)]
fn copy_square<const SIDE: usize>(run: &mut [u16], t: &[[u16; SIDE]; SIDE], at: u32, step: u32) {
    if run.len() >= 8 {
        copy_long(run, t, at, step);
    } else {
        copy_short(run, t, at, step);
    }
}

/// Of 8 pixels and more.
#[inline(never)]
fn copy_long<const SIDE: usize>(run: &mut [u16], t: &[[u16; SIDE]; SIDE], mut at: u32, step: u32) {
    let mut eights = run.chunks_exact_mut(8);
    for eight in eights.by_ref() {
        if let Ok(eight) = <&mut [u16; 8]>::try_from(eight) {
            // Unknown to the compiler, which would keep eight multiples of it.
            straight(eight, t, &mut at, unknown(step));
        }
    }
    let rest = eights.into_remainder();
    if !rest.is_empty() {
        copy_short(rest, t, at, step);
    }
}

/// Up to 7 pixels in straight code: 4, 2 and 1.
#[inline(never)]
fn copy_short<const SIDE: usize>(run: &mut [u16], t: &[[u16; SIDE]; SIDE], mut at: u32, step: u32) {
    let (four, rest) = run.split_at_mut(run.len() & 4);
    if let Ok(four) = <&mut [u16; 4]>::try_from(four) {
        straight(four, t, &mut at, step);
    }
    let (two, one) = rest.split_at_mut(rest.len() & 2);
    if let Ok(two) = <&mut [u16; 2]>::try_from(two) {
        straight(two, t, &mut at, step);
    }
    if let [one, ..] = one {
        *one = texel(t, at);
    }
}

/// Copies texels into `run`: the first at `at`, the next a `step` further on.
///
/// Places are `v << 16 | u`, each a fraction of the texture's period with `16 - log2 side` bits
/// below the texel, so the texture repeats, whatever its wrap. A step is the sum `(v << 16) + u` of
/// numbers with signs. v is off by one bit for each period of u between a place and the one that
/// was packed. Sides are at most 256; of others, any texels.
///
/// In place, as it is most of what a short span costs.
#[inline(always)]
pub fn copy(run: &mut [u16], texture: &Texture<'_>, at: u32, step: u32) {
    match texture.square() {
        Some(square) => copy_from(run, square, at, step),
        None => copy_packed(run, texture, at, step),
    }
}

/// [`copy`] from one of the squares that have loops of their own.
#[inline(always)]
pub fn copy_from(run: &mut [u16], square: Square<'_>, at: u32, step: u32) {
    match square {
        Square::Side32(t) => copy_square(run, t, at, step),
        Square::Side64(t) => copy_square(run, t, at, step),
        Square::Side128(t) => copy_square(run, t, at, step),
        Square::Side256(t) => copy_square(run, t, at, step),
    }
}

/// [`copy`], called.
#[inline(never)]
pub(super) fn copy_part(run: &mut [u16], texture: &Texture<'_>, at: u32, step: u32) {
    copy(run, texture, at, step);
}

/// [`copy`] from any form and size.
#[inline(never)]
fn copy_packed(run: &mut [u16], texture: &Texture<'_>, at: u32, step: u32) {
    if texture.repeated() > 0 {
        // No square of words, so one of indices.
        return copy_indices(run, texture, at, [step, 0]);
    }
    let logs = [texture.log_width(), texture.log_height()];
    // u in the upper half takes its carry along.
    let way = TexelWay::new([at << 16, step << 16], [at, step], logs);
    copy_turns(run, texture, way);
}

/// Copies from any form and size, which repeats.
#[inline(never)]
fn copy_turns(run: &mut [u16], texture: &Texture<'_>, way: TexelWay) {
    // A loop for each form.
    let form = texture.form;
    match form {
        Form::Words(_) => each(run, texture, way, |i| form.get(i)),
        Form::Index8(..) => each(run, texture, way, |i| form.get(i)),
        Form::Index4(..) => each(run, texture, way, |i| form.get(i)),
        Form::Index2(..) => each(run, texture, way, |i| form.get(i)),
        Form::Index1(..) => each(run, texture, way, |i| form.get(i)),
        Form::Computed(texels, _) => texels.fetch(run, way),
    }
}

/// The loop of [`copy_turns`]: one check a texel, which never fails.
#[inline(always)]
fn each(
    run: &mut [u16],
    texture: &Texture<'_>,
    way: TexelWay,
    texel: impl Fn(usize) -> Option<u16>,
) {
    let [[mut u, du], [mut v, dv]] = way.ways;
    let [right, down] = way.fraction.map(u32::from);
    let log_width = texture.log_width();
    let (right, down) = (right & 31, down.wrapping_sub(log_width) & 31);
    let rows = ((1u32 << texture.log_height()) - 1) << log_width;
    for pixel in run {
        let index = (v >> down & rows) | u >> right;
        let Some(texel) = texel(index as usize) else {
            return;
        };
        *pixel = texel;
        u = u.wrapping_add(du);
        v = v.wrapping_add(dv);
    }
}

/// Copies texels into `run` along `way`, with the texture's wrap: the exact texel of each place
/// `base + at + i step`, as long as that stays within -4096 ..< 4096 texels of the base.
#[inline(never)]
pub fn copy_exact(run: &mut [u16], texture: &Texture<'_>, way: Way) {
    if texture.wrap() == Wrap::Repeat {
        copy_turns(run, texture, turns(texture, way.repeated(), way.step));
    } else {
        copy_cells(run, texture, way);
    }
}

/// [`copy_exact`] of a run so many pixels from the beginning of `way`, faster on squares of 32 to 256 words that
/// repeat: there places may be off by 1/24 texel; by 1/10 where steps are longer than a quarter of the side.
#[inline(never)]
pub fn copy_wide(run: &mut [u16], skipped: usize, texture: &Texture<'_>, way: Way) {
    if texture.repeated() == 0 || !matches!(texture.form, Form::Words(_)) {
        copy_exact(run, texture, way.skip(skipped));
        return;
    }
    // Rounded steps stay within 1/32 texel of the way, and carries of u within another one.
    let log = texture.log_width();
    let (length, step) = (16usize << (8 - log), packed_step(way.step, log));
    let mut skipped_here = skipped & (length - 1);
    let mut at = way.skip(skipped - skipped_here).repeated();
    let mut rest = run;
    while !rest.is_empty() {
        let (part, more) = rest.split_at_mut((length - skipped_here).min(rest.len()));
        copy_part(part, texture, packed_on(at, step, skipped_here, log), step);
        at = at.plus(way.step.times(length));
        (rest, skipped_here) = (more, 0);
    }
}

/// A place in one word, so many packed steps on.
#[inline(always)]
pub(super) fn packed_on(at: Uv, step: u32, pixels: usize, log: u32) -> u32 {
    packed(at, log).wrapping_add(step.wrapping_mul(pixels as u32))
}

/// A place in one word, rounded down, for a square of `2^log` texels a side.
#[inline(always)]
pub(super) fn packed(at: Uv, log: u32) -> u32 {
    let v = (at.v << (13 - log)) as u32;
    v & 0xFFFF_0000 | (at.u >> (3 + log)) as u32 & 0xFFFF
}

/// A step in one word, rounded to nearest.
#[inline(always)]
pub(super) fn packed_step(step: Uv, log: u32) -> u32 {
    let half = 4 << log;
    let u = step.u.wrapping_add(half) >> (3 + log);
    let v = step.v.wrapping_add(half) >> (3 + log);
    (v << 16).wrapping_add(u) as u32
}

/// Places as fractions of the texture's period.
#[inline(always)]
fn turns(texture: &Texture<'_>, at: Uv, step: Uv) -> TexelWay {
    let logs = [texture.log_width(), texture.log_height()];
    let turns = |way: [i32; 2], log: u32| way.map(|place| (place << (13 - log)) as u32);
    let (u, v) = (
        turns([at.u, step.u], logs[0]),
        turns([at.v, step.v], logs[1]),
    );
    TexelWay::new(u, v, logs)
}

impl Texture<'_> {
    /// The texel at `base + at`, with the texture's wrap.
    #[inline(never)]
    pub(super) fn at(&self, base: [i32; 2], at: Uv) -> Option<u16> {
        let side = |at: i32, base: i32, log: u32| {
            folded((at >> FRACTION).wrapping_add(base), log, self.wrap())
        };
        let column = side(at.u, base[0], self.log_width());
        let row = side(at.v, base[1], self.log_height());
        self.form.get(row << self.log_width() | column)
    }
}

/// The column or the row, of `2^log`, that a wrap shows for any texel.
#[inline(always)]
pub(super) fn folded(texel: i32, log: u32, wrap: Wrap) -> usize {
    let last = (1 << log) - 1;
    let texel = match wrap {
        Wrap::Repeat => texel,
        Wrap::Clamp => texel.clamp(0, last),
        Wrap::Mirror if texel >> log & 1 != 0 => !texel,
        Wrap::Mirror => texel,
    };
    (texel & last) as usize
}

/// One axis of a way, cut into cells: within one, places are straight on the texture.
struct Axis {
    at: i32,
    step: i32,
    base: i32,
    log: u32,
    wrap: Wrap,
}

impl Axis {
    /// Which repeat of the texture pixel `i` is in; where it is clamped, -1, 0 or 1.
    #[inline(always)]
    fn cell(&self, i: usize) -> i32 {
        let at = self.at.wrapping_add(self.step.wrapping_mul(i as i32));
        let cell = (at >> FRACTION).wrapping_add(self.base) >> self.log;
        match self.wrap {
            Wrap::Clamp => cell.signum(),
            Wrap::Mirror | Wrap::Repeat => cell,
        }
    }

    /// How many of `pixels` pixels, at least 1, lie in the first one's cell. A way goes through
    /// cells in order, so the end is found by halving.
    fn same(&self, pixels: usize) -> usize {
        let first = self.cell(0);
        let (mut inside, mut beyond) = (0, pixels - 1);
        if self.cell(beyond) == first {
            return pixels;
        }
        while beyond - inside > 1 {
            let middle = inside.midpoint(beyond);
            if self.cell(middle) == first {
                inside = middle;
            } else {
                beyond = middle;
            }
        }
        beyond
    }

    /// Uv and step within the texture that show what the wrap shows in the first cell.
    fn unfolded(&self) -> [i32; 2] {
        let at = self.at.wrapping_add(self.base << FRACTION);
        match (self.wrap, self.cell(0)) {
            (Wrap::Clamp, ..=-1) => [0, 0],
            (Wrap::Clamp, 1..) => [-1, 0],
            (Wrap::Mirror, cell) if cell & 1 != 0 => [!at, self.step.wrapping_neg()],
            _ => [at, self.step],
        }
    }

    fn advance(&mut self, pixels: usize) {
        let way = self.step.wrapping_mul(pixels as i32);
        self.at = self.at.wrapping_add(way);
    }
}

/// [`copy_wide`] from a texture that does not repeat: cell by cell.
#[inline(never)]
fn copy_cells(run: &mut [u16], texture: &Texture<'_>, way: Way) {
    let axis = |at, step, base, log| Axis {
        at,
        step,
        base,
        log,
        wrap: texture.wrap(),
    };
    let mut u = axis(way.at.u, way.step.u, way.base[0], texture.log_width());
    let mut v = axis(way.at.v, way.step.v, way.base[1], texture.log_height());
    let mut rest = run;
    while !rest.is_empty() {
        let pixels = u.same(rest.len()).min(v.same(rest.len()));
        let Some((now, more)) = rest.split_at_mut_checked(pixels) else {
            return;
        };
        let ([at_u, step_u], [at_v, step_v]) = (u.unfolded(), v.unfolded());
        let (at, step) = (Uv::new(at_u, at_v), Uv::new(step_u, step_v));
        copy_turns(now, texture, turns(texture, at, step));
        u.advance(pixels);
        v.advance(pixels);
        rest = more;
    }
}
