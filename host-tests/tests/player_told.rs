//! What a player tells of what it drew, and what of its settings stays in force beside what a list says (H11, H14).

use crate::listing::PLENTY;
use crate::played::{Kept, drawn, lists, played};
use host_tests::lists::writer::{FieldPacker, ListWriter};
use host_tests::rooms::{Room, picture};
use scanbeam::event::{Event, Notice};
use scanbeam::input::{PlayerSettings, RunCounts};
use scanbeam::light::{DirectionalLight, Lighting};
use scanbeam::list::{
    FieldForm, Flow, Halt, Header, Id, Material, State, TexelForm, Texture as TextureBlock,
};
use scanbeam::look::{Gouraud, Textured};
use scanbeam::mesh::U1F15;
use scanbeam::pixel::Rgb565Be;
use scanbeam::scene::{Blend, BlendMode, Draw, Scene};
use scanbeam::{Camera, Cull, Screen};

type Smooth = Gouraud<Rgb565Be>;

/// A surface of full opacity that is seen from both sides.
const WHITE: Material = Material {
    diffuse: [255; 3],
    opacity: 255,
    specular: [0; 3],
    exponent: 0,
    two_sided: true,
    unlit: false,
    texture: None,
};

/// The notices of an event: the place of the block, and the value.
fn of(event: Event, notices: &[Notice]) -> Vec<(u32, u32)> {
    let of = notices.iter().filter(|n| n.event == event);
    of.map(|n| (n.offset, n.value)).collect()
}

/// A triangle with normals, of so bright a grey, of which one corner is so near, in 2^-14.
fn draw_triangle(writer: &mut ListWriter<'_>, grey: u8, near: i32) {
    let header = Header {
        shade: true,
        new: true,
        ..Header::of(Id::Short, 3)
    };
    let mut words = Vec::new();
    let mut packer = FieldPacker::new(|w| words.push(w));
    for [x, y, z] in [[-9000, -9000, 0], [9000, -9000, 0], [0, 9000, near]] {
        packer.field(FieldForm::S16x3, [x, y, z, 0]);
        packer.align();
        packer.field(FieldForm::U8x4, [i32::from(grey); 4]);
        packer.align();
        packer.field(FieldForm::S10x3, [0, 0, 511, 0]);
        packer.align();
    }
    writer.vertices(header, &words).unwrap();
}

/// What a player says of a list that it draws where there is room for so many triangles, and so many indices at once.
fn told(list: &[u32], objects: usize, indices: usize) -> (RunCounts, Vec<Notice>) {
    let camera = Camera::look_at([0.0, 0.0, 1.2], [0.0; 3], [0.0, 1.0, 0.0], 60.0, 0.5, 9.0);
    let room = Room {
        vertices: 99,
        places: 0,
        objects,
        draws: 9,
    };
    let mut kept = Kept::new(64, indices);
    let mut notices: Vec<Notice> = Vec::new();
    let mut counts = RunCounts::default();
    let screen = Screen::new(96, 72).unwrap();
    picture(screen, room, 0, |scene: &mut Scene<'_, '_, _>| {
        scene.begin(&camera.unwrap())?;
        let mut player = kept.player::<Smooth>(PlayerSettings::default());
        player.start(0);
        let mut budget = PLENTY;
        let tell = &mut |n: Notice| notices.push(n);
        assert_eq!(player.run(list, scene, &mut budget, tell), Ok(Halt::End));
        counts = player.counts();
        Ok(())
    })
    .unwrap();
    (counts, notices)
}

/// Kills: sums of a scene's triangles in place of those of the list, triangles without room that nobody counts, and a
/// block that is told as clipped since one before it was.
#[test]
fn a_player_counts_what_each_block_drew_and_lost() {
    let mut memory = vec![0; 256];
    let mut writer = ListWriter::new(&mut memory);
    // A new state between two blocks parts their meshes.
    let mut places = Vec::new();
    for near in [0, 30_000, 0, 0] {
        writer.state(&State::Material(WHITE)).unwrap();
        places.push(4 * writer.position());
        draw_triangle(&mut writer, 255, near);
    }
    writer.flow(Flow::End).unwrap();
    let list = writer.words();
    // The triangle that is cut leaves two, so that there is room for the first two, and no more; or for all.
    for (objects, dropped) in [(3, 2), (9, 0)] {
        let (counts, notices) = told(list, objects, 96);
        assert_eq!(
            (counts.draws, counts.triangles, counts.dropped),
            (4, 4, dropped)
        );
        assert_eq!(of(Event::Clipped, &notices), [(places[1], 1)], "{objects}");
        // One triangle a block.
        let lost: Vec<_> = places[4 - dropped as usize..]
            .iter()
            .map(|at| (*at, 1))
            .collect();
        assert_eq!(of(Event::Full, &notices), lost, "{objects}");
    }
}

