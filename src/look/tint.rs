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
//! | [`tint_swapped`] | 12.1 (104) | 28.4 (206) | 808 |
//! | [`tint_flat`] | 7.5 (88) | 20.0 (168) | 568 |
//! | [`tint_flat_swapped`] | 10.0 (100) | 21.0 (181) | 660 |
//!
//! # Error
//! Against `round(texel x shade)` with nothing else rounded: at most one step of red and of blue,
//! and of green (which has 6 bits) one of its own, where the shade changes by less than 1/70 of full
//! light a pixel; at most one 5-bit step, which is two of green, up to 1/35. Beyond, a pixel is
//! shaded as one that is half a pixel away.

use core::hint::black_box as unknown;

/// Light of a pixel, or its step, in two words: 16 bits a channel, full light is 2^15.
///
/// Where a channel is below 0 or above `FULL + 255`, pixels get any colour: planes are to keep
/// [`MARGIN`] to both ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Shade {
    /// Red above blue. Of a step, the sum `(red << 16) + blue` of numbers with signs.
    pub red_blue: u32,
    /// Green above 0.
    pub green: u32,
}

/// Full light.
pub const FULL: u32 = 1 << 15;

/// How far planes may err beyond dark and full light: dark vertices are to have it, full ones
/// [`FULL`] and it.
pub const MARGIN: u32 = 64;

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
    /// The shade that is `by` further on.
    #[inline(always)]
    #[must_use]
    pub const fn plus(self, by: Self) -> Self {
        Self {
            red_blue: self.red_blue.wrapping_add(by.red_blue),
            green: self.green.wrapping_add(by.green),
        }
    }

    /// `pixels` times this step.
    #[inline(always)]
    #[must_use]
    pub const fn times(self, pixels: usize) -> Self {
        Self {
            red_blue: self.red_blue.wrapping_mul(pixels as u32),
            green: self.green.wrapping_mul(pixels as u32),
        }
    }

    /// Red, green and blue with 10 bits below full light.
    #[inline(always)]
    const fn channels(self) -> [u32; 3] {
        [
            self.red_blue >> 21,
            self.green >> 21,
            self.red_blue >> 5 & 0x7FF,
        ]
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
    let swap = |w: u32| {
        if SWAPPED {
            w.swap_bytes().rotate_right(16)
        } else {
            w
        }
    };
    swap(product(swap(pixels), by, m))
}

/// Two pixels in place.
#[inline(always)]
fn pair<const SWAPPED: bool>(a: &mut u16, b: &mut u16, by: [u32; 3], m: Masks) {
    let w = tinted::<SWAPPED>(u32::from(*a) | u32::from(*b) << 16, by, m);
    (*a, *b) = (w as u16, (w >> 16) as u16);
}

/// Up to 7 pixels in straight code, 4, 2 and 1, by what `next` gives for each pair.
#[inline(always)]
fn short<const SWAPPED: bool>(run: &mut [u16], m: Masks, mut next: impl FnMut() -> [u32; 3]) {
    let (four, rest) = run.split_at_mut(run.len() & 4);
    if let [a, b, c, d] = four {
        pair::<SWAPPED>(a, b, next(), m);
        pair::<SWAPPED>(c, d, next(), m);
    }
    let (two, one) = rest.split_at_mut(rest.len() & 2);
    if let [a, b] = two {
        pair::<SWAPPED>(a, b, next(), m);
    }
    if let [a, ..] = one {
        *a = tinted::<SWAPPED>(u32::from(*a), next(), m) as u16;
    }
}

/// Multiplies native 565 pixels by a shade that is `shade` half a pixel beyond the first one's
/// centre, and gets `step` more each pixel.
#[inline(always)]
pub fn tint(run: &mut [u16], shade: Shade, step: Shade) {
    gouraud::<false>(run, shade, step.times(2));
}

