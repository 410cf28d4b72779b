//! Formats, and every method against exact colours.

use super::lirp::blend;
use super::*;
use crate::num::random::Rng;
use crate::shade::{
    Auto, Forward, HalfRate, Interpolation, Lirp10, Lirp12, Lirp16, LirpPacked, Method, Packed8,
    Packed16, Quality, QuarterRate, Stretch,
};
use crate::visible::{Everywhere, Visible};
use std::{println, vec, vec::Vec};

#[test]
fn formats_round_trip_and_keep_their_bytes() {
    for word in 0..=u16::MAX {
        assert_eq!(Rgb565::from_rgb8(Rgb565::to_rgb8(word)), word);
    }
    assert_eq!(Rgb565Be::from_rgb8([255, 0, 0]).to_ne_bytes(), [0xF8, 0x00]);
    assert_eq!(Rgb565Le::from_rgb8([255, 0, 0]).to_ne_bytes(), [0x00, 0xF8]);
    assert_eq!(
        Rgb565Be::to_rgb8(u16::from_ne_bytes([0x07, 0xE0])),
        [0, 255, 0]
    );
    assert_eq!(Rgb888::from_rgb8([1, 2, 3]), [1, 2, 3]);
}

/// Which pixels are seen, as depth would tell.
struct Mask<'m>(&'m [bool]);

impl Visible for Mask<'_> {
    fn each<W>(&mut self, pixels: &mut [W], mut each: impl FnMut(&mut W, bool)) {
        let (now, later) = self.0.split_at(pixels.len());
        for (pixel, shown) in pixels.iter_mut().zip(now) {
            each(pixel, *shown);
        }
        self.0 = later;
    }
}

/// A span by its colours: 16.16 steps with half a step, as planes have them.
#[derive(Debug)]
struct Colours {
    at: [i32; 3],
    step: [i32; 3],
    pixels: usize,
    small: bool,
}

impl Colours {
    /// Colours of a format, as near to either end of their range as planes may come.
    fn random<F: PixelFormat>(rng: &mut Rng, small: bool) -> Self {
        let most = if small { 64 } else { 8192u32 };
        let longest = [4, 20, 64, most][rng.below(4) as usize];
        let pixels = 1 + rng.below(longest);
        let mut colours = Self {
            at: [0; 3],
            step: [0; 3],
            pixels: pixels as usize,
            small,
        };
        for i in 0..3 {
            let range = u32::from(F::STEPS[i]) << 16;
            let from = rng.below(range + 1);
            let reach = [range, range / 64, 0][rng.below(3) as usize];
            let to = (from.saturating_sub(reach) + rng.below(2 * reach + 1)).min(range);
            colours.at[i] = from as i32 + (1 << 15);
            colours.step[i] = (to as i32 - from as i32) / (pixels as i32 - 1).max(1);
            if small {
                // 16 bits are all that there is.
                let cut = F::BITS[i];
                colours.at[i] = colours.at[i] >> cut << cut;
                colours.step[i] = colours.step[i] / (1 << cut) * (1 << cut);
            }
        }
        colours
    }

    fn stretch<F: PixelFormat>(&self) -> Stretch {
        if !self.small {
            return Stretch::Channels(self.at, self.step);
        }
        let bits = F::BITS;
        let at = [0, 1, 2].map(|i| self.at[i] >> bits[i]);
        let step = [0, 1, 2].map(|i| self.step[i] >> bits[i]);
        let pair = |high: i32, low: i32| (high << 16).wrapping_add(low);
        let field = |i: usize, more: u32| (step[i] + (1 << more >> 1)) >> more;
        Stretch::Packed {
            red_blue: pair(at[0], at[2]),
            green: at[1] << 16,
            steps: (pair(step[0], step[2]), step[1] << 16),
            field_step: (field(0, 5) << 21)
                .wrapping_add(field(2, 6) << 11)
                .wrapping_add(field(1, 5)),
        }
    }

