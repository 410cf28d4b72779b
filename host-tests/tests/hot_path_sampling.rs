//! Textures that are sampled by more than the nearest texel of one size, against f64 pixel by pixel: which level of
//! detail a pixel has, and the weighted mean of four texels (H6).
//!
//! The reference knows corners and nothing of planes, spans or slots.

use crate::common::Rng;
use crate::hot::exact::{doubled_area, within};
use crate::hot::{Corner, SceneRooms, Smooth, WordOf, camera, draw_with, frame};
use scanbeam::look::{Textured, halved};
use scanbeam::pixel::{PixelFormat, Rgb565, Rgb565Be, Rgb565Le};
use scanbeam::scene::{Budget, Sampling, Skin, Texture, TextureError, Wrap};
use scanbeam::{Cull, Screen};

const BACKGROUND: u16 = 0x1234;
const WRAPS: [Wrap; 3] = [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror];
const BUDGETS: [Budget; 3] = [Budget::FAST, Budget::BALANCED, Budget::EXACT];

/// A triangle and its texture places, with 8 fraction bits.
#[derive(Clone, Debug)]
struct Skinned {
    corners: [Corner; 3],
    places: [[i32; 2]; 3],
}

impl Skinned {
    /// A triangle that is neither thin nor from behind, with places of so many texels.
    fn some(rng: &mut Rng, screen: Screen, texels: i32) -> Self {
        let size = rng.pick(&[100, 300, 1_500]);
        let slant = rng.pick(&[1.0, 1.5, 8.0, 8.0]);
        let w = 1.0 + 3.0 * rng.unit();
        loop {
            let middle = [screen.width(), screen.height()].map(|c| rng.within(0, 8 * i32::from(c)));
            let corners = [(); 3].map(|()| Corner {
                at: (
                    middle[0] + rng.within(-size, size),
                    middle[1] + rng.within(-size, size),
                ),
                w: w * rng.between(1.0, slant),
                colour: [255; 3],
            });
            let places =
                [(); 3].map(|()| [(); 2].map(|()| rng.within(-128 * texels, 128 * texels)));
            let skinned = Self { corners, places };
            let least = i64::from(size) * i64::from(size) / 4;
            if doubled_area(corners.map(|c| c.at)) > least && skinned.stretch() > 0.05 {
                return skinned;
            }
        }
    }

    /// Doubled area on the texture, by that of the rectangle about it.
    fn stretch(&self) -> f64 {
        let [a, b, c] = self.places.map(|p| p.map(f64::from));
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        let side = |k: usize| {
            let all = [a[k], b[k], c[k]];
            all.iter().fold(0.0f64, |m, p| m.max(*p)) - all.iter().fold(0.0f64, |m, p| m.min(*p))
        };
        area.abs() / (side(0) * side(1)).max(1.0)
    }

    /// The place in texels, and 1/w, at a point of the picture.
    fn at(&self, x: f64, y: f64) -> ([f64; 2], f64) {
        let p = self
            .corners
            .map(|c| [f64::from(c.at.0) / 8.0, f64::from(c.at.1) / 8.0]);
        let area = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| {
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        };
        let (whole, at) = (area(p[0], p[1], p[2]), [x, y]);
        let parts = [
            area(at, p[1], p[2]),
            area(p[0], at, p[2]),
            area(p[0], p[1], at),
        ];
        let near = [0, 1, 2].map(|k| parts[k] / whole / self.corners[k].w);
        let q: f64 = near.iter().sum();
        let of = |axis: usize| {
            let texel = |k: usize| f64::from(self.places[k][axis]) / 256.0;
            (0..3).map(|k| near[k] * texel(k)).sum::<f64>() / q
        };
        ([of(0), of(1)], q)
    }

    /// Texels to the next column and to the next line.
    fn steps(&self, x: f64, y: f64) -> [[f64; 2]; 2] {
        let of = |dx: f64, dy: f64| {
            let (a, b) = (self.at(x - dx, y - dy).0, self.at(x + dx, y + dy).0);
            [0, 1].map(|k| (b[k] - a[k]) * 32.0)
        };
        [of(1.0 / 64.0, 0.0), of(0.0, 1.0 / 64.0)]
    }

    /// The logarithm of the texels under a pixel.
    fn texels(&self, x: f64, y: f64) -> f64 {
        let [a, b] = self.steps(x, y);
        (a[0] * b[1] - a[1] * b[0]).abs().log2()
    }

