//! The priority contest, bit by bit from the top (P6).
//!
//! Polygon processors stand in a row along a bus. Each compares the priority that comes along with its
//! own, passes on the one that wins, and inserts its colour where that was its own. A stage looks at one
//! bit of each, and hands on whether it is decided and for whom; stages are a clock apart, so numbers of
//! any length are compared at the rate of pixels. Of equal numbers the one on the bus stays, so
//! the first in the row wins.
//!
//! The fast path compares whole numbers and draws in that order; surfaces drawn last win there, so the row
//! begins with them.

/// Which number has the higher priority.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wins {
    /// The smaller one.
    Least,
    /// The larger one.
    Most,
}

/// What one stage hands to the next, of the next lower bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Decision {
    /// Bits above have differed.
    pub resolved: bool,
    /// Then: whether for the processor, not for the bus.
    pub own: bool,
}

impl Decision {
    /// Before the first bit: open while the processor's polygon is `active`, else for the bus.
    #[inline]
    #[must_use]
    pub const fn start(active: bool) -> Self {
        Self {
            resolved: !active,
            own: false,
        }
    }
}

/// One stage: the bits of bus and processor, and what is decided above. Gives the bit that goes on along
/// the bus, and the decision.
///
/// Two products of two inputs and a sum each, as gates would have it.
#[inline]
#[must_use]
pub const fn priority_stage(wins: Wins, bus: bool, own: bool, above: Decision) -> (bool, Decision) {
    let (c, d) = (above.resolved, above.own);
    // The better of both bits, and whether the processor alone has it.
    let (better, ahead) = match wins {
        Wins::Least => (bus & own, bus & !own),
        Wins::Most => (bus | own, !bus & own),
    };
    let out = (!c & better) | (c & ((d & own) | (!d & bus)));
    let decision = Decision {
        resolved: c | (bus != own),
        own: (c & d) | (!c & ahead),
    };
    (out, decision)
}

/// The contest of whole numbers of `bits` bits, at most 16, through as many stages: the number that goes
/// on along the bus, and whether the processor inserts its colour.
#[inline]
#[must_use]
pub const fn priority_contest(
    wins: Wins,
    bits: u32,
    bus: u16,
    own: u16,
    active: bool,
) -> (u16, bool) {
    let mut decision = Decision::start(active);
    let (mut out, mut bit) = (0, bits);
    while bit > 0 {
        bit -= 1;
        let (next, below) =
            priority_stage(wins, bus >> bit & 1 != 0, own >> bit & 1 != 0, decision);
        out = out << 1 | next as u16;
        decision = below;
    }
    (out, decision.own)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Rng;
    use std::vec::Vec;

    /// Bus, own, resolved, for own: the bit that goes on, resolved, for own.
    type Row = [u8; 7];
    const LEAST: [Row; 16] = [
        [0, 0, 0, 0, 0, 0, 0],
        [0, 0, 0, 1, 0, 0, 0],
        [0, 0, 1, 0, 0, 1, 0],
        [0, 0, 1, 1, 0, 1, 1],
        [0, 1, 0, 0, 0, 1, 0],
        [0, 1, 0, 1, 0, 1, 0],
        [0, 1, 1, 0, 0, 1, 0],
        [0, 1, 1, 1, 1, 1, 1],
        [1, 0, 0, 0, 0, 1, 1],
        [1, 0, 0, 1, 0, 1, 1],
        [1, 0, 1, 0, 1, 1, 0],
        [1, 0, 1, 1, 0, 1, 1],
        [1, 1, 0, 0, 1, 0, 0],
        [1, 1, 0, 1, 1, 0, 0],
        [1, 1, 1, 0, 1, 1, 0],
        [1, 1, 1, 1, 1, 1, 1],
    ];
    /// Only the rows that are open and whose bits differ are others.
    const MOST: [Row; 4] = [
        [0, 1, 0, 0, 1, 1, 1],
        [0, 1, 0, 1, 1, 1, 1],
        [1, 0, 0, 0, 1, 1, 0],
        [1, 0, 0, 1, 1, 1, 0],
    ];

    #[test]
    fn a_stage_is_its_truth_table() {
        for row in LEAST {
            let other = MOST.iter().find(|other| other[..4] == row[..4]);
            for (wins, row) in [(Wins::Least, &row), (Wins::Most, other.unwrap_or(&row))] {
                let [bus, own, resolved, for_own, out, after, decided] = row.map(|bit| bit != 0);
                let above = Decision {
                    resolved,
                    own: for_own,
                };
                let below = Decision {
                    resolved: after,
                    own: decided,
                };
                let stage = priority_stage(wins, bus, own, above);
                assert_eq!(stage, (out, below), "{wins:?} {row:?}");
            }
        }
    }

    #[test]
    fn all_pairs_of_eight_bits_end_as_a_comparison_says() {
        for bus in 0..256 {
            for own in 0..256 {
                let least = priority_contest(Wins::Least, 8, bus, own, true);
                assert_eq!(least, (bus.min(own), own < bus));
                let most = priority_contest(Wins::Most, 8, bus, own, true);
                assert_eq!(most, (bus.max(own), own > bus));
                for wins in [Wins::Least, Wins::Most] {
                    assert_eq!(priority_contest(wins, 8, bus, own, false), (bus, false));
                }
            }
        }
    }

    #[test]
    fn rows_of_processors_have_the_winner_that_whole_numbers_have() {
        let mut rng = Rng(11);
        for round in 0..20_000 {
            let bits = 1 + rng.below(16);
            let most = (1u32 << bits) - 1;
            // Few numbers, so that some are equal.
            let below = [2, 5, most + 1][round % 3].min(most + 1);
            let row: Vec<(u16, bool)> = (0..1 + rng.below(12))
                .map(|_| (rng.below(below) as u16, rng.below(4) > 0))
                .collect();
            for wins in [Wins::Least, Wins::Most] {
                let start = if wins == Wins::Most { 0 } else { most as u16 };
                let (mut bus, mut winner) = (start, None);
                for (i, &(own, active)) in row.iter().enumerate() {
                    let inserts;
                    (bus, inserts) = priority_contest(wins, bits, bus, own, active);
                    if inserts {
                        winner = Some(i);
                    }
                }
                // Before anybody, the bus has the lowest priority, which nobody beats who has it too.
                let rank = |own: u16| match wins {
                    Wins::Most => own,
                    Wins::Least => most as u16 - own,
                };
                let active = row.iter().enumerate().filter(|(_, p)| p.1 && rank(p.0) > 0);
                let best = active.max_by_key(|(i, p)| (rank(p.0), usize::MAX - i));
                assert_eq!(winner, best.map(|(i, _)| i), "{wins:?} {row:?}");
                assert_eq!(bus, best.map_or(start, |(_, p)| p.0));
            }
        }
    }
}
