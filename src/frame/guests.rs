//! What has no slot, where spans meet: guests, which lie in the cells of depth while a line is drawn (X3, C5).
//!
//! A guest is set up for its line alone, and only where some of it is seen.

use super::near::{Drawing, Field, Taken, colour_free};
use super::renderer::Renderer;
use super::rival::{Rival, Slope, thin_slope};
use super::slot::Flags;
use super::spans::{Drawn, Line, Span, colour_run};
use super::thin::depth_plane;
use crate::look::{Look, WordOf};
use crate::span::Way;
use crate::visible::Mask;

/// A span of what has no slot, as it lies in the cells of depth: `CELLS` of them.
#[derive(Clone, Copy)]
pub(super) struct Guest {
    /// Its nearest depth.
    pub(super) key: u32,
    pub(super) rival: Rival,
}

/// Cells of depth that a guest takes.
pub(super) const CELLS: usize = 5;

impl Guest {
    #[inline(always)]
    pub(super) fn of(cells: &[u32], number: usize) -> Option<Self> {
        let cells = cells.get(CELLS * number..CELLS * (number + 1))?;
        let &[key, object, span, at, step] = cells else {
            return None;
        };
        let slope = Slope { at, step };
        let rival = Rival {
            span: Span::of(span),
            slope,
            object: object as u16,
        };
        Some(Self { key, rival })
    }

    /// Keeps it, where there are enough cells.
    #[inline(always)]
    pub(super) fn keep(self, cells: &mut [u32], number: usize) {
        let Some(cells) = cells.get_mut(CELLS * number..CELLS * (number + 1)) else {
            return;
        };
        let Rival {
            span,
            slope,
            object,
        } = self.rival;
        let words = [
            self.key,
            u32::from(object),
            span.start << 16 | span.end,
            slope.at,
            slope.step,
        ];
        cells.copy_from_slice(&words);
    }
}

impl<L: Look, const WORDS: usize> Field<'_, L, WORDS> {
    /// The nearest depth of a guest; 0 where there is none.
    #[inline(always)]
    pub(super) fn guest_key(&self, at: usize) -> u32 {
        if at >= self.guests {
            return 0;
        }
        Guest::of(self.cells, at).map_or(0, |guest| guest.key)
    }

    /// Draws the guest that comes next; the key of the one after it.
    #[inline(never)]
    pub(super) fn next_guest(
        &self,
        taken: &mut Taken,
        drawing: &mut Drawing<'_>,
        out: &mut Line<'_, '_, WordOf<L>>,
    ) -> u32 {
        let guest = Guest::of(self.cells, taken.guests);
        taken.guests += 1;
        if let Some(guest) = guest {
            self.draw_guest(guest, *taken, drawing, out);
        }
        self.guest_key(taken.guests)
    }

    /// Draws a guest before what comes later.
    #[inline(never)]
    fn draw_guest(
        &self,
        guest: Guest,
        after: Taken,
        drawing: &mut Drawing<'_>,
        out: &mut Line<'_, '_, WordOf<L>>,
    ) {
        let rival = guest.rival;
        let [_, far] = rival.slope.range(rival.span);
        let Span { start, end } = rival.span;
        if drawing.mask.has_all(start, end) {
            drawing.hidden += 1;
            return;
        }
        if !self.is_contested(rival.span, far, after.slots) && self.guest_key(after.guests) < far {
            return colour_guest::<L>(rival, None, drawing, out);
        }
        let mut taken = *drawing.mask;
        self.hide(rival, far, after, out, &mut taken);
        if !taken.has_all(start, end) {
            colour_guest::<L>(rival, Some(&mut taken), drawing, out);
        }
    }
}

