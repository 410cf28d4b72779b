//! The column `where` of the table of requirements: in which ways a row is done, and what shows it.
//!
//! A cell has a part for each way, `host; QEMU ...; lists ...; tool ...`, each with names, or `no lists: reason`.
//!
//! | way | a name is | that is there |
//! |---|---|---|
//! | `host` | none: the tests' cell has them | |
//! | `QEMU` | a figure, as `frame a` | for every core of every compiler in `figures/firmware.json` |
//! | | `board NAME` | as a folder of `examples` that is run in an emulator |
//! | `lists` | `file: function` | as a test of lists |
//! | | `frame teapot_list`, `frame crate_list` | as a list that the firmware plays |
//! | `tool` | `command`, `command --flag` | in the tool's help |
//! | | `scene: key` | in a file of `examples/scene-files` |

use super::{has_test, quoted};
use host_tests::args::{self, Stop};
use host_tests::boards;
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// All ways, in the order of their parts.
const WAYS: [&str; 4] = ["host", "QEMU", "lists", "tool"];

/// The example whose log, made in QEMU, is held against the host's, and the test that does it.
const LOGGED: (&str, &str) = ("defmt-log", "host-tests/tests/defmt_log.rs");

/// What names may name.
pub(super) struct Known {
    root: PathBuf,
    /// Figures that every core has.
    figures: BTreeSet<String>,
    /// Keys of scene files.
    keys: BTreeSet<String>,
}

impl Known {
    /// What there is in the project whose folder this is.
    pub(super) fn of(root: &Path) -> Self {
        let mut keys = BTreeSet::new();
        for entry in fs::read_dir(root.join("examples/scene-files")).unwrap() {
            let path = entry.unwrap().path();
            if path
                .extension()
                .is_some_and(|extension| extension == "json")
            {
                collect_keys(&json(&path), &mut keys);
            }
        }
        Self {
            root: root.to_owned(),
            figures: common_figures(&json(&root.join("host-tests/figures/firmware.json"))),
            keys,
        }
    }

    /// What is wrong with the cell of a row, which may have code in `src`.
    pub(super) fn faults(&self, id: &str, has_src: bool, cell: &str) -> Vec<String> {
        let parts: Vec<&str> = cell.split("; ").collect();
        let ways: Vec<&str> = parts.iter().map(|part| way_of(part)).collect();
        let missing: Vec<String> = (WAYS.iter().filter(|way| !ways.contains(way)))
            .map(|way| format!("{id}: nothing is said of {way}"))
            .collect();
        if !missing.is_empty() {
            return missing;
        }
        if ways != WAYS || parts[0] != "host" {
            return vec![format!("{id}: {WAYS:?} are needed, each once: {cell}")];
        }
        let mut faults = Vec::new();
        for (way, part) in ways.into_iter().zip(parts).skip(1) {
            match part.strip_prefix("no ") {
                Some(_) => faults.extend(refused(id, has_src, part)),
                None => faults.extend(self.unknown(id, way, part)),
            }
        }
        faults
    }

    /// What is wrong with a part that has names.
    fn unknown(&self, id: &str, way: &str, part: &str) -> Vec<String> {
        let names = quoted(part);
        let around: String = part.split('`').step_by(2).collect();
        if names.is_empty() || part.matches('`').count() % 2 == 1 || around.trim() != way {
            return vec![format!("{id}: names are needed in {part}")];
        }
        let is_known = |name: &str| match way {
            "QEMU" => self.is_in_qemu(name),
            "lists" => self.is_of_lists(name),
            _ => self.is_of_tool(name),
        };
        let unknown = names.into_iter().filter(|name| !is_known(name));
        unknown
            .map(|name| format!("{id}: there is no {name} for {way}"))
            .collect()
    }

    fn is_in_qemu(&self, name: &str) -> bool {
        if let Some(board) = name.strip_prefix("board ") {
            let test = fs::read_to_string(self.root.join(LOGGED.1)).unwrap_or_default();
            let is_logged = board == LOGGED.0 && test.contains(&format!("examples/{board}\""));
            let is_run = is_logged || boards::examples().any(|example| example == board);
            return is_run && self.root.join("examples").join(board).is_dir();
        }
        // A figure of a frame that is drawn no longer may still be in the record.
        let frame = name.strip_prefix("frame ");
        let is_drawn = |frame| scenes::frames().any(|(drawn, _)| drawn == frame);
        self.figures.contains(name) && frame.is_none_or(is_drawn)
    }

