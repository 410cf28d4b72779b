//! Lines of triangles against the fill rule, planes and depth of whole numbers and f64.

use super::Rng;
use crate::bits::METHODS;
use crate::depth::DepthMethod;
use crate::format::Format;
use crate::lines::{Triangle, draw_line};
use crate::method::Method;
use scanbeam::pixel::{Rgb565, Rgb888};
use std::vec::Vec;

const WIDTH: i32 = 48;
const HEIGHT: u16 = 36;

pub(super) fn random(rng: &mut Rng) -> Triangle {
    loop {
        let size = [20, 100, 400][rng.below(3) as usize];
        let base = [(); 2].map(|()| rng.below(400) as i32 - 40);
        let place = [(); 3].map(|()| base.map(|b| b + rng.below(size) as i32));
        let [a, b, c] = place;
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        if area.abs() >= 64 {
            return Triangle {
                place,
                depth: [(); 3].map(|()| (1 << 24) + rng.below((1 << 31) - (1 << 24))),
                colour: [(); 3].map(|()| [(); 3].map(|()| rng.below(256) as u8)),
            };
        }
    }
}

/// The fill rule's words: an edge counts on the lines `Ytop < Y <= Ybottom`, and of the two that count one must be left
/// of the centre and the other not.
fn covers(place: [[i32; 2]; 3], column: i32, line: u16) -> bool {
    let (x, y) = (8 * column + 4, 8 * i32::from(line) + 4);
    (0..3).fold(false, |left, k| {
        let (a, b) = (place[k], place[(k + 1) % 3]);
        let (a, b) = if a[1] <= b[1] { (a, b) } else { (b, a) };
        let counts = a[1] < y && y <= b[1];
        left ^ (counts && (x - a[0]) * (b[1] - a[1]) > (y - a[1]) * (b[0] - a[0]))
    })
}