    /// Whether it may be drawn without 1/w.
    fn may_be_affine(&self, budget: f64) -> bool {
        let w = self.corners.map(|c| 1.0 / c.w);
        let (least, most) = (w[0].min(w[1]).min(w[2]), w[0].max(w[1]).max(w[2]));
        let side = |k: usize| {
            let all = self.places.map(|p| p[k]);
            let (low, high) = (all.iter().min(), all.iter().max());
            f64::from(high.unwrap() - low.unwrap()) / 256.0
        };
        side(0).max(side(1)) * (most - least) <= 4.4 * budget * least
    }
}

/// The picture of triangles, each a call, by so many slots.
fn picture<L: Smooth>(
    all: &[Skinned],
    texture: &'static Texture<'static>,
    budget: Budget,
    (screen, slots): (Screen, u16),
) -> Vec<Vec<WordOf<L>>>
where
    WordOf<L>: From<u16>,
{
    let mut rooms = SceneRooms::of_triangles(all.len(), screen);
    let mut scene = rooms.scene::<L>(screen);
    scene.begin(&camera()).expect("the rooms are large enough");
    for one in all {
        let places: &'static [_] = one.places.to_vec().leak();
        let dress = |draw: &mut scanbeam::Draw<'_, '_, i32>| {
            draw.cull = Cull::None;
            draw.texture = Some(Skin {
                texture,
                places,
                budget,
            });
        };
        draw_with(&mut scene, &[one.corners], dress).expect("there is room");
    }
    frame(&scene, slots, true, BACKGROUND.into())
}

/// A colour that says which level it is of.
fn of_level(level: usize) -> u16 {
    0x0821 * (level as u16 + 3)
}

/// Levels that are of one colour each, so that a pixel says which one it has.
fn told_apart(sides: [u32; 2], count: usize, sampling: Sampling) -> &'static Texture<'static> {
    let level = |level: usize| {
        let [width, height] = sides.map(|side| (side >> level).max(1));
        let words = vec![of_level(level); (width * height) as usize];
        Texture::words(words.leak(), width, height).expect("powers of two")
    };
    let coarser: Vec<_> = (1..=count).map(level).collect();
    let texture = level(0).sampled(sampling, coarser.leak());
    Box::leak(Box::new(texture.expect("halves")))
}

/// Kills: a level more or less at any threshold, limits of the wrong power of 1/w, a cut a pixel off, levels of the
/// triangle's corner in place of the pixel's, and a level that changes with the slots.
#[test]
fn a_pixel_has_the_level_whose_texels_are_as_large_as_it() {
    let mut rng = Rng::new(2_601);
    let screen = Screen::new(96, 64).expect("a screen");
    let mut seen = [0usize; 8];
    let (mut open, mut cut) = (0, 0);
    for round in 0..3_000 {
        let sides = [1 << rng.below(9), 1 << rng.below(9)];
        let most = 32 - u32::leading_zeros(sides[0] | sides[1]) as usize - 1;
        let count = rng.below(7).min(most as u32) as usize;
        let sampling = [Sampling::NEAREST, Sampling::LINEAR][round % 2];
        let texture = told_apart(sides, count, sampling);
        let number = rng.below(3) as usize;
        let (budget, texels) = (BUDGETS[number], rng.pick(&[60, 300, 1_500]));
        let all: Vec<_> = (0..1 + rng.below(3))
            .map(|_| Skinned::some(&mut rng, screen, texels))
            .collect();
        let first = picture::<Textured<Rgb565>>(&all, texture, budget, (screen, 128));
        let other = picture::<Textured<Rgb565>>(&all, texture, budget, (screen, 1));
        assert_eq!(first, other, "slots change nothing");
        if all.len() > 1 {
            continue;
        }
        let one = &all[0];
        let places = one.corners.map(|c| c.at);
        let corner =
            |k: usize| one.texels(f64::from(places[k].0) / 8.0, f64::from(places[k].1) / 8.0);
        let corners = [0, 1, 2].map(corner);
        for (y, words) in (0..).zip(&first) {
            let mut last = None;
            for x in within(places, y, screen.width()) {
                let level = words[x] / 0x0821 - 3;
                assert_eq!(words[x], of_level(level.into()), "one of the levels");
                let at = one.texels(x as f64 + 0.5, f64::from(y) + 0.5);
                let (mut low, mut high) = (at, at);
                if one.may_be_affine([0.5, 0.25, 0.01][number]) {
                    // One level for all of it.
                    low = corners.iter().fold(low, |m, c| m.min(*c));
                    high = corners.iter().fold(high, |m, c| m.max(*c));
                }
                // Levels change where texels are 2, 8, 32, ... to a pixel.
                let of = |texels: f64| ((texels + 1.0) / 2.0).floor().clamp(0.0, count as f64);
                let want = [of(low - 0.1), of(high + 0.1)];
                open += usize::from(want[0] != want[1]);
                assert!(
                    (want[0]..=want[1]).contains(&f64::from(level)),
                    "{level} for {want:?} at {x}, {y} of {sides:?}, {count} levels, {budget:?}: {one:?}"
                );
                seen[usize::from(level)] += 1;
                cut += usize::from(last.is_some_and(|last| last != level));
                last = Some(level);
            }
        }
    }
    println!("{seen:?}, {open} open, {cut} cuts");
    assert!(seen[..5].iter().all(|&pixels| pixels > 5_000) && cut > 2_000);
    assert!(open < seen.iter().sum::<usize>() / 8);
}

