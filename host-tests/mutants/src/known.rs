//! Mutants that are known to live.

use std::collections::BTreeSet;
use std::path::Path;

/// The file, from the root.
pub const FILE: &str = "host-tests/figures/mutants.txt";

/// Names of mutants, each of which has a reason on the lines below it.
///
/// # Errors
/// A file that cannot be read, a name without a reason, and one that is there twice.
pub fn read(root: &Path) -> Result<BTreeSet<String>, String> {
    let text = std::fs::read_to_string(root.join(FILE));
    parse(&text.map_err(|error| format!("{FILE}: {error}"))?)
}

fn parse(text: &str) -> Result<BTreeSet<String>, String> {
    let mut names = BTreeSet::new();
    let mut waiting: Option<&str> = None;
    for line in text.lines().filter(|line| !line.starts_with('#')) {
        if line.starts_with(' ') || line.is_empty() {
            if !line.trim().is_empty() {
                waiting = None;
            }
            continue;
        }
        if let Some(name) = waiting {
            return Err(format!("{FILE}: no reason stands below {name}"));
        }
        if !names.insert(line.to_owned()) {
            return Err(format!("{FILE}: twice there: {line}"));
        }
        waiting = Some(line);
    }
    match waiting {
        Some(name) => Err(format!("{FILE}: no reason stands below {name}")),
        None => Ok(names),
    }
}

#[cfg(test)]
mod tests {
    use super::parse;

    /// Kills: names without a reason, and names that hide one another.
    #[test]
    fn every_name_has_a_reason() {
        let names = parse("# head\na\n  why\n  so\nb\n  why\n").unwrap();
        assert_eq!(names.into_iter().collect::<Vec<_>>(), ["a", "b"]);
        assert!(parse("a\nb\n  why\n").is_err());
        assert!(parse("a\n  why\nb\n").is_err());
        assert!(parse("a\n  why\na\n  why\n").is_err());
    }
}
