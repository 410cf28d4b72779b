//! Tries mutants by the firmware, as CI does: its frames in QEMU against those that are drawn on this
//! computer, and what all of it costs against the record.

use crate::case::{self, End};
use crate::site::Source;
use crate::tree::{self, Files};
use crate::{say, weave};
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// A copy of the project that the firmware is built in, and the tool that runs it: of what is not
/// mutated.
#[derive(Debug)]
pub struct Shop {
    tree: PathBuf,
    build: PathBuf,
    tool: PathBuf,
    /// How long all of it takes without a mutant.
    usual: Duration,
}

impl Shop {
    /// Builds the tool, and tries what is not mutated.
    ///
    /// # Errors
    /// What does not compile, and firmware that does not pass as it is.
    pub fn new(folder: &Path, files: &Files) -> Result<Self, String> {
        say!("building the firmware in {}", folder.display());
        let [tree, build] = ["tree", "build"].map(|name| folder.join(name));
        tree::write(&tree, files)?;
        let mut cargo = Command::new("cargo");
        cargo
            .args(["build", "--quiet", "--package", "host-tests"])
            .args(["--bin", "scanbeam"])
            .current_dir(&tree)
            .env("CARGO_TARGET_DIR", &build);
        let status = cargo.status().map_err(|error| format!("cargo: {error}"))?;
        if !status.success() {
            return Err("cargo built no tool".to_owned());
        }
        let mut shop = Self {
            tool: build.join("debug/scanbeam"),
            tree,
            build,
            usual: Duration::from_secs(3600),
        };
        // Once more, for the time that it takes where all but the crate is built.
        shop.passes()?;
        let begun = Instant::now();
        shop.passes()?;
        shop.usual = begun.elapsed();
        Ok(shop)
    }

    /// Tries the firmware as it is.
    ///
    /// # Errors
    /// Firmware that does not pass.
    pub fn passes(&self) -> Result<(), String> {
        match self.run(Stdio::inherit())? {
            End::Passed => Ok(()),
            end => Err(format!("the firmware without a mutant: {end:?}")),
        }
    }

    /// Tries a mutant.
    ///
    /// # Errors
    /// Files that cannot be written, and programs that cannot be run.
    pub fn one(&self, source: &Source, id: usize) -> Result<End, String> {
        let path = self.tree.join(&source.file);
        tree::write_one(&path, mutated(source, id).as_bytes())?;
        let end = self.run(Stdio::null());
        tree::write_one(&path, source.text.as_bytes())?;
        end
    }

    /// What is wrong goes to `errors`.
    fn run(&self, errors: Stdio) -> Result<End, String> {
        let mut command = Command::new(&self.tool);
        command
            .args(["firmware", "--bench", "--json", "--board", "m4"])
            .current_dir(&self.tree)
            .env("CARGO_TARGET_DIR", &self.build)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(errors);
        let limit = Duration::from_secs(30) + 5 * self.usual;
        Ok(match case::ended(&mut command, limit)? {
            None => End::Late,
            Some(status) if status.success() => End::Passed,
            Some(_) => End::Failed,
        })
    }
}

/// The source of a file with one mutant, and without a question.
fn mutated(source: &Source, id: usize) -> String {
    let constant: HashSet<String> = (source.const_fns.iter())
        .map(|function| function.name.clone())
        .collect();
    let woven = weave::weave(source, |other| other == id, &constant);
    woven.text.replace(&weave::question(id), "true")
}

#[cfg(test)]
mod tests {
    use super::mutated;
    use crate::scan;

    /// Kills: functions that are not constant any more, and mutants that are not on.
    #[test]
    fn one_mutant_is_on() {
        let mut mutants = Vec::new();
        let text = "const fn f(a: u8) -> B { a - 1 }".to_owned();
        let source = scan::file("src/a.rs", text, &mut mutants).unwrap();
        assert_eq!(
            mutated(&source, 1),
            "const fn f(a: u8) -> B { a - (if true { 2 } else { 1 }) }"
        );
    }
}
