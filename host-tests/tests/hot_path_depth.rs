//! K8: which of several surfaces is seen, by depth, by order of submission, and the depth itself.
//!
//! Depth is 1/w, 2^30 where w is 1, and 2^14 more. Here are its bounds, none set after measuring:
//!
//! | what | bound | from |
//! |---|---|---|
//! | a plane of any triangle | 2^13 units, and half a unit a pixel each way | 13 spare bits |
//! | one of a tiny triangle | 2^-16 of how much the corners differ, and 2^13 units | a reciprocal of 16 bits |
//! | a corner | `2^-15` of it | a reciprocal of 16 bits and its remainder; 26 bits of a model's scale |

use crate::common::Rng;
use crate::hot::exact::{weights, within};
use crate::hot::{
    Corner, LineRooms, Place, SceneRooms, Smooth, WordOf, camera, draw_with, frame, line,
    with_scene,
};
use scanbeam::look::Gouraud;
use scanbeam::pixel::{PixelFormat, Rgb565, Rgb888};
use scanbeam::scene::{Draw, Scene, Scissor};
use scanbeam::{Affine, Camera, Cull, Faces, Mesh, Screen};

type L = Gouraud<Rgb888>;
/// Depth where w is 1.
const ONE: f64 = (1u32 << 30) as f64;
/// What all depths are raised by.
const RAISED: f64 = 16_384.0;

/// A triangle's colour by number, below 64; far enough apart for 5 bits.
fn colour(id: usize) -> [u8; 3] {
    [60 + 16 * (id % 8) as u8, 60 + 16 * (id / 8) as u8, 0]
}

/// The numbers of the triangles that are seen; `None` where none is.
fn seen<L: Smooth>(scene: &Scene<'_, '_, L>, slots: u16, depth: bool) -> Vec<Vec<Option<usize>>> {
    let background = L::Format::from_rgb8([0; 3]);
    let id = |word: WordOf<L>| {
        let [red, green, _] =
            L::Format::to_rgb8(word).map(|level| (usize::from(level) + 8).checked_sub(60));
        Some(red? / 16 + green? / 16 * 8)
    };
    let lines = frame(scene, slots, depth, background).into_iter();
    lines
        .map(|line| line.into_iter().map(id).collect())
        .collect()
}

/// A triangle drawn twice, so that it meets itself, by calls that have a value: only there all depth is kept.
fn with_kept(screen: Screen, one: [Corner; 3], see: impl FnOnce(&Scene<'_, '_, L>)) {
    let mut rooms = SceneRooms::of_triangles(2, screen);
    let mut scene = rooms.scene::<L>(screen);
    scene.begin(&camera()).unwrap();
    for _ in 0..2 {
        let all = Scissor::inside(0..screen.width(), 0..screen.height());
        draw_with(&mut scene, &[one], |call| {
            (call.cull, call.scissor) = (Cull::None, Some(all));
        })
        .unwrap();
    }
    see(&scene);
}

fn distance(rng: &mut Rng, bits: f64) -> f64 {
    rng.between(0.0, bits).exp2()
}

/// 1/w at a pixel, as depth.
pub fn exact(corners: &[Corner; 3], column: usize, line: u16) -> f64 {
    let places = corners.map(|c| c.at);
    let (part, _) = weights(places, column as i32, line.into());
    (0..3).map(|k| part[k] * ONE / corners[k].w).sum()
}

/// How far depth may be off at a pixel.
pub fn bound(corners: &[Corner; 3]) -> f64 {
    let depth = corners.map(|c| ONE / c.w);
    let (low, high) = depth
        .iter()
        .fold((f64::MAX, 0.0f64), |(l, h), &d| (l.min(d), h.max(d)));
    let extent = |c: [i32; 3]| f64::from(c.iter().max().unwrap() - c.iter().min().unwrap());
    let size = extent(corners.map(|c| c.at.0)) + extent(corners.map(|c| c.at.1));
    8_192.0 + size / 16.0 + (high - low) * 2f64.powi(-16) + high * 2f64.powi(-15)
}