/// What is linear between the corners, at a pixel's centre.
pub(super) fn plane(place: [[i32; 2]; 3], values: [f64; 3], column: i32, line: u16) -> f64 {
    let [a, b, c] = place.map(|p| p.map(f64::from));
    let (x, y) = (
        f64::from(8 * column + 4),
        f64::from(8 * i32::from(line) + 4),
    );
    let area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    let w1 = ((x - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (y - a[1])) / area;
    let w2 = ((b[0] - a[0]) * (y - a[1]) - (x - a[0]) * (b[1] - a[1])) / area;
    values[0] + (values[1] - values[0]) * w1 + (values[2] - values[0]) * w2
}

/// Dies where an edge counts from its top line on and not to its bottom line, and of spans a pixel off.
#[test]
fn spans_are_those_of_the_fill_rule() {
    let mut rng = Rng(31);
    for _ in 0..2_000 {
        let triangle = random(&mut rng);
        for line in 0..HEIGHT {
            let span = triangle.span(line);
            for column in 0..WIDTH {
                let want = covers(triangle.place, column, line);
                assert_eq!(span.contains(&column), want, "{triangle:?} {column} {line}");
            }
        }
    }
}

/// Draws a picture of triangles.
fn drawn<F: Format>(how: (Method, DepthMethod), triangles: &[Triangle]) -> Vec<F::Word> {
    let mut cells = [0; WIDTH as usize];
    let mut picture = Vec::new();
    for line in 0..HEIGHT {
        let mut pixels = [F::from_rgb8([9; 3]); WIDTH as usize];
        draw_line::<F>(
            how,
            triangles.iter().copied(),
            line,
            &mut pixels,
            &mut cells,
        );
        picture.extend(pixels);
    }
    picture
}

/// Colours of planes are those of f64, of the nearest triangle by f64. Dies of values at a pixel's
/// corner in place of its centre, and of spans a pixel off.
#[test]
fn pictures_are_those_of_f64() {
    let mut rng = Rng(32);
    let (mut compared, mut over) = (0, 0);
    for _ in 0..300 {
        let triangles: Vec<Triangle> = (0..8).map(|_| random(&mut rng)).collect();
        let picture = drawn::<Rgb888>((Method::Plane, DepthMethod::Bits32), &triangles);
        for (i, pixel) in picture.iter().enumerate() {
            let (column, line) = (i as i32 % WIDTH, (i as i32 / WIDTH) as u16);
            let depth = |t: &Triangle| plane(t.place, t.depth.map(f64::from), column, line);
            let mut here: Vec<&Triangle> = triangles
                .iter()
                .filter(|t| covers(t.place, column, line))
                .collect();
            here.sort_by(|a, b| depth(b).total_cmp(&depth(a)));
            let Some(seen) = here.first() else {
                assert_eq!(*pixel, [9; 3]);
                continue;
            };
            // Steps are rounded to a unit: half of one a pixel.
            if here
                .get(1)
                .is_some_and(|next| depth(seen) - depth(next) < 50.0)
            {
                continue;
            }
            over += usize::from(here.len() > 1);
            for channel in 0..3 {
                let values = seen.colour.map(|c| f64::from(c[channel]));
                let off = f64::from(pixel[channel]) - plane(seen.place, values, column, line);
                assert!(off.abs() < 0.5001, "{off} at {column}, {line}");
                compared += 1;
            }
        }
    }
    assert!(compared > 100_000 && over > 2_000, "{compared} {over}");
}

/// Depth methods show the picture of 32 bits where no two surfaces are within their steps, whatever draws the colours. Dies
/// where block-fix bits are compared as a number.
#[test]
fn layers_apart_show_the_same_by_every_depth() {
    let mut rng = Rng(33);
    for round in 0..200 {
        let mut triangles: Vec<Triangle> = (0..8).map(|_| random(&mut rng)).collect();
        for (layer, triangle) in (0..).zip(&mut triangles) {
            // Three fifths as near each, and level within a hundredth.
            let layer = (layer * 5 + round) % 8;
            let depth = (3 << 29) / 5u32.pow(layer) * 3u32.pow(layer);
            triangle.depth = [(); 3].map(|()| depth + rng.below(depth / 100));
        }
        let method = METHODS[round as usize % METHODS.len()];
        let whole = drawn::<Rgb565>((method, DepthMethod::Bits32), &triangles);
        for depth in [
            DepthMethod::Bits16,
            DepthMethod::Bits22,
            DepthMethod::BlockFix,
            DepthMethod::Linear,
            DepthMethod::Word,
        ] {
            assert!(
                drawn::<Rgb565>((method, depth), &triangles) == whole,
                "{depth:?}"
            );
        }
    }
}

/// Level layers at random distances: what one code tells apart is told apart, what lies within it is not and the last is
/// seen, in every range, against codes by f64 (H2). Dies where the first of equals is seen, and of values that are rounded
/// otherwise where corners go round the other way.
#[test]
fn what_is_within_a_block_fix_code_is_not_told_apart() {
    let mut told = [[0; 2]; 4];
    for step in 0..3000 {
        let near = 1.01 * 1.00224f64.powi(step);
        let far = near * (1.0 + 2f64.powi(-16 + step % 9));
        // Range e is for 2^(-3 e - 3) up to 2^(-3 e).
        let code = |distance: f64| {
            let depth = 1.0 / distance;
            let range = ((-depth.log2() / 3.0).ceil() as i32 - 1).clamp(0, 3);
            (depth * f64::from(1 << (14 + 3 * range)), range)
        };
        let ((a, range), (b, other)) = (code(near), code(far));
        if range != other {
            continue;
        }
        let level = |distance: f64, colour| Triangle {
            place: [[0, 0], [0, 400], [400, 0]],
            depth: [(2f64.powi(31) / distance) as u32; 3],
            colour: [colour; 3],
        };
        let layers = [level(near, [200, 0, 0]), level(far, [0, 200, 0])];
        let apart = a.floor() > b.floor();
        let seen = drawn::<Rgb888>((Method::Plane, DepthMethod::BlockFix), &layers)[0];
        assert_eq!(seen == [200, 0, 0], apart, "{near} and {far}: {a} and {b}");
        told[range as usize][usize::from(apart)] += 1;
    }
    assert!(told.iter().flatten().all(|count| *count > 5), "{told:?}");
}
