//! Blends of 8 bits a channel, four channels in a register. Channels are all alike, so where
//! pixels begin does not matter.

use super::Mix;
use super::mix::half;

const LOW: u32 = 0x0101_0101;
const HIGH: u32 = 0x8080_8080;
/// Every other byte.
const ODD: u32 = 0x00FF_00FF;

/// Alpha of 255 as one of 256: exact at both ends.
const fn of_256(alpha: u8) -> u32 {
    alpha as u32 + (alpha as u32 >> 7)
}

/// `(old (256 - a) + new a) / 256` in every byte, rounded to nearest.
#[inline(always)]
const fn filter(old: u32, new: u32, a: u32) -> u32 {
    // The largest product, 255 256 + 128, has 16 bits.
    const HALF: u32 = 0x0080_0080;
    let odd = (old & ODD) * (256 - a) + HALF + (new & ODD) * a;
    let even = (old >> 8 & ODD) * (256 - a) + HALF + (new >> 8 & ODD) * a;
    (odd >> 8 & ODD) | (even & !ODD)
}

/// The sum of every byte, at most full.
#[inline(always)]
const fn add(old: u32, new: u32) -> u32 {
    let mean = half(old, new, LOW);
    let sum = (mean & !HIGH) << 1 | (old ^ new) & LOW;
    let over = mean & HIGH;
    sum | over | (over - (over >> 7))
}

/// Applies `f` to all bytes, four at a time.
#[inline(always)]
fn each(old: &mut [u8], new: &[u8], f: impl Fn(u32, u32) -> u32) {
    let mut olds = old.chunks_exact_mut(4);
    let mut news = new.chunks_exact(4);
    for (old, new) in olds.by_ref().zip(news.by_ref()) {
        let word = |bytes: &[u8]| u32::from_ne_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
        let mixed = f(word(old), word(new));
        old.copy_from_slice(&mixed.to_ne_bytes());
    }
    for (old, new) in olds.into_remainder().iter_mut().zip(news.remainder()) {
        *old = f(u32::from(*old), u32::from(*new)) as u8;
    }
}

/// Blends `new` bytes over `old` ones, as many as both have.
#[inline(never)]
pub(in super::super) fn mix_bytes(old: &mut [u8], new: &[u8], mix: Mix) {
    let count = old.len().min(new.len());
    let (old, new) = (&mut old[..count], &new[..count]);
    let (alpha, flip) = match mix {
        Mix::Filter(alpha) => return each(old, new, |o, n| filter(o, n, of_256(alpha))),
        Mix::Half => return each(old, new, |o, n| half(o, n, LOW)),
        Mix::Add(alpha) => (alpha, 0),
        // What is missing to full grows.
        Mix::Subtract(alpha) => (alpha, u32::MAX),
    };
    // All of 256 parts are the byte itself.
    each(old, new, |o, n| {
        flip ^ add(flip ^ o, filter(0, n, of_256(alpha)))
    });
}
