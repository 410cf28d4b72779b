//! Choices that between them have every pair.

use super::{Axis, CHOICES, Choices, TEXTURED, some_choices};
use crate::common::Rng;

/// Two choices on different axes.
pub type Pair = [(usize, usize); 2];

/// All pairs of choices that have not been drawn; they are taken away.
pub struct Pairs(Vec<Pair>);

/// Whether a scene of these choices shows what a pair does: where no texture is drawn, how it is drawn is not seen, and
/// of what is refused nothing is.
fn shows(choices: &Choices, pair: &Pair) -> bool {
    let has = |axis: Axis| pair.iter().any(|&(a, _)| a == axis as usize);
    let of = |axis: Axis| choices[axis as usize];
    let is_meant = of(Axis::Look) >= TEXTURED || of(Axis::Form) == 0;
    let is_seen = if has(Axis::Look) && has(Axis::Form) {
        true
    } else if [
        Axis::Wrap,
        Axis::Budget,
        Axis::Key,
        Axis::Application,
        Axis::Filter,
        Axis::Mask,
    ]
    .into_iter()
    .any(has)
    {
        is_meant && (of(Axis::Form) > 0 || has(Axis::Form) || has(Axis::Look))
    } else {
        is_meant
    };
    is_seen && pair.iter().all(|&(a, choice)| choices[a] == choice)
}

impl Pairs {
    pub fn all() -> Self {
        let choices = |axis: usize| (0..CHOICES[axis]).map(move |choice| (axis, choice));
        let mut pairs = Vec::new();
        for a in 0..CHOICES.len() {
            for b in a + 1..CHOICES.len() {
                let both = |one| choices(b).map(move |other| [one, other]);
                pairs.extend(choices(a).flat_map(both));
            }
        }
        Self(pairs)
    }

    /// Of many choices that show the first pair that is left, those that show most of the others.
    pub fn next(&mut self, rng: &mut Rng) -> Option<Choices> {
        let first = *self.0.last()?;
        let mut candidates = Vec::new();
        while candidates.len() < 20 {
            let mut choices = some_choices(rng);
            for (axis, choice) in first {
                choices[axis] = choice;
            }
            if shows(&choices, &first) {
                candidates.push(choices);
            }
        }
        let news = |choices: &Choices| self.0.iter().filter(|pair| shows(choices, pair)).count();
        let best = candidates.into_iter().max_by_key(news)?;
        self.0.retain(|pair| !shows(&best, pair));
        Some(best)
    }
}
