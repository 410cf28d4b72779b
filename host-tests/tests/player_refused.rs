//! What a player refuses, and that nothing of such a list is drawn (H13, X7).

use crate::hot::shine::even_light;
use crate::listing::{PLENTY, ring_memory, triangle};
use crate::played::lists::{after_a_triangle, draw_textured, texture};
use crate::played::{Kept, drawn, lit_at_pixels, played};
use host_tests::lists::writer::ListWriter;
use scanbeam::Light;
use scanbeam::event::{Event, Notice};
use scanbeam::input::{OnViolation, Player, PlayerMemory, PlayerSettings};
use scanbeam::list::{
    Budget, CameraWords, Field, FieldForm, Flow, Halt, Header, Id, Lent, LightWords, ListError,
    ListRing, Material, Missing, Overlay, Palette, Reason, State, TexelForm, VertexFormat, Window,
};
use scanbeam::look::{Gouraud, Look, Phong, Textured};
use scanbeam::pixel::Rgb565Be;
use scanbeam::scene::{Draw, Scissor};
use scenes::Played;

type Smooth = Gouraud<Rgb565Be>;
type Skinned = Textured<Rgb565Be>;

/// What a player says to a list: nothing of it must be drawn where that is an error.
fn said<'t, L: Look<Pixel = Rgb565Be>>(
    list: &'t [u32],
    settings: PlayerSettings<'t, 't>,
    vertices: usize,
    textures: usize,
    texels: usize,
) -> Result<Halt, ListError> {
    let kept = Box::leak(Box::new(Kept::new(vertices, 96)));
    let mut player = kept.player_with::<L>(settings, textures, texels);
    let mut result = Ok(Halt::End);
    drawn::<L>(|scene| {
        player.start(0);
        result = played(&mut player, list, scene, PLENTY);
        let is_drawn = scene.objects() + scene.vertices() > 0;
        assert_eq!(is_drawn, result.is_ok(), "{result:?}");
        assert_eq!(player.counts().draws > 0, result.is_ok());
    });
    result
}

/// Three vertices of a table, or of a strip, whose places have 32 bits; where they are.
fn fine_places(writer: &mut ListWriter<'_>, id: Id) -> u32 {
    let fields = [Field {
        parameter: Field::PLACE,
        form: FieldForm::S32x3,
    }];
    let format = VertexFormat::new(&fields).unwrap();
    writer.state(&State::Format(format)).unwrap();
    let at = writer.position();
    let header = Header {
        new: id == Id::Short,
        ..Header::of(id, 3)
    };
    writer.vertices(header, &[0; 9]).unwrap();
    at
}

/// Refused by a look, as this block at this offset.
fn refused<L: Look<Pixel = Rgb565Be>>(list: &[u32], at: u32, block: Id, reason: Reason) {
    refused_with::<L>(PlayerSettings::default(), list, at, block, reason);
}

/// The same with settings.
fn refused_with<L: Look<Pixel = Rgb565Be>>(
    settings: PlayerSettings<'static, 'static>,
    list: &[u32],
    at: u32,
    block: Id,
    reason: Reason,
) {
    let list = Vec::leak(list.to_vec());
    let error = ListError {
        offset: at,
        block: Some(block),
        reason,
    };
    assert_eq!(said::<L>(list, settings, 64, 8, 4096), Err(error));
    assert!(error.to_string().contains(&format!("{at:#x}")), "{error}");
}

/// Refused as light at vertices, where pixels are lit.
fn refused_where_lit(list: &[u32], at: u32, block: Id) {
    let reason = Reason::Missing(Missing::LightAtVertices);
    refused_with::<Phong<Rgb565Be>>(lit_at_pixels(), list, at, block, reason);
}

