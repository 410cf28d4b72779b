//! The pixels of one object on one line: tested, coloured, stored (K8).

use super::scene::Scene;
use crate::composite::{Compositing, PixelFormat, TextureSource, paint};
use crate::geometry::{Parameters, Role, Scale, Shading, at_pixel};
use crate::num::Plane;
use crate::pipeline::{CellOf, DrawableOf, LevelsOf, Pipeline, WordOf};
use crate::shade::{Forward, Interpolation, Levels, PixelLights, Stretch};
use crate::stats::SpanCounter;
use crate::visible::{Everywhere, LineDepth, Masked, Named, Placed, Tested, Visible};

/// What is lent to a scene.
type Lent<P> = (<P as Pipeline>::Textures, <P as Pipeline>::Lights);

/// How levels become steps of the output.
pub(crate) const fn scale<P: Pipeline>() -> &'static Scale {
    const { &Scale::new(<P::Pixel as PixelFormat>::STEPS) }
}

/// What draws the objects of a line: from their planes, or from their corners.
pub(super) struct Brush<'a, 's, P: Pipeline> {
    pub(super) scene: &'a Scene<'s, P>,
    /// Records read once more: of triangles drawn from their corners, and for depth.
    pub(super) reads: u32,
    pub(super) counter: &'a mut P::Counter,
    pub(super) interpolation: P::Interpolation,
}

impl<P: Pipeline> Brush<'_, '_, P> {
    /// Draws a span of an object from a column and line of guard space on, into its pixels and,
    /// where other spans may share them, its depth cells.
    #[inline(always)]
    pub(super) fn draw(
        &mut self,
        object: u16,
        body: &DrawableOf<P>,
        at: (i32, i32),
        (pixels, cells): (&mut [WordOf<P>], Option<&mut [CellOf<P>]>),
    ) {
        match &body.parameters {
            Parameters::Planes(plane, levels) => {
                let how = (self.interpolation, self.scene.lent(), &mut *self.counter);
                let grain = P::Depth::grain(body.range().0);
                draw_span::<P>((plane, grain, levels), at, (pixels, cells), how);
            }
            Parameters::Corners => {
                self.reads += 1;
                let (count, tested) = (pixels.len() as u32, cells.is_some());
                let cells = cells.unwrap_or_default();
                let grain = P::Depth::grain(body.range().0);
                let shown = &mut |i, depth| {
                    let cell = cells.get_mut(i);
                    cell.is_none_or(|cell| P::Depth::test(cell, depth, grain))
                };
                let seen = draw_thin(self.scene, object, at, pixels, self.counter, shown);
                self.counter.span(seen, count - seen, tested);
            }
        }
    }

