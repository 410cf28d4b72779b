//! Numbers that a block cannot have are refused, and named with the word that they stand in (H13).

use crate::listing::ring_memory;
use host_tests::lists::writer::ListWriter;
use scanbeam::list::*;

/// A block of a list on its own, as words.
fn block(state: &State, data: &[u32]) -> Vec<u32> {
    let mut memory = [0; 1024];
    let mut writer = ListWriter::new(&mut memory);
    match data {
        [] => writer.state(state).unwrap(),
        data => writer.bulk(state, data).unwrap(),
    }
    writer.words().to_vec()
}

/// With one word replaced: what is let in, and what is refused with that word and its value.
fn replaced(block: &[u32], word: usize, good: &[u32], bad: &[u32]) {
    for (values, is_good) in [(good, true), (bad, false)] {
        for &value in values {
            let mut list = block.to_vec();
            list[word] = value;
            let read = read_block(&list[..], 0, &VertexFormat::default());
            let reason = read.map(|_| ()).map_err(|error| error.reason);
            let refused = Reason::Value {
                word: word as u32,
                value,
            };
            let want = if is_good { Ok(()) } else { Err(refused) };
            assert_eq!(reason, want, "word {word}: {value:#x} in {block:x?}");
        }
    }
}

/// Two halves of a word, the lower one first.
fn halves(low: i16, high: i16) -> u32 {
    u32::from(low as u16) | u32::from(high as u16) << 16
}

const MATRIX: Matrix = Matrix {
    linear: [0; 9],
    linear_exponent: 0,
    offset: [0; 3],
    offset_exponent: 0,
};

const CAMERA: CameraWords = CameraWords {
    eye: [0.0; 3],
    at: [0.0; 3],
    up: [0.0; 3],
    focal: 1.0,
    near: 1.0,
    far: 1.0,
};

/// A palette of so many colours.
fn palette(count: u16) -> Palette {
    Palette {
        number: 0,
        count,
        at: 0,
    }
}

/// An overlay of one line of so many texels.
fn overlay(width: u16) -> Overlay {
    Overlay {
        left: 0,
        top: 0,
        width,
        height: 1,
        form: TexelForm::Rgb565,
        additive: false,
        palette: 0,
        at: 0,
    }
}

/// What a head begins with.
const CONE: Cone = Cone {
    apex: [1, -2, 1 << 30],
    axis: [-3, 4, 1 << 14],
    spread: 5,
    words: 0,
};

const MARK: u32 = u32::from_le_bytes(*b"SCBL");

const MOST: i32 = (1 << 30) - 1;

/// Kills: each limit of `reader.rs` one off, or not asked for: the mark of a head, mantissas of more than 30 bits,
/// exponents, a negative radius, ambient light above 1.
#[test]
fn numbers_of_space_and_light_have_limits() {
    let head = block(&State::Head(Head::default()), &[]);
    replaced(&head, 1, &[MARK], &[0, MARK + 1, MARK.swap_bytes()]);
    let matrix = block(&State::Matrix(MATRIX), &[]);
    let (good, bad) = ([MOST, -MOST], [MOST + 1, -MOST - 1, i32::MIN, i32::MAX]);
    let (good, bad) = (good.map(|m| m as u32), bad.map(|m| m as u32));
    for word in (1..=9).chain(11..=13) {
        replaced(&matrix, word, &good, &bad);
    }
    let good = [halves(-128, 96), halves(96, -128)];
    let bad = [
        halves(-129, 0),
        halves(97, 0),
        halves(0, -129),
        halves(0, 97),
    ];
    replaced(&matrix, 10, &good, &bad);
    let bounds = Bounds {
        centre: [0; 3],
        radius: 1,
        exponent: 0,
        words: 0,
    };
    let bounds = block(&State::Bounds(bounds), &[]);
    replaced(&bounds, 4, &[0, MOST as u32], &[-1i32 as u32, 1 << 30]);
    let bad = [-129i32, 97, 1 << 16, i32::MIN].map(|exponent| exponent as u32);
    replaced(&bounds, 5, &[96, -128i32 as u32], &bad);
    let cone = block(&State::Cone(CONE), &[]);
    for word in 1..=5 {
        replaced(&cone, word, &[0, u32::MAX, 1 << 31], &[]);
    }
    // It reads as it was written.
    let read = read_block(&cone[..], 0, &VertexFormat::default());
    assert_eq!(
        read.unwrap().instruction,
        Instruction::State(State::Cone(CONE))
    );
    let light = LightWords {
        direction: [0, 0, 1 << 14],
        ambient: 0,
        colour: [255; 3],
    };
    let light = block(&State::Light { number: 0, light }, &[]);
    replaced(&light, 2, &[1 << 31], &[1 << 31 | 1 << 16, u32::MAX]);
    replaced(&light, 3, &[0xFF_FFFF], &[1 << 24, 1 << 31]);
}

