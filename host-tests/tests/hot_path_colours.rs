//! K10, P3, P4: every pixel's colour against the exact one, for triangles of all sizes and shapes whose corners
//! have colours from one end of the range to the other.
//!
//! | pixels | bound | from |
//! |---|---|---|
//! | RGB565 | one step | half a step rounding, fields of 10 and 11 bits, planes and packed runs to half a step |
//! | RGB888 | 1.1 levels | half a level rounding, 1/8 level of fields, 1/2 level of planes of 16 bits |
//! | RGB888, thin triangles of nearly one colour | 4.1 levels | corners within 32 units of a field count as one colour |
//!
//! A colour that left its field would be off by the whole range.

use crate::common::Rng;
use crate::hot::exact::{self, weights, within};
use crate::hot::{Corner, Place, SceneRooms, Smooth, camera, draw, frame};
use scanbeam::look::Gouraud;
use scanbeam::pixel::{PixelFormat, Rgb565, Rgb565Be, Rgb888};
use scanbeam::{Cull, Screen};

/// What was seen: the worst and the sum of all differences, in steps of the output.
#[derive(Debug, Default)]
struct Seen {
    triangles: u64,
    pixels: u64,
    worst: f64,
    sum: f64,
}

/// Colours that try the ends of the range.
fn colours(rng: &mut Rng) -> [[u8; 3]; 3] {
    let kind = rng.below(5);
    let near = rng.below(248) as u8;
    [(); 3].map(|()| {
        [(); 3].map(|()| match kind {
            0 | 1 => rng.pick(&[0, 255]),
            2 => rng.pick(&[0, 1, 127, 128, 254, 255]),
            3 => near + rng.below(8) as u8,
            _ => rng.below(256) as u8,
        })
    })
}

fn corners(rng: &mut Rng, places: [Place; 3]) -> [Corner; 3] {
    let colours = colours(rng);
    [0, 1, 2].map(|k| Corner {
        at: places[k],
        w: 1.0,
        colour: colours[k],
    })
}

/// How many steps a pixel may be off, and one of a thin triangle of nearly one colour.
#[derive(Clone, Copy)]
struct Bound {
    bound: f64,
    even: f64,
}

/// Whether a triangle may count as one of a single colour where it is thin.
fn nearly_one(corners: &[Corner; 3]) -> bool {
    (0..3).all(|i| {
        let channel = corners.map(|c| c.colour[i]);
        channel.iter().max().unwrap() - channel.iter().min().unwrap() <= 8
    })
}

/// Draws triangles that do not overlap, and holds each pixel against the exact colour: at most `bound`
/// steps off.
fn check<L: Smooth>(
    rooms: &mut SceneRooms,
    (screen, slots): (Screen, u16),
    triangles: &[[Corner; 3]],
    Bound { bound, even }: Bound,
    seen: &mut Seen,
) {
    let mut scene = rooms.scene::<L>(screen);
    scene.begin(&camera()).unwrap();
    draw(&mut scene, triangles, Cull::None).unwrap();
    assert_eq!(scene.assembled().clipped, 0);
    let picture = frame(&scene, slots, false, L::Format::from_rgb8([0; 3]));
    let steps = L::Format::STEPS.map(f64::from);
    for corners in triangles {
        seen.triangles += 1;
        let places = corners.map(|c| c.at);
        let is_even = exact::doubled_area(places).abs() < 1_024 && nearly_one(corners);
        let (low, high) = places
            .iter()
            .fold((i32::MAX, 0), |(l, h), p| (l.min(p.1), h.max(p.1)));
        let height = i32::from(screen.height());
        for y in low.div_euclid(8).clamp(0, height)..(high / 8 + 1).clamp(0, height) {
            let columns = within(places, y, screen.width());
            let (mut part, step) = weights(places, columns.start as i32, y);
            for x in columns {
                let levels = L::Format::to_rgb8(picture[y as usize][x]);
                for i in 0..3 {
                    let exact = (0..3)
                        .map(|k| part[k] * f64::from(corners[k].colour[i]))
                        .sum::<f64>();
                    let got = (f64::from(levels[i]) * steps[i] / 255.0).round();
                    let off = (got - exact * steps[i] / 255.0).abs();
                    seen.worst = seen.worst.max(off);
                    seen.sum += off;
                    let bound = if is_even { even } else { bound };
                    assert!(
                        off <= bound + 1e-9,
                        "channel {i} of {levels:?} for {exact} levels: {off} steps, {x}, {y} of {corners:?}"
                    );
                }
                seen.pixels += 1;
                part = [0, 1, 2].map(|k| part[k] + step[k]);
            }
        }
    }
}

/// Triangles in cells, so that none meets another: up to `size` units of a corner.
fn in_cells(rng: &mut Rng, screen: Screen, size: i32, thin: bool) -> Vec<[Corner; 3]> {
    let mut triangles = Vec::new();
    let cell = size + 16;
    let (w, h) = (
        8 * i32::from(screen.width()),
        8 * i32::from(screen.height()),
    );
    for y in (0..h - cell).step_by(cell as usize) {
        for x in (0..w - cell).step_by(cell as usize) {
            let mut place = || (x + rng.within(0, size), y + rng.within(0, size));
            let mut places = [(); 3].map(|()| place());
            if thin {
                let ([a, b, _], on) = (places, rng.within(0, 64));
                let wide = rng.within(0, 4);
                let mut near = |a: i32, b: i32, low: i32| {
                    let at = a + (b - a) * on / 64 + rng.within(-wide, wide);
                    at.clamp(low, low + size)
                };
                places[2] = (near(a.0, b.0, x), near(a.1, b.1, y));
            }
            triangles.push(corners(rng, places));
        }
    }
    triangles
}