/// Colours what has no slot, where nobody is and but for columns that are taken.
#[inline(never)]
fn colour_guest<L: Look>(
    rival: Rival,
    taken: Option<&mut Mask>,
    drawing: &mut Drawing<'_>,
    out: &mut Line<'_, '_, WordOf<L>>,
) {
    let Some(triangle) = out.view.triangle_of(rival.object) else {
        return;
    };
    let area = triangle.area();
    let size = triangle.size(area);
    let mut planes = L::EMPTY;
    let (object, draws) = (rival.object, out.view.draws);
    let fill = L::set_up(&triangle, object, size, area, draws, &mut planes);
    drawing.counts.set_ups += 1;
    let drawn = Drawn {
        planes: &planes,
        flags: Flags::new(fill, Way::PLAIN),
        object,
    };
    if let Some(taken) = taken {
        return colour_free::<L>(drawing.mask, taken, drawn, rival.span, out);
    }
    let Span { start, end } = rival.span;
    drawing.mask.cover_free(start, end, |start, end| {
        colour_run::<L>(drawn, rival.span, Span { start, end }, out);
    });
}

impl<L: Look, const WORDS: usize> Renderer<'_, L, WORDS> {
    /// Keeps a span of what has no slot, for [`draw_near`](Renderer::draw_near).
    #[inline(always)]
    pub(super) fn keep_guest(&mut self, object: u16, span: Span) {
        let slope = Slope { at: 0, step: 0 };
        let rival = Rival {
            span,
            slope,
            object,
        };
        Guest { key: 0, rival }.keep(self.depth, self.guests);
        self.guests += 1;
    }

    /// Whether what has no slot on this line can be sorted.
    #[inline(always)]
    pub(super) fn has_room(&self) -> bool {
        !self.depth.is_empty() && CELLS * self.guests <= self.depth.len()
    }

    /// Sorts what has no slot, all of it or what meets others, and colours the rest; how many are sorted.
    #[inline(never)]
    pub(super) fn sort_guests(&mut self, all: bool, out: &mut Line<'_, '_, WordOf<L>>) -> usize {
        let mut count = 0;
        for k in 0..core::mem::take(&mut self.guests) {
            let Some(mut guest) = Guest::of(self.depth, k) else {
                break;
            };
            let Rival { span, object, .. } = guest.rival;
            if !all && !self.over.meets(span.start, span.end) {
                let mut mask = Mask::EMPTY;
                let mut drawing = Drawing {
                    mask: &mut mask,
                    counts: &mut self.counts,
                    hidden: 0,
                };
                colour_guest::<L>(guest.rival, None, &mut drawing, out);
                continue;
            }
            let triangle = out.view.triangle_of(object);
            guest.rival.slope = match triangle.and_then(|t| depth_plane(&t)) {
                Some([at, step, down]) => Slope {
                    at: at.wrapping_add(down.wrapping_mul(out.number)),
                    step,
                },
                None => thin_slope::<L>(object, span, out),
            };
            [guest.key, _] = guest.rival.slope.range(span);
            let mut at = count;
            while at > 0 {
                match Guest::of(self.depth, at - 1) {
                    Some(before) if before.key < guest.key => before.keep(self.depth, at),
                    _ => break,
                }
                at -= 1;
            }
            guest.keep(self.depth, at);
            count += 1;
        }
        count
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lies_in_cells_comes_back() {
        let rival = Rival {
            span: Span {
                start: 3,
                end: 1016,
            },
            slope: Slope {
                at: 0x8123_4567,
                step: 0xFFFF_FF00,
            },
            object: 61_439,
        };
        let guest = Guest { key: 77, rival };
        let mut cells = [0; 3 * CELLS - 1];
        guest.keep(&mut cells, 1);
        let back = Guest::of(&cells, 1).unwrap();
        assert_eq!((back.key, back.rival.object), (77, 61_439));
        let Slope { at, step } = back.rival.slope;
        assert_eq!((at, step), (rival.slope.at, rival.slope.step));
        assert_eq!((back.rival.span.start, back.rival.span.end), (3, 1016));
        guest.keep(&mut cells, 2);
        assert!(Guest::of(&cells, 2).is_none());
        assert_eq!(cells[..CELLS], [0; CELLS]);
        assert_eq!(cells[2 * CELLS..], [0; CELLS - 1]);
    }
}
