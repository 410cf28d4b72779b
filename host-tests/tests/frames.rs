//! What the frames of methods, effects and values that the firmware draws have to show, to compare anything (X1, X2).

use host_tests::frames::{effect_frames, method_frames, values_sent};
use host_tests::say;
use scanbeam::pipeline::Quality;
use scenes::{VALUES, Values};
use std::collections::BTreeSet;

/// A frame that does not tell methods apart compares nothing.
#[test]
fn the_frame_tells_methods_apart() {
    let frames = method_frames().unwrap();
    for (name, words) in &frames {
        let colours: BTreeSet<u16> = words.iter().copied().collect();
        assert!(colours.len() > 200, "{name}: {}", colours.len());
    }
    let different: BTreeSet<&Vec<u16>> = frames.iter().map(|(_, words)| words).collect();
    // Wide LIRP, and exact planes however they are chosen, may agree.
    assert!(different.len() >= 8, "{}", different.len());
}

/// QEMU draws the same bits, so what holds here holds there (X1, X2).
#[test]
fn what_auto_chooses_keeps_its_budget_beside_planes() {
    let frames = method_frames().unwrap();
    let of = |name: &str| &frames.iter().find(|frame| frame.0 == name).unwrap().1;
    let planes = of("method_plane");
    assert_eq!(of("method_auto_exact"), planes);
    for (name, quality) in [
        ("method_auto_fast", Quality::fast()),
        ("method_auto_balanced", Quality::balanced()),
    ] {
        let (mut worst, mut differ) = (0.0f64, 0);
        for (shown, plane) in of(name).iter().zip(planes) {
            differ += u32::from(shown != plane);
            let [shown, plane] = [shown, plane].map(|word| {
                let word = u16::from_be(*word);
                [word >> 11, word >> 5 & 63, word & 31]
            });
            for (channel, steps) in [31.0, 63.0, 31.0].into_iter().enumerate() {
                let steps_off = f64::from(shown[channel].abs_diff(plane[channel]));
                // Either is rounded by half a step.
                worst = worst.max((steps_off - 1.0) * 255.0 / steps);
            }
        }
        say!("{name}: {differ} pixels differ, by {worst:.2} levels beyond rounding");
        let budget: f64 = quality.levels.to_num();
        assert!(differ > 0 && worst <= budget, "{name}: {worst}");
    }
}

#[test]
fn frames_are_full_of_colours_and_the_same_with_any_cache() {
    let frames = effect_frames(64).unwrap();
    for (name, words) in &frames {
        let colours: BTreeSet<u16> = words.iter().copied().collect();
        // Sides of cubes have one colour each, lit or in shadow.
        let least = if *name == "effect_shadows" { 6 } else { 25 };
        assert!(colours.len() > least, "{name}: {}", colours.len());
    }
    assert!(effect_frames(0).unwrap() == frames);
    assert!(effect_frames(5).unwrap() == frames);
}

/// What few draw calls have in the rooms: each frame has it, whatever the number of slots.
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
