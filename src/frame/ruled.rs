//! The pixels of a span whose draw call has values that few have (H9, H15, K11).
//!
//! What the scissor keeps is compared 32 pixels at a time, and what is seen of that is coloured in runs, or blended over what is there. So a
//! triangle has the same columns, depths and planes as without such values. Where the texture has holes, or pixels have
//! alphas of their own, colours come first, 32 at a time, and what holes leave is compared.

use super::alpha::Surface;
use super::renderer::View;
use super::spans::{Drawn, Known, Line, Span, thin_planes};
use crate::look::{Fill, Look, Place, WordOf};
use crate::num::{few_leading_zeros, rolled};
use crate::pixel::{blend, blend_each};
use crate::scene::{DepthTest, DrawState, MaskTexel, PixelAlpha};
use crate::visible::{MOST_TESTED, Part, keep, test};
use core::ops::Range;

/// A span of a triangle, and the values of its draw call.
#[derive(Clone, Copy)]
pub(super) struct Ruled<'a, P> {
    pub(super) drawn: Drawn<'a, P>,
    pub(super) span: Span,
    pub(super) state: &'a DrawState<'a>,
}

/// What colours the runs of a span.
pub(super) struct Ink<'a, P> {
    pub(super) fill: Fill,
    pub(super) planes: &'a P,
    span: Span,
    state: &'a DrawState<'a>,
    surface: Surface,
}

/// Colours those pixels between `from` and `to` that the values let through; without depth nothing is compared.
#[inline(never)]
pub(super) fn draw_ruled<L: Look>(
    ruled: Ruled<'_, L::Planes>,
    part: Span,
    out: &mut Line<'_, '_, L>,
    mut known: Option<Known<'_>>,
) {
    let Ruled { span, state, .. } = ruled;
    let mut others = None;
    let ink = ink_of::<L>(ruled, &mut others, out);
    let part = span.within(part);
    for Range { start, end } in state.cut(out.number, part.start..part.end) {
        let run = Span { start, end };
        if start >= end {
            continue;
        }
        if state.is_by_pixel() {
            lay_by_pixel::<L>(&ink, run, out, &mut known);
            continue;
        }
        match &mut known {
            Some(known) => compare(run, state, known, &mut |seen| {
                lay::<L>(&ink, seen, out);
            }),
            None => lay::<L>(&ink, run, out),
        }
    }
}

/// Colours a run, dithered: on a line without values, where nothing is compared.
pub(super) fn colour_dithered<L: Look>(
    drawn: Drawn<'_, L::Planes>,
    at: Place,
    view: &View<'_>,
    run: &mut [WordOf<L>],
) {
    let mut others = None;
    let fill = fill_of::<L>(drawn, at, true, &mut others, view);
    let planes = others.as_ref().unwrap_or(drawn.planes);
    L::fill_opaque(fill, planes, at, view.draws.states, true, run);
}

/// What colours a span; `others` keeps its planes where those of the triangle do not do.
#[inline(always)]
pub(super) fn ink_of<'a, L: Look>(
    ruled: Ruled<'a, L::Planes>,
    others: &'a mut Option<L::Planes>,
    out: &Line<'_, '_, L>,
) -> Ink<'a, L::Planes> {
    let Ruled { drawn, span, state } = ruled;
    let at = span.place(span.start, out.number);
    let fill = fill_of::<L>(drawn, at, state.dithers, others, out.view);
    Ink {
        fill,
        planes: others.as_ref().unwrap_or(drawn.planes),
        span,
        state,
        surface: state
            .alphas
            .and_then(|alphas| Surface::of(alphas, drawn.object, span, out.number, out.view))
            .unwrap_or(Surface::OPAQUE),
    }
}

