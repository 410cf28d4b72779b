//! What has no slot: set up for one line (C5).

use super::guests::{Stray, Walk};
use super::renderer::Renderer;
use super::slot::Flags;
use super::spans::{Drawn, Line, colour};
use crate::active::CacheUse;
use crate::look::{Fill, Look, Primitive};
use crate::span::Way;

/// A triangle without a slot, set up for one line.
pub(super) struct Alone<P> {
    planes: P,
    flags: Flags,
    object: u16,
}

impl<P> Alone<P> {
    /// Nothing yet: `planes` are empty.
    #[inline(never)]
    pub(super) fn empty(planes: P) -> Self {
        Self {
            planes,
            flags: Flags::new(Fill::Plain, Way::PLAIN),
            object: 0,
        }
    }

    /// Becomes a triangle whose colours are not asked for.
    #[inline(always)]
    pub(super) fn darken(&mut self, stray: &Stray<'_>) {
        self.object = stray.object;
        self.flags = Flags::new(Fill::Plain, Way::PLAIN);
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

/// Sets up what has no slot for one line, where it will be read: planes are not copied.
#[inline(never)]
pub(super) fn set_up_stray<L: Look>(
    stray: &Stray<'_>,
    alone: &mut Alone<L::Planes>,
    counts: &mut CacheUse,
    out: &Line<'_, '_, L>,
) {
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
    alone.darken(stray);
    let fill = L::set_up(&of, &mut alone.planes);
    alone.flags = alone.flags.with_fill(fill);
    if out.view.dithers(stray.object) {
        alone.flags = alone.flags.with_values();
    }
    counts.set_ups += 1;
}

impl<L: Look, const WORDS: usize> Renderer<'_, L, WORDS> {
    /// Colours what has no slot, where nobody is yet; `false` as soon as one meets another.
    #[inline(never)]
    pub(super) fn draw_all_alone(&mut self, out: &mut Line<'_, '_, L>) -> bool {
        let mut walk = Walk::of(self.cache.spilled);
        let (mut alone, mut misses) = (Alone::empty(L::EMPTY), 0);
        while let Some(stray) = self.next_stray(&mut walk, out) {
            if self.covered.cover(stray.span.start, stray.span.end) != 0 {
                return false;
            }
            set_up_stray::<L>(&stray, &mut alone, &mut self.counts, out);
            colour::<L>(alone.drawn(), stray.span, out);
            misses += 1;
        }
        self.counts.misses += misses;
        true
    }
}
