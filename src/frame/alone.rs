//! What has no slot: set up for one line (C5).

use super::renderer::{Renderer, View};
use super::slot::Flags;
use super::spans::{Drawn, Line, Span, colour};
use super::thin::depth_plane;
use crate::active::next;
use crate::link::Link;
use crate::look::{Look, WordOf};

/// A triangle without a slot, set up for one line.
pub(super) struct Alone<P> {
    planes: P,
    flags: Flags,
    object: u16,
    pub(super) span: Span,
}

impl<P> Alone<P> {
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

impl<L: Look, const WORDS: usize> Renderer<'_, L, WORDS> {
    /// What has no slot, set up for one line; `None` where it has no pixels there.
    #[inline(never)]
    pub(super) fn set_up_alone(
        &mut self,
        object: u16,
        out: &Line<'_, '_, WordOf<L>>,
    ) -> Option<Alone<L::Planes>> {
        let triangle = out.view.triangle_of(object)?;
        let area = triangle.area();
        let size = triangle.size(area);
        let way = triangle.way();
        let sides = triangle.sides(way, out.number as i32, triangle.lines().turn);
        let (start, end) = sides.columns(way, out.number, out.view.frame);
        if start >= end {
            return None;
        }
        let mut planes = L::EMPTY;
        let fill = L::set_up(&triangle, object, size, area, out.view.draws, &mut planes);
        self.counts.set_ups += 1;
        Some(Alone {
            planes,
            flags: Flags::new(fill, way).without_depth(true),
            object,
            span: Span { start, end },
        })
    }

    /// Colours what has no slot, where nobody is yet; `false` as soon as one meets another. What has ended leaves the
    /// chain.
    #[inline(never)]
    pub(super) fn draw_all_alone(&mut self, out: &mut Line<'_, '_, WordOf<L>>) -> bool {
        let (mut before, mut at) = (Link::NONE, self.cache.spilled);
        let mut misses = 0;
        while at.is_some() {
            let after = next(self.links, at);
            let Some(triangle) = out.view.triangle_of(at.object()) else {
                break;
            };
            if triangle.lines().end <= out.number as i32 {
                self.cache.relink(before, after, self.links);
            } else {
                if let Some(alone) = self.set_up_alone(at.object(), out) {
                    if self.covered.cover(alone.span.start, alone.span.end) != 0 {
                        return false;
                    }
                    colour::<L>(alone.drawn(), alone.span, out);
                }
                misses += 1;
                before = at;
            }
            at = after;
        }
        self.counts.misses += misses;
        true
    }

    /// The plane of depth of what has no slot.
    #[inline(never)]
    pub(super) fn find_depth(alone: &mut Alone<L::Planes>, view: &View<'_>) -> [u32; 3] {
        let triangle = view.triangle_of(alone.object);
        let plane = triangle.and_then(|t| depth_plane(&t));
        alone.flags = alone.flags.without_depth(plane.is_none());
        plane.unwrap_or_default()
    }
}