#[test]
fn what_a_player_does_not_have_is_refused_where_it_stands() {
    use Missing::*;
    let long = after_a_triangle(|writer| {
        let header = Header {
            new: true,
            ..Header::of(Id::Long, 3)
        };
        writer.vertices(header, &[0; 3]).unwrap();
        0
    });
    let state = |state: State, data: &[u32]| {
        after_a_triangle(|writer| {
            match data {
                [] => writer.state(&state).unwrap(),
                data => writer.bulk(&state, data).unwrap(),
            }
            0
        })
    };
    let (list, at) = long;
    refused_where_lit(&list, at, Id::Long);
    let overlay = Overlay {
        left: 0,
        top: 0,
        width: 2,
        height: 1,
        form: TexelForm::Rgb565,
        additive: false,
        palette: 0,
        at: 0,
    };
    let (list, at) = state(State::Overlay(overlay), &[0]);
    refused::<Smooth>(&list, at, Id::State, Reason::Lent(Lent::Overlays));
    let light = LightWords::from(Light::new([0.0, 1.0, 0.0], 0.1).unwrap());
    let (list, at) = state(State::Light { number: 3, light }, &[]);
    refused::<Smooth>(&list, at, Id::State, Reason::Missing(Lights));
    let red = LightWords {
        colour: [255, 0, 0],
        ..light
    };
    let (list, at) = state(
        State::Light {
            number: 0,
            light: red,
        },
        &[],
    );
    refused::<Smooth>(&list, at, Id::State, Reason::Missing(Lights));
    let (list, at) = state(State::Light { number: 0, light }, &[]);
    refused_where_lit(&list, at, Id::State);
    let shiny = Material {
        specular: [1, 0, 0],
        ..Material::default()
    };
    let (list, at) = state(State::Material(shiny), &[]);
    refused::<Smooth>(&list, at, Id::State, Reason::Missing(Highlights));
    let (list, at) = after_a_triangle(|writer| {
        draw_textured(writer);
        0
    });
    refused::<Smooth>(&list, at, Id::State, Reason::Missing(Textures));
    for id in [Id::Short, Id::Table] {
        let (list, at) = after_a_triangle(|writer| fine_places(writer, id));
        refused::<Smooth>(&list, at, id, Reason::Missing(FinePlaces));
    }
    let (list, at) = after_a_triangle(|writer| {
        let header = Header {
            shade: true,
            ..Header::of(Id::Table, 3)
        };
        let words = writer.format().table_words(header, 3);
        writer.vertices(header, &vec![0; words as usize]).unwrap();
        0
    });
    refused_where_lit(&list, at, Id::Table);
}

#[test]
fn textures_that_cannot_be_drawn_are_refused_where_they_are_drawn_with() {
    let list = |form, colour: u32, with_palette| {
        after_a_triangle(|writer| {
            let block = texture(form, 1);
            let words = vec![colour.to_le(); block.words() as usize];
            writer.bulk(&State::Texture(block), &words).unwrap();
            let palette = Palette {
                number: 2,
                count: 3,
                at: 0,
            };
            if with_palette {
                let colours = [0xFF00_0000, colour, 0xFFFF_FFFF];
                writer.bulk(&State::Palette(palette), &colours).unwrap();
            }
            draw_textured(writer)
        })
    };
    let (opaque, half) = (0xFF20_4060, 0x8020_4060);
    let (words, at) = list(TexelForm::Index4, opaque, false);
    refused::<Skinned>(&words, at, Id::Short, Reason::NoPalette(1));
    let (words, at) = after_a_triangle(draw_textured);
    refused::<Skinned>(&words, at, Id::Short, Reason::NoTexture(1));

    let (words, at) = list(TexelForm::Index8, opaque, true);
    let words: &[u32] = Vec::leak(words);
    let reason = |reason| {
        Err(ListError {
            offset: at,
            block: Some(Id::Short),
            reason,
        })
    };
    let settings = PlayerSettings::default();
    assert_eq!(said::<Skinned>(words, settings, 64, 1, 256), Ok(Halt::End));
    let full = reason(Reason::Lent(Lent::Textures));
    assert_eq!(said::<Skinned>(words, settings, 64, 0, 256), full);
    let full = reason(Reason::Lent(Lent::Texels));
    assert_eq!(said::<Skinned>(words, settings, 64, 1, 255), full);

    let dithered = PlayerSettings {
        draw: Draw {
            dither: true,
            ..settings.draw
        },
        ..settings
    };
    // Alphas, and D where the rest is dithered, take a second texture, with as many words.
    for (form, colour, settings) in [
        (TexelForm::Index4, half, settings),
        (TexelForm::Rgba, 0x3020_4060, settings),
        (TexelForm::Rgba, 0xFF20_4060, dithered),
    ] {
        let (words, at) = list(form, colour, form.is_indexed());
        let words: &[u32] = Vec::leak(words);
        assert_eq!(said::<Skinned>(words, settings, 64, 2, 32), Ok(Halt::End));
        for (textures, texels, lent) in [(1, 32, Lent::Textures), (2, 31, Lent::Texels)] {
            let error = ListError {
                offset: at,
                block: Some(Id::Short),
                reason: Reason::Lent(lent),
            };
            let done = said::<Skinned>(words, settings, 64, textures, texels);
            assert_eq!(done, Err(error), "{form:?}");
        }
    }
    // D counts where what it belongs to is dithered.
    let (words, _) = list(TexelForm::Rgba, 0xFF20_4060, false);
    let words: &[u32] = Vec::leak(words);
    assert_eq!(said::<Skinned>(words, settings, 64, 1, 16), Ok(Halt::End));
}

