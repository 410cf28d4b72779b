//! H10: calls that are dithered to 16 bits, pixel by pixel against f64: a level is cut to a step after it was raised by
//! the part of a step that the place has in a matrix of 4 x 4.

use crate::common::Rng;
use crate::hot::exact::{weights, within};
use crate::hot::shine::even_light;
use crate::hot::{Corner, SceneRooms, Smooth, WordOf, camera, draw_with, frame};
use scanbeam::look::{Gouraud, Phong, Textured};
use scanbeam::pixel::{PixelFormat, Rgb565, Rgb565Be, Rgb888};
use scanbeam::scene::{Budget, Scissor, Skin, Texture};
use scanbeam::{Cull, Screen};

/// As it is printed in books.
const MATRIX: [[u8; 4]; 4] = [[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]];

const STEPS: [f64; 3] = [31.0, 63.0, 31.0];

/// How far a level may be off, in steps: 4 units of the 32 that green has, and what light and texels add.
const OFF: f64 = 0.2;

/// Where a look has its colours from.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Lit {
    AtCorners,
    /// From the call, in light that leaves it as it is.
    AtPixels,
}

/// Texels of one colour, in steps.
const TEXEL: [u16; 3] = [25, 40, 31];

static TEXELS: [u16; 64] = [TEXEL[0] << 11 | TEXEL[1] << 5 | TEXEL[2]; 64];
static TEXTURE: Texture<'static> = match Texture::words(&TEXELS, 8, 8) {
    Ok(texture) => texture,
    Err(_) => panic!("8 x 8 texels"),
};
static SWAPPED: [u16; 64] = [TEXELS[0].swap_bytes(); 64];
static TEXTURE_BE: Texture<'static> = match Texture::words(&SWAPPED, 8, 8) {
    Ok(texture) => texture,
    Err(_) => panic!("8 x 8 texels"),
};

fn triangle(rng: &mut Rng, is_even: bool) -> [Corner; 3] {
    let size = rng.pick(&[12, 60, 150, 500, 3_000]);
    let middle = (rng.within(0, 380), rng.within(0, 190));
    let colour = [(); 3].map(|()| rng.below(256) as u8);
    [(); 3].map(|()| Corner {
        at: (
            middle.0 + rng.within(-size, size),
            middle.1 + rng.within(-size, size),
        ),
        w: 1.5,
        colour: if is_even {
            colour
        } else {
            [(); 3].map(|()| rng.below(256) as u8)
        },
    })
}

/// Draws triangles alone, as calls that `texture` lies on, and hands each pixel to `see`: its word, and its place.
fn each_pixel<L: Smooth>(
    seed: u64,
    texture: Option<&'static Texture<'static>>,
    lit: Lit,
    dither: bool,
    mut see: impl FnMut(&[Corner; 3], WordOf<L>, [u16; 2]),
) where
    WordOf<L>: PartialEq,
{
    let mut rng = Rng::new(seed);
    let screen = Screen::new(48, 24).expect("a screen");
    let light = even_light();
    for _ in 0..200 {
        let corners = triangle(&mut rng, lit == Lit::AtPixels);
        let mut rooms = SceneRooms::of_triangles(1, screen);
        let mut scene = rooms.scene::<L>(screen);
        scene.begin(&camera()).expect("the rooms are large enough");
        draw_with(&mut scene, &[corners], |draw| {
            (draw.cull, draw.dither) = (Cull::None, dither);
            if lit == Lit::AtPixels {
                (draw.mesh.colours, draw.colour, draw.lamps) = (&[], corners[0].colour, light);
            }
            draw.texture = texture.map(|texture| Skin {
                texture,
                places: &[[0, 0], [900, 0], [0, 900]],
                budget: Budget::BALANCED,
            });
        })
        .expect("there is room");
        let background = L::Format::from_rgb8([0; 3]);
        let lines = frame(&scene, 4, true, background);
        assert!(
            frame(&scene, 0, false, background) == lines,
            "without a slot"
        );
        for (y, line) in (0..).zip(&lines) {
            for x in within(corners.map(|c| c.at), y.into(), 48) {
                see(&corners, line[x], [x as u16, y]);
            }
        }
    }
}

/// Holds each pixel against the level that the corners have there, times the texel.
fn is_dithered<L: Smooth<Format: PixelFormat<Word = u16>>>(
    seed: u64,
    texture: Option<&'static Texture<'static>>,
    lit: Lit,
    order: fn(u16) -> u16,
) {
    let (mut pixels, mut raised) = (0, 0);
    each_pixel::<L>(seed, texture, lit, true, |corners, word, [x, y]| {
        let (part, _) = weights(corners.map(|c| c.at), x.into(), y.into());
        let rank = MATRIX[usize::from(y) % 4][usize::from(x) % 4];
        let word = order(word);
        let got = [word >> 11, word >> 5 & 63, word & 31];
        for i in 0..3 {
            let level = (0..3).map(|k| part[k] * f64::from(corners[k].colour[i]) / 255.0);
            let whole = texture.map_or(STEPS[i], |_| f64::from(TEXEL[i]));
            let steps = level.sum::<f64>() * whole;
            let cut = |off: f64| {
                let raised = steps + f64::from(2 * u32::from(rank) + 1) / 32.0 + off;
                raised.floor().clamp(0.0, STEPS[i])
            };
            let got_step = f64::from(got[i]);
            assert!(
                cut(-OFF) <= got_step && got_step <= cut(OFF),
                "{got:?} for {steps} of channel {i} at {x}, {y}, {rank}: {corners:?}"
            );
            raised += usize::from(got_step != steps.round());
        }
        pixels += 1;
    });
    // Of all levels a quarter is nearer to another step than to the one that is shown.
    assert!(pixels > 20_000 && raised > pixels / 3, "{pixels} {raised}");
}

