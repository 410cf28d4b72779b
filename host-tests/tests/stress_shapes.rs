//! M3, P4: numbers under stress, with overflow checks on. Slivers, pixels, giants, points and
//! lines, colours at 0 and full, and 1/w from 1 to far below.
//!
//! Every bound follows from a format, and none was set after measuring:
//!
//! | what | bound | from | test |
//! |---|---|---|---|
//! | coverage of corners on the 13.3 grid, slivers of 1/8 pixel to 8192 pixels | exact | integer edges | here, `watertight.rs` |
//! | colour, any span and gradient | 1 step of the output from exact; never beyond the corners by more than 1 | half a step rounding, 11- and 10-bit fields, planes to 1/8 step | here |
//! | depth at a pixel, 1/w = 1 being 2^31 | 2^13 units, 1/2 a pixel each way, and `2^-24 scale / w` of a corner's | 13 spare bits of planes, 26 bits of a model's scale | here |
//! | order of depth | right where 1/w differs by more than both bounds; of constant 1/w by 2^-24 of it and 2 units | the same | here |
//! | 1/w below 2^-16 | all the same: the last drawn is seen | corners keep 2^15 units from 0 | here |
//! | near plane at any angle: where edges lie | `0.0884 + 2^-24 scale / near (focal + 4096)` pixels; none is cut open | 1/16 pixel each way by snapping, 26 bits of a model's scale | `stress_near.rs` |
//! | near plane: colour, 1/w | 1 level, `2^-18 + 2^-24 scale / near`, and what that way of an edge makes of their slopes | as above | `stress_near.rs` |
//! | chains of n maps of any magnitude | `3 n 2^-30` of the product of their norms | mantissas of 30 bits | `geometry/transform.rs` |
//! | a million turns: skew of the rows | `n 2^-20` left alone, 2^-26 with `Affine::orthonormalised` | 24-bit rows of a turn | `geometry/transform.rs` |
//! | a camera set anew a million times: skew of its view | `2^-20 + 2^-21 / s`, s the sine between up and view | 24-bit floats, their cross product divided by s | `geometry/camera.rs` |
//! | camera, model and planes scaled by 2^k, -50 to 80 | the same bits | exponents apart from mantissas | `stress_input.rs` |
//! | floats, files and flags of any bits | refused in one line, or drawn without a panic | `Option` and `Result` at every door | `stress_input.rs`, `fuzz.rs` |
//!
//! Overflow checks and debug assertions are on in every test and in the fuzz targets
//! (`host-tests/fuzz`). `scenes::STRESS` has the same kinds of triangles in frames that QEMU draws
//! with the same bits.

use crate::common::{LineRooms, Rng, line};
use crate::stress::{self, Corner, Worst, check, colour, depth_bound, distance, with_scene};
use crate::watertight::count::{self, Place, doubled_area};
use scanbeam::Screen;
use scanbeam::pipeline::GouraudDepth;
use scanbeam::pixel::Rgb888;

/// Corners at these places, at distances up to 2^`bits`.
fn corners(rng: &mut Rng, places: [Place; 3], bits: f64) -> [Corner; 3] {
    places.map(|at| Corner {
        at,
        w: distance(rng, bits),
        colour: colour(rng),
    })
}

fn done(worst: &Worst, triangles: usize, pixels: u64) {
    println!("{worst:?}");
    assert!(
        worst.triangles >= triangles && worst.pixels >= pixels,
        "{worst:?}"
    );
}

/// Strips 1/8 to 1 pixel wide at any slope, across the picture and beyond it.
#[test]
fn slivers_keep_coverage_colour_and_depth() {
    let (mut rng, mut worst) = (Rng::new(51), Worst::default());
    let screen = Screen::new(64, 48).unwrap();
    while worst.triangles < 12_000 {
        let mut end = || (rng.within(-200, 712), rng.within(-200, 584));
        let (a, b) = (end(), end());
        let wide = rng.within(1, 8);
        let on = rng.within(0, 64);
        let c = (
            a.0 + (b.0 - a.0) * on / 64 + rng.within(-wide, wide),
            a.1 + (b.1 - a.1) * on / 64 + rng.within(-wide, wide),
        );
        let bits = rng.pick(&[0.0, 3.0, 9.0]);
        check(screen, &corners(&mut rng, [a, b, c], bits), &mut worst);
    }
    done(&worst, 12_000, 200_000);
}

