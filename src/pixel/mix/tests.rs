//! Blends against f64, channel by channel: ideal rounding plus one step.

use super::*;
use crate::num::random::Rng;
use crate::pixel::{Rgb565, Rgb565Be, Rgb565Le, Rgb888};
use std::vec::Vec;

/// Steps of the channels of a word.
trait Steps: PixelFormat {
    fn steps(word: Self::Word) -> [u8; 3];
}

impl Steps for Rgb565 {
    fn steps(word: u16) -> [u8; 3] {
        [
            (word >> 11) as u8,
            (word >> 5 & 63) as u8,
            (word & 31) as u8,
        ]
    }
}

impl Steps for Rgb565Be {
    fn steps(word: u16) -> [u8; 3] {
        Rgb565::steps(u16::from_be(word))
    }
}

impl Steps for Rgb565Le {
    fn steps(word: u16) -> [u8; 3] {
        Rgb565::steps(u16::from_le(word))
    }
}

impl Steps for Rgb888 {
    fn steps(word: [u8; 3]) -> [u8; 3] {
        word
    }
}

/// What a channel would be, before rounding.
fn exact(old: u8, new: u8, full: u16, mix: Mix) -> f64 {
    let (o, n, full) = (f64::from(old), f64::from(new), f64::from(full));
    match mix {
        Mix::Filter(a) => o + (n - o) * f64::from(a) / 255.0,
        Mix::Half => (o + n) / 2.0,
        Mix::Add(a) => (o + n * f64::from(a) / 255.0).min(full),
        Mix::Subtract(a) => (o - n * f64::from(a) / 255.0).max(0.0),
    }
}

/// Mixes words in one go, and checks each channel; the largest error in steps.
fn check<F: Steps>(old: &[F::Word], new: &[F::Word], mix: Mix) -> f64 {
    let mut mixed = old.to_vec();
    F::mix(&mut mixed, new, mix);
    let mut worst = 0f64;
    for ((&m, &o), &n) in mixed.iter().zip(old).zip(new) {
        let (m, o, n) = (F::steps(m), F::steps(o), F::steps(n));
        for i in 0..3 {
            let want = exact(o[i], n[i], F::STEPS[i], mix);
            let off = (f64::from(m[i]) - want).abs();
            assert!(off <= 1.5, "{mix:?}: {o:?} {n:?} give {m:?}, not {want}");
            worst = worst.max(off);
            match mix {
                Mix::Filter(0) | Mix::Add(0) | Mix::Subtract(0) => assert_eq!(m[i], o[i]),
                Mix::Filter(255) => assert_eq!(m[i], n[i]),
                Mix::Half => assert_eq!(u16::from(m[i]), (u16::from(o[i]) + u16::from(n[i])) / 2),
                Mix::Add(255) | Mix::Subtract(255) => assert_eq!(f64::from(m[i]), want),
                _ => {}
            }
        }
    }
    worst
}

/// All pairs of a channel's steps, at all alphas; the other channels are anything.
fn all_pairs<F: Steps>() {
    let mut rng = Rng(5);
    let mut worst = [0f64; 4];
    for alpha in 0..=255 {
        for channel in 0..3 {
            let steps = u32::from(F::STEPS[channel]);
            // Of 8 bits, every other row is enough for a test that ends.
            let stride = if steps > 63 { 5 } else { 1 };
            let mut old = Vec::new();
            let mut new = Vec::new();
            for o in (0..=steps).step_by(stride) {
                for n in 0..=steps {
                    let mut any = || F::STEPS.map(|s| rng.below(u32::from(s) + 1) as u8);
                    let (mut a, mut b) = (any(), any());
                    (a[channel], b[channel]) = (o as u8, n as u8);
                    old.push(F::pack(a));
                    new.push(F::pack(b));
                }
            }
            let mixes = [
                Mix::Filter(alpha),
                Mix::Half,
                Mix::Add(alpha),
                Mix::Subtract(alpha),
            ];
            for (mix, worst) in mixes.into_iter().zip(&mut worst) {
                // Half has no alpha.
                if mix != Mix::Half || alpha == 0 {
                    *worst = worst.max(check::<F>(&old, &new, mix));
                }
            }
        }
    }
    std::println!("filter, half, add, subtract: {worst:.3?} steps off at most");
}

#[test]
fn all_pairs_of_565_at_all_alphas() {
    all_pairs::<Rgb565>();
}

#[test]
fn all_pairs_of_565_with_swapped_bytes() {
    all_pairs::<Rgb565Be>();
}

#[test]
fn pairs_of_888_at_all_alphas() {
    all_pairs::<Rgb888>();
}

#[test]
fn random_words_anywhere() {
    let mut rng = Rng(77);
    for round in 0..4000 {
        let count = rng.below(40) as usize;
        let (from, other) = (rng.below(4) as usize, rng.below(4) as usize);
        let mut words =
            |n: usize| -> Vec<u16> { (0..n).map(|_| rng.below(1 << 16) as u16).collect() };
        let (old, new) = (words(from + count), words(other + count));
        let alpha = (round % 256) as u8;
        for mix in [
            Mix::Filter(alpha),
            Mix::Half,
            Mix::Add(alpha),
            Mix::Subtract(alpha),
            Mix::Add(255),
            Mix::Subtract(255),
        ] {
            check::<Rgb565>(&old[from..], &new[other..], mix);
            check::<Rgb565Be>(&old[from..], &new[other..], mix);
            check::<Rgb565Le>(&old[from..], &new[other..], mix);
            // A pixel is the same wherever it lies in a span.
            let mut all = old[from..].to_vec();
            Rgb565::mix(&mut all, &new[other..], mix);
            for i in 0..count {
                let mut one = [old[from + i]];
                Rgb565::mix(&mut one, &[new[other + i]], mix);
                assert_eq!(one[0], all[i]);
            }
            let bytes = |w: &[u16]| -> Vec<[u8; 3]> {
                w.iter()
                    .map(|w| [(w >> 8) as u8, *w as u8, (w >> 4) as u8])
                    .collect()
            };
            check::<Rgb888>(&bytes(&old[from..]), &bytes(&new[other..]), mix);
        }
    }
}

#[test]
fn the_way_of_any_format_is_as_good() {
    for mix in [
        Mix::Filter(77),
        Mix::Half,
        Mix::Add(200),
        Mix::Subtract(200),
        Mix::Filter(0),
        Mix::Filter(255),
        Mix::Add(255),
    ] {
        for old in 0..=255u8 {
            for new in 0..=255u8 {
                let off = f64::from(mix.of_levels(old, new)) - exact(old, new, 255, mix);
                assert!(off.abs() <= 0.51, "{mix:?} {old} {new}: {off}");
            }
        }
    }
    // No word changes on the way to levels and back, which masks of channels rely on.
    for word in 0..=u16::MAX {
        assert_eq!(Rgb565::from_rgb8(Rgb565::to_rgb8(word)), word);
    }
}