/// Texels of a form as words in the order of numbers, and the texture of them for the panel.
fn noise<F: PixelFormat<Word = u16>>(
    rng: &mut Rng,
    sides: [u32; 2],
    wrap: Wrap,
) -> (Vec<u16>, Texture<'static>) {
    let swap = |word: u16| {
        if F::from_rgb8([255, 0, 0]) == 0xF800 {
            word
        } else {
            word.swap_bytes()
        }
    };
    let count = (sides[0] * sides[1]) as usize;
    let made = if rng.below(2) == 0 {
        let numbers: Vec<u16> = (0..count).map(|_| rng.below(1 << 16) as u16).collect();
        let words: Vec<u16> = numbers.iter().map(|&word| swap(word)).collect();
        let texture = Texture::words(words.leak(), sides[0], sides[1]);
        (numbers, texture)
    } else {
        let palette: Vec<u16> = (0..256).map(|_| rng.below(1 << 16) as u16).collect();
        let bytes: Vec<u8> = (0..count).map(|_| rng.below(256) as u8).collect();
        let numbers = bytes.iter().map(|&i| palette[usize::from(i)]).collect();
        let words: Vec<u16> = palette.iter().map(|&word| swap(word)).collect();
        let texture = Texture::index8(bytes.leak(), words.leak(), sides[0], sides[1]);
        (numbers, texture)
    };
    (made.0, made.1.expect("powers of two").wrapping(wrap))
}

fn rgb(word: u16) -> [f64; 3] {
    let [r, g, b] = [word >> 11, word >> 5 & 63, word & 31].map(f64::from);
    [r / 31.0, g / 63.0, b / 31.0]
}

/// What a mean of texels may be in a square of places: the least and the most of each channel, each from 0 to 1.
fn means(
    numbers: &[u16],
    sides: [u32; 2],
    wrap: Wrap,
    at: [f64; 2],
    reach: [f64; 2],
) -> [[f64; 2]; 3] {
    let folded = |texel: i32, side: u32| {
        let side = side as i32;
        match wrap {
            Wrap::Repeat => texel.rem_euclid(side),
            Wrap::Clamp => texel.clamp(0, side - 1),
            Wrap::Mirror => {
                let there = texel.rem_euclid(2 * side);
                there.min(2 * side - 1 - there)
            }
        }
    };
    let texel = |u: i32, v: i32| {
        let (u, v) = (folded(u, sides[0]), folded(v, sides[1]));
        rgb(numbers[(v as u32 * sides[0] + u as u32) as usize])
    };
    // A mean of four is linear on each axis between the middles of texels, so its least and most are at their corners.
    let stops = |k: usize| {
        let (low, high) = (at[k] - reach[k] - 0.5, at[k] + reach[k] - 0.5);
        let whole = (low.ceil() as i32..=high.floor() as i32).map(f64::from);
        whole.chain([low, high]).collect::<Vec<_>>()
    };
    let mut range = [[f64::MAX, f64::MIN]; 3];
    for v in stops(1) {
        for u in stops(0) {
            let (x, y) = (u.floor() as i32, v.floor() as i32);
            let (right, down) = (u - u.floor(), v - v.floor());
            let [a, b, c, d] = [
                texel(x, y),
                texel(x + 1, y),
                texel(x, y + 1),
                texel(x + 1, y + 1),
            ];
            for i in 0..3 {
                let upper = a[i] + (b[i] - a[i]) * right;
                let lower = c[i] + (d[i] - c[i]) * right;
                let mean = upper + (lower - upper) * down;
                // Weights are whole parts of 32.
                let off = (a[i] - b[i] - c[i] + d[i]).abs() / 64.0;
                range[i] = [range[i][0].min(mean - off), range[i][1].max(mean + off)];
            }
        }
    }
    range
}