/// Triangles of a few pixels and less, where a colour may run from 0 to full in 1/8 pixel.
#[test]
fn specks_keep_coverage_colour_and_depth() {
    let (mut rng, mut worst) = (Rng::new(52), Worst::default());
    let screen = Screen::new(17, 15).unwrap();
    while worst.triangles < 30_000 {
        let size = rng.pick(&[2, 5, 9, 20, 60]);
        let base = (rng.within(-8, 130), rng.within(-8, 120));
        let places = [(); 3].map(|()| (base.0 + rng.within(0, size), base.1 + rng.within(0, size)));
        let bits = rng.pick(&[0.0, 3.0, 9.0]);
        check(screen, &corners(&mut rng, places, bits), &mut worst);
    }
    done(&worst, 30_000, 80_000);
}

/// Up to 8192 pixels wide or high, corners up to the ends of guard space.
#[test]
fn giants_keep_coverage_colour_and_depth() {
    let (mut rng, mut worst) = (Rng::new(53), Worst::default());
    let screens = [(8192, 2), (2, 8192), (8191, 3), (640, 8), (64, 64), (1, 1)]
        .map(|(w, h)| Screen::new(w, h).unwrap());
    while worst.triangles < 1_200 {
        let screen = screens[worst.triangles % screens.len()];
        let middle = (
            4 * i32::from(screen.width()),
            4 * i32::from(screen.height()),
        );
        // The outmost 128th of guard space is clipped.
        let reach = rng.pick(&[600, 5_000, 32_600]);
        let mut along = |middle: i32| middle + rng.within(-reach, reach);
        let mut places = [(); 3].map(|()| (along(middle.0), along(middle.1)));
        if rng.below(3) == 0 {
            // A sliver as long as can be.
            places[2] = (
                places[1].0 + rng.within(-2, 2),
                places[1].1 + rng.within(-2, 2),
            );
        }
        let bits = rng.pick(&[0.0, 3.0, 9.0]);
        check(screen, &corners(&mut rng, places, bits), &mut worst);
    }
    done(&worst, 1_200, 1_000_000);
}

/// A span of every length, from 0 to full and back: whole pixels, at the left end and not. 8150
/// pixels is the longest that is not clipped at the guard band.
#[test]
fn spans_of_every_length_keep_their_colours() {
    let (mut rng, mut worst) = (Rng::new(54), Worst::default());
    for length in 1..=8150 {
        // Below 300 each, above every 61st and the last.
        if length > 300 && length % 61 != 0 && length != 8150 {
            continue;
        }
        let room = (8150 - length).min(40);
        let screen = Screen::new((length + room) as u16, 1).unwrap();
        let (left, right) = (8 * rng.within(0, room), 8 * length);
        let ends = rng.pick(&[(0, 255), (255, 0), (254, 255), (1, 0)]);
        let corner = |at: Place, level: u8| Corner {
            at,
            w: 1.0,
            colour: [level, 255 - level, level],
        };
        let triangle = [
            corner((left, 0), ends.0),
            corner((left + right, 0), ends.1),
            corner((left + right, 16), ends.1),
        ];
        check(screen, &triangle, &mut worst);
        let triangle = [
            corner((left, 0), ends.0),
            corner((left, 16), ends.0),
            corner((left + right, 8), ends.1),
        ];
        check(screen, &triangle, &mut worst);
    }
    done(&worst, 800, 1_500_000);
}

/// Points, lines, and triangles that share all of their corners, drawn over one another.
#[test]
fn what_has_no_area_draws_nothing_and_twins_are_one() {
    let (mut rng, mut worst) = (Rng::new(55), Worst::default());
    let screen = Screen::new(24, 20).unwrap();
    while worst.triangles < 6_000 {
        let mut place = || (rng.within(-20, 210), rng.within(-20, 180));
        let (a, b) = (place(), place());
        let on = rng.within(-3, 3);
        let between = (a.0 + on * (b.0 - a.0), a.1 + on * (b.1 - a.1));
        let places = rng.pick(&[[a, a, a], [a, a, b], [a, b, a], [b, a, a], [a, b, between]]);
        assert_eq!(doubled_area(places), 0);
        if places
            .iter()
            .any(|p| p.0.abs() > 32_000 || p.1.abs() > 32_000)
        {
            continue;
        }
        check(screen, &corners(&mut rng, places, 3.0), &mut worst);
    }
    assert_eq!(worst.pixels, 0, "{worst:?}");
    // The same triangle again and again: nearer or equal wins, so the last is seen, and as it is
    // the same it is as if there were one.
    type P = GouraudDepth<Rgb888>;
    for _ in 0..400 {
        let places = [(); 3].map(|()| (rng.within(-20, 210), rng.within(-20, 180)));
        let one = corners(&mut rng, places, 3.0);
        let frame = |copies: usize, slots: usize| {
            with_scene::<P, _>(screen, &vec![one; copies], |scene| {
                let mut rooms = LineRooms::<P>::fitting(slots, scene);
                let mut renderer = rooms.renderer();
                let lines = 0..screen.height();
                lines
                    .map(|y| line(&mut renderer, scene, y))
                    .collect::<Vec<_>>()
            })
        };
        let alone = frame(1, 4);
        for (copies, slots) in [(2, 4), (7, 3), (7, 0), (40, 64)] {
            assert_eq!(frame(copies, slots), alone, "{copies}, {slots}: {one:?}");
        }
    }
}

