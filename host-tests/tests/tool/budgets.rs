//! Limits, and what breaks them.

use host_tests::budgets::*;

#[test]
fn what_is_above_its_limit_or_has_none_is_broken() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("budgets.txt");
    std::fs::write(&path, "# words\n 100  50  text a, m4\n7 - source b\n").unwrap();
    let mut budgets = read(&path).unwrap();
    let figures = |a, b| Figures::from([("text a, m4".into(), a), ("source b".into(), b)]);
    let (own, other) = ("rustc 1.95.2 (x 2026-01-01)", "rustc 1.90.0 (x 2025-01-01)");
    assert!(broken(&budgets, &figures(100 + FOLDER, 7), own).is_empty());
    assert_eq!(
        broken(&budgets, &figures(101 + FOLDER, 7), own),
        ["text a, m4: 117, where 100 is the limit"]
    );
    assert_eq!(broken(&budgets, &figures(100, 8), own).len(), 1);
    // Another compiler's code may be larger; the source is the same.
    assert!(broken(&budgets, &figures(110, 7), other).is_empty());
    assert_eq!(broken(&budgets, &figures(112, 8), other).len(), 2);
    let mut more = figures(1, 1);
    more.insert("source c".into(), 0);
    assert_eq!(
        broken(&budgets, &more, own),
        ["source c: 0, and there is no limit"]
    );
    // Limits are lowered and never raised.
    assert_eq!(tighten(&mut budgets, &figures(60, 9)), 1);
    write(&path, &budgets).unwrap();
    let limits: Vec<u64> = read(&path).unwrap().values().map(|b| b.limit).collect();
    assert_eq!(limits, [7, 60]);
    assert_eq!(read(&path).unwrap()["text a, m4"].goal, Some(50));
    for wrong in ["x - a\n", "1 a\n", "1 -\n", "1 - a\n2 - a\n"] {
        std::fs::write(&path, wrong).unwrap();
        assert!(read(&path).is_err(), "{wrong:?}");
    }
}

/// Kills: functions of `core` that fail without a word of panicking in their path, and those of others that are called so.
#[test]
fn functions_that_panic_are_known_by_their_names() {
    for name in [
        "core::panicking::panic_fmt",
        "core::panicking::panic_const::panic_const_div_by_zero",
        "core::slice::index::slice_index_fail",
        "core::slice::copy_from_slice_impl::len_mismatch_fail",
        "core::option::unwrap_failed",
    ] {
        assert!(is_panic(name), "{name}");
    }
    for name in [
        "core::slice::sort::insertion_sort",
        "scanbeam::scan_out::pump::Pump<D>::fail",
        "small::panicking::has_failed",
    ] {
        assert!(!is_panic(name), "{name}");
    }
}
