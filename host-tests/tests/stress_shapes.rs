//! M3, P4: numbers under stress, with overflow checks on. Slivers, pixels, giants, points and
//! lines, colours at 0 and full, and 1/w from 1 to far below.
//!
//! Every bound follows from a format, and none was set after measuring:
//!
//! | what | bound | from | test |
//! |---|---|---|---|
//! | coverage of corners on the 13.3 grid, slivers of 1/8 pixel to giants of the whole guard band | exact | integer edges | `hot_path_cover.rs`, `watertight.rs` |
//! | colour, any span and gradient, specks, slivers and giants | 1 step of 16-bit output from exact, 1.1 levels of 24-bit | half a step rounding, 11- and 10-bit fields or eighths of a level, planes to 1/2 of them | `hot_path_colours.rs`, here |
//! | depth at a pixel, 1/w = 1 being 2^30 | 2^13 units, 1/2 a pixel each way, `2^-15` of a corner's, and of tiny triangles 2^-16 of how much corners differ | 13 spare bits of planes, reciprocals of 16 bits | `hot_path_depth.rs` |
//! | order of depth, 1/w from 1 to 2^-16 | right where 1/w differs by more than both bounds | the same | `hot_path_depth.rs` |
//! | depth of any corners that a camera sees together | never leaves its range | corners are cut to 2^-10 of 1 where others are so far | `hot_path_depth.rs` |
//! | near plane at any angle: where edges lie | `0.0884 + 2^-24 scale / near (focal + 4096)` pixels; none is cut open | 1/16 pixel each way by snapping, 26 bits of a model's scale | `stress_near.rs` |
//! | planes that the eye is almost in: where the near plane cuts them | `0.0884 + 2^-24 scale / near (2 focal + 256)` pixels | the same 26 bits of x and y, which vertices that are not cut do without | `stress_near.rs` |
//! | near plane: colour, 1/w | 1.1 levels, `2^-18 + 2^-15 / w + 2^-24 scale / near`, and what that way of an edge makes of their slopes | as above | `stress_near.rs` |
//! | chains of n maps of any magnitude | `3 n 2^-30` of the product of their norms | mantissas of 30 bits | `geometry/transform.rs` |
//! | a million turns: skew of the rows | `n 2^-20` left alone, 2^-26 with `Affine::orthonormalised` | 24-bit rows of a turn | `geometry/transform.rs` |
//! | a camera set anew a million times: skew of its view | `2^-20 + 2^-21 / s`, s the sine between up and view | 24-bit floats, their cross product divided by s | `geometry/camera.rs` |
//! | camera, model and planes scaled by 2^k, -50 to 80 | the same bits | exponents apart from mantissas | `stress_input.rs` |
//! | floats, files and flags of any bits | refused in one line, or drawn without a panic | `Option` and `Result` at every door | `stress_input.rs`, `fuzz.rs` |
//!
//! Overflow checks and debug assertions are on in every test and in the fuzz targets
//! (`host-tests/fuzz`).

use crate::common::Rng;
use crate::hot::cover::{Bench, L};
use crate::hot::exact::{doubled_area, weights, within};
use crate::hot::{Corner, SceneRooms, Smooth, camera, draw, frame, with_scene};
use scanbeam::look::Gouraud;
use scanbeam::pixel::{PixelFormat, Rgb565, Rgb565Be, Rgb888};
use scanbeam::scene::LARGEST;
use scanbeam::{Cull, Screen};

