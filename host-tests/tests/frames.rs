//! What the small frames that the firmware draws have to show, to compare anything (X1, X2).

use host_tests::frames::{Drawn, bytes_in_format, shot_frame, suite_frame, values_sent};
use host_tests::say;
use scanbeam::event::Event;
use scanbeam::pixel::{PixelFormat, Rgb565, Rgb565Be, Rgb888, Xrgb8888};
use scanbeam::scene::Shading;
use scenes::{InFormat, Shot, Suite, VALUES, Values};
use std::collections::BTreeSet;

/// What few draw calls have: each frame has it, whatever the number of slots.
#[test]
fn frames_of_values_are_full_of_colours_and_the_same_with_any_slots() {
    let mut pictures = BTreeSet::new();
    for (name, values) in VALUES {
        let sent = values_sent(values, 64).unwrap();
        let colours: BTreeSet<u16> = sent.shown.iter().copied().collect();
        let least = match values {
            // Without shading a call has one colour.
            Values::Master => 2,
            // Yes, no, and three answers.
            Values::Told => 5,
            _ => 20,
        };
        assert!(colours.len() > least, "{name}: {}", colours.len());
        for slots in [0, 5] {
            let few = values_sent(values, slots).unwrap();
            assert!(few.words == sent.words, "{name} with {slots} slots");
        }
        assert!(pictures.insert(sent.words), "{name} is another's");
    }
}

/// Lines, or cells of lines, that change are all that is sent, and the display shows the whole picture.
#[test]
fn of_a_second_frame_what_changes_is_sent_alone() {
    let [lines, runs] =
        [Values::Lines, Values::Runs].map(|values| values_sent(values, 64).unwrap());
    assert!(lines.shown == runs.shown);
    let (first, more) = lines.words.split_at(lines.shown.len());
    // The second frame as a whole: lines of it that came, or had been there.
    let width = usize::from(scenes::VALUES_WIDTH);
    let changed = first.chunks(width).zip(lines.shown.chunks(width));
    let changed: Vec<u16> = changed
        .filter(|(before, after)| before != after)
        .flat_map(|(_, after)| after.to_vec())
        .collect();
    assert!(!changed.is_empty() && changed.len() < first.len() / 2);
    assert!(more == changed);
    let pixels = first.iter().zip(&lines.shown).filter(|(a, b)| a != b);
    let (pixels, cells) = (pixels.count(), runs.words.len() - first.len());
    say!(
        "{pixels} pixels change: {} sent in lines, {cells} in cells",
        more.len()
    );
    assert!((pixels..more.len() / 2).contains(&cells));
}

/// A square's colour, of a picture of answers.
fn square(picture: &[u16], number: usize) -> [u8; 3] {
    let (column, row) = (number % 8, number / 8);
    let at = usize::from(scenes::VALUES_WIDTH) * (17 + 17 * row) + 19 + 17 * column;
    Rgb565Be::to_rgb8(picture[at])
}

/// What is told as squares has been told: damaged lists come to different ends, the frame of their squares had pixels and
/// no other event, a list halted, and queues were full.
///
/// Kills: damages that are none, events of no frame, queues that are never full.
#[test]
fn answers_are_many_and_those_that_are_known_are_right() {
    let sent = values_sent(Values::Told, 64).unwrap();
    let (first, second) = sent.words.split_at(sent.shown.len());
    let damaged: BTreeSet<_> = (0..48).map(|number| square(first, number)).collect();
    say!("{} ends of 48 damaged lists", damaged.len());
    assert!(damaged.len() > 15);
    let told = |number: usize| square(second, number);
    for (number, event) in Event::ALL.into_iter().enumerate() {
        let white = [u8::from(event == Event::PixelRendered) * 255; 3];
        assert_eq!(told(number), white, "{event:?}");
    }
    let [stalls, halts, lines] = [40, 41, 42].map(told);
    assert!(stalls[0] > 0 && stalls[1..] == [0; 2], "{stalls:?}");
    assert!(halts != [0; 3] && lines != [0; 3]);
}

/// The levels of a scene whose pixels are words of `N` bytes.
fn levels_in<const N: usize>(format: InFormat, levels: fn([u8; N]) -> [u8; 3]) -> Vec<[u8; 3]> {
    let bytes = bytes_in_format(format).unwrap();
    let words = bytes.chunks(N).map(|word| word.try_into().unwrap());
    words.map(levels).collect()
}

/// Words of 24 bits hold what bytes do; grey is what the weights make of numbers, but for a step of each.
#[test]
fn formats_show_the_same_scenes() {
    let bytes = levels_in(InFormat::LitBytes, Rgb888::to_rgb8);
    let colours: BTreeSet<_> = bytes.iter().collect();
    assert!(colours.len() > 5_000, "{}", colours.len());
    let words = |word| Xrgb8888::to_rgb8(u32::from_ne_bytes(word));
    assert!(bytes == levels_in(InFormat::LitWords, words));

    let numbers = levels_in(InFormat::Numbers, |word| {
        Rgb565::to_rgb8(u16::from_ne_bytes(word))
    });
    let grey = levels_in(InFormat::Grey, |[level]| [level; 3]);
    let mut most = 0;
    for ([r, g, b], [level, ..]) in numbers.iter().map(|rgb| rgb.map(u32::from)).zip(&grey) {
        let of_numbers = (77 * r + 150 * g + 29 * b + 128) >> 8;
        most = most.max(of_numbers.abs_diff(u32::from(*level)));
    }
    say!("grey is up to {most} levels off that of RGB565");
    let levels: BTreeSet<_> = grey.iter().collect();
    assert!(levels.len() > 50 && most <= 8, "{} levels", levels.len());
}

/// The levels of what an SPI panel gets.
fn sent(drawn: Drawn) -> impl Iterator<Item = [u8; 3]> {
    drawn.words.into_iter().map(Rgb565Be::to_rgb8)
}

/// Numbers are what an SPI panel gets, of flat faces that are filled in pairs.
///
/// Kills: numbers whose bytes are swapped as those of a panel are.
#[test]
fn numbers_are_what_an_spi_panel_gets() {
    let faces = sent(suite_frame(Suite::NearToFar).unwrap());
    let numbers = levels_in(InFormat::SuiteNumbers(Suite::NearToFar), |word| {
        Rgb565::to_rgb8(u16::from_ne_bytes(word))
    });
    assert!(faces.eq(numbers));
}

/// Bytes are what an SPI panel gets, but for what five and six bits lose, of triangles that are too thin for planes too.
///
/// Kills: bytes of whole words that begin with red, whichever channel is next.
#[test]
fn bytes_are_what_an_spi_panel_gets_of_thin_triangles() {
    let slivers = sent(shot_frame(Shot::Slivers, Shading::Smooth).unwrap());
    let bytes = levels_in(InFormat::Slivers, Rgb888::to_rgb8);
    let colours: BTreeSet<_> = bytes.iter().collect();
    let pairs = slivers.zip(&bytes);
    let most = pairs.flat_map(|(a, b)| [0, 1, 2].map(|i| a[i].abs_diff(b[i])));
    let most = most.max().unwrap();
    say!("{} colours, up to {most} levels apart", colours.len());
    assert!(colours.len() > 500 && most <= 8, "{most}");
}
