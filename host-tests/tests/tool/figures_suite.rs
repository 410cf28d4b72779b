//! The table of the suite in the README.

use host_tests::bench::table::between;
use host_tests::figures::gate::Record;
use host_tests::figures::suite::*;

#[test]
fn the_readme_has_what_is_recorded() {
    let record = Record::read(&Record::path()).unwrap();
    let readme = include_str!("../../../README.md");
    let written = between(readme, MARKERS, &markdown(&record)).unwrap();
    assert_eq!(written, readme, "`firmware --bench --bless` writes it");
}

#[test]
fn every_scene_has_a_title_and_a_figure() {
    let record = Record::read(&Record::path()).unwrap();
    for row in rows(&record) {
        assert_ne!(row[0], title(""));
        assert!(
            !row.iter().any(|cell| cell.contains('-') && cell.len() < 3),
            "{row:?}"
        );
    }
}
