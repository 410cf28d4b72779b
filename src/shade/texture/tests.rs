//! Spans against f64, which shares no arithmetic: texels chosen, budgets kept, levels and filters.

mod samples;

use super::*;
use crate::num::random::Rng;
use std::vec;
use std::vec::Vec;

/// A span in real numbers: 1/w, u and v (texels) at the first and last pixel's centre.
#[derive(Clone, Copy, Debug)]
struct Ends {
    q: [f64; 2],
    u: [f64; 2],
    v: [f64; 2],
    pixels: usize,
}

impl Ends {
    /// 1/w goes from 1 to `1 / ratio` or the other way.
    fn random(rng: &mut Rng, ratio: f64, texels: f64, pixels: usize) -> Self {
        let mut q = [1.0, 1.0 / ratio];
        if rng.below(2) == 0 {
            q.reverse();
        }
        // The nearest corner is anywhere in the exponent's octave.
        let size = 0.5 + 0.499 * rng.unit();
        let mut pair = || [rng.unit() * texels, rng.unit() * texels];
        let (u, v) = (pair(), pair());
        Self {
            q: q.map(|q| q * size),
            u,
            v,
            pixels,
        }
    }

    /// The true place at a pixel, in texels.
    fn place(&self, pixel: usize) -> (f64, f64) {
        let t = pixel as f64 / (self.pixels - 1).max(1) as f64;
        let line = |a: f64, b: f64| a + t * (b - a);
        let q = line(self.q[0], self.q[1]);
        let at = |x: [f64; 2]| line(x[0] * self.q[0], x[1] * self.q[1]) / q;
        (at(self.u), at(self.v))
    }

    /// As a set-up would make it: values and steps rounded to nearest.
    fn span(&self) -> PerspectiveSpan {
        let n = (self.pixels - 1).max(1) as f64;
        let q = |i: usize| self.q[i] * 2f64.powi(31);
        let over = |x: [f64; 2], i: usize| x[i] * q(i) / 1024.0;
        let round = |x: f64| x.round() as i32;
        PerspectiveSpan {
            at: Homogeneous {
                q: round(q(0)),
                s: round(over(self.u, 0)),
                t: round(over(self.v, 0)),
            },
            step: Homogeneous {
                q: round((q(1) - q(0)) / n),
                s: round((over(self.u, 1) - over(self.u, 0)) / n),
                t: round((over(self.v, 1) - over(self.v, 0)) / n),
            },
        }
    }

    /// The places that a way of drawing gives to all pixels.
    fn drawn(&self, stride: Stride) -> Vec<Uv> {
        let mut places = vec![Uv::default(); self.pixels];
        self.span()
            .draw(stride, &Places, &mut places, |pixel, place| *pixel = place);
        places
    }

    /// The largest distance of any pixel's place from the true one, texels.
    fn error(&self, places: &[Uv]) -> f64 {
        let mut worst = 0f64;
        for (i, place) in places.iter().enumerate() {
            let (u, v) = self.place(i);
            let off =
                |got: i32, want: f64| (f64::from(got) / f64::from(1 << FRACTION) - want).abs();
            worst = worst.max(off(place.u, u)).max(off(place.v, v));
        }
        worst
    }
}

/// A texture whose texel is its place.
struct Places;

impl Texels for Places {
    type Texel = Uv;

    fn at(&self, place: Uv) -> Uv {
        place
    }
}

/// Wrong texels of all pixels, in per cent, and the farthest of them.
fn wrong_texels(ratio: f64, pixels: usize, texels: f64) -> (f64, i32) {
    let mut rng = Rng(pixels as u64 + ratio as u64);
    let (mut wrong, mut all, mut farthest) = (0u32, 0u32, 0);
    for _ in 0..(200_000 / pixels).max(200) {
        let ends = Ends::random(&mut rng, ratio, texels, pixels);
        for (i, place) in ends.drawn(Stride::One).iter().enumerate() {
            let (u, v) = ends.place(i);
            let (x, y) = place.texel();
            let far = (x - u.floor() as i32)
                .abs()
                .max((y - v.floor() as i32).abs());
            wrong += u32::from(far > 0);
            all += 1;
            farthest = farthest.max(far);
        }
    }
    (f64::from(wrong) * 100.0 / f64::from(all), farthest)
}

#[test]
fn exact_spans_choose_the_right_texel() {
    for ratio in [1.0, 2.0, 10.0, 100.0] {
        for pixels in [2, 5, 16, 33, 208, 512, 1024] {
            let (wrong, farthest) = wrong_texels(ratio, pixels, 1024.0);
            std::println!("1:{ratio} {pixels} px, 1024 texels: {wrong:.4} % wrong");
            assert!(wrong <= 0.3, "1:{ratio}, {pixels} pixels: {wrong} %");
            assert!(
                farthest <= 1,
                "1:{ratio}, {pixels} pixels: {farthest} texels"
            );
        }
    }
}