/// Kills: floats that are no numbers, windows without a column or a line, and bits that nothing has.
#[test]
fn cameras_windows_and_materials_have_limits() {
    let camera = block(&State::Camera(CAMERA), &[]);
    let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY].map(f32::to_bits);
    for word in 1..=12 {
        replaced(&camera, word, &[f32::MAX.to_bits()], &bad);
    }
    let window = Window {
        left: 5,
        top: 7,
        right: 10,
        bottom: 10,
    };
    let window = block(&State::Window(window), &[]);
    let bad = [halves(5, 8), halves(6, 7), halves(4, 8), halves(6, 6), 0];
    replaced(&window, 2, &[halves(6, 8)], &bad);
    let material = Material {
        diffuse: [0; 3],
        opacity: 0,
        specular: [0; 3],
        exponent: 0,
        two_sided: false,
        unlit: false,
        texture: None,
    };
    let material = block(&State::Material(material), &[]);
    // A number of a texture where there is one alone.
    replaced(
        &material,
        3,
        &[0, 3, 4, 0xFF07],
        &[8, 0x80, 1 << 16, 1 << 31, 0x100, 0x8003],
    );
}

/// Kills: sides, forms and lengths that a texture, a palette or an overlay cannot have.
#[test]
fn what_has_texels_has_limits() {
    let texture = Texture {
        number: 0,
        log_width: 1,
        log_height: 1,
        form: TexelForm::Rgb565,
        levels: 1,
        palette: 0,
        clamped: false,
        at: 0,
    };
    let words = texture.words();
    let block_of = block(&State::Texture(texture), &vec![0; words as usize]);
    let first = block_of[1];
    let bad = [
        first | 11,
        first | 11 << 4,
        first | 15 << 8,
        first | 1 << 14,
        first | 1 << 25,
    ];
    replaced(
        &block_of,
        1,
        &[first, first | 1 << 24, first | 0xFF << 16],
        &bad,
    );
    replaced(&block_of, 2, &[words], &[0, words - 1, words + 1]);
    for (log_width, log_height) in [(10, 0), (0, 10)] {
        let longest = Texture {
            log_width,
            log_height,
            ..texture
        };
        let data = vec![0; longest.words() as usize];
        let block_of = block(&State::Texture(longest), &data);
        replaced(
            &block_of,
            1,
            &[block_of[1]],
            &[block_of[1] | 15, block_of[1] | 15 << 4],
        );
    }
    let palette = palette(2);
    let palette = block(&State::Palette(palette), &[0; 2]);
    replaced(&palette, 1, &[1, 2], &[0, 257, u32::MAX]);
    let overlay = overlay(2);
    let overlay = block(&State::Overlay(overlay), &[0]);
    let bad = [halves(0, 1), halves(1, 0), halves(1025, 1), halves(1, 1025)];
    replaced(&overlay, 2, &[halves(1, 1), halves(2, 1)], &bad);
    let flags = overlay[3];
    let good = [flags, flags | 1 << 4, flags | 0xFF << 8];
    replaced(
        &overlay,
        3,
        &good,
        &[flags | 15, flags | 1 << 5, flags | 1 << 16],
    );
}