    fn is_of_lists(&self, name: &str) -> bool {
        if let Some(frame) = name.strip_prefix("frame ") {
            return scenes::PLAYED.iter().any(|(played, _)| *played == frame);
        }
        name.split_once(": ").is_some_and(|(file, test)| {
            let of_lists = ["player", "list"].iter().any(|word| file.contains(word));
            of_lists && has_test(&self.root.join(file), test)
        })
    }

    fn is_of_tool(&self, name: &str) -> bool {
        if let Some(key) = name.strip_prefix("scene: ") {
            return self.keys.contains(key);
        }
        let (command, flag) = name.split_once(' ').unwrap_or((name, "--help"));
        let Err(Stop::Text(help)) = args::parse(["scanbeam", command, "--help"]) else {
            return false;
        };
        let mut told = help
            .lines()
            .map(str::trim)
            .filter(|line| line.starts_with('-'));
        told.any(|line| line.split([' ', ',']).any(|word| word == flag))
    }
}

/// The way that a part is of, whether it has names or a reason.
fn way_of(part: &str) -> &str {
    let named = part.strip_prefix("no ").unwrap_or(part);
    named.split([' ', ':']).next().unwrap_or_default()
}

/// What is wrong with a part `no WAY: reason`.
fn refused(id: &str, has_src: bool, part: &str) -> Option<String> {
    let reason = part
        .split_once(": ")
        .map_or("", |(_, reason)| reason.trim());
    let is_src_in_qemu = has_src && way_of(part) == "QEMU";
    if reason.is_empty() {
        Some(format!("{id}: a reason is needed in {part}"))
    } else if is_src_in_qemu {
        Some(format!("{id}: has code in src, which has to run in QEMU"))
    } else {
        None
    }
}

fn json(path: &Path) -> Value {
    let text = fs::read_to_string(path).unwrap();
    serde_json::from_str(&text).unwrap()
}

/// Names of figures that each core of each compiler has.
fn common_figures(record: &Value) -> BTreeSet<String> {
    let compilers = record.as_object().unwrap().values();
    let cores = compilers.flat_map(|cores| cores.as_object().unwrap().values());
    let names = cores.map(|core| BTreeSet::from_iter(core.as_object().unwrap().keys().cloned()));
    names.reduce(|all, one| &all & &one).unwrap()
}

/// All keys of a file of JSON.
fn collect_keys(value: &Value, keys: &mut BTreeSet<String>) {
    match value {
        Value::Object(fields) => {
            for (key, value) in fields {
                keys.insert(key.clone());
                collect_keys(value, keys);
            }
        }
        Value::Array(values) => values.iter().for_each(|value| collect_keys(value, keys)),
        _ => {}
    }
}

/// Figures that one core lacks are no figures, and keys are found however deep they lie.
#[test]
fn figures_are_of_all_cores_and_keys_of_all_depths() {
    let record = serde_json::json!({
        "one": { "m4": { "frame a": 1, "frame b": 2 }, "m3": { "frame a": 3, "frame b": 4 } },
        "two": { "m4": { "frame a": 5, "frame c": 6 } },
    });
    assert!(common_figures(&record).iter().eq(["frame a"]));
    let mut keys = BTreeSet::new();
    collect_keys(
        &serde_json::json!({ "a": [{ "b": { "c": 1 } }] }),
        &mut keys,
    );
    assert!(keys.iter().eq(["a", "b", "c"]));
}

/// A figure of a frame that is drawn no longer is none, nor is a board without a folder.
#[test]
fn what_is_there_no_longer_is_unknown() {
    let mut known = Known {
        root: super::root(),
        figures: ["frame a", "frame gone"].map(str::to_owned).into(),
        keys: BTreeSet::new(),
    };
    assert!(known.is_in_qemu("frame a") && !known.is_in_qemu("frame gone"));
    assert!(known.is_in_qemu("board bare") && known.is_in_qemu("board defmt-log"));
    known.root = PathBuf::from("nowhere");
    assert!(!known.is_in_qemu("board bare") && !known.is_in_qemu("board defmt-log"));
}
