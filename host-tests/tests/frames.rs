//! What the small frames that the firmware draws have to show, to compare anything (X1, X2).

use host_tests::frames::values_sent;
use host_tests::say;
use scenes::{VALUES, Values};
use std::collections::BTreeSet;

/// What few draw calls have: each frame has it, whatever the number of slots.
#[test]
fn frames_of_values_are_full_of_colours_and_the_same_with_any_slots() {
    let mut pictures = BTreeSet::new();
    for (name, values) in VALUES {
        let sent = values_sent(values, 64).unwrap();
        let colours: BTreeSet<u16> = sent.shown.iter().copied().collect();
        // Without shading a call has one colour.
        let least = if values == Values::Master { 2 } else { 20 };
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
