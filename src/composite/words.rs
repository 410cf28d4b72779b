//! Colours straight into words of depth and colour, for the courses that have a loop of their own: one
//! colour, and packed ramps anchored every 8 pixels (K8).
//!
//! All others are drawn as always, and put into words from there. The bits are those of
//! [`paint`](super::paint).

use super::course::{Course, Wide, Words};
use super::{PixelFormat, Ramp};
use crate::shade::{Interpolation, Method, Stretch};
use crate::stats::SpanCounter;
use crate::visible::{DepthCell, WordCourse};

/// Draws a span into its cells, if it has a loop of its own; how many pixels are seen, where they are
/// counted.
#[inline(always)]
pub(crate) fn paint_words<F: PixelFormat, I: Interpolation, K: SpanCounter, C: DepthCell>(
    cells: &mut [C],
    depth: WordCourse,
    stretch: Stretch,
    interpolation: I,
) -> Option<u32> {
    match stretch {
        Stretch::Constant(steps) => Some(whole::<K, C>(cells, depth, F::to_half(F::pack(steps)))),
        Stretch::Packed {
            red_blue,
            green,
            steps,
            field_step,
        } => {
            let course = Words {
                red_blue,
                green,
                steps,
                field_step,
            };
            packed::<F, I, K, C, _>(cells, depth, &course, interpolation)
        }
        Stretch::Channels(at, step) => {
            let course = Wide::new::<F>(at, step);
            packed::<F, I, K, C, _>(cells, depth, &course, interpolation)
        }
    }
}

#[inline(never)]
fn whole<K: SpanCounter, C: DepthCell>(cells: &mut [C], mut depth: WordCourse, pixel: u16) -> u32 {
    let mut seen = 0;
    for cell in cells {
        let shown = depth.put(cell, pixel);
        if K::COUNTS {
            seen += u32::from(shown);
        }
    }
    seen
}

#[inline(always)]
fn packed<F: PixelFormat, I: Interpolation, K: SpanCounter, C: DepthCell, R: Course>(
    cells: &mut [C],
    depth: WordCourse,
    course: &R,
    interpolation: I,
) -> Option<u32> {
    let same = R::is_its_ramp::<F>(cells.len());
    let slope = || course.slope();
    let method = interpolation.method(cells.len() as u32, slope, F::PRECISION);
    let ramps = !same && matches!(method, Method::Packed8);
    ramps.then(|| runs::<F, K, C, R>(cells, depth, course))
}

/// A packed ramp, anchored anew every 8 pixels.
#[inline(never)]
fn runs<F: PixelFormat, K: SpanCounter, C: DepthCell, R: Course>(
    cells: &mut [C],
    mut depth: WordCourse,
    course: &R,
) -> u32 {
    const RUN: usize = 8;
    let mut course = *course;
    let mut seen = 0;
    let mut put = |ramp: &mut F::Ramp, cell: &mut C| {
        let shown = depth.put(cell, F::to_half(ramp.pixel()));
        ramp.step();
        if K::COUNTS {
            seen += u32::from(shown);
        }
    };
    let mut runs = cells.chunks_exact_mut(RUN);
    for run in &mut runs {
        let Ok(run): Result<&mut [C; RUN], _> = run.try_into() else {
            continue;
        };
        let mut ramp = course.ramp::<F>();
        for cell in run {
            put(&mut ramp, cell);
        }
        course.advance(RUN as u32);
    }
    let mut ramp = course.ramp::<F>();
    for cell in runs.into_remainder() {
        put(&mut ramp, cell);
    }
    seen
}
