//! Lists in scenes whose pixels are numbers of a palette (H18): their colours are such numbers, and what numbers cannot
//! be is refused.

use crate::common::Rng;
use crate::listing::{PLENTY, triangle};
use crate::played::{Kept, drawn_in, played};
use crate::player_alpha::{Band, list_of};
use host_tests::lists::writer::ListWriter;
use scanbeam::input::PlayerSettings;
use scanbeam::list::{Flow, Halt, Header, Id, ListError, Material, Missing, Reason, State};
use scanbeam::look::{Gouraud, Look};
use scanbeam::pixel::{Index4, Index8, Indexed, PixelFormat, Rgb888};
use scanbeam::scene::{Blend, Draw};

const FACES: usize = 40;

/// Faces over and beside each other, each in a colour.
fn listed(colour: impl Fn(usize) -> [u8; 3]) -> &'static [u32] {
    let mut list = Vec::new();
    for number in 0..FACES {
        let mut memory = [0; 8];
        let mut writer = ListWriter::new(&mut memory);
        let material = Material {
            diffuse: colour(number),
            ..Material::default()
        };
        writer.state(&State::Material(material)).unwrap();
        list.extend_from_slice(writer.words());
        list.extend(triangle(number as u32));
    }
    let mut memory = [0; 1];
    let mut writer = ListWriter::new(&mut memory);
    writer.flow(Flow::End).unwrap();
    list.extend_from_slice(writer.words());
    Vec::leak(list)
}

/// What a list draws.
fn picture<P: PixelFormat>(list: &'static [u32]) -> Vec<P::Word>
where
    Gouraud<P>: Look<Pixel = P>,
{
    let mut kept = Kept::new(64, 96);
    let mut player = kept.player::<Gouraud<P>>(PlayerSettings::default());
    drawn_in::<P, Gouraud<P>>(|scene| {
        player.start(0);
        assert_eq!(played(&mut player, list, scene, PLENTY), Ok(Halt::End));
    })
}

fn numbers_are_those_of_faces<const N: usize>()
where
    Gouraud<Indexed<N>>: Look<Pixel = Indexed<N>>,
{
    let number = |face: usize| (1 + face * 7 % (N - 1)) as u8;
    // Each face in a colour of its own.
    let faces = picture::<Rgb888>(listed(|face| [1 + face as u8, 0, 0]));
    let want = faces.into_iter().map(|[red, _, _]| match red {
        0 => 0,
        red => number(usize::from(red) - 1),
    });
    let want: Vec<u8> = want.collect();
    let got = picture::<Indexed<N>>(listed(|face| Indexed::<N>::colour(number(face))));
    assert!(got == want, "{N} colours");
    assert!(want.iter().filter(|number| **number > 0).count() > 500);
}

/// Kills: colours of blocks that are made darker, or rounded to another number.
#[test]
fn colours_of_lists_are_numbers() {
    numbers_are_those_of_faces::<256>();
    numbers_are_those_of_faces::<16>();
}

/// What a player says to a list that draws nothing.
fn refused<P: PixelFormat>(
    list: &'static [u32],
    settings: PlayerSettings<'static, 'static>,
) -> ListError
where
    Gouraud<P>: Look<Pixel = P>,
{
    let mut kept = Kept::new(64, 96).with_alphas(64);
    let mut player = kept.player::<Gouraud<P>>(settings);
    let mut error = None;
    drawn_in::<P, Gouraud<P>>(|scene| {
        player.start(0);
        error = played(&mut player, list, scene, PLENTY).err();
        assert_eq!((scene.objects(), player.counts().draws), (0, 0));
    });
    error.expect("it is refused")
}

/// Writes a strip with alphas.
fn strip(band: &Band) -> impl FnOnce(&mut ListWriter<'_>) {
    let header = Header {
        shade: true,
        new: true,
        ..Header::of(Id::Short, 12)
    };
    move |writer| writer.vertices(header, &band.words(false)).unwrap()
}

/// Kills: lists that go on without what is seen through.
#[test]
fn numbers_of_lists_are_not_blended() {
    let band = Band::new(&mut Rng::new(3), 12);
    let opaque = Band {
        alphas: vec![255; 12],
        ..Band::new(&mut Rng::new(4), 12)
    };
    let long = |writer: &mut ListWriter<'_>| {
        let header = Header {
            new: true,
            ..Header::of(Id::Long, 3)
        };
        let words = vec![0; 3 * header.long_words() as usize];
        writer.vertices(header, &words).unwrap();
    };
    let settings = PlayerSettings::default();
    let added = PlayerSettings {
        draw: Draw {
            blend: Some(Blend::add(255)),
            ..settings.draw
        },
        ..settings
    };
    let reason = Reason::Missing(Missing::Blends);
    for (list, settings) in [
        (list_of(255, strip(&band)), settings),
        (list_of(200, strip(&opaque)), settings),
        (list_of(200, long), settings),
        (list_of(255, strip(&opaque)), added),
    ] {
        for error in [
            refused::<Index8>(list, settings),
            refused::<Index4>(list, settings),
        ] {
            assert_eq!(error.reason, reason);
            assert!(error.to_string().contains("palette"), "{error}");
        }
    }
    // What is opaque is drawn, whatever its alphas say where nobody looks.
    picture::<Index8>(list_of(255, strip(&opaque)));
}
