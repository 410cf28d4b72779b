//! K3, K4, K5: which pixels triangles cover, exactly, and the same bits whatever the cache, the order of
//! lines or the number of renderers is.
//!
//! Triangles whose corners lie on chosen 1/8 pixels have a colour each. At every pixel the one that was
//! drawn last has to be seen, and each has to be hit as often as triangles cover it, by the words of the fill rule in
//! whole numbers. What meshes have together is in `watertight.rs`.

use crate::common::Rng;
use crate::hot::count::Count;
use crate::hot::cover::{Bench, GUARD, L, corners, id};
use crate::hot::exact::{columns, doubled_area};
use crate::hot::ways::Lines;
use crate::hot::{Corner, Place, SceneRooms, Smooth, WordOf, camera, draw, frame};
use scanbeam::look::Gouraud;
use scanbeam::pixel::{Rgb565Be, Rgb888};
use scanbeam::scene::Scene;
use scanbeam::{Cull, Screen};

fn screens() -> [Screen; 6] {
    [(1, 1), (32, 24), (33, 25), (320, 240), (1016, 3), (3, 1016)]
        .map(|(w, h)| Screen::new(w, h).unwrap())
}

/// A place at most `reach` units beyond the picture.
fn place(rng: &mut Rng, screen: Screen, reach: i32) -> Place {
    let (w, h) = (
        8 * i32::from(screen.width()),
        8 * i32::from(screen.height()),
    );
    let mut along = |size: i32| {
        let (low, high) = (size / 2 - GUARD + 8, size / 2 + GUARD - 8);
        rng.within(-reach, size + reach).clamp(low, high)
    };
    (along(w), along(h))
}

/// A triangle of any shape.
fn shape(rng: &mut Rng, screen: Screen) -> [Place; 3] {
    let a = place(rng, screen, 40);
    let near = |rng: &mut Rng, a: Place, size: i32| {
        (a.0 + rng.within(-size, size), a.1 + rng.within(-size, size))
    };
    match rng.below(8) {
        // Specks, and what is about as large as each way of setting up allows.
        0 => [a, near(rng, a, 6), near(rng, a, 6)],
        1 => [a, near(rng, a, 30), near(rng, a, 30)],
        2 => [a, near(rng, a, 110), near(rng, a, 110)],
        3 => [a, near(rng, a, 250), near(rng, a, 250)],
        4 => [a, near(rng, a, 520), near(rng, a, 520)],
        // Across the picture's borders.
        5 => [(); 3].map(|()| place(rng, screen, 600)),
        // Slivers at any slope.
        6 => {
            let b = place(rng, screen, 400);
            let on = rng.within(0, 64);
            let c = (a.0 + (b.0 - a.0) * on / 64, a.1 + (b.1 - a.1) * on / 64);
            let c = near(rng, c, 3);
            [a, b, c]
        }
        // To the ends of the guard band.
        _ => [(); 3].map(|()| place(rng, screen, GUARD)),
    }
}

#[test]
fn spans_by_the_rule_are_pixels_by_the_rule() {
    let mut rng = Rng::new(301);
    let screen = Screen::new(33, 25).unwrap();
    for _ in 0..4_000 {
        let triangle = shape(&mut rng, screen);
        let count = Count::new(screen, &[triangle], Cull::None);
        for y in 0..screen.height() {
            let columns = columns(triangle, y.into());
            for (x, &hit) in (0..).zip(&count.hits[count.line(y)]) {
                assert_eq!(columns.contains(&x), hit == 1, "{x}, {y}: {triangle:?}");
            }
        }
    }
}