fn hold_means<L: Smooth>(rng: &mut Rng) -> [usize; 2]
where
    L::Format: PixelFormat<Word = u16>,
{
    let screen = Screen::new(64, 40).expect("a screen");
    let (mut held, mut open) = (0, 0);
    for _ in 0..250 {
        let sides = [1 << rng.below(9), 1 << rng.below(9)];
        let wrap = rng.pick(&WRAPS);
        let (numbers, texture) = noise::<L::Format>(rng, sides, wrap);
        let texture = texture.sampled(Sampling::LINEAR, &[]).expect("no levels");
        let number = rng.below(3) as usize;
        let texels = rng.pick(&[4, 20, 100]);
        let one = Skinned::some(rng, screen, texels);
        let texture = Box::leak(Box::new(texture));
        let lines = picture::<L>(
            std::slice::from_ref(&one),
            texture,
            BUDGETS[number],
            (screen, 8),
        );
        let budget = [0.5, 0.25, 0.01][number];
        for (y, words) in (0..).zip(&lines) {
            for x in within(one.corners.map(|c| c.at), y, screen.width()) {
                let (cx, cy) = (x as f64 + 0.5, f64::from(y) + 0.5);
                let steps = one.steps(cx, cy);
                // The budget, 1/16 texel of fixed point and of weights each, and 1/16 pixel of corners that are rounded.
                let reach =
                    [0, 1].map(|k| budget + 0.125 + (steps[0][k].abs() + steps[1][k].abs()) / 16.0);
                if reach[0].max(reach[1]) > 2.0 {
                    open += 1;
                    continue;
                }
                let want = means(&numbers, sides, wrap, one.at(cx, cy).0, reach);
                let got = L::Format::to_rgb8(words[x]).map(|level| f64::from(level) / 255.0);
                for i in 0..3 {
                    let half = [0.52 / 31.0, 0.52 / 63.0, 0.52 / 31.0][i];
                    assert!(
                        (want[i][0] - half..=want[i][1] + half).contains(&got[i]),
                        "{got:?} for {want:?} at {x}, {y} of {sides:?}, {wrap:?}: {one:?}"
                    );
                }
                held += 1;
            }
        }
    }
    [held, open]
}

/// Kills: texels half a texel off, weights turned about or on the wrong side, a neighbour beyond the wrap, fields that
/// run into each other, bytes in the wrong order.
#[test]
fn a_filtered_pixel_is_the_mean_of_four_texels() {
    let mut rng = Rng::new(2_602);
    let all = [
        hold_means::<Textured<Rgb565>>(&mut rng),
        hold_means::<Textured<Rgb565Be>>(&mut rng),
        hold_means::<Textured<Rgb565Le>>(&mut rng),
    ];
    println!("held and open: {all:?}");
    for [held, open] in all {
        assert!(held > 80_000 && open < held / 3);
    }
}

/// Where the mean of a tile is not the texel, a magnified texture is smooth: between two texels each step of the way
/// has its own colour. Kills: a filter that is not one.
#[test]
fn texels_become_a_ramp() {
    let words = [0x0000u16, 0xFFFF, 0x0000, 0xFFFF].to_vec().leak();
    let texture = Texture::words(words, 2, 2).expect("2 x 2");
    let texture = texture.wrapping(Wrap::Clamp).sampled(Sampling::LINEAR, &[]);
    let texture = Box::leak(Box::new(texture.expect("no levels")));
    let corner = |x: i32, y: i32| Corner {
        at: (8 * x, 8 * y),
        w: 1.0,
        colour: [255; 3],
    };
    // 32 pixels a texel.
    let one = Skinned {
        corners: [corner(0, 0), corner(64, 0), corner(0, 64)],
        places: [[0, 0], [512, 0], [0, 512]],
    };
    let screen = Screen::new(64, 64).expect("a screen");
    let lines = picture::<Textured<Rgb565>>(&[one], texture, Budget::EXACT, (screen, 8));
    let blue: Vec<u16> = lines[0][..63].iter().map(|word| word & 31).collect();
    assert_eq!(blue[..16], [0; 16]);
    assert_eq!(blue[48..], [31; 15]);
    assert!(blue.is_sorted());
    let mut steps = blue;
    steps.dedup();
    assert!(steps.len() >= 16, "{steps:?}");
}