/// So many frames of cells of a size.
fn cells<L: Smooth>(seed: u64, frames: usize, (size, thin): (i32, bool), bound: Bound) -> Seen {
    let (mut rng, mut seen) = (Rng::new(seed), Seen::default());
    let screen = Screen::new(320, 240).unwrap();
    let mut rooms = SceneRooms::new(30_000, 10_000, 240, 1);
    for i in 0..frames {
        let size = size * (1 + i as i32 % 4) / 4;
        let triangles = in_cells(&mut rng, screen, size.max(4), thin);
        let slots = [64, 128, 6][i % 3];
        check::<L>(&mut rooms, (screen, slots), &triangles, bound, &mut seen);
    }
    println!(
        "{size} {thin} {seen:?} mean {}",
        seen.sum / (3 * seen.pixels) as f64
    );
    seen
}

const STEP: Bound = Bound {
    bound: 1.0,
    even: 1.0,
};
const LEVEL: Bound = Bound {
    bound: 1.1,
    even: 4.1,
};

/// Within 25 pixels or so: one packed word in 565.
#[test]
fn tiny_triangles_are_a_step_from_exact() {
    cells::<Gouraud<Rgb565>>(321, 900, (224, false), STEP);
    cells::<Gouraud<Rgb565Be>>(322, 100, (112, false), STEP);
    cells::<Gouraud<Rgb888>>(323, 300, (224, false), LEVEL);
}

#[test]
fn small_triangles_are_a_step_from_exact() {
    cells::<Gouraud<Rgb565>>(324, 500, (511, false), STEP);
    cells::<Gouraud<Rgb888>>(325, 300, (511, false), LEVEL);
}

#[test]
fn slivers_are_a_step_from_exact() {
    cells::<Gouraud<Rgb565>>(326, 2000, (200, true), STEP);
    cells::<Gouraud<Rgb888>>(327, 500, (200, true), LEVEL);
    cells::<Gouraud<Rgb565>>(328, 2000, (511, true), STEP);
    cells::<Gouraud<Rgb888>>(329, 500, (511, true), LEVEL);
}

/// Of the whole picture and more, thin and not, one at a time.
#[test]
fn large_triangles_are_a_step_from_exact() {
    fn large<L: Smooth>(seed: u64, bound: Bound) {
        let (mut rng, mut seen) = (Rng::new(seed), Seen::default());
        let mut rooms = SceneRooms::new(3, 1, 1_016, 1);
        for round in 0..1_500 {
            let (w, h) = [(320, 240), (1_016, 3), (3, 1_016), (64, 48), (33, 25)][round % 5];
            let screen = Screen::new(w, h).unwrap();
            let reach = rng.pick(&[0, 300, 2_000, 11_000]);
            let mut along = |size: u16| rng.within(-reach, 8 * i32::from(size) + reach);
            let mut places = [(); 3].map(|()| (along(w), along(h)));
            if rng.below(2) == 0 {
                let ([a, b, _], on) = (places, rng.within(0, 64));
                let mut near = |a: i32, b: i32| a + (b - a) * on / 64 + rng.within(-4, 4);
                places[2] = (near(a.0, b.0), near(a.1, b.1));
            }
            let slots = rng.pick(&[0, 4]);
            let one = [corners(&mut rng, places)];
            check::<L>(&mut rooms, (screen, slots), &one, bound, &mut seen);
        }
        println!(
            "large {seen:?} mean {}",
            seen.sum / (3 * seen.pixels) as f64
        );
        assert!(seen.pixels > 1_000_000);
    }
    large::<Gouraud<Rgb565>>(330, STEP);
    large::<Gouraud<Rgb888>>(331, LEVEL);
}

/// Kills: a colour that counts as even along a line where one channel changes across alone, or down alone.
#[test]
fn one_channel_that_changes_along_one_axis_is_a_step_from_exact() {
    let mut seen = Seen::default();
    let screen = Screen::new(96, 96).unwrap();
    let mut rooms = SceneRooms::new(3, 1, 96, 1);
    for size in [100, 300, 500, 700] {
        let places = [(8, 8), (8 + size, 8), (8, 8 + size)];
        for channel in 0..3 {
            for bright in 0..3 {
                let corner = |k: usize| {
                    let mut colour = [0, 100, 0];
                    colour[channel] = if k == bright { 255 } else { 0 };
                    Corner {
                        at: places[k],
                        w: 1.0,
                        colour,
                    }
                };
                let one = [[0, 1, 2].map(corner)];
                check::<Gouraud<Rgb565>>(&mut rooms, (screen, 4), &one, STEP, &mut seen);
                check::<Gouraud<Rgb888>>(&mut rooms, (screen, 4), &one, LEVEL, &mut seen);
            }
        }
    }
    assert!(seen.pixels > 50_000, "{seen:?}");
}
