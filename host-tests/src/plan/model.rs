//! What instructions a frame takes, reckoned from what it does: so much of each kind of work, times what one was measured
//! to take.
//!
//! What one takes is the least-squares solution without negative terms over the [samples](super::samples), of pass one, of
//! every eight lines and of whole frames; each sample counts as much as another.

use crate::flashed::shape::{LARGE, NAMES, Share, Shares, TEXTURED};
use crate::flashed::tally::{LineTally, PassOne, Tally};
use std::collections::BTreeMap;

/// Instructions of one work, by what it is.
pub type Costs = BTreeMap<String, f64>;
/// How much of each work, by what it is.
pub type Works = BTreeMap<String, f64>;

/// The part that large triangles may take for the bound.
const MOST_LARGE: f64 = 0.35;
/// The part that what has no slot may take for it.
const MOST_WITHOUT_SLOT: f64 = 0.03;
/// Lines of an equation.
const BLOCK: usize = 8;
/// Rounds of the solution at most.
const ROUNDS: usize = 10_000;
/// When the solution is one: no term changes by more, relative to itself.
const STILL: f64 = 1e-7;
/// How much is added to the diagonal, relative to it, so that works that always come together share what they take.
const RIDGE: f64 = 1e-6;

/// What a frame takes.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// Instructions of pass one.
    pub pass_one: f64,
    /// Those of each line.
    pub lines: Vec<f64>,
    /// Those of the whole frame.
    pub frame: f64,
}

/// The works of pass one.
#[must_use]
pub fn pass_one_works(pass: &PassOne) -> Works {
    let meshes = &pass.meshes;
    let white = pass.listed.map_or(0, |listed| listed.white);
    let lit = f64::from(meshes.lit - white.min(meshes.lit));
    let of_meshes = [
        ("draw call", pass.draws.into()),
        ("vertex", meshes.vertices.into()),
        ("vertex lit", lit),
        ("vertex and light", lit * f64::from(meshes.lights)),
    ];
    let all = [
        ("frame", 1.0),
        ("vertex with texels", meshes.placed.into()),
        ("face not seen", pass.culled.into()),
        ("face cut", pass.clipped.into()),
        ("vertex of a cut", pass.own.into()),
        ("face filed", pass.filed.into()),
    ];
    let mut works: Works = all.map(|(name, count)| (name.to_owned(), count)).into();
    // What a player gathers first is not drawn as what lies ready.
    let from = if pass.listed.is_some() { "list: " } else { "" };
    for (name, count) in of_meshes {
        works.insert(format!("{from}{name}"), count);
    }
    if let Some(listed) = pass.listed {
        for (name, count) in [
            ("block", listed.blocks),
            ("triangle", listed.triangles),
            ("vertex in white light", listed.white),
        ] {
            works.insert(format!("{from}{name}"), count.into());
        }
    }
    works
}

/// The works of a line of so many pixels.
fn line_works(line: &LineTally, shares: &Shares, width: u16) -> Works {
    let (spans, cache) = (line.spans, line.cache);
    let all = f64::from(spans.spans);
    let hidden = part(spans.spans_hidden, spans.spans);
    let meet = f64::from(spans.spans - spans.spans_untested);
    let misses = f64::from(cache.misses);
    let sum = |of: fn(&Share) -> u32| shares.iter().map(of).sum::<u32>();
    let seen = part(spans.pixels_shaded, sum(|share| share.pixels));
    let textured = shares[TEXTURED..].iter().map(|share| share.spans).sum();
    let one = |yes: bool| f64::from(u8::from(yes));
    let of_line = [
        ("line", 1.0),
        (
            "pixel of the background",
            f64::from(width) - f64::from(spans.pixels_shaded),
        ),
        (
            "span between tall sides",
            f64::from(sum(|share| share.tall)) * (1.0 - hidden),
        ),
        ("triangle without pixels", sum(|share| share.empty).into()),
        ("line with spans", one(all > 0.0)),
        ("line that changes", one(sum(|share| share.starts) > 0)),
        ("side that turns", cache.turning.into()),
        ("line where spans meet", one(meet > 0.0)),
        ("span that meets", meet),
        ("span hidden", spans.spans_hidden.into()),
        ("span sorted", all * one(meet > 0.0)),
        ("pair of spans that meet", meet * meet),
        ("span without slot", misses),
        (
            "span of texels without slot",
            misses * part(textured, sum(|share| share.spans)),
        ),
        ("pair without slot", misses * all),
        ("move into slot", cache.moved_in.into()),
    ];
    let mut works: Works = of_line.map(|(name, count)| (name.to_owned(), count)).into();
    for (name, share) in NAMES.iter().zip(shares) {
        works.insert(format!("{name}: set-up"), share.starts.into());
        works.insert(
            format!("{name}: span"),
            f64::from(share.spans) * (1.0 - hidden),
        );
        works.insert(format!("{name}: pixel"), f64::from(share.pixels) * seen);
    }
    works
}

fn part(some: u32, all: u32) -> f64 {
    f64::from(some) / f64::from(all.max(1))
}

/// Adds works.
fn add(works: &mut Works, more: Works) {
    for (name, count) in more {
        *works.entry(name).or_default() += count;
    }
}

/// The works of lines from one on.
fn works_of_lines(tally: &Tally, from: usize, end: usize) -> Works {
    let mut works = Works::new();
    let lines = tally.lines.iter().zip(&tally.shares);
    for (line, shares) in lines.take(end).skip(from) {
        add(&mut works, line_works(line, shares, tally.width));
    }
    works
}

