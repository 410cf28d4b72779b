//! The pixels of one object on one line: tested, coloured, stored (K8).

use super::scene::Scene;
use crate::composite::{PixelFormat, TextureSource, paint};
use crate::geometry::{Parameters, Scale, at_pixel};
use crate::pipeline::{CellOf, DrawableOf, LevelsOf, Pipeline, WordOf};
use crate::shade::{Forward, Interpolation, Levels, Stretch};
use crate::stats::SpanCounter;
use crate::visible::{DepthRamp, Everywhere, LineDepth, Masked, Named, Placed, Tested, Visible};

/// How spans are coloured: by which method, and with what is lent to the scene.
pub(super) struct How<P: Pipeline, I> {
    pub(super) interpolation: I,
    pub(super) textures: P::Textures,
}

impl<P: Pipeline, I: Copy> Clone for How<P, I> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<P: Pipeline, I: Copy> Copy for How<P, I> {}

impl<P: Pipeline, I> How<P, I> {
    /// By this method, with what the scene has.
    #[inline(always)]
    pub(super) fn new(scene: &Scene<'_, P>, interpolation: I) -> Self {
        Self {
            interpolation,
            textures: scene.textures(),
        }
    }
}

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
    /// How this brush colours spans.
    #[inline(always)]
    pub(super) fn how(&self) -> How<P, P::Interpolation> {
        How::new(self.scene, self.interpolation)
    }

    /// Draws a span of an object from a column and line of guard space on, into its pixels and,
    /// where other spans may share them, its depth cells.
    #[inline(always)]
    pub(super) fn draw(
        &mut self,
        object: u16,
        body: &DrawableOf<P>,
        at: (i32, i32),
        pixels: &mut [WordOf<P>],
        cells: Option<&mut [CellOf<P>]>,
    ) {
        let grain = P::Depth::grain(body.range().0);
        match &body.parameters {
            Parameters::Planes(plane, levels) => match cells {
                Some(cells) => {
                    let course = DepthRamp::of(plane, at.0, at.1);
                    let mut tests = Tested::<P::Depth, P::Counter>::new(cells, course, grain);
                    self.count_flat(levels, at);
                    colour::<P, _>(pixels, levels, at, self.how(), &mut tests);
                    self.count(levels, at, pixels.len(), tests.seen(), true);
                }
                None => {
                    self.count_flat(levels, at);
                    colour::<P, _>(pixels, levels, at, self.how(), &mut Everywhere);
                    let count = pixels.len();
                    self.count(levels, at, count, count as u32, false);
                }
            },
            Parameters::Corners => {
                self.reads += 1;
                let (count, tested) = (pixels.len() as u32, cells.is_some());
                let cells = cells.unwrap_or_default();
                let shown = &mut |i, depth| {
                    let cell = cells.get_mut(i);
                    cell.is_none_or(|cell| P::Depth::test(cell, depth, grain))
                };
                let seen = draw_thin(self.scene, object, at, pixels, self.counter, shown);
                self.counter.span(seen, count - seen, tested);
            }
        }
    }

    /// Says beforehand whether the next span has one colour, where spans are counted.
    #[inline(always)]
    pub(super) fn count_flat(&mut self, levels: &LevelsOf<P>, at: (i32, i32)) {
        if P::Counter::COUNTS && matches!(levels.stretch(at.0, at.1), Stretch::Constant(_)) {
            self.counter.flat();
        }
    }

    /// Counts a span of planes.
    #[inline(always)]
    fn count(
        &mut self,
        levels: &LevelsOf<P>,
        at: (i32, i32),
        count: usize,
        seen: u32,
        tested: bool,
    ) {
        self.counter.span(seen, count as u32 - seen, tested);
        count_fetches::<P>(levels, at, self.scene.textures(), seen, self.counter);
    }

    /// Draws those pixels of a span of planes that have its name.
    #[inline(never)]
    pub(super) fn draw_named(
        &mut self,
        body: &DrawableOf<P>,
        at: (i32, i32),
        pixels: &mut [WordOf<P>],
        mut named: Named<'_, P::Depth>,
    ) {
        let Parameters::Planes(_, levels) = &body.parameters else {
            return;
        };
        colour::<P, _>(pixels, levels, at, self.how(), &mut named);
        self.count(levels, at, pixels.len(), named.seen(), true);
    }

    /// Draws those pixels of a span that are not covered, and covers them.
    #[inline]
    pub(super) fn draw_masked(
        &mut self,
        object: u16,
        body: &DrawableOf<P>,
        at: (i32, i32),
        pixels: &mut [WordOf<P>],
        mut masked: Masked<'_, '_, P::Depth>,
    ) {
        let count = pixels.len() as u32;
        match &body.parameters {
            Parameters::Planes(_, levels) => self.colour_masked(levels, at, pixels, &mut masked),
            Parameters::Corners => {
                self.reads += 1;
                let shown = &mut |_, _| masked.next();
                draw_thin(self.scene, object, at, pixels, self.counter, shown);
            }
        }
        let seen = masked.seen();
        self.counter.span(seen, count - seen, false);
    }

    /// The same of a span of planes.
    #[inline(never)]
    fn colour_masked(
        &mut self,
        levels: &LevelsOf<P>,
        at: (i32, i32),
        pixels: &mut [WordOf<P>],
        masked: &mut Masked<'_, '_, P::Depth>,
    ) {
        let how = self.how();
        colour::<P, _>(pixels, levels, at, how, masked);
        count_fetches::<P>(levels, at, how.textures, masked.seen(), self.counter);
    }
}