#[test]
fn what_memory_scene_or_settings_do_not_allow_is_refused() {
    let teapot = Played::Teapot.list().unwrap();
    let settings = PlayerSettings::default();
    let error = said::<Smooth>(teapot, settings, 64, 0, 0).unwrap_err();
    assert_eq!(
        (error.block, error.reason),
        (Some(Id::Table), Reason::Lent(Lent::Vertices))
    );
    let lit = PlayerSettings {
        draw: Draw {
            light: Light::new([0.0, 1.0, 0.0], 0.1),
            lamps: even_light(),
            ..settings.draw
        },
        ..settings
    };
    let error = said::<Phong<Rgb565Be>>(teapot, lit, 300, 0, 0).unwrap_err();
    assert_eq!(error.reason, Reason::Missing(Missing::LightAtVertices));
    let error = said::<Smooth>(teapot, lit_at_pixels(), 300, 0, 0).unwrap_err();
    assert_eq!(error.reason, Reason::Missing(Missing::Lamps));
    // A second rectangle cannot be said.
    let window = Window {
        left: 1,
        top: 1,
        right: 9,
        bottom: 9,
    };
    let (list, at) = after_a_triangle(|writer| {
        writer.state(&State::Window(window)).unwrap();
        0
    });
    let cut = PlayerSettings {
        draw: Draw {
            scissor: Some(Scissor::outside(3..5, 3..5)),
            ..settings.draw
        },
        ..settings
    };
    let error = said::<Smooth>(Vec::leak(list), cut, 64, 0, 0).unwrap_err();
    assert_eq!(
        (error.offset, error.reason),
        (at, Reason::Missing(Missing::SecondScissor))
    );
    // A scene that was not begun.
    let mut player = Player::<Smooth>::new(PlayerMemory::default(), settings);
    let screen = scanbeam::Screen::new(8, 8).unwrap();
    let memory = scanbeam::scene::Memory {
        vertices: &mut [],
        places: &mut [],
        objects: &mut [],
        bins: &mut [],
        draws: &mut [],
    };
    let mut scene = scanbeam::scene::Scene::new(screen, memory);
    player.start(0);
    let error = played(&mut player, teapot, &mut scene, PLENTY).unwrap_err();
    assert_eq!((error.block, error.reason), (None, Reason::NotBegun));
}

#[test]
fn violations_are_told_and_stop_where_they_are_to() {
    let camera = CameraWords {
        eye: [0.0, 0.0, 4.0],
        at: [0.0; 3],
        up: [0.0, 1.0, 0.0],
        focal: 300.0,
        near: 0.1,
        far: 90.0,
    };
    let window = Window {
        left: 0,
        top: 0,
        right: 97,
        bottom: 72,
    };
    let (list, _) = after_a_triangle(|writer| {
        writer.state(&State::Camera(camera)).unwrap();
        writer.state(&State::Window(window)).unwrap();
        writer.master(7).unwrap();
        writer.flow(Flow::Jump(1 << 20)).unwrap();
        writer.flow(Flow::Interrupt(9)).unwrap();
        0
    });
    let list: &[u32] = Vec::leak(list);
    for on_violation in [OnViolation::GoOn, OnViolation::Stop] {
        let settings = PlayerSettings {
            on_violation,
            ..PlayerSettings::default()
        };
        let mut kept = Kept::new(64, 96);
        let mut player = kept.player::<Smooth>(settings);
        let mut events = Vec::new();
        let mut halt = Ok(Halt::Stopped);
        drawn::<Smooth>(|scene| {
            player.start(0);
            let mut note = |n: Notice| events.push((n.event, n.value));
            halt = player.run(list, scene, &mut PLENTY.clone(), &mut note);
            assert_eq!(scene.objects(), 1);
        });
        let reached = (Event::AccessViolation, 0);
        if on_violation == OnViolation::Stop {
            assert_eq!((halt, &events[..]), (Ok(Halt::Violation), &[reached][..]));
            continue;
        }
        assert_eq!(halt, Ok(Halt::End));
        assert_eq!(events[..4], [reached; 4]);
        assert_eq!(events[4..], [(Event::Interrupt, 9), (Event::ListEnd, 0)]);
        assert_eq!(player.counts().violations, 4);
    }
}

