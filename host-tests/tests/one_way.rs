//! Rule 1 of DESIGN: data goes one way, so a room imports the ground floor, itself and rooms
//! before it. Read from the source of `src/`.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// What everything stands on, in order: a room of the ground floor imports those before it.
const GROUND: [&str; 5] = ["num", "arena", "link", "event", "stats"];
/// The rooms in the order in which data walks.
const ROOMS: [&str; 12] = [
    "list", "geometry", "scene", "pixel", "overlay", "active", "span", "visible", "look", "player",
    "scan_out", "frame",
];
/// The front door's modules by task: they take over names from everywhere, and no room sees them.
const FRONT: [&str; 3] = ["input", "light", "mesh"];
/// The front door: it sees everything.
const ABOVE: [&str; 1] = ["lib"];
/// Pairs beyond the order: the first must never know the second.
const NEVER: [(&str, &str); 5] = [
    ("active", "geometry"),
    ("span", "active"),
    ("visible", "geometry"),
    ("look", "active"),
    ("frame", "player"),
];

/// The rooms that `text` names after `crate::`, in `use` lines and in paths, with their lines;
/// comments and unit tests are left out.
fn imports(text: &str) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    let code: String = text
        .lines()
        .take_while(|line| line.trim() != "#[cfg(test)]" || !text_after_is_module(text, line))
        .map(|line| line.split("//").next().unwrap_or("").to_owned() + "\n")
        .collect();
    for (at, _) in code.match_indices("crate::") {
        // `$crate`, `my_crate::` and the like are other things.
        if code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == '$') {
            continue;
        }
        let line = 1 + code[..at].matches('\n').count();
        let rest = code[at + "crate::".len()..].trim_start();
        if let Some(group) = rest.strip_prefix('{') {
            // The first name of each branch of the group.
            let mut depth = 1;
            let mut start = true;
            let mut name = String::new();
            for c in group.chars() {
                match c {
                    '{' => depth += 1,
                    '}' => depth -= 1,
                    ',' if depth == 1 => {
                        found.push((line, std::mem::take(&mut name)));
                        start = true;
                    }
                    ':' => start = false,
                    c if depth == 1 && start && !c.is_whitespace() => name.push(c),
                    _ => {}
                }
                if depth == 0 {
                    break;
                }
            }
            found.push((line, name));
        } else {
            let end = rest
                .find(|c: char| !(c.is_alphanumeric() || c == '_'))
                .unwrap_or(rest.len());
            found.push((line, rest[..end].to_owned()));
        }
    }
    found.retain(|(_, name)| !name.is_empty());
    found
}

/// Whether the `#[cfg(test)]` stands before a module with a body, as it does at a file's end.
fn text_after_is_module(text: &str, line: &str) -> bool {
    text.split(line)
        .nth(1)
        .is_some_and(|rest| rest.trim_start().starts_with("mod tests {"))
}

fn place(names: &[&str], name: &str) -> Option<usize> {
    names.iter().position(|n| *n == name)
}

/// Why `room` must not import `other`, if it must not.
fn forbidden(room: &str, other: &str) -> Option<String> {
    if room == other || ABOVE.contains(&room) || FRONT.contains(&room) {
        return None;
    }
    if !GROUND.contains(&room) && !ROOMS.contains(&room) {
        return Some(format!("`{room}` has no place in the order of rooms"));
    }
    if NEVER.contains(&(room, other)) {
        return Some(format!("`{room}` must never know `{other}`"));
    }
    // Pixels are words on their way out; picture memory in blocks lies as textures in blocks do.
    if room == "scan_out" && other != "scene" {
        return Some(format!("`scan_out` imports no other room, not `{other}`"));
    }
    if let Some(own) = place(&GROUND, room) {
        return match place(&GROUND, other) {
            Some(at) if at < own => None,
            _ => Some(format!("`{room}` is on the ground floor, below `{other}`")),
        };
    }
    if GROUND.contains(&other) {
        return None;
    }
    match place(&ROOMS, other) {
        Some(at) if Some(at) < place(&ROOMS, room) => None,
        Some(_) => Some(format!("`{other}` comes after `{room}`")),
        None => Some(format!("`{room}` must not see `{other}`")),
    }
}

fn rust_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            rust_files(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

#[test]
fn rooms_import_upstream_only() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../src");
    let mut files = Vec::new();
    rust_files(&root, &mut files);
    let mut wrong = Vec::new();
    let mut seen: BTreeMap<(String, String), usize> = BTreeMap::new();
    for file in &files {
        let inside = file.strip_prefix(&root).unwrap();
        // Unit tests in files of their own.
        if inside
            .iter()
            .any(|part| part == "tests" || part == "tests.rs")
        {
            continue;
        }
        let room = inside.iter().next().unwrap().to_str().unwrap();
        let room = room.trim_end_matches(".rs").to_owned();
        for (line, other) in imports(&fs::read_to_string(file).unwrap()) {
            if let Some(why) = forbidden(&room, &other) {
                wrong.push(format!("src/{}:{line}: {why}", inside.display()));
            }
            *seen.entry((room.clone(), other)).or_default() += 1;
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    // The reader sees what is there.
    assert!(files.len() > 20, "{} files", files.len());
    for (room, other) in [
        ("geometry", "num"),
        ("scene", "arena"),
        ("active", "link"),
        ("look", "scene"),
        ("frame", "active"),
        ("player", "list"),
    ] {
        let key = (room.to_owned(), other.to_owned());
        assert!(seen.contains_key(&key), "{room} imports {other}: not found");
    }
}

#[test]
fn the_reader_finds_every_form() {
    let text = "use crate::span::{Span, x::y};\n// use crate::comment;\nuse crate::{\n    num::Edge,\n    \
                link::{Link, b},\n    look,\n};\nfn f() -> crate::visible::A { $crate::macro_name; }\n\
                pub(crate) fn g() {}\n#[cfg(test)]\nmod tests {\n    use crate::frame::R;\n}\n";
    let found: Vec<_> = imports(text).into_iter().map(|(_, name)| name).collect();
    assert_eq!(found, ["span", "num", "link", "look", "visible"]);
    assert_eq!(imports("\n\nuse crate::num;")[0].0, 3);
}

#[test]
fn the_order_refuses_what_it_must() {
    for (room, other) in [
        ("active", "geometry"),
        ("visible", "look"),
        ("scene", "pixel"),
        ("scan_out", "num"),
        ("scan_out", "pixel"),
        ("geometry", "active"),
        ("num", "link"),
        ("link", "frame"),
        ("frame", "player"),
        ("look", "lib"),
        ("cellar", "num"),
        ("look", "texture"),
    ] {
        assert!(forbidden(room, other).is_some(), "{room} -> {other}");
    }
    for (room, other) in [
        ("look", "geometry"),
        ("geometry", "num"),
        ("frame", "scan_out"),
        ("active", "active"),
        ("stats", "event"),
        ("scan_out", "scene"),
        ("lib", "frame"),
    ] {
        assert_eq!(forbidden(room, other), None, "{room} -> {other}");
    }
}
