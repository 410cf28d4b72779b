//! Sides, filters and levels of detail.

use super::super::*;
use crate::num::random::Rng;
use std::vec;
use std::vec::Vec;

#[test]
fn sides_repeat_turn_back_or_end() {
    let words: Vec<u32> = (0..8).collect();
    let size = Size::new(8, 1).unwrap();
    fn row<A: Address>(words: &[u32], size: Size) -> Vec<u32> {
        let texture = Texture::<_, A>::new(Words(words), size).unwrap();
        (-9..18).map(|x| texture.texel((x, 5))).collect()
    }
    let modulo = |x: i32| x.rem_euclid(8) as u32;
    let mirror = |x: i32| {
        let x = x.rem_euclid(16);
        (if x < 8 { x } else { 15 - x }) as u32
    };
    let clamp = |x: i32| x.clamp(0, 7) as u32;
    assert_eq!(
        row::<Wrap>(&words, size),
        (-9..18).map(modulo).collect::<Vec<_>>()
    );
    assert_eq!(
        row::<Mirror>(&words, size),
        (-9..18).map(mirror).collect::<Vec<_>>()
    );
    assert_eq!(
        row::<Clamp>(&words, size),
        (-9..18).map(clamp).collect::<Vec<_>>()
    );
}

#[test]
fn wrong_sizes_are_named() {
    for (width, height) in [(0, 8), (8, 3), (2048, 8), (8, 1 << 31)] {
        assert_eq!(
            Size::new(width, height),
            Err(TextureError::Side { width, height })
        );
    }
    let size = Size::new(1024, 1).unwrap();
    assert_eq!(
        Texture::<_, Wrap>::new(Words(&[0u8; 1023]), size).unwrap_err(),
        TextureError::Texels {
            needed: 1024,
            have: 1023
        }
    );
    let error = TextureError::Side {
        width: 3,
        height: 4,
    };
    assert!(std::format!("{error}").contains("3x4"));
}

/// Random words of a texture that has every channel.
fn noise(size: Size, seed: u64) -> Vec<u32> {
    let mut rng = Rng(seed);
    (0..size.texels()).map(|_| rng.below(u32::MAX)).collect()
}

#[test]
fn bilinear_is_the_weighted_mean() {
    let size = Size::new(16, 8).unwrap();
    let words = noise(size, 2);
    let texture = Texture::<_, Mirror>::new(Words(&words), size).unwrap();
    let filtered = Bilinear::<_, Rgba8871>::new(texture);
    let mut rng = Rng(3);
    for _ in 0..20_000 {
        let mut coordinate = || (rng.below(40 * 16) as i32 - 160) << (FRACTION - 4);
        let place = Uv {
            u: coordinate(),
            v: coordinate(),
        };
        let got = filtered.at(place);
        let at = |x: i32| f64::from(x) / f64::from(1 << FRACTION) - 0.5;
        let (u, v) = (at(place.u), at(place.v));
        let channel = |get: fn(Texel) -> u8| {
            let mut sum = 0.0;
            for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                let (x, y) = (u.floor() + f64::from(dx), v.floor() + f64::from(dy));
                let weight = (1.0 - (u - x).abs()) * (1.0 - (v - y).abs());
                let fold = |a: f64, n: u32| {
                    let a = (a as i32).rem_euclid(2 * n as i32) as u32;
                    if a < n { a } else { 2 * n - 1 - a }
                };
                let index = fold(y, size.height()) * size.width() + fold(x, size.width());
                sum += weight * f64::from(get(Rgba8871::expand(words[index as usize])));
            }
            sum
        };
        let near = |got: u8, want: f64| assert!((f64::from(got) - want).abs() <= 0.5, "{place:?}");
        near(got.rgb[0], channel(|t| t.rgb[0]));
        near(got.rgb[1], channel(|t| t.rgb[1]));
        near(got.rgb[2], channel(|t| t.rgb[2]));
        near(got.alpha, channel(|t| t.alpha));
    }
    // At a texel's middle, the texel itself.
    let middle = Uv {
        u: 3 << FRACTION | 1 << (FRACTION - 1),
        v: 2 << FRACTION | 1 << (FRACTION - 1),
    };
    assert_eq!(filtered.at(middle), Rgba8871::expand(words[2 * 16 + 3]));
}

