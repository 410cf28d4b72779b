//! Texture places along spans against f64.

use super::Rng;
use crate::bits::STRIDES;
use crate::perspective::{FRACTION, Homogeneous, PerspectiveSpan, Stride, Uv};
use std::{println, vec};

/// A span in real numbers: 1/w, u and v (texels) at the first and last pixel's centre.
struct Ends {
    q: [f64; 2],
    u: [f64; 2],
    v: [f64; 2],
    pixels: usize,
}

impl Ends {
    /// 1/w goes from 1 to `1 / ratio` or the other way.
    fn random(rng: &mut Rng, ratio: f64, texels: f64, pixels: usize) -> Self {
        let size = 0.5 + 0.499 * rng.unit();
        let mut q = [size, size / ratio];
        if rng.below(2) == 0 {
            q.reverse();
        }
        let [u, v] = [(); 2].map(|()| [rng.unit() * texels, rng.unit() * texels]);
        Self { q, u, v, pixels }
    }

    /// The true place at a pixel, in texels.
    fn place(&self, pixel: usize) -> [f64; 2] {
        let t = pixel as f64 / (self.pixels - 1).max(1) as f64;
        let line = |a: f64, b: f64| a + t * (b - a);
        let q = line(self.q[0], self.q[1]);
        [self.u, self.v].map(|x| line(x[0] * self.q[0], x[1] * self.q[1]) / q)
    }

    /// Values and steps rounded to nearest.
    fn span(&self) -> PerspectiveSpan {
        let n = (self.pixels - 1).max(1) as f64;
        let q = self.q.map(|q| q * 2f64.powi(31));
        let over = |x: [f64; 2]| [0, 1].map(|i| x[i] * q[i] / 1024.0);
        let of = |f: &dyn Fn([f64; 2]) -> f64| {
            let [q, s, t] = [q, over(self.u), over(self.v)].map(|x| f(x).round() as i32);
            Homogeneous { q, s, t }
        };
        PerspectiveSpan {
            at: of(&|x| x[0]),
            step: of(&|x| (x[1] - x[0]) / n),
        }
    }

    fn drawn(&self, stride: Stride) -> vec::Vec<Uv> {
        let mut places = vec![Uv::default(); self.pixels];
        self.span()
            .walk(stride, &mut places, |pixel, place| *pixel = place);
        places
    }
}

/// Dies without the Newton step, and with u/w in other units than v/w.
#[test]
fn exact_spans_choose_the_right_texel() {
    for ratio in [1.0, 2.0, 10.0, 100.0] {
        for pixels in [2, 5, 16, 33, 208, 512, 1024] {
            let mut rng = Rng(pixels as u64 + ratio as u64);
            let (mut wrong, mut all) = (0u32, 0u32);
            for _ in 0..(100_000 / pixels).max(200) {
                let ends = Ends::random(&mut rng, ratio, 1024.0, pixels);
                for (i, place) in ends.drawn(Stride::One).iter().enumerate() {
                    let want = ends.place(i).map(|x| x.floor() as i32);
                    let far = [place.u >> FRACTION, place.v >> FRACTION];
                    let far = (far[0] - want[0]).abs().max((far[1] - want[1]).abs());
                    assert!(far <= 1, "1:{ratio}, {pixels} pixels: {far} texels");
                    wrong += far as u32;
                    all += 1;
                }
            }
            let wrong = f64::from(wrong) * 100.0 / f64::from(all);
            println!("1:{ratio} {pixels} px, 1024 texels: {wrong:.4} % wrong");
            assert!(wrong <= 0.3, "1:{ratio}, {pixels} pixels: {wrong} %");
        }
    }
}

/// H5: ends are exact, the pixel between two is their average, and runs are straight. Dies where a run's step is that of
/// the next, and where the rest of a span is taken for a whole run.
#[test]
fn ends_are_exact_and_between_divisions_the_way_is_straight() {
    let mut rng = Rng(1);
    for pixels in 1..80usize {
        for _ in 0..20 {
            let ends = Ends::random(&mut rng, 3.0, 200.0, pixels);
            let exact = ends.drawn(Stride::One);
            for (stride, n) in STRIDES.into_iter().zip([1, 2, 4, 8, 16, pixels]) {
                let drawn = ends.drawn(stride);
                assert_eq!(drawn[0], exact[0], "{stride:?}");
                for (k, place) in drawn.iter().enumerate() {
                    let from = k - k % n;
                    let to = (from + n).min(pixels - 1);
                    let (of, way) = ((k - from) as f64, (to - from).max(1) as f64);
                    // Steps are cut off, by a unit of 2^-18 texel at most.
                    for axis in [|p: &Uv| p.u, |p: &Uv| p.v] {
                        let [a, b] = [from, to].map(|i| f64::from(axis(&exact[i])));
                        let off = f64::from(axis(place)) - (a + (b - a) * of / way);
                        assert!(off.abs() <= 2.0 * of + 1.0, "{stride:?}: {off}");
                    }
                }
            }
        }
    }
}
