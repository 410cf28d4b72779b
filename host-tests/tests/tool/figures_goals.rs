//! The table of goals.

use host_tests::bench::table::between;
use host_tests::figures::gate::Record;
use host_tests::figures::goals::*;

/// Kills: a figure of another name, board or unit, and a file that was not written anew.
#[test]
fn goals_stand_beside_what_is_recorded() {
    let record = Record::read(&Record::path()).unwrap();
    let text = include_str!("../../figures/goals.md");
    let written = between(text, MARKERS, &markdown(&record)).unwrap();
    assert_eq!(written, text, "`firmware --bench --bless` writes it");
    let frame = record.latest("m4", "frame g").unwrap() / 1e6;
    assert!(text.contains(&format!("| G | {frame:.2} / 2.40 |")));
    assert!(!text.contains("| - "), "a name is not recorded");
}
