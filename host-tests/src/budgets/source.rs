//! Counts of the crate's source: lines of code, traits, names and functions, without tests and
//! comments.

use super::lexer::{Kind, Untested, Word, closed, untested, words};
use crate::stdio;
use std::collections::BTreeSet;
use std::error::Error;
use std::path::{Path, PathBuf};

/// Lines that a file should not have more of.
pub const LONG_FILE: usize = 500;
/// Values that a function should not take as many of.
const MANY_VALUES: usize = 8;

/// What the source has.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Counts {
    /// Lines with code on them, tests left out.
    pub code_lines: usize,
    /// Traits.
    pub traits: usize,
    /// Constants of traits that are true or false.
    pub bools: usize,
    /// Functions that take 8 or more values, once tuples are opened.
    pub wide_functions: usize,
    /// Functions that take a tuple.
    pub tuple_functions: usize,
    /// Files of more than 500 lines, tests among them.
    pub long_files: usize,
    /// Names at the root.
    pub root_names: usize,
    /// Names of all public modules, those at the root among them.
    pub names: usize,
}

/// Counts the crate whose folder of sources this is.
///
/// # Errors
/// When a file cannot be read.
pub fn count(src: &Path) -> Result<Counts, Box<dyn Error>> {
    let mut files = BTreeSet::new();
    find(src, &mut files)?;
    let mut sources = Vec::new();
    for file in &files {
        let text = std::fs::read_to_string(file)
            .map_err(|error| format!("{}: {}", file.display(), stdio::reason(&error)))?;
        sources.push((file.clone(), text));
    }
    Ok(count_sources(&sources))
}

/// All files of Rust below a folder.
fn find(folder: &Path, files: &mut BTreeSet<PathBuf>) -> Result<(), Box<dyn Error>> {
    let unread = |error: std::io::Error| format!("{}: {}", folder.display(), stdio::reason(&error));
    for entry in std::fs::read_dir(folder).map_err(unread)? {
        let path = entry.map_err(unread)?.path();
        if path.is_dir() {
            find(&path, files)?;
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.insert(path);
        }
    }
    Ok(())
}

/// Counts sources by their paths, of which `lib.rs` is the root.
pub fn count_sources(sources: &[(PathBuf, String)]) -> Counts {
    let mut counts = Counts::default();
    let read: Vec<_> = sources
        .iter()
        .map(|(path, text)| (path, text, untested(&words(text))))
        .collect();
    let mut tests: Vec<PathBuf> = Vec::new();
    for (path, _, kept) in &read {
        tests.extend(kept.test_modules.iter().map(|name| beside(path).join(name)));
    }
    let is_test = |path: &Path| {
        tests
            .iter()
            .any(|test| path.with_extension("") == *test || path.starts_with(test))
    };
    for (path, text, kept) in &read {
        counts.long_files += usize::from(text.lines().count() > LONG_FILE);
        if is_test(path) {
            continue;
        }
        let words = &kept.words;
        let lines: BTreeSet<usize> = words.iter().flat_map(|w| w.line..=w.end).collect();
        counts.code_lines += lines.len();
        items(words, &mut counts);
    }
    let root = read.iter().find(|(path, ..)| path.ends_with("lib.rs"));
    if let Some((root, _, kept)) = root {
        counts.root_names = public_names(&kept.words).len();
        counts.names = counts.root_names;
        counts.names += names_within(root, root, kept, &read);
    }
    counts
}

/// The folder of a file's modules.
fn beside(file: &Path) -> PathBuf {
    let folder = file.parent().unwrap_or(Path::new(""));
    match file.file_stem().and_then(|stem| stem.to_str()) {
        Some("mod" | "lib" | "main") | None => folder.to_path_buf(),
        Some(stem) => folder.join(stem),
    }
}

