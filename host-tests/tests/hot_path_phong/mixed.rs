//! Calls that are lit at pixels beside calls that are not, in one scene (K10).

use super::{Facet, Shine};
use crate::common::Rng;
use crate::hot::{SceneRooms, Smooth, WordOf, camera, draw_with, frame};
use scanbeam::look::{Gouraud, Phong, Textured, TexturedPhong};
use scanbeam::pixel::{PixelFormat, Rgb565Be, Rgb888};
use scanbeam::scene::{Application, Budget, Draw, Shading, Skin, Texture};
use scanbeam::{Cull, Screen};

/// Texels of several colours, of which one is a hole.
static WORDS: [u16; 16] = {
    let mut words = [0; 16];
    let mut i = 0;
    while i < 16 {
        words[i] = (i as u16 * 4_111) ^ 0x5a5;
        i += 1;
    }
    words
};
static SWAPPED: [u16; 16] = {
    let mut words = WORDS;
    let mut i = 0;
    while i < 16 {
        words[i] = words[i].swap_bytes();
        i += 1;
    }
    words
};
/// Textures of words, without transparent texels and with one.
const fn both(words: &'static [u16; 16]) -> [Texture<'static>; 2] {
    match (Texture::words(words, 4, 4), Texture::words(words, 4, 4)) {
        (Ok(plain), Ok(keyed)) => [plain, keyed.keyed(words[5])],
        _ => panic!("4 x 4 texels"),
    }
}
static CHECKED: [Texture<'static>; 2] = both(&WORDS);
static CHECKED_BE: [Texture<'static>; 2] = both(&SWAPPED);

/// Calls that are lit at pixels and calls that are not in one scene: each pixel is that of its call in a scene where all
/// are lit, or in one of the look `U` where none is.
fn each_call_is_lit_by_itself<L, U>(seed: u64, textures: Option<&'static [Texture<'static>; 2]>)
where
    L: Smooth<Format: PixelFormat<Word: PartialEq>>,
    U: Smooth<Format = L::Format>,
{
    let mut rng = Rng::new(seed);
    let screen = Screen::new(64, 24).expect("a screen");
    let mut pixels = [0; 2];
    for _ in 0..40 {
        let shine = Shine::new(&mut rng, 2);
        let lamps: &'static _ = Box::leak(Box::new(shine.lamps(screen)));
        let facets: Vec<_> = (0..12)
            .map(|_| {
                let mut facet = Facet::new(&mut rng, screen);
                for corner in &mut facet.corners {
                    corner.colour = [(); 3].map(|()| rng.below(256) as u8);
                }
                facet
            })
            .collect();
        let dress = |draw: &mut Draw<'_, '_, i32>, i: usize, is_lit: bool| {
            if is_lit {
                facets[i].dress(draw, lamps, [200, 20 * i as u8, 90]);
            }
            (draw.cull, draw.dither) = (Cull::None, i.is_multiple_of(3));
            if i.is_multiple_of(4) {
                draw.shading = Shading::Flat;
            }
            // Transparent texels are filled, so that each call has all of its pixels.
            let keyed = usize::from(i % 3 == 1);
            draw.application = [Application::Product, Application::Decal][keyed];
            draw.texture = textures
                .filter(|_| !i.is_multiple_of(5))
                .map(|textures| Skin {
                    texture: &textures[keyed],
                    places: &[[0, 0], [3_000, 100], [200, 2_500]],
                    budget: Budget::BALANCED,
                });
        };
        let mixed = drawn::<L>(&facets, screen, |draw, i| dress(draw, i, i % 2 == 1));
        let lit = drawn::<L>(&facets, screen, |draw, i| dress(draw, i, true));
        let unlit = drawn::<U>(&facets, screen, |draw, i| dress(draw, i, false));
        let owner = drawn::<Gouraud<Rgb888>>(&facets, screen, |draw, i| {
            (draw.mesh.colours, draw.colour) = (&[], [20 * (i as u8 + 1), 0, 0]);
            draw.cull = Cull::None;
        });
        for ((mixed, owner), (lit, unlit)) in mixed.iter().zip(&owner).zip(lit.iter().zip(&unlit)) {
            for x in 0..mixed.len() {
                let Some(owner) = (owner[x][0] / 20).checked_sub(1) else {
                    continue;
                };
                let want = [unlit[x], lit[x]][usize::from(owner % 2)];
                assert!(mixed[x] == want, "column {x}: call {owner}");
                pixels[usize::from(owner % 2)] += 1;
            }
        }
    }
    assert!(pixels.iter().all(|&n| n > 10_000), "{pixels:?}");
}

/// The lines of facets, each in a call of its own.
fn drawn<L: Smooth>(
    facets: &[Facet],
    screen: Screen,
    dress: impl Fn(&mut Draw<'_, '_, i32>, usize),
) -> Vec<Vec<WordOf<L>>> {
    let mut rooms = SceneRooms::new(6 * 12, 12, 24, 12);
    let mut scene = rooms.scene::<L>(screen);
    scene.begin(&camera()).expect("the rooms are large enough");
    for (i, facet) in facets.iter().enumerate() {
        draw_with(&mut scene, &[facet.corners], |draw| dress(draw, i)).expect("there is room");
    }
    frame(&scene, 5, true, L::Format::from_rgb8([0; 3]))
}

/// Kills: a look that is lit at pixels and reads colours of an unlit call as normals, or lights it; the planes of one
/// call for another.
#[test]
fn calls_with_lamps_and_without_are_in_one_scene() {
    each_call_is_lit_by_itself::<Phong<Rgb565Be>, Gouraud<Rgb565Be>>(1_807, None);
    each_call_is_lit_by_itself::<Phong<Rgb888>, Gouraud<Rgb888>>(1_808, None);
    let (narrow, wide) = (Some(&CHECKED_BE), Some(&CHECKED));
    each_call_is_lit_by_itself::<TexturedPhong<Rgb565Be>, Textured<Rgb565Be>>(1_809, narrow);
    each_call_is_lit_by_itself::<TexturedPhong<Rgb888>, Textured<Rgb888>>(1_810, wide);
}
