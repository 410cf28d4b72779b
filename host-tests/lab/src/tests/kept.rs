//! Kept colours against planes by f64.

use super::Rng;
use super::triangles::{plane, random};
use crate::format::{FRACTION, Format};
use crate::kept::{ColourPlanes, Kept, Span};
use crate::lines::Triangle;
use scanbeam::pixel::{Rgb565, Rgb888};

/// Lines of the test triangles' picture.
const LINES: u16 = 60;

/// A channel at a column of a span's line, in steps of the format.
fn steps<F: Format>(triangle: &Triangle, channel: usize, span: &Span, column: i32) -> f64 {
    let values = triangle.colour.map(|c| f64::from(c[channel]));
    plane(triangle.place, values, column, span.line) * f64::from(F::STEPS[channel]) / 255.0
}

/// Holds a triangle's spans, each kept for so many lines, against f64; how many were kept, and how many taken anew since
/// they would have left their range.
fn compared<F: Format>(triangle: &Triangle, every: u16) -> [u32; 2] {
    let planes = ColourPlanes::new::<F>(triangle);
    let mut kept = Kept::new(every);
    let mut since = None::<Span>;
    let mut counts = [0; 2];
    for span in (0..LINES).filter_map(|line| Span::of(triangle, line)) {
        let colours = kept.of_span::<F>(&planes, &span);
        let is_due = since.is_none_or(|s| span.line >= s.line + every) || span.turns;
        let anew = colours == planes.at(span.column, span.line);
        assert!(anew || !is_due, "{triangle:?} {span:?}: {since:?}");
        let from = if anew { span } else { since.unwrap() };
        counts[0] += u32::from(!anew);
        counts[1] += u32::from(anew && !is_due);
        for i in 0..3 {
            // As far off as where it begins, from end to end.
            let off = steps::<F>(triangle, i, &from, from.column)
                - steps::<F>(triangle, i, &span, span.column);
            for pixel in [0, span.pixels - 1] {
                let shown = colours.after(pixel).at[i];
                assert!(
                    (0..i32::from(F::STEPS[i] + 1) << FRACTION).contains(&shown),
                    "{triangle:?} {span:?}: {shown} leaves its range"
                );
                let shown = f64::from(shown) / f64::from(1 << FRACTION) - 0.5;
                let exact = steps::<F>(triangle, i, &span, span.column + pixel as i32);
                assert!((shown - exact - off).abs() < 1e-3, "{triangle:?} {span:?}");
            }
        }
        since = Some(from);
    }
    counts
}

/// Dies where colours are kept for a line more, over a corner, or beyond their range, where planes are taken at another
/// pixel, and where steps are those of another channel.
#[test]
fn kept_colours_are_off_by_where_their_span_begins() {
    let mut rng = Rng(41);
    let mut counts = [[0; 2]; 4];
    for _ in 0..2_000 {
        let triangle = random(&mut rng);
        for (every, counts) in [1, 2, 3, 8].into_iter().zip(&mut counts) {
            for more in [
                compared::<Rgb565>(&triangle, every),
                compared::<Rgb888>(&triangle, every),
            ] {
                counts[0] += more[0];
                counts[1] += more[1];
            }
        }
    }
    // Taken on each line, none is kept and none is taken sooner.
    assert_eq!(counts[0], [0, 0]);
    let [_, two, three, eight] = counts.map(|[kept, _]| kept);
    assert!(1_000 < two && two < three && three < eight, "{counts:?}");
    assert!(counts[3][1] > 1_000, "{counts:?}");
}
