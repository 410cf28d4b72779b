//! Every method against the colours that it stands for.

use super::Rng;
use crate::bits::METHODS;
use crate::colours::Colours;
use crate::format::{FRACTION, Format};
use crate::method::Method;
use crate::paint::paint;
use scanbeam::pixel::{Rgb565, Rgb888};
use std::vec::Vec;
use std::{println, vec};

/// Colours of a format along so many pixels, as near to either end of their range as there are.
pub(super) fn random<F: Format>(rng: &mut Rng) -> (Colours, usize) {
    let longest = [4, 20, 64, 8192][rng.below(4) as usize];
    let pixels = 1 + rng.below(longest);
    let mut colours = Colours {
        at: [0; 3],
        step: [0; 3],
    };
    for i in 0..3 {
        let range = u32::from(F::STEPS[i]) << FRACTION;
        let from = rng.below(range + 1);
        let reach = [range, range / 64, 0][rng.below(3) as usize];
        let to = (from.saturating_sub(reach) + rng.below(2 * reach + 1)).min(range);
        colours.at[i] = from as i32 + (1 << (FRACTION - 1));
        colours.step[i] = (to as i32 - from as i32) / (pixels as i32 - 1).max(1);
    }
    (colours, pixels as usize)
}

/// What a method may be off, in units of 2^-16 of a channel's range.
pub(super) fn bound<F: Format>(method: Method, colours: &Colours, pixels: usize) -> f64 {
    let (unit, drift) = (f64::from(F::PACKING.unit), f64::from(F::PACKING.drift));
    let slope = (0..3).fold(0.0f64, |most, i| {
        let below = 2f64.powi((F::WIDTH[i] + FRACTION) as i32 - 16);
        most.max(f64::from(colours.step[i].abs()) / below)
    });
    let after = (pixels - 1) as f64;
    let rise = slope * after;
    // The middle may lie half a unit between two.
    match method {
        Method::Plane | Method::Within(_) => 0.0,
        Method::Packed8 => unit + after.min(7.0) * drift,
        Method::Packed16 => unit + after.min(15.0) * drift,
        Method::Half => (slope / 2.0).ceil() + unit + 3.0 * drift,
        Method::Quarter => (slope * 1.5).ceil() + unit + 3.0 * drift,
        Method::Whole => (rise / 2.0).ceil(),
        Method::Lirp(bits) => 1.0 + rise / f64::from(1 << bits),
        Method::LirpPacked => 256.0 + rise / 256.0,
    }
}

/// How far a pixel is off, beyond the rounding of the format, in the same units.
fn off<F: Format>(word: F::Word, colours: &Colours, pixel: usize) -> f64 {
    let shown = F::to_rgb8(word);
    (0..3).fold(0.0, |most, i| {
        let step = (f64::from(shown[i]) * f64::from(F::STEPS[i]) / 255.0).round();
        let exact = f64::from(colours.at[i]) + f64::from(colours.step[i]) * pixel as f64;
        let exact = exact / f64::from(1 << FRACTION) - 0.5;
        let off = (step - exact).abs() - 0.5;
        most.max(off * 65_536.0 / f64::from(1u32 << F::WIDTH[i]))
    })
}

fn keeps_its_bound<F: Format>(rng: &mut Rng, method: Method) {
    let mut worst = 0.0f64;
    for _ in 0..4_000 {
        let (colours, n) = random::<F>(rng);
        let chosen = method.of_span(n as u32, || colours.slope::<F>(), F::PACKING);
        let bound = bound::<F>(chosen, &colours, n);
        let mut all = vec![F::Word::default(); n];
        paint::<F>(method, &colours, &mut all, &mut || true);
        for (k, word) in all.iter().enumerate() {
            let off = off::<F>(*word, &colours, k);
            worst = worst.max(off);
            assert!(
                off <= bound,
                "{method:?} at {k}: {off} of {bound}, {colours:?}"
            );
        }
        // Hidden pixels stay as they were, seen ones do not change by it.
        let mask: Vec<bool> = (0..n).map(|_| rng.below(3) > 0).collect();
        let other = F::from_rgb8([1, 254, 77]);
        let mut some = vec![other; n];
        let mut seen = mask.iter();
        paint::<F>(method, &colours, &mut some, &mut || *seen.next().unwrap());
        for k in 0..n {
            let want = if mask[k] { all[k] } else { other };
            assert!(some[k] == want, "{method:?} {colours:?}");
        }
    }
    println!("{method:?}: {worst:.1} units of 2^-16");
}

/// Dies where a run is anchored half a pixel off, where steps are cut and not rounded, where the last group has the
/// middle of a whole one, and where `seen` is asked twice or not at all.
#[test]
fn every_method_keeps_its_bound_and_hides_what_is_hidden() {
    let mut rng = Rng(11);
    for method in METHODS {
        keeps_its_bound::<Rgb888>(&mut rng, method);
        keeps_its_bound::<Rgb565>(&mut rng, method);
    }
}

/// Nothing is drawn of nothing.
#[test]
fn a_span_may_be_empty() {
    let colours = Colours {
        at: [1 << 22; 3],
        step: [1 << 12; 3],
    };
    for method in METHODS {
        paint::<Rgb565>(method, &colours, &mut [], &mut || unreachable!());
    }
}