#[test]
fn first_and_last_pixel_are_exact_in_every_way() {
    let mut rng = Rng(1);
    for pixels in 1..80 {
        for _ in 0..20 {
            let ends = Ends::random(&mut rng, 3.0, 200.0, pixels);
            let exact = ends.drawn(Stride::One);
            for stride in Stride::ALL {
                let drawn = ends.drawn(stride);
                assert_eq!(drawn[0], exact[0], "{stride:?}");
                // A run's last pixel is reached by its steps, which are rounded down: 2^-18 texel.
                let miss = exact[pixels - 1].minus(drawn[pixels - 1]);
                let most = 2 * i32::try_from(pixels).unwrap();
                assert!(
                    miss.u.abs().max(miss.v.abs()) <= most,
                    "{stride:?}: {miss:?}"
                );
            }
            // Every 2nd pixel is exact, and the last one.
            let drawn = ends.drawn(Stride::Two);
            for i in (0..pixels).step_by(2) {
                let miss = exact[i].minus(drawn[i]);
                assert!(miss.u.abs().max(miss.v.abs()) <= 2, "pixel {i} of {pixels}");
            }
            for i in (1..pixels.saturating_sub(1)).step_by(2) {
                let (a, b) = (exact[i - 1], exact[i + 1]);
                let mean = |a: i32, b: i32| (i64::from(a) + i64::from(b)).div_euclid(2) as i32;
                assert!(
                    (drawn[i].u - mean(a.u, b.u)).abs() <= 2,
                    "pixel {i} of {pixels}"
                );
                assert!(
                    (drawn[i].v - mean(a.v, b.v)).abs() <= 2,
                    "pixel {i} of {pixels}"
                );
            }
        }
    }
}

/// The bound keeps, in places and in texels of the packed loop, for random spans of all kinds.
#[test]
fn budgets_are_kept() {
    let identity: Vec<u16> = (0..=u16::MAX).collect();
    let size = Size::new(256, 256).unwrap();
    let texture = Texture::<_, Wrap>::new(Words(&identity), size).unwrap();
    let square = texture.square::<8, 65_536>().unwrap();
    for quality in [Quality::Fast, Quality::Balanced] {
        let budget = quality.budget();
        let most = f64::from(budget.units()) / f64::from(1 << FRACTION);
        let mut rng = Rng(8);
        let mut used = [0u32; 6];
        let mut worst = 0f64;
        let mut nearest = 1f64;
        for i in 0..40_000u32 {
            let ratio = [1.0, 1.02, 1.2, 2.0, 10.0, 100.0][(i % 6) as usize];
            let pixels = 1 + rng.below([6, 40, 330, 1024][(i / 6 % 4) as usize]) as usize;
            let texels = [4.0, 32.0, 256.0][(i / 24 % 3) as usize];
            let ends = Ends::random(&mut rng, ratio, texels, pixels);
            let span = ends.span();
            let stride = budget.stride(&span, pixels);
            used[Stride::ALL.iter().position(|s| *s == stride).unwrap()] += 1;
            let error = ends.error(&ends.drawn(stride));
            assert!(error <= most, "{quality:?} {stride:?} {ends:?}: {error}");
            worst = worst.max(error);
            let mut indices = vec![0u16; pixels];
            span.draw(stride, &square, &mut indices, |pixel, texel| *pixel = texel);
            for (pixel, index) in indices.iter().enumerate() {
                let (u, v) = ends.place(pixel);
                let off = |texel: u16, place: f64| {
                    // From the place to the texel's square, on a side that repeats.
                    let d = (place - f64::from(texel)).rem_euclid(256.0);
                    if d < 1.0 {
                        0.0
                    } else {
                        (d - 1.0).min(256.0 - d)
                    }
                };
                let off = off(index & 255, u).max(off(index >> 8, v));
                assert!(off <= most, "{quality:?} {stride:?} {ends:?}: {off} texels");
            }
            // The next cheaper way would have done: how often the bound is too careful.
            if let Some(next) = Stride::ALL.iter().skip_while(|s| **s != stride).nth(1) {
                nearest = nearest.min(ends.error(&ends.drawn(*next)) / most);
            }
        }
        std::println!(
            "{quality:?}: worst {worst:.4} texel of {most}; strides 1, 2, 4, 8, 16, affine: {used:?}"
        );
        assert!(used.iter().all(|n| *n > 100), "{used:?}");
        assert!(
            worst > 0.5 * most,
            "{worst} of {most}: the bound is far too careful"
        );
    }
    let ends = Ends::random(&mut Rng(4), 50.0, 256.0, 100);
    assert_eq!(
        Quality::Exact.budget().stride(&ends.span(), 100),
        Stride::One
    );
    // 1/w constant, and spans of one pixel.
    let flat = Ends::random(&mut Rng(4), 1.0, 256.0, 100);
    assert_eq!(
        Quality::Fast.budget().stride(&flat.span(), 100),
        Stride::Affine
    );
    assert_eq!(Quality::Fast.budget().stride(&ends.span(), 1), Stride::One);
}