    /// The largest step, and the largest rise, units of 2^-16 of a channel's range.
    fn slope<F: PixelFormat>(&self) -> (f64, f64) {
        let slope = (0..3).fold(0.0f64, |most, i| {
            let bits = F::BITS[i];
            most.max(f64::from(self.step[i].abs()) / f64::from(1 << bits))
        });
        (slope, slope * (self.pixels - 1) as f64)
    }
}

/// What a method may be off, units of 2^-16 of a channel's range: as [`Auto`] has it.
fn bound<F: PixelFormat>(method: Method, colours: &Colours) -> f64 {
    let (unit, drift) = match (F::STEPS[0], colours.small) {
        (255, true) => (0.0, 0.0),
        _ => (f64::from(F::PRECISION.unit), f64::from(F::PRECISION.drift)),
    };
    let (slope, rise) = colours.slope::<F>();
    let after = (colours.pixels - 1) as f64;
    // The middle may lie half a unit between two.
    match method {
        Method::Forward => 0.0,
        Method::Packed8 => unit + after.min(7.0) * drift,
        Method::Packed16 => unit + after.min(15.0) * drift,
        Method::Half => (slope / 2.0).ceil() + unit + 3.0 * drift,
        Method::Quarter => (slope * 1.5).ceil() + unit + 3.0 * drift,
        Method::Whole => (rise / 2.0).ceil(),
        Method::Lirp10 => 1.0 + rise / 1024.0,
        Method::Lirp12 => 1.0 + rise / 4096.0,
        Method::Lirp16 => 1.0 + rise / 65536.0,
        Method::LirpPacked => 256.0 + rise / 256.0,
    }
}

fn each_keeps_its_bound<F: PixelFormat, I: Interpolation>(rng: &mut Rng, interpolation: I) {
    let name = core::any::type_name::<I>();
    let mut worst = 0.0f64;
    for round in 0..6_000 {
        let colours = Colours::random::<F>(rng, round % 2 == 0);
        let stretch = colours.stretch::<F>();
        let n = colours.pixels;
        let method = interpolation.method(
            n as u32,
            || colours.slope::<F>().0.ceil() as u32,
            F::PRECISION,
        );
        let bound = bound::<F>(method, &colours);
        let mut all = vec![F::Word::default(); n];
        paint::<F, I>(&mut all, stretch, interpolation, &mut Everywhere);
        for (k, word) in all.iter().enumerate() {
            let shown = F::to_rgb8(*word);
            for (i, shown) in shown.into_iter().enumerate() {
                let steps = f64::from(F::STEPS[i]);
                let step = (f64::from(shown) * steps / 255.0).round();
                let exact = f64::from(colours.at[i]) + f64::from(colours.step[i]) * k as f64;
                let exact = exact / 65536.0 - 0.5;
                let off = (step - exact).abs() - 0.5;
                let range = f64::from(1u32 << (F::BITS[i]));
                let off = off * 65536.0 / range;
                worst = worst.max(off);
                assert!(
                    off <= bound,
                    "{name} {i} at {k}: {off} of {bound}, {colours:?}"
                );
            }
        }
        // Hidden pixels stay as they were, seen ones do not change by it.
        let mask: Vec<bool> = (0..n).map(|_| rng.below(3) > 0).collect();
        let other = F::from_rgb8([1, 254, 77]);
        let mut some = vec![other; n];
        paint::<F, I>(&mut some, stretch, interpolation, &mut Mask(&mask));
        for k in 0..n {
            assert!(
                some[k] == if mask[k] { all[k] } else { other },
                "{name} {colours:?}"
            );
        }
    }
    println!("{name}: {worst:.1} units of 2^-16");
}

