//! Textures of lists as values of the rooms: forms, palettes, transparent texels, and the memory that they take (H7).

mod own;
mod samples;
mod tables;

use crate::common::Rng;
use crate::listing::PLENTY;
use crate::played::{Kept, drawn, drawn_in, played};
use host_tests::lists::writer::{FieldPacker, ListWriter};
use samples::{has_alpha, key_of, levelled, make_translucent, sample};
use scanbeam::input::PlayerSettings;
use scanbeam::list::{
    FieldForm, Flow, Halt, Header, Id, Lent, ListCommand, Material, Palette, Reason, State,
    TexelForm, Texture as TextureBlock,
};
use scanbeam::look::Textured;
use scanbeam::mesh::ScreenVertex;
use scanbeam::pixel::{PixelFormat, Rgb565, Rgb565Be, Xrgb8888};
use scanbeam::scene::{Blend, Budget, Draw, Sampling, ScreenCorner, Shading, Skin, Texture};
use scanbeam::{Cull, Faces, Light, Mesh};

type Skinned = Textured<Rgb565Be>;

/// The corners of a quad, and their places on a texture in sides.
const CORNERS: [[i32; 2]; 4] = [
    [-16_000, -9_000],
    [14_000, -9_000],
    [14_000, 8_000],
    [-16_000, 8_000],
];
const SIDES: [[i32; 2]; 4] = [[0, 9_000], [11_000, 9_000], [11_000, 0], [0, 0]];

/// A material with the texture of a number, seen from both sides.
fn wear(writer: &mut ListWriter<'_>, number: u8) {
    let material = Material {
        texture: Some(number),
        two_sided: true,
        ..Material::default()
    };
    writer.state(&State::Material(material)).unwrap();
}

/// A quad with the texture of a number, with PRSP or not.
fn draw_quad(writer: &mut ListWriter<'_>, number: u8, prsp: bool) {
    wear(writer, number);
    draw_quad_again(writer, prsp);
}

/// The same with the material in force.
fn draw_quad_again(writer: &mut ListWriter<'_>, prsp: bool) {
    let header = Header {
        text: true,
        prsp,
        new: true,
        rm: true,
        ..Header::of(Id::Short, 4)
    };
    let mut words = Vec::new();
    let mut packer = FieldPacker::new(|w| words.push(w));
    for ([x, y], [u, v]) in CORNERS.into_iter().zip(SIDES) {
        packer.field(FieldForm::S16x3, [x, y, 0, 0]);
        packer.align();
        packer.field(FieldForm::U16x2, [u, v, 0, 0]);
        packer.align();
    }
    writer.vertices(header, &words).unwrap();
}

/// What a list draws, with memory for so many vertices.
fn listed(list: &[u32], room: usize) -> Vec<u16> {
    let list = list.to_vec();
    let mut kept = Kept::new(room, 96);
    drawn::<Skinned>(|scene| {
        let mut player = kept.player::<Skinned>(PlayerSettings::default());
        player.start(0);
        assert_eq!(played(&mut player, &list[..], scene, PLENTY), Ok(Halt::End));
    })
}

/// The same by a call, with texels that are words of the panel.
fn call_quad(texture: &Texture<'_>, budget: Budget) -> Vec<u16> {
    call_quad_as(texture, budget, |_| {})
}

/// The same by a call that `dress` changes.
fn call_quad_as(
    texture: &Texture<'_>,
    budget: Budget,
    dress: impl Fn(&mut Draw<'_, '_>),
) -> Vec<u16> {
    let positions = CORNERS.map(|[x, y]| [x as i16, y as i16, 0]);
    let (width, height) = (texture.width() as i32, texture.height() as i32);
    let places = SIDES.map(|[u, v]| [(u * width) >> 4, (v * height) >> 4]);
    drawn::<Skinned>(|scene| {
        let mut call = Draw {
            cull: Cull::None,
            texture: Some(Skin {
                texture,
                places: &places,
                budget,
            }),
            ..Draw::new(Mesh {
                positions: &positions,
                normals: &[],
                colours: &[],
                faces: Faces::Triangles(&[[0, 1, 2], [0, 2, 3]]),
            })
        };
        dress(&mut call);
        scene.draw(&call).unwrap();
    })
}

