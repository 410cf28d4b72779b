//! The demo: turns that fit their memory and show the same whatever is sent.

use host_tests::args::ChangedArg;
use host_tests::demo::*;

#[test]
fn thousands_are_set_apart() {
    for (digits, text) in [
        ("0", "0"),
        ("999", "999"),
        ("1000", "1,000"),
        ("1234567", "1,234,567"),
    ] {
        assert_eq!(thousands(digits), text);
    }
}

/// Kills: a frame that is sent whole though the display shows most of it, memory that is full or hardly used.
#[test]
fn a_turn_fits_the_memory_at_any_angle() {
    let turn = Turn::draw(97, ChangedArg::Lines, &|| ()).unwrap();
    assert_eq!(turn.frames.len(), 97);
    for (number, took) in turn.took.iter().enumerate() {
        let assembled = took.frame.assembled;
        assert_eq!(assembled.dropped, 0);
        assert_eq!(assembled.clipped, 0, "the whole teapot is in sight");
        // None is clipped, so what is left of each is one or nothing.
        let kept = assembled.triangles - assembled.culled;
        assert_eq!(took.objects, kept as usize);
        let (cache, scan_out) = (took.frame.cache, took.frame.scan_out);
        assert!(cache.hits + cache.spilled <= kept && cache.moved_in <= cache.spilled);
        assert_eq!(scan_out.bytes_sent + scan_out.bytes_unsent, 320 * 240 * 2);
        assert_eq!(scan_out.lines_unsent > 60, number > 0, "frame {number}");
    }
    for lent in turn.lent().iter().flatten() {
        let [bytes, used] = lent.bytes();
        assert!(
            used <= bytes && 10 * used >= 9 * bytes,
            "{}: {used} of {bytes}",
            lent.what
        );
    }
}

/// Kills: parts of a frame that are not sent though they changed, and flags that send alike.
#[test]
fn whatever_is_sent_the_display_shows_the_same() {
    let ways = [ChangedArg::All, ChangedArg::Lines, ChangedArg::Runs];
    let turns = ways.map(|changed| Turn::draw(5, changed, &|| ()).unwrap());
    let [all, lines, runs] = &turns;
    let words = |turn: &Turn, frame: usize| turn.took[frame].frame.scan_out.bytes_sent;
    for frame in 0..5 {
        assert!(all.frames[frame] == lines.frames[frame], "{frame}");
        assert!(all.frames[frame] == runs.frames[frame], "{frame}");
        let sent = [runs, lines, all].map(|turn| words(turn, frame));
        let falls = frame > 0 && sent[0] < sent[1] && sent[1] < sent[2];
        assert!(falls || sent == [320 * 240 * 2; 3], "{frame}: {sent:?}");
        assert_eq!(falls, frame > 0);
    }
}

#[test]
fn the_readme_says_how_much_memory_is_lent() {
    let lent = Turn::draw(1, ChangedArg::Lines, &|| ()).unwrap().lent();
    let bytes = |rooms: &[Lent]| {
        let sum: usize = rooms.iter().map(|lent| lent.bytes()[0]).sum();
        thousands(&sum.to_string())
    };
    let [fast, slow] = &lent;
    let said = format!(
        "takes {} bytes of fast RAM ({} of the object cache, {} of depth, {} of two line buffers) \
         and {} of slow RAM",
        bytes(fast),
        bytes(&fast[..2]),
        bytes(&fast[2..3]),
        bytes(&fast[3..]),
        bytes(slow)
    );
    assert!(include_str!("../../../README.md").contains(&said), "{said}");
}