/// 16 bits of a place lose less than a 16th of a texel, however long the run is.
#[test]
fn packed_runs_stay_within_a_sixteenth() {
    fn check<const LOG: u32, const N: usize>() {
        let identity: Vec<u32> = (0..N as u32).collect();
        let side = 1u32 << LOG;
        let size = Size::new(side, side).unwrap();
        let texture = Texture::<_, Wrap>::new(Words(&identity), size).unwrap();
        let square = texture.square::<LOG, N>().unwrap();
        let mut rng = Rng(LOG.into());
        for i in 0..20_000 {
            let mut place = |bits: u32| Uv {
                u: rng.below(1 << bits) as i32 - (1 << (bits - 1)),
                v: rng.below(1 << bits) as i32 - (1 << (bits - 1)),
            };
            let (from, step) = (place(30), place(18 + i % 6));
            let pixels = 1 + rng.below(330) as usize;
            let mut drawn = vec![0; pixels];
            square.run(&mut drawn, from, step, |pixel, texel| *pixel = texel);
            for (i, index) in drawn.iter().enumerate() {
                let one = f64::from(1 << FRACTION);
                let off = |from: i32, step: i32, texel: u32| {
                    let true_place = (f64::from(from) + i as f64 * f64::from(step)) / one;
                    let d = (true_place - f64::from(texel)).rem_euclid(f64::from(side));
                    if d < 1.0 {
                        0.0
                    } else {
                        (d - 1.0).min(f64::from(side) - d)
                    }
                };
                let off = off(from.u, step.u, index % side).max(off(from.v, step.v, index / side));
                assert!(off < 1.0 / 16.0, "{LOG}: {off}");
            }
        }
    }
    check::<2, 16>();
    check::<5, 1024>();
    check::<6, 4096>();
    check::<7, 16_384>();
    check::<8, 65_536>();
}

/// Corners at any distance and with any repeats give the same places as real division.
#[test]
fn corners_share_an_exponent() {
    let mut rng = Rng(6);
    let mut straight = 0;
    for i in 0..60_000 {
        let far = f64::from(1u32 << (i % 24));
        let ratio = [1.001, 1.1, 3.0, 60.0][i / 24 % 4];
        let wide = [60.0f64, 1000.0, 4000.0][i / 96 % 3];
        let base = (rng.unit() - 0.5) * 100_000.0;
        let corners = [(); 3].map(|()| Corner {
            depth: ((0.999 / far / (1.0 + (ratio - 1.0) * rng.unit())) * 2f64.powi(31)) as u32,
            u: ((base + rng.unit() * (wide - 200.0).max(50.0)) * 256.0) as i32,
            v: (rng.unit() * 50.0 * 256.0) as i32,
        });
        if corners.iter().any(|c| c.depth == 0) {
            continue;
        }
        let Some(made) = Corners::new(corners, Period::Short) else {
            panic!("{corners:?}");
        };
        let most = made
            .at
            .iter()
            .map(|at| at.q.max(at.s.abs()).max(at.t.abs()));
        assert!(most.max().unwrap() >= 1 << 29, "{made:?}");
        // The texture's repeats cancel.
        for (corner, at) in corners.iter().zip(made.at) {
            let place = at.place();
            let off = f64::from(place.u) / f64::from(1 << FRACTION) - f64::from(corner.u) / 256.0;
            let off = off - (off / 128.0).round() * 128.0;
            assert!(off.abs() < 0.02, "{corners:?} {off}");
        }
        let budget = Budget::texels(1, 4);
        if !made.straight(budget) {
            continue;
        }
        straight += 1;
        for _ in 0..20 {
            let (a, b) = (rng.unit(), rng.unit());
            let (a, b) = if a + b > 1.0 {
                (1.0 - a, 1.0 - b)
            } else {
                (a, b)
            };
            let weights = [1.0 - a - b, a, b];
            let q = [0, 1, 2].map(|i| f64::from(corners[i].depth));
            let u = [0, 1, 2].map(|i| f64::from(corners[i].u) / 256.0);
            let sum = |f: &dyn Fn(usize) -> f64| (0..3).map(f).sum::<f64>();
            let linear = sum(&|i| weights[i] * u[i]);
            let true_u = sum(&|i| weights[i] * u[i] * q[i]) / sum(&|i| weights[i] * q[i]);
            assert!((linear - true_u).abs() <= 0.25, "{corners:?}");
        }
    }
    assert!(straight > 5_000, "{straight}");
    let corner = |depth, u| Corner { depth, u, v: 0 };
    let three = |d, u| {
        Corners::new(
            [corner(d, 0), corner(1 << 31, u), corner(1 << 31, 9)],
            Period::Short,
        )
    };
    assert_eq!(three(0, 5), None);
    assert_eq!(three((1 << 31) + 1, 5), None);
    assert_eq!(three(1, 4097 << 8), None);
    assert!(three(1, i32::MIN).is_none() && three(1, 5).is_some());
}