#[test]
fn levels_are_averages_of_averages() {
    for (w, h) in [(64, 64), (32, 4), (1, 16), (2, 1), (1, 1)] {
        let size = Size::new(w, h).unwrap();
        let mut level = noise(size, 7);
        for n in 0..3 {
            let (from, below) = (size.level(n), size.level(n + 1));
            let mut words = vec![0; below.texels()];
            let made = build_level::<Rgba8871>(from, |i| Rgba8871::expand(level[i]), &mut words);
            assert_eq!(made, Ok(below.texels()));
            for y in 0..below.height() {
                for x in 0..below.width() {
                    let fold =
                        |a: u32, d: u32, from: u32, to: u32| if from > to { 2 * a + d } else { a };
                    let four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dx, dy)| {
                        let x = fold(x, dx, from.width(), below.width());
                        let y = fold(y, dy, from.height(), below.height());
                        Rgba8871::expand(level[(y * from.width() + x) as usize])
                    });
                    let got = Rgba8871::expand(words[(y * below.width() + x) as usize]);
                    for i in 0..3 {
                        let mean = four.iter().map(|t| f64::from(t.rgb[i])).sum::<f64>() / 4.0;
                        assert!((f64::from(got.rgb[i]) - mean).abs() <= 0.5);
                    }
                    let mean = four.iter().map(|t| f64::from(t.alpha)).sum::<f64>() / 4.0;
                    assert!((f64::from(got.alpha) - mean).abs() <= 0.5);
                }
            }
            let short = build_level::<Rgba8871>(from, |_| Texel::default(), &mut words[1..]);
            assert_eq!(
                short,
                Err(TextureError::Texels {
                    needed: below.texels(),
                    have: below.texels() - 1
                })
            );
            level = words;
        }
        assert_eq!(
            level_words(size),
            (1..4).map(|n| size.level(n).texels()).sum::<usize>()
        );
    }
}

/// The level chosen from 1/w is that of the true ratio of areas at the place, but for ratios that
/// are within 2 % of a limit.
#[test]
fn levels_follow_the_ratio_that_depth_gives() {
    let mut rng = Rng(12);
    let mut seen = [0u32; 4];
    for i in 0..30_000 {
        let mut point = |n: f64| (rng.unit() * n, rng.unit() * n);
        let screen = [(); 3].map(|()| point(200.0));
        let stretch = [20.0, 100.0, 400.0, 1000.0][i % 4];
        let uv = [(); 3].map(|()| point(stretch));
        let q = [(); 3].map(|()| 0.05 + 0.9 * rng.unit());
        let cross = |p: [(f64, f64); 3]| {
            (p[1].0 - p[0].0) * (p[2].1 - p[0].1) - (p[2].0 - p[0].0) * (p[1].1 - p[0].1)
        };
        let area = (cross(screen).abs() * 64.0) as u64;
        let corners = [0, 1, 2].map(|i| Corner {
            depth: (q[i] * 2f64.powi(31)) as u32,
            u: (uv[i].0 * 256.0) as i32,
            v: (uv[i].1 * 256.0) as i32,
        });
        if area < 64 * 50 || cross(uv).abs() < 20.0 {
            continue;
        }
        let made = Corners::new(corners, Period::Short).unwrap();
        let ends = made.levels(area);
        // The true Jacobian by differences of the projective map, at a random inner point.
        let map = |x: f64, y: f64| {
            let part = |a: usize, b: usize| cross([(x, y), screen[a], screen[b]]) / cross(screen);
            let w = [part(1, 2), part(2, 0), part(0, 1)];
            let sum = |f: &dyn Fn(usize) -> f64| (0..3).map(|i| w[i] * f(i)).sum::<f64>();
            let at = sum(&|i| q[i]);
            (
                sum(&|i| q[i] * uv[i].0) / at,
                sum(&|i| q[i] * uv[i].1) / at,
                at,
            )
        };
        let (a, b) = (rng.unit(), rng.unit());
        let (a, b) = if a + b > 1.0 {
            (1.0 - a, 1.0 - b)
        } else {
            (a, b)
        };
        let inner = |get: fn((f64, f64)) -> f64| {
            let p = screen.map(get);
            p[0] + a * (p[1] - p[0]) + b * (p[2] - p[0])
        };
        let (x, y) = (inner(|p| p.0), inner(|p| p.1));
        let (o, r, d) = (map(x, y), map(x + 1e-4, y), map(x, y + 1e-4));
        let ratio = ((r.0 - o.0) * (d.1 - o.1) - (d.0 - o.0) * (r.1 - o.1)).abs() / 1e-8;
        // Half the logarithm to base 2 of the area ratio: the level in real numbers.
        let level = ratio.log2() / 2.0;
        let want = (level + 0.5).floor().clamp(0.0, 3.0) as u32;
        let scale = f64::from(made.at[0].q) / q[0];
        let got = ends.level((o.2 * scale) as u32);
        if ((level + 0.5) - (level + 0.5).round()).abs() > 0.04 {
            assert_eq!(got, want, "level {level}");
            seen[got as usize] += 1;
        }
    }
    assert!(seen.iter().all(|n| *n > 500), "{seen:?}");
    assert_eq!(LevelEnds::FULL.level(0), 0);
    assert_eq!(LevelEnds::new(0, 5, [1; 3]), LevelEnds::FULL);
}

