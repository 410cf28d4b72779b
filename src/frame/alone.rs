//! What has no slot: set up for one line (C5).

use super::guests::{Stray, Walk};
use super::renderer::{Renderer, View};
use super::slot::Flags;
use super::spans::{Drawn, Line, Span, colour};
use super::thin::depth_plane;
use crate::active::CacheUse;
use crate::look::{Fill, Look, Primitive};
use crate::span::Way;

/// A triangle without a slot, set up for one line.
pub(super) struct Alone<P> {
    planes: P,
    flags: Flags,
    object: u16,
    pub(super) span: Span,
}

impl<P> Alone<P> {
    /// Without its colours: `planes` are empty.
    #[inline(always)]
    pub(super) fn dark(stray: &Stray<'_>, planes: P) -> Self {
        Self {
            planes,
            // Its columns are known, and its depth is not.
            flags: Flags::new(Fill::Plain, Way::PLAIN).with_depth(true),
            object: stray.object,
            span: stray.span,
        }
    }

    /// As it is drawn.
    #[inline(always)]
    pub(super) fn drawn(&self) -> Drawn<'_, P> {
        Drawn {
            planes: &self.planes,
            flags: self.flags,
            object: self.object,
        }
    }
}

/// What has no slot, set up for one line.
#[inline(never)]
pub(super) fn set_up_stray<L: Look>(
    stray: &Stray<'_>,
    counts: &mut CacheUse,
    out: &Line<'_, '_, L>,
) -> Alone<L::Planes> {
    let triangle = &stray.triangle;
    let area = triangle.area();
    let size = triangle.size(area);
    let of = Primitive {
        triangle,
        object: stray.object,
        size,
        area,
        draws: &out.view.draws,
    };
    // Its planes are made where they are given back, so that nothing is copied.
    let mut alone = Alone::dark(stray, L::EMPTY);
    let fill = L::set_up(&of, &mut alone.planes);
    alone.flags = Flags::new(fill, Way::PLAIN).with_depth(true);
    if out.view.dithers(stray.object) {
        alone.flags = alone.flags.with_values();
    }
    counts.set_ups += 1;
    alone
}

impl<L: Look, const WORDS: usize> Renderer<'_, L, WORDS> {
    /// What has no slot, set up for one line; `None` where it has no pixels there.
    #[inline(never)]
    pub(super) fn set_up_alone(
        &mut self,
        object: u16,
        out: &Line<'_, '_, L>,
    ) -> Option<Alone<L::Planes>> {
        let stray = out.stray(object)?;
        Some(set_up_stray::<L>(&stray, &mut self.counts, out))
    }

    /// Colours what has no slot, where nobody is yet; `false` as soon as one meets another.
    #[inline(never)]
    pub(super) fn draw_all_alone(&mut self, out: &mut Line<'_, '_, L>) -> bool {
        let mut walk = Walk::of(self.cache.spilled);
        let mut misses = 0;
        while let Some(stray) = self.next_stray(&mut walk, out) {
            if self.covered.cover(stray.span.start, stray.span.end) != 0 {
                return false;
            }
            let alone = set_up_stray::<L>(&stray, &mut self.counts, out);
            colour::<L>(alone.drawn(), alone.span, out);
            misses += 1;
        }
        self.counts.misses += misses;
        true
    }

    /// The plane of depth of what has no slot.
    #[inline(never)]
    pub(super) fn find_depth(alone: &mut Alone<L::Planes>, view: &View<'_>) -> [u32; 3] {
        let triangle = view.triangle_of(alone.object);
        let plane = triangle.and_then(|t| depth_plane(&t));
        alone.flags = alone.flags.with_depth(plane.is_none());
        plane.unwrap_or_default()
    }
}
