//! The second pass: texels, which a fetcher left in the pixels, times a shade, in place.
//!
//! Two pixels are one word, so three products serve both, with the shade of the place between them.
//! Spans of full light are not to be given here: they cost nothing.
//!
//! Instructions (rustc 1.95, opt-level 3, counted in QEMU), the same bits on both cores:
//!
//! | a pixel of long runs (5 pixels, all in) | Cortex-M4 | Cortex-M0+ | code, M4 |
//! |---|---|---|---|
//! | [`tint`] | 10.9 (94) | 26.7 (203) | 742 bytes |
//! | the same, swapped | 11.6 (100) | 26.9 (207) | 786 |
//!
//! Long runs of one shade have a loop of their own, 248 bytes: a list of crates, swapped, takes 556,885 instructions
//! for them on an M4 where the loop with steps takes 713,247.
//!
//! Dithered, what is raised takes the place of half a step: two pixels at a time where the shade is one, and else each
//! by its own shade.
//!
//! # Error
//! Against `round(texel x shade)` with nothing else rounded: at most one step of red and of blue,
//! and of green (which has 6 bits) one of its own, where the shade changes by less than 1/70 of full
//! light a pixel; at most one 5-bit step, which is two of green, up to 1/35. Beyond, a pixel is
//! shaded as one that is half a pixel away.

use super::ramp::Pair;
use crate::num::{SHORT, rolled};
use crate::pixel::{PixelFormat, Rgb565Bytes, threshold};
use core::hint::black_box as unknown;

/// Light of a pixel, or its step: full light is 2^15.
///
/// Where a channel is below 0 or above full light and 255, pixels get any colour: planes keep a [margin](Shade::MARGIN)
/// to both ends.
pub type Shade = Pair;

/// Full light.
#[cfg(test)]
pub const FULL: u32 = 1 << 15;

/// What a [`product`] is made with, in registers: unknown to the compiler, which would else make
/// others of them.
#[derive(Clone, Copy)]
struct Masks {
    /// Five bits in each half.
    five: u32,
    /// Six bits in each half.
    six: u32,
    /// Half a step in each half.
    half: u32,
}

static MASKS: Masks = Masks {
    five: 0x001F_001F,
    six: 0x003F_003F,
    half: 0x0200_0200,
};

impl Masks {
    /// The same with other parts of a step in place of half of one.
    #[inline(always)]
    fn raising(self, half: u32) -> Self {
        Self { half, ..self }
    }

    /// The same in registers.
    #[inline(always)]
    fn unknown(&self) -> Self {
        Self {
            five: unknown(self.five),
            six: unknown(self.six),
            half: unknown(self.half),
        }
    }
}

impl Shade {
    /// What planes have on top of the light, so that sums which err stay above 0: of 5 bits 1/16 of a step, of 8 bits half.
    pub(super) const MARGIN: u32 = 1 << 6;

    /// A quarter of `step` back.
    #[inline(always)]
    pub fn minus_quarter(self, step: Self) -> Self {
        self.minus(Self::of(step.parts().map(|part| part >> 2)))
    }

    /// Red, green and blue with 10 bits below full light.
    #[inline(always)]
    const fn channels(self) -> [u32; 3] {
        let Self { red_blue, green } = self;
        [red_blue >> 21, green >> 21, red_blue >> 5 & 0x7FF]
    }
}

/// Two pixels of 565, each in a half of a word, times red, green and blue.
#[inline(always)]
fn product(pixels: u32, [red, green, blue]: [u32; 3], m: Masks) -> u32 {
    let by = |field: u32, shade: u32| field.wrapping_mul(shade).wrapping_add(m.half) >> 10;
    let r = by(pixels >> 11 & m.five, red) & m.five;
    let g = by(pixels >> 5 & m.six, green) & m.six;
    let b = by(pixels & m.five, blue) & m.five;
    r << 11 | g << 5 | b
}

/// [`product`] of pixels whose bytes are in the panel's order where that is `SWAPPED`.
#[inline(always)]
fn tinted<const SWAPPED: bool>(pixels: u32, by: [u32; 3], m: Masks) -> u32 {
    let swap = |w: u32| match SWAPPED {
        // And the two pixels with them, there and back.
        true => w.swap_bytes(),
        false => w,
    };
    swap(product(swap(pixels), by, m))
}

/// Two pixels in place.
#[inline(always)]
fn pair<const SWAPPED: bool>(a: &mut u16, b: &mut u16, by: [u32; 3], m: Masks) {
    let w = tinted::<SWAPPED>(u32::from(*a) | u32::from(*b) << 16, by, m);
    (*a, *b) = (w as u16, (w >> 16) as u16);
}

