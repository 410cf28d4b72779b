//! Any bytes: no panic, no hang, bounded work (X7). What `fuzz/src/list.rs` does for as
//! long as it is let, done here for a while, on random words and on damaged lists.

use crate::common::Rng;
use crate::fuzz::list::play;
use host_tests::lists::print;
use host_tests::lists::writer::{Form, ListWriter};
use scanbeam::list::{
    Bounds, CameraWords, Cone, Field, FieldForm, Flow, Head, Header, Id, LightWords, Material,
    Matrix, Overlay, Palette, State, TexelForm, Texture, VertexFormat, Window,
};

#[test]
fn random_words_do_no_harm() {
    let mut rng = Rng::new(1);
    let mut words = 0;
    for _ in 0..100_000 {
        let list: Vec<u32> = (0..rng.below(60))
            .map(|_| {
                let word = rng.below(1 << 16) << 16 | rng.below(1 << 16);
                match rng.below(3) {
                    // Often a header that can be read, of few elements.
                    0 => (word & 0xF000_03F8 | 1 << 24) & !(rng.below(2) * 0xF8),
                    1 => rng.below(40),
                    _ => word,
                }
            })
            .collect();
        words += play(&list).good;
    }
    assert!(words > 10_000, "{words} words of good blocks");
}

/// State of every kind that is not about vertices and textures.
fn valid_state(rng: &mut Rng, writer: &mut ListWriter<'_>) {
    for number in [0, 5] {
        let light = LightWords {
            direction: [0; 3].map(|_: i16| rng.within(-16_384, 16_384) as i16),
            ambient: 3000,
            colour: [255, 200, 90],
        };
        writer.state(&State::Light { number, light }).unwrap();
    }
    writer.state(&State::LightOff { number: 1 }).unwrap();
    let camera = CameraWords {
        eye: [0.0, 0.5, 4.0],
        at: [0.0; 3],
        up: [0.0, 1.0, 0.0],
        focal: 300.0,
        near: 0.1,
        far: 90.0,
    };
    writer.state(&State::Camera(camera)).unwrap();
    let window = Window {
        left: 0,
        top: 0,
        right: 40,
        bottom: 30,
    };
    writer.state(&State::Window(window)).unwrap();
    for (form, additive) in [(TexelForm::Index2, true), (TexelForm::Rgb565, false)] {
        let overlay = Overlay {
            left: 30,
            top: 0,
            width: 5,
            height: 3,
            form,
            additive,
            palette: 2,
            at: 0,
        };
        let pixels: Vec<u32> = (0..overlay.words())
            .map(|_| rng.below(1 << 16) << 16)
            .collect();
        writer.bulk(&State::Overlay(overlay), &pixels).unwrap();
    }
}

/// Flow of every kind, but for the end, and what is passed over.
fn valid_flow(writer: &mut ListWriter<'_>) {
    writer.flow(Flow::Pause).unwrap();
    writer.flow(Flow::Interrupt(9)).unwrap();
    writer.flow(Flow::JumpRelative(2)).unwrap();
    writer.master(7).unwrap();
    let next = writer.position() + 2;
    writer.flow(Flow::Jump(next)).unwrap();
    writer.flow(Flow::Sync).unwrap();
}

