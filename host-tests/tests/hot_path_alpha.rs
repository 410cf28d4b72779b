//! K11, H7, H8, H10: alpha that differs from vertex to vertex and from texel to texel, texels that are added or not
//! dithered, against f64 and against formulas of whole numbers, pixel by pixel.
//!
//! Where a mask lies is told by a picture of the same call whose texels are all different: its pixels name them.

use crate::common::Rng;
use crate::hot::exact::{weights, within};
use crate::hot::{Corner, SceneRooms, Smooth, WordOf, camera, draw_with, frame};
use scanbeam::look::{Gouraud, Phong, Textured, TexturedPhong};
use scanbeam::mesh::ScreenVertex;
use scanbeam::pixel::{PixelFormat, Rgb565, Rgb565Be, Rgb565Le, Rgb888, Xrgb8888};
use scanbeam::scene::{
    Application, Blend, BlendMode, Budget, Draw, DrawError, Factor, Full, MaskTexel, Sampling,
    ScreenCorner, Shading, Skin, Texture, TextureError, Wrap,
};
use scanbeam::{Affine, Camera, Cull, Faces, Mesh, MeshError, Screen};

const BLACK: [u8; 3] = [0; 3];

fn leak<T>(all: Vec<T>) -> &'static [T] {
    all.leak()
}

/// A triangle of any size and slant, of these colours.
fn triangle(rng: &mut Rng, colour: [u8; 3]) -> [Corner; 3] {
    let size = rng.pick(&[12, 60, 200, 700, 3_000]);
    let middle = (rng.within(0, 380), rng.within(0, 190));
    let w = 1.0 + 3.0 * rng.unit();
    let slant = rng.pick(&[1.0, 1.0, 3.0]);
    [(); 3].map(|()| Corner {
        at: (
            middle.0 + rng.within(-size, size),
            middle.1 + rng.within(-size, size),
        ),
        w: w * rng.between(1.0, slant),
        colour,
    })
}

const WIDTH: u16 = 48;

/// The picture of one triangle as a call that `dress` changes: the same by any number of slots, with depth or without.
fn picture<L: Smooth>(
    corners: [Corner; 3],
    background: [u8; 3],
    dress: impl Fn(&mut Draw<'_, '_, i32>),
) -> Vec<Vec<WordOf<L>>>
where
    WordOf<L>: PartialEq,
{
    let screen = Screen::new(WIDTH, 24).expect("a screen");
    let mut rooms = SceneRooms::new(12, 4, 24, 1);
    let mut scene = rooms.scene::<L>(screen);
    scene.begin(&camera()).expect("the rooms are large enough");
    draw_with(&mut scene, &[corners], |draw| {
        draw.cull = Cull::None;
        dress(draw);
    })
    .expect("there is room");
    let background = L::Format::from_rgb8(background);
    let lines = frame(&scene, 4, true, background);
    assert!(frame(&scene, 0, true, background) == lines, "without slots");
    assert!(
        frame(&scene, 4, false, background) == lines,
        "without depth"
    );
    lines
}

/// Calls `see` with each place that a triangle covers.
fn each_place(corners: &[Corner; 3], mut see: impl FnMut(usize, usize)) {
    for y in 0..24 {
        for x in within(corners.map(|c| c.at), y, WIDTH) {
            see(x, y as usize);
        }
    }
}

/// Holds white triangles over black, whose level is then their alpha, against f64.
fn vertices_have_alpha<L: Smooth>(seed: u64, off: f64)
where
    WordOf<L>: PartialEq,
{
    let mut rng = Rng::new(seed);
    let (mut pixels, mut worst) = (0, 0.0f64);
    for i in 0..300 {
        let corners = triangle(&mut rng, [255; 3]);
        let alphas = [(); 3].map(|()| rng.pick(&[0, 255, rng.clone().below(256) as u8]));
        let alphas = leak(alphas.to_vec());
        let own = rng.pick(&[255, 255, 200, 90]);
        let lines = picture::<L>(corners, BLACK, |draw| {
            draw.shading = [Shading::Smooth, Shading::Flat][i % 2];
            (draw.alphas, draw.blend) = (alphas, Some(Blend::filter(own)));
        });
        each_place(&corners, |x, y| {
            let (part, _) = weights(corners.map(|c| c.at), x as i32, y as i32);
            let alpha = (0..3).map(|k| part[k] * f64::from(alphas[k])).sum::<f64>();
            let want = alpha * f64::from(own) / 255.0;
            let got = L::Format::to_rgb8(lines[y][x]);
            for level in got {
                worst = worst.max((f64::from(level) - want).abs());
                assert!(
                    (f64::from(level) - want).abs() <= off,
                    "{got:?} for {want} at {x}, {y}: {alphas:?}, {corners:?}"
                );
            }
            pixels += 1;
        });
    }
    println!("{worst}");
    assert!(pixels > 20_000, "{pixels}");
}