/// How a span is coloured: by planes of its own where it is thin, and where it is dithered and those of the triangle do
/// not keep enough for that.
#[inline(always)]
fn fill_of<L: Look>(
    drawn: Drawn<'_, L::Planes>,
    at: Place,
    dithers: bool,
    others: &mut Option<L::Planes>,
    view: &View<'_>,
) -> Fill {
    let mut fill = drawn.flags.fill();
    if dithers && fill == Fill::Plain {
        let mut planes = *drawn.planes;
        let triangle = view.triangle_of(drawn.object);
        if let Some(finer) = triangle.and_then(|t| L::set_up_dithered(&t, &mut planes)) {
            (fill, *others) = (finer, Some(planes));
        }
    }
    if fill == Fill::Thin {
        (fill, *others) = (Fill::Wide, Some(thin_planes::<L>(drawn.object, at, view)));
    }
    fill
}

/// The depths of a run; what nobody has written is farthest away.
#[inline(never)]
pub(super) fn cells_of<'a>(run: Span, known: &'a mut Known<'_>) -> Option<&'a mut [u32]> {
    let (cells, is_new) = written_cells(run, known)?;
    if is_new {
        cells.fill(0);
    }
    Some(cells)
}

/// The same, and whether nobody has written any, as they are then.
#[inline(always)]
fn written_cells<'a>(run: Span, known: &'a mut Known<'_>) -> Option<(&'a mut [u32], bool)> {
    let part = known.written.cover_part(run.start, run.end, |column| {
        if let Some(cell) = known.cells.get_mut(column) {
            *cell = 0;
        }
    });
    let cells = known.cells.get_mut(run.start as usize..run.end as usize)?;
    Some((cells, part == Part::None))
}

/// Calls `f` with each run of pixels that pass the test.
#[inline(never)]
fn compare(run: Span, state: &DrawState<'_>, known: &mut Known<'_>, f: &mut dyn FnMut(Span)) {
    let slope = known.slope;
    let Some((cells, is_new)) = written_cells(run, known) else {
        return;
    };
    if is_new {
        if state.depth == DepthTest::HIDES {
            keep(cells, slope.at(run.start), slope.step);
            return f(run);
        }
        cells.fill(0);
    }
    let firsts = (run.start..).step_by(MOST_TESTED);
    for (cells, first) in cells.chunks_mut(MOST_TESTED).zip(firsts) {
        let seen = test(cells, slope.at(first), slope.step, state.depth);
        each_run(seen, first, f);
    }
}

/// Calls `f` with each run of bits that are set; the top one is the pixel at `start`.
#[inline(never)]
pub(super) fn each_run(mut bits: u32, mut start: u32, f: &mut dyn FnMut(Span)) {
    while bits != 0 {
        let skipped = few_leading_zeros(bits);
        let pixels = few_leading_zeros(!(bits << (skipped & 31))).min(32 - skipped);
        start += skipped;
        let end = start + pixels;
        f(Span { start, end });
        start = end;
        bits = bits.checked_shl(skipped + pixels).unwrap_or(0);
    }
}