/// Multiplies 565 pixels, whose bytes are `SWAPPED` where a panel on a serial bus wants that, by a shade that is `shade`
/// half a pixel beyond the first one's centre, and gets `step` more each pixel. Of an odd number, the last one is shaded
/// by its own place: half a pixel beyond may lie beyond its triangle.
#[inline(always)]
pub fn tint<const SWAPPED: bool>(run: &mut [u16], shade: Shade, step: Shade) {
    gouraud::<SWAPPED>(run, shade, step.times(2));
}

/// By steps of two pixels.
#[inline(always)]
fn gouraud<const SWAPPED: bool>(run: &mut [u16], shade: Shade, step: Shade) {
    if run.len() >= 8 {
        gouraud_long::<SWAPPED>(run, shade, step);
    } else {
        gouraud_short::<SWAPPED>(run, shade, step);
    }
}

/// Of one shade, as faces of one normal have it.
#[inline(never)]
fn even_long<const SWAPPED: bool>(run: &mut [u16], shade: Shade, step: Shade) {
    let m = MASKS.unknown();
    let rest = even_fours::<SWAPPED>(run, shade.channels(), [m, m]);
    // For a step that it knows, the compiler would make another copy of that.
    gouraud_short::<SWAPPED>(rest, shade, step);
}

/// Of one shade, four pixels at a time, each two by a mask of their own; what is left.
#[inline(always)]
fn even_fours<const SWAPPED: bool>(
    run: &mut [u16],
    by: [u32; 3],
    [first, second]: [Masks; 2],
) -> &mut [u16] {
    let mut fours = run.chunks_exact_mut(4);
    for four in fours.by_ref() {
        rolled();
        if let [a, b, c, d] = four {
            pair::<SWAPPED>(a, b, by, first);
            pair::<SWAPPED>(c, d, by, second);
        }
    }
    fours.into_remainder()
}

#[inline(never)]
fn gouraud_long<const SWAPPED: bool>(run: &mut [u16], mut shade: Shade, step: Shade) {
    if step.red_blue | step.green == 0 {
        return even_long::<SWAPPED>(run, shade, step);
    }
    let m = if SHORT { MASKS } else { MASKS.unknown() };
    let mut eights = run.chunks_exact_mut(8);
    for eight in eights.by_ref() {
        // Unknown to the compiler, which would keep multiples of it.
        let step = Shade::new(unknown(step.red_blue), unknown(step.green));
        if let [a, b, c, d, e, f, g, h] = eight {
            pair::<SWAPPED>(a, b, shade.channels(), m);
            shade = shade.plus(step);
            pair::<SWAPPED>(c, d, shade.channels(), m);
            shade = shade.plus(step);
            pair::<SWAPPED>(e, f, shade.channels(), m);
            shade = shade.plus(step);
            pair::<SWAPPED>(g, h, shade.channels(), m);
            shade = shade.plus(step);
        }
    }
    gouraud_short::<SWAPPED>(eights.into_remainder(), shade, step);
}

/// Up to 7 pixels in straight code: 4, 2 and 1.
#[inline(never)]
fn gouraud_short<const SWAPPED: bool>(run: &mut [u16], mut shade: Shade, step: Shade) {
    let m = MASKS;
    let (four, rest) = run.split_at_mut(run.len() & 4);
    if let [a, b, c, d] = four {
        pair::<SWAPPED>(a, b, shade.channels(), m);
        shade = shade.plus(step);
        pair::<SWAPPED>(c, d, shade.channels(), m);
        shade = shade.plus(step);
    }
    let (two, one) = rest.split_at_mut(rest.len() & 2);
    if let [a, b] = two {
        pair::<SWAPPED>(a, b, shade.channels(), m);
        shade = shade.plus(step);
    }
    if let [a, ..] = one {
        let by = shade.minus_quarter(step).channels();
        *a = tinted::<SWAPPED>(u32::from(*a), by, m) as u16;
    }
}

/// What a place and the next one raise pixels by in place of half a step, before they are cut to one.
#[inline(always)]
fn raised<const SWAPPED: bool>([column, line]: [u32; 2]) -> u32 {
    let by = |i: u32| ((1 << 9) + 32 * threshold(column.wrapping_add(i), line)) as u32;
    match SWAPPED {
        true => by(0) << 16 | by(1),
        false => by(1) << 16 | by(0),
    }
}

/// Full light may be a little more, which with nearly a step would be one beyond the texel.
#[inline(always)]
fn held(shade: Shade) -> [u32; 3] {
    shade.channels().map(|channel| channel.min(1 << 10))
}

