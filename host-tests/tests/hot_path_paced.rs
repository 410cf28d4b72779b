//! X9: frames whose lines cost no more than they may; how long they take is measured on emulated boards.

use host_tests::frames::{PacedFrame, paced_frame};
use scenes::PACED;

/// Kills: triangles that are late are not counted; a line that may cost more than it has.
#[test]
fn frames_use_what_lines_may_cost_and_tell_what_they_lost() {
    let mut all = 0;
    for paced in PACED {
        let frame = paced_frame(paced).unwrap();
        let differing = frame.differing();
        let PacedFrame { paid, .. } = frame;
        println!("{} {differing} {paid:?}", paced.name);
        assert!(paid.dearest <= paced.pace.most, "{}", paced.name);
        assert!(10 * paid.dearest >= 9 * paced.pace.most, "{}", paced.name);
        assert!(paid.late > 0 && paid.lines > 0 && differing > 500);
        all += paid.even + paid.joined + paid.unsorted + paid.left_out;
    }
    assert!(all > 100_000, "{all}");
}
