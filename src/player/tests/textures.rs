//! Textures: their levels, what refused ones keep, and settings that are others later.

use super::*;
use crate::list::{Lent as Lacking, Reason};
use crate::scene::{Draw, Sampling};

/// Texture 0 of texels of 32 bits, with sides of these logarithms.
fn texture(log_sides: [u32; 2], levels: u32, texels: &[u32]) -> Vec<u32> {
    let [width, height] = log_sides;
    let form = 7 << 8 | (levels - 1) << 12;
    let header = [state(8, 0), width | height << 4 | form, texels.len() as u32];
    [&header, texels].concat()
}

/// Texel `n` of those that have this colour or another, and no dither of their own.
fn texel(n: u32) -> u32 {
    0x7F00_0000 | 0x0032_96C8u32.rotate_left(8 * (n % 3)) & 0x00FF_FFFF
}

/// The square of the corners, with all of a texture on it.
fn square() -> Vec<u32> {
    let mut words = vec![block(1, 4, NEW | PRSP | TEXT)];
    let places = [0, 0x1000, 0x1000_0000, 0x1000_1000];
    for (corner, place) in CORNERS.into_iter().zip(places) {
        words.extend(corner);
        words.push(place);
    }
    words
}

/// A list that draws a square with a texture.
fn skinned(texture: &[u32]) -> &'static [u32] {
    let parts = [texture, &material(Some(0)), &square(), &[flow(0)]];
    listed(&parts.concat())
}

/// The picture of a list that a new player draws.
fn new_picture(settings: PlayerSettings<'static, 'static>, list: &'static [u32]) -> Vec<u16> {
    picture(&mut player(settings, Lent::SOME), list, Halt::End)
}

fn linear() -> PlayerSettings<'static, 'static> {
    PlayerSettings {
        sampling: Some(Sampling::LINEAR),
        ..PlayerSettings::default()
    }
}

/// Kills: a texture with levels below one texel that is not filtered, and memory that such levels take.
#[test]
fn levels_below_one_texel_are_not_drawn_with() {
    for sides in [[0, 0], [1, 1], [1, 0], [2, 1], [0, 2]] {
        let least = 1 + u32::max(sides[0], sides[1]);
        let count = |levels| {
            (0..levels).map(|l| {
                sides
                    .iter()
                    .map(|s: &u32| 1 << s.saturating_sub(l))
                    .product::<u32>()
            })
        };
        let list = |levels| {
            let texels: Vec<u32> = (0..count(levels).sum()).map(texel).collect();
            skinned(&texture(sides, levels, &texels))
        };
        let want = new_picture(linear(), list(least));
        let nearest = new_picture(PlayerSettings::default(), list(least));
        assert_eq!(want == nearest, sides == [0, 0]);
        for levels in least..=4 {
            let lent = Lent {
                textures: 1,
                texels: count(least).sum::<u32>() as usize,
                levels: least as usize - 1,
            };
            let got = picture(&mut player(linear(), lent), list(levels), Halt::End);
            assert!(got == want, "{sides:?}, {levels}");
        }
    }
}

/// Kills: memory that textures keep which are refused for want of another room, of words for a mask, or of levels.
#[test]
fn what_is_refused_keeps_no_memory() {
    let plain = skinned(&texture([1, 1], 1, &[0, 1, 2, 2].map(texel)));
    let masked = skinned(&texture([1, 1], 1, &[0x4000_00FF; 4]));
    let levelled = skinned(&texture([1, 1], 2, &[0, 1, 2, 2, 1].map(texel)));
    let both = skinned(&texture([1, 1], 2, &[0x4000_00FF; 5]));
    let lent = |textures, texels, levels| Lent {
        textures,
        texels,
        levels,
    };
    let want = new_picture(PlayerSettings::default(), plain);
    for (refused, lent, lacking) in [
        (masked, lent(1, 8, 0), Lacking::Textures),
        (masked, lent(2, 7, 0), Lacking::Texels),
        (levelled, lent(1, 5, 0), Lacking::Levels),
        (both, lent(2, 10, 1), Lacking::Levels),
    ] {
        let mut player = player(PlayerSettings::default(), lent);
        for _ in 0..3 {
            let error = run(&mut player, refused).0.unwrap_err();
            assert_eq!(error.reason, Reason::Lent(lacking));
            player.start(0);
        }
        assert!(
            picture(&mut player, plain, Halt::End) == want,
            "{lacking:?}"
        );
    }
}

