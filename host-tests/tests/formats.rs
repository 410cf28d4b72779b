//! Every public error, event and figure can be logged: `defmt::Format` is derived for it with the feature
//! `defmt`. Read from the source of `src/`.

use std::fs;
use std::path::{Path, PathBuf};

/// Ends of names of what is logged.
const LOGGED: [&str; 9] = [
    "Error",
    "ErrorKind",
    "Event",
    "Notice",
    "Stats",
    "Counts",
    "Fed",
    "Use",
    "Assembled",
];

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|end| end == "rs") {
            found.push(path);
        }
    }
}

/// Public structs and enums of `text` whose names end as those of what is logged, and whether `Format` is derived.
fn logged(text: &str) -> Vec<(&str, bool)> {
    let mut found = Vec::new();
    let mut attributes = String::new();
    for line in text.lines() {
        let line = line.trim();
        if line.starts_with("#[") || line.starts_with("///") {
            attributes += line;
            continue;
        }
        let rest = line
            .strip_prefix("pub enum ")
            .or_else(|| line.strip_prefix("pub struct "));
        if let Some(rest) = rest {
            let name = rest.split(|c: char| !c.is_alphanumeric()).next().unwrap();
            if LOGGED.iter().any(|end| name.ends_with(end)) {
                let format = "#[cfg_attr(feature = \"defmt\", derive(defmt::Format))]";
                found.push((name, attributes.contains(format)));
            }
        }
        attributes.clear();
    }
    found
}

#[test]
fn what_is_logged_can_be_formatted() {
    let mut files = Vec::new();
    sources(
        &Path::new(env!("CARGO_MANIFEST_DIR")).join("../src"),
        &mut files,
    );
    let mut count = 0;
    let mut missing = Vec::new();
    for file in files {
        let text = fs::read_to_string(&file).unwrap();
        for (name, formatted) in logged(&text) {
            count += 1;
            if !formatted {
                missing.push(format!("{name} in {}", file.display()));
            }
        }
    }
    assert!(missing.is_empty(), "no defmt::Format: {missing:#?}");
    assert!(count >= 27, "only {count} found");
}

#[test]
fn a_missing_derive_is_found() {
    let text = "/// Doc.\n#[derive(Debug)]\npub enum OneError<E> {\n}\n\n#[derive(Debug)]\n\
        #[cfg_attr(feature = \"defmt\", derive(defmt::Format))]\npub struct OtherStats;\n\
        pub struct ThirdCounts(u8);\n";
    let want = [
        ("OneError", false),
        ("OtherStats", true),
        ("ThirdCounts", false),
    ];
    assert_eq!(logged(text), want);
}