/// Kills: steps of a steep shade that are not taken modulo 2^16 (boxes of 3 pixels), a matrix that is turned.
#[test]
fn calls_are_dithered_by_the_matrix() {
    is_dithered::<Gouraud<Rgb565>>(2_001, None, Lit::AtCorners, |word| word);
    is_dithered::<Gouraud<Rgb565Be>>(2_002, None, Lit::AtCorners, u16::from_be);
    is_dithered::<Textured<Rgb565>>(2_003, None, Lit::AtCorners, |word| word);
    is_dithered::<Textured<Rgb565>>(2_004, Some(&TEXTURE), Lit::AtCorners, |word| word);
    is_dithered::<Textured<Rgb565Be>>(2_005, Some(&TEXTURE_BE), Lit::AtCorners, u16::from_be);
    is_dithered::<Phong<Rgb565Be>>(2_006, None, Lit::AtPixels, u16::from_be);
}

/// Pixels of 24 bits have what they have without.
#[test]
fn pixels_of_24_bits_are_not_dithered() {
    let pictures = [true, false].map(|dither| {
        let mut words = Vec::new();
        each_pixel::<Gouraud<Rgb888>>(2_007, None, Lit::AtCorners, dither, |_, word, _| {
            words.push(word)
        });
        each_pixel::<Phong<Rgb888>>(2_008, None, Lit::AtPixels, dither, |_, word, _| {
            words.push(word)
        });
        words
    });
    assert!(pictures[0].len() > 20_000 && pictures[0] == pictures[1]);
}

/// Draws triangles over each other, each in a call of its own, dithered where it says so; a call before all others cuts
/// nothing away, if it says that it cuts.
fn layers<L: Smooth>(
    triangles: &[([Corner; 3], bool)],
    texture: Option<&'static Texture<'static>>,
    cuts: bool,
    slots: u16,
    depth: bool,
) -> Vec<Vec<WordOf<L>>> {
    let screen = Screen::new(48, 24).expect("a screen");
    let mut rooms = SceneRooms::of_triangles(triangles.len(), screen);
    let mut scene = rooms.scene::<L>(screen);
    scene.begin(&camera()).expect("the rooms are large enough");
    for (i, (corners, dither)) in triangles.iter().enumerate() {
        draw_with(&mut scene, &[*corners], |draw| {
            (draw.cull, draw.dither) = (Cull::None, *dither);
            draw.scissor = (cuts && i == 0).then(|| Scissor::inside(0..48, 0..24));
            draw.texture = texture.map(|texture| Skin {
                texture,
                places: &[[0, 0], [900, 0], [0, 900]],
                budget: Budget::BALANCED,
            });
        })
        .expect("there is room");
    }
    frame(&scene, slots, depth, L::Format::from_rgb8([9, 0, 70]))
}

/// What is dithered alone has the pixels that it has where depths are compared, as on lines with a call that cuts.
fn is_dithered_alike<L: Smooth>(seed: u64, texture: Option<&'static Texture<'static>>)
where
    WordOf<L>: PartialEq,
{
    let mut rng = Rng::new(seed);
    let mut differ = 0;
    for round in 0..80 {
        let count = 2 + rng.below(9);
        let mut triangles: Vec<_> = (0..count)
            .map(|_| {
                let is_even = rng.below(3) == 0;
                let corners = triangle(&mut rng, is_even);
                let deep = corners.map(|corner| Corner {
                    w: 1.0 + rng.unit() * 4.0,
                    ..corner
                });
                (deep, rng.below(4) > 0)
            })
            .collect();
        // All over the picture, behind the others.
        for (corner, at) in triangles[0]
            .0
            .iter_mut()
            .zip([(-100, -100), (900, -100), (-100, 500)])
        {
            (corner.at, corner.w) = (at, 9.0);
        }
        for depth in [true, false] {
            let want = layers::<L>(&triangles, texture, true, 64, depth);
            for slots in [64, 3, 0] {
                let got = layers::<L>(&triangles, texture, false, slots, depth);
                assert!(got == want, "{round}: {slots} slots, depth {depth}");
            }
            for (_, dithers) in &mut triangles {
                *dithers = !*dithers;
            }
            differ += u32::from(layers::<L>(&triangles, texture, false, 64, depth) != want);
        }
    }
    assert!(differ > 100, "{differ} of 160 look otherwise without");
}

/// Kills: a call that is not dithered where nothing else is asked of its line, one that is though it does not say so, a
/// triangle without a slot or without planes that is not, one that is marked when its line is over.
#[test]
fn a_dither_alone_is_that_of_lines_with_values() {
    is_dithered_alike::<Gouraud<Rgb565>>(2_011, None);
    is_dithered_alike::<Textured<Rgb565>>(2_012, Some(&TEXTURE));
}