/// 1/w from 1 to 2^-9 and down to the farthest that a camera sees: depth keeps its bound, and of two surfaces the nearer one
/// is seen wherever they are further apart than both bounds.
#[test]
fn the_nearer_is_seen_down_to_a_65536th() {
    type P = GouraudDepth<Rgb888>;
    let mut rng = Rng::new(56);
    let screen = Screen::new(48, 40).unwrap();
    let (mut decided, mut open) = (0u64, 0u64);
    for round in 0..3_000 {
        // The range of a pair, and how far it lies away.
        let (bits, away) = [
            (9.0, 0.0),
            (0.3, 0.0),
            (1.0, 6.0),
            (0.1, 9.0),
            (1.0, 13.0),
            (0.9, 15.0),
        ][round % 6];
        let mut triangle = |red: u8| {
            let places = [(); 3].map(|()| (rng.within(-100, 480), rng.within(-100, 420)));
            places.map(|at| Corner {
                at,
                w: distance(&mut rng, bits) * f64::exp2(away),
                colour: [red, 0, 0],
            })
        };
        let pair = [triangle(100), triangle(200)];
        if pair.iter().any(|t| doubled_area(t.map(|c| c.at)) == 0) {
            continue;
        }
        let bound: f64 = pair.iter().map(|t| depth_bound(screen, t)).sum();
        with_scene::<P, _>(screen, &pair, |scene| {
            let mut rooms = LineRooms::<P>::fitting(rng.pick(&[0, 2]), scene);
            let mut renderer = rooms.renderer();
            let counts = pair
                .each_ref()
                .map(|t| count::Count::new(screen, &[t.map(|c| c.at)], scanbeam::Cull::None));
            for y in 0..screen.height() {
                let pixels = line(&mut renderer, scene, y);
                for (x, word) in pixels.iter().enumerate() {
                    let hit = |k: usize| counts[k].hits[counts[k].line(y)][x] == 1;
                    if !(hit(0) && hit(1)) {
                        continue;
                    }
                    let depth = pair
                        .each_ref()
                        .map(|t| stress::exact_depth(t, x as i32, i32::from(y)));
                    if (depth[0] - depth[1]).abs() <= bound {
                        open += 1;
                        continue;
                    }
                    decided += 1;
                    let want = if depth[0] > depth[1] { 100 } else { 200 };
                    assert_eq!(word[0], want, "{x}, {y}: {depth:?} {bound} {pair:?}");
                }
            }
        });
    }
    println!("{decided} pixels decided, {open} too near to tell");
    assert!(decided > 100_000, "{decided}");
}

/// Surfaces that face the eye have one 1/w, and no plane errs. Distances are cut to 2^-26 of the
/// model's scale, at most 2^-25 of them, and reciprocals err by 2^-27: 2^-24 of 1/w and 2 units
/// apart is enough, from 1 down to 2^-16, which is as far as cameras see.
#[test]
fn surfaces_that_face_the_eye_are_told_apart() {
    type P = GouraudDepth<Rgb888>;
    let mut rng = Rng::new(57);
    let screen = Screen::new(3, 3).unwrap();
    let seen = |w: [f64; 2]| {
        let faces = [0, 1].map(|k| {
            [(-30, -20), (90, -20), (30, 100)].map(|at| Corner {
                at,
                w: w[k],
                colour: [100 + 100 * k as u8, 0, 0],
            })
        });
        with_scene::<P, _>(screen, &faces, |scene| {
            let mut rooms = LineRooms::<P>::fitting(2, scene);
            line(&mut rooms.renderer(), scene, 1)[1][0]
        })
    };
    for _ in 0..40_000 {
        let bits = rng.pick(&[1.0, 9.0, 15.9]);
        let w = distance(&mut rng, bits).max(1.0 + 1e-4);
        let apart = 1.0 + 2f64.powi(-24) + 2.0 * w / stress::ONE;
        assert_eq!(seen([w, w * apart]), 100, "{w}");
        assert_eq!(seen([w * apart, w]), 200, "{w}");
        assert_eq!(seen([w, w]), 200, "the last of equals");
    }
}
