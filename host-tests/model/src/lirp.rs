//! LIRP: a linear blend by selectors and adders (K7).
//!
//! A weight of n bits whose all ones mean 1 uses every code; with a one before the point nearly
//! half of them would be wasted. What the all-ones code lacks to a whole is given to A in the
//! lower half of the range and to B in the upper, so both ends are exact. The price is one step
//! of double size in the middle.

/// Bits of the weight along a span.
pub const SPAN_BITS: u32 = 10;
/// Bits of the weight down an edge.
pub const EDGE_BITS: u32 = 12;

/// `a` at `w = 0`, `b` at `w = 2^n - 1`, and between them on the way: K7 as it stands.
///
/// `((~w) a + w b + (a below the middle, else b)) >> n`, rounded towards minus infinity. The
/// result never leaves the range between `a` and `b`. `n` is 1 to 30, `a` and `b` lie within
/// `-2^32 ..= 2^32`; bits of `w` above the n-th are dropped.
#[inline]
#[must_use]
pub const fn lirp(a: i64, b: i64, w: u32, n: u32) -> i64 {
    let ones = (1 << n) - 1;
    let w = w & ones;
    let share = selected(a, b, w, n - 1);
    ((ones - w) as i64 * a + w as i64 * b + share) >> n
}

/// [`lirp`] as the circuit has it: a two-way selector for each bit of the weight, one more for
/// the top bit at the lowest place, and a row of adders.
#[must_use]
pub const fn lirp_by_selectors(a: i64, b: i64, w: u32, n: u32) -> i64 {
    let mut sum = selected(a, b, w, n - 1);
    let mut bit = 0;
    while bit < n {
        sum += selected(a, b, w, bit) << bit;
        bit += 1;
    }
    sum >> n
}

/// The selector of one bit of the weight.
#[inline(always)]
const fn selected(a: i64, b: i64, w: u32, bit: u32) -> i64 {
    if w >> bit & 1 == 0 { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_bits_are_as_printed() {
        assert_eq!(lirp(100, 200, 0, 4), 100);
        assert_eq!(lirp(100, 200, 15, 4), 200);
        // 7 / 16 below the middle, 9 / 16 from there on: the step of double size.
        assert_eq!(lirp(0, 160, 7, 4), 70);
        assert_eq!(lirp(0, 160, 8, 4), 90);
    }

    #[test]
    fn both_ends_are_exact_for_every_width_and_all_nine_bit_values() {
        for n in 1..=16 {
            let ones = (1 << n) - 1;
            for a in 0..512 {
                for b in 0..512 {
                    assert_eq!(lirp(a, b, 0, n), a, "n {n}, {a} to {b}");
                    assert_eq!(lirp(a, b, ones, n), b, "n {n}, {a} to {b}");
                }
            }
        }
    }

    #[test]
    fn every_weight_stays_between_the_ends_and_within_one_step_of_the_line() {
        let values = [0i64, 1, 2, 63, 255, 256, 300, 510, 511];
        for n in 1..=12 {
            let ones = (1 << n) - 1;
            for a in values {
                for b in values {
                    let mut last = a;
                    for w in 0..=ones {
                        let value = lirp(a, b, w, n);
                        assert!((a.min(b)..=a.max(b)).contains(&value));
                        assert!(if a <= b { value >= last } else { value <= last });
                        last = value;
                        let line = a as f64 + (b - a) as f64 * f64::from(w) / f64::from(ones);
                        let step = (b - a).abs() as f64 / f64::from(1 << n) * 0.5 + 1.0;
                        assert!((value as f64 - line).abs() <= step, "{n} {a} {b} {w}");
                    }
                }
            }
        }
    }

    #[test]
    fn the_selectors_give_the_same_bits() {
        for n in 1..=12 {
            for w in 0..1 << n {
                for (a, b) in [(0, 511), (511, 0), (-2048, 2047), (7, 7), (-1, 0)] {
                    assert_eq!(lirp_by_selectors(a, b, w, n), lirp(a, b, w, n));
                }
                let (a, b) = (0xFFFF_FFFF, 0x1234_5678);
                assert_eq!(lirp_by_selectors(a, b, w, n), lirp(a, b, w, n));
            }
        }
    }
}
