//! The screen of a terminal.

use host_tests::view::screen::*;

#[test]
fn text_breaks_between_its_parts() {
    assert_eq!(broken("a b  c d  e", "  ", 80), ["a b  c d  e"]);
    assert_eq!(broken("a b  c d  e", "  ", 8), ["a b  c d", "e"]);
    assert_eq!(broken("a b  c d  e", "  ", 4), ["a b", "c d", "e"]);
    assert_eq!(broken("long, x", ", ", 3), ["lon", "x"]);
}

#[test]
fn the_picture_has_what_the_text_leaves() {
    let mut screen = Screen::default();
    screen.set_size(10, 12);
    let keys = ("one  two  three", "  ");
    assert_eq!(screen.text(&[("1, 2", ", "), keys]).len(), 3);
    assert_eq!(screen.left(), (10, 9));
    // Shorter text leaves the picture as it is, until the size changes.
    assert_eq!(screen.text(&[keys]).len(), 2);
    assert_eq!(screen.left(), (10, 9));
    screen.set_size(30, 12);
    screen.text(&[keys]);
    assert_eq!(screen.left(), (30, 11));
    // The keys are the last to go.
    screen.set_size(10, 5);
    assert_eq!(screen.text(&[("1, 2", ", "), keys]), ["one  two", "three"]);
    screen.set_size(10, 3);
    assert_eq!(screen.text(&[("1, 2", ", "), keys]), ["one  two"]);
    screen.set_size(0, 0);
    assert!(screen.text(&[keys]).is_empty());
    assert_eq!(screen.left(), (1, 1));
}

#[test]
fn only_what_changed_is_sent() {
    let mut screen = Screen::default();
    screen.set_size(4, 3);
    let mut sent = |first: &str, last: &str| {
        let mut out = Vec::new();
        let picture = vec![format!("\x1b[m{first}"), "\x1b[mrow".to_owned()];
        screen.show(&mut out, picture, vec![last.into()]).unwrap();
        String::from_utf8(out).unwrap()
    };
    let first = sent("one", "text");
    assert!(first.contains("one") && first.contains("row") && first.contains("text"));
    let second = sent("two", "text");
    assert!(second.contains("two") && !second.contains("row") && !second.contains("text"));
    let third = sent("two", "new");
    assert!(!third.contains("two") && third.contains("\x1b[2Knew"));
}
