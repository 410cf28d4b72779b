//! LIRP against the circuit of the hardware model.

use super::Rng;
use crate::format::Format;
use crate::lirp::blend;
use scanbeam::pixel::{Rgb565, Rgb888};
use scanbeam_model::lirp as circuit;
use std::vec;

/// The multiply-add gives the bits of the circuit, at all pixels of a span. Dies without the top bit of w, and with a
/// first weight that is not rounded.
#[test]
fn the_blend_is_the_circuit() {
    fn of<F: Format, const N: u32>(rng: &mut Rng) {
        for _ in 0..2_000 {
            let ends = [(); 2].map(|()| [(); 3].map(|()| rng.below(65_536)));
            let longest = [30, 8191][rng.below(2) as usize];
            let n = 2 + rng.below(longest) as usize;
            let mut pixels = vec![F::Word::default(); n];
            blend::<F, N>(ends, &mut pixels, &mut || true);
            let ones = f64::from((1 << N) - 1);
            for (k, pixel) in pixels.iter().enumerate() {
                // W to nearest: all ones at the last pixel. What the step lacks for 2^-32 adds up on the way.
                let exact = k as f64 * ones / (n - 1) as f64 + 0.5;
                let lacking = k as f64 * f64::from(1 << N) / 4_294_967_296.0;
                let level = |w: u32, i: usize| {
                    let [a, b] = [0, 1].map(|end: usize| i64::from(ends[end][i]));
                    (circuit(a, b, w, N) >> (16 - F::WIDTH[i])) as u8
                };
                let pack = |w: f64| F::pack([0, 1, 2].map(|i| level(w as u32, i)));
                assert!(
                    *pixel == pack(exact) || *pixel == pack(exact - lacking),
                    "{N} bits, {n} pixels, at {k}: {ends:?}"
                );
            }
            let whole =
                |end: usize| F::pack([0, 1, 2].map(|i| (ends[end][i] >> (16 - F::WIDTH[i])) as u8));
            assert!(pixels[0] == whole(0) && pixels[n - 1] == whole(1));
        }
    }
    let mut rng = Rng(13);
    of::<Rgb888, 10>(&mut rng);
    of::<Rgb565, 12>(&mut rng);
    of::<Rgb888, 16>(&mut rng);
}
