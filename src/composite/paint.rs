//! Colours into pixels, span by span, by the method of the pipeline.

use super::course::{Course, Wide, Words};
use super::dither;
use super::lirp::{blend, blend_packed};
use super::{PixelFormat, Ramp};
use crate::shade::{Interpolation, Method, Stretch};
use crate::visible::Visible;

/// Writes the pixels of a span that are seen.
#[inline(always)]
pub(crate) fn paint<F: PixelFormat, I: Interpolation>(
    pixels: &mut [F::Word],
    stretch: Stretch,
    interpolation: I,
    visible: &mut impl Visible,
) {
    if F::DITHERS {
        dither::paint::<F>(pixels, stretch, visible);
        return;
    }
    match stretch {
        Stretch::Constant(steps) => whole::<F>(pixels, F::pack(steps), visible),
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
            by_choice::<F, I, _>(pixels, &course, interpolation, visible);
        }
        Stretch::Channels(at, step) => {
            let course = Wide::new::<F>(at, step);
            by_choice::<F, I, _>(pixels, &course, interpolation, visible);
        }
    }
}

#[inline(always)]
fn by_choice<F: PixelFormat, I: Interpolation, C: Course>(
    pixels: &mut [F::Word],
    course: &C,
    interpolation: I,
    visible: &mut impl Visible,
) {
    // One or two pixels need no method, and steps of two fields cannot be told apart there.
    let short = pixels.len() < 3;
    let slope = || course.slope();
    let same = C::is_its_ramp::<F>(pixels.len());
    match interpolation.method(pixels.len() as u32, slope, F::PRECISION) {
        Method::Packed8 | Method::Packed16 if same => course.forward::<F>(pixels, visible),
        Method::Forward => course.forward::<F>(pixels, visible),
        Method::Half if !short => rate::<F, C, 2, 8>(pixels, course, visible),
        Method::Quarter if !short => rate::<F, C, 4, 16>(pixels, course, visible),
        Method::Whole if !short => {
            let mut middle = *course;
            middle.advance_halves(pixels.len() as u32 - 1);
            whole::<F>(pixels, pixel::<F>(&middle), visible);
        }
        Method::Packed8 | Method::Half | Method::Quarter | Method::Whole => {
            packed::<F, C, 8>(pixels, course, visible);
        }
        Method::Packed16 => packed::<F, C, 16>(pixels, course, visible),
        Method::Lirp10 => blend::<F, 10>(pixels, ends(course, pixels.len()), visible),
        Method::Lirp12 => blend::<F, 12>(pixels, ends(course, pixels.len()), visible),
        Method::Lirp16 => blend::<F, 16>(pixels, ends(course, pixels.len()), visible),
        Method::LirpPacked => blend_packed::<F>(pixels, ends(course, pixels.len()), visible),
    }
}

/// Whether nobody has to be asked.
#[inline(always)]
const fn all_seen<V: Visible>(_: &V) -> bool {
    V::ALL
}

/// The pixel at the present place.
#[inline(always)]
fn pixel<F: PixelFormat>(course: &impl Course) -> F::Word {
    let (red_blue, green) = course.words();
    F::pack_words(red_blue, green)
}

/// The colours of the first and the last pixel.
#[inline(always)]
fn ends(course: &impl Course, pixels: usize) -> [[u32; 3]; 2] {
    let mut last = *course;
    last.advance(pixels as u32 - 1);
    [course.channels(), last.channels()]
}

/// All pixels in one colour.
#[inline(always)]
fn whole<F: PixelFormat>(pixels: &mut [F::Word], word: F::Word, visible: &mut impl Visible) {
    if all_seen(visible) {
        F::fill(pixels, word);
        return;
    }
    visible.each(pixels, |pixel, shown| {
        if shown {
            *pixel = word;
        }
    });
}

/// A chunk as an array, so that loops over it have no end to watch for.
#[inline(always)]
fn array<W, const N: usize>(chunk: &mut [W]) -> Option<&mut [W; N]> {
    chunk.try_into().ok()
}

/// A packed ramp, anchored anew every `RUN` pixels.
///
/// In place for short spans of small triangles that are seen, where a call would show (20
/// instructions); else out of line, as what is around a span would take its registers.
#[inline(always)]
fn packed<F: PixelFormat, C: Course, const RUN: usize>(
    pixels: &mut [F::Word],
    course: &C,
    visible: &mut impl Visible,
) {
    if C::WORDS && all_seen(visible) && pixels.len() <= SHORT {
        short::<F>(pixels, course.ramp::<F>());
    } else {
        runs_apart::<F, C, RUN>(pixels, course, visible);
    }
}

