//! Triangles into strips and fans: greedy, with an index of directed edges.
//!
//! From the triangle with the fewest neighbours left, all six ways to walk (three corners to
//! begin with, as strip and as fan) are tried, and the longest is taken. A strip of n triangles
//! costs n + 3 indices with the one that ends it, so a triangle alone is better off separate.

use scanbeam::list::Strip;
use std::collections::{BTreeSet, HashMap};
use std::ops::Range;

/// Triangles of one table in the order in which they are drawn.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Runs {
    /// Strips of two triangles and more.
    pub strips: Vec<Vec<u32>>,
    /// Fans of three triangles and more.
    pub fans: Vec<Vec<u32>>,
    /// What is left.
    pub separate: Vec<[u32; 3]>,
}

impl Runs {
    /// How many triangles there are.
    #[must_use]
    pub fn triangles(&self) -> usize {
        let runs = self.strips.iter().chain(&self.fans);
        runs.map(|r| r.len() - 2).sum::<usize>() + self.separate.len()
    }
}

/// Puts triangles in order; none may name a vertex twice.
#[must_use]
pub fn strips_of(triangles: &[[u32; 3]]) -> Runs {
    runs_of(triangles, 0..6)
}

/// The same in strips alone, of one triangle too, so that one block has them all.
#[must_use]
pub(super) fn strips_alone(triangles: &[[u32; 3]]) -> Runs {
    let Runs {
        mut strips,
        separate,
        ..
    } = runs_of(triangles, 3..6);
    strips.extend(separate.iter().map(|t| t.to_vec()));
    Runs {
        strips,
        ..Runs::default()
    }
}

/// By some of the ways to walk: three as a fan, three as a strip.
fn runs_of(triangles: &[[u32; 3]], ways: Range<usize>) -> Runs {
    let mut edges: HashMap<(u32, u32), Vec<u32>> = HashMap::new();
    for (n, t) in (0..).zip(triangles) {
        for k in 0..3 {
            edges.entry((t[k], t[(k + 1) % 3])).or_default().push(n);
        }
    }
    let mut walk = Walk {
        triangles,
        edges,
        used: vec![false; triangles.len()],
    };
    // By neighbours left, so that the next to begin with is found at once.
    let mut left: Vec<u32> = (0..triangles.len() as u32)
        .map(|n| walk.neighbours(n).count() as u32)
        .collect();
    let mut queue: BTreeSet<(u32, u32)> = (0..).zip(&left).map(|(n, d)| (*d, n)).collect();
    let mut runs = Runs::default();
    while let Some((_, first)) = queue.first().copied() {
        let best = ways
            .clone()
            // Of equally long ones the last is taken: a strip.
            .map(|way| walk.along(first, way % 3, way < 3))
            .max_by_key(|(taken, _)| taken.len());
        // There are six.
        let Some((taken, order)) = best else { break };
        for &n in &taken {
            walk.used[n as usize] = true;
            queue.remove(&(left[n as usize], n));
        }
        for &n in &taken {
            let around: Vec<u32> = walk.neighbours(n).collect();
            for m in around {
                queue.remove(&(left[m as usize], m));
                left[m as usize] -= 1;
                queue.insert((left[m as usize], m));
            }
        }
        match (order, taken.len()) {
            (Order::Strip(run), 2..) => runs.strips.push(run),
            (Order::Fan(run), 2..) => runs.fans.push(run),
            _ => runs.separate.push(triangles[first as usize]),
        }
    }
    runs
}

enum Order {
    Strip(Vec<u32>),
    Fan(Vec<u32>),
}

struct Walk<'a> {
    triangles: &'a [[u32; 3]],
    edges: HashMap<(u32, u32), Vec<u32>>,
    used: Vec<bool>,
}

impl Walk<'_> {
    /// Unused triangles on the other sides of the edges of `n`, each as often as it shares one.
    fn neighbours(&self, n: u32) -> impl Iterator<Item = u32> + '_ {
        let t = self.triangles[n as usize];
        (0..3).flat_map(move |k| self.across(t[k], t[(k + 1) % 3], n))
    }

    fn across(&self, a: u32, b: u32, but: u32) -> impl Iterator<Item = u32> + '_ {
        let others = self.edges.get(&(b, a)).map_or(&[][..], Vec::as_slice);
        let others = others.iter().copied();
        others.filter(move |m| *m != but && !self.used[*m as usize])
    }

    /// Walks from a triangle as far as it goes.
    fn along(&self, first: u32, turn: usize, fan: bool) -> (Vec<u32>, Order) {
        let t = self.triangles[first as usize];
        let mut order = vec![t[turn], t[(turn + 1) % 3], t[(turn + 2) % 3]];
        let mut taken = vec![first];
        let mut seen: BTreeSet<u32> = [first].into();
        while let [.., middle, last] = order[..] {
            // The edge that the next triangle shares, as it walks it.
            let edge = match (fan, order.len() % 2) {
                (true, _) => (order[0], last),
                (false, 1) => (last, middle),
                (false, _) => (middle, last),
            };
            let next = self.edges.get(&edge).and_then(|all| {
                let free = |n: &&u32| !self.used[**n as usize] && !seen.contains(n);
                all.iter().find(free)
            });
            let Some(&next) = next else { break };
            let third = self.triangles[next as usize]
                .into_iter()
                .find(|v| *v != edge.0 && *v != edge.1);
            let Some(third) = third else { break };
            order.push(third);
            taken.push(next);
            seen.insert(next);
        }
        let order = if fan {
            Order::Fan(order)
        } else {
            Order::Strip(order)
        };
        (taken, order)
    }
}

/// The triangles of a strip or fan, each with the corner first that has the smallest number.
#[must_use]
pub fn unrolled(run: &[u32], fan: bool) -> Vec<[u32; 3]> {
    let mut strip = Strip::default();
    (0..run.len() as u16)
        .filter_map(|n| strip.push(n, fan))
        .map(|t| turned(t.map(|n| run[usize::from(n)])))
        .collect()
}

/// The same triangle, its smallest corner first.
#[must_use]
pub fn turned(t: [u32; 3]) -> [u32; 3] {
    let [a, b, c] = t;
    match a.min(b).min(c) {
        m if m == a => t,
        m if m == b => [b, c, a],
        _ => [c, a, b],
    }
}
