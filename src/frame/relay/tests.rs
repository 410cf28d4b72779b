//! Which lines a desk lends, and what it says to others than those.

use super::*;
use std::vec::Vec;

type Line = &'static mut [u16];

/// A relay with three buffers.
fn relay() -> Relay<Line, 4> {
    Relay::new((0..3).map(|_| std::vec![0; 4].leak()))
}

const PEER: Peer<'static> = Peer {
    wait: &|| false,
    wake: &|| (),
};

/// A desk in the midst of a frame of lines 0 to `end`, with nothing on those before `blank`.
fn opened<'q>(mut desk: Desk<'q, Line>, blank: u16, end: u16) -> Desk<'q, Line> {
    (desk.blank, desk.end, desk.odd) = (blank, end, false);
    desk
}

#[test]
fn bands_rise_lie_among_the_lines_that_are_left_and_shrink() {
    for end in [0, 1, 2, 3, 9, 40, 1016] {
        for (band, blank) in [(1, 0), (4, 0), (4, 30), (100, 2), (u16::MAX, 0)] {
            let mut relay = relay();
            let (_worker, desk) = relay.split();
            let mut desk = opened(desk, blank.min(end), end);
            desk.set_band(band);
            let (mut line, mut lent, mut own) = (0, Vec::new(), 0);
            while line < end {
                desk.order.store(ASKS[0], Ordering::Relaxed);
                desk.answer(line, PEER);
                let order = desk.order.load(Ordering::Relaxed);
                if order & BAND != 0 {
                    let new = (order >> 16 & 0x7FFF) as u16..order as u16;
                    assert!(!new.is_empty() && new.end <= end && new.len() <= usize::from(band));
                    assert!(new.start >= line.max(blank.min(end)));
                    let left = usize::from(end - line);
                    assert!(new.len() <= (left / 4).max(1), "{new:?} of {left}");
                    assert!(
                        lent.last()
                            .is_none_or(|last: &Range<u16>| last.end <= new.start)
                    );
                    lent.push(new);
                }
                if desk.has_lent(line) {
                    assert!(lent.iter().any(|band| band.contains(&line)));
                } else {
                    assert!(!lent.iter().any(|band| band.contains(&line)));
                    own += 1;
                }
                line += 1;
            }
            if end == 1016 && blank == 0 && band < 10 {
                // Who asks at once has about half of the lines.
                assert!(
                    (300..700).contains(&own),
                    "{own} of {end} by bands of {band}"
                );
            }
        }
    }
}

#[test]
fn who_asks_in_another_frame_is_not_answered() {
    let mut relay = relay();
    let (_worker, desk) = relay.split();
    let mut desk = opened(desk, 0, 40);
    for order in [AWAY, ASKS[1], OVER, BAND | 3] {
        desk.order.store(order, Ordering::Relaxed);
        desk.answer(0, PEER);
        assert_eq!(desk.order.load(Ordering::Relaxed), order);
    }
    assert!(!desk.is_left(), "nobody was told");
    desk.told = true;
    desk.order.store(ASKS[1], Ordering::Relaxed);
    assert!(desk.is_left(), "it is in the next frame");
}

#[test]
fn another_line_than_is_due_is_an_error_and_its_buffer_comes_back() {
    let mut relay = relay();
    let (mut worker, mut desk) = relay.split();
    let Some(buf) = worker.free.dequeue() else {
        panic!("three are free")
    };
    let result = Ok(true);
    let line = 8;
    let sent = worker.to_desk.enqueue(Drawn { line, result, buf });
    assert!(sent.is_ok());
    let mut pixels = [7; 4];
    let got = desk.take(9, &mut pixels, PEER);
    assert_eq!(got, Err(LineError::Strayed { line: 9 }));
    assert_eq!(pixels, [7; 4], "nothing is written");
    assert_eq!(worker.free.len(), 3);
}