/// A triangle of any size, from specks to what is larger than the picture, thin and not.
fn places(rng: &mut Rng) -> [Place; 3] {
    let a = (rng.within(-100, 480), rng.within(-100, 420));
    let size = rng.pick(&[6, 30, 100, 200, 400, 2_000]);
    let near = |rng: &mut Rng, a: Place, size: i32| {
        (a.0 + rng.within(-size, size), a.1 + rng.within(-size, size))
    };
    let b = near(rng, a, size);
    let c = if rng.below(3) == 0 {
        let on = rng.within(0, 64);
        near(
            rng,
            (a.0 + (b.0 - a.0) * on / 64, a.1 + (b.1 - a.1) * on / 64),
            3,
        )
    } else {
        near(rng, a, size)
    };
    [a, b, c]
}

fn triangle(rng: &mut Rng, bits: f64, away: f64, id: usize) -> [Corner; 3] {
    places(rng).map(|at| Corner {
        at,
        w: distance(rng, bits) * away.exp2(),
        colour: colour(id),
    })
}

#[test]
fn depth_is_within_its_bound_of_1_over_w() {
    let mut rng = Rng::new(341);
    let screen = Screen::new(48, 40).unwrap();
    let (mut worst, mut units, mut pixels) = (0.0f64, 0.0f64, 0u64);
    for round in 0..20_000 {
        let (bits, away) = [
            (0.0, 0.0),
            (1.0, 0.0),
            (6.0, 0.0),
            (5.0, 4.0),
            (1.0, 9.0),
            (0.5, 15.0),
        ][round % 6];
        let one = triangle(&mut rng, bits, away, 0);
        let at = one.map(|c| c.at);
        let bound = bound(&one);
        with_kept(screen, one, |scene| {
            let slots = rng.pick(&[0, 1, 4]);
            for y in 0..screen.height() {
                let columns = within(at, y.into(), screen.width());
                if columns.is_empty() {
                    continue;
                }
                let mut rooms = LineRooms::fitting(scene, slots, true);
                line(&mut rooms.renderer(), scene, y, [0; 3]);
                for x in columns {
                    let want = exact(&one, x, y) + RAISED;
                    let off = (f64::from(rooms.depth[x]) - want).abs();
                    worst = worst.max(off / bound);
                    units = units.max(off);
                    pixels += 1;
                    assert!(
                        off <= bound,
                        "{} for {want}, {bound} at {x}, {y}, {slots} slots: {one:?}",
                        rooms.depth[x]
                    );
                }
            }
        });
    }
    println!("{pixels} pixels, at most {units} units, {worst} of the bound");
    assert!(pixels > 1_000_000);
}

/// From the nearest that a camera sees to the farthest within one triangle: no depth leaves its range, so nothing
/// far is taken for the nearest.
#[test]
fn depth_never_wraps() {
    let mut rng = Rng::new(344);
    let screen = Screen::new(48, 40).unwrap();
    let (mut least, mut most, mut pixels) = (u32::MAX, 0, 0u64);
    for _ in 0..20_000 {
        let at = places(&mut rng);
        let one = at.map(|at| Corner {
            at,
            w: rng.pick(&[1.0, 1.0, 4_000.0, 65_400.0]),
            colour: [200, 0, 0],
        });
        with_kept(screen, one, |scene| {
            let slots = rng.pick(&[0, 4]);
            let mut rooms = LineRooms::fitting(scene, slots, true);
            let mut cells = Vec::new();
            for y in (0..screen.height()).step_by(3) {
                rooms.depth.fill(u32::MAX);
                line(&mut rooms.renderer(), scene, y, [0; 3]);
                cells.extend(rooms.depth.iter().filter(|&&cell| cell != u32::MAX));
            }
            for cell in cells {
                (least, most, pixels) = (least.min(cell), most.max(cell), pixels + 1);
                // Corners at 1 are cut to 2^-10 of it where others are so far.
                let range = 1..(ONE * 1.004) as u32;
                assert!(range.contains(&cell), "{cell}, {slots} slots: {one:?}");
            }
        });
    }
    println!("{pixels} pixels, {least} to {most}");
    assert!(pixels > 400_000);
}