/// Colours a run, or blends it, where pixels are not all alike. Colours are found before depth is asked, and once: holes
/// keep none.
#[inline(never)]
fn lay_by_pixel<L: Look>(
    ink: &Ink<'_, L::Planes>,
    run: Span,
    out: &mut Line<'_, '_, L>,
    known: &mut Option<Known<'_>>,
) {
    let state = ink.state;
    let mut colours = [WordOf::<L>::default(); MOST_TESTED];
    let mut alphas = [PixelAlpha::OPAQUE; MOST_TESTED];
    for from in (run.start..run.end).step_by(MOST_TESTED) {
        let pixels = (run.end - from).min(MOST_TESTED as u32);
        let all = ..pixels as usize;
        let (Some(new), Some(alphas)) = (colours.get_mut(all), alphas.get_mut(all)) else {
            return;
        };
        let at = ink.span.place(from, out.number);
        let draws = out.view.draws.states;
        let opaque = L::fill_opaque(ink.fill, ink.planes, at, draws, state.dithers, new);
        let has_alphas = state.has_alphas();
        if has_alphas {
            find_alphas::<L>(ink, at, out.view, alphas);
            if L::TEXTURED && state.dithers {
                undither::<L>(ink, at, out.view, alphas, new);
            }
        }
        let mut put = |seen: Span| {
            let columns = |from: u32| (seen.start - from) as usize..(seen.end - from) as usize;
            let old = out.pixels.get_mut(columns(0)).unwrap_or_default();
            // As long as those, and said so.
            let new = new.get(columns(from).start..).unwrap_or_default();
            let Some(new) = new.get(..old.len()) else {
                return;
            };
            match state.blend {
                None => old.copy_from_slice(new),
                Some(how) if has_alphas => {
                    let alphas = alphas.get(columns(from)).unwrap_or_default();
                    blend_each::<L::Pixel>(old, new, how, alphas);
                }
                Some(how) => blend::<L::Pixel>(old, new, how),
            }
        };
        // Of a shorter run the lower bits say nothing.
        let opaque = opaque & u32::MAX << (32 - pixels);
        each_run(opaque, from, &mut |run| match known {
            Some(known) => compare(run, state, known, &mut put),
            None => put(run),
        });
    }
}

/// The alphas of a run of up to 32 pixels, and what else its texels say of themselves.
#[inline(never)]
fn find_alphas<L: Look>(
    ink: &Ink<'_, L::Planes>,
    at: Place,
    view: &View<'_>,
    alphas: &mut [PixelAlpha],
) {
    let mut texels = [MaskTexel::OPAQUE.word(); MOST_TESTED];
    let texels = &mut texels[..alphas.len()];
    if L::TEXTURED && ink.state.has_mask {
        L::fill_mask(ink.planes, at, view.draws.states, texels);
    }
    for ((alpha, &texel), column) in alphas.iter_mut().zip(&*texels).zip(at.column..) {
        rolled();
        *alpha = PixelAlpha::new(ink.surface.at(column), MaskTexel(texel));
    }
}

/// Colours those of a dithered run anew whose texels are not to be dithered.
#[inline(never)]
fn undither<L: Look>(
    ink: &Ink<'_, L::Planes>,
    at: Place,
    view: &View<'_>,
    alphas: &[PixelAlpha],
    run: &mut [WordOf<L>],
) {
    if !alphas.iter().any(|alpha| alpha.texel().is_undithered()) {
        return;
    }
    let mut plain = [WordOf::<L>::default(); MOST_TESTED];
    let plain = &mut plain[..run.len()];
    L::fill_opaque(ink.fill, ink.planes, at, view.draws.states, false, plain);
    for ((pixel, &plain), alpha) in run.iter_mut().zip(&*plain).zip(alphas) {
        rolled();
        if alpha.texel().is_undithered() {
            *pixel = plain;
        }
    }
}

/// Colours a run, or blends it.
fn lay<L: Look>(ink: &Ink<'_, L::Planes>, run: Span, out: &mut Line<'_, '_, L>) {
    let Some(pixels) = out.pixels.get_mut(run.start as usize..run.end as usize) else {
        return;
    };
    let mut at = ink.span.place(run.start, out.number);
    // Called, not pointed at: what others call would have to take all that a pointer hands over.
    let fill = |at: Place, run: &mut [WordOf<L>]| {
        let draws = out.view.draws.states;
        if ink.state.dithers {
            L::fill_opaque(ink.fill, ink.planes, at, draws, true, run);
        } else {
            L::fill(ink.fill, ink.planes, at, draws, run);
        }
    };
    let Some(how) = ink.state.blend else {
        return fill(at, pixels);
    };
    let mut colours = [WordOf::<L>::default(); MOST_TESTED];
    for pixels in pixels.chunks_mut(MOST_TESTED) {
        let Some(new) = colours.get_mut(..pixels.len()) else {
            return;
        };
        fill(at, new);
        blend::<L::Pixel>(pixels, new, how);
        at.column += pixels.len() as u32;
    }
}