#[test]
fn a_ring_is_played_as_it_grows() {
    let triangles: Vec<Vec<u32>> = (0..40).map(triangle).collect();
    let whole: Vec<u32> = triangles.concat();
    let mut kept = Kept::new(64, 96);
    let mut player = kept.player::<Smooth>(PlayerSettings::default());
    let want = drawn::<Smooth>(|scene| {
        player.start(0);
        assert_eq!(
            played(&mut player, &whole[..], scene, PLENTY),
            Ok(Halt::End)
        );
        assert!(scene.objects() > 20);
    });
    let mut memory = ring_memory(64);
    let mut ring = ListRing::new(&mut memory);
    let (mut writer, mut reader) = ring.split();
    let mut kept = Kept::new(64, 96);
    let mut player = kept.player::<Smooth>(PlayerSettings::default());
    let got = drawn::<Smooth>(|scene| {
        player.start(0);
        // Kills: a block that is not whole yet is malformed.
        let (first, rest) = triangles[0].split_at(triangles[0].len() - 1);
        writer.append(first).unwrap();
        let words = reader.words();
        assert_eq!(played(&mut player, words, scene, PLENTY), Ok(Halt::Waiting));
        writer.append(rest).unwrap();
        for block in &triangles[1..] {
            while writer.append(block).is_err() {
                let words = reader.words();
                assert_eq!(played(&mut player, words, scene, PLENTY), Ok(Halt::Waiting));
                reader.free_to(player.position());
            }
        }
        let words = reader.words();
        assert_eq!(played(&mut player, words, scene, PLENTY), Ok(Halt::Waiting));
        // What is malformed is refused, and what stands before it stays.
        writer.append(&[0x0200_0000u32.to_le()]).unwrap();
        let error = played(&mut player, reader.words(), scene, PLENTY).unwrap_err();
        assert_eq!(error.reason, Reason::Version(2));
        assert_eq!(error.offset, 4 * whole.len() as u32);
    });
    assert!(got == want);
}

/// In place, behind what was drawn of a ring, and in the ring as a whole. Kills: no event, or another value.
#[test]
fn what_is_malformed_is_an_event_without_a_value() {
    let bad = [0x0200_0000u32.to_le()];
    let list = [&triangle(0)[..], &bad].concat();
    let mut kept = Kept::new(64, 96);
    let mut player = kept.player::<Smooth>(PlayerSettings::default());
    let mut told = Vec::new();
    let mut memory = ring_memory(64);
    let mut ring = ListRing::new(&mut memory);
    let (mut writer, reader) = ring.split();
    drawn::<Smooth>(|scene| {
        let tell = &mut |notice: Notice| told.push((notice.event, notice.value));
        let budget = &mut PLENTY.clone();
        player.start(0);
        assert!(player.run(&list[..], scene, budget, tell).is_err());
        player.start(0);
        writer.append(&triangle(0)).unwrap();
        let halt = player.run(reader.words(), scene, budget, tell);
        assert_eq!(halt, Ok(Halt::Waiting));
        writer.append(&bad).unwrap();
        assert!(player.run(reader.words(), scene, budget, tell).is_err());
        assert!(scene.objects() > 0, "what stands before it was drawn");
        player.start(0);
        assert!(player.run(reader.words(), scene, budget, tell).is_err());
    });
    let events = [
        Event::Malformed,
        Event::ListEnd,
        Event::Malformed,
        Event::Malformed,
    ];
    assert_eq!(told, events.map(|event| (event, 0)));
}

/// Kills: blocks without vertices that cost some.
#[test]
fn what_has_no_vertices_costs_none() {
    let mut memory = [0; 64];
    let mut writer = ListWriter::new(&mut memory);
    writer.state(&State::PointSize(2)).unwrap();
    writer.flow(Flow::End).unwrap();
    let mut kept = Kept::new(64, 96);
    let mut player = kept.player::<Smooth>(PlayerSettings::default());
    let budget = Budget {
        vertices: 0,
        ..PLENTY
    };
    drawn::<Smooth>(|scene| {
        player.start(0);
        assert_eq!(
            played(&mut player, writer.words(), scene, budget),
            Ok(Halt::End)
        );
    });
}

/// Kills: a list that goes on where its settings do not fit each other.
#[test]
fn what_does_not_fit_the_settings_stops_the_list() {
    let mut kept = Kept::new(64, 96);
    let settings = PlayerSettings {
        draw: Draw {
            light: Light::new([0.0, 0.0, 1.0], 0.2),
            lamps: even_light(),
            ..PlayerSettings::default().draw
        },
        ..PlayerSettings::default()
    };
    let mut player = kept.player::<Phong<Rgb565Be>>(settings);
    let list = &triangle(0)[..];
    drawn::<Phong<Rgb565Be>>(|scene| {
        player.start(0);
        let error = played(&mut player, list, scene, PLENTY).unwrap_err();
        assert_eq!(error.reason, Reason::Missing(Missing::LightAtVertices));
        let again = played(&mut player, list, scene, PLENTY);
        assert_eq!(again, Ok(Halt::Stopped));
        assert_eq!(scene.objects(), 0);
    });
}
