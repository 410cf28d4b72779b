use super::*;
use crate::geometry::CameraError;
use crate::num::random::Rng;

#[test]
fn places_are_the_nearest_to_those_of_a_division() {
    let screen = Screen::new(320, 240).unwrap();
    let mut rng = Rng(9);
    let (mut worst, mut worst_fine, mut worst_depth) = (0f64, 0f64, 0f64);
    for i in 0..60_000 {
        let size = [0.001f32, 1.0, 5000.0][i % 3];
        let focal = [20.0f32, 200.0, 3000.0][i / 3 % 3];
        let away = size * (3.0 + 40.0 * rng.signed().abs());
        let (o, z, y) = ([0.0; 3], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
        let camera = Camera::look_at(o, z, y, focal, size, size * 1000.0).unwrap();
        let model = Affine::placed(size, [0.0, 0.0, -away]).unwrap();
        let view = View::new(&camera, screen, &model);
        let q = [rng.signed(), rng.signed(), rng.signed()].map(|c| (c * 16_384.0) as i16);
        let p = view.point(q);
        if view.beyond(p) != 0 {
            assert!(!view.is_within(p));
            continue;
        }
        assert!(view.is_within(p));
        let on = view.project(p);
        let [x, y, z] = q.map(|c| f64::from(c) / 16_384.0 * f64::from(size));
        let z = f64::from(away) - z;
        let want = [
            8.0 * (f64::from(ORIGIN) + 160.0 + f64::from(focal) * x / z),
            8.0 * (f64::from(ORIGIN) + 120.0 - f64::from(focal) * y / z),
        ];
        let got = [on.place & 0xFFFF, on.place >> 16].map(f64::from);
        for k in 0..2 {
            worst = worst.max((got[k] - want[k]).abs());
            let fine = got[k] + f64::from(on.fine[k]) / 8.0;
            worst_fine = worst_fine.max((fine - want[k]).abs());
        }
        // All depths of a camera have the same factor, 1/2 to 1.
        let depth = f64::from(on.depth) / 2f64.powi(31) * z / f64::from(size);
        let near = View::new(&camera, screen, &Affine::placed(size, [0.0; 3]).unwrap());
        let at_near = near.project(near.point([0i16, 0, -32_768]));
        let factor = f64::from(at_near.depth) / 2f64.powi(30);
        assert!(factor > 0.49 && factor < 1.0001, "{factor}");
        worst_depth = worst_depth.max((depth / factor - 1.0).abs());
    }
    std::println!("{worst} {worst_fine} of 1/8 pixel, {worst_depth}");
    assert!(worst < 0.505, "{worst}");
    assert!(worst_fine < 0.13, "{worst_fine}");
    assert!(worst_depth < 3e-5, "{worst_depth}");
}

/// Kills: points on a plane that lie beyond it, or one unit beyond it that do not.
#[test]
fn planes_belong_to_what_is_seen() {
    let screen = Screen::new(320, 240).unwrap();
    let (o, ahead, up) = ([0.0; 3], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
    let camera = Camera::look_at(o, ahead, up, 200.0, 0.1, 2.0).unwrap();
    let view = View::new(&camera, screen, &Affine::IDENTITY);
    let at = |x: i32, y: i32, z: i32| view.beyond(Point { x, y, z });
    assert_eq!([at(0, 0, view.near), at(0, 0, view.far)], [0, 0]);
    let outside = [at(0, 0, view.near - 1), at(0, 0, view.far + 1)];
    assert_eq!(outside, [beyond::NEAR, beyond::FAR]);
    let z = view.near * 2;
    let side = guard(z);
    for (x, y, plane) in [
        (1, 0, beyond::RIGHT),
        (-1, 0, beyond::LEFT),
        (0, 1, beyond::BOTTOM),
        (0, -1, beyond::TOP),
    ] {
        assert_eq!(at(x * side, y * side, z), 0);
        assert_eq!(at(x * (side + 1), y * (side + 1), z), plane);
    }
}

/// Kills: points between guard planes that are beyond them with all bits, so that one of two neighbours is cut there.
#[test]
fn finer_points_lie_where_others_see_them() {
    let screen = Screen::new(320, 240).unwrap();
    let mut rng = Rng(11);
    let (mut worst, mut on_rim) = ([0f64; 2], 0);
    for _ in 0..60_000 {
        let (o, ahead, up) = ([0.0; 3], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
        let camera = Camera::look_at(o, ahead, up, 200.0, 1e-4, 1.0).unwrap();
        let view = View::new(&camera, screen, &Affine::IDENTITY);
        let z = 2e-4 + 1e-4 * f64::from(rng.signed());
        let [x, y] = [(); 2].map(|()| f64::from(rng.signed()));
        // Close to the guard band's rim, which is 10.24 times as far to the right.
        let q = [(10.24 + 0.02 * x) * z, 0.5 * z * y, -z];
        let q = q.map(|v| (v * f64::from(1 << 30)).round() as i32);
        let seen = view.point(q);
        let finer = view.finer(q, seen);
        let out = beyond::RIGHT | beyond::LEFT;
        if view.beyond(seen) & out != 0 {
            continue;
        }
        let within = [beyond::RIGHT, beyond::LEFT].map(|plane| view.within(plane, finer));
        assert!(within.iter().all(|w| *w >= 0), "{within:?}");
        assert!(view.is_between(finer));
        on_rim += u32::from(within.contains(&0));
        let below = 200.0 * f64::from(q[1]) / f64::from(q[2]);
        let want = 8.0 * (f64::from(ORIGIN) + 120.0 + below);
        let of = |on: OnScreen| f64::from(on.place >> 16) + f64::from(on.fine[1]) / 8.0;
        let projected = [view.project(seen), view.project_finer(finer, view.finer)].map(of);
        for k in 0..2 {
            worst[k] = worst[k].max((projected[k] - want).abs());
        }
        assert_eq!(view.project_finer(seen, 0), view.project(seen));
    }
    std::println!("{worst:?} of 1/8 pixel, {on_rim} on the rim");
    assert!(on_rim > 20, "{on_rim}");
    assert!(worst[0] > 8.0 && worst[1] < 0.4, "{worst:?}");
}

#[test]
fn cameras_that_are_shifted_see_the_same_from_another_middle() {
    let screen = Screen::new(320, 240).unwrap();
    let mut rng = Rng(10);
    let mut worst = 0;
    for i in 0..20_000 {
        let focal = [90.0f32, 700.0, 3000.0][i % 3];
        let (o, ahead, y) = ([0.0; 3], [0.2, 0.1, -1.0], [0.0, 1.0, 0.0]);
        let camera = Camera::look_at(o, ahead, y, focal, 0.1, 100.0).unwrap();
        let shift = [rng.signed(), rng.signed()].map(|s| s * 900.0);
        let shifted = camera.shifted(shift).unwrap();
        let model = Affine::placed(1.0, [0.0, 0.0, -4.0]).unwrap();
        let q = [rng.signed(), rng.signed(), rng.signed()].map(|c| (c * 16_384.0) as i16);
        let place = |camera: &Camera| {
            let view = View::new(camera, screen, &model);
            let p = view.point(q);
            let on = (view.beyond(p) == 0).then(|| view.project(p).place)?;
            Some([on & 0xFFFF, on >> 16].map(|c| c as i32))
        };
        let (Some(one), Some(other)) = (place(&camera), place(&shifted)) else {
            continue;
        };
        for k in 0..2 {
            let by = (f64::from(shift[k]) * 8.0).round() as i32;
            worst = worst.max((one[k] - by - other[k]).abs());
        }
    }
    assert_eq!(worst, 1);
    let camera = Camera::look_at([0.0; 3], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0], 2.0, 0.1, 9.0);
    let camera = camera.unwrap();
    assert!(camera.shifted([128.0, -128.0]).is_ok());
    for far in [[129.0, 0.0], [0.0, -129.0], [f32::NAN, 0.0], [0.0, 1e9]] {
        assert_eq!(
            camera.shifted(far).err(),
            Some(CameraError::Shift),
            "{far:?}"
        );
    }
}
