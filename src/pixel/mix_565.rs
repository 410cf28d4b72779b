//! Blends of 5, 6 and 5 bits, two pixels in a register.
//!
//! The filter takes the three fields that have room above them, and then the other three. The
//! others work on all six fields at once: what two fields have in common, and half of what they
//! have not, is their mean, which cannot overflow; its top bit says whether their sum would.

use super::between::{apart_565, joined_565};
use super::mix::half;
use super::{Mix, PixelFormat, Rgb565};

/// The low bit of every field.
const LOW: u32 = 0x0821_0821;
/// The high bit of every field.
const HIGH: u32 = 0x8410_8410;
/// Three fields with room above: green of the upper pixel, red and blue of the lower.
const ODD: u32 = 0x07E0_F81F;
/// The other three, moved down by 5.
const EVEN_DOWN: u32 = 0x07C0_F83F;
/// Half a step of the product of a field of [`ODD`] or [`EVEN_DOWN`] with 32.
const HALF_ODD: u32 = 1 << 25 | 1 << 15 | 1 << 4;
const HALF_EVEN: u32 = 1 << 26 | 1 << 15 | 1 << 4;

/// Alpha of 255 as one of 32, to nearest: as of 256, which differ by less than a half.
const fn of_32(alpha: u8) -> u32 {
    (alpha as u32 + 4) / 8
}

/// `(old (32 - a) + new a) / 32` in every field, rounded to nearest.
#[inline(always)]
const fn filter(old: u32, new: u32, a: u32) -> u32 {
    let odd = part(old & ODD, new & ODD, a, HALF_ODD);
    let even = part(old >> 5 & EVEN_DOWN, new >> 5 & EVEN_DOWN, a, HALF_EVEN);
    (odd >> 5 & ODD) | (even & EVEN_DOWN << 5)
}

/// Three fields of [`filter`], times 32. The largest, 63 32 + 16, has the 11 bits that there are.
#[inline(always)]
const fn part(old: u32, new: u32, a: u32, half: u32) -> u32 {
    (old * (32 - a) + half) + new * a
}

/// The sum of every field, at most full.
#[inline(always)]
const fn add(old: u32, new: u32) -> u32 {
    let mean = half(old, new, LOW);
    let sum = (mean & !HIGH) << 1 | (old ^ new) & LOW;
    // Where a mean reaches half of the range: all bits of a field of 5, all but one of one of 6.
    let over = mean & HIGH;
    let full = over | (over - (over >> 4)) | over >> 5 & 0x0020_0020;
    sum | full
}

/// Two pixels over two others, both in the order of numbers: in one small function that looks at the
/// mode for each pair.
#[inline(never)]
fn mix_pair(old: u32, new: u32, mix: Mix) -> u32 {
    let (alpha, flip) = match mix {
        Mix::Filter(alpha) => return filter(old, new, of_32(alpha)),
        Mix::Half => return half(old, new, LOW),
        Mix::Add(alpha) => (alpha, 0),
        // What is missing to full grows.
        Mix::Subtract(alpha) => (alpha, u32::MAX),
    };
    // All of 32 parts are the pixel itself.
    flip ^ add(flip ^ old, filter(0, new, of_32(alpha)))
}

/// One pixel over another, both in the order of numbers, to the same bits as [`mix_pair`].
#[inline(always)]
pub(super) fn mix_one(old: u16, new: u16, mix: Mix) -> u16 {
    // All fields have room in one word.
    let filter = |old: u32, a: u32| joined_565(part(old, apart_565(new), a, HALF_ODD) >> 5 & ODD);
    let (alpha, flip) = match mix {
        Mix::Filter(alpha) => return filter(apart_565(old), of_32(alpha)),
        Mix::Half => return half(old.into(), new.into(), LOW) as u16,
        Mix::Add(alpha) => (alpha, 0),
        Mix::Subtract(alpha) => (alpha, u16::MAX),
    };
    flip ^ Rgb565::add(flip ^ old, filter(0, of_32(alpha)))
}

/// Blends pixels of 16 bits, two at a time, brought into the order of numbers and back.
#[inline(always)]
pub(super) fn mix_565(old: &mut [u16], new: &[u16], order: impl Fn(u32) -> u32, mix: Mix) {
    let both = |old: u32, new: u32| order(mix_pair(order(old), order(new), mix));
    let pair = |pair: &[u16]| u32::from(pair[0]) | u32::from(pair[1]) << 16;
    let count = old.len().min(new.len());
    let mut pairs = old[..count].chunks_exact_mut(2);
    let mut news = new[..count].chunks_exact(2);
    for (old, new) in pairs.by_ref().zip(news.by_ref()) {
        let both = both(pair(old), pair(new));
        old.copy_from_slice(&[both as u16, (both >> 16) as u16]);
    }
    if let ([old], [new]) = (pairs.into_remainder(), news.remainder()) {
        *old = both(u32::from(*old), u32::from(*new)) as u16;
    }
}
