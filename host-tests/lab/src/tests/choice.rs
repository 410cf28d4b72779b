//! What is chosen by a budget.

use super::Rng;
use super::methods::{bound, random};
use crate::format::{Format, Precision};
use crate::method::Method;
use scanbeam::pixel::Rgb565;

/// Dies where a bound is taken for half of itself, and where a budget's levels are worth 256 units.
#[test]
fn what_is_chosen_keeps_its_budget() {
    let mut rng = Rng(12);
    let mut loose = 0;
    for _ in 0..200_000 {
        let (colours, pixels) = random::<Rgb565>(&mut rng);
        let levels = rng.below(2000) as u16;
        let slope = || colours.slope::<Rgb565>();
        let method = Method::Within(levels).of_span(pixels as u32, slope, Rgb565::PACKING);
        let most = bound::<Rgb565>(method, &colours, pixels) / 65536.0 * 32.0 * 255.0 / 31.0;
        // Planes add nothing to the rounding.
        let exact = method == Method::Plane;
        assert!(
            exact || most <= f64::from(levels) / 256.0,
            "{method:?} {most} {levels}"
        );
        loose += u32::from(!exact);
    }
    assert!(loose > 100_000);
}

/// From cheap to dear, by what they cost a pixel.
const RANKS: [Method; 6] = [
    Method::Whole,
    Method::Quarter,
    Method::Packed16,
    Method::Packed8,
    Method::Half,
    Method::Plane,
];

#[test]
fn a_looser_budget_never_takes_a_dearer_method() {
    let mut taken = [0; 6];
    for (unit, drift) in [(0, 0), (1, 1), (64, 32)] {
        let packing = Precision { unit, drift };
        for pixels in [1, 2, 3, 7, 8, 9, 15, 16, 17, 64, 319, 8192] {
            for slope in [0, 1, 5, 30, 60, 150, 200, 248, 400, 2000, 30_000u32] {
                if pixels > 2 && u64::from(slope) * u64::from(pixels - 1) > 1 << 16 {
                    continue;
                }
                let mut last = RANKS.len();
                for levels in 0..2048 {
                    let method = Method::Within(levels).of_span(pixels, || slope, packing);
                    let now = RANKS.iter().position(|rank| *rank == method).unwrap();
                    assert!(now <= last, "{levels} {pixels} {slope} {packing:?}");
                    last = now;
                    taken[now] += 1;
                }
            }
        }
    }
    assert!(taken.iter().all(|&count| count > 100), "{taken:?}");
}

#[test]
fn exact_is_exact() {
    let of = |pixels, slope| Method::EXACT.of_span(pixels, || slope, Rgb565::PACKING);
    assert_eq!(
        [of(40, 1), of(40, 0), of(1, 9)],
        [Method::Plane, Method::Whole, Method::Plane]
    );
}