#[test]
fn textures_of_every_form_are_those_of_calls() {
    let (mut holes, mut texels) = (0, 0);
    for form in TexelForm::ALL {
        for seed in 0..12 {
            let mut rng = Rng::new(seed);
            let has_holes = seed % 3 == 2 && has_alpha(form);
            let sample = sample(&mut rng, form, has_holes);
            let prsp = seed % 2 == 0;
            let list = &sample.list(prsp)[..];

            let key = key_of(sample.texels.iter());
            let words = sample.holed(key);
            let texture = sample.texture(&words);
            let texture = if has_holes {
                texture.keyed(key)
            } else {
                texture
            };
            let want = call_quad(&texture, if prsp { Budget::BALANCED } else { Budget::FAST });
            holes += usize::from(has_holes) * want.iter().filter(|word| **word == 0).count();

            let mut kept = Kept::new(64, 96);
            let mut player = kept.player::<Skinned>(PlayerSettings::default());
            let got = drawn::<Skinned>(|scene| {
                player.start(0);
                assert_eq!(played(&mut player, list, scene, PLENTY), Ok(Halt::End));
            });
            assert!(got == want, "{form:?}, seed {seed}");
            texels += got.iter().filter(|word| **word != 0).count();
        }
    }
    assert!(holes > 10_000 && texels > 50_000, "{holes}, {texels}");
}

#[test]
fn levels_of_detail_are_those_of_calls() {
    let mut different = 0;
    for (form, seed) in TexelForm::ALL
        .into_iter()
        .flat_map(|f| [(f, 0), (f, 1), (f, 2)])
    {
        // The third has a side of one texel.
        let sides = [[5, 4], [6, 6], [6, 1]][seed as usize];
        let (whole, words, key) = levelled(form, seed, sides);
        let level = |level: usize| {
            let [width, height] = sides.map(|log: u8| 1 << log.saturating_sub(level as u8));
            Texture::words(&words[level], width, height).unwrap()
        };
        let coarser = [level(1), level(2), level(3)];
        let first = level(0).wrapping(whole.wrap()).keyed(key);
        let sampled = first.sampled(Sampling::NEAREST, &coarser).unwrap();
        let want = call_quad(&sampled, Budget::BALANCED);
        let mut kept = Kept::new(64, 96);
        let list = Vec::leak(whole.list(true));
        let mut player = kept.player::<Skinned>(PlayerSettings::default());
        let got = drawn::<Skinned>(|scene| {
            player.start(0);
            assert_eq!(played(&mut player, &*list, scene, PLENTY), Ok(Halt::End));
        });
        assert!(got == want, "{form:?}, seed {seed}");
        let alone = call_quad(&first, Budget::BALANCED);
        different += got.iter().zip(&alone).filter(|(a, b)| a != b).count();
    }
    assert!(different > 8_000, "{different}");
}

#[test]
fn levels_of_detail_without_room_are_refused() {
    let mut memory = vec![0; 4096];
    let mut writer = ListWriter::new(&mut memory);
    for number in [1, 2] {
        let (whole, ..) = levelled(TexelForm::Rgb565, 0, [4, 4]);
        let block = TextureBlock {
            number,
            ..whole.block
        };
        writer.bulk(&State::Texture(block), &whole.words).unwrap();
        draw_quad(&mut writer, number, true);
    }
    writer.flow(Flow::End).unwrap();
    let mut kept = Kept::new(64, 96);
    let mut player = kept.player::<Skinned>(PlayerSettings::default());
    let list = writer.words();
    drawn::<Skinned>(|scene| {
        player.start(0);
        let error = played(&mut player, list, scene, PLENTY).unwrap_err();
        assert_eq!(error.reason, Reason::Lent(Lent::Levels));
        assert_eq!(scene.objects(), 0);
    });
}