/// A span of every length, from 0 to full and back: whole pixels, at the left end and not, of triangles that are as wide
/// as the picture and of such that are wider.
fn spans<F: Smooth>(seed: u64, bound: f64) {
    let (mut rng, mut pixels) = (Rng::new(seed), 0);
    let mut rooms = SceneRooms::new(3, 1, 2, 1);
    for length in 1..=1_500 {
        let width = (length + rng.within(0, 40)).min(LARGEST.into());
        let screen = Screen::new(width as u16, 1).unwrap();
        let left = 8 * rng.within(-40, (width - length).max(0));
        let ends = rng.pick(&[(0, 255), (255, 0), (254, 255), (1, 0)]);
        let corner = |at: (i32, i32), level: u8| Corner {
            at,
            w: 1.0,
            colour: [level, 255 - level, level],
        };
        let right = left + 8 * length;
        for triangle in [
            [
                corner((left, 0), ends.0),
                corner((right, 0), ends.1),
                corner((right, 16), ends.1),
            ],
            [
                corner((left, 0), ends.0),
                corner((left, 16), ends.0),
                corner((right, 8), ends.1),
            ],
        ] {
            let mut scene = rooms.scene::<F>(screen);
            scene.begin(&camera()).unwrap();
            draw(&mut scene, &[triangle], Cull::None).unwrap();
            let slots = rng.pick(&[0, 4]);
            let words = &frame(&scene, slots, false, F::Format::from_rgb8([9; 3]))[0];
            let places = triangle.map(|c| c.at);
            for x in within(places, 0, screen.width()) {
                let (part, _) = weights(places, x as i32, 0);
                let levels = F::Format::to_rgb8(words[x]);
                for (i, level) in levels.into_iter().enumerate() {
                    let steps = f64::from(F::Format::STEPS[i]) / 255.0;
                    let want = (0..3).map(|k| part[k] * f64::from(triangle[k].colour[i]));
                    let got = (f64::from(level) * steps).round();
                    let off = (got - want.sum::<f64>() * steps).abs();
                    assert!(
                        off <= bound + 1e-9,
                        "{off} steps of channel {i}, {slots} slots, {x}: {triangle:?}"
                    );
                }
                pixels += 1;
            }
        }
    }
    assert!(pixels > 1_000_000, "{pixels}");
}

#[test]
fn spans_of_every_length_keep_their_colours() {
    spans::<Gouraud<Rgb888>>(54, 1.1);
    spans::<Gouraud<Rgb565>>(58, 1.0);
    spans::<Gouraud<Rgb565Be>>(59, 1.0);
}

/// Points and lines: where corners lie at the same place, and where they lie on one line.
#[test]
fn what_has_no_area_draws_nothing() {
    let (mut rng, mut bench) = (Rng::new(55), Bench::new());
    let screen = Screen::new(24, 20).unwrap();
    for _ in 0..6_000 {
        let mut place = || (rng.within(-20, 210), rng.within(-20, 180));
        let (a, b) = (place(), place());
        let on = rng.within(-3, 3);
        let between = (a.0 + on * (b.0 - a.0), a.1 + on * (b.1 - a.1));
        let places = rng.pick(&[[a, a, a], [a, a, b], [a, b, a], [b, a, a], [a, b, between]]);
        assert_eq!(doubled_area(places), 0);
        let want = bench.check(screen, &[places], Cull::None, &[4, 0]);
        assert!(want.hits.concat().iter().all(|&h| h == 0));
    }
    bench.done(6_000);
}

/// The same triangle again and again: nearer or equal wins, so the last is seen, and as it is the same it is as if there
/// were one.
#[test]
fn twins_are_one() {
    let mut rng = Rng::new(56);
    let screen = Screen::new(24, 20).unwrap();
    for _ in 0..400 {
        let one = [(); 3].map(|()| Corner {
            at: (rng.within(-20, 210), rng.within(-20, 180)),
            w: rng.between(0.0, 3.0).exp2(),
            colour: [(); 3].map(|()| rng.below(256) as u8),
        });
        let picture = |copies: usize, slots: u16| {
            with_scene::<L, _>(screen, &vec![one; copies], |scene| {
                frame(scene, slots, true, [0; 3])
            })
        };
        let alone = picture(1, 4);
        for (copies, slots) in [(2, 4), (7, 3), (7, 0), (40, 64)] {
            assert_eq!(picture(copies, slots), alone, "{copies}, {slots}: {one:?}");
        }
    }
}
