//! Pixels of a span over those that are there (K11, H8, P5).

use super::Pixel;
use crate::composite::{Mix, mix_pair_565};
use crate::scene::{Blend, BlendMode, Factor, PixelAlpha};

/// The way that formats have for a mode, if there is one.
fn mix_of(mode: BlendMode) -> Option<Mix> {
    match mode {
        BlendMode::Filter(alpha) => Some(Mix::Filter(alpha)),
        BlendMode::Half => Some(Mix::Half),
        BlendMode::Add(alpha) => Some(Mix::Add(alpha)),
        BlendMode::Subtract(alpha) => Some(Mix::Subtract(alpha)),
        BlendMode::Replace | BlendMode::Factors { .. } => None,
    }
}

/// Blends pixels of 16 bits, two at a time, brought into the order of numbers and back.
#[inline(always)]
pub(super) fn mix_565(old: &mut [u16], new: &[u16], order: impl Fn(u32) -> u32, mix: Mix) {
    let both = |old: u32, new: u32| order(mix_pair_565(order(old), order(new), mix));
    let pair = |pair: &[u16]| u32::from(pair[0]) | u32::from(pair[1]) << 16;
    let count = old.len().min(new.len());
    let mut pairs = old[..count].chunks_exact_mut(2);
    let mut news = new[..count].chunks_exact(2);
    for (old, new) in pairs.by_ref().zip(news.by_ref()) {
        old.copy_from_slice(&super::halves(both(pair(old), pair(new))));
    }
    if let ([old], [new]) = (pairs.into_remainder(), news.remainder()) {
        *old = both(u32::from(*old), u32::from(*new)) as u16;
    }
}

/// Blends `new` pixels over `old` ones, as many as both have.
#[inline(never)]
pub(crate) fn blend<F: Pixel>(old: &mut [F::Word], new: &[F::Word], blend: Blend) {
    match mix_of(blend.mode) {
        Some(mix) if blend.channels == Blend::ALL => F::mix_few(old, new, mix),
        mix => {
            for (old, &new) in old.iter_mut().zip(new) {
                *old = single::<F>(*old, new, blend, mix);
            }
        }
    }
}

/// The same by alphas of pixels.
#[inline(never)]
pub(crate) fn blend_each<F: Pixel>(
    old: &mut [F::Word],
    new: &[F::Word],
    how: Blend,
    alphas: &[PixelAlpha],
) {
    let (mut rest, mut from) = (old, 0);
    for alike in alphas.chunk_by(PartialEq::eq) {
        let Some((old, more)) = rest.split_at_mut_checked(alike.len()) else {
            return;
        };
        let new = new.get(from..).unwrap_or_default();
        blend::<F>(old, new, how.by(alike[0]));
        (rest, from) = (more, from + alike.len());
    }
}

/// One pixel over another, by their levels; channels that are not written keep theirs.
fn single<F: Pixel>(old: F::Word, new: F::Word, blend: Blend, mix: Option<Mix>) -> F::Word {
    let mut word = [new];
    if let Some(mix) = mix {
        word = [old];
        F::mix_few(&mut word, &[new], mix);
    }
    let (o, mut n) = (F::to_rgb8(old), F::to_rgb8(word[0]));
    for (i, (&o, n)) in o.iter().zip(&mut n).enumerate() {
        if blend.channels >> i & 1 == 0 {
            *n = o;
        } else if let BlendMode::Factors {
            source,
            destination,
        } = blend.mode
        {
            *n = sum(*n, factor(source, o), o, factor(destination, o));
        }
    }
    F::from_rgb8(n)
}

/// A level times a factor and another times another, at most full.
fn sum(new: u8, source: u8, old: u8, destination: u8) -> u8 {
    let both = u32::from(new) * u32::from(source) + u32::from(old) * u32::from(destination);
    ((both + 127) / 255).min(255) as u8
}

/// A factor where `old` is the level that is there.
fn factor(factor: Factor, old: u8) -> u8 {
    match factor {
        Factor::Constant(value) => value,
        Factor::Destination => old,
        Factor::InverseDestination => 255 - old,
        // Where no pixel has an alpha of its own, all are opaque.
        Factor::SourceAlpha | Factor::TextureAlpha => 255,
        Factor::InverseSourceAlpha | Factor::InverseTextureAlpha => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::composite::PixelFormat;
    use crate::num::random::Rng;
    use crate::pixel::{Rgb565, Rgb565Be, Rgb565Le};
    use std::vec::Vec;

    /// Runs of any length and alignment, in every mode with every alpha.
    fn few_are_as_many<F: Pixel<Word = u16>>() {
        let mut rng = Rng(7);
        for alpha in 0..=255 {
            let mixes = [Mix::Filter, Mix::Add, Mix::Subtract].map(|mix| mix(alpha));
            for mix in mixes.into_iter().chain([Mix::Half]) {
                for _ in 0..40 {
                    let mut word = |_| rng.bits() as u16;
                    let old: Vec<u16> = (0..17).map(&mut word).collect();
                    let new: Vec<u16> = (0..17).map(&mut word).collect();
                    let (from, to) = (usize::from(old[0]) % 3, 3 + usize::from(new[0]) % 15);
                    let (mut few, mut many) = (old.clone(), old.clone());
                    F::mix_few(&mut few[from..to], &new[..to], mix);
                    <F as PixelFormat>::mix(&mut many[from..to], &new[..to], mix);
                    assert_eq!(few, many, "{mix:?} of {old:?} and {new:?}");
                }
            }
        }
    }

    #[test]
    fn the_small_loop_gives_the_bits_of_the_fast_ones() {
        few_are_as_many::<Rgb565>();
        few_are_as_many::<Rgb565Le>();
        few_are_as_many::<Rgb565Be>();
    }
}
