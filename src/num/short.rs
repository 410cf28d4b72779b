//! What a processor does whose only multiplication is 32 x 32 to 32 bits: a Cortex-M0+.
//!
//! There a 64-bit product is a library call of some 40 instructions, a division one of 130 to 190, and a count
//! of leading zeros one of 33. The forms here give the same bits in 6 to 45, a tall side's slope in three times that.
//! They are chosen where `build.rs` finds such a target ([`SHORT`]); all others keep the plain forms beside the calls,
//! and the tests hold one against the other. Reciprocals take 1.3 KB of flash, on those targets
//! alone.

use core::hint::black_box;

/// Whether the target has neither long products nor a division.
pub const SHORT: bool = cfg!(short_multiply);

/// `a` in an upper half with a sign and a lower one without.
#[inline(always)]
const fn halves(a: i32) -> (i32, i32) {
    (a >> 16, a & 0xFFFF)
}

/// `floor(a b / 2^16)` modulo 2^32: two multiplications.
#[inline(always)]
pub(super) const fn by_16(a: i32, b: i16) -> i32 {
    let (high, low) = halves(a);
    let b = b as i32;
    (high.wrapping_mul(b)).wrapping_add((low * b) >> 16)
}

/// `floor(a b / 2^32)`: four multiplications.
#[inline(always)]
pub(super) const fn high(a: i32, b: i32) -> i32 {
    let ((ah, al), (bh, bl)) = (halves(a), halves(b));
    let low = (al as u32 * bl as u32) >> 16;
    let first = ah * bl + low as i32;
    let second = al * bh + (first & 0xFFFF);
    ah * bh + (first >> 16) + (second >> 16)
}

/// `a b`: five multiplications.
#[inline(always)]
pub(super) const fn wide(a: i32, b: i32) -> i64 {
    (high(a, b) as i64) << 32 | a.wrapping_mul(b) as u32 as i64
}

/// `floor(a b / 2^32)` without signs.
#[inline(always)]
pub(super) const fn high_unsigned(a: u32, b: u32) -> u32 {
    let (ah, al, bh, bl) = (a >> 16, a & 0xFFFF, b >> 16, b & 0xFFFF);
    // Unknown to the compiler, which would else put the pieces together again, and call.
    let first = ah * bl + (black_box(al * bl) >> 16);
    let second = al * bh + (first & 0xFFFF);
    ah * bh + (first >> 16) + (second >> 16)
}

/// `2^31 / d` for the middle of each 256 of `d` in 2^15 ..< 2^16.
static SEEDS: [u16; 128] = {
    let mut seeds = [0; 128];
    let mut i = 0;
    while i < 128 {
        seeds[i] = ((1u32 << 31) / ((i as u32 + 128) * 256 + 128)) as u16;
        i += 1;
    }
    seeds
};

/// `n / d` and the remainder, for `d` in 2^15 ..< 2^16.
#[inline(always)]
pub(super) const fn divide(n: u32, d: u32) -> (u32, u32) {
    // 2^31 / d, 2^-8 of itself off, and after Newton's step less than 3 units, made too small.
    let seed = SEEDS[(d >> 8) as usize & 127] as i32;
    let miss = (1u32 << 31).wrapping_sub(d.wrapping_mul(seed as u32)) as i32;
    let reciprocal = (seed + ((seed * (miss >> 8)) >> 23) - 3) as u32;
    // Twice the upper part of the rest: at most 11 units are missing after the first.
    let first = ((n >> 16) * reciprocal) >> 15;
    let rest = n.wrapping_sub(first.wrapping_mul(d));
    let second = ((rest >> 4) * reciprocal) >> 27;
    let (mut quotient, mut rest) = (first + second, rest.wrapping_sub(second * d));
    while rest >= d {
        rest -= d;
        quotient += 1;
    }
    (quotient, rest)
}

/// [`divide`]: one copy for all that is divided.
#[inline(never)]
pub(super) fn divide_called(n: u32, d: u32) -> (u32, u32) {
    divide(n, d)
}

/// `n / by` rounded down, where that has 16 bits with its sign; the rest, and `by`, times the power of two that makes a
/// divisor of 16 bits of `by`.
#[inline(always)]
pub(super) fn floor(n: i32, by: u32) -> (i32, u32, u32) {
    let up = leading_zeros(by) & 15;
    let divisor = by << up;
    // By 2^15 more, so that it is not below 0.
    let (quotient, rest) = divide_called((by << 15).wrapping_add(n as u32) << up, divisor);
    (quotient as i32 - (1 << 15), rest, divisor)
}

/// [`slope_and_rest`](super::slope_and_rest): three digits by one divisor.
#[inline(always)]
pub(super) fn slope_and_rest(dx: i32, height: u32) -> (i32, i32) {
    let (whole, rest, divisor) = floor(dx, height);
    let (upper, rest) = divide_called(rest << 11, divisor);
    let (lower, rest) = divide_called(rest << 11, divisor);
    let more = u32::from(2 * rest >= divisor);
    (whole, ((upper << 11 | lower) + more) as i32)
}

/// One Newton step from `seed = (2^32 - 1) / (a >> 16)`, which left `rest`: see
/// [`recip`](super::recip()).
#[inline(always)]
pub(super) const fn newton(a: u32, seed: u32, rest: u32) -> u32 {
    // An eighth of 2^48 - a seed, in which a >> 16 times the seed is 2^32 - 1 - rest.
    let low = a & 0xFFFF;
    let miss = ((rest + 1) << 13)
        .wrapping_sub(low * (seed >> 3))
        .wrapping_sub((low * (seed & 7) + 7) >> 3) as i32;
    // seed miss / 2^31, by the halves of miss; the seed has 17 bits.
    let (up, down) = halves(miss);
    let down = down as u32;
    let part = (seed >> 1) * down + (((seed & 1) * down) >> 1);
    let step = ((seed as i32).wrapping_mul(up)).wrapping_add((part >> 15) as i32) >> 15;
    ((seed << 14) as i32).wrapping_add(step) as u32
}

