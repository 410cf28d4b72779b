//! The pixels of a span.

use super::renderer::{Dither, View};
use super::rival::Slope;
use super::slot::{Active, Flags};
use super::thin::thin_span;
use crate::active::CacheSlot;
use crate::look::{Fill, Look, Place, WordOf};
use crate::visible::Mask;

/// A line that is drawn.
pub(super) struct Line<'a, 'v, L: Look> {
    pub(super) view: &'a View<'v>,
    pub(super) number: u32,
    pub(super) pixels: &'a mut [WordOf<L>],
    /// What dithers, where a scene may.
    pub(super) dither: Option<Dither<L>>,
    /// Whether the nearest span is seen; otherwise the one of the highest priority, of equals the one submitted last.
    pub(super) deep: bool,
    /// Whether slots are sorted by depth.
    pub(super) nearest_first: bool,
}

/// The columns of a span.
#[derive(Clone, Copy)]
pub(super) struct Span {
    pub(super) start: u32,
    pub(super) end: u32,
}

/// The depth of a line, as far as it is known.
pub(super) struct Known<'a> {
    /// The depth of the triangle that is compared.
    pub(super) slope: Slope,
    pub(super) cells: &'a mut [u32],
    pub(super) written: &'a mut Mask,
}

impl<'a> Known<'a> {
    #[inline(always)]
    pub(super) fn new(slope: Slope, cells: &'a mut [u32], written: &'a mut Mask) -> Self {
        Self {
            slope,
            cells,
            written,
        }
    }
}

/// A triangle as it is drawn: from a slot, or set up for one line.
#[derive(Clone, Copy)]
pub(super) struct Drawn<'a, P> {
    pub(super) planes: &'a P,
    pub(super) flags: Flags,
    pub(super) object: u16,
}

/// The planes of a thin triangle on the line of one of its spans.
#[cold]
#[inline(never)]
pub(super) fn thin_planes<L: Look>(object: u16, at: Place, view: &View<'_>) -> L::Planes {
    let mut planes = L::EMPTY;
    if let Some(triangle) = view.triangle_of(object) {
        let span = Span::new(at.span, at.end);
        let ends = thin_span(&triangle, span, at.line);
        L::set_up_thin(&ends, object, &view.draws, &mut planes);
    }
    planes
}

/// The columns of a slot.
#[inline(always)]
pub(super) fn columns_of<L: Look>(
    slot: &CacheSlot<Active<L::Planes>>,
    out: &Line<'_, '_, L>,
) -> Span {
    let (way, sides) = (Flags::of(slot).way(), &slot.item.sides);
    let (start, end) = sides.columns(way, out.number, out.view.frame);
    Span { start, end }
}

/// Colours the span of a slot.
#[inline(never)]
pub(super) fn colour_slot<L: Look>(
    slot: &CacheSlot<Active<L::Planes>>,
    span: u32,
    out: &mut Line<'_, '_, L>,
) {
    let (span, flags) = (Span::of(span), Flags::of(slot));
    let is_usual = match L::TEXTURED {
        true => !flags.is_other(),
        false => flags.is_coloured_plainly(),
    };
    if !is_usual {
        return colour::<L>(Drawn::of(slot), span, out);
    }
    let Some(run) = out.pixels.get_mut(span.start as usize..span.end as usize) else {
        return;
    };
    let at = span.place(span.start, out.number);
    let (planes, draws) = (&slot.item.planes, out.view.draws.states);
    if L::TEXTURED {
        return L::fill_slot(flags.fill(), planes, at, draws, run);
    }
    L::fill_plain(planes, at, draws, run);
}

/// Colours a span.
#[inline(always)]
pub(super) fn colour<L: Look>(drawn: Drawn<'_, L::Planes>, span: Span, out: &mut Line<'_, '_, L>) {
    colour_run::<L>(drawn, span, span, out);
}

/// Colours a run of a span.
#[inline(always)]
pub(super) fn colour_run<L: Look>(
    drawn: Drawn<'_, L::Planes>,
    span: Span,
    run: Span,
    out: &mut Line<'_, '_, L>,
) {
    let Some(pixels) = out.pixels.get_mut(run.start as usize..run.end as usize) else {
        return;
    };
    let at = span.place(run.start, out.number);
    let (planes, flags, object) = (drawn.planes, drawn.flags, drawn.object);
    if flags.is_other() {
        return colour_other::<L>(planes, flags, object, at, out.view, out.dither, pixels);
    }
    L::fill(flags.fill(), planes, at, out.view.draws.states, pixels);
}

/// Colours a run that is dithered, or of a thin triangle. What is drawn comes in parts, so that nobody who calls this
/// keeps it whole.
#[cold]
#[inline(never)]
fn colour_other<L: Look>(
    planes: &L::Planes,
    flags: Flags,
    object: u16,
    at: Place,
    view: &View<'_>,
    dither: Option<Dither<L>>,
    pixels: &mut [WordOf<L>],
) {
    if let Some(dither) = dither.filter(|_| flags.has_values()) {
        let drawn = Drawn {
            planes,
            flags,
            object,
        };
        return dither(drawn, at, view, pixels);
    }
    let planes = thin_planes::<L>(object, at, view);
    L::fill(Fill::Wide, &planes, at, view.draws.states, pixels);
}

impl<'a, P> Drawn<'a, P> {
    /// What is in a slot.
    #[inline(always)]
    pub(super) fn of(slot: &'a CacheSlot<Active<P>>) -> Self {
        Self {
            planes: &slot.item.planes,
            flags: Flags::of(slot),
            object: slot.object,
        }
    }
}

impl Span {
    #[inline(always)]
    pub(super) const fn new(start: u32, end: u32) -> Self {
        Self { start, end }
    }

    /// The place of a column of the span on a line.
    #[inline(always)]
    pub(super) fn place(self, column: u32, line: u32) -> Place {
        Place {
            span: self.start,
            end: self.end,
            column,
            line,
        }
    }

    /// Whether two spans that are not empty share a column.
    #[inline(always)]
    pub(super) fn meets(self, other: Self) -> bool {
        self.start < other.end && other.start < self.end
    }

    /// What two spans share; it may be empty.
    #[inline(always)]
    pub(super) fn within(self, other: Self) -> Self {
        Self::new(self.start.max(other.start), self.end.min(other.end))
    }

    /// The first run of the span that a mask has not, which it has from now on; the span is what lies behind it then.
    #[inline(always)]
    pub(super) fn take_run(&mut self, mask: &mut Mask) -> Option<Self> {
        if self.start >= self.end {
            return None;
        }
        let run = Self::of(mask.take_run(self.start, self.end));
        self.start = run.end;
        (run.end != 0).then_some(run)
    }

    #[inline(always)]
    pub(super) fn of(word: u32) -> Self {
        Self {
            start: word >> 16,
            end: word & 0xFFFF,
        }
    }
}