#[test]
fn a_texture_is_made_once_for_each_palette() {
    let mut rng = Rng::new(5);
    let one = sample(&mut rng, TexelForm::Index8, false);
    let mut memory = vec![0; 4096];
    let mut writer = ListWriter::new(&mut memory);
    writer.bulk(&State::Texture(one.block), &one.words).unwrap();
    for shift in [0, 8] {
        let colours: Vec<u32> = one
            .colours
            .iter()
            .map(|c| c.rotate_left(shift) | 0xFF00_0000)
            .collect();
        let palette = Palette {
            number: 2,
            count: 256,
            at: 0,
        };
        writer.bulk(&State::Palette(palette), &colours).unwrap();
        // A palette counts from where it stands, for the material of before too.
        if shift > 0 {
            draw_quad_again(&mut writer, false);
            continue;
        }
        draw_quad(&mut writer, 1, false);
        // The same texture by another number.
        let again = Flow::LoadTexture { number: 3, at: 0 };
        writer.flow(again).unwrap();
        draw_quad(&mut writer, 3, false);
    }
    writer.flow(Flow::End).unwrap();
    let list = writer.words();
    let mut kept = Kept::new(64, 96);
    let mut player = kept.player_with::<Skinned>(PlayerSettings::default(), 2, 512);
    let mut pictures = Vec::new();
    for begin in [
        ListCommand::Start(0),
        ListCommand::Restart,
        ListCommand::Start(0),
    ] {
        pictures.push(drawn::<Skinned>(|scene| {
            player.command(begin);
            assert_eq!(played(&mut player, list, scene, PLENTY), Ok(Halt::End));
        }));
    }
    assert!(pictures[0] == pictures[1] && pictures[0] == pictures[2]);
    // One palette less has no room.
    let mut player = kept.player_with::<Skinned>(PlayerSettings::default(), 2, 511);
    drawn::<Skinned>(|scene| {
        player.start(0);
        let error = played(&mut player, list, scene, PLENTY).unwrap_err();
        assert_eq!(error.reason, Reason::Lent(Lent::Texels));
        assert_eq!(scene.objects(), 0);
    });
}

/// Kills: places down a texture that are half as far.
#[test]
fn vertices_on_the_screen_have_places_on_a_texture() {
    let mut rng = Rng::new(21);
    let sample = sample(&mut rng, TexelForm::Rgb565, false);
    let places = [[40, 30], [700, 60], [60, 540], [690, 500u32]];
    let corners = places.map(|place| (place, [(); 2].map(|()| rng.below(1 << 14))));
    let mut memory = vec![0; 4096];
    let mut writer = ListWriter::new(&mut memory);
    writer
        .bulk(&State::Texture(sample.block), &sample.words)
        .unwrap();
    wear(&mut writer, sample.block.number);
    let header = Header {
        text: true,
        new: true,
        ..Header::of(Id::Long, 4)
    };
    let words = corners.map(|([x, y], [u, v])| [y << 16 | x, v << 16 | u]);
    writer.vertices(header, words.as_flattened()).unwrap();
    writer.flow(Flow::End).unwrap();
    let words = sample.holed(0);
    let texture = sample.texture(&words);
    let [w, h] = [texture.width(), texture.height()];
    let of = |i: usize| {
        let ([x, y], [u, v]) = corners[i];
        ScreenCorner {
            vertex: ScreenVertex {
                x: x as i16,
                y: y as i16,
                depth: 1 << 31,
                colour: [255; 3],
            },
            texel: [(u * w) as i32 >> 4, (v * h) as i32 >> 4],
        }
    };
    let want = drawn::<Skinned>(|scene| {
        let call = Draw {
            cull: Cull::None,
            texture: Some(Skin {
                texture: &texture,
                places: &[],
                budget: Budget::FAST,
            }),
            ..PlayerSettings::default().draw
        };
        let faces = [[0, 1, 2], [2, 1, 3]];
        scene.draw_screen(&call, &faces.map(|f| f.map(of))).unwrap();
    });
    assert!(want.iter().filter(|word| **word != 0).count() > 500);
    assert!(listed(writer.words(), 8) == want);
}