#[test]
fn a_level_has_the_places_of_the_texture() {
    let size = Size::new(32, 32).unwrap();
    let all: Vec<Vec<u32>> = (0..4)
        .map(|n| (0..size.level(n).texels() as u32).collect())
        .collect();
    let levels = Levels {
        levels: [0, 1, 2, 3]
            .map(|n| Texture::<_, Wrap>::new(Words(&all[n][..]), size.level(n as u32)).unwrap()),
    };
    let place = Uv {
        u: 13 << FRACTION,
        v: -3 << FRACTION,
    };
    for (level, at) in [
        (0, (13, 29)),
        (1, (6, 14)),
        (2, (3, 7)),
        (3, (1, 3)),
        (9, (1, 3)),
    ] {
        let width = size.level(level).width().max(4);
        assert_eq!(
            levels.level(level).at(place),
            at.1 * width + at.0,
            "level {level}"
        );
    }
}

/// No number, however wrong, panics or reads beyond a texture.
#[test]
fn any_numbers_do_no_harm() {
    let words: Vec<u16> = (0..1 << 14).collect();
    let size = Size::new(128, 128).unwrap();
    let texture = Texture::<_, Mirror>::new(Words(&words), size).unwrap();
    let wrapped = Texture::<_, Wrap>::new(Words(&words), size).unwrap();
    let square = wrapped.square::<7, 16_384>().unwrap();
    let filtered = Bilinear::<_, Rgb565Texel>::new(texture);
    let mut rng = Rng(21);
    let mut sum = 0u32;
    for i in 0..20_000u32 {
        let mut any = || {
            let bits = rng.below(33);
            let x = (u64::from(rng.below(u32::MAX)) >> (32 - bits)) as i32;
            [x, x.wrapping_neg(), i32::MAX, i32::MIN, 0][if rng.below(8) == 0 {
                rng.below(5) as usize
            } else {
                0
            }]
        };
        let mut three = || Homogeneous {
            q: any(),
            s: any(),
            t: any(),
        };
        let span = PerspectiveSpan {
            at: three(),
            step: three(),
        };
        let corner = |h: Homogeneous| Corner {
            depth: h.q as u32,
            u: h.s,
            v: h.t,
        };
        let corners = [
            corner(span.at),
            corner(span.step),
            corner(span.at.plus(span.step)),
        ];
        let period = [Period::Short, Period::Long, Period::Never][i as usize % 3];
        if let Some(made) = Corners::new(corners, period) {
            sum += u32::from(made.straight(Budget::texels(span.at.s as u32, 1 << FRACTION)));
            sum += made
                .levels(u64::from(span.at.t as u32))
                .level(span.step.q as u32);
        }
        let pixels = (i % 70) as usize;
        let stride = Budget::texels(span.step.t as u32, 1 << FRACTION).stride(&span, pixels);
        let mut line = vec![0u16; pixels];
        for stride in [stride, Stride::ALL[(i % 6) as usize]] {
            span.draw(stride, &texture, &mut line, |pixel, texel| *pixel = texel);
            span.draw(stride, &square, &mut line, |pixel, texel| *pixel ^= texel);
            span.draw(stride, &filtered, &mut line, |pixel, texel| {
                *pixel ^= u16::from(texel.rgb[0]);
            });
            sum = line
                .iter()
                .fold(sum, |sum, word| sum.wrapping_add(u32::from(*word)));
        }
    }
    assert_ne!(sum, 0);
}