/// Names in the public modules of a file and in theirs: its own, and those that it takes from its rooms.
fn names_within(
    root: &Path,
    path: &Path,
    kept: &Untested<'_>,
    read: &[(&PathBuf, &String, Untested<'_>)],
) -> usize {
    let mut names = 0;
    for module in public_modules(&kept.words) {
        let own = |path: &Path, file: &Path| {
            let folder = beside(path);
            file == folder.join(format!("{module}.rs"))
                || file == folder.join(module).join("mod.rs")
        };
        let own = read.iter().find(|(file, ..)| own(path, file));
        // A room of the root before a module within a room that has the same name.
        let taken = || {
            let files = read
                .iter()
                .filter(|(file, ..)| is_module(root, file, module));
            files.min_by_key(|(file, ..)| file.components().count())
        };
        if let Some((file, _, kept)) = own.or_else(taken) {
            names += public_names(&kept.words).len() + names_within(root, file, kept, read);
        }
    }
    names
}

/// Whether a file is the module of that name, at the root or in one of its rooms.
fn is_module(root: &Path, file: &Path, name: &str) -> bool {
    let folder = root.parent().unwrap_or(Path::new(""));
    let Ok(within) = file.strip_prefix(folder) else {
        return false;
    };
    let parts: Vec<_> = within.iter().filter_map(|part| part.to_str()).collect();
    match parts[..] {
        [module, "mod.rs"] | [_, module, "mod.rs"] => module == name,
        [file] => file.strip_suffix(".rs") == Some(name),
        _ => false,
    }
}

/// Counts what stands in a file.
fn items(words: &[Word<'_>], counts: &mut Counts) {
    for (at, word) in words.iter().enumerate() {
        let is_name = |word: &Word<'_>| word.kind == Kind::Name;
        if !is_name(word) || !words.get(at + 1).is_some_and(is_name) {
            continue;
        }
        match word.text {
            "trait" => {
                counts.traits += 1;
                let open = (at..words.len()).find(|i| words[*i].is("{") || words[*i].is(";"));
                let open = open.unwrap_or(at);
                counts.bools += bools(&words[open..=closed(words, open)]);
            }
            "fn" => {
                let open = at + 2 + generics(&words[at + 2..]);
                let values = values(&words[open..=closed(words, open)]);
                counts.wide_functions += usize::from(values.all >= MANY_VALUES);
                counts.tuple_functions += usize::from(values.tuples > 0);
            }
            _ => {}
        }
    }
}

/// Constants of type `bool`.
fn bools(body: &[Word<'_>]) -> usize {
    let is_bool = |w: &&[Word<'_>]| w[0].is("const") && w[2].is(":") && w[3].is("bool");
    body.windows(4).filter(is_bool).count()
}

/// How many words the angle brackets at the start take, with what is between them; 0 where there are none.
fn generics(words: &[Word<'_>]) -> usize {
    if !words.first().is_some_and(|word| word.is("<")) {
        return 0;
    }
    let mut depth = 0;
    for (at, word) in words.iter().enumerate() {
        let arrow = at > 0 && words[at - 1].is("-");
        match word.text {
            "<" | "(" | "[" => depth += 1,
            ")" | "]" => depth -= 1,
            ">" if !arrow => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return at + 1;
        }
    }
    words.len()
}

/// What a function takes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
struct Values {
    /// Values, with tuples opened; `self` is one.
    all: usize,
    /// Tuples.
    tuples: usize,
}

/// What stands between the round brackets `words`.
fn values(words: &[Word<'_>]) -> Values {
    let mut values = Values::default();
    for parameter in parts(words) {
        // The type, behind the first `:` that is not within brackets and not half of a `::`.
        let start = type_of(parameter);
        open_tuple(&parameter[start..], &mut values);
    }
    values
}

/// Adds a type: one value, or those of a tuple.
fn open_tuple(kind: &[Word<'_>], values: &mut Values) {
    let bare = kind
        .iter()
        .position(|word| !(word.is("&") || word.is("mut") || word.kind == Kind::Literal));
    let bare = &kind[bare.unwrap_or(0)..];
    let is_tuple =
        bare.first().is_some_and(|word| word.is("(")) && closed(bare, 0) + 1 == bare.len();
    let inner = if is_tuple { parts(bare) } else { Vec::new() };
    if inner.len() < 2 {
        values.all += 1;
        return;
    }
    values.tuples += 1;
    for part in inner {
        open_tuple(part, values);
    }
}

/// Where a parameter's type starts.
fn type_of(parameter: &[Word<'_>]) -> usize {
    let mut depth = 0;
    for (at, word) in parameter.iter().enumerate() {
        match word.text {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth -= 1,
            ":" if depth == 0 => return at + 1,
            _ => {}
        }
    }
    0
}

/// What stands between the commas of a bracket and its end.
fn parts<'w, 's>(words: &'w [Word<'s>]) -> Vec<&'w [Word<'s>]> {
    let inside = &words[1..words.len().saturating_sub(1).max(1)];
    let mut parts = Vec::new();
    let (mut depth, mut start) = (0, 0);
    for (at, word) in inside.iter().enumerate() {
        let arrow = at > 0 && inside[at - 1].is("-");
        match word.text {
            "(" | "[" | "{" | "<" => depth += 1,
            ")" | "]" | "}" => depth -= 1,
            ">" if !arrow => depth -= 1,
            "," if depth == 0 => {
                parts.push(&inside[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    parts.push(&inside[start..]);
    parts.retain(|part| !part.is_empty());
    parts
}

/// Names that a module's file gives to everybody: what it takes over by `pub use`, and what it
/// defines.
fn public_names<'s>(words: &[Word<'s>]) -> BTreeSet<&'s str> {
    let mut names = BTreeSet::new();
    let mut at = 0;
    while at + 1 < words.len() {
        let next = words[at + 1];
        match words[at].text {
            "pub" if next.is("use") => {
                let end = (at..words.len()).find(|i| words[*i].is(";"));
                let end = end.unwrap_or(words.len());
                let last_of_path = |i: &usize| {
                    let behind = words.get(i + 1);
                    words[*i].kind == Kind::Name
                        && behind.is_none_or(|w| w.is(",") || w.is("}") || w.is(";"))
                };
                names.extend((at + 2..end).filter(last_of_path).map(|i| words[i].text));
                at = end;
            }
            "pub" => {
                let kinds = [
                    "fn", "struct", "enum", "trait", "type", "const", "static", "mod",
                ];
                let named = (at + 1..words.len().min(at + 5))
                    .find(|i| kinds.iter().any(|kind| words[*i].is(kind)))
                    .filter(|_| !next.is("("));
                names.extend(named.and_then(|i| words.get(i + 1)).map(|word| word.text));
                at += 1;
            }
            "{" => at = closed(words, at) + 1,
            _ => at += 1,
        }
    }
    names
}

/// Modules that the root gives to everybody.
fn public_modules<'s>(words: &[Word<'s>]) -> Vec<&'s str> {
    let lower = |name: &&str| name.chars().all(|c| c.is_ascii_lowercase() || c == '_');
    public_names(words).into_iter().filter(lower).collect()
}