#[test]
fn every_method_keeps_its_bound_and_hides_what_is_hidden() {
    fn all<F: PixelFormat>(rng: &mut Rng) {
        each_keeps_its_bound::<F, _>(rng, Forward);
        each_keeps_its_bound::<F, _>(rng, Packed8);
        each_keeps_its_bound::<F, _>(rng, Packed16);
        each_keeps_its_bound::<F, _>(rng, Lirp10);
        each_keeps_its_bound::<F, _>(rng, Lirp12);
        each_keeps_its_bound::<F, _>(rng, Lirp16);
        each_keeps_its_bound::<F, _>(rng, LirpPacked);
        each_keeps_its_bound::<F, _>(rng, Auto::new(Quality::fast()));
        each_keeps_its_bound::<F, _>(rng, Auto::new(Quality::balanced()));
        each_keeps_its_bound::<F, _>(rng, Auto::new(Quality::exact()));
        each_keeps_its_bound::<F, _>(rng, HalfRate);
        each_keeps_its_bound::<F, _>(rng, QuarterRate);
    }
    let mut rng = Rng(11);
    all::<Rgb888>(&mut rng);
    all::<Rgb565>(&mut rng);
    all::<Rgb565Be>(&mut rng);
}

#[test]
fn what_auto_chooses_keeps_its_budget() {
    let mut rng = Rng(12);
    let precision = Rgb565::PRECISION;
    let mut loose = 0;
    for round in 0..200_000 {
        let colours = Colours::random::<Rgb565>(&mut rng, round % 2 == 0);
        let quality = Quality {
            levels: fixed::types::U8F8::from_bits(rng.below(2000) as u16),
            ..Quality::exact()
        };
        let slope = || colours.slope::<Rgb565>().0.ceil() as u32;
        let method = Auto::new(quality).method(colours.pixels as u32, slope, precision);
        let levels = bound::<Rgb565>(method, &colours) / 65536.0 * 32.0 * 255.0 / 31.0;
        let budget: f64 = quality.levels.to_num();
        let exact = method == Method::Forward;
        // 248 units a level, not 249, are kept to, so no rounding can matter.
        assert!(exact || levels <= budget, "{method:?} {levels} {quality:?}");
        loose += u32::from(method != Method::Forward);
    }
    assert!(loose > 100_000);
}

/// K7 as it stands: `((~w) a + w b + (a below the middle, else b)) >> n`.
fn circuit(a: i64, b: i64, w: u32, n: u32) -> i64 {
    let (not, w) = (i64::from(!w & ((1 << n) - 1)), i64::from(w));
    let share = if w >> (n - 1) == 0 { a } else { b };
    (not * a + w * b + share) >> n
}

/// The multiply-add gives the bits of the circuit, at all pixels of a span.
#[test]
fn the_blend_is_the_circuit() {
    fn of<F: PixelFormat, const N: u32>(rng: &mut Rng) {
        for _ in 0..2_000 {
            let ends = [(); 2].map(|()| [(); 3].map(|()| rng.below(65_536)));
            let longest = [30, 8191][rng.below(2) as usize];
            let n = 2 + rng.below(longest) as usize;
            let mut pixels = vec![F::Word::default(); n];
            blend::<F, N>(&mut pixels, ends, &mut Everywhere);
            let ones = f64::from((1 << N) - 1);
            for (k, pixel) in pixels.iter().enumerate() {
                // W to nearest: all ones at the last pixel. What the step lacks for 2^-32 adds
                // up on the way.
                let exact = k as f64 * ones / (n - 1) as f64 + 0.5;
                let lacking = k as f64 * f64::from(1 << N) / 4_294_967_296.0;
                let level = |w: u32, i: usize| {
                    let (a, b) = (i64::from(ends[0][i]), i64::from(ends[1][i]));
                    let bits = F::BITS[i];
                    (circuit(a, b, w, N) >> (16 - bits)) as u8
                };
                let pack = |w: f64| {
                    let w = w as u32;
                    F::pack([level(w, 0), level(w, 1), level(w, 2)])
                };
                assert!(
                    *pixel == pack(exact) || *pixel == pack(exact - lacking),
                    "{N} bits, {n} pixels, at {k}: {ends:?}"
                );
            }
            let whole = |i: usize| {
                F::pack([0, 1, 2].map(|c| (ends[i][c] >> F::STEPS[c].leading_zeros()) as u8))
            };
            assert!(pixels[0] == whole(0) && pixels[n - 1] == whole(1));
        }
    }
    let mut rng = Rng(13);
    of::<Rgb888, 10>(&mut rng);
    of::<Rgb565, 12>(&mut rng);
    of::<Rgb888, 16>(&mut rng);
}