/// All shapes over one another, few enough that each is seen somewhere.
#[test]
fn triangles_of_all_shapes_cover_what_the_rule_says() {
    let mut rng = Rng::new(302);
    let mut bench = Bench::new();
    for round in 0..1_500 {
        let screen = screens()[round % 6];
        let count = rng.pick(&[1, 2, 7, 40]);
        let triangles: Vec<_> = (0..count).map(|_| shape(&mut rng, screen)).collect();
        let cull = rng.pick(&[Cull::None, Cull::Back]);
        let slots = rng.pick(&[[0, 128, 4], [1, 64, 128], [64, 1, 0], [4, 4, 64]]);
        bench.check(screen, &triangles, cull, &slots);
    }
    assert!(bench.triangles > 10_000, "{}", bench.triangles);
}

/// One at a time: nothing is hidden.
#[test]
fn each_triangle_alone_covers_what_the_rule_says() {
    let mut rng = Rng::new(303);
    let mut bench = Bench::new();
    for round in 0..12_000 {
        let screen = screens()[[0, 1, 2, 1, 2, 4, 5][round % 7]];
        let triangle = shape(&mut rng, screen);
        let slots = rng.pick(&[[4, 4], [0, 4], [64, 0]]);
        bench.check(screen, &[triangle], Cull::None, &slots);
    }
}

/// Half squares of 64 pixels, of which all corners are 512 units apart or in line. Kills: 512 units that count as fewer.
#[test]
fn half_squares_of_64_pixels_cover_what_the_rule_says() {
    let mut rng = Rng::new(312);
    let mut bench = Bench::new();
    let screen = screens()[3];
    for round in 0..400 {
        let (x, y) = (rng.within(-40, 2_000), rng.within(-40, 1_400));
        let square = [(x, y), (x, y + 512), (x + 512, y + 512), (x + 512, y)];
        let triangle = [1, 2, 3].map(|k| square[(round + k) % 4]);
        bench.check(screen, &[triangle], Cull::None, &[4, 0]);
    }
}

/// Corners at the very ends of the guard band, all of them and some.
#[test]
fn giants_of_the_whole_guard_band_cover_what_the_rule_says() {
    let mut rng = Rng::new(304);
    let mut bench = Bench::new();
    for round in 0..1_500 {
        let screen = screens()[1 + round % 5];
        let middle = (
            4 * i32::from(screen.width()),
            4 * i32::from(screen.height()),
        );
        let mut along = |middle: i32| {
            let end = rng.pick(&[GUARD, GUARD, GUARD - 1, GUARD - 8, 9_000, 1_000, 3, 0]);
            middle + rng.pick(&[-end, end])
        };
        let triangles = [(); 2].map(|()| [(); 3].map(|()| (along(middle.0), along(middle.1))));
        bench.check(screen, &triangles, Cull::None, &[4, 0]);
    }
}

/// Beyond the guard band triangles are cut: nothing of the picture changes but by a unit beside edges that were
/// cut. Pieces take the vertices that they have.
#[test]
fn triangles_cut_at_the_guard_band_cover_what_they_did() {
    let mut rng = Rng::new(309);
    let mut rooms = SceneRooms::new(64, 32, 1_016, 2);
    let (mut cut, mut decided) = (0, 0);
    for round in 0..3_000 {
        let screen = screens()[1 + round % 5];
        let (w, h) = (screen.width(), screen.height());
        let middle = (4 * i32::from(w), 4 * i32::from(h));
        let mut along = |middle: i32| {
            let far = rng.within(0, 60_000);
            middle + rng.pick(&[-20_000 - far, far - 30_000, 20_000 + far])
        };
        let triangle = [(); 3].map(|()| (along(middle.0), along(middle.1)));
        if doubled_area(triangle).abs() < 1 << 20 {
            continue;
        }
        let mut scene = rooms.scene::<L>(screen);
        scene.begin(&camera()).unwrap();
        draw(&mut scene, &corners(&[triangle]), Cull::None).unwrap();
        cut += scene.assembled().clipped;
        // Those of the mesh, if it is kept, and of pieces.
        assert_eq!(scene.vertices() % 3, 0, "{triangle:?}");
        for (y, line) in (0..).zip(frame(&scene, rng.pick(&[0, 4]), false, [0; 3])) {
            for (x, pixel) in (0..).zip(line) {
                // Doubled areas with the pixel, over the lengths of sides: distances to the sides.
                let at = (8 * x + 4, 8 * y + 4);
                let side = if doubled_area(triangle) > 0 {
                    1.0
                } else {
                    -1.0
                };
                let distance = [0, 1, 2].map(|k| {
                    let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
                    let long = f64::from(b.0 - a.0).hypot(f64::from(b.1 - a.1));
                    side * doubled_area([a, b, at]) as f64 / long
                });
                let least = distance.into_iter().fold(f64::MAX, f64::min);
                if least.abs() > 2.0 {
                    decided += 1;
                    assert_eq!(
                        id(pixel) == 1,
                        least > 0.0,
                        "{x}, {y}: {least}, {triangle:?}"
                    );
                }
            }
        }
    }
    assert!(cut > 1_000 && decided > 1_000_000, "{cut} {decided}");
}

