//! Which pixels of a span have exact places (H4, H5), against f64.

use super::super::perspective::{Perspective, Within};
use super::{WRAPS, coordinates, off, some_span, truth};
use crate::num::random::Rng;
use crate::scene::{Texture, Wrap};

/// What a place of fixed point is off by, for places so far from the base.
fn fixed_point(span: &Perspective, at: [f64; 2]) -> f64 {
    let far = |axis: usize| (at[axis] - f64::from(span.base[axis])).abs();
    far(0).max(far(1)) / 32_768.0 + 0.0025
}

/// How far a pixel's texel is from a place.
fn off_place(texel: u16, [u, v]: [f64; 2], wrap: Wrap) -> f64 {
    off(u, texel, wrap).max(off(v, texel >> 8, wrap))
}

/// Ends, and every pixel of a stride, have the places of exact perspective; what is between two exact ones is their mean.
///
/// Kills: a last piece that ends a pixel early, a piece that begins at the pixel behind the exact one, odd pixels
/// with the place of the one before.
#[test]
fn ends_and_strides_are_exact_and_what_is_between_is_the_mean() {
    let words = coordinates();
    let square = Texture::words(&words, 256, 256).unwrap();
    let mut rng = Rng(41);
    let mut means = 0;
    for i in 0..20_000 {
        let mut run = std::vec![0; 1 + rng.below(80) as usize];
        let (span, log, wrap) = (
            some_span(&mut rng, run.len()),
            i as u32 % 5,
            WRAPS[i / 5 % 3],
        );
        let texture = square.wrapping(wrap);
        let within = Within::whole(&run);
        span.draw(&mut run, within, &texture, log);
        let (last, each) = (run.len() - 1, 1 << log);
        for (x, &texel) in run.iter().enumerate() {
            let at = truth(&span, x);
            let is_exact = x == last || x % each == 0;
            if is_exact {
                let off = off_place(texel, at, wrap);
                let most = fixed_point(&span, at);
                assert!(off <= most, "{x} of {}, {log}: {off}", run.len());
            }
            // What does not repeat has exact places where others have every 2nd.
            if log == 1 && wrap == Wrap::Repeat && !is_exact {
                let [a, b] = [truth(&span, x - 1), truth(&span, x + 1)];
                let mean = [0, 1].map(|axis| f64::midpoint(a[axis], b[axis]));
                let most = fixed_point(&span, a).max(fixed_point(&span, b));
                // The last piece of a span of an odd number of steps is exact.
                if x < last / 2 * 2 {
                    means += 1;
                    assert!(off_place(texel, mean, wrap) <= most, "{x}: {span:?}");
                }
            }
        }
    }
    assert!(means > 20_000, "{means}");
}

/// Short spans of squares are straight or an arc between both ends, which are off by what one word a place is.
///
/// Kills: steps of one pixel more than there are, an arc whose step is not taken back by half its turns.
#[test]
fn ends_of_short_spans_are_exact_to_what_a_word_holds() {
    let words = coordinates();
    let texture = Texture::words(&words, 256, 256).unwrap();
    let square = texture.square().unwrap();
    let mut rng = Rng(42);
    for i in 0..20_000 {
        let is_arc = i % 2 == 0;
        // As many as the reach may be on sides of 256 texels.
        let most_pixels = if is_arc { 19 } else { 17 };
        let mut run = std::vec![0; 1 + rng.below(most_pixels) as usize];
        let span = some_span(&mut rng, run.len());
        let within = Within::whole(&run);
        let reserve = if is_arc {
            span.arc(&mut run, within, square);
            0.125
        } else {
            span.between(&mut run, within, square);
            0.0625
        };
        for x in [0, run.len() - 1] {
            let at = truth(&span, x);
            let (off, most) = (off_place(run[x], at, Wrap::Repeat), fixed_point(&span, at));
            assert!(off <= most + reserve, "{x} of {}: {off}", run.len());
        }
    }
}