/// Kills: alphas in the order of the mesh where corners were sorted, one alpha for a whole triangle, a flat face that takes
/// its first one, a mode whose own alpha is dropped.
#[test]
fn alpha_is_linear_between_vertices() {
    // Half a level of alpha, one of 256 in place of 255, and half of one of the pixel.
    vertices_have_alpha::<Gouraud<Rgb888>>(1, 2.0);
    vertices_have_alpha::<Gouraud<Xrgb8888>>(2, 2.0);
    vertices_have_alpha::<Textured<Rgb888>>(3, 2.0);
    // Half of one of 32, half a step, and the same half a level.
    vertices_have_alpha::<Gouraud<Rgb565Be>>(4, 8.9);
    vertices_have_alpha::<Textured<Rgb565Le>>(5, 8.9);
}

/// Meshes whose colours are their alphas, and white ones with these alphas over black, are the same pictures, where
/// triangles cross the near plane and the guard band too, whether vertices are shared or find no room.
///
/// Kills: alphas of the corners for pieces, a piece's in another order, records of a mesh that has no room for them.
#[test]
fn what_is_cut_keeps_its_alphas() {
    let screen = Screen::new(64, 48).expect("a screen");
    let eye = Camera::look_at([0.0; 3], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0], 40.0, 0.5, 30.0);
    let camera = eye.expect("a camera");
    let (mut pixels, mut clipped) = (0, 0);
    for seed in 0..60 {
        let mut rng = Rng::new(700 + seed);
        let positions: Vec<[i16; 3]> = (0..9)
            .map(|_| {
                let [x, y] = [(); 2].map(|()| rng.within(-16_000, 16_000) as i16);
                [x, y, rng.within(-16_000, 3_000) as i16]
            })
            .collect();
        let alphas: Vec<u8> = (0..9).map(|_| rng.below(256) as u8).collect();
        let grey: Vec<[u8; 3]> = alphas.iter().map(|a| [*a; 3]).collect();
        let faces = [[0, 1, 2], [3, 4, 5], [6, 7, 8]];
        // Opaque ones hide each other, so each is drawn alone.
        for face in faces {
            let mesh = Mesh {
                positions: &positions,
                normals: &[],
                colours: &grey,
                faces: Faces::Triangles(std::slice::from_ref(&face)),
            };
            let opaque = Draw {
                model: Affine::placed(4.0, [0.0, 0.0, -1.0]).expect("a model"),
                cull: Cull::None,
                ..Draw::new(mesh)
            };
            let translucent = Draw {
                mesh: Mesh {
                    colours: &[],
                    ..mesh
                },
                alphas: &alphas,
                blend: Some(Blend::ALPHA),
                ..opaque
            };
            // Room for the mesh and its records, for the mesh alone, for pieces alone.
            let room = [60, 10, 8][seed as usize % 3] + 24;
            let pictures = [opaque, translucent].map(|call| {
                let mut rooms = SceneRooms::new(room, 12, 48, 1);
                let mut scene = rooms.scene::<Gouraud<Rgb888>>(screen);
                scene.begin(&camera).expect("the rooms are large enough");
                scene.draw(&call).expect("there is room");
                clipped += scene.assembled().clipped;
                frame(&scene, 8, true, BLACK)
            });
            for (one, other) in pictures[0]
                .iter()
                .flatten()
                .zip(pictures[1].iter().flatten())
            {
                for (a, b) in one.iter().zip(other) {
                    assert!(a.abs_diff(*b) <= 2, "{one:?}, {other:?}: seed {seed}");
                }
                pixels += usize::from(*other != BLACK);
            }
        }
    }
    assert!(pixels > 20_000 && clipped > 50, "{pixels}, {clipped}");
}