/// Kills: masks of alphas for a palette without any, which take as much memory again.
#[test]
fn a_palette_without_alphas_takes_a_word_a_colour() {
    let list = &sample(&mut Rng::new(5), TexelForm::Index8, false).list(false)[..];
    let mut kept = Kept::new(64, 96);
    let mut player = kept.player_with::<Skinned>(PlayerSettings::default(), 1, 256);
    let picture = drawn::<Skinned>(|scene| {
        player.start(0);
        assert_eq!(played(&mut player, list, scene, PLENTY), Ok(Halt::End));
    });
    assert!(picture.iter().filter(|word| **word != 0).count() > 500);
}

/// Kills: texels that are copied where they are words of the panel already, and some that are not and are used as they lie.
#[test]
fn texels_of_the_panel_are_used_where_they_lie() {
    let sample = sample(&mut Rng::new(11), TexelForm::Rgb565, false);
    let list = &sample.list(true)[..];
    let mut kept = Kept::new(64, 96);
    let mut player = kept.player_with::<Textured<Rgb565>>(PlayerSettings::default(), 2, 0);
    let seen = drawn_in::<Rgb565, Textured<Rgb565>>(|scene| {
        player.start(0);
        assert_eq!(played(&mut player, list, scene, PLENTY), Ok(Halt::End));
    });
    let mut kept = Kept::new(64, 96);
    let mut player = kept.player_with::<Skinned>(PlayerSettings::default(), 2, 0);
    drawn::<Skinned>(|scene| {
        player.start(0);
        let error = played(&mut player, list, scene, PLENTY).unwrap_err();
        assert_eq!(error.reason, Reason::Lent(Lent::Texels));
    });
    let mut kept = Kept::new(64, 96);
    let mut player = kept.player::<Skinned>(PlayerSettings::default());
    let copied = drawn::<Skinned>(|scene| {
        player.start(0);
        assert_eq!(played(&mut player, list, scene, PLENTY), Ok(Halt::End));
    });
    assert!(seen.iter().filter(|word| **word != 0).count() > 500);
    assert!(seen.into_iter().map(u16::to_be).eq(copied));
}

/// Pixels of 32 bits are made of the texels that panels of 16 bits get. Kills: texels that are cut, black, or in the
/// order of bytes of another panel.
#[test]
fn pixels_of_more_bits_are_made_of_the_same_texels() {
    let mut rng = Rng::new(9);
    let mut seen = 0;
    for form in TexelForm::ALL {
        let sample = sample(&mut rng, form, false);
        let list = &sample.list(true)[..];
        let mut kept = Kept::new(64, 96);
        let mut player = kept.player::<Skinned>(PlayerSettings::default());
        let narrow = drawn::<Skinned>(|scene| {
            player.start(0);
            assert_eq!(played(&mut player, list, scene, PLENTY), Ok(Halt::End));
        });
        let mut kept = Kept::new(64, 96);
        let mut player = kept.player::<Textured<Xrgb8888>>(PlayerSettings::default());
        let wide = drawn_in::<Xrgb8888, Textured<Xrgb8888>>(|scene| {
            player.start(0);
            assert_eq!(played(&mut player, list, scene, PLENTY), Ok(Halt::End));
        });
        for (narrow, wide) in narrow.into_iter().zip(wide) {
            // A texel in full light is itself.
            assert_eq!(
                Rgb565Be::to_rgb8(narrow),
                Xrgb8888::to_rgb8(wide),
                "{form:?}"
            );
            seen += usize::from(narrow != 0);
        }
    }
    assert!(seen > 4_000, "{seen}");
}