/// A valid list of some of everything there is.
fn valid(rng: &mut Rng) -> Vec<u32> {
    let mut memory = vec![0; 1024];
    let mut writer = ListWriter::new(&mut memory);
    writer.state(&State::Head(Head::default())).unwrap();
    let forms = [FieldForm::S16x3, FieldForm::S10x3, FieldForm::S8x3];
    let format = VertexFormat::new(&[
        Field {
            parameter: Field::PLACE,
            form: rng.pick(&forms),
        },
        Field {
            parameter: Field::NORMAL,
            form: rng.pick(&forms),
        },
        Field {
            parameter: Field::DIFFUSE,
            form: FieldForm::U8x3,
        },
        Field {
            parameter: Field::TEXTURE,
            form: FieldForm::U16x2,
        },
    ])
    .unwrap();
    writer.state(&State::Format(format)).unwrap();
    let bounds = Bounds {
        centre: [0; 3],
        radius: 1 << 29,
        exponent: 1,
        words: 14,
    };
    writer.state(&State::Bounds(bounds)).unwrap();
    writer.state(&State::Matrix(Matrix::IDENTITY)).unwrap();
    let cone = Cone {
        apex: [0; 3],
        axis: [0, 0, 1 << 14],
        spread: 1 << 15,
        words: 0,
    };
    writer.state(&State::Cone(cone)).unwrap();
    let texture = Texture {
        number: 1,
        log_width: 2,
        log_height: 2,
        form: TexelForm::Index4,
        levels: 1,
        palette: 2,
        clamped: false,
        at: 0,
    };
    let at = writer.position();
    writer
        .bulk(&State::Texture(texture), &[0x1234_5678; 2])
        .unwrap();
    let palette = Palette {
        number: 2,
        count: 6,
        at: 0,
    };
    writer
        .bulk(&State::Palette(palette), &[0x00AA_55FF; 6])
        .unwrap();
    writer.flow(Flow::LoadTexture { number: 3, at }).unwrap();
    valid_state(rng, &mut writer);
    let material = Material {
        texture: Some(3),
        specular: [90, 255, 255],
        exponent: 20,
        two_sided: true,
        ..Material::default()
    };
    writer.state(&State::Material(material)).unwrap();
    writer.state(&State::PointSize(5)).unwrap();
    for id in [Id::Short, Id::Long, Id::Points, Id::Quads, Id::Table] {
        let strip = !matches!(id, Id::Table | Id::Points);
        let header = Header {
            shade: true,
            text: true,
            new: strip,
            rm: id == Id::Short,
            ..Header::of(id, 8)
        };
        let words = match id {
            Id::Table => format.table_words(header, 8),
            Id::Long => 8 * 3,
            _ => 8 * format.words(header),
        };
        let data: Vec<u32> = (0..words)
            .map(|_| rng.below(1 << 16) << 16 | rng.below(1 << 16))
            .collect();
        writer.vertices(header, &data).unwrap();
    }
    let indices: Vec<_> = (0..12).map(|_| Some(rng.below(8) as u16)).collect();
    writer.indexed(None, false, indices.into_iter()).unwrap();
    valid_flow(&mut writer);
    let strips = [Some(1), Some(2), Some(3), None, Some(4), Some(5), Some(6)];
    let strips = strips.into_iter();
    writer.indexed(Some(Form::Fan), true, strips).unwrap();
    writer.flow(Flow::End).unwrap();
    let head = Head {
        words: writer.position() + 2,
        table: 8,
        triangles: 30,
    };
    writer.rewrite(0, &State::Head(head)).unwrap();
    // A block of a later version, before the end.
    let mut list = writer.words().to_vec();
    let end = list.pop();
    list.extend([0x9100_0100u32.to_le(), 5]);
    list.extend(end);
    list
}

/// The list with a head that says it has no words.
fn headless(list: &[u32]) -> Vec<u32> {
    let mut open = list.to_vec();
    open[2] = 0;
    open
}

#[test]
fn every_cut_and_every_flipped_bit_is_survived() {
    let mut rng = Rng::new(2);
    for _ in 0..3 {
        let list = valid(&mut rng);
        assert!(play(&list).ended, "undamaged it comes to its end");
        // With a head that does not say how long it is, a cut is noticed only where it is.
        let open = headless(&list);
        for len in 0..list.len() {
            play(&open[..len]);
            assert!(len == 0 || !play(&list[..len]).ended);
        }
        for bit in 0..32 * list.len() {
            let mut list = list.clone();
            list[bit / 32] ^= 1 << (bit % 32);
            play(&list);
        }
    }
}

#[test]
fn every_kind_of_block_is_printed_and_drawn() {
    let list = headless(&valid(&mut Rng::new(9)));
    let (text, error) = print::listing(&list);
    assert_eq!(error, None);
    for part in [
        "Head",
        "format:",
        "Matrix",
        "Light ",
        "LightOff",
        "Material",
        "Camera",
        "Window",
        "Texture",
        "Palette",
        "Overlay",
        "Bounds",
        "Cone",
        "PointSize",
        "Pause",
        "Sync",
        "Interrupt(9)",
        "LoadTexture",
        "jump by 2 words to",
        "jump to",
        "MASTER",
        "later version",
        "SHORT  8 shade text new fan",
        "LONG  8 shade",
        "POINTS  8",
        "QUADS  8",
        "TABLE  8",
        "INDEXED  12 separate",
        "INDEXED  7 new fan wide",
        "FLOW  End",
    ] {
        assert!(text.contains(part), "{part}:\n{text}");
    }
    // Cut anywhere, what stands before is printed and the place of the fault is told.
    let (mut last, mut refused) = (0, 0);
    for len in 1..list.len() {
        let (part, error) = print::listing(&list[..len]);
        assert!(text.starts_with(&part) && last <= part.len() && part.len() < text.len());
        last = part.len();
        if let Some(error) = error {
            assert!(
                error.contains("offset 0x") && error.contains("words are needed"),
                "{error}"
            );
            refused += 1;
        }
    }
    assert!(refused > list.len() / 2);
}
