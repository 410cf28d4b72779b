//! Lines of a frame as figures.

use host_tests::figures::*;
use host_tests::firmware::{LinesRun, Output};
use std::collections::BTreeMap;

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

#[test]
fn a_listed_vertex_is_what_it_takes_more_than_one_of_a_call() {
    let lines = [
        "figure name=list_pass_one value=300",
        "figure name=calls_pass_one value=200",
        "figure name=list_vertices value=20",
        "lines scene=a pass_one=1 first=0 costs=1",
        "done frames=0",
    ];
    let output = Output::parse(&lines.map(str::to_owned)).unwrap();
    let bench = Bench::new(&output, &BTreeMap::new(), Vec::new()).unwrap();
    assert_eq!(bench.unit("listed_vertex"), Some(5.0));
}
