//! Pixels of a span over those that are there (K11, H8, P5).

use super::{Mix, PixelFormat};
use crate::num::of_255;
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

/// Blends `new` pixels over `old` ones, as many as both have.
#[inline(never)]
pub(crate) fn blend<F: PixelFormat>(old: &mut [F::Word], new: &[F::Word], blend: Blend) {
    match mix_of(blend.mode) {
        Some(Mix::Filter(0) | Mix::Add(0) | Mix::Subtract(0)) => {}
        Some(mix) if blend.channels == Blend::ALL => F::mix(old, new, mix),
        mix => by_levels::<F>(old, new, blend, mix),
    }
}

/// The same by alphas of pixels.
#[inline(never)]
pub(crate) fn blend_each<F: PixelFormat>(
    old: &mut [F::Word],
    new: &[F::Word],
    how: Blend,
    alphas: &[PixelAlpha],
) {
    let mix = mix_of(how.mode).filter(|_| how.channels == Blend::ALL);
    let Some(mix @ (Mix::Filter(own) | Mix::Add(own) | Mix::Subtract(own))) = mix else {
        return blend_runs::<F>(old, new, how, alphas);
    };
    // Pixel by pixel, as `Blend::by` says: few follow each other with the same alpha.
    for ((old, &new), alpha) in old.iter_mut().zip(new).zip(alphas) {
        let level = alpha.times(own);
        let mix = match mix {
            Mix::Filter(_) if !alpha.texel().is_added() => Mix::Filter(level),
            Mix::Subtract(_) if !alpha.texel().is_added() => Mix::Subtract(level),
            _ => Mix::Add(level),
        };
        if level != 0 {
            *old = F::mix_one(*old, new, mix);
        }
    }
}

/// In runs of equal alphas.
#[inline(always)]
fn blend_runs<F: PixelFormat>(
    old: &mut [F::Word],
    new: &[F::Word],
    how: Blend,
    alphas: &[PixelAlpha],
) {
    let mut from = 0;
    while let Some([alpha, more @ ..]) = alphas.get(from..) {
        let end = from + 1 + more.iter().take_while(|other| *other == alpha).count();
        let (Some(old), Some(new)) = (old.get_mut(from..end), new.get(from..)) else {
            return;
        };
        blend::<F>(old, new, how.by(*alpha));
        from = end;
    }
}

/// Blends in a way that formats have none for, by levels; channels that are not written keep theirs.
#[inline(never)]
fn by_levels<F: PixelFormat>(old: &mut [F::Word], new: &[F::Word], blend: Blend, mix: Option<Mix>) {
    let factors = match blend.mode {
        BlendMode::Factors {
            source,
            destination,
        } => [source, destination],
        _ => [Factor::ONE, Factor::ZERO],
    };
    let factors = factors.map(linear);
    for (old, &new) in old.iter_mut().zip(new) {
        let word = mix.map_or(new, |mix| F::mix_one(*old, new, mix));
        let (o, mut n) = (F::to_rgb8(*old), F::to_rgb8(word));
        for (i, (&o, n)) in o.iter().zip(&mut n).enumerate() {
            if blend.channels >> i & 1 == 0 {
                *n = o;
            } else if mix.is_none() {
                let [source, destination] =
                    factors.map(|[at_0, slope]| slope.wrapping_mul(o.into()).wrapping_add(at_0));
                let sum = u32::from(*n) * source + u32::from(o) * destination;
                *n = of_255(sum).min(255) as u8;
            }
        }
        *old = F::from_rgb8(n);
    }
}

/// A factor, which is linear in the level that is there, 255 for 1: what it is where that is 0, and its slope.
fn linear(factor: Factor) -> [u32; 2] {
    match factor {
        Factor::Constant(value) => [value.into(), 0],
        Factor::Destination => [0, 1],
        Factor::InverseDestination => [255, u32::MAX],
        // Where no pixel has an alpha of its own, all are opaque.
        Factor::SourceAlpha | Factor::TextureAlpha => [255, 0],
        Factor::InverseSourceAlpha | Factor::InverseTextureAlpha => [0, 0],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::random::Rng;
    use crate::pixel::{PixelFormat, Rgb565, Rgb565Be};

    /// Kills: fields that borrow from each other, parts of 31, a sum that wraps, light taken from the wrong one.
    #[test]
    fn one_pixel_is_mixed_as_many_are() {
        let mut rng = Rng(10);
        for _ in 0..40_000 {
            let alpha = rng.below(256) as u8;
            let mix = match rng.below(4) {
                0 => Mix::Filter(alpha),
                1 => Mix::Half,
                2 => Mix::Add(alpha),
                _ => Mix::Subtract(alpha),
            };
            let [old, new] = [(); 2].map(|()| rng.below(1 << 16) as u16);
            let mut words = [old; 2];
            Rgb565::mix(&mut words, &[new; 2], mix);
            assert_eq!(words, [Rgb565::mix_one(old, new, mix); 2], "{mix:?}");
            let swapped = Rgb565Be::mix_one(old.to_be(), new.to_be(), mix);
            assert_eq!(u16::from_be(swapped), words[0], "{mix:?}");
        }
    }

    /// Killed by: a factor of the other colour, a sum that is not held at full, a channel mask whose bits are swapped.
    #[test]
    fn factors_and_write_masks() {
        let mut rng = Rng(9);
        let factors = [
            Factor::ZERO,
            Factor::ONE,
            Factor::Constant(100),
            Factor::Destination,
            Factor::InverseDestination,
            Factor::SourceAlpha,
            Factor::InverseTextureAlpha,
        ];
        let value = |factor: Factor, old: f64| match factor {
            Factor::Constant(c) => f64::from(c) / 255.0,
            Factor::Destination => old,
            Factor::InverseDestination => 1.0 - old,
            Factor::SourceAlpha | Factor::TextureAlpha => 1.0,
            Factor::InverseSourceAlpha | Factor::InverseTextureAlpha => 0.0,
        };
        let steps = |word: u16| [word >> 11, word >> 5 & 63, word & 31].map(f64::from);
        let pairs = factors.iter().flat_map(|&s| factors.map(|d| (s, d)));
        for (source, destination) in pairs {
            for _ in 0..400 {
                let how = Blend {
                    mode: BlendMode::Factors {
                        source,
                        destination,
                    },
                    channels: rng.below(8) as u8,
                };
                let (old, new) = (rng.below(1 << 16) as u16, rng.below(1 << 16) as u16);
                let mut word = [old];
                blend::<Rgb565>(&mut word, &[new], how);
                let (g, o, n) = (steps(word[0]), steps(old), steps(new));
                for i in 0..3 {
                    let full = f64::from(Rgb565::STEPS[i]);
                    let at = o[i] / full;
                    let want = if how.channels >> i & 1 == 0 {
                        o[i]
                    } else {
                        (n[i] * value(source, at) + o[i] * value(destination, at)).min(full)
                    };
                    assert!((g[i] - want).abs() <= 1.5, "{how:?}: {o:?} {n:?} {g:?}");
                    assert!(how.channels >> i & 1 == 1 || g[i] == o[i]);
                }
            }
        }
    }
}
