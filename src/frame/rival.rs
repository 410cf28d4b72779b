//! Spans that compete for columns: their depth along the line, and who of two is seen.

use super::near::place_of;
use super::renderer::View;
use super::slot::{Active, Flags};
use super::spans::{Line, Span};
use super::thin::{MARGIN, depth_plane, thin_span};
use crate::active::CacheSlot;
use crate::look::Look;
use crate::num::rolled;
use crate::visible::Mask;

/// The depth of a span: its value at the picture's first column, and its step.
#[derive(Clone, Copy)]
pub(super) struct Slope {
    pub(super) at: u32,
    pub(super) step: u32,
}

/// A span that competes for its columns.
#[derive(Clone, Copy)]
pub(super) struct Rival {
    pub(super) span: Span,
    pub(super) slope: Slope,
    pub(super) object: u16,
}

/// A depth, and the number of the object.
pub(super) type Key = (u32, u16);

impl Slope {
    /// What stands for a depth where there is none: its place in the order of all triangles.
    #[inline(always)]
    pub(super) fn of_place(view: &View<'_>, object: u16) -> Self {
        Self::even(place_of(view, object))
    }

    /// The same in all columns.
    #[inline(always)]
    pub(super) fn even(at: u32) -> Self {
        Self { at, step: 0 }
    }

    /// That of a plane of depth on a line.
    #[inline(always)]
    pub(super) fn of_plane([at, step, down]: [u32; 3], line: u32) -> Self {
        Self {
            at: at.wrapping_add(down.wrapping_mul(line)),
            step,
        }
    }

    #[inline(always)]
    pub(super) fn at(self, column: u32) -> u32 {
        self.at.wrapping_add(self.step.wrapping_mul(column))
    }

    /// The nearest and the farthest depth of a span that is not empty.
    #[inline(always)]
    pub(super) fn range(self, span: Span) -> [u32; 2] {
        let (first, last) = (self.at(span.start), self.at(span.end - 1));
        [first.max(last), first.min(last)]
    }
}

impl Rival {
    /// Where it stands among those of a column: what is less is behind.
    #[inline(always)]
    pub(super) fn key(self, column: u32) -> Key {
        (self.slope.at(column), self.object)
    }

    /// Whether this is seen in a column that both have, and not the other.
    #[inline(always)]
    pub(super) fn hides(self, other: Self, column: u32) -> bool {
        self.key(column) > other.key(column)
    }

    /// Adds to a mask the columns in which both are and this is seen.
    #[inline(never)]
    pub(super) fn hide(&self, other: &Self, mask: &mut Mask) {
        if let Some(hidden) = self.hidden_of(*other) {
            mask.cover(hidden.start, hidden.end);
        }
    }

    /// The columns in which both are and this is seen: they begin or end with what both have, as both depths are
    /// linear.
    #[inline(always)]
    pub(super) fn hidden_of(self, other: Self) -> Option<Span> {
        let Span { start, end } = self.span.within(other.span);
        if start >= end {
            return None;
        }
        let first = self.hides(other, start);
        if first == self.hides(other, end - 1) {
            return first.then_some(Span { start, end });
        }
        let turned = self.turned(other, first, Span { start, end });
        Some(if first {
            Span { start, end: turned }
        } else {
            Span { start: turned, end }
        })
    }

    /// Of columns that both have, the first in which this is not seen as it is in the first of all, `first`; in the last
    /// it is not so either.
    #[inline(always)]
    pub(super) fn turned(self, other: Self, first: bool, Span { start, end }: Span) -> u32 {
        let [this, that] = [self, other].map(|rival| rival.slope);
        let seen_of_equal = u32::from(self.object > other.object);
        // Above 0 where this is seen: between columns that differ in it, depths are less than 2^31 apart.
        let mut nearer = Slope {
            at: (this.at.wrapping_sub(that.at)).wrapping_add(seen_of_equal),
            step: this.step.wrapping_sub(that.step),
        };
        if !first {
            nearer.at = 1_u32.wrapping_sub(nearer.at);
            nearer.step = nearer.step.wrapping_neg();
        }
        // From `same` on it is as in the first column, from `turned` on as in the last.
        let (mut same, mut turned) = (start, end - 1);
        loop {
            rolled();
            let middle = (same + turned) / 2;
            if middle == same {
                return turned;
            }
            if nearer.at(middle) as i32 > 0 {
                same = middle;
            } else {
                turned = middle;
            }
        }
    }
}

/// The plane of depth of what is in a slot, from now on.
#[inline(never)]
fn find_depth<L: Look>(slot: &mut CacheSlot<Active<L::Planes>>, view: &View<'_>) {
    let triangle = view.triangle_of(slot.object);
    let plane = triangle.and_then(|t| depth_plane(&t));
    Flags::of(slot).with_depth(plane.is_none()).keep(slot);
    slot.item.depth = plane.unwrap_or_default();
}