/// Points, and triangles on the screen, have alphas too. Kills: one alpha for all points, corners of a face in another
/// order, a face that takes those of the first.
#[test]
fn what_is_made_on_the_screen_has_alphas() {
    let screen = Screen::new(WIDTH, 24).expect("a screen");
    let mut rng = Rng::new(20);
    let mut rooms = SceneRooms::new(400, 100, 24, 1);
    let mut scene = rooms.scene::<Gouraud<Rgb888>>(screen);
    scene.begin(&camera()).expect("the rooms are large enough");
    // One point a column, 2 wide, on other lines.
    let positions: Vec<[i32; 3]> = (0..8)
        .map(|i| [(6 * i - 21) << 18, (3 * i - 10) << 18, -(1 << 30)])
        .collect();
    let alphas: Vec<u8> = (0..8).map(|i| 20 + 30 * i as u8).collect();
    let mesh = Mesh {
        positions: &positions,
        normals: &[],
        colours: &[],
        faces: Faces::Triangles(&[]),
    };
    let points = Draw {
        alphas: &alphas,
        blend: Some(Blend::ALPHA),
        ..Draw::new(mesh)
    };
    scene.draw_points(&points, 2).expect("there is room");
    let lines = frame(&scene, 8, true, BLACK);
    let mut seen: Vec<(usize, u8)> = Vec::new();
    for line in &lines {
        for (x, pixel) in line
            .iter()
            .enumerate()
            .filter(|(_, pixel)| **pixel != BLACK)
        {
            seen.push((x / 6, pixel[0]));
        }
    }
    assert_eq!(seen.len(), 32, "{seen:?}");
    seen.sort_unstable();
    for (point, four) in seen.chunks(4).enumerate() {
        let alpha = alphas[point];
        for (_, level) in four {
            assert!(level.abs_diff(alpha) <= 1, "{level} for {alpha}");
        }
    }
    let mut pixels = 0;
    for _ in 0..60 {
        scene.begin(&camera()).expect("the rooms are large enough");
        let (a, b) = (triangle(&mut rng, [255; 3]), triangle(&mut rng, [255; 3]));
        let alphas: Vec<u8> = (0..6).map(|_| rng.below(256) as u8).collect();
        let faces = [a, b].map(|corners| {
            corners.map(|c| ScreenCorner {
                vertex: ScreenVertex {
                    x: c.at.0 as i16,
                    y: c.at.1 as i16,
                    depth: 1 << 30,
                    colour: c.colour,
                },
                ..ScreenCorner::default()
            })
        });
        let empty = Mesh {
            positions: &[] as &[[i16; 3]],
            ..Mesh {
                positions: &[],
                normals: &[],
                colours: &[],
                faces: Faces::Triangles(&[]),
            }
        };
        let call = Draw {
            cull: Cull::None,
            alphas: &alphas,
            blend: Some(Blend::add(255)),
            ..Draw::new(empty)
        };
        scene.draw_screen(&call, &faces).expect("there is room");
        let lines = frame(&scene, 8, true, BLACK);
        let mut want = vec![[0.0f64; WIDTH as usize]; 24];
        for (corners, alphas) in [a, b].iter().zip(alphas.chunks(3)) {
            each_place(corners, |x, y| {
                let (part, _) = weights(corners.map(|c| c.at), x as i32, y as i32);
                want[y][x] += (0..3).map(|k| part[k] * f64::from(alphas[k])).sum::<f64>();
                pixels += 1;
            });
        }
        for (got, want) in lines.iter().flatten().zip(want.iter().flatten()) {
            let want = want.min(255.0);
            assert!(
                (f64::from(got[0]) - want).abs() <= 3.0,
                "{got:?} for {want}"
            );
        }
    }
    assert!(pixels > 5_000, "{pixels}");
}

/// What a field of so many steps becomes, in whole numbers, `alpha` being one of `whole`.
fn blended(mode: BlendMode, [old, new, most]: [u32; 3], alpha: u32, whole: u32) -> u32 {
    let part = (new * alpha + whole / 2) / whole;
    match mode {
        BlendMode::Add(_) => (old + part).min(most),
        BlendMode::Subtract(_) => old.saturating_sub(part),
        _ => (old * (whole - alpha) + new * alpha + whole / 2) / whole,
    }
}

