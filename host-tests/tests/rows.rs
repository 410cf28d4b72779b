//! The table of requirements: every row is there once, each file and test that it names exists, and what shows it in QEMU,
//! in lists and by the tool does too. And the house of proofs: each file of it is a module, so that none is left out of the program.

mod damages;
mod ways;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use ways::Known;

/// Letters of the rows, and how many of each there are.
const ROWS: [(char, usize); 8] = [
    ('S', 7),
    ('K', 18),
    ('C', 8),
    ('H', 18),
    ('P', 6),
    ('B', 6),
    ('X', 13),
    ('M', 4),
];

/// What is wrong with a table: rows that are missing or there twice, and names of nothing.
fn faults(table: &str, root: &Path) -> Vec<String> {
    let mut missing: BTreeSet<String> = (ROWS.iter())
        .flat_map(|&(letter, count)| (1..=count).map(move |n| format!("{letter}{n}")))
        .collect();
    let known = Known::of(root);
    let mut faults = Vec::new();
    for line in table.lines().filter(|line| line.starts_with("| ")).skip(1) {
        let cells: Vec<&str> = line.trim_matches('|').split(" | ").map(str::trim).collect();
        let [id, what, code, tests, ways] = cells[..] else {
            faults.push(format!("{line}: five cells are needed"));
            continue;
        };
        if !missing.remove(id) {
            faults.push(format!("{id}: unknown, or there twice"));
        }
        if what.is_empty() || quoted(code).is_empty() || quoted(tests).is_empty() {
            faults.push(format!("{id}: an empty cell"));
        }
        for file in quoted(code) {
            if ![root.join("src").join(file), root.join(file)]
                .iter()
                .any(|path| path.is_file())
            {
                faults.push(format!("{id}: there is no {file}"));
            }
        }
        for test in quoted(tests) {
            let found = test
                .split_once(": ")
                .is_some_and(|(file, name)| has_test(&root.join(file), name));
            if !found {
                faults.push(format!("{id}: there is no test {test}"));
            }
        }
        let is_src = |file: &&str| root.join("src").join(file).is_file();
        faults.extend(known.faults(id, quoted(code).iter().any(is_src), ways));
    }
    faults.extend(missing.into_iter().map(|id| format!("{id}: missing")));
    faults
}

/// What stands between backquotes.
fn quoted(cell: &str) -> Vec<&str> {
    cell.split('`').skip(1).step_by(2).collect()
}

/// Whether the file has a function of this name right under `#[test]`, attributes apart.
fn has_test(file: &Path, name: &str) -> bool {
    let text = fs::read_to_string(file).unwrap_or_default();
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    let begins = format!("fn {name}(");
    let is_at = |at: usize| {
        let above = lines[..at].iter().rev();
        above
            .take_while(|line| line.starts_with("#["))
            .any(|line| *line == "#[test]")
    };
    (0..lines.len()).any(|at| lines[at].starts_with(&begins) && is_at(at))
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The table.
fn rows() -> String {
    fs::read_to_string(root().join("src/guide/rows.md")).unwrap()
}

#[test]
fn every_row_has_its_code_and_its_tests() {
    let faults = faults(&rows(), &root());
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn what_is_wrong_in_a_table_is_found() {
    let table = rows();
    let damaged = |from: &str, to: &str| {
        assert!(table.contains(from), "{from}");
        faults(&table.replacen(from, to, 1), &root())
    };
    assert_eq!(damaged("| K5 |", "| K4 |").len(), 2);
    assert_eq!(damaged("`span/edge.rs`", "`span/edges.rs`").len(), 1);
    assert_eq!(
        damaged(": lines_become_percentiles", ": lines_become").len(),
        1
    );
    // A function that is no test.
    assert_eq!(
        damaged(": lines_become_percentiles", ": from_lines").len(),
        1
    );
    assert_eq!(damaged("| M4 |", "| M5 |").len(), 2);
}

/// What the top level lacks of these names.
fn lacks<'n>(root: &Path, names: &[&'n str]) -> Vec<&'n str> {
    let is_there = |name: &&&str| !root.join(name).exists();
    names.iter().filter(is_there).copied().collect()
}

/// S2: the top level has what was asked for.
#[test]
fn the_top_level_has_its_files_and_folders() {
    let mut names = vec!["Cargo.toml", "src", "host-tests", "memory.x", "README.md"];
    assert_eq!(lacks(&root(), &names), [""; 0]);
    names.push("cellar");
    assert_eq!(lacks(&root(), &names), ["cellar"]);
}

/// Names of files in `tests` of which `main` makes no module.
fn left_out(main: &str, files: &[&str]) -> Vec<String> {
    let is_module = |name: &str| main.lines().any(|line| line == format!("mod {name};"));
    let names = files.iter().filter_map(|file| file.strip_suffix(".rs"));
    names
        .filter(|name| *name != "main" && !is_module(name))
        .map(str::to_owned)
        .collect()
}

#[test]
fn every_file_of_proofs_is_compiled() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    let main = fs::read_to_string(folder.join("main.rs")).unwrap();
    let entries = fs::read_dir(folder).unwrap();
    let files: Vec<String> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    let mut files: Vec<&str> = files.iter().map(String::as_str).collect();
    assert!(files.len() > 40, "{files:?}");
    assert_eq!(left_out(&main, &files), [""; 0]);
    files.push("cellar.rs");
    assert_eq!(left_out(&main, &files), ["cellar"]);
}
