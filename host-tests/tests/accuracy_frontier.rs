//! The process `scanbeam accuracy --json`: the keys that others read, and the defaults' place.

use serde_json::Value;
use std::process::Command;

#[test]
fn the_list_has_its_keys_and_the_defaults_are_on_the_frontier() {
    let output = Command::new(env!("CARGO_BIN_EXE_scanbeam"))
        .args(["accuracy", "--json"])
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
    let list: Value = serde_json::from_slice(&output.stdout).unwrap();
    let rows = list.as_array().unwrap();
    assert!(rows.len() > 60);
    for row in rows {
        for key in ["family", "method", "unit"] {
            assert!(
                row[key].as_str().is_some_and(|text| !text.is_empty()),
                "{key}: {row}"
            );
        }
        let number = |key: &str| row[key].as_f64().unwrap_or_else(|| panic!("{key}: {row}"));
        assert!(number("max_error") >= number("mean_error") && number("mean_error") >= 0.0);
        let cost = &row["instructions_per_pixel"];
        assert!(
            cost.is_null() || cost.as_f64().is_some_and(|c| c > 0.0),
            "{row}"
        );
        let on = row["on_frontier"].as_bool().unwrap();
        assert!(!on || !cost.is_null(), "{row}");
    }
    let of = |family: &'static str| rows.iter().filter(move |row| row["family"] == family);
    for family in ["interpolation", "depth", "coverage", "frame", "texture"] {
        assert!(of(family).any(|row| row["on_frontier"] == true), "{family}");
    }
    // Pixels of 16 bits: alone, on short and on long spans, and with depth.
    let default = of("interpolation").filter(|row| {
        let has = |key: &str, text: &str| row[key].as_str().is_some_and(|t| t.starts_with(text));
        has("method", "renderer") && has("case", "RGB565")
    });
    let mut count = 0;
    for row in default {
        assert_eq!(row["on_frontier"], true, "{row}");
        count += 1;
    }
    assert_eq!(count, 3);
}
