//! Textures of the settings in place of those of a list: computed (H17), in blocks behind a cache (B1, B5), or in memory.

use super::samples::sample;
use super::{Skinned, call_quad, call_quad_as, draw_quad};
use crate::common::{Rng, leaked};
use crate::listing::PLENTY;
use crate::played::{Kept, drawn, played};
use host_tests::lists::writer::ListWriter;
use scanbeam::input::PlayerSettings;
use scanbeam::list::{Flow, Halt, Lent, ListError, Reason, State, TexelForm};
use scanbeam::scene::{
    Blend, BlockCache, Blocked, Budget, CacheWord, Checker, MaskTexel, Sampling, Texture, Wrap,
};

static CHECKER: Checker = Checker {
    colours: [0x1234, 0xF81F],
    log_side: 1,
};

/// A quad with the texture of a number, which the list has where it is 1.
fn list_of(number: u8) -> Vec<u32> {
    let sample = sample(&mut Rng::new(3), TexelForm::Rgb565, false);
    let mut memory = vec![0; 4096];
    let mut writer = ListWriter::new(&mut memory);
    let defined = writer.bulk(&State::Texture(sample.block), &sample.words);
    defined.unwrap();
    draw_quad(&mut writer, number, true);
    writer.flow(Flow::End).unwrap();
    writer.words().to_vec()
}

/// What it draws, with room for no texture of the list.
fn listed(
    number: u8,
    textures: &[Option<&'static Texture<'static>>],
) -> Result<Vec<u16>, ListError> {
    let list = list_of(number);
    let mut kept = Kept::new(64, 96);
    let settings = PlayerSettings {
        textures,
        // That of the list alone.
        sampling: Some(Sampling::LINEAR),
        ..PlayerSettings::default()
    };
    let mut player = kept.player_with::<Skinned>(settings, 0, 0);
    let mut halt = Ok(Halt::End);
    let picture = drawn::<Skinned>(|scene| {
        player.start(0);
        halt = played(&mut player, &list[..], scene, PLENTY);
    });
    halt.map(|_| picture)
}

/// Kills: textures of settings that are passed over, are another number's, have another wrap or another filter.
#[test]
fn textures_of_settings_stand_in_place_of_those_of_lists() {
    let mut rng = Rng::new(8);
    let words: Vec<u16> = (0..64 * 32)
        .map(|_| 4_099 * rng.below(15) as u16 + 99)
        .collect();
    let words: &'static [u16] = words.leak();
    let plain = Texture::words(words, 64, 32).unwrap();
    let fast = Box::leak(Box::new([const { CacheWord::new() }; 64]));
    let cache = leaked(BlockCache::new(plain, Blocked::new(2, 2).unwrap(), fast).unwrap());
    let own = [
        plain,
        plain.wrapping(Wrap::Mirror),
        plain.sampled(Sampling::LINEAR, &[]).unwrap(),
        plain.keyed(words[0]),
        Texture::computed(&CHECKER, 64, 32).unwrap(),
        cache.texture(),
    ];
    let mut pictures = Vec::new();
    for texture in own {
        let texture = leaked(texture);
        let want = call_quad(texture, Budget::BALANCED);
        // In place of the list's, and of one that it does not have.
        assert!(listed(1, &[None, Some(texture)]) == Ok(want.clone()));
        assert!(listed(3, &[None, None, None, Some(texture)]) == Ok(want.clone()));
        assert!(want.iter().filter(|word| **word != 0).count() > 500);
        pictures.push(want);
    }
    // Texels through a cache are those of memory, in another order.
    assert!(cache.reads().reads > 1_000);
    for (i, one) in pictures.iter().enumerate() {
        assert!(pictures[..i].iter().all(|other| other != one), "{i}");
    }
}

/// Kills: masks of textures of settings that are not looked at.
#[test]
fn textures_of_settings_are_blended_by_their_masks() {
    let mut rng = Rng::new(9);
    let mut some = |of: &dyn Fn(u32) -> u16| -> &'static [u16] {
        let words: Vec<u16> = (0..32 * 32).map(|_| of(rng.below(1 << 16))).collect();
        words.leak()
    };
    let texels = some(&|word| word as u16);
    let alphas = some(&|word| MaskTexel::alpha(word as u8).word());
    let mask = leaked(Texture::words(alphas, 32, 32).unwrap());
    let masked = Texture::words(texels, 32, 32).unwrap().masked(mask);
    let masked = leaked(masked.unwrap());
    let want = call_quad_as(masked, Budget::BALANCED, |draw| {
        draw.blend = Some(Blend::ALPHA);
    });
    assert!(want != call_quad(masked, Budget::BALANCED));
    assert!(listed(1, &[None, Some(masked)]) == Ok(want));
}

/// Kills: numbers that are not in the settings and are drawn with something.
#[test]
fn what_settings_do_not_have_is_the_lists() {
    let checker = leaked(Texture::computed(&CHECKER, 64, 32).unwrap());
    for textures in [&[Some(checker), None, None][..], &[Some(checker)], &[]] {
        let reason = |number| listed(number, textures).unwrap_err().reason;
        // There is room for none.
        assert_eq!(reason(1), Reason::Lent(Lent::Textures));
        assert_eq!(reason(2), Reason::NoTexture(2));
    }
}
