//! Colours of spans that are taken anew on some lines alone (P3), against the plane between the corners.

use super::spans::{CASES, Subject, UNIT};
use super::stage::Rng;
use super::{Errors, Row};
use scanbeam::pixel::Rgb565;
use scanbeam::scene::LARGEST;
use scanbeam_lab::kept::{ColourPlanes, Kept, Span};
use scanbeam_lab::{Method, Triangle, paint};

/// Lines after which colours are taken anew, and the kernels of short and of long spans.
const WAYS: [(u16, &str, [&str; 2]); 4] = [
    (1, "colours on every line", ["kept1_565", "kept1_565_large"]),
    (
        2,
        "colours on every 2nd line",
        ["kept2_565", "kept2_565_large"],
    ),
    (
        3,
        "colours on every 3rd line",
        ["kept3_565", "kept3_565_large"],
    ),
    (
        8,
        "colours on every 8th line",
        ["kept8_565", "kept8_565_large"],
    ),
];

pub(super) fn rows() -> Vec<Row> {
    let mut rows = Vec::new();
    for long in [false, true] {
        for ((_, name, kernels), errors) in WAYS.into_iter().zip(triangles(long)) {
            let case = CASES[0][usize::from(long)];
            let kernel = kernels[usize::from(long)];
            rows.push(errors.row(("lines", case, name, UNIT, Some(kernel))));
        }
    }
    rows
}

/// All lines of the same random triangles, by all ways.
fn triangles(long: bool) -> [Errors; WAYS.len()] {
    let mut rng = Rng::new(2);
    let mut errors = WAYS.map(|_| Errors::default());
    let size = if long { (LARGEST, 256) } else { (64, 64) };
    let mut pixels = vec![0; size.0.into()];
    for _ in 0..if long { 40 } else { 3_000 } {
        let Some(subject) = Subject::random(&mut rng, long) else {
            continue;
        };
        let triangle = Triangle {
            place: subject.places.map(|(x, y)| [x, y]),
            depth: [1 << 30; 3],
            colour: subject.colours,
        };
        let planes = ColourPlanes::new::<Rgb565>(&triangle);
        for ((every, ..), errors) in WAYS.into_iter().zip(&mut errors) {
            let mut kept = Kept::new(every);
            for span in (0..size.1).filter_map(|line| Span::of(&triangle, line)) {
                let colours = kept.of_span::<Rgb565>(&planes, &span);
                let run = &mut pixels[span.column as usize..][..span.pixels as usize];
                paint::<Rgb565>(Method::Packed16, &colours, run, &mut || true);
                subject.compare::<Rgb565>(span.line.into(), &pixels, errors);
            }
        }
    }
    errors
}
