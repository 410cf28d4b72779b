//! Triangles out of vertices that come one by one (H11).
//!
//! Of the last three, the next vertex replaces the oldest (RM 0, a strip) or the middle one (RM
//! 1, a fan). The first triangle is counter-clockwise in the order in which its vertices came;
//! each neighbour is turned so that it stays on the same side.

/// The last three vertices, by index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Strip {
    /// Oldest, middle, newest.
    pub corners: [u16; 3],
    /// How many there are, 0 to 3.
    pub have: u8,
    /// The order of the corners is clockwise.
    pub odd: bool,
}

impl Strip {
    /// Forgets all.
    #[inline]
    pub fn restart(&mut self) {
        self.have = 0;
        self.odd = false;
    }

    /// Takes the next vertex; the triangle that it completes, counter-clockwise.
    #[inline(always)]
    pub fn push(&mut self, index: u16, fan: bool) -> Option<[u16; 3]> {
        if self.have < 3 {
            if let Some(slot) = self.corners.get_mut(usize::from(self.have)) {
                *slot = index;
            }
            self.have += 1;
            return (self.have == 3).then_some(self.corners);
        }
        let [a, b, c] = self.corners;
        self.odd ^= !fan;
        let first = if fan { a } else { b };
        self.corners = [first, c, index];
        Some(match self.odd {
            true => [c, first, index],
            false => self.corners,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    /// Each edge between neighbours is walked once each way, whatever mixture of strips and fans.
    #[test]
    fn neighbours_lie_on_the_same_side() {
        let mut seed = 1u32;
        for _ in 0..200 {
            let mut strip = Strip::default();
            let mut edges = HashSet::new();
            let mut triangles = 0;
            for index in 0..40 {
                seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                if let Some([a, b, c]) = strip.push(index, seed >> 31 != 0) {
                    triangles += 1;
                    for edge in [(a, b), (b, c), (c, a)] {
                        assert!(edges.insert(edge), "{edge:?} is walked twice");
                    }
                }
            }
            assert_eq!(triangles, 38);
            let inner = edges.iter().filter(|(a, b)| edges.contains(&(*b, *a)));
            assert_eq!(inner.count(), 2 * 37);
        }
        let mut strip = Strip::default();
        let all: std::vec::Vec<_> = (0..5).filter_map(|i| strip.push(i, false)).collect();
        assert_eq!(all, [[0, 1, 2], [2, 1, 3], [2, 3, 4]]);
        strip.restart();
        let all: std::vec::Vec<_> = (0..5).filter_map(|i| strip.push(i, true)).collect();
        assert_eq!(all, [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
    }
}
