//! Masks lie on the texels that they speak of, and texels that are not to be dithered are not (H7, H10, K11).
//!
//! Where a mask lies is told by a picture of the same call whose texels are all different: its pixels name them.

use super::{each_place, leak, picture, triangle};
use crate::common::Rng;
use crate::hot::Smooth;
use crate::hot::shine::even_light;
use scanbeam::light::PixelLamps;
use scanbeam::look::{Textured, TexturedPhong};
use scanbeam::pixel::{PixelFormat, Rgb565, Rgb565Be, Rgb565Le, Rgb888};
use scanbeam::scene::{Application, Blend, BlendMode, Budget, MaskTexel, Skin, Texture, Wrap};

/// What a field of so many steps becomes, in whole numbers, `alpha` being one of `whole`.
pub fn blended(mode: BlendMode, [old, new, most]: [u32; 3], alpha: u32, whole: u32) -> u32 {
    let part = (new * alpha + whole / 2) / whole;
    match mode {
        BlendMode::Add(_) => (old + part).min(most),
        BlendMode::Subtract(_) => old.saturating_sub(part),
        _ => (old * (whole - alpha) + new * alpha + whole / 2) / whole,
    }
}

/// A pixel of 5, 6 and 5 bits as a number over another.
pub fn over_565(mode: BlendMode, old: u16, new: u16, alpha: u8) -> u16 {
    let alpha = (u32::from(alpha) * 32 + 127) / 255;
    let fields = |word: u16| [word >> 11, word >> 5 & 63, word & 31].map(u32::from);
    let (o, n) = (fields(old), fields(new));
    let of = |i: usize, most| blended(mode, [o[i], n[i], most], alpha, 32) as u16;
    of(0, 31) << 11 | of(1, 63) << 5 | of(2, 31)
}

/// Texels that are all different, words of a mask for them, and the texture of both.
pub struct Sample {
    pub words: &'static [u16],
    pub masks: &'static [u16],
    pub plain: &'static Texture<'static>,
    pub masked: &'static Texture<'static>,
    /// To find a texel by its word.
    texel_of: Vec<u32>,
}

/// `order` makes words of numbers.
pub fn sample(rng: &mut Rng, order: fn(u16) -> u16) -> Sample {
    let (width, height) = rng.pick(&[
        (64, 64),
        (32, 32),
        (16, 64),
        (128, 128),
        (256, 64),
        (1, 8),
        (256, 256),
    ]);
    let count = width * height;
    // An odd factor leaves numbers different.
    let words = (0..count).map(|n| order((n as u16).wrapping_mul(40_503).wrapping_add(77)));
    let words = leak(words.collect());
    let mask = |_| {
        let alpha = rng.pick(&[0, 255, rng.clone().below(256) as u8]);
        let mut texel = MaskTexel::alpha(alpha);
        if rng.below(3) == 0 {
            texel = texel.added();
        }
        if rng.below(2) == 0 {
            texel = texel.undithered();
        }
        texel.word()
    };
    let masks = leak((0..count).map(mask).collect());
    let wrap = rng.pick(&[Wrap::Repeat, Wrap::Clamp, Wrap::Mirror]);
    let plain = Texture::words(words, width, height)
        .expect("sides")
        .wrapping(wrap);
    let plain: &'static _ = Box::leak(Box::new(plain));
    let mask = Box::leak(Box::new(
        Texture::words(masks, width, height).expect("sides"),
    ));
    let masked = Box::leak(Box::new(plain.masked(mask).expect("the same sides")));
    let mut texel_of = vec![u32::MAX; 1 << 16];
    for (n, word) in (0..).zip(words) {
        texel_of[usize::from(*word)] = n;
    }
    Sample {
        words,
        masks,
        plain,
        masked,
        texel_of,
    }
}

const BUDGETS: [Budget; 3] = [Budget::FAST, Budget::BALANCED, Budget::EXACT];

/// Places of corners on a texture, and how exact.
pub fn some_skin(rng: &mut Rng) -> (&'static [[i32; 2]], Budget) {
    let reach = rng.pick(&[2_000, 20_000, 60_000]);
    let places = (0..3).map(|_| [(); 2].map(|()| rng.within(-reach, reach)));
    (leak(places.collect()), rng.pick(&BUDGETS))
}

