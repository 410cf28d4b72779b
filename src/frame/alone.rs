//! What has no slot: set up for one line, in a place of its own that nobody clears (C5).

use super::renderer::{Renderer, View};
use super::slot::{Active, Flags};
use super::spans::{Drawn, Line, Span};
use super::thin::depth_plane;
use crate::look::{Look, WordOf};
use crate::span::{Frame, Triangle, Way};

/// A triangle without a slot; its planes are in the cache's scratch, up to the next one's.
pub(super) struct Alone {
    depth: [u32; 3],
    flags: Flags,
    object: u16,
    pub(super) span: Span,
}

impl Alone {
    /// As it is drawn, from the scratch.
    #[inline(always)]
    pub(super) fn drawn<'a, P>(&'a self, scratch: &'a Active<P>) -> Drawn<'a, P> {
        Drawn {
            item: scratch,
            depth: &self.depth,
            flags: self.flags,
            object: self.object,
        }
    }

    /// Finds the depth of what has no slot.
    #[inline(always)]
    pub(super) fn find_depth(&mut self, view: &View<'_>) {
        let plane = view.triangle_of(self.object).and_then(|t| depth_plane(&t));
        self.flags = self.flags.without_depth(plane.is_none());
        self.depth = plane.unwrap_or_default();
    }
}

/// The columns of a triangle without a slot.
#[inline(never)]
pub(super) fn columns_of(triangle: &Triangle<'_>, line: u32, frame: Frame) -> Span {
    let way = triangle.way();
    let sides = triangle.sides(way, line as i32, triangle.lines().turn);
    let (start, end) = sides.columns(way, line, frame);
    Span { start, end }
}

impl<L: Look, const WORDS: usize> Renderer<'_, L, WORDS> {
    /// What has no slot, set up for one line, on columns that may be known; `None` where it has no pixels there.
    #[inline(always)]
    pub(super) fn set_up_alone(
        &mut self,
        object: u16,
        columns: Option<Span>,
        out: &Line<'_, '_, WordOf<L>>,
    ) -> Option<Alone> {
        if columns.is_some_and(|span| span.start >= span.end) {
            return None;
        }
        let triangle = out.view.triangle_of(object)?;
        let span = columns.unwrap_or_else(|| columns_of(&triangle, out.number, out.view.frame));
        if span.start >= span.end {
            return None;
        }
        let area = triangle.area();
        let planes = &mut self.cache.scratch.planes;
        let (size, draws) = (triangle.size(area), out.view.draws);
        let fill = L::set_up(&triangle, object, size, area, draws, planes);
        self.counts.set_ups += 1;
        Some(Alone {
            depth: [0; 3],
            // Columns are known: nobody asks for sides.
            flags: Flags::new(fill, Way::PLAIN).without_depth(true),
            object,
            span,
        })
    }
}
