//! Masks of textures with levels of detail and filters (H6, H7).

use super::masks::{over_565, some_skin};
use super::{BLACK, each_place, leak, picture, triangle};
use crate::common::Rng;
use crate::hot::exact::weights;
use scanbeam::look::Textured;
use scanbeam::pixel::{PixelFormat, Rgb565, Rgb888};
use scanbeam::scene::{Blend, BlendMode, Budget, MaskTexel, Sampling, Skin, Texture, Wrap};

/// Alphas are filtered where colours are. Kills: a mask of which the nearest texel is taken, one that is mixed as colours
/// are, one that repeats where its texture does not.
#[test]
fn masks_are_filtered_as_colours_are() {
    let mut rng = Rng::new(70);
    let (mut pixels, mut nearest) = (0, 0);
    for _ in 0..120 {
        let mut corners = triangle(&mut rng, [255; 3]);
        for corner in &mut corners {
            corner.w = 1.5;
        }
        let masks: Vec<u16> = (0..256).map(|_| rng.below(256) as u16).collect();
        let wrap = rng.pick(&[Wrap::Repeat, Wrap::Clamp, Wrap::Mirror]);
        let white = Texture::words(&[0xFFFF; 256], 16, 16).expect("sides");
        let white = white.wrapping(wrap).sampled(Sampling::LINEAR, &[]);
        let mask = Texture::words(leak(masks.clone()), 16, 16).expect("sides");
        let masked = white.expect("no levels").masked(Box::leak(Box::new(mask)));
        let masked: &'static _ = Box::leak(Box::new(masked.expect("the same sides")));
        let places = [(); 3].map(|()| [(); 2].map(|()| rng.within(-3_000, 3_000)));
        let skin = Skin {
            texture: masked,
            places: leak(places.to_vec()),
            budget: Budget::EXACT,
        };
        let lines = picture::<Textured<Rgb888>>(corners, BLACK, |draw| {
            (draw.texture, draw.blend) = (Some(skin), Some(Blend::ALPHA));
        });
        let folded = |at: i32| match wrap {
            Wrap::Repeat => at.rem_euclid(16),
            Wrap::Clamp => at.clamp(0, 15),
            Wrap::Mirror => at.rem_euclid(32).min(31 - at.rem_euclid(32)),
        };
        let alpha = |u: i32, v: i32| f64::from(masks[(folded(v) * 16 + folded(u)) as usize]);
        each_place(&corners, |x, y| {
            let (part, step) = weights(corners.map(|c| c.at), x as i32, y as i32);
            let of = |axis: usize, part: [f64; 3]| {
                (0..3)
                    .map(|k| part[k] * f64::from(places[k][axis]) / 256.0)
                    .sum::<f64>()
            };
            if (0..2).any(|axis| of(axis, step).abs() > 4.0) {
                return;
            }
            let at = [0, 1].map(|axis| of(axis, part) - 0.5);
            let [u, v] = at.map(|c| c.floor() as i32);
            let [right, down] = at.map(|c| c - c.floor());
            let four = [
                alpha(u, v),
                alpha(u + 1, v),
                alpha(u, v + 1),
                alpha(u + 1, v + 1),
            ];
            let upper = four[0] + (four[1] - four[0]) * right;
            let lower = four[2] + (four[3] - four[2]) * right;
            let want = upper + (lower - upper) * down;
            let most = four.iter().fold(0.0f64, |m, a| m.max(*a));
            let least = four.iter().fold(255.0f64, |m, a| m.min(*a));
            // Weights of 16 on both axes, and places within 1/50 texel.
            let off = (most - least) * (2.0 / 16.0 + 0.04) + 2.0;
            let got = f64::from(lines[y][x][0]);
            assert!(
                (got - want).abs() <= off,
                "{got} for {want} of {four:?} at {x}, {y}"
            );
            let one = four[usize::from(right > 0.5) + 2 * usize::from(down > 0.5)];
            nearest += usize::from((got - one).abs() > off);
            pixels += 1;
        });
    }
    assert!(pixels > 5_000 && nearest > 1_000, "{pixels}, {nearest}");
}

/// Each level of detail has a mask of its own. Kills: the mask of the largest on all levels.
#[test]
fn levels_of_detail_have_masks_of_their_own() {
    let mut rng = Rng::new(80);
    let level = |side: u32, word: u16| {
        let words = leak(vec![word; (side * side) as usize]);
        Texture::words(words, side, side).expect("sides")
    };
    let alphas = [40u8, 230, 90, 160];
    let colours: [u16; 4] = [0xFFFF, 0x07E0, 0xF81F, 0x0018];
    let sides = [64, 32, 16, 8];
    let all = |of: &dyn Fn(usize) -> u16, sampling| -> Texture<'static> {
        let coarser = (1..4).map(|l| level(sides[l], of(l))).collect();
        level(64, of(0))
            .sampled(sampling, leak(coarser))
            .expect("levels")
    };
    let mut pixels = [0; 4];
    for i in 0..150 {
        let corners = triangle(&mut rng, [255; 3]);
        let sampling = [Sampling::NEAREST, Sampling::LINEAR][i % 2];
        let plain: &'static _ = Box::leak(Box::new(all(&|l| colours[l], sampling)));
        let masks = all(&|l| MaskTexel::alpha(alphas[l]).word(), Sampling::NEAREST);
        let masked = plain.masked(Box::leak(Box::new(masks))).expect("as many");
        let masked: &'static _ = Box::leak(Box::new(masked));
        let (places, budget) = some_skin(&mut rng);
        let [named, got] = [(plain, None), (masked, Some(Blend::ALPHA))].map(
            |(texture, blend): (&'static Texture<'static>, _)| {
                picture::<Textured<Rgb565>>(corners, [90, 120, 200], |draw| {
                    let skin = Skin {
                        texture,
                        places,
                        budget,
                    };
                    (draw.texture, draw.blend) = (Some(skin), blend);
                })
            },
        );
        let old = Rgb565::from_rgb8([90, 120, 200]);
        each_place(&corners, |x, y| {
            let Some(l) = colours.iter().position(|word| *word == named[y][x]) else {
                return;
            };
            let want = over_565(BlendMode::Filter(255), old, colours[l], alphas[l]);
            assert_eq!(got[y][x], want, "level {l} at {x}, {y}");
            pixels[l] += 1;
        });
    }
    assert!(pixels.iter().all(|pixels| *pixels > 500), "{pixels:?}");
}
