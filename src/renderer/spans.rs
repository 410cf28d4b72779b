//! The pixels of one object on one line: tested, coloured, stored (K8).

use super::scene::Scene;
use crate::composite::PixelFormat;
use crate::geometry::{Parameters, at_pixel};
use crate::pipeline::{CellOf, DrawableOf, Pipeline, WordOf};
use crate::shade::{Levels, Walker};
use crate::span::Span;
use crate::stats::SpanCounter;
use crate::visible::LineDepth;

/// The steps of the output's channels.
pub(super) const fn steps<P: Pipeline>() -> [u16; 3] {
    <P::Pixel as PixelFormat>::STEPS
}

/// Draws a span of `drawable`, which is `object` of `scene`, into its pixels and depth cells.
#[inline]
pub(super) fn draw_span<P: Pipeline>(
    scene: &Scene<'_, P>,
    object: u16,
    drawable: &DrawableOf<P>,
    span: Span,
    (pixels, depth): (&mut [WordOf<P>], &mut [CellOf<P>]),
    counter: &mut P::Counter,
) {
    match &drawable.parameters {
        Parameters::Planes(plane, levels) => {
            let at = plane.at(span.column, span.line) as u32;
            let walker = levels.walk(span.column, span.line);
            draw::<P>(pixels, depth, (at, plane.dx as u32), walker, counter);
        }
        Parameters::Corners => draw_thin(scene, object, span, (pixels, depth), counter),
    }
}

/// Draws a span from planes: compares, stores, steps.
#[inline]
fn draw<P: Pipeline>(
    pixels: &mut [WordOf<P>],
    depth: &mut [CellOf<P>],
    (mut at, step): (u32, u32),
    mut walker: impl Walker,
    counter: &mut P::Counter,
) {
    let mut seen = 0;
    for (pixel, cell) in pixels.iter_mut().zip(depth.iter_mut()) {
        if P::Depth::test(cell, at) {
            *pixel = P::Pixel::pack(walker.colour());
            if P::Counter::COUNTS {
                seen += 1;
            }
        }
        at = at.wrapping_add(step);
        walker.step();
    }
    counter.span(seen, pixels.len() as u32 - seen, P::Depth::TESTS);
}

/// Draws a span of a triangle that is too thin for planes, pixel by pixel from its corners.
#[cold]
#[inline(never)]
fn draw_thin<P: Pipeline>(
    scene: &Scene<'_, P>,
    object: u16,
    span: Span,
    (pixels, depth): (&mut [WordOf<P>], &mut [CellOf<P>]),
    counter: &mut P::Counter,
) {
    let Some((face, corners)) = scene
        .object(object)
        .and_then(|o| Some((o.face, o.corners(scene.vertices())?)))
    else {
        return;
    };
    let mut seen = 0;
    let count = pixels.len() as u32;
    for ((pixel, cell), column) in pixels.iter_mut().zip(depth).zip(span.column..) {
        let at = (column, span.line);
        let (z, levels) = at_pixel::<P::Shading>(corners, face, steps::<P>(), at);
        if P::Depth::test(cell, z) {
            *pixel = P::Pixel::pack(levels.walk(column, span.line).colour());
            seen += 1;
        }
    }
    counter.span(seen, count - seen, P::Depth::TESTS);
}
