//! Modes and factors by alphas, and alphas that nobody asks for (K11, H8).

use super::masks::{sample, some_skin};
use super::{WIDTH, each_place, leak, picture, triangle};
use crate::common::Rng;
use scanbeam::look::Textured;
use scanbeam::pixel::{PixelFormat, Rgb565Be, Rgb888};
use scanbeam::scene::{Blend, BlendMode, Budget, Draw, Factor, MaskTexel, Skin, Texture};

/// Each factor, and each mode, with alphas of vertices, of texels and of its own, over any colour, against f64.
///
/// Kills: an alpha of vertices in the place of one of texels, inverses that are not, a mode without its own alpha, `Half`
/// by alpha, a texel that is added and asks the mode.
#[test]
fn modes_and_factors_ask_for_their_alphas() {
    let mut rng = Rng::new(50);
    let mut pixels = 0;
    for i in 0..600 {
        let colour = [(); 3].map(|()| rng.below(256) as u8);
        let corners = triangle(&mut rng, colour);
        let surface = rng.below(256) as u8;
        let texel = MaskTexel::alpha(rng.below(256) as u8);
        let texel = if i % 5 == 0 { texel.added() } else { texel };
        let background = [(); 3].map(|()| rng.below(256) as u8);
        let mut factor = || {
            let number = rng.below(256) as u8;
            let all = [
                Factor::Constant(number),
                Factor::Destination,
                Factor::InverseDestination,
                Factor::SourceAlpha,
                Factor::InverseSourceAlpha,
                Factor::TextureAlpha,
                Factor::InverseTextureAlpha,
            ];
            rng.pick(&all)
        };
        let [source, destination] = [factor(), factor()];
        let own = rng.below(256) as u8;
        let mode = [
            BlendMode::Filter(own),
            BlendMode::Add(own),
            BlendMode::Subtract(own),
            BlendMode::Half,
            BlendMode::Factors {
                source,
                destination,
            },
        ];
        let mode = rng.pick(&mode);
        let written = [(); 3].map(|()| rng.below(4) > 0);
        let (has_surface, has_texel) = (rng.below(3) > 0, rng.below(3) > 0);
        let white = Texture::words(&[0xFFFF], 1, 1).expect("a texel");
        let mask = leak(vec![texel.word()]);
        let mask = Box::leak(Box::new(Texture::words(mask, 1, 1).expect("a texel")));
        let masked = Box::leak(Box::new(white.masked(mask).expect("the same sides")));
        let lines = picture::<Textured<Rgb888>>(corners, background, |draw| {
            draw.blend = Some(Blend::new(mode).writing(written));
            if has_surface {
                draw.alphas = leak(vec![surface; 3]);
            }
            if has_texel {
                draw.texture = Some(Skin {
                    texture: masked,
                    places: &[[0, 0]; 3],
                    budget: Budget::FAST,
                });
            }
        });
        let part = |has: bool, alpha: u8| if has { f64::from(alpha) / 255.0 } else { 1.0 };
        let [of_surface, of_texel] = [
            part(has_surface, surface),
            part(has_texel, texel.word() as u8),
        ];
        let both = of_surface * of_texel;
        let is_added = has_texel && i % 5 == 0;
        let want = [0, 1, 2].map(|k| {
            let (old, new) = (f64::from(background[k]), f64::from(colour[k]));
            let factor = |factor| match factor {
                Factor::Constant(number) => f64::from(number) / 255.0,
                Factor::Destination => old / 255.0,
                Factor::InverseDestination => 1.0 - old / 255.0,
                Factor::SourceAlpha => of_surface,
                Factor::InverseSourceAlpha => 1.0 - of_surface,
                Factor::TextureAlpha => of_texel,
                Factor::InverseTextureAlpha => 1.0 - of_texel,
            };
            let own = f64::from(own) / 255.0;
            let level = match mode {
                _ if !written[k] => old,
                BlendMode::Half | BlendMode::Factors { .. } if is_added => old + new * both,
                BlendMode::Add(_) | BlendMode::Filter(_) | BlendMode::Subtract(_) if is_added => {
                    old + new * both * own
                }
                BlendMode::Filter(_) => old + (new - old) * both * own,
                BlendMode::Add(_) => old + new * both * own,
                BlendMode::Subtract(_) => old - new * both * own,
                BlendMode::Half => (old + new) / 2.0,
                BlendMode::Factors {
                    source,
                    destination,
                } => new * factor(source) + old * factor(destination),
                BlendMode::Replace => new,
            };
            level.clamp(0.0, 255.0)
        });
        each_place(&corners, |x, y| {
            let got = lines[y][x];
            for k in 0..3 {
                assert!(
                    (f64::from(got[k]) - want[k]).abs() <= 3.0,
                    "{got:?} for {want:?}: {mode:?}, {background:?}, {colour:?}"
                );
            }
            pixels += 1;
        });
    }
    assert!(pixels > 20_000, "{pixels}");
}

