//! Lists on boards.

use super::*;

/// Kills: a list that is cut off or does not end and is drawn as far as it goes, errors of lists without their place, a
/// player that is lent as much as before, and overlays that are left out.
#[test]
fn lists_that_boards_cannot_draw_are_refused() -> Tried {
    let list = host_tests::lists::read_list(&example("scenes/crate.list"))?;
    let refused = |list: &[u32]| {
        let done = settle(&mut list::words(list), &[]);
        done.map(|_| ()).expect_err("it is refused").to_string()
    };
    for length in [1, 5, list.len() / 2, list.len() - 1] {
        let said = refused(&list[..length]);
        let told = ["halted at offset", "list: offset"];
        assert!(
            told.iter().any(|words| said.contains(words)),
            "{length}: {said}"
        );
    }
    // A JUMP to itself, which no budget sees the end of.
    let round = [1 << 24 | 5 << 16, 0];
    assert!(refused(&round).contains("halted at offset 0x0"));
    // OVERLAY of 1 x 1 pixels of 16 bits, and END.
    let overlay = [
        7 << 28 | 1 << 24 | 10 << 16,
        0,
        1 | 1 << 16,
        5,
        0xF800,
        1 << 24,
    ];
    assert_eq!(refused(&overlay), "overlays, which boards do not draw");
    // With too little for its textures at first.
    let mut words = list::words(&list);
    let (head, mut reader) = scene_flash::Head::read(&words)?;
    let given = scene_flash::List::read(&mut reader)?;
    let mut room = given.room;
    (room.textures, room.texels, room.levels) = (1, 1, 0);
    let tight = scene_flash::List { room, ..given }.to_words();
    let from = scene_flash::Head::WORDS;
    words[from..from + tight.len()].copy_from_slice(&tight);
    let shown = settle(&mut words, &[])?;
    assert_eq!(shown.head.kind, head.kind);
    let mut roomy = list::words(&list);
    assert!(settle(&mut roomy, &[])?.pixels == shown.pixels);
    Ok(())
}

/// Kills: a list that is looked at in each frame.
#[test]
fn lists_are_drawn_on_boards_and_their_lines_are_measured() -> Tried {
    let passes = drawn_on("scenes/teapot.list", Kind::ListSmooth, &[M4])?;
    // It was looked at once, before: that takes 87,000 more.
    assert!(passes[0] < 400_000, "{passes:?}");
    drawn_on("scenes/crate.list", Kind::ListTextured, &[M4])?;
    Ok(())
}