/// Each pixel with the shade of its own place, which `shade` is for the first.
#[inline(always)]
fn dithered<const SWAPPED: bool>(
    run: &mut [u16],
    mut shade: Shade,
    step: Shade,
    [column, line]: [u32; 2],
) {
    if step.is_none() {
        return dithered_even::<SWAPPED>(run, shade, [column, line]);
    }
    for (pixel, column) in run.iter_mut().zip(column..) {
        let m = MASKS.raising(raised::<SWAPPED>([column, line]));
        *pixel = tinted::<SWAPPED>(u32::from(*pixel), held(shade), m) as u16;
        shade = shade.plus(step);
        rolled();
    }
}

/// Of one shade, two pixels at a time.
#[inline(always)]
fn dithered_even<const SWAPPED: bool>(run: &mut [u16], shade: Shade, [column, line]: [u32; 2]) {
    let by = held(shade);
    let half = |i: u32| raised::<SWAPPED>([column.wrapping_add(i), line]);
    let first = MASKS.raising(half(0)).unknown();
    let second = first.raising(half(2));
    let rest = even_fours::<SWAPPED>(run, by, [first, second]);
    for (pixels, m) in rest.chunks_mut(2).zip([first, second]) {
        if let [a, b] = pixels {
            pair::<SWAPPED>(a, b, by, m);
        } else if let [a] = pixels {
            *a = tinted::<SWAPPED>(u32::from(*a), by, m) as u16;
        }
    }
}

/// A pixel of 16 bits that can be tinted.
pub trait Texel: PixelFormat<Word = u16> {
    /// A pixel in the order of numbers, or such a number as a pixel.
    fn ordered(word: u16) -> u16;

    /// Multiplies a run by a shade, which is that of the place half a pixel beyond the first.
    #[inline(always)]
    fn tint(run: &mut [u16], shade: Shade, step: Shade) {
        if Self::ordered(1) == 1 {
            tint::<false>(run, shade, step);
        } else {
            tint::<true>(run, shade, step);
        }
    }

    /// The same, dithered by where the run is on the picture, and each pixel by the shade of its own place, which
    /// `shade` is for the first.
    #[inline(never)]
    fn tint_dithered(run: &mut [u16], shade: Shade, step: Shade, at: [u32; 2]) {
        if Self::ordered(1) == 1 {
            dithered::<false>(run, shade, step, at);
        } else {
            dithered::<true>(run, shade, step, at);
        }
    }
}