/// Holds pixels of 16 bits against whole numbers.
fn masks_lie_on_texels<L: Smooth<Format: PixelFormat<Word = u16>>>(
    seed: u64,
    light: Option<&'static PixelLamps>,
    order: fn(u16) -> u16,
) {
    let mut rng = Rng::new(seed);
    let (mut pixels, mut added) = (0, 0);
    for i in 0..240 {
        let corners = triangle(&mut rng, [255; 3]);
        let sample = sample(&mut rng, order);
        let (places, budget) = some_skin(&mut rng);
        let own = rng.pick(&[255, 255, 130]);
        let mode = [BlendMode::Filter, BlendMode::Add, BlendMode::Subtract][i % 3](own);
        let background = [90, 120, 200];
        let [named, got] = [
            (sample.plain, None),
            (sample.masked, Some(Blend::new(mode))),
        ]
        .map(|(texture, blend)| {
            picture::<L>(corners, background, |draw| {
                draw.texture = Some(Skin {
                    texture,
                    places,
                    budget,
                });
                // White, which looks that are lit at pixels have from the call.
                (draw.mesh.colours, draw.blend, draw.lamps) = (&[], blend, light);
            })
        });
        let old = order(L::Format::from_rgb8(background));
        each_place(&corners, |x, y| {
            let Some(&mask) = sample
                .masks
                .get(sample.texel_of[usize::from(named[y][x])] as usize)
            else {
                // Too far stretched, and drawn white.
                return;
            };
            let alpha = ((u32::from(mask as u8) * u32::from(own) + 127) / 255) as u8;
            let is_added = mask >> 9 & 1 != 0;
            let mode = if is_added { BlendMode::Add(own) } else { mode };
            let want = order(over_565(mode, old, order(named[y][x]), alpha));
            assert_eq!(
                got[y][x], want,
                "{x}, {y}: {mode:?}, {mask:#x}, {corners:?}"
            );
            pixels += 1;
            added += usize::from(is_added);
        });
        assert!(!sample.words.is_empty());
    }
    assert!(pixels > 20_000 && added > 3_000, "{pixels}, {added}");
}

/// Kills: a mask that is read in another way than its texture (not clamped, or by another walker), bits A and D mixed up,
/// an alpha of the mode that is dropped, a texel that is added and asks the mode.
#[test]
fn a_mask_lies_where_its_texture_lies() {
    masks_lie_on_texels::<Textured<Rgb565>>(31, None, |word| word);
    masks_lie_on_texels::<Textured<Rgb565Be>>(32, None, u16::to_be);
    masks_lie_on_texels::<Textured<Rgb565Le>>(33, None, u16::to_le);
    masks_lie_on_texels::<TexturedPhong<Rgb565Be>>(34, even_light(), u16::to_be);
}

/// Levels of 24 and 32 bits, whose texels are the same words. Kills: a mask that wide pixels do not ask.
#[test]
fn masks_of_wide_pixels_lie_on_texels() {
    let mut rng = Rng::new(35);
    let mut pixels = 0;
    for _ in 0..120 {
        let corners = triangle(&mut rng, [255; 3]);
        let sample = sample(&mut rng, |word| word);
        let (places, budget) = some_skin(&mut rng);
        let background = [90, 120, 200];
        let lines = |texture, blend| {
            picture::<Textured<Rgb888>>(corners, background, |draw| {
                draw.texture = Some(Skin {
                    texture,
                    places,
                    budget,
                });
                draw.blend = blend;
            })
        };
        let (named, got) = (
            lines(sample.plain, None),
            lines(sample.masked, Some(Blend::ALPHA)),
        );
        each_place(&corners, |x, y| {
            let word = Rgb565::from_rgb8(named[y][x]);
            let texel = sample.texel_of[usize::from(word)];
            let Some(&mask) = sample.masks.get(texel as usize) else {
                return;
            };
            let alpha = u32::from(mask as u8);
            let alpha = alpha + (alpha >> 7);
            let mode = match mask >> 9 & 1 {
                1 => BlendMode::Add(255),
                _ => BlendMode::Filter(255),
            };
            let of = |i: usize| {
                let (old, new) = (u32::from(background[i]), u32::from(named[y][x][i]));
                blended(mode, [old, new, 255], alpha, 256) as u8
            };
            assert_eq!(got[y][x], [of(0), of(1), of(2)], "{x}, {y}: {mask:#x}");
            pixels += 1;
        });
    }
    assert!(pixels > 10_000, "{pixels}");
}