#[inline(never)]
fn runs_apart<F: PixelFormat, C: Course, const RUN: usize>(
    pixels: &mut [F::Word],
    course: &C,
    visible: &mut impl Visible,
) {
    runs::<F, C, RUN>(pixels, course, visible);
}

/// Most pixels that are written without a loop.
const SHORT: usize = 8;

/// All of at most [`SHORT`] pixels, in straight code: a jump by their number saves two
/// instructions a pixel.
#[inline(always)]
fn short<F: PixelFormat>(run: &mut [F::Word], mut ramp: F::Ramp) {
    let mut next = || {
        let word = ramp.pixel();
        ramp.step();
        word
    };
    match run {
        [a] => *a = next(),
        [a, b] => [*a, *b] = [next(), next()],
        [a, b, c] => [*a, *b, *c] = [next(), next(), next()],
        [a, b, c, d] => [*a, *b, *c, *d] = [(); 4].map(|()| next()),
        [a, b, c, d, e] => [*a, *b, *c, *d, *e] = [(); 5].map(|()| next()),
        [a, b, c, d, e, f] => [*a, *b, *c, *d, *e, *f] = [(); 6].map(|()| next()),
        [a, b, c, d, e, f, g] => [*a, *b, *c, *d, *e, *f, *g] = [(); 7].map(|()| next()),
        [a, b, c, d, e, f, g, h] => {
            [*a, *b, *c, *d, *e, *f, *g, *h] = [(); 8].map(|()| next());
        }
        _ => {}
    }
}

/// The pixels from an anchor on.
#[inline(always)]
fn part<F: PixelFormat>(pixels: &mut [F::Word], mut ramp: F::Ramp, visible: &mut impl Visible) {
    if all_seen(visible) && pixels.len() <= SHORT {
        short::<F>(pixels, ramp);
        return;
    }
    visible.each(pixels, |pixel, shown| {
        if shown {
            *pixel = ramp.pixel();
        }
        ramp.step();
    });
}

/// Whole runs, and what is left.
#[inline(always)]
fn runs<F: PixelFormat, C: Course, const RUN: usize>(
    pixels: &mut [F::Word],
    course: &C,
    visible: &mut impl Visible,
) {
    let mut course = *course;
    let mut runs = pixels.chunks_exact_mut(RUN);
    for run in runs.by_ref().filter_map(array::<_, RUN>) {
        let mut ramp = course.ramp::<F>();
        visible.block(run, |pixel, shown| {
            if shown {
                *pixel = ramp.pixel();
            }
            ramp.step();
        });
        course.advance(RUN as u32);
    }
    part::<F>(runs.into_remainder(), course.ramp::<F>(), visible);
}

/// One colour for `N` pixels, that of their middle, by a ramp that steps from group to group and
/// is anchored anew every `RUN` pixels, which are 4 groups. The pixels left over at the end have
/// their own middle, so no colour is asked for beyond the span.
#[inline(never)]
fn rate<F: PixelFormat, C: Course, const N: usize, const RUN: usize>(
    pixels: &mut [F::Word],
    course: &C,
    visible: &mut impl Visible,
) {
    let count = pixels.len() as u32;
    let over = count % N as u32;
    let mut middle = *course;
    middle.advance_halves(N as u32 - 1);
    let mut middle = middle.coarse(N as u32);
    let mut runs = pixels.chunks_exact_mut(RUN);
    for run in runs.by_ref().filter_map(array::<_, RUN>) {
        groups::<F, N>(run, middle.ramp::<F>(), visible);
        middle.advance(4);
    }
    let rest = runs.into_remainder();
    let (run, last) = rest.split_at_mut(rest.len() - over as usize);
    groups::<F, N>(run, middle.ramp::<F>(), visible);
    if over > 0 {
        let mut end = *course;
        end.advance(count - over);
        end.advance_halves(over - 1);
        let word = pixel::<F>(&end);
        visible.each(last, |pixel, shown| {
            if shown {
                *pixel = word;
            }
        });
    }
}

/// Whole groups of `N` pixels, a colour each.
#[inline(always)]
fn groups<F: PixelFormat, const N: usize>(
    pixels: &mut [F::Word],
    mut ramp: F::Ramp,
    visible: &mut impl Visible,
) {
    for group in pixels.chunks_exact_mut(N).filter_map(array::<_, N>) {
        let word = ramp.pixel();
        visible.block(group, |pixel, shown| {
            if shown {
                *pixel = word;
            }
        });
        ramp.step();
    }
}