/// Kills: means that are cut, sides of one texel that shrink, keys that spread or vanish, too few words that are taken.
#[test]
fn a_level_is_the_means_of_the_one_before() {
    let mut rng = Rng::new(2_603);
    for _ in 0..200 {
        let sides = [1u32 << rng.below(5), 1 << rng.below(5)];
        let (numbers, texture) = noise::<Rgb565Be>(&mut rng, sides, Wrap::Mirror);
        let half = sides.map(|side| (side / 2).max(1));
        let needed = (half[0] * half[1]) as usize;
        let mut words = vec![0xAAAA; needed + 3];
        if sides == [1, 1] {
            let refused = halved::<Rgb565Be>(&texture, &mut words).err();
            let (width, height) = (1, 1);
            assert_eq!(
                refused,
                Some(TextureError::Level {
                    level: 1,
                    width,
                    height
                })
            );
            continue;
        }
        let have = needed - 1;
        let refused = halved::<Rgb565Be>(&texture, &mut words[..have]).err();
        assert_eq!(refused, Some(TextureError::Words { needed, have }));
        let level = halved::<Rgb565Be>(&texture, &mut words).expect("enough words");
        assert_eq!([level.width(), level.height()], half);
        assert_eq!((level.wrap(), level.key()), (Wrap::Mirror, None));
        assert_eq!(words[needed..], [0xAAAA; 3]);
        for (i, &word) in words[..needed].iter().enumerate() {
            let (column, row) = (i as u32 % half[0], i as u32 / half[0]);
            let at = |dx: u32, dy: u32| {
                let u = if sides[0] > 1 { 2 * column + dx } else { 0 };
                let v = if sides[1] > 1 { 2 * row + dy } else { 0 };
                numbers[(v * sides[0] + u) as usize]
            };
            let four = [at(0, 0), at(1, 0), at(0, 1), at(1, 1)];
            let word = if cfg!(target_endian = "big") {
                word
            } else {
                word.swap_bytes()
            };
            let fields = |w: u16| [w >> 11, w >> 5 & 63, w & 31];
            let mean = [0, 1, 2].map(|k| (four.map(|w| fields(w)[k]).iter().sum::<u16>() + 2) / 4);
            assert_eq!(fields(word), mean);
        }
    }
    // A key stays where two of four are transparent, is no part of a mean, and is not what a mean becomes.
    let key = 0x0001u16;
    for (four, want) in [
        ([key, key, 9, 9], key),
        ([key, 0xFFFF, 0xFFFF, 0xFFFF], 0xFFFF),
        ([0x0002, 0x0002, 0x0000, 0x0000], 0x0002),
    ] {
        let texture = Texture::words(&four, 2, 2).expect("2 x 2").keyed(key);
        let mut words = [0];
        let level = halved::<Rgb565>(&texture, &mut words).expect("enough words");
        assert_eq!(level.key(), Some(key));
        assert_eq!(words, [want]);
    }
}

/// Kills: levels of any sides.
#[test]
fn levels_of_other_sides_are_refused() {
    let of = |width: u32, height: u32| {
        let words = vec![0u16; (width * height) as usize];
        Texture::words(words.leak(), width, height).expect("powers of two")
    };
    let with = |levels: &[[u32; 2]]| {
        let levels: Vec<_> = levels
            .iter()
            .map(|&[width, height]| of(width, height))
            .collect();
        of(8, 2).sampled(Sampling::NEAREST, levels.leak()).map(drop)
    };
    assert_eq!(with(&[]), Ok(()));
    assert_eq!(with(&[[4, 1], [2, 1], [1, 1]]), Ok(()));
    let refused = |level, width, height| {
        Err(TextureError::Level {
            level,
            width,
            height,
        })
    };
    assert_eq!(with(&[[4, 2]]), refused(1, 4, 2));
    assert_eq!(with(&[[4, 1], [4, 1]]), refused(2, 4, 1));
    assert_eq!(with(&[[4, 1], [2, 1], [1, 1], [1, 1]]), refused(4, 1, 1));
    let text = with(&[[4, 2]]).expect_err("another height").to_string();
    assert!(text.contains("level 1 has 4x2"), "{text}");
}
