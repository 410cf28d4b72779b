//! Blends of 5, 6 and 5 bits, two pixels in a register.
//!
//! The filter takes the three fields that have room above them, and then the other three. The
//! others work on all six fields at once: what two fields have in common, and half of what they
//! have not, is their mean, which cannot overflow; its top bit says whether their sum would.

use super::Mix;

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

/// Alpha of 255 as one of 32, rounded to nearest.
const fn of_32(alpha: u8) -> u32 {
    (alpha as u32 * 32 + 127) / 255
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

/// The mean of every field, rounded down.
#[inline(always)]
const fn half(old: u32, new: u32) -> u32 {
    (old & new) + ((old ^ new) & !LOW) / 2
}

/// The sum of every field, at most full.
#[inline(always)]
const fn add(old: u32, new: u32) -> u32 {
    let mean = half(old, new);
    let sum = (mean & !HIGH) << 1 | (old ^ new) & LOW;
    // Where a mean reaches half of the range: all bits of a field of 5, all but one of one of 6.
    let over = mean & HIGH;
    let full = over | (over - (over >> 4)) | over >> 5 & 0x0020_0020;
    sum | full
}

/// A field's low bit is lost to its neighbour where bytes are in the other order, so words are
/// brought into the order of numbers first.
#[inline(always)]
const fn order<const SWAP: bool>(pair: u32) -> u32 {
    if SWAP {
        (pair & 0x00FF_00FF) << 8 | pair >> 8 & 0x00FF_00FF
    } else {
        pair
    }
}

/// Applies `f` to all pixels, in pairs where they lie so.
#[inline(always)]
fn each<const SWAP: bool>(old: &mut [u16], new: &[u16], f: impl Fn(u32, u32) -> u32) {
    let both = |old: u32, new: u32| order::<SWAP>(f(order::<SWAP>(old), order::<SWAP>(new)));
    let single = |old: &mut u16, new: u16| *old = both(u32::from(*old), u32::from(new)) as u16;
    let count = old.len().min(new.len());
    let (old, new) = (&mut old[..count], &new[..count]);
    let (head, pairs, tail) = bytemuck::pod_align_to_mut::<u16, u32>(old);
    let (new_head, rest) = new.split_at(head.len());
    let (new_pairs, new_tail) = rest.split_at(2 * pairs.len());
    let (before, aligned, _) = bytemuck::pod_align_to::<u16, u32>(new_pairs);
    for (old, new) in head.iter_mut().zip(new_head) {
        single(old, *new);
    }
    if before.is_empty() && aligned.len() == pairs.len() {
        let mut runs = pairs.chunks_exact_mut(4);
        let mut news = aligned.chunks_exact(4);
        for (old, new) in runs.by_ref().zip(news.by_ref()) {
            if let (Ok(old), Ok(new)) = (<&mut [u32; 4]>::try_from(old), <&[u32; 4]>::try_from(new))
            {
                *old = [0, 1, 2, 3].map(|i| both(old[i], new[i]));
            }
        }
        for (old, new) in runs.into_remainder().iter_mut().zip(news.remainder()) {
            *old = both(*old, *new);
        }
    } else {
        for (old, new) in pairs.iter_mut().zip(new_pairs.chunks_exact(2)) {
            let new = bytemuck::cast::<[u16; 2], u32>([new[0], new[1]]);
            *old = both(*old, new);
        }
    }
    for (old, new) in tail.iter_mut().zip(new_tail) {
        single(old, *new);
    }
}

/// Two pixels over two others, both in the order of numbers: what [`mix_565`] does, in one small function
/// that looks at the mode for each pair.
#[inline(never)]
pub(crate) fn mix_pair_565(old: u32, new: u32, mix: Mix) -> u32 {
    let (alpha, flip) = match mix {
        Mix::Filter(alpha) => return filter(old, new, of_32(alpha)),
        Mix::Half => return half(old, new),
        Mix::Add(alpha) => (alpha, 0),
        // What is missing to full grows.
        Mix::Subtract(alpha) => (alpha, u32::MAX),
    };
    // All of 32 parts are the pixel itself.
    flip ^ add(flip ^ old, filter(0, new, of_32(alpha)))
}

/// Blends `new` pixels over `old` ones; `SWAP` says that their bytes are not in the order of
/// numbers.
#[inline(never)]
pub(in super::super) fn mix_565<const SWAP: bool>(old: &mut [u16], new: &[u16], mix: Mix) {
    match mix {
        Mix::Filter(alpha) => {
            let a = of_32(alpha);
            each::<SWAP>(old, new, |o, n| filter(o, n, a));
        }
        Mix::Half => each::<SWAP>(old, new, half),
        Mix::Add(255) => each::<SWAP>(old, new, add),
        Mix::Add(alpha) => {
            let a = of_32(alpha);
            each::<SWAP>(old, new, |o, n| add(o, filter(0, n, a)));
        }
        // What is missing to full grows.
        Mix::Subtract(255) => each::<SWAP>(old, new, |o, n| !add(!o, n)),
        Mix::Subtract(alpha) => {
            let a = of_32(alpha);
            each::<SWAP>(old, new, |o, n| !add(!o, filter(0, n, a)));
        }
    }
}
