//! Figures held against what is recorded.

use host_tests::figures::Figure;
use host_tests::figures::gate::*;
use std::collections::BTreeMap;

const OLD: &str = "rustc 1.95.0 (59807616e 2026-04-14)";
const NEW: &str = "rustc 1.96.1 (0123456789 2026-06-01)";

fn boards(values: &[(&str, f64, f64)]) -> BTreeMap<String, Vec<Figure>> {
    let figures = values.iter().map(|&(name, value, grain)| Figure {
        name: name.into(),
        value,
        grain,
    });
    BTreeMap::from([("m4".to_owned(), figures.collect())])
}

fn recorded(values: &[(&str, f64, f64)]) -> Record {
    let mut record = Record::default();
    record.bless(OLD, &boards(values));
    record
}

#[test]
fn releases_are_told_apart_by_their_minor_number() {
    assert_eq!(release(OLD), "rustc 1.95");
    assert_eq!(release(NEW), "rustc 1.96");
    assert_eq!(minor("rustc 1.96"), 96);
}

#[test]
fn slower_is_refused_with_both_figures() {
    let record = recorded(&[("frame sphere", 800_000.0, 80.0), ("unit span", 16.0, 2.0)]);
    let verdict = |frame, span| {
        let now = [("frame sphere", frame, 80.0), ("unit span", span, 2.0)];
        record.judge(OLD, &boards(&now))
    };
    // As recorded, within the tolerance and the grain, and faster.
    for (frame, span) in [(800_000.0, 16.0), (816_080.0, 18.3), (500_000.0, 1.0)] {
        assert_eq!(verdict(frame, span).refused, [], "{frame} {span}");
    }
    assert_eq!(verdict(500_000.0, 1.0).better, 2);
    let slower = verdict(816_100.0, 16.0);
    assert_eq!(slower.refused.len(), 1);
    let line = slower.refused[0].to_string();
    assert!(line.contains("816100") && line.contains("800000"), "{line}");
    assert!(
        line.contains("+2.0 %") && line.contains("m4: frame sphere"),
        "{line}"
    );
    assert_eq!(verdict(900_000.0, 19.0).refused.len(), 2);
}

#[test]
fn what_is_missing_on_either_side_is_refused() {
    let record = recorded(&[("a", 1.0, 0.0), ("b", 1.0, 0.0)]);
    let refused = record
        .judge(OLD, &boards(&[("a", 1.0, 0.0), ("c", 1.0, 0.0)]))
        .refused;
    let names: Vec<&str> = refused.iter().map(|r| r.name.as_str()).collect();
    assert_eq!(names, ["c", "b"]);
    assert_eq!(record.judge(OLD, &BTreeMap::new()).refused.len(), 1);
    let nothing = Record::default().judge(OLD, &boards(&[("a", 1.0, 0.0)]));
    assert_eq!(nothing.refused.len(), 1);
}

#[test]
fn another_compiler_is_held_against_the_nearest_one() {
    let record = recorded(&[("a", 100.0, 0.0)]);
    let verdict = |value| record.judge(NEW, &boards(&[("a", value, 0.0)]));
    assert_eq!(verdict(109.0).refused, []);
    assert_eq!(verdict(109.0).other.as_deref(), Some("rustc 1.95"));
    assert_eq!(verdict(111.0).refused.len(), 1);
    let mut both = record.clone();
    both.bless(NEW, &boards(&[("a", 90.0, 0.0)]));
    assert_eq!(
        both.judge(NEW, &boards(&[("a", 92.0, 0.0)])).refused.len(),
        1
    );
    assert_eq!(
        both.judge(OLD, &boards(&[("a", 101.0, 0.0)])),
        Verdict::default()
    );
}

#[test]
fn records_survive_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("r.json");
    assert_eq!(Record::read(&path).unwrap(), Record::default());
    let record = recorded(&[("a", 1.25, 0.0)]);
    record.write(&path).unwrap();
    assert_eq!(Record::read(&path).unwrap(), record);
    std::fs::write(&path, "[").unwrap();
    assert!(
        Record::read(&path)
            .unwrap_err()
            .to_string()
            .contains("r.json")
    );
}

/// The checked-in record is whole: every board, and the same figures for each.
#[test]
fn the_record_is_complete() {
    let Record(releases) = Record::read(&Record::path()).unwrap();
    assert!(!releases.is_empty());
    for (release, boards) in releases {
        let names = |figures: &Figures| figures.keys().cloned().collect::<Vec<_>>();
        assert_eq!(
            boards.len(),
            host_tests::firmware::BOARDS.len(),
            "{release}"
        );
        let first = names(&boards["m4"]);
        assert!(first.len() > 50, "{release}");
        assert!(
            boards.values().all(|figures| names(figures) == first),
            "{release}"
        );
    }
}
