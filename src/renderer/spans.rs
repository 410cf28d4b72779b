//! The pixels of one object on one line: tested, coloured, stored (K8).

use super::scene::Scene;
use crate::composite::{PixelFormat, TextureSource, paint};
use crate::geometry::{Scale, at_pixel};
use crate::num::Plane;
use crate::pipeline::{CellOf, LevelsOf, Pipeline, WordOf};
use crate::shade::{Forward, Levels, Stretch};
use crate::stats::SpanCounter;
use crate::visible::{Everywhere, LineDepth, Masked, Tested, Visible};

/// How levels become steps of the output.
pub(crate) const fn scale<P: Pipeline>() -> &'static Scale {
    const { &Scale::new(<P::Pixel as PixelFormat>::STEPS) }
}

/// Draws a span of an object with this depth and these levels, from a column and line of guard
/// space on, into its pixels and, where other spans may share them, its depth cells.
#[inline(always)]
pub(super) fn draw_span<P: Pipeline>(
    (plane, levels): (&Plane, &LevelsOf<P>),
    (column, line): (i32, i32),
    (pixels, cells): (&mut [WordOf<P>], Option<&mut [CellOf<P>]>),
    (interpolation, textures, counter): (P::Interpolation, P::Textures, &mut P::Counter),
) {
    let at = (column, line);
    if P::Counter::COUNTS && matches!(levels.stretch(column, line), Stretch::Constant(_)) {
        counter.flat();
    }
    let count = pixels.len() as u32;
    let tested = cells.is_some();
    let seen = match cells {
        Some(cells) => {
            let depth = plane.at(column, line) as u32;
            let mut tests = Tested::<P::Depth, P::Counter>::new(cells, depth, plane.dx as u32);
            colour::<P>(pixels, levels, at, (interpolation, textures), &mut tests);
            tests.seen()
        }
        None => {
            colour::<P>(
                pixels,
                levels,
                at,
                (interpolation, textures),
                &mut Everywhere,
            );
            count
        }
    };
    counter.span(seen, count - seen, tested);
    count_fetches::<P>(levels, at, textures, seen, counter);
}

/// Writes the pixels of a span that are seen: its texture times its levels, or these alone.
#[inline(always)]
fn colour<P: Pipeline>(
    pixels: &mut [WordOf<P>],
    levels: &LevelsOf<P>,
    (column, line): (i32, i32),
    (interpolation, textures): (P::Interpolation, P::Textures),
    visible: &mut impl Visible,
) {
    let stretch = levels.stretch(column, line);
    if let Some((index, place)) = levels.texture(column, line) {
        let course = (place, levels.detail());
        if textures.paint(index, pixels, course, stretch, visible) {
            return;
        }
    }
    paint::<P::Pixel, _>(pixels, stretch, interpolation, visible);
}

/// Counts the texels of `seen` pixels, where they are counted.
#[inline(always)]
fn count_fetches<P: Pipeline>(
    levels: &LevelsOf<P>,
    (column, line): (i32, i32),
    textures: P::Textures,
    seen: u32,
    counter: &mut P::Counter,
) {
    if !P::Counter::COUNTS {
        return;
    }
    if let Some((index, _)) = levels.texture(column, line) {
        counter.fetched(seen * textures.fetches(index));
    }
}

/// Draws those pixels of a span that are not covered, and covers them.
#[inline(never)]
pub(super) fn draw_masked<P: Pipeline>(
    levels: &LevelsOf<P>,
    at: (i32, i32),
    (pixels, mut masked): (&mut [WordOf<P>], Masked<'_, '_, P::Depth>),
    (interpolation, textures, counter): (P::Interpolation, P::Textures, &mut P::Counter),
) {
    let count = pixels.len() as u32;
    colour::<P>(pixels, levels, at, (interpolation, textures), &mut masked);
    let seen = masked.seen();
    counter.span(seen, count - seen, false);
    count_fetches::<P>(levels, at, textures, seen, counter);
}

/// Draws a span of a triangle that is too thin for planes, pixel by pixel from its corners.
#[cold]
#[inline(never)]
pub(super) fn draw_thin<P: Pipeline>(
    scene: &Scene<'_, P>,
    object: u16,
    (column, line): (i32, i32),
    (pixels, mut cells): (&mut [WordOf<P>], Option<&mut [CellOf<P>]>),
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
    for (i, column) in (0..pixels.len()).zip(column..) {
        let at = (column, line);
        let (depth, levels) = at_pixel::<P::Shading>(corners, face, scale::<P>(), at);
        let cell = cells.as_mut().and_then(|cells| cells.get_mut(i));
        if cell.is_none_or(|cell| P::Depth::test(cell, depth)) {
            let pixels = &mut pixels[i..=i];
            let textures = scene.textures();
            let textured = levels.texture(column, line).is_some_and(|(index, place)| {
                let stretch = levels.stretch(column, line);
                let course = (place, levels.detail());
                textures.paint(index, pixels, course, stretch, &mut Everywhere)
            });
            if !textured {
                paint::<P::Pixel, _>(
                    pixels,
                    levels.stretch(column, line),
                    Forward,
                    &mut Everywhere,
                );
            }
            count_fetches::<P>(&levels, at, textures, 1, counter);
            seen += 1;
        }
    }
    counter.span(seen, count - seen, cells.is_some());
}