/// A scene of triangles of many distances and colours, some through each other.
fn mixed(rng: &mut Rng, screen: Screen, count: usize) -> Vec<[Corner; 3]> {
    let mut one = || {
        let places = shape(rng, screen);
        places.map(|at| Corner {
            at,
            w: rng.between(1.01, 3.0),
            colour: [(); 3].map(|()| rng.below(256) as u8),
        })
    };
    (0..count).map(|_| one()).collect()
}

/// Draws `mixed` triangles and hands the scene to `see`.
fn with_mixed<M: Smooth>(
    rng: &mut Rng,
    screen: Screen,
    see: impl FnOnce(&mut Rng, &Scene<'_, 'static, M>),
) {
    let count = rng.pick(&[3, 20, 90, 300]);
    let triangles = mixed(rng, screen, count);
    let mut rooms = SceneRooms::new(3 * count, count, screen.height().into(), 1);
    let mut scene = rooms.scene::<M>(screen);
    scene.begin(&camera()).unwrap();
    draw(&mut scene, &triangles, Cull::None).unwrap();
    see(rng, &scene);
}

fn cache_and_lines<M: Smooth>(seed: u64, background: WordOf<M>)
where
    WordOf<M>: std::fmt::Debug,
{
    let mut rng = Rng::new(seed);
    for round in 0..30 {
        let screen = screens()[round % 6];
        with_mixed::<M>(&mut rng, screen, |rng, scene| {
            for depth in [true, false] {
                let lines = Lines {
                    scene,
                    depth,
                    background,
                };
                let name = format!("round {round}");
                let want = lines.whole(&name);
                lines.every_way(&want, rng, &name);
            }
        });
    }
}

#[test]
fn the_cache_and_the_order_of_lines_change_nothing() {
    cache_and_lines::<Gouraud<Rgb888>>(306, [1, 2, 3]);
    cache_and_lines::<Gouraud<Rgb565Be>>(307, 0x1234);
}

#[test]
fn bands_are_parts_of_the_whole() {
    let mut rng = Rng::new(308);
    for round in 0..60 {
        let screen = screens()[1 + round % 5];
        let triangles = mixed(&mut rng, screen, 80);
        let height = screen.height();
        let mut rooms = SceneRooms::new(240, 80, height.into(), 1);
        let mut picture = |lines: std::ops::Range<u16>, slots: u16| {
            let mut scene = rooms.scene::<L>(screen);
            scene.begin_lines(&camera(), lines.clone()).unwrap();
            draw(&mut scene, &triangles, Cull::None).unwrap();
            assert_eq!(scene.lines(), lines);
            frame(&scene, slots, true, [9; 3])
        };
        let whole = picture(0..height, 64);
        let mut from = 0;
        while from < height {
            let to = (from + 1 + rng.below(u32::from(height).div_ceil(3)) as u16).min(height);
            let got = picture(from..to, rng.pick(&[0, 7, 128]));
            assert!(
                got == whole[from.into()..to.into()],
                "lines {from}..{to}, round {round}"
            );
            from = to;
        }
    }
}