/// Of many surfaces across each other the nearest is seen wherever it is nearer than all others by more than
/// the bounds, in whatever order they are drawn and whatever the cache is.
#[test]
fn the_nearest_is_seen() {
    nearest::<Gouraud<Rgb888>>(342);
    nearest::<Gouraud<Rgb565>>(346);
}

fn nearest<L: Smooth>(seed: u64) {
    let mut rng = Rng::new(seed);
    let screen = Screen::new(48, 40).unwrap();
    let (mut decided, mut open) = (0u64, 0u64);
    for round in 0..1_500 {
        let (bits, away) = [
            (1.0, 0.0),
            (0.2, 0.0),
            (6.0, 0.0),
            (1.0, 6.0),
            (4.0, 4.0),
            (0.9, 15.0),
        ][round % 6];
        let count = rng.pick(&[2, 3, 12, 40]);
        let triangles: Vec<_> = (0..count)
            .map(|i| triangle(&mut rng, bits, away, i))
            .collect();
        let bounds: Vec<_> = triangles.iter().map(bound).collect();
        let slots = rng.pick(&[0, 1, 8, 64]);
        let picture = with_scene::<L, _>(screen, &triangles, |scene| seen(scene, slots, true));
        for (y, line) in (0..).zip(&picture) {
            let mut at = vec![Vec::new(); screen.width().into()];
            for (k, t) in triangles.iter().enumerate() {
                for x in within(t.map(|c| c.at), i32::from(y), screen.width()) {
                    at[x].push((exact(t, x, y), k));
                }
            }
            for (x, mut at) in at.into_iter().enumerate() {
                at.sort_by(|a, b| b.0.total_cmp(&a.0));
                let Some(&(depth, first)) = at.first() else {
                    assert_eq!(line[x], None);
                    continue;
                };
                let near = |&(other, k): &(f64, usize)| depth - other <= bounds[first] + bounds[k];
                if at.iter().skip(1).any(near) {
                    open += 1;
                    continue;
                }
                decided += 1;
                assert_eq!(
                    line[x],
                    Some(first),
                    "{x}, {y}, {slots} slots: {at:?} of {triangles:?}"
                );
            }
        }
    }
    println!("{decided} pixels decided, {open} too near to tell");
    assert!(decided > 500_000, "{decided}");
}