/// [`leading_zeros`] below 6, by a table of the upper six bits.
#[inline(always)]
pub(super) fn few_zeros(x: u32) -> Option<u32> {
    static ZEROS: [u8; 64] = {
        let mut zeros = [0; 64];
        let mut upper = 1u32;
        while upper < 64 {
            zeros[upper as usize] = (upper << 26).leading_zeros() as u8;
            upper += 1;
        }
        zeros
    };
    let upper = x >> 26;
    (upper != 0).then(|| u32::from(ZEROS[upper as usize]))
}

/// Bits set in none of the upper places: with all below the first one set, 33 numbers are left, and times `SPREAD` each
/// has upper bits that no other has.
#[inline(always)]
pub(super) fn leading_zeros(mut x: u32) -> u32 {
    const SPREAD: u32 = 0xBB96_8A43;
    static ZEROS: [u8; 64] = {
        let mut zeros = [0; 64];
        let mut bits = 0;
        while bits <= 32 {
            let x = ((1u64 << bits) - 1) as u32;
            zeros[(x.wrapping_mul(SPREAD) >> 26) as usize] = 32 - bits;
            bits += 1;
        }
        zeros
    };
    for by in [1, 2, 4, 8, 16] {
        x |= x >> by;
    }
    u32::from(ZEROS[(x.wrapping_mul(SPREAD) >> 26) as usize])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::random::Rng;

    /// Numbers of any size, the ends of the range among them.
    fn any(rng: &mut Rng) -> i32 {
        let ends = [
            0,
            1,
            -1,
            i32::MAX,
            i32::MIN,
            0x7FFF,
            0x8000,
            0xFFFF,
            0x1_0000,
            -0x8000,
        ];
        match rng.below(8) {
            0 => ends[rng.below(10) as usize],
            _ => (rng.below(u32::MAX) as i32) >> rng.below(32),
        }
    }

    #[test]
    fn products_are_those_of_64_bits() {
        let mut rng = Rng(41);
        for _ in 0..2_000_000 {
            let (a, b) = (any(&mut rng), any(&mut rng));
            let wide = i64::from(a) * i64::from(b);
            assert_eq!(high(a, b), (wide >> 32) as i32, "{a} {b}");
            assert_eq!(super::wide(a, b), wide, "{a} {b}");
            let (ua, ub) = (a as u32, b as u32);
            let unsigned = u64::from(ua) * u64::from(ub);
            assert_eq!(high_unsigned(ua, ub), (unsigned >> 32) as u32, "{ua} {ub}");
            let short = i64::from(a) * i64::from(b as i16);
            assert_eq!(by_16(a, b as i16), (short >> 16) as i32, "{a} {}", b as i16);
        }
    }

    #[test]
    fn every_divisor_divides() {
        let mut rng = Rng(43);
        for d in 1 << 15..1 << 16 {
            let some = [(); 24].map(|()| rng.below(u32::MAX));
            let ends = [
                0,
                1,
                d - 1,
                d,
                d + 1,
                u32::MAX,
                (1 << 30) + d / 2,
                7 * d - 1,
                7 * d,
            ];
            for n in some.into_iter().chain(ends) {
                assert_eq!(divide(n, d), (n / d, n % d), "{n} / {d}");
            }
        }
    }

    #[test]
    fn every_height_has_its_slopes() {
        let mut rng = Rng(53);
        for height in 1..2048 {
            let some = [(); 60].map(|()| rng.below(1 << 16) as i32 - (1 << 15));
            let ends = [0, 1, -1, height - 1, -height, 0x7FFF, -0x8000];
            for dx in some.into_iter().chain(ends) {
                let (whole, rest) = (dx.div_euclid(height), dx.rem_euclid(height) as u32);
                let halves = (u64::from(rest) << 23) / height as u64;
                let want = (whole, ((halves + 1) >> 1) as i32);
                assert_eq!(slope_and_rest(dx, height as u32), want, "{dx} / {height}");
                // As where a processor divides.
                assert_eq!(
                    crate::num::slope_and_rest(dx, height),
                    want,
                    "{dx} / {height}"
                );
            }
        }
        for height in 1..1 << 16 {
            assert_eq!(slope_and_rest(0, height), (0, 0), "{height}");
        }
    }

    #[test]
    fn quotients_of_16_bits_are_rounded_down() {
        let mut rng = Rng(59);
        for by in 1..1 << 15 {
            let ends = [0x7FFF * by + by - 1, -0x8000 * by, 0, -1, by - 1, -by];
            let some = [(); 40].map(|()| (rng.below(1 << 16) as i32 - (1 << 15)) * by);
            let some = some.map(|n| n + rng.below(by as u32) as i32);
            for n in some.into_iter().chain(ends) {
                assert_eq!(floor(n, by as u32).0, n.div_euclid(by), "{n} / {by}");
            }
        }
    }

    #[test]
    fn every_number_has_its_zeros() {
        let mut rng = Rng(47);
        for bit in 0..32 {
            let x = 1u32 << bit;
            for x in [x, x - 1, x | rng.below(x.max(1))] {
                assert_eq!(leading_zeros(x), x.leading_zeros(), "{x:#x}");
                let few = (x.leading_zeros() < 6).then(|| x.leading_zeros());
                assert_eq!(few_zeros(x), few, "{x:#x}");
            }
        }
    }
}
