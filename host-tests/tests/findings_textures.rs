//! Places on textures at the ends of their ranges: far from the first texel, and far apart.

use crate::common::{Rng, SceneRooms, frame};
use host_tests::places::{PlaceFormat, Places};
use scanbeam::event::Event;
use scanbeam::mesh::ScreenVertex;
use scanbeam::pipeline::texture::{
    Address, Checker, Clamp, Gradient, Mirror, Quality, Size, Skin, TexelOf, Texels, Texture,
    Textured, Textures, Words, Wrap,
};
use scanbeam::pipeline::{
    Composited, Depth32, Flat, FrameStats, Instance, Packed8, Parts, TexturedDepth,
};
use scanbeam::pixel::Rgb888;
use scanbeam::{Camera, Cull, Faces, Mesh, Screen};

type Look<'t, T> = TexturedDepth<'t, Rgb888, T>;

fn camera() -> Camera {
    let (ahead, up) = ([0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
    Camera::look_at([0.0; 3], ahead, up, 9.0, 0.1, 9.0).unwrap()
}

/// The first lines of pictures 16 x 16 of one triangle on which u goes from `from` to `to` texels
/// from left to right; how many triangles are said to be untextured, and told to be.
fn row<T: Texels<Texel: TexelOf<Rgb888>>>(
    texture: T,
    (from, to): (i32, i32),
    (depths, quality): ([u32; 3], Quality),
    upright: bool,
) -> (Vec<u8>, u32) {
    let textures = [texture];
    let mut rooms = SceneRooms::<Look<'_, T>>::new(3, 1, 16);
    rooms.textures = Textures(&textures);
    let places = [(0i16, 0i16), (128, 0), (0, 128)];
    let vertices = [0, 1, 2].map(|i| ScreenVertex {
        x: places[i].0,
        y: places[i].1,
        depth: depths[i],
        colour: [255; 3],
    });
    let along = [from, to, from].map(|u| if upright { [0, u] } else { [u, 0] });
    let mut scene = rooms.scene(Screen::new(16, 16).unwrap());
    scene.begin(&camera()).unwrap();
    let skin = Skin {
        places: &along,
        texture: 0,
        quality,
    };
    let done = scene.draw_screen(&vertices, &[[0, 1, 2]], skin, Cull::None);
    let untextured = scene.pass_one().untextured;
    assert_eq!(done.unwrap().untextured, untextured);
    let shown = frame(&scene, 1)[0][..15].iter().map(|p| p[0]).collect();
    (shown, untextured)
}

/// The same of a flat triangle, whole texels; textured.
fn flat<T: Texels<Texel: TexelOf<Rgb888>> + Copy>(texture: T, from: i32, to: i32) -> Vec<u8> {
    let how = ([1 << 30; 3], Quality::Exact);
    let (across, plain) = row(texture, (from * 256, to * 256), how, false);
    assert_eq!(plain, 0);
    across
}

/// Texels that say their column, from 1 on, modulo 251.
fn columns(width: u32) -> Vec<[u8; 3]> {
    (0..width).map(|i| [(i % 251 + 1) as u8; 3]).collect()
}

fn texture<A: Address>(texels: &[[u8; 3]], width: u32) -> Texture<Words<'_, [u8; 3]>, A> {
    Texture::new(Words(texels), Size::new(width, 1).unwrap()).unwrap()
}

/// What the middles of 15 of 16 pixels show where u goes from one place to another.
fn wanted(from: i32, to: i32, of: impl Fn(i64) -> u8) -> Vec<u8> {
    let middle = |i: i32| (i64::from(from) * 32 + i64::from(to - from) * i64::from(2 * i + 1)) >> 5;
    (0..15).map(|i| of(middle(i))).collect()
}

/// Wherever a triangle lies, what lies beyond the sides of a texture is what its way says.
#[test]
fn what_lies_beyond_the_sides_is_shown_wherever_it_lies() {
    let starts = [
        -1_048_576, -5000, -4090, -1025, -1024, -17, -16, -1, 0, 1, 7, 500, 1000, 1023, 1024, 1100,
        2040, 2048, 3000, 4080, 4090, 4096, 6000, 8190, 100_000,
    ];
    for start in starts {
        for way in [16, 48, 176] {
            let (from, to) = (start, start + way);
            for log in [0, 3, 9, 10] {
                let side = 1i64 << log;
                let texels = columns(1 << log);
                let at = |u: i64| (u % 251 + 1) as u8;
                let context = || format!("{from} to {to} of {side}");
                assert_eq!(
                    flat(texture::<Wrap>(&texels, 1 << log), from, to),
                    wanted(from, to, |u| at(u.rem_euclid(side))),
                    "wrap, {}",
                    context()
                );
                assert_eq!(
                    flat(texture::<Clamp>(&texels, 1 << log), from, to),
                    wanted(from, to, |u| at(u.clamp(0, side - 1))),
                    "clamp, {}",
                    context()
                );
                assert_eq!(
                    flat(texture::<Mirror>(&texels, 1 << log), from, to),
                    wanted(from, to, |u| {
                        let u = u.rem_euclid(2 * side);
                        at(u.min(2 * side - 1 - u))
                    }),
                    "mirror, {}",
                    context()
                );
            }
            for log_side in 0..=12 {
                let checker = Checker {
                    colours: [[1; 3], [2; 3]],
                    log_side,
                };
                let of = |u: i64| (u >> log_side & 1) as u8 + 1;
                assert_eq!(
                    flat(checker, from, to),
                    wanted(from, to, of),
                    "{log_side}, {from}"
                );
            }
            for log_length in [0, 5, 9, 10, 11] {
                let gradient = Gradient {
                    from: [0; 3],
                    to: [255; 3],
                    log_length,
                };
                let length = 1i64 << log_length;
                // To an eighth of a texel, there and back.
                let got = flat(gradient, from, to);
                for (i, got) in (0..15).zip(got) {
                    let u = f64::from(from) + f64::from(way) * (f64::from(i) + 0.5) / 16.0;
                    let u = u.rem_euclid(2.0 * length as f64);
                    let want = 255.0 * u.min(2.0 * length as f64 - u) / length as f64;
                    assert!(
                        (f64::from(got) - want).abs() < 1.5,
                        "{log_length}, {from}: {i}"
                    );
                }
            }
        }
    }
}

/// A 256th of a texel below 0 is what its neighbour shows.
#[test]
fn a_clamped_corner_a_little_below_0_changes_nothing() {
    let texels = columns(8);
    let how = ([1 << 30; 3], Quality::Exact);
    for upright in [false, true] {
        let clamp = || texture::<Clamp>(&texels, 8);
        let (a, _) = row(clamp(), (0, 16 * 256), how, upright);
        let (b, _) = row(clamp(), (-1, 16 * 256 - 1), how, upright);
        assert_eq!(a, b);
    }
    let clamp = texture::<Clamp>(&texels, 8);
    assert_eq!(flat(clamp, -1, 15)[..10], [1, 1, 2, 3, 4, 5, 6, 7, 8, 8]);
}

/// 4,096 texels are textured wherever they begin, in all ways; what is wider is counted and told.
#[test]
fn triangles_have_4096_texels_wherever_they_begin() {
    let mut rng = Rng::new(311);
    let texels: Vec<_> = (0..8).map(|i| [20 * (i + 1); 3]).collect();
    let mut starts = vec![
        0,
        1,
        256 * 1000,
        256 * 1023,
        256 * 1024 - 1,
        -1,
        -256 * 4000,
    ];
    starts.extend((0..60).map(|_| rng.within(-1_000_000_000, 1_000_000_000)));
    let leaning = [1 << 30, 1 << 28, 1 << 29];
    for start in starts {
        for quality in [Quality::Fast, Quality::Balanced, Quality::Exact] {
            for depths in [[1 << 30; 3], leaning] {
                for (way, wide) in [
                    (3072 * 256, false),
                    (3073 * 256, false),
                    (4095 * 256 + 250, false),
                    (4096 * 256 - 1, false),
                    (4096 * 256, false),
                    (4096 * 256 + 1, true),
                    (90_000_000, true),
                ] {
                    let Some(end) = i32::checked_add(start, way) else {
                        continue;
                    };
                    for upright in [false, true] {
                        let ends = if rng.below(2) == 0 {
                            (start, end)
                        } else {
                            (end, start)
                        };
                        let wrap = texture::<Wrap>(&texels, 8);
                        let (shown, plain) = row(wrap, ends, (depths, quality), upright);
                        let is_plain = shown.iter().all(|c| *c == 255);
                        assert_eq!(is_plain, wide, "{start} {way} {quality:?} {depths:?}");
                        assert_eq!(plain, u32::from(wide), "{start} {way}");
                    }
                }
            }
        }
    }
}

/// The same of a mesh, whole and cut by the near plane, and of one of many triangles of which few
/// are too wide: each is counted once.
#[test]
fn wide_triangles_of_meshes_are_counted_once() {
    type Wide<'t> = Composited<Look<'t, Texture<Words<'t, [u8; 3]>>>>;
    let texels: Vec<_> = (0..8).map(|i| [20 * (i + 1); 3]).collect();
    let textures = [texture::<Wrap>(&texels, 8)];
    let mut positions = Vec::new();
    let mut places = Vec::new();
    let mut faces = Vec::new();
    let mut triangle = |z: [i16; 3], way: i32| {
        let first = positions.len() as u16;
        positions.extend([[-8192, -8192, z[0]], [8192, -8192, z[1]], [0, 16_384, z[2]]]);
        places.extend([[5, 0], [5 + way, 0], [5, 77]]);
        faces.push([first, first + 1, first + 2]);
    };
    for way in [4096 * 256, 4097 * 256, 100, -4097 * 256, -4096 * 256] {
        triangle([-16_384; 3], way);
        // From behind, which is culled.
        triangle([16_384; 3], way);
    }
    // Through the near plane: what is left of it is still too wide, in one piece and in two.
    triangle([-16_384, -16_384, 16_384], 9000 * 256);
    triangle([16_384, -16_384, -16_384], 9000 * 256);
    // And not any more.
    triangle([-16_384, 32_000, 32_000], 4500 * 256);
    let mut rooms = SceneRooms::<Wide<'_>>::new(99, 99, 16);
    rooms.textures = Textures(&textures);
    let mesh = Mesh {
        positions: &positions,
        normals: &[],
        colours: &[],
        faces: Faces::Triangles(&faces),
    };
    let mut scene = rooms.scene(Screen::new(16, 16).unwrap());
    scene.begin(&camera()).unwrap();
    let skin = Skin {
        places: &places,
        texture: 0,
        quality: Quality::Exact,
    };
    let done = scene.draw_skinned(
        &mesh,
        skin.into(),
        &Instance {
            cull: Cull::None,
            ..Instance::default()
        },
    );
    assert_eq!(done.unwrap().untextured, 4);
    assert_eq!(scene.pass_one().untextured, 4);
    let stats = FrameStats {
        pass_one: scene.pass_one(),
        ..FrameStats::default()
    };
    assert!(stats.events().has(Event::Untextured));
    assert!(!FrameStats::default().events().has(Event::Untextured));
    // Without a texture nothing is lost, and nothing told.
    scene.begin(&camera()).unwrap();
    let none = Skin {
        texture: Skin::TEXTURES,
        ..skin
    };
    scene
        .draw_skinned(&mesh, none.into(), &Instance::default())
        .unwrap();
    assert_eq!(scene.pass_one().untextured, 0);
}

/// How far places are off in a picture of random triangles, in texels, beyond what the budget
/// lets lines be: the corners' 1/w differ by up to a ratio, their places by so many texels.
fn farthest_off(seed: u64, (ratio, texels): (f64, f64), quality: Quality) -> (f64, u32) {
    type Look = Parts<Textured<Flat>, Depth32, PlaceFormat, (), Packed8, Textures<'static, Places>>;
    let mut rng = Rng::new(seed);
    let (width, height) = (320u16, 240u16);
    let mut rooms = SceneRooms::<Look>::new(3, 1, 240);
    rooms.textures = Textures(&[Places]);
    let (mut worst, mut pixels) = (0f64, 0);
    for _ in 0..40 {
        let low = rng.between(1.0, (2f64.powi(30) / ratio / 32_768.0).max(1.01)) * 32_768.0;
        let ends = [0.0, 1.0, rng.unit()].map(|part| (low * ratio.powf(part)) as u32);
        let wide = rng.pick(&[2560, 2560, 400]);
        let (left, top) = (
            rng.within(0, 2560 - wide),
            rng.within(0, 1920 - wide.min(1900)),
        );
        let vertices = ends.map(|depth| ScreenVertex {
            x: (left + rng.within(0, wide)) as i16,
            y: (top + rng.within(0, wide.min(1900))) as i16,
            depth,
            colour: [255; 3],
        });
        let reach = (texels * 256.0) as i32;
        let places = [(); 3].map(|()| [rng.within(0, reach), rng.within(0, reach)]);
        let mut scene = rooms.scene(Screen::new(width, height).unwrap());
        scene.begin(&camera()).unwrap();
        let skin = Skin {
            places: &places,
            texture: 0,
            quality,
        };
        scene
            .draw_screen(&vertices, &[[0, 1, 2]], skin, Cull::None)
            .unwrap();
        let at = vertices.map(|v| (f64::from(v.x) / 8.0, f64::from(v.y) / 8.0));
        let cross = |a: (f64, f64), b: (f64, f64), p: (f64, f64)| {
            (b.0 - a.0) * (p.1 - a.1) - (b.1 - a.1) * (p.0 - a.0)
        };
        for (y, row) in frame(&scene, 1).iter().enumerate() {
            for (x, shown) in row.iter().enumerate() {
                let p = (x as f64 + 0.5, y as f64 + 0.5);
                let weights = [0, 1, 2].map(|i| {
                    cross(at[(i + 1) % 3], at[(i + 2) % 3], p) * f64::from(vertices[i].depth)
                });
                let sum: f64 = weights.iter().sum();
                let want = [0, 1].map(|axis| {
                    let part = |i: usize| weights[i] * f64::from(places[i][axis]) / 256.0;
                    (part(0) + part(1) + part(2)) / sum
                });
                if let Some(off) = shown.off(want) {
                    pixels += 1;
                    worst = worst.max(off[0].abs()).max(off[1].abs());
                }
            }
        }
    }
    (worst, pixels)
}

/// What [`Quality`] says of how far its budgets reach: to corners of 1:300, a texel more at
/// 1:12,000, and eight at the farthest that a camera sees.
#[test]
fn places_keep_their_budget() {
    let budgets = [
        (Quality::Exact, 1.0 / 16.0),
        (Quality::Balanced, 0.25),
        (Quality::Fast, 0.5),
    ];
    for (quality, budget) in budgets {
        for (ratio, more) in [(10.0, 0.0), (300.0, 0.0), (12_000.0, 1.0), (65_000.0, 8.0)] {
            for texels in [64.0, 3000.0] {
                let (worst, pixels) = farthest_off(7, (ratio, texels), quality);
                assert!(
                    worst <= budget + more,
                    "1:{ratio}, {texels} texels: {worst}"
                );
                assert!(pixels > 40_000, "{pixels}");
            }
        }
    }
}