/// Places of the blocks of which a triangle was cut.
fn clipped(notices: &[Notice]) -> Vec<u32> {
    let clipped = of(Event::Clipped, notices).into_iter();
    clipped.map(|(block, _)| block).collect()
}

/// Blocks without a state between them are drawn together, as far as there is memory; a table has no faces of its own.
/// Kills: the place of the block that makes room, of the first block of all, of a state, and of a table.
#[test]
fn what_is_drawn_together_is_told_of_its_first_block() {
    let mut memory = vec![0; 256];
    let mut writer = ListWriter::new(&mut memory);
    let mut places = Vec::new();
    for near in [0, 30_000, 0] {
        places.push(4 * writer.position());
        draw_triangle(&mut writer, 255, near);
    }
    writer.flow(Flow::End).unwrap();
    for (indices, block) in [(4, 1), (96, 0)] {
        let (_, notices) = told(writer.words(), 9, indices);
        assert_eq!(clipped(&notices), [places[block]], "{indices}");
    }

    let mut memory = vec![0; 256];
    let mut writer = ListWriter::new(&mut memory);
    writer.state(&State::Material(WHITE)).unwrap();
    let mut words = Vec::new();
    let mut packer = FieldPacker::new(|w| words.push(w));
    for near in [0, 30_000] {
        for [x, y, z] in [[-9000, -9000, 0], [9000, -9000, 0], [0, 9000, near]] {
            packer.field(FieldForm::S16x3, [x, y, z, 0]);
        }
    }
    packer.align();
    writer.vertices(Header::of(Id::Table, 6), &words).unwrap();
    let mut places = Vec::new();
    for first in [3, 0, 3] {
        places.push(4 * writer.position());
        let corners = (first..first + 3).map(Some);
        writer.indexed(None, false, corners).unwrap();
        writer.state(&State::Material(WHITE)).unwrap();
    }
    writer.flow(Flow::End).unwrap();
    let (_, notices) = told(writer.words(), 9, 96);
    assert_eq!(clipped(&notices), [places[0], places[2]]);
}

/// The picture of a triangle of a material and a grey over nothing.
fn picture_of(settings: PlayerSettings<'_, '_>, material: Material, grey: u8) -> Vec<u16> {
    let mut memory = vec![0; 64];
    let mut writer = ListWriter::new(&mut memory);
    writer.state(&State::Material(material)).unwrap();
    draw_triangle(&mut writer, grey, 0);
    writer.flow(Flow::End).unwrap();
    let mut kept = Kept::new(64, 96);
    drawn::<Smooth>(|scene| {
        let mut player = kept.player::<Smooth>(settings);
        player.start(0);
        played(&mut player, writer.words(), scene, PLENTY).unwrap();
    })
}

/// Kills: a blend of the settings that an opaque material puts out, and one that opacity does not replace.
#[test]
fn what_is_opaque_has_the_blend_of_the_settings() {
    let with = |blend| {
        let begin = PlayerSettings::default();
        PlayerSettings {
            draw: Draw {
                blend,
                ..begin.draw
            },
            ..begin
        }
    };
    let half = Material {
        opacity: 128,
        ..WHITE
    };
    let halved = with(Some(Blend::filter(128)));
    let none = with(None);
    let filtered = picture_of(halved, WHITE, 200);
    assert!(filtered != picture_of(none, WHITE, 200));
    assert!(filtered == picture_of(none, half, 200));
    // A subtraction would leave nothing.
    let less = with(Some(Blend::new(BlendMode::Subtract(255))));
    assert!(picture_of(less, WHITE, 200).iter().all(|word| *word == 0));
    assert!(picture_of(less, half, 200) == filtered);
}