/// [`tint`] of pixels whose bytes are swapped, as panels on a serial bus want them.
#[inline(always)]
pub fn tint_swapped(run: &mut [u16], shade: Shade, step: Shade) {
    gouraud::<true>(run, shade, step.times(2));
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

#[inline(never)]
fn gouraud_long<const SWAPPED: bool>(run: &mut [u16], mut shade: Shade, step: Shade) {
    let m = MASKS.unknown();
    let mut eights = run.chunks_exact_mut(8);
    for eight in eights.by_ref() {
        // Unknown to the compiler, which would keep multiples of it.
        let step = Shade {
            red_blue: unknown(step.red_blue),
            green: unknown(step.green),
        };
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

/// Up to 7 pixels.
#[inline(never)]
fn gouraud_short<const SWAPPED: bool>(run: &mut [u16], mut shade: Shade, step: Shade) {
    short::<SWAPPED>(run, *unknown(&MASKS), || {
        let by = shade.channels();
        shade = shade.plus(step);
        by
    });
}

/// Multiplies native 565 pixels by one shade.
#[inline(never)]
pub fn tint_flat(run: &mut [u16], shade: Shade) {
    flat::<false>(run, shade);
}

/// [`tint_flat`] of pixels whose bytes are swapped.
#[inline(never)]
pub fn tint_flat_swapped(run: &mut [u16], shade: Shade) {
    flat::<true>(run, shade);
}

#[inline(always)]
fn flat<const SWAPPED: bool>(run: &mut [u16], shade: Shade) {
    let (m, by) = (*unknown(&MASKS), shade.channels());
    let mut eights = run.chunks_exact_mut(8);
    for eight in eights.by_ref() {
        // One that is unknown anew keeps the compiler from unrolling further.
        let by = [unknown(by[0]), by[1], by[2]];
        if let [a, b, c, d, e, f, g, h] = eight {
            pair::<SWAPPED>(a, b, by, m);
            pair::<SWAPPED>(c, d, by, m);
            pair::<SWAPPED>(e, f, by, m);
            pair::<SWAPPED>(g, h, by, m);
        }
    }
    short::<SWAPPED>(eights.into_remainder(), m, || by);
}

#[cfg(test)]
mod tests {
    use super::super::mapping::shade_planes;
    use super::*;
    use crate::num::random::Rng;
    use crate::scene::Vertex;
    use crate::span::{Frame, Triangle};
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

    #[test]
    fn all_texels_times_all_shades_are_within_a_step() {
        let mut run: Vec<u16> = (0..=u16::MAX).step_by(7).collect();
        let texels = run.clone();
        for i in 0..=200 {
            let level = f64::from(i) / 200.0;
            let by = [level, 1.0 - level, (2.0 * level).min(1.0)];
            run.copy_from_slice(&texels);
            tint_flat(&mut run, shade(by));
            for (&got, &texel) in run.iter().zip(&texels) {
                assert!(
                    off(got, texel, by).iter().all(|&d| d <= 1.0),
                    "{texel:#x} {by:?}"
                );
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
            let mut channel = || {
                let step = (2.0 * rng.unit() - 1.0) * steepest;
                let way = step * pixels as f64;
                let low = rng.unit() * (1.0 - way.abs());
                (if way < 0.0 { low - way } else { low }, step)
            };
            let of = [channel(), channel(), channel()];
            let at = |x: f64| of.map(|(from, step)| from + step * x);
            let texels: Vec<u16> = (0..pixels).map(|_| rng.bits() as u16).collect();
            let (mut run, mut swapped) = (texels.clone(), texels.clone());
            // The step as the difference of two, as planes have it.
            let (first, next) = (shade(at(0.5)), shade(at(1.5)));
            let step = Shade {
                red_blue: next.red_blue.wrapping_sub(first.red_blue),
                green: next.green.wrapping_sub(first.green),
            };
            tint(&mut run, first, step);
            for (x, (&got, &texel)) in run.iter().zip(&texels).enumerate() {
                let [r, g, b] = off(got, texel, at(x as f64));
                assert!(
                    r <= 1.0 && b <= 1.0 && g <= green,
                    "{x} of {pixels}: {of:?}"
                );
            }
            swapped.iter_mut().for_each(|p| *p = p.swap_bytes());
            tint_swapped(&mut swapped, first, step);
            swapped.iter_mut().for_each(|p| *p = p.swap_bytes());
            assert_eq!(swapped, run);
            let (mut flat, mut other) = (texels.clone(), texels);
            tint_flat(&mut flat, first);
            other.iter_mut().for_each(|p| *p = p.swap_bytes());
            tint_flat_swapped(&mut other, first);
            other.iter_mut().for_each(|p| *p = p.swap_bytes());
            assert_eq!(flat, other);
        }
    }

    #[test]
    fn planes_of_a_shade_stay_within_the_margin() {
        let mut rng = Rng(14);
        let frame = Frame {
            left: 0,
            top: 0,
            width: 320,
        };
        let mut seen = 0;
        for _ in 0..4000 {
            let mut place = || {
                let (x, y) = (400 + rng.below(500), 300 + rng.below(500));
                y << 16 | x
            };
            let (places, light) = ([place(), place(), place()], [(); 3].map(|()| rng.bits()));
            let light = light.map(|l| [l, l >> 10, l >> 20].map(|l| 2 + (l & 1023) + (l & 1)));
            let vertices = [0, 1, 2].map(|i| {
                let [r, g, b] = light[i];
                Vertex {
                    place: places[i],
                    depth: 0,
                    colour: r << 21 | (b / 2) << 11 | g,
                }
            });
            let triangle = Triangle {
                vertex: vertices.each_ref(),
                texture: Default::default(),
                frame,
            };
            let area = triangle.area();
            if !(1024..1 << 30).contains(&area) {
                continue;
            }
            let planes = shade_planes(&triangle.shares(area), vertices.map(|v| v.colour));
            seen += check(&planes, &places, &vertices.map(|v| v.colour));
        }
        assert!(seen > 100_000, "{seen}");
    }

    /// Checks the pixels of a triangle; how many there are.
    fn check(planes: &[u32; 6], places: &[u32; 3], colour: &[u32; 3]) -> u32 {
        let [a, b, c] = places.map(|p| (f64::from(p & 0xFFFF) / 8.0, f64::from(p >> 16) / 8.0));
        let edge = |p: (f64, f64), q: (f64, f64), x: f64, y: f64| {
            (q.0 - p.0) * (y - p.1) - (q.1 - p.1) * (x - p.0)
        };
        let mut seen = 0;
        for (line, column) in (36..102).flat_map(|l| (48..114).map(move |c| (l, c))) {
            let (x, y) = (f64::from(column) + 0.5, f64::from(line) + 0.5);
            let w = [edge(b, c, x, y), edge(c, a, x, y), edge(a, b, x, y)];
            if w.iter().any(|&w| w < 0.0) {
                continue;
            }
            seen += 1;
            // Half a pixel further on.
            let (x, sum) = (x + 0.5, w[0] + w[1] + w[2]);
            let w = [edge(b, c, x, y), edge(c, a, x, y), edge(a, b, x, y)];
            let at = |plane: usize| {
                planes[plane]
                    .wrapping_add(planes[plane + 1].wrapping_mul(column))
                    .wrapping_add(planes[plane + 2].wrapping_mul(line))
            };
            let (rb, g) = (at(0), at(3));
            for (got, shift, bits, more) in [
                (rb >> 16, 21, 0x7FF, 5),
                (rb & 0xFFFF, 11, 0x3FF, 6),
                (g >> 16, 0, 0x7FF, 5),
            ] {
                let want: f64 = (0..3)
                    .map(|i| w[i] / sum * f64::from((colour[i] >> shift & bits) << more))
                    .sum();
                let off = (got as u16).wrapping_sub(want as i32 as u16) as i16;
                assert!(
                    u32::from(off.unsigned_abs()) <= MARGIN,
                    "{off} at {column} {line}"
                );
            }
        }
        seen
    }
}