/// Of a call that is dithered, a texel with the D bit has the pixel of the same call without a dither, any other that of
/// the same call without a mask; with holes, decals and light at pixels too.
fn d_bits_bypass_the_dither<L: Smooth<Format: PixelFormat<Word = u16>>>(
    seed: u64,
    light: Option<&'static PixelLamps>,
    order: fn(u16) -> u16,
) {
    let mut rng = Rng::new(seed);
    let (mut pixels, mut differ) = (0, 0);
    for i in 0..160 {
        let mut corners = triangle(&mut rng, [255; 3]);
        let sample = sample(&mut rng, order);
        let (places, budget) = some_skin(&mut rng);
        let skin = |texture| Skin {
            texture,
            places,
            budget,
        };
        let background = [90, 120, 200];
        let named = picture::<L>(corners, background, |draw| {
            (draw.mesh.colours, draw.texture) = (&[], Some(skin(sample.plain)));
        });
        let colour = [(); 3].map(|()| 20 + rng.below(200) as u8);
        for corner in &mut corners {
            corner.colour = colour.map(|c| c - rng.below(20) as u8);
        }
        // Of another texture, whose texels are not all different: a quarter of them are transparent.
        let key = order(1);
        let words = (0..sample.words.len()).map(|_| match rng.below(4) {
            0 => key,
            _ => order(rng.below(1 << 16) as u16),
        });
        let words = leak(words.collect());
        let (width, height) = (sample.plain.width(), sample.plain.height());
        let mut plain = Texture::words(words, width, height).expect("sides");
        plain = plain.wrapping(sample.plain.wrap());
        if i % 2 == 0 {
            plain = plain.keyed(key);
        }
        let mask = Texture::words(sample.masks, width, height).expect("sides");
        let masked = plain
            .masked(Box::leak(Box::new(mask)))
            .expect("the same sides");
        let (plain, masked): (&'static _, &'static _) =
            (Box::leak(Box::new(plain)), Box::leak(Box::new(masked)));
        let application = rng.pick(&[Application::Product, Application::Decal]);
        let [dithered, even, got] = [(plain, true), (plain, false), (masked, true)].map(
            |(texture, dither): (&'static Texture<'static>, bool)| {
                picture::<L>(corners, background, |draw| {
                    draw.texture = Some(skin(texture));
                    (draw.dither, draw.application) = (dither, application);
                    if light.is_some() {
                        (draw.mesh.colours, draw.colour, draw.lamps) = (&[], colour, light);
                    }
                })
            },
        );
        each_place(&corners, |x, y| {
            let texel = sample.texel_of[usize::from(named[y][x])] as usize;
            let Some(mask) = sample.masks.get(texel) else {
                return;
            };
            let want = match mask >> 8 & 1 {
                1 => even[y][x],
                _ => dithered[y][x],
            };
            assert_eq!(got[y][x], want, "{x}, {y}: {mask:#x}, {application:?}");
            pixels += 1;
            differ += usize::from(even[y][x] != dithered[y][x]);
        });
    }
    assert!(pixels > 10_000 && differ > 2_000, "{pixels}, {differ}");
}

/// Kills: a D bit that is not asked, one that is taken for all, a mask that is read by another walker.
#[test]
fn texels_with_the_d_bit_are_not_dithered() {
    d_bits_bypass_the_dither::<Textured<Rgb565>>(41, None, |word| word);
    d_bits_bypass_the_dither::<Textured<Rgb565Be>>(42, None, u16::to_be);
    d_bits_bypass_the_dither::<TexturedPhong<Rgb565Be>>(43, even_light(), u16::to_be);
}