impl<const ORDER: u8> Texel for Rgb565Bytes<ORDER> {
    #[inline(always)]
    fn ordered(word: u16) -> u16 {
        Self::in_memory(word)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::random::Rng;
    use crate::pixel::{Rgb565, Rgb565Be};
    use std::vec::Vec;

    /// Red, green and blue of a pixel, in steps of its own.
    fn fields(p: u16) -> [f64; 3] {
        [p >> 11, p >> 5 & 63, p & 31].map(f64::from)
    }

    /// How far a pixel is from the rounded product, in steps of each field.
    fn off(got: u16, texel: u16, shade: [f64; 3]) -> [f64; 3] {
        let (got, texel) = (fields(got), fields(texel));
        [0, 1, 2].map(|i| (got[i] - (texel[i] * shade[i]).round()).abs())
    }

    fn shade([red, green, blue]: [f64; 3]) -> Shade {
        let of = |x: f64| (x * f64::from(FULL)).round() as i32;
        Shade {
            red_blue: ((of(red) << 16) + of(blue)) as u32,
            green: (of(green) << 16) as u32,
        }
    }

    /// Kills: a place of another column or line, halves that are exchanged, one shade that is not taken as others are,
    /// more than full light that raises beyond the texel, a shade of another pixel.
    #[test]
    fn dithered_texels_are_raised_by_their_places() {
        let mut rng = Rng(31);
        for round in 0..4_000 {
            let pixels = 1 + rng.below(23) as usize;
            let at = [rng.below(8), rng.below(8)];
            let levels = [0, 9_000, 20_000, FULL, FULL + 200];
            let first = [(); 3].map(|()| levels[rng.below(5) as usize] as i32);
            let step = [(); 3].map(|()| match round % 2 {
                0 => 0,
                _ => rng.below(200) as i32,
            });
            let step = [0, 1, 2].map(|i| if first[i] > 20_000 { -step[i] } else { step[i] });
            let shade = |levels: [i32; 3]| Shade {
                red_blue: ((levels[0] << 16) + levels[2]) as u32,
                green: (levels[1] << 16) as u32,
            };
            let texels: Vec<u16> = (0..pixels).map(|_| rng.bits() as u16).collect();
            let mut run = texels.clone();
            Rgb565::tint_dithered(&mut run, shade(first), shade(step), at);
            let mut swapped: Vec<u16> = texels.iter().map(|t| t.swap_bytes()).collect();
            Rgb565Be::tint_dithered(&mut swapped, shade(first), shade(step), at);
            assert!(run.iter().zip(&swapped).all(|(r, s)| *r == s.swap_bytes()));
            for (k, (&got, &texel)) in (0..).zip(run.iter().zip(&texels)) {
                let parts = f64::from(threshold(at[0] + k, at[1])) / 32.0 + 0.5;
                let (got, texel) = (fields(got), fields(texel));
                for i in 0..3 {
                    let by = f64::from(first[i] + step[i] * k as i32) / f64::from(FULL);
                    // The shade has 10 bits.
                    let cut = |off: f64| ((by.min(1.0) + off) * texel[i] + parts).floor();
                    let (least, most) = (cut(-0.0011).max(0.0), cut(0.0001).min(texel[i]));
                    assert!(
                        least <= got[i] && got[i] <= most,
                        "{round} {k} {i} {got:?} {texel:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn all_texels_times_all_shades_are_within_a_step() {
        let mut run: Vec<u16> = (0..=u16::MAX).step_by(7).collect();
        let texels = run.clone();
        for i in 0..=200 {
            let level = f64::from(i) / 200.0;
            let by = [level, 1.0 - level, (2.0 * level).min(1.0)];
            run.copy_from_slice(&texels);
            tint::<false>(&mut run, shade(by), Shade::default());
            let mut swapped: Vec<u16> = texels.iter().map(|p| p.swap_bytes()).collect();
            tint::<true>(&mut swapped, shade(by), Shade::default());
            assert!(run.iter().zip(&swapped).all(|(p, s)| *p == s.swap_bytes()));
            for (&got, &texel) in run.iter().zip(&texels) {
                // Half a step, and 1/1024 of the field for the shade.
                let (got, texel) = (fields(got), fields(texel));
                for (i, bound) in [0.54, 0.57, 0.54].into_iter().enumerate() {
                    let off = got[i] - texel[i] * by[i];
                    assert!(off.abs() <= bound, "{off} of {texel:?} {by:?}");
                }
            }
            if level == 1.0 {
                let red: Vec<_> = run.iter().map(|p| p >> 11).collect();
                assert!(red.iter().zip(&texels).all(|(r, t)| *r == t >> 11));
            }
        }
    }

    #[test]
    fn shades_that_change_are_within_their_bound() {
        let mut rng = Rng(13);
        for i in 0..20_000 {
            // Slopes up to full light in 70 or 35 pixels, within dark and full.
            let (steepest, green) = [(1.0 / 70.0, 1.0), (1.0 / 35.0, 2.0)][i % 2];
            let pixels = 1 + rng.below(34) as usize;
            // Now and then green alone changes.
            let others = if i % 8 == 0 { 0.0 } else { steepest };
            let mut channel = |steepest: f64| {
                let step = (2.0 * rng.unit() - 1.0) * steepest;
                let way = step * pixels as f64;
                let low = rng.unit() * (1.0 - way.abs());
                (if way < 0.0 { low - way } else { low }, step)
            };
            let of = [others, steepest, others].map(&mut channel);
            let at = |x: f64| of.map(|(from, step)| from + step * x);
            let texels: Vec<u16> = (0..pixels).map(|_| rng.bits() as u16).collect();
            let (mut run, mut swapped) = (texels.clone(), texels.clone());
            // The step as the difference of two, as planes have it.
            let (first, next) = (shade(at(0.5)), shade(at(1.5)));
            let step = Shade {
                red_blue: next.red_blue.wrapping_sub(first.red_blue),
                green: next.green.wrapping_sub(first.green),
            };
            tint::<false>(&mut run, first, step);
            for (x, (&got, &texel)) in run.iter().zip(&texels).enumerate() {
                let [r, g, b] = off(got, texel, at(x as f64));
                assert!(
                    r <= 1.0 && b <= 1.0 && g <= green,
                    "{x} of {pixels}: {of:?}"
                );
            }
            swapped.iter_mut().for_each(|p| *p = p.swap_bytes());
            tint::<true>(&mut swapped, first, step);
            swapped.iter_mut().for_each(|p| *p = p.swap_bytes());
            assert_eq!(swapped, run);
        }
    }
}