/// Layers over the whole picture and parts of it, each at a distance of its own or leaning, in any order: lines
/// that are full before all layers were asked have what the nearest ones have.
#[test]
fn layers_hide_what_is_behind_them() {
    let mut rng = Rng::new(345);
    let screen = Screen::new(64, 48).unwrap();
    for round in 0..1_200 {
        let layers: usize = rng.pick(&[2, 5, 20]);
        let leaning = round % 3 == 1;
        let mut triangles = Vec::new();
        for k in 0..layers {
            let colour = colour(k);
            let w = 1.01 + 0.15 * f64::from(rng.below(20));
            let (small, alone) = (rng.pick(&[1, 1, 2, 4]), rng.below(4) == 0);
            // Some twice at the same distance: there the last is seen.
            let mut corner = |x: i32, y: i32| Corner {
                at: (x + rng.within(-90, 90), y + rng.within(-60, 60)),
                w: if leaning {
                    w + rng.between(0.0, 0.2)
                } else {
                    w
                },
                colour,
            };
            let (a, b) = (corner(-50, -50), corner(600 / small, -40));
            let (c, d) = (corner(-60, 450 / small), corner(600 / small, 450 / small));
            if !alone {
                triangles.push([a, b, c]);
            }
            triangles.push([b, d, c]);
        }
        rng.shuffle(&mut triangles);
        let bounds: Vec<_> = triangles.iter().map(bound).collect();
        with_scene::<L, _>(screen, &triangles, |scene| {
            let picture = seen(scene, 64, true);
            // Without slots nothing is known of the line before.
            assert_eq!(picture, seen(scene, 0, true), "round {round}");
            for (y, line) in (0..).zip(&picture) {
                for (x, pixel) in line.iter().enumerate() {
                    let mut best: Option<(f64, usize)> = None;
                    let mut open = false;
                    for (k, t) in triangles.iter().enumerate() {
                        let at = t.map(|c| c.at);
                        if !within(at, i32::from(y), screen.width()).contains(&x) {
                            continue;
                        }
                        let depth = exact(t, x, y);
                        let Some((other, first)) = best else {
                            best = Some((depth, k));
                            continue;
                        };
                        let near = (depth - other).abs() <= bounds[k] + bounds[first];
                        open |= near && leaning;
                        if depth > other || near {
                            best = Some((depth, k));
                        }
                    }
                    if !open {
                        let want = best.map(|(_, k)| triangles[k][0].colour);
                        assert_eq!(pixel.map(colour), want, "{x}, {y}: {triangles:?}");
                    }
                }
            }
        });
    }
}

/// The red of the pixel in the middle of surfaces that face the eye, at these distances and drawn in this order, each
/// with its number, from 1 on, as its red.
fn faced(camera: &Camera, distances: [f64; 2], slots: u16) -> u8 {
    let screen = Screen::new(1, 1).unwrap();
    let mut rooms = SceneRooms::new(18, 9, 1, 2);
    let mut scene = rooms.scene::<L>(screen);
    scene.begin(camera).unwrap();
    for (number, distance) in (1..).zip(distances) {
        // In 2^-14 of the distance, so that the mesh rounds nothing.
        let positions = [
            [-8192i16, -8192, -16_384],
            [8192, -8192, -16_384],
            [0, 8192, -16_384],
        ];
        let call = Draw {
            model: Affine::placed(distance as f32, [0.0; 3]).unwrap(),
            colour: [number, 0, 0],
            ..Draw::new(Mesh {
                positions: &positions,
                normals: &[],
                colours: &[],
                faces: Faces::Triangles(&[[0, 1, 2]]),
            })
        };
        scene.draw(&call).unwrap();
    }
    frame(&scene, slots, true, [0; 3])[0][0][0]
}