    /// Draws those pixels of a span of planes that have its name.
    #[inline(never)]
    pub(super) fn draw_named(
        &mut self,
        body: &DrawableOf<P>,
        at: (i32, i32),
        (pixels, mut named): (&mut [WordOf<P>], Named<'_, P::Depth>),
    ) {
        let Parameters::Planes(_, levels) = &body.parameters else {
            return;
        };
        let count = pixels.len() as u32;
        let lent = self.scene.lent();
        let how = (self.interpolation, lent);
        colour::<P, _>(pixels, levels, at, how, &mut named);
        let seen = named.seen();
        self.counter.span(seen, count - seen, true);
        count_fetches::<P>(levels, at, lent.0, seen, self.counter);
    }

    /// Draws those pixels of a span that are not covered, and covers them.
    #[inline]
    pub(super) fn draw_masked(
        &mut self,
        object: u16,
        body: &DrawableOf<P>,
        at: (i32, i32),
        (pixels, mut masked): (&mut [WordOf<P>], Masked<'_, '_, P::Depth>),
    ) {
        let count = pixels.len() as u32;
        match &body.parameters {
            Parameters::Planes(_, levels) => {
                let how = (self.interpolation, self.scene.lent(), &mut *self.counter);
                draw_masked::<P>(levels, at, (pixels, &mut masked), how);
            }
            Parameters::Corners => {
                self.reads += 1;
                let shown = &mut |_, _| masked.next();
                draw_thin(self.scene, object, at, pixels, self.counter, shown);
            }
        }
        let seen = masked.seen();
        self.counter.span(seen, count - seen, false);
    }
}

/// Draws a span of an object with this depth and these levels, from a column and line of guard
/// space on, into its pixels and, where other spans may share them, its depth cells.
#[inline(always)]
fn draw_span<P: Pipeline>(
    (plane, grain, levels): (&Plane, <P::Depth as LineDepth>::Grain, &LevelsOf<P>),
    (column, line): (i32, i32),
    (pixels, cells): (&mut [WordOf<P>], Option<&mut [CellOf<P>]>),
    (interpolation, lent, counter): (P::Interpolation, Lent<P>, &mut P::Counter),
) {
    let at = (column, line);
    if P::Counter::COUNTS && matches!(levels.stretch(column, line), Stretch::Constant(_)) {
        counter.flat();
    }
    let count = pixels.len() as u32;
    let tested = cells.is_some();
    let seen = match cells {
        Some(cells) => {
            let course = (plane.at(column, line) as u32, plane.dx as u32);
            let mut tests = Tested::<P::Depth, P::Counter>::new(cells, course, grain);
            colour::<P, _>(pixels, levels, at, (interpolation, lent), &mut tests);
            tests.seen()
        }
        None => {
            let how = (interpolation, lent);
            colour::<P, _>(pixels, levels, at, how, &mut Everywhere);
            count
        }
    };
    counter.span(seen, count - seen, tested);
    count_fetches::<P>(levels, at, lent.0, seen, counter);
}

/// Writes the pixels of a span that are seen: its texture times its levels, or these alone.
#[inline(always)]
pub(super) fn colour<P: Pipeline, I: Interpolation>(
    pixels: &mut [WordOf<P>],
    levels: &LevelsOf<P>,
    (column, line): (i32, i32),
    (interpolation, lent): (I, Lent<P>),
    visible: &mut impl Visible,
) {
    if P::Pixel::DITHERS {
        let placed = &mut Placed::new(visible, column, line);
        colour_placed::<P, _>(
            pixels,
            levels,
            (column, line),
            (interpolation, lent),
            placed,
        );
    } else {
        colour_placed::<P, _>(
            pixels,
            levels,
            (column, line),
            (interpolation, lent),
            visible,
        );
    }
}

/// The same, for pixels whose place is known where it matters.
#[inline(always)]
fn colour_placed<P: Pipeline, I: Interpolation>(
    pixels: &mut [WordOf<P>],
    levels: &LevelsOf<P>,
    (column, line): (i32, i32),
    (interpolation, lent): (I, Lent<P>),
    visible: &mut impl Visible,
) {
    if P::Lights::SHINE && LevelsOf::<P>::NORMALS {
        for (pixel, column) in pixels.chunks_mut(1).zip(column..) {
            let format = (P::Pixel::BITS, P::Pixel::STEPS);
            let stretch = lent.1.lit(levels, (column, line), format);
            let how = (Forward, lent.0);
            colour_stretch::<P, _>(pixel, levels, (column, line), (stretch, how), visible);
        }
        return;
    }
    let stretch = levels.stretch(column, line);
    let how = (interpolation, lent.0);
    colour_stretch::<P, _>(pixels, levels, (column, line), (stretch, how), visible);
}

/// The same, by the colours of a stretch.
#[inline(always)]
fn colour_stretch<P: Pipeline, I: Interpolation>(
    pixels: &mut [WordOf<P>],
    levels: &LevelsOf<P>,
    (column, line): (i32, i32),
    (stretch, (interpolation, textures)): (Stretch, (I, P::Textures)),
    visible: &mut impl Visible,
) {
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
pub(super) fn count_fetches<P: Pipeline>(
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
fn draw_masked<P: Pipeline>(
    levels: &LevelsOf<P>,
    at: (i32, i32),
    (pixels, masked): (&mut [WordOf<P>], &mut Masked<'_, '_, P::Depth>),
    (interpolation, lent, counter): (P::Interpolation, Lent<P>, &mut P::Counter),
) {
    colour::<P, _>(pixels, levels, at, (interpolation, lent), masked);
    count_fetches::<P>(levels, at, lent.0, masked.seen(), counter);
}

/// Draws a span of a triangle that is too thin for planes, pixel by pixel from its corners, where
/// it is `shown`, which gets the index of each pixel and its depth; how many were.
#[cold]
#[inline(never)]
pub(super) fn draw_thin<P: Pipeline>(
    scene: &Scene<'_, P>,
    object: u16,
    (column, line): (i32, i32),
    pixels: &mut [WordOf<P>],
    counter: &mut P::Counter,
    shown: &mut dyn FnMut(usize, u32) -> bool,
) -> u32 {
    let Some((face, corners)) = scene
        .object(object)
        .and_then(|o| Some((o.face, o.corners(scene.vertices())?)))
    else {
        return 0;
    };
    // What waits for its shadow is not drawn in the usual way.
    let finish = P::Shading::finish(&face);
    if P::Compositing::BLENDS && finish.is_some_and(|f| f.role() != Role::Plain) {
        return 0;
    }
    let mut seen = 0;
    let lent = scene.lent();
    for (i, (pixel, column)) in pixels.chunks_mut(1).zip(column..).enumerate() {
        let at = (column, line);
        let (depth, levels) = at_pixel::<P::Shading>(corners, face, scale::<P>(), at);
        if shown(i, depth) {
            colour::<P, _>(pixel, &levels, at, (Forward, lent), &mut Everywhere);
            count_fetches::<P>(&levels, at, lent.0, 1, counter);
            seen += 1;
        }
    }
    seen
}