/// Kills: textures that stay sampled or dithered as they were when they were made.
#[test]
fn other_settings_count_for_textures_that_are_there() {
    let plain = PlayerSettings::default();
    let dithered = PlayerSettings {
        draw: Draw {
            dither: true,
            ..plain.draw
        },
        ..plain
    };
    // D where texels stand side by side with those that have none.
    let halves = texture([1, 1], 1, &[0xFF83_8583, 0x7F83_8583].repeat(2));
    let grey = [state(5, 0), 0xFF6D_6B6D, 0, 7];
    let halved = listed(&[&halves, &grey[..], &square(), &[flow(0)]].concat());
    let coloured = skinned(&texture([1, 1], 1, &[0, 1, 2, 2].map(texel)));
    for (list, other) in [(coloured, linear()), (halved, dithered)] {
        let (before, want) = (new_picture(plain, list), new_picture(other, list));
        assert!(before != want);
        let mut player = player(plain, Lent::SOME);
        for (settings, want) in [(plain, &before), (other, &want), (plain, &before)] {
            player.set(settings);
            player.start(0);
            assert!(picture(&mut player, list, Halt::End) == *want);
        }
    }
    // Both are found again, and what has no D is the same where it is dithered: there is no room for more.
    let palette = [state(9, 0), 2, 0xFF20_4060, 0xFFC0_8040];
    let indexed = [state(8, 0), 1 | 1 << 4, 1, 0b0110];
    let list = skinned(&[palette, indexed].concat());
    let lent = Lent {
        textures: 2,
        texels: 4,
        levels: 0,
    };
    let mut player = player(plain, lent);
    for settings in [plain, linear(), dithered, plain, linear()] {
        player.set(settings);
        player.start(0);
        assert_eq!(run(&mut player, list).0, Ok(Halt::End));
    }
}

/// Kills: a texture of the settings that was replaced.
#[test]
fn other_textures_of_the_settings_count_from_the_next_block_on() {
    let own = |word| {
        let texture = Texture::words(Vec::leak(vec![word]), 1, 1).unwrap();
        let texture: &Texture<'_> = std::boxed::Box::leak(std::boxed::Box::new(texture));
        PlayerSettings {
            textures: Vec::leak(vec![Some(texture)]),
            ..PlayerSettings::default()
        }
    };
    let list = listed(&[&material(Some(0)), &square(), &[flow(2)][..], &square()].concat());
    let mut player = player(own(0xF800), Lent::SOME);
    let middle = usize::from(HEIGHT / 2 * WIDTH + WIDTH / 2);
    assert_eq!(picture(&mut player, list, Halt::Sync)[middle], 0xF800);
    player.set(own(0x001F));
    assert_eq!(picture(&mut player, list, Halt::End)[middle], 0x001F);
}

/// A texture of the settings with sides of these logarithms.
fn gradient([width, height]: [u32; 2]) -> Option<&'static Texture<'static>> {
    let texels = (0..1u16 << (width + height)).map(|n| n.wrapping_mul(0x9E37) | 1);
    let texels: &[u16] = Vec::leak(texels.collect());
    let texture = Texture::words(texels, 1 << width, 1 << height).unwrap();
    Some(std::boxed::Box::leak(std::boxed::Box::new(texture)))
}

/// Kills: texture places that are read of a ring when something is drawn, and such that lost bits.
#[test]
fn a_table_that_was_freed_keeps_its_places() {
    let sides = [[6, 6], [5, 4], [10, 4], [1, 3], [6, 6]];
    let settings = PlayerSettings {
        textures: Vec::leak(sides.map(gradient).to_vec()),
        ..PlayerSettings::default()
    };
    let places = [0x0003_0005, 0x0207_1000, 0x1000_01FF, 0x1003_0F0D];
    let mut table = vec![block(5, 4, PRSP | TEXT)];
    for [x, y] in [[0, 1], [2, 3]].map(|pair| pair.map(|i: usize| CORNERS[i][0])) {
        table.extend([x, y << 16, y >> 16]);
    }
    table.extend(places);
    let faces = |texture| {
        [
            &material(Some(texture))[..],
            &[block(6, 4, NEW), 0x0302_0100],
        ]
        .concat()
    };
    let mut later = vec![0; 600];
    later[0] = block(8, 599, 0);
    for is_freed in [false, true] {
        let (mut writer, mut reader) = ring(1024).split();
        let mut played = player(settings, Lent::SOME);
        let before = if is_freed {
            vec![&table, &later, &later]
        } else {
            vec![&table]
        };
        for words in before {
            writer.append(listed(words)).unwrap();
            assert_eq!(run(&mut played, reader.words()).0, Ok(Halt::Waiting));
            if is_freed {
                reader.free_to(played.position());
            }
        }
        for number in 0..sides.len() as u32 {
            writer.append(listed(&faces(number))).unwrap();
            // The texture before is narrow.
            if is_freed && number == 4 {
                let error = run(&mut played, reader.words()).0.unwrap_err();
                assert_eq!(error.reason, Reason::Lent(Lacking::Places));
                break;
            }
            let got = picture(&mut played, reader.words(), Halt::Waiting);
            let alone = listed(&[&table[..], &faces(number), &[flow(0)]].concat());
            assert!(got == new_picture(settings, alone), "{is_freed}, {number}");
        }
    }
}
