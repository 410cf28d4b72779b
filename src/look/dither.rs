//! Smooth colours, dithered: each pixel raised by a part of a step that hangs on its place (P5).
//!
//! Vertices keep half a step from either end of a channel, and a dither takes 15/32 of one: so a span whose ends keep
//! that much is raised in two words, packed anew every 16 pixels as without a dither, and no channel is looked at. What
//! planes err by may leave less, or a shader's colours: there each channel is held at its ends.

use super::Place;
use super::course::Course;
use super::ramp::Pair;
use crate::pixel::{PixelFormat, threshold};

/// By how much each of 4 x 4 places raises a pair of words, in lines.
type Raised = [[Pair; 4]; 4];

/// So many of 32 parts of a step of a channel of 16 bits, of which a format keeps so many.
pub(super) const fn parts_of(parts: i32, steps: u16) -> i32 {
    (parts * (1 << steps.leading_zeros())) >> 5
}

/// The same of three channels.
const fn all_parts_of(parts: i32, [red, green, blue]: [u16; 3]) -> [i32; 3] {
    let [red, green] = [parts_of(parts, red), parts_of(parts, green)];
    [red, green, parts_of(parts, blue)]
}

const fn raised(steps: [u16; 3]) -> Raised {
    let mut raised = [[Pair::new(0, 0); 4]; 4];
    let mut i = 0;
    while i < 16 {
        let (line, column) = (i >> 2, i & 3);
        let parts = threshold(column as u32, line as u32);
        raised[line][column] = Pair::of(all_parts_of(parts, steps));
        i += 1;
    }
    raised
}

/// Colours a run; `course` is at its span's first pixel.
#[inline(never)]
pub(super) fn fill<F: PixelFormat>(course: Course, place: Place, run: &mut [F::Word]) {
    if !course.keeps(const { all_parts_of(15, F::STEPS) }, place.pixels()) {
        return fill_held::<F>(course, place, run);
    }
    let raised = &const { raised(F::STEPS) }[place.line as usize & 3];
    let mut column = place.column;
    if course.is_even() {
        return fill_even::<F>(run, course.pair(), raised, column);
    }
    course.each_part(run, place.skipped(), |part, [mut at, step]| {
        for pixel in part {
            *pixel = at.plus(raised[column as usize & 3]).pixel::<F>();
            at = at.plus(step);
            column += 1;
        }
    });
}

/// The same of one colour: four pixels again and again.
#[inline(never)]
fn fill_even<F: PixelFormat>(run: &mut [F::Word], at: Pair, raised: &[Pair; 4], column: u32) {
    let four = [0, 1, 2, 3].map(|i| {
        let by = raised[column.wrapping_add(i) as usize & 3];
        at.plus(by).pixel::<F>()
    });
    let mut fours = run.chunks_exact_mut(4);
    for pixels in fours.by_ref() {
        pixels.copy_from_slice(&four);
    }
    let rest = fours.into_remainder();
    rest.copy_from_slice(&four[..rest.len()]);
}

/// The same, each channel held at its ends.
#[cold]
#[inline(never)]
fn fill_held<F: PixelFormat>(mut course: Course, place: Place, run: &mut [F::Word]) {
    course.skip(place.skipped());
    for (pixel, column) in run.iter_mut().zip(place.column..) {
        let parts = threshold(column, place.line);
        // Of a steep shade two words hold steps modulo 2^16.
        let channel = |i: usize| {
            let raised = (course.value[i] >> 15 & 0xFFFF) as i32 + parts_of(parts, F::STEPS[i]);
            raised.clamp(0, 0xFFFF) as u32
        };
        *pixel = F::pack_words(channel(0) << 16 | channel(2), channel(1) << 16);
        course.skip(1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::random::Rng;
    use crate::pixel::{Rgb565, Rgb565Be};

    fn place(span: u32, end: u32, column: u32, line: u32) -> Place {
        Place {
            span,
            end,
            column,
            line,
        }
    }

    /// A course between two colours of 16 bits, `pixels` apart, that ends in them.
    fn between(ends: [[u32; 3]; 2], pixels: u32) -> Course {
        let step = |i: usize| {
            let rise = i64::from(ends[1][i]) - i64::from(ends[0][i]);
            ((rise << 15) / i64::from(pixels.max(2) - 1)) as i32
        };
        Course {
            value: [0, 1, 2].map(|i| (ends[0][i] << 15) + (1 << 14)),
            step: [step(0), step(1), step(2)],
            packed: 0,
        }
    }

    /// A step of a channel as it is shown.
    fn shown(word: u16) -> [i64; 3] {
        [word >> 11, word >> 5 & 63, word & 31].map(i64::from)
    }

    /// Kills: a place of another line or column, a channel that is raised by another's step, parts that do not join, one
    /// colour that goes on at another place, a channel that leaves its field.
    #[test]
    fn spans_are_raised_by_their_places_in_whatever_runs() {
        let mut rng = Rng(77);
        let (mut even, mut held) = (0, 0);
        for round in 0..3_000 {
            let pixels = 1 + rng.below(70);
            let (start, line) = (rng.below(9), rng.below(9));
            let mut ends = [(); 2].map(|()| [(); 3].map(|()| rng.below(0x1_0000)));
            if round % 3 == 0 {
                ends[1] = ends[0];
            }
            if round % 5 > 0 {
                ends = ends.map(|end| end.map(|channel| channel.clamp(1 << 10, 0xFBFF)));
            } else {
                ends[0][rng.below(3) as usize] = [0, 300, 0xFF00, 0xFFFF][rng.below(4) as usize];
            }
            let course = between(ends, pixels);
            let most = all_parts_of(15, Rgb565::STEPS);
            (even, held) = (
                even + usize::from(course.is_even()),
                held + usize::from(!course.keeps(most, pixels)),
            );
            let at = |column: u32| place(start, start + pixels, column, line);
            let mut whole = [0u16; 70];
            let whole = &mut whole[..pixels as usize];
            fill::<Rgb565>(course, at(start), whole);
            for (i, &word) in (0..).zip(&*whole) {
                let parts = i64::from(threshold(start + i, line));
                for (channel, (got, bits)) in shown(word).into_iter().zip([5, 6, 5]).enumerate() {
                    let exact = i64::from(course.value[channel])
                        + i64::from(course.step[channel]) * i64::from(i);
                    let step = 1i64 << (31 - bits);
                    // Half a unit of 16 bits a pixel, within parts of 16.
                    let cut = |off: i64| {
                        let raised = exact + parts * step / 32 + (off << 15);
                        raised.clamp(0, i64::from(i32::MAX)) / step
                    };
                    assert!(cut(-9) <= got && got <= cut(9), "{round} {i} {channel}");
                }
            }
            let cut = rng.below(pixels);
            let mut parts = [0u16; 70];
            let (one, other) = parts[..pixels as usize].split_at_mut(cut as usize);
            fill::<Rgb565>(course, at(start), one);
            fill::<Rgb565>(course, at(start + cut), other);
            assert_eq!(&parts[..pixels as usize], &*whole, "{round}: cut at {cut}");
            let mut swapped = [0u16; 70];
            let swapped = &mut swapped[..pixels as usize];
            fill::<Rgb565Be>(course, at(start), swapped);
            assert!(whole.iter().zip(swapped).all(|(w, s)| w.to_be() == *s));
        }
        assert!(even > 700 && held > 300 && held < 2_000, "{even} {held}");
    }
}
