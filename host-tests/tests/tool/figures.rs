//! Lines of a frame as figures.

use host_tests::figures::*;
use host_tests::firmware::LinesRun;

#[test]
fn lines_become_percentiles() {
    let run = |costs| LinesRun {
        scene: "a".into(),
        pass_one: 7,
        costs,
    };
    let lines = Lines::new(&run((1..=200).rev().collect())).unwrap();
    assert_eq!((lines.median, lines.p99, lines.worst), (101, 198, 200));
    assert_eq!((lines.worst_line, lines.pass_one), (0, 7));
    let one = Lines::new(&run(vec![5])).unwrap();
    assert_eq!((one.median, one.p99, one.worst), (5, 5, 5));
    assert_eq!(Lines::new(&run(vec![])), None);
}