/// Finds the depth of a slot, unless it is known.
#[inline(always)]
pub(super) fn deepen<L: Look>(slot: &mut CacheSlot<Active<L::Planes>>, view: &View<'_>) {
    if !Flags::of(slot).is_deep() {
        find_depth::<L>(slot, view);
    }
}

/// The depth of what is in a slot, along a span.
#[inline(always)]
pub(super) fn slope_of<L: Look>(
    slot: &CacheSlot<Active<L::Planes>>,
    span: Span,
    out: &Line<'_, '_, L>,
) -> Slope {
    if !out.deep {
        return Slope::of_place(out.view, slot.object);
    }
    if Flags::of(slot).lacks_depth() {
        return thin_slope(slot.object, span, out.view, out.number);
    }
    Slope::of_plane(slot.item.depth, out.number)
}

/// The depth of a triangle that is too thin for a plane, along a span.
#[cold]
#[inline(never)]
pub(super) fn thin_slope(object: u16, span: Span, view: &View<'_>, line: u32) -> Slope {
    let Some(triangle) = view.triangle_of(object) else {
        return Slope::even(0);
    };
    let ends = thin_span(&triangle, span, line);
    let [at, step] = ends.line(triangle.vertex.map(|v| i64::from(v.depth)));
    let at = at.wrapping_add(MARGIN);
    Slope { at, step }
}

/// What is in a slot as a rival.
pub(super) fn rival_of<L: Look>(
    slot: &CacheSlot<Active<L::Planes>>,
    span: Span,
    out: &Line<'_, '_, L>,
) -> Rival {
    Rival {
        span,
        slope: slope_of::<L>(slot, span, out),
        object: slot.object,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::random::Rng;
    use std::vec::Vec;

    /// Kills: a column that turns one too early or too late, of equal depths the one that was submitted first, a range of one
    /// column more, and one whose ends are told by the sign of a difference or of a step.
    #[test]
    fn who_is_seen_is_told_for_each_column() {
        let mut rng = Rng(11);
        let (mut crossed, mut equal) = (0, 0);
        for round in 0..40_000 {
            let rival = |rng: &mut Rng, object: u16| {
                let start = rng.below(60);
                let span = Span {
                    start,
                    end: start + 1 + rng.below([3, 40][round % 2]),
                };
                let mut slope = Slope {
                    at: (1 << 20) + rng.below(64),
                    step: rng.below(7).wrapping_sub(3),
                };
                if round % 7 == 0 {
                    // From any depth to any other, the nearest and none at all among them.
                    let [from, to] = [(); 2].map(|()| match rng.below(3) {
                        0 => 0,
                        1 => 1 << 31,
                        _ => rng.below(1 << 31),
                    });
                    let steps = i64::from((span.end - span.start - 1).max(1));
                    slope.step = ((i64::from(to) - i64::from(from)) / steps) as u32;
                    slope.at = from.wrapping_sub(slope.step.wrapping_mul(span.start));
                }
                Rival {
                    span,
                    slope,
                    object,
                }
            };
            let mut pair = [rival(&mut rng, 5), rival(&mut rng, 9)];
            if round % 5 == 0 {
                pair[1].slope = pair[0].slope;
            }
            if round % 3 == 0 {
                pair.swap(0, 1);
            }
            let [a, b] = pair;
            let of = |r: Rival, c: u32| r.slope.at.wrapping_add(r.slope.step.wrapping_mul(c));
            let both: Vec<u32> = (a.span.start..a.span.end)
                .filter(|c| (b.span.start..b.span.end).contains(c))
                .collect();
            let want: Vec<u32> = both
                .iter()
                .copied()
                .filter(|&c| match of(a, c).cmp(&of(b, c)) {
                    std::cmp::Ordering::Equal => a.object > b.object,
                    order => order.is_gt(),
                })
                .collect();
            // Not where one has the other's slope, which may leave all depths there.
            if round % 5 != 0 {
                let depths = || (a.span.start..a.span.end).map(|c| of(a, c));
                let range = [depths().max().unwrap(), depths().min().unwrap()];
                assert_eq!(a.slope.range(a.span), range);
            }
            let hidden = a.hidden_of(b);
            let got: Vec<u32> = hidden.map_or(Vec::new(), |s| (s.start..s.end).collect());
            assert_eq!(got, want);
            crossed += u32::from(!want.is_empty() && want.len() < both.len());
            equal += u32::from(both.iter().any(|&c| of(a, c) == of(b, c)));
        }
        assert!(crossed > 150 && equal > 1_000, "{crossed}, {equal}");
    }
}