/// Writes the pixels of a span that are seen: its texture times its levels, or these alone.
#[inline(always)]
pub(super) fn colour<P: Pipeline, I: Interpolation>(
    pixels: &mut [WordOf<P>],
    levels: &LevelsOf<P>,
    (column, line): (i32, i32),
    how: How<P, I>,
    visible: &mut impl Visible,
) {
    if P::Pixel::DITHERS {
        let placed = &mut Placed::new(visible, column, line);
        colour_placed::<P, _>(pixels, levels, (column, line), how, placed);
    } else {
        colour_placed::<P, _>(pixels, levels, (column, line), how, visible);
    }
}

/// The same, for pixels whose place is known where it matters.
#[inline(always)]
fn colour_placed<P: Pipeline, I: Interpolation>(
    pixels: &mut [WordOf<P>],
    levels: &LevelsOf<P>,
    (column, line): (i32, i32),
    how: How<P, I>,
    visible: &mut impl Visible,
) {
    let stretch = levels.stretch(column, line);
    colour_stretch::<P, _>(pixels, levels, (column, line), stretch, how, visible);
}

/// The same, by the colours of a stretch.
#[inline(always)]
fn colour_stretch<P: Pipeline, I: Interpolation>(
    pixels: &mut [WordOf<P>],
    levels: &LevelsOf<P>,
    (column, line): (i32, i32),
    stretch: Stretch,
    how: How<P, I>,
    visible: &mut impl Visible,
) {
    if let Some((index, place)) = levels.texture(column, line) {
        let course = (place, levels.detail());
        if how.textures.paint(index, pixels, course, stretch, visible) {
            return;
        }
    }
    paint::<P::Pixel, _>(pixels, stretch, how.interpolation, visible);
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
    let mut seen = 0;
    let how = How::new(scene, Forward);
    for (i, (pixel, column)) in pixels.chunks_mut(1).zip(column..).enumerate() {
        let at = (column, line);
        let (depth, levels) = at_pixel::<P::Shading>(corners, face, scale::<P>(), at);
        if shown(i, depth) {
            colour::<P, _>(pixel, &levels, at, how, &mut Everywhere);
            count_fetches::<P>(&levels, at, how.textures, 1, counter);
            seen += 1;
        }
    }
    seen
}