/// The works of a frame.
#[must_use]
pub fn works(tally: &Tally) -> Works {
    let mut all = pass_one_works(&tally.pass_one);
    add(&mut all, works_of_lines(tally, 0, tally.lines.len()));
    all
}

/// Instructions of works; a work of which nothing is known takes none.
#[must_use]
pub fn reckon(costs: &Costs, works: &Works) -> f64 {
    let cost = |(name, count): (&String, &f64)| count * costs.get(name).copied().unwrap_or(0.0);
    works.iter().map(cost).sum()
}

/// Parts of the instructions that are less certain than others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parts {
    /// Of large triangles: their costs hang on what is not counted, such as how strongly a texture is foreshortened.
    pub large: f64,
    /// Of what has no slot: it is compared with what is on its line, with more or less of it.
    pub without_slot: f64,
}

impl Parts {
    /// Those of a frame.
    #[must_use]
    pub fn of(costs: &Costs, works: &Works) -> Self {
        let all = reckon(costs, works).max(1.0);
        let part = |is_in: &dyn Fn(&str) -> bool| {
            let some = works.iter().filter(|(name, _)| is_in(name));
            reckon(
                costs,
                &some.map(|(name, count)| (name.clone(), *count)).collect(),
            ) / all
        };
        Self {
            large: part(&|name| LARGE.iter().any(|kind| of_kind(NAMES[*kind], name))),
            without_slot: part(&|name| name.ends_with("slot")),
        }
    }

    /// Whether both are so small that what is reckoned is within [`BOUND`](super::BOUND) of what is measured.
    #[must_use]
    pub fn are_small(&self) -> bool {
        self.large <= MOST_LARGE && self.without_slot <= MOST_WITHOUT_SLOT
    }
}

/// Whether a work is of a kind of triangles.
fn of_kind(kind: &str, work: &str) -> bool {
    work.strip_prefix(kind)
        .is_some_and(|rest| rest.starts_with(':'))
}

/// Sums of products of equations: works by works, and works by what they take.
#[derive(Debug, Clone, Default)]
pub struct Equations {
    left: BTreeMap<String, BTreeMap<String, f64>>,
    right: BTreeMap<String, f64>,
}

impl Equations {
    /// Those of a sample.
    #[must_use]
    pub fn of(tally: &Tally, measured: &Measured) -> Self {
        let mut all = Self::default();
        let height = measured.lines.len();
        let second = (measured.frame - measured.pass_one).max(1.0);
        all.add(&pass_one_works(&tally.pass_one), measured.pass_one, 1.0);
        let count = height.div_ceil(BLOCK) as f64;
        for from in (0..height).step_by(BLOCK) {
            let end = (from + BLOCK).min(height);
            let cost = measured.lines[from..end].iter().sum();
            // All of them count as much as one, each by how far it is off of the mean.
            let weight = cost / (second / count) / count.sqrt();
            all.add(&works_of_lines(tally, from, end), cost, weight);
        }
        all.add(&works(tally), measured.frame, 2.0);
        all
    }

    /// An equation that counts so much, by how far it is off of what was measured.
    pub fn add(&mut self, works: &Works, cost: f64, weight: f64) {
        let square = (weight / cost.max(1.0)).powi(2);
        for (name, count) in works.iter().filter(|(_, count)| **count != 0.0) {
            *self.right.entry(name.clone()).or_default() += square * count * cost;
            let row = self.left.entry(name.clone()).or_default();
            for (other, by) in works {
                *row.entry(other.clone()).or_default() += square * count * by;
            }
        }
    }

    /// Adds those of another sample.
    pub fn join(&mut self, more: &Self) {
        for (name, row) in &more.left {
            add(self.left.entry(name.clone()).or_default(), row.clone());
        }
        add(&mut self.right, more.right.clone());
    }

    /// What one work of each kind takes.
    #[must_use]
    pub fn solve(&self) -> Costs {
        let names: Vec<&String> = self.right.keys().collect();
        let own = |name: &String| self.left[name][name].sqrt();
        // In units in which the diagonal is 1.
        let scale: Vec<f64> = names.iter().map(|name| own(name)).collect();
        let left: Vec<Vec<f64>> = (names.iter().zip(&scale))
            .map(|(name, by)| {
                let row = &self.left[*name];
                let of = |(other, at): (&&String, &f64)| {
                    row.get(*other).copied().unwrap_or_default() / by / at
                };
                names.iter().zip(&scale).map(of).collect()
            })
            .collect();
        let right: Vec<f64> = (names.iter().zip(&scale))
            .map(|(name, by)| self.right[*name] / by)
            .collect();
        let solution = without_negatives(&left, &right);
        let cost = |(name, (value, by)): (&&String, (f64, &f64))| ((*name).clone(), value / by);
        names
            .iter()
            .zip(solution.into_iter().zip(&scale))
            .map(cost)
            .collect()
    }
}

/// The least-squares solution of normal equations with a diagonal of 1, without negative terms: one term after the other.
fn without_negatives(left: &[Vec<f64>], right: &[f64]) -> Vec<f64> {
    let mut terms = vec![0.0_f64; right.len()];
    for _ in 0..ROUNDS {
        let mut moved = 0.0_f64;
        for (at, (row, wanted)) in left.iter().zip(right).enumerate() {
            let have: f64 = row.iter().zip(&terms).map(|(a, b)| a * b).sum();
            let rest = wanted - have - RIDGE * terms[at];
            let new = (terms[at] + rest / (1.0 + RIDGE)).max(0.0);
            moved = moved.max((new - terms[at]).abs() / (1.0 + new));
            terms[at] = new;
        }
        if moved < STILL {
            break;
        }
    }
    terms
}
