//! A line on which spans overlap, drawn into words of depth and colour (K8). For pipelines whose depth
//! is [`DepthAndColour`](crate::pipeline::DepthAndColour), and whose pixels have at most 16 bits.
//!
//! Spans of one colour and packed ramps go straight into the words. Of all others the colours are
//! first drawn over the line's pixels, which are scratch: all that a span covers is written again from
//! the words when the line is complete.

use super::lines::LinePass;
use super::spans::{How, colour, count_fetches, draw_thin};
use crate::active::{ActiveList, Visitor};
use crate::composite::{PixelFormat, paint_words};
use crate::geometry::Parameters;
use crate::pipeline::{CellOf, DrawableOf, LevelsOf, Pipeline, WordOf};
use crate::shade::Levels;
use crate::stats::SpanCounter;
use crate::visible::{DepthRamp, Everywhere, WordCourse, resolve};

/// A line whose cells are words of depth and colour.
struct WordPass<'w, 'a, 's, P: Pipeline> {
    pass: &'w mut LinePass<'a, 's, P>,
    /// The first column that was drawn, and the one after the last.
    drawn: (usize, usize),
}

impl<P: Pipeline> Visitor<DrawableOf<P>> for WordPass<'_, '_, '_, P> {
    fn set_up(&mut self, object: u16, body: &mut DrawableOf<P>) -> bool {
        self.pass.set_up(object, body)
    }

    #[inline]
    fn visit(&mut self, object: u16, body: &DrawableOf<P>) {
        let pass = &mut *self.pass;
        let Some((start, end)) = pass.span(body) else {
            return;
        };
        let (Some(pixels), Some(cells)) = (
            pass.pixels.get_mut(start..end),
            pass.cells.get_mut(start..end),
        ) else {
            return;
        };
        self.drawn = (self.drawn.0.min(start), self.drawn.1.max(end));
        let at = (pass.left + start as i32, pass.line);
        let brush = &mut pass.brush;
        let count = pixels.len() as u32;
        let seen = match &body.parameters {
            Parameters::Planes(plane, levels) => {
                let depth = DepthRamp::of(plane, at.0, at.1);
                brush.count_flat(levels, at);
                let how = brush.how();
                let seen = draw_words::<P>(pixels, cells, levels, at, depth, how);
                count_fetches::<P>(levels, at, how.textures, seen, brush.counter);
                seen
            }
            Parameters::Corners => {
                brush.reads += 1;
                let mut seen = 0;
                let parts = pixels.chunks_mut(1).zip(cells);
                for ((pixel, cell), column) in parts.zip(at.0..) {
                    let mut course = None;
                    let shown = &mut |_, depth| {
                        let at = WordCourse::single(depth);
                        course = at.is_seen(cell).then_some(at);
                        course.is_some()
                    };
                    let at = (column, at.1);
                    seen += draw_thin(brush.scene, object, at, pixel, brush.counter, shown);
                    if let (Some(mut course), [pixel]) = (course, pixel) {
                        course.put(cell, P::Pixel::to_half(*pixel));
                    }
                }
                seen
            }
        };
        brush.counter.span(seen, count - seen, true);
    }
}

/// Draws a span of planes; how many pixels are seen, where they are counted.
#[inline(always)]
fn draw_words<P: Pipeline>(
    pixels: &mut [WordOf<P>],
    cells: &mut [CellOf<P>],
    levels: &LevelsOf<P>,
    at: (i32, i32),
    depth: DepthRamp,
    how: How<P, P::Interpolation>,
) -> u32 {
    let course = WordCourse::new(depth, pixels.len());
    let plain = !P::Pixel::DITHERS && levels.texture(at.0, at.1).is_none();
    if let Some(course) = course.filter(|_| plain) {
        let stretch = levels.stretch(at.0, at.1);
        let seen = paint_words::<P::Pixel, _, P::Counter, CellOf<P>>(
            cells,
            course,
            stretch,
            how.interpolation,
        );
        if let Some(seen) = seen {
            return seen;
        }
    }
    colour::<P, _>(pixels, levels, at, how, &mut Everywhere);
    merge::<P>(pixels, cells, course, depth)
}

/// Puts pixels into words; how many are seen.
#[inline(never)]
fn merge<P: Pipeline>(
    pixels: &mut [WordOf<P>],
    cells: &mut [CellOf<P>],
    course: Option<WordCourse>,
    ramp: DepthRamp,
) -> u32 {
    let mut seen = 0;
    let pairs = pixels.iter().zip(cells);
    if let Some(mut course) = course {
        for (pixel, cell) in pairs {
            let shown = course.put(cell, P::Pixel::to_half(*pixel));
            if P::Counter::COUNTS {
                seen += u32::from(shown);
            }
        }
        return seen;
    }
    let mut depth = ramp.first;
    for (pixel, cell) in pairs {
        seen += u32::from(WordCourse::single(depth).put(cell, P::Pixel::to_half(*pixel)));
        depth = depth.wrapping_add(ramp.step);
    }
    seen
}

impl<P: Pipeline> LinePass<'_, '_, P> {
    /// Draws all objects into words, and the line out of them. `next` is the line that will come after,
    /// `spare` takes what has no slot.
    #[inline(never)]
    pub(super) fn draw_words(
        &mut self,
        list: &mut ActiveList<'_, DrawableOf<P>>,
        next: i32,
        spare: &mut DrawableOf<P>,
    ) {
        self.clear();
        let mut words = WordPass {
            pass: self,
            drawn: (usize::MAX, 0),
        };
        list.visit_all(next, spare, &mut words);
        let (start, end) = words.drawn;
        if let (Some(pixels), Some(cells)) = (
            self.pixels.get_mut(start..end),
            self.cells.get_mut(start..end),
        ) {
            resolve(cells, pixels, P::Pixel::from_half);
        }
    }
}