/// Opaque where alpha is 255, nothing where it is 0, bit by bit; and what asks for no alpha is drawn as without any.
///
/// Kills: `Half` by alpha.
#[test]
fn alphas_at_their_ends_and_where_nobody_asks_change_nothing() {
    let mut rng = Rng::new(60);
    for _ in 0..80 {
        let corners = triangle(&mut rng, [200, 90, 40]);
        let sample = sample(&mut rng, u16::to_be);
        let (places, budget) = some_skin(&mut rng);
        let words = sample.words.len();
        let (width, height) = (sample.plain.width(), sample.plain.height());
        let of = |dress: &dyn Fn(&mut Draw<'_, '_, i32>)| {
            picture::<Textured<Rgb565Be>>(corners, [10, 120, 40], |draw| {
                draw.texture = Some(Skin {
                    texture: sample.plain,
                    places,
                    budget,
                });
                dress(draw);
            })
        };
        let even = |texel: MaskTexel| -> &'static Texture<'static> {
            let mask = Texture::words(leak(vec![texel.word(); words]), width, height);
            let masked = sample
                .plain
                .masked(Box::leak(Box::new(mask.expect("sides"))));
            Box::leak(Box::new(masked.expect("the same sides")))
        };
        let opaque = of(&|_| {});
        let lies = |texture: &'static Texture<'static>| {
            move |draw: &mut Draw<'_, '_, i32>| {
                if let Some(skin) = &mut draw.texture {
                    skin.texture = texture;
                }
            }
        };
        let (full, none) = (
            lies(even(MaskTexel::OPAQUE)),
            lies(even(MaskTexel::alpha(0))),
        );
        let drawn = of(&|draw| {
            full(draw);
            (draw.blend, draw.alphas) = (Some(Blend::ALPHA), &[255; 3]);
        });
        assert!(drawn == opaque, "alpha of 255");
        let nothing = vec![vec![Rgb565Be::from_rgb8([10, 120, 40]); WIDTH.into()]; 24];
        let drawn = of(&|draw| {
            none(draw);
            draw.blend = Some(Blend::ALPHA);
        });
        assert!(drawn == nothing, "texels of 0");
        let drawn = of(&|draw| (draw.blend, draw.alphas) = (Some(Blend::add(255)), &[0; 3]));
        assert!(drawn == nothing, "vertices of 0");
        // Nobody asks.
        let masked = lies(sample.masked);
        let drawn = of(&|draw| {
            masked(draw);
            draw.alphas = &[0, 100, 200];
        });
        assert!(drawn == opaque, "no blend");
        let half = Some(Blend::new(BlendMode::Half));
        let drawn = of(&|draw| (draw.blend, draw.alphas) = (half, &[0, 100, 200]));
        assert!(drawn == of(&|draw| draw.blend = half), "half");
    }
}