/// A pixel of 5, 6 and 5 bits as a number over another.
fn over_565(mode: BlendMode, old: u16, new: u16, alpha: u8) -> u16 {
    let alpha = (u32::from(alpha) * 32 + 127) / 255;
    let fields = |word: u16| [word >> 11, word >> 5 & 63, word & 31].map(u32::from);
    let (o, n) = (fields(old), fields(new));
    let of = |i: usize, most| blended(mode, [o[i], n[i], most], alpha, 32) as u16;
    of(0, 31) << 11 | of(1, 63) << 5 | of(2, 31)
}

/// Texels that are all different, words of a mask for them, and the texture of both.
struct Sample {
    words: &'static [u16],
    masks: &'static [u16],
    plain: &'static Texture<'static>,
    masked: &'static Texture<'static>,
    /// To find a texel by its word.
    texel_of: Vec<u32>,
}

/// `order` makes words of numbers.
fn sample(rng: &mut Rng, order: fn(u16) -> u16) -> Sample {
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
fn some_skin(rng: &mut Rng) -> (&'static [[i32; 2]], Budget) {
    let reach = rng.pick(&[2_000, 20_000, 60_000]);
    let places = (0..3).map(|_| [(); 2].map(|()| rng.within(-reach, reach)));
    (leak(places.collect()), rng.pick(&BUDGETS))
}

/// Holds pixels of 16 bits against whole numbers.
fn masks_lie_on_texels<L: Smooth<Format: PixelFormat<Word = u16>>>(
    seed: u64,
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
                (draw.mesh.colours, draw.blend) = (&[], blend);
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

/// Kills: a mask that is read by another way than its texture (not clamped, not mirrored, from its own planes), alpha of
/// the neighbour, bits A and D mixed up, an alpha that is dropped, `added` that asks the mode.
#[test]
fn a_mask_lies_where_its_texture_lies() {
    masks_lie_on_texels::<Textured<Rgb565>>(31, |word| word);
    masks_lie_on_texels::<Textured<Rgb565Be>>(32, u16::to_be);
    masks_lie_on_texels::<Textured<Rgb565Le>>(33, u16::to_le);
    masks_lie_on_texels::<TexturedPhong<Rgb565Be>>(34, u16::to_be);
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
    at_pixels: bool,
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
                    if at_pixels {
                        (draw.mesh.colours, draw.colour) = (&[], colour);
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

/// Kills: a D bit that is not asked, asked where texels are added, or turns the dither on; pixels that are dithered twice.
#[test]
fn texels_with_the_d_bit_are_not_dithered() {
    d_bits_bypass_the_dither::<Textured<Rgb565>>(41, false, |word| word);
    d_bits_bypass_the_dither::<Textured<Rgb565Be>>(42, false, u16::to_be);
    d_bits_bypass_the_dither::<TexturedPhong<Rgb565Be>>(43, true, u16::to_be);
}

/// Each factor, and each mode, with alphas of vertices, of texels and of its own, over any colour, against f64.
///
/// Kills: an alpha of texels in the place of one of vertices, inverses that are not, a factor without its alpha, channels
/// that are written though they are not to be.
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
/// Kills: alphas that are looked at in a call that hides what is behind it, in one that is not dithered, or by `Half`.
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

/// Alphas are filtered where colours are. Kills: a mask of which the nearest texel is taken, one that is mixed as colours
/// are, weights of the other axis.
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

/// Masks that do not fit, alphas that are too few, and memory that is full. Kills: a mask of other sides, bits or levels that
/// is taken; a call with too many alphas; a mesh whose alphas find no room and that is drawn without them.
#[test]
fn what_does_not_fit_is_refused() {
    const WORDS: [u16; 64] = [0; 64];
    static LEVEL: [Texture<'static>; 1] = [match Texture::words(&WORDS, 4, 4) {
        Ok(texture) => texture,
        Err(_) => panic!("4 x 4"),
    }];
    let texture = Texture::words(&WORDS, 8, 8).expect("sides");
    let others = [
        Texture::words(&WORDS, 8, 4),
        Texture::words(&WORDS, 4, 8),
        Texture::index8(&[0; 64], &[0; 256], 8, 8),
        texture.sampled(Sampling::NEAREST, &LEVEL),
    ];
    for other in others {
        let other = other.expect("a texture");
        assert_eq!(texture.masked(&other).err(), Some(TextureError::Mask));
        assert_eq!(other.masked(&texture).err(), Some(TextureError::Mask));
    }
    let masked = texture.masked(&texture).expect("itself");
    let again = masked.sampled(Sampling::NEAREST, &LEVEL).err();
    assert_eq!(again, Some(TextureError::Mask));
    assert!(masked.sampled(Sampling::LINEAR, &[]).is_ok());
    let told = TextureError::Mask.to_string();
    assert_eq!(told, "texture: its mask is not of the same form");

    let screen = Screen::new(16, 16).expect("a screen");
    let length = Err(DrawError::Mesh(MeshError::AttributeLength));
    let positions: [[i16; 3]; 3] = [
        [-900, -900, -16_384],
        [900, -900, -16_384],
        [0, 900, -16_384],
    ];
    let mesh = Mesh {
        positions: &positions,
        normals: &[],
        colours: &[],
        faces: Faces::Triangles(&[[0, 1, 2]]),
    };
    let call = Draw {
        blend: Some(Blend::ALPHA),
        cull: Cull::None,
        ..Draw::new(mesh)
    };
    for alphas in [&[1u8, 2][..], &[1, 2, 3, 4]] {
        let call = Draw { alphas, ..call };
        let mut rooms = SceneRooms::new(9, 9, 16, 9);
        let mut scene = rooms.scene::<Gouraud<Rgb565>>(screen);
        scene.begin(&camera()).expect("the rooms are large enough");
        assert_eq!(scene.draw(&call), length);
        assert_eq!(scene.draw_points(&call, 3), length);
        let faces = [[ScreenCorner::default(); 3]; 2];
        assert_eq!(scene.draw_screen(&call, &faces), length);
        assert_eq!((scene.objects(), scene.vertices()), (0, 0));
    }
    // Three vertices and a record; one less has no room.
    for (room, want) in [(4, true), (3, false)] {
        let mut rooms = SceneRooms::new(room, 9, 16, 9);
        let mut scene = rooms.scene::<Gouraud<Rgb565>>(screen);
        scene.begin(&camera()).expect("the rooms are large enough");
        let full = DrawError::Full {
            memory: Full::Vertices,
            triangles: 1,
            first_face: 0,
        };
        let drawn = scene.draw(&Draw {
            alphas: &[9; 3],
            ..call
        });
        assert_eq!(drawn, if want { Ok(()) } else { Err(full) });
        assert_eq!(scene.objects(), usize::from(want));
        // What nobody asks for takes no room.
        scene.begin(&camera()).expect("the rooms are large enough");
        let opaque = Draw {
            alphas: &[9; 3],
            blend: None,
            ..call
        };
        scene.draw(&opaque).expect("there is room");
        assert_eq!(scene.vertices(), 3);
    }
}

/// A look lit at pixels has alphas of vertices too. Kills: a look that is asked for them.
#[test]
fn light_at_pixels_has_alpha_at_vertices() {
    let mut rng = Rng::new(90);
    let mut pixels = 0;
    for _ in 0..60 {
        let corners = triangle(&mut rng, [255; 3]);
        let alphas = leak((0..3).map(|_| rng.below(256) as u8).collect());
        let lines = picture::<Phong<Rgb888>>(corners, BLACK, |draw| {
            (draw.mesh.colours, draw.alphas) = (&[], alphas);
            draw.blend = Some(Blend::ALPHA);
        });
        each_place(&corners, |x, y| {
            let (part, _) = weights(corners.map(|c| c.at), x as i32, y as i32);
            let want = (0..3).map(|k| part[k] * f64::from(alphas[k])).sum::<f64>();
            let got = f64::from(lines[y][x][0]);
            assert!((got - want).abs() <= 2.0, "{got} for {want} at {x}, {y}");
            pixels += 1;
        });
    }
    assert!(pixels > 4_000, "{pixels}");
}