/// Whatever near and far a camera accepts, of two surfaces a thousandth of their distance apart the nearer one is seen,
/// in either order.
#[test]
fn a_thousandth_apart_the_nearer_is_seen_at_any_distance() {
    let mut rng = Rng::new(301);
    for round in 0..4_000 {
        let near = rng.between(-50.0, 60.0).exp2() as f32;
        let ratio = rng.between(0.1, 16.0).exp2() as f32;
        let (ahead, up) = ([0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
        let camera = Camera::look_at([0.0; 3], ahead, up, 20.0, near, near * ratio).unwrap();
        let (near, far) = (f64::from(near), f64::from(near * ratio) / 1.002);
        let away = near * (far / near).powf(rng.pick(&[0.0, 1.0, rng.clone().unit()])) * 1.0005;
        let slots = [0, 1, 64][round % 3];
        for (distances, want) in [([away, away * 1.001], 1), ([away * 1.001, away], 2)] {
            let seen = faced(&camera, distances, slots);
            assert_eq!(seen, want, "{near} {ratio} {distances:?}");
        }
    }
}

/// The same of surfaces that lean, up to 8 times as far at one corner as at another, within 4,096 times near: farther away
/// planes of 1/w, which err by half a unit a pixel, no longer tell a thousandth apart in each pixel.
#[test]
fn a_thousandth_apart_the_nearer_that_leans_is_seen_within_4096_times_near() {
    let mut rng = Rng::new(302);
    let screen = Screen::new(40, 30).unwrap();
    let mut pixels = 0;
    for round in 0..6_000 {
        let steep = [1.2f64, 2.0, 8.0][round % 3];
        let farthest = (12.0 * rng.unit()).exp2();
        let corners = [(); 3].map(|()| {
            let at = (rng.within(-60, 380), rng.within(-60, 300));
            (at, (farthest * steep.powf(-rng.unit())).max(1.0))
        });
        let of = |red: u8, by: f64| {
            let colour = [red, 0, 0];
            corners.map(|(at, w)| Corner {
                at,
                w: w * by,
                colour,
            })
        };
        let [near, far] = [of(100, 1.0), of(200, 1.001)];
        let pair = if round % 2 == 0 {
            [near, far]
        } else {
            [far, near]
        };
        with_scene::<L, _>(screen, &pair, |scene| {
            let shown = frame(scene, [0, 1, 64][round / 3 % 3], true, [0; 3]);
            let shown = shown.into_iter().flatten().filter(|p| p[0] != 0);
            for pixel in shown {
                assert_eq!(pixel[0], 100, "{pair:?}");
                pixels += 1;
            }
        });
    }
    assert!(pixels > 500_000, "{pixels}");
}

/// Of equals the last is seen, and without depth the last of all.
#[test]
fn the_last_of_equals_is_seen() {
    last_of_equals::<Gouraud<Rgb888>>(343);
    last_of_equals::<Gouraud<Rgb565>>(347);
}

fn last_of_equals<L: Smooth>(seed: u64) {
    let mut rng = Rng::new(seed);
    let screen = Screen::new(48, 40).unwrap();
    let mut pixels = 0;
    for _ in 0..1_000 {
        let one = triangle(&mut rng, 3.0, 0.0, 0);
        let copies: usize = rng.pick(&[2, 3, 9]);
        let mut twins: Vec<_> = (0..copies)
            .map(|i| {
                one.map(|c| Corner {
                    colour: colour(i),
                    ..c
                })
            })
            .collect();
        // One that is nearer, first: with depth it is seen, without it is not.
        let nearer = one.map(|c| Corner {
            w: 0.9 * c.w.max(1.2),
            colour: colour(60),
            ..c
        });
        let is_nearer = one.iter().all(|c| c.w > 1.2);
        if is_nearer {
            twins.insert(0, nearer);
        }
        for (depth, slots) in [(true, 64), (true, 0), (false, 64), (false, 3)] {
            let picture = with_scene::<L, _>(screen, &twins, |scene| seen(scene, slots, depth));
            let want = if is_nearer && depth { 60 } else { copies - 1 };
            for (y, line) in (0..).zip(&picture) {
                for x in within(one.map(|c| c.at), y, screen.width()) {
                    assert_eq!(
                        line[x],
                        Some(want),
                        "{x}, {y}, {slots} slots, depth {depth}: {one:?}"
                    );
                    pixels += 1;
                }
            }
        }
    }
    assert!(pixels > 50_000, "{pixels}");
}

/// Kills: one place too many in the order of slots before there is one.
#[test]
fn all_slots_may_meet_on_the_first_line() {
    let mut rng = Rng::new(91);
    let screen = Screen::new(200, 3).unwrap();
    let triangles: Vec<_> = (0..128)
        .map(|i| {
            let left = rng.within(0, 1_000);
            [(left, -10), (left + 500, -10), (left + 200, 90)].map(|at| Corner {
                at,
                w: rng.between(1.0, 3.0),
                colour: colour(i % 64),
            })
        })
        .collect();
    with_scene::<L, _>(screen, &triangles, |scene| {
        let want = frame(scene, 0, true, [0; 3]);
        for slots in [32, 127, 128] {
            assert!(frame(scene, slots, true, [0; 3]) == want, "{slots} slots");
        }
    });
}