/// Kills: lights of the settings that fall on what is not lit.
#[test]
fn lights_of_the_settings_do_not_fall_on_what_is_unlit() {
    let lamps = [DirectionalLight::new([0.0, 1.0, 1.0], [0.5, 0.2, 0.1]).unwrap()];
    let ambient = [U1F15::from_bits(3000); 3];
    let lighting = Lighting::new(&lamps, ambient, scanbeam::mesh::Material::default()).unwrap();
    let begin = PlayerSettings::default();
    let dark = PlayerSettings {
        draw: Draw {
            cull: Cull::None,
            light: None,
            ..begin.draw
        },
        ..begin
    };
    let lit = PlayerSettings {
        draw: Draw {
            lights: Some(&lighting),
            ..dark.draw
        },
        ..dark
    };
    let unlit = Material {
        unlit: true,
        ..WHITE
    };
    assert!(picture_of(lit, unlit, 255) == picture_of(dark, unlit, 255));
    assert!(picture_of(lit, WHITE, 255) != picture_of(lit, unlit, 255));
}

/// The corners of a triangle lie up to 4.4 sides of its texture apart: 2,250 texels, or 4,500, which is too many.
#[test]
fn what_stretches_over_too_many_texels_is_told_of_its_block() {
    let mut memory = vec![0; 2048];
    let mut writer = ListWriter::new(&mut memory);
    let mut at = Vec::new();
    for log_width in [9, 10, 10] {
        let block = lists::texture(TexelForm::Rgb565, 1);
        let block = TextureBlock {
            log_width,
            log_height: 0,
            ..block
        };
        writer
            .bulk(&State::Texture(block), &vec![0; 1 << (log_width - 1)])
            .unwrap();
        at.push(4 * lists::draw_textured(&mut writer));
    }
    writer.flow(Flow::End).unwrap();
    let list = writer.words();
    let mut notices: Vec<Notice> = Vec::new();
    let mut kept = Kept::new(64, 96);
    drawn::<Textured<Rgb565Be>>(|scene| {
        let mut player = kept.player::<Textured<Rgb565Be>>(PlayerSettings::default());
        player.start(0);
        let mut budget = PLENTY;
        let tell = &mut |n: Notice| notices.push(n);
        assert_eq!(player.run(list, scene, &mut budget, tell), Ok(Halt::End));
    });
    let told = of(Event::Untextured, &notices);
    assert_eq!(told, [(at[1], 1), (at[2], 1)]);
}

/// Kills: triangles whose places on a texture find no room, and that nobody tells.
#[test]
fn what_has_no_room_for_its_places_is_told_of_its_block() {
    let mut memory = vec![0; 256];
    let mut writer = ListWriter::new(&mut memory);
    let block = lists::texture(TexelForm::Rgb565, 1);
    writer.bulk(&State::Texture(block), &[0; 8]).unwrap();
    let at = 4 * lists::draw_textured(&mut writer);
    writer.flow(Flow::End).unwrap();
    let list = writer.words();
    let camera = Camera::look_at([0.0, 0.0, 4.0], [0.0; 3], [0.0, 1.0, 0.0], 60.0, 0.5, 9.0);
    for (places, lost) in [(0, vec![(at, 1)]), (3, vec![])] {
        let room = Room {
            vertices: 99,
            places,
            objects: 9,
            draws: 9,
        };
        let mut kept = Kept::new(64, 96);
        let mut notices: Vec<Notice> = Vec::new();
        let screen = Screen::new(96, 72).unwrap();
        picture(screen, room, 0, |scene: &mut Scene<'_, '_, _>| {
            scene.begin(&camera.unwrap())?;
            let mut player = kept.player::<Textured<Rgb565Be>>(PlayerSettings::default());
            player.start(0);
            let tell = &mut |n: Notice| notices.push(n);
            let halt = player.run(list, scene, &mut PLENTY.clone(), tell);
            assert_eq!(halt, Ok(Halt::End));
            Ok(())
        })
        .unwrap();
        assert_eq!(of(Event::Full, &notices), lost, "{places}");
    }
}