/// Texels of any alpha are those of a call whose texture has a mask, and texels with the D bit are not dithered where the
/// rest is. Kills: alphas of another colour, D that is not asked, a call that hides what is behind it.
#[test]
fn texels_with_alpha_are_those_of_calls() {
    let forms = [
        TexelForm::Index1,
        TexelForm::Index4,
        TexelForm::Index6,
        TexelForm::Index8,
        TexelForm::Rgba,
    ];
    let mut differ = [0; 2];
    for (form, seed) in forms
        .into_iter()
        .flat_map(|form| [0, 1, 2, 3].map(|s| (form, s)))
    {
        let mut rng = Rng::new(40 + seed);
        let (has_alpha, dithers) = (seed != 3, seed >= 2);
        let mut sample = sample(&mut rng, form, false);
        let masks = make_translucent(&mut rng, &mut sample, has_alpha);
        let list = &sample.list(true)[..];
        let words = sample.words();
        let plain = sample.texture(&words);
        let mask = Texture::words(&masks, plain.width(), plain.height()).unwrap();
        let masked = plain.masked(&mask).unwrap();
        // Shaded, so that there is something to dither.
        let light = Light::new([0.8, 0.0, 0.6], 0.3);
        let settings = PlayerSettings {
            draw: Draw {
                light,
                shading: Shading::Flat,
                dither: dithers,
                ..PlayerSettings::default().draw
            },
            ..PlayerSettings::default()
        };
        let want = |texture: &Texture<'_>| {
            call_quad_as(texture, Budget::BALANCED, |draw| {
                (draw.dither, draw.light, draw.shading) = (dithers, light, Shading::Flat);
                draw.blend = has_alpha.then_some(Blend::ALPHA);
            })
        };
        let mut kept = Kept::new(64, 96);
        let mut player = kept.player::<Skinned>(settings);
        let got = drawn::<Skinned>(|scene| {
            player.start(0);
            assert_eq!(played(&mut player, list, scene, PLENTY), Ok(Halt::End));
        });
        assert!(got == want(&masked), "{form:?}, seed {seed}");
        let opaque = want(&plain);
        let kind = usize::from(!has_alpha);
        differ[kind] += got.iter().zip(&opaque).filter(|(a, b)| a != b).count();
    }
    assert!(differ[0] > 10_000 && differ[1] > 100, "{differ:?}");
}

/// The settings say how texels of lists are taken: as those of a call that is sampled so. Kills: settings that nobody
/// asks, a filter of another texture.
#[test]
fn textures_of_lists_are_filtered_as_those_of_calls() {
    let mut rng = Rng::new(11);
    let mut differ = 0;
    for form in [TexelForm::Rgb565, TexelForm::Index4, TexelForm::Rgba] {
        let sample = sample(&mut rng, form, false);
        let list = &sample.list(true)[..];
        let words = sample.words();
        let plain = sample.texture(&words);
        let pictures = [None, Some(Sampling::LINEAR)].map(|sampling| {
            let texture = match sampling {
                Some(sampling) => plain.sampled(sampling, &[]).unwrap(),
                None => plain,
            };
            let want = call_quad(&texture, Budget::BALANCED);
            let mut kept = Kept::new(64, 96);
            let mut player = kept.player::<Skinned>(PlayerSettings {
                sampling,
                ..PlayerSettings::default()
            });
            let got = drawn::<Skinned>(|scene| {
                player.start(0);
                assert_eq!(played(&mut player, list, scene, PLENTY), Ok(Halt::End));
            });
            assert!(got == want, "{form:?}, {sampling:?}");
            got
        });
        let [near, mixed] = &pictures;
        differ += near.iter().zip(mixed).filter(|(a, b)| a != b).count();
    }
    assert!(differ > 1_000, "{differ}");
}
