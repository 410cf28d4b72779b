//! Pixels of a span over those that are there (K11, H8, P5).

use crate::composite::{Mix, PixelFormat};
use crate::scene::{Blend, BlendMode, Factor};

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
        Some(mix) if blend.channels == Blend::ALL => F::mix(old, new, mix),
        mix => {
            for (old, &new) in old.iter_mut().zip(new) {
                *old = single::<F>(*old, new, blend, mix);
            }
        }
    }
}

/// One pixel over another, by their levels; channels that are not written keep theirs.
fn single<F: PixelFormat>(old: F::Word, new: F::Word, blend: Blend, mix: Option<Mix>) -> F::Word {
    let mut word = [new];
    if let Some(mix) = mix {
        word = [old];
        F::mix(&mut word, &[new], mix);
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
    }
}