/// Kills: a length that is not asked for before words are read.
#[test]
fn what_ends_within_a_block_is_refused_with_its_length() {
    let light = LightWords {
        direction: [0; 3],
        ambient: 0,
        colour: [0; 3],
    };
    let window = Window {
        left: 0,
        top: 0,
        right: 1,
        bottom: 1,
    };
    let bounds = Bounds {
        centre: [0; 3],
        radius: 0,
        exponent: 0,
        words: 0,
    };
    let states = [
        (State::Head(Head::default()), 5),
        (State::Matrix(MATRIX), 14),
        (State::Light { number: 0, light }, 4),
        (State::Camera(CAMERA), 13),
        (State::Window(window), 3),
        (State::Bounds(bounds), 7),
        (State::Cone(CONE), 7),
    ];
    for (state, need) in states {
        let list = block(&state, &[]);
        assert_eq!(list.len(), need, "{state:?}");
        for have in 1..need {
            cut(&list, have, need);
        }
    }
    let palette = palette(3);
    let texture = Texture {
        number: 0,
        log_width: 2,
        log_height: 0,
        form: TexelForm::Rgb565,
        levels: 1,
        palette: 0,
        clamped: false,
        at: 0,
    };
    let overlay = overlay(4);
    // Their lengths are known once their first words are there.
    let known = [
        (State::Palette(palette), 2, 3),
        (State::Texture(texture), 3, 2),
        (State::Overlay(overlay), 4, 2),
    ];
    for (state, first, data) in known {
        let list = block(&state, &[0; 3][..data]);
        assert_eq!(list.len(), first + data, "{state:?}");
        for have in 1..list.len() {
            let need = if have < first { first } else { list.len() };
            cut(&list, have, need);
        }
    }
}

/// A list that ends within its only block.
fn cut(list: &[u32], have: usize, need: usize) {
    let read = read_block(&list[..have], 0, &VertexFormat::default());
    let reason = read.map(|_| ()).map_err(|error| error.reason);
    let (need, have) = (need as u32, have as u32);
    assert_eq!(reason, Err(Reason::Truncated { need, have }), "{list:x?}");
}

/// A block that is longer than its ring will never be there; of one that is shorter the rest may come.
///
/// Kills: rings are taken for larger than they are.
#[test]
fn blocks_longer_than_their_ring_are_refused() {
    let matrix = block(&State::Matrix(MATRIX), &[]);
    let need = matrix.len() as u32;
    for room in [8, 16, 32] {
        let mut memory = ring_memory(room);
        let mut ring = ListRing::new(&mut memory);
        let (mut writer, reader) = ring.split();
        let read = || {
            let read = read_block(reader.words(), 0, &VertexFormat::default());
            read.map(|_| ()).map_err(|error| error.reason)
        };
        writer.append(&matrix[..8]).unwrap();
        let want = match need > room {
            true => Reason::TooLong { need, room },
            false => Reason::Truncated { need, have: 8 },
        };
        assert_eq!(read(), Err(want));
        match writer.append(&matrix[8..]) {
            Ok(()) => assert_eq!(read(), Ok(())),
            Err(full) => assert_eq!((full.need, full.free), (need - 8, 0)),
        }
    }
}

/// Kills: a block without its word that switches something off.
#[test]
fn what_a_master_block_does_not_say_is_off() {
    for words in [&[0][..], &[0x5A], &[0x5A, 7]] {
        let count = if words == [0] { 0 } else { words.len() as u16 };
        let mut list = vec![Header::of(Id::Master, count).to_word()];
        list.extend(&words[..usize::from(count)]);
        let read = read_block(&list[..], 0, &VertexFormat::default()).unwrap();
        assert_eq!(read.instruction, Instruction::Master(words[0]));
        assert_eq!(read.words, 1 + u32::from(count));
    }
}

/// Kills: of parted triangles, those that are not whole are let in, or those that go on from other blocks.
#[test]
fn parted_triangles_are_whole_and_begin_anew() {
    let whole = Header {
        new: true,
        low: Header::SEPARATE,
        ..Header::of(Id::Indexed, 6)
    };
    let read = |header: Header| {
        let list = [header.to_word().to_le(), 0, 0];
        let read = read_block(&list[..], 0, &VertexFormat::default());
        read.map(|_| ()).map_err(|error| error.reason)
    };
    assert_eq!(read(whole), Ok(()));
    for (header, reason) in [
        (Header { count: 4, ..whole }, Some(4)),
        (Header { count: 5, ..whole }, Some(5)),
        (Header { rm: true, ..whole }, None),
        (
            Header {
                new: false,
                ..whole
            },
            None,
        ),
    ] {
        let want = match reason {
            Some(count) => Reason::Count(count),
            None => Reason::Reserved(header.to_word()),
        };
        assert_eq!(read(header), Err(want), "{header:?}");
    }
}

/// Kills: points without a size.
#[test]
fn points_have_a_size() {
    for (size, is_good) in [(0, false), (1, true), (255, true)] {
        let list = block(&State::PointSize(size), &[]);
        let read = read_block(&list[..], 0, &VertexFormat::default());
        let is_refused = read.is_err_and(|error| matches!(error.reason, Reason::Count(_)));
        assert_eq!(is_refused, !is_good, "{size}");
    }
}
