//! Sets of up to 32 members, a bit each, in the order that a processor finds them fastest.
//!
//! A Cortex-M4 counts leading zeros in one instruction, so there the first member is the top bit; a
//! Cortex-M0+ isolates the lowest bit and looks its number up, 9 instructions against 34 for a count.
//! Either way members come out in rising order, so the same sets give the same pictures.

use super::short::SHORT;
use core::num::NonZeroU32;

/// The set of one member, 0 to 31.
#[inline(always)]
pub const fn bit(member: u32) -> u32 {
    if SHORT {
        low_bit(member)
    } else {
        top_bit(member)
    }
}

/// [`bit`] where the first member is the lowest bit.
#[inline(always)]
const fn low_bit(member: u32) -> u32 {
    1 << (member & 31)
}

/// [`bit`] where the first member is the top bit.
#[inline(always)]
const fn top_bit(member: u32) -> u32 {
    0x8000_0000 >> (member & 31)
}

/// Takes the lowest member out of a set, if it has any.
#[inline(always)]
pub fn take_first(set: &mut u32) -> Option<u32> {
    if SHORT { take_low(set) } else { take_top(set) }
}

/// [`take_first`] of a set of [`low_bit`]s.
#[inline(always)]
fn take_low(set: &mut u32) -> Option<u32> {
    let low = *set & set.wrapping_neg();
    let first = (low != 0).then(|| number_of(low));
    *set &= set.wrapping_sub(1);
    first
}

/// [`take_first`] of a set of [`top_bit`]s.
#[inline(always)]
fn take_top(set: &mut u32) -> Option<u32> {
    let first = NonZeroU32::new(*set)?.leading_zeros();
    *set &= !top_bit(first);
    Some(first)
}

/// The number of the one bit of a word, by a de Bruijn sequence.
///
/// A table of the numbers alone the compiler takes for a count of zeros: it puts one of its own beside each, and asks
/// for 0 first.
#[inline(always)]
fn number_of(low: u32) -> u32 {
    const SEQUENCE: u32 = 0x077C_B531;
    static NUMBER: [u8; 32] = {
        let mut numbers = [0; 32];
        let mut i = 0;
        while i < 32 {
            numbers[(SEQUENCE.wrapping_mul(1 << i) >> 27) as usize] = 32 + i as u8;
            i += 1;
        }
        numbers
    };
    u32::from(NUMBER[(SEQUENCE.wrapping_mul(low) >> 27) as usize]) & 31
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::random::Rng;
    use std::vec::Vec;

    /// All sets of members of which each is in one of four, whichever end they begin at.
    fn come_out(bit: impl Fn(u32) -> u32, take: impl Fn(&mut u32) -> Option<u32>) {
        let mut rng = Rng(4);
        for _ in 0..10_000 {
            let members = rng.bits() & rng.bits();
            let members: Vec<u32> = (0..32).filter(|i| members >> i & 1 != 0).collect();
            let mut set = members.iter().fold(0, |set, i| set | bit(*i));
            assert_eq!(set.count_ones() as usize, members.len());
            let mut out = Vec::new();
            while let Some(member) = take(&mut set) {
                out.push(member);
            }
            assert_eq!(out, members);
        }
        // Of a number beyond the last the rest by 32 counts, as the shift would have it.
        assert_eq!(bit(32 + 7), bit(7));
    }

    #[test]
    fn members_come_out_in_rising_order() {
        come_out(bit, take_first);
        come_out(low_bit, take_low);
        come_out(top_bit, take_top);
        assert_eq!((low_bit(0), top_bit(0)), (1, 1 << 31));
    }

    #[test]
    fn a_single_bit_has_its_number() {
        for i in 0..32 {
            assert_eq!(number_of(1 << i), i);
        }
    }
}
