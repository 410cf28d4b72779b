//! A line of calls as the reference has it: coverage from whole numbers, 1/w in f64, and pixels one by one.

use super::calls::{Call, Skinned};
use crate::hot::exact::doubled_area;
use crate::hot::layers::compare_face;
use crate::hot::values::passes;
use scanbeam::scene::Shadow;
use scanbeam::stats::SpanCounts;
use std::cmp::Ordering;
use std::ops::Range;

/// A line of calls as the reference has it.
pub(super) struct Row<'a> {
    pub(super) calls: &'a [Call],
    pub(super) y: u16,
    pub(super) is_textured: bool,
    /// Whether depth is compared.
    pub(super) is_deep: bool,
    /// The columns of each call, before it is cut.
    pub(super) columns: Vec<Range<usize>>,
    /// Of each call its pixels that are no holes.
    pub(super) opaque: &'a [Vec<Vec<bool>>],
}

/// What becomes of one call's pixels.
#[derive(Default)]
pub(super) struct Told {
    pub(super) all: u32,
    pub(super) seen: u32,
    pub(super) hidden: u32,
    pub(super) tests: u32,
    pub(super) fetched: u32,
}

impl Row<'_> {
    pub(super) fn is_covered(&self, i: usize, x: usize) -> bool {
        self.columns[i].contains(&x)
    }

    /// The pixels of a call that its scissor keeps.
    pub(super) fn kept(&self, i: usize) -> Vec<usize> {
        let cut = self.calls[i].cut.as_ref();
        let keeps = |&x: &usize| cut.is_none_or(|cut| cut.keeps(x as u16, self.y));
        self.columns[i].clone().filter(keeps).collect()
    }

    pub(super) fn has_texels(&self, i: usize) -> bool {
        self.is_textured && self.calls[i].skin != Skinned::Bare
    }

    /// Whether a pixel is a hole.
    pub(super) fn is_hole(&self, i: usize, x: usize) -> bool {
        let is_holed = self.is_textured && self.calls[i].skin == Skinned::Holed;
        is_holed && !self.opaque[i][usize::from(self.y)][x]
    }

    /// Whether a call shares a column with another.
    pub(super) fn meets(&self, i: usize) -> bool {
        let meets = |&x: &usize| (0..self.calls.len()).any(|k| k != i && self.is_covered(k, x));
        self.columns[i].clone().any(|x| meets(&x))
    }

    /// The figures; `None` where they hang on what depth may err.
    pub(super) fn counts(&self) -> Option<SpanCounts> {
        let mut counts = SpanCounts::default();
        let here = |i: &usize| !self.columns[*i].is_empty();
        let all: Vec<usize> = (0..self.calls.len()).filter(here).collect();
        let valued = |&i: &usize| self.calls[i].has_values(self.is_textured);
        if !all.iter().any(valued) {
            self.bare(&all, &mut counts)?;
        } else if self.is_deep {
            self.deep(&all, &mut counts)?;
        } else {
            self.in_order(&all, &mut counts);
        }
        Some(counts)
    }

    pub(super) fn add(counts: &mut SpanCounts, told: &Told, is_untested: bool) {
        if told.all > 0 {
            counts.spans += 1;
            counts.spans_hidden += u32::from(told.seen == 0);
            counts.spans_untested += u32::from(is_untested);
            counts.pixels_shaded += told.seen;
            counts.pixels_hidden += told.hidden;
            counts.depth_tests += told.tests;
            counts.texture_fetches += told.fetched;
        }
    }

    /// Without values: of each column one call is seen.
    pub(super) fn bare(&self, all: &[usize], counts: &mut SpanCounts) -> Option<()> {
        for &i in all {
            let mut told = Told::default();
            for x in self.columns[i].clone() {
                let mut is_seen = true;
                for &k in all.iter().filter(|&&k| k != i && self.is_covered(k, x)) {
                    let (a, b) = (&self.calls[i], &self.calls[k]);
                    let order = if self.is_deep {
                        a.compare(Some(b), [x as u16, self.y])?
                    } else {
                        a.priority.cmp(&b.priority)
                    };
                    is_seen &= order.then(i.cmp(&k)).is_gt();
                }
                told.all += 1;
                told.seen += u32::from(is_seen);
                told.hidden += u32::from(!is_seen);
                told.fetched += u32::from(is_seen && self.has_texels(i));
            }
            Self::add(counts, &told, !self.meets(i));
        }
        Some(())
    }

    /// With values and without depth: one over the other.
    pub(super) fn in_order(&self, all: &[usize], counts: &mut SpanCounts) {
        for &i in all {
            let is_in_vain = matches!(
                self.calls[i].shadow,
                Some(Shadow::Volume(_) | Shadow::Shadowed(_))
            );
            if !is_in_vain {
                let kept = self.kept(i);
                let seen = kept.iter().filter(|&&x| !self.is_hole(i, x)).count() as u32;
                let told = Told {
                    all: kept.len() as u32,
                    seen,
                    fetched: if self.has_texels(i) {
                        kept.len() as u32
                    } else {
                        0
                    },
                    ..Told::default()
                };
                Self::add(counts, &told, !self.meets(i));
            }
        }
    }

    /// With values and depth.
    pub(super) fn deep(&self, all: &[usize], counts: &mut SpanCounts) -> Option<()> {
        let mut cells: Vec<Option<usize>> = vec![None; 2_000];
        // Where spans meet, or one compares.
        let asked = |x: usize| {
            let here: Vec<_> = all.iter().filter(|&&k| self.is_covered(k, x)).collect();
            here.len() > 1 || here.iter().any(|&&k| self.calls[k].compares())
        };
        let is_late = |i: usize| self.calls[i].shadow.is_some() || self.calls[i].is_translucent();
        for &i in all.iter().filter(|&&i| !is_late(i)) {
            let is_compared = self.columns[i].clone().any(asked);
            let told = self.laid(i, is_compared, &mut cells)?;
            Self::add(counts, &told, !is_compared);
        }
        for light in 0..8 {
            self.light(light, all, &cells, counts)?;
        }
        for &i in all.iter().filter(|&&i| is_late(i)) {
            if self.calls[i].shadow.is_none() {
                let told = self.laid(i, true, &mut cells.clone())?;
                Self::add(counts, &told, false);
            }
        }
        Some(())
    }

    /// A call that is laid over what is there.
    pub(super) fn laid(
        &self,
        i: usize,
        is_compared: bool,
        cells: &mut [Option<usize>],
    ) -> Option<Told> {
        let call = &self.calls[i];
        let is_holed = self.is_textured && call.skin == Skinned::Holed;
        let mut told = Told::default();
        for x in self.kept(i) {
            told.all += 1;
            told.fetched += u32::from(is_holed);
            if self.is_hole(i, x) {
                continue;
            }
            let mut is_seen = true;
            if is_compared {
                let there = cells[x].map(|k| &self.calls[k]);
                let order = call.compare(there, [x as u16, self.y])?;
                told.tests += 1;
                is_seen = passes(call.test[0], order);
                if passes(call.test[1], order) {
                    cells[x] = Some(i);
                }
            }
            told.seen += u32::from(is_seen);
            told.hidden += u32::from(!is_seen);
            told.fetched += u32::from(is_seen && !is_holed && self.has_texels(i));
        }
        Some(told)
    }

    /// The volumes of a light, and what is seen again by it.
    fn light(
        &self,
        light: u8,
        all: &[usize],
        cells: &[Option<usize>],
        counts: &mut SpanCounts,
    ) -> Option<()> {
        let of = |i: usize, shadow: Shadow| self.calls[i].shadow == Some(shadow);
        let receives = |&i: &usize| of(i, Shadow::Lit(light)) || of(i, Shadow::Shadowed(light));
        if !all.iter().any(receives) {
            return Some(());
        }
        let mut inside = vec![0; cells.len()];
        for &i in all.iter().filter(|&&i| of(i, Shadow::Volume(light))) {
            let corners = &self.calls[i].corners;
            let is_back = doubled_area(corners.map(|c| c.at)) > 0;
            for x in self.kept(i) {
                counts.depth_tests += 1;
                let there = cells[x].map(|k| &self.calls[k].corners);
                if compare_face(corners, there, [x as u16, self.y])? == Ordering::Greater {
                    inside[x] += if is_back { 1 } else { -1 };
                }
            }
        }
        let mut done = vec![false; cells.len()];
        for &i in all.iter().filter(|i| receives(i)) {
            let mut told = Told::default();
            let is_once = self.calls[i].is_translucent();
            for x in self.kept(i) {
                told.all += 1;
                let is_due = (inside[x] != 0) == of(i, Shadow::Shadowed(light));
                let mut is_seen = false;
                if is_due && !(is_once && done[x]) {
                    told.tests += 1;
                    let there = cells[x].map(|k| &self.calls[k]);
                    let order = self.calls[i].compare(there, [x as u16, self.y])?;
                    is_seen = order == Ordering::Equal;
                    done[x] |= is_seen && is_once;
                }
                told.hidden += u32::from(!is_seen);
                told.fetched += u32::from(is_seen && self.has_texels(i));
                told.seen += u32::from(is_seen && !self.is_hole(i, x));
            }
            Self::add(counts, &told, false);
        }
        Some(())
    }
}
