//! Compiles the copy with all mutants in it, and leaves out those that do not compile.

use crate::site::{Mutant, Source};
use crate::weave::{self, Choices, Woven};
use crate::{say, tree};
use serde_json::Value;
use std::collections::{HashMap, HashSet};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Most rounds of compiling: what is found in one round hides what the next one finds.
const ROUNDS: usize = 60;

/// What the proofs and the unit tests are built of.
const TESTS: &str = "-p host-tests -p scanbeam --lib --test proofs";
/// What the unit tests alone are built of.
const UNIT: &str = "-p scanbeam --lib --features async,embedded-graphics,mipidsi";

/// The copy and the sources that are mutated in it.
#[derive(Debug)]
pub struct Copy<'a> {
    /// The folder of the project's copy.
    pub tree: PathBuf,
    /// The folder of what is built.
    pub build: PathBuf,
    /// What is mutated.
    pub sources: &'a [Source],
    /// All mutants.
    pub mutants: &'a [Mutant],
    /// Whether they are tried by unit tests alone.
    pub is_unit: bool,
    /// Those that are compiled in, where not all are.
    pub woven: Option<HashSet<usize>>,
}

/// The programs of tests.
#[derive(Debug, Clone)]
pub struct Programs {
    /// Unit tests of the crate.
    pub unit: PathBuf,
    /// Proofs, where they are asked for.
    pub proofs: Option<PathBuf>,
}

impl Copy<'_> {
    /// Whether a mutant is in what is compiled.
    #[must_use]
    pub fn is_live(&self, choices: &Choices, id: usize) -> bool {
        let within = &self.mutants[id].const_fn;
        let is_constant = within
            .as_ref()
            .is_some_and(|name| choices.constant.contains(name));
        let is_woven = self.woven.as_ref().is_none_or(|woven| woven.contains(&id));
        is_woven && !is_constant && !choices.dropped.contains(&id)
    }

    /// Leaves out what does not compile: `choices` is what was left out before.
    ///
    /// # Errors
    /// What does not compile for another reason.
    pub fn make_compile(&self, choices: &mut Choices) -> Result<(), String> {
        self.rounds("check", UNIT, choices)?;
        if !self.is_unit {
            self.rounds("check", TESTS, choices)?;
        }
        Ok(())
    }

    /// Builds the programs.
    ///
    /// # Errors
    /// What does not compile, and programs that are missing.
    pub fn build(&self, choices: &mut Choices) -> Result<Programs, String> {
        say!("building the tests with all mutants in them");
        let tests = if self.is_unit { UNIT } else { TESTS };
        let made = self.rounds("test --no-run", tests, choices)?;
        // The tool has the name of the crate.
        let program = |kind: &str, name: &str| {
            let found = made.iter().rev().find(|artifact| {
                artifact["target"]["name"] == name
                    && artifact["target"]["kind"][0] == kind
                    && artifact["profile"]["test"] == true
            });
            let path = found.and_then(|artifact| artifact["executable"].as_str());
            path.map(PathBuf::from)
                .ok_or_else(|| format!("cargo made no tests of {name}"))
        };
        Ok(Programs {
            unit: program("lib", "scanbeam")?,
            proofs: match self.is_unit {
                true => None,
                false => Some(program("test", "proofs")?),
            },
        })
    }

    fn rounds(
        &self,
        command: &str,
        arguments: &str,
        choices: &mut Choices,
    ) -> Result<Vec<Value>, String> {
        for _ in 0..ROUNDS {
            let woven = self.weave(choices)?;
            let (made, errors) = self.cargo(command, arguments)?;
            if errors.is_empty() {
                return Ok(made);
            }
            let before = (choices.dropped.len(), choices.constant.len());
            for error in &errors {
                blame(error, &woven, choices);
            }
            let (dropped, constant) = (choices.dropped.len(), choices.constant.len());
            say!(
                "{} errors of compilation: {dropped} mutants left out, {constant} functions stay constant",
                errors.len()
            );
            if (dropped, constant) == before {
                let rendered = errors.iter().filter_map(|error| error["rendered"].as_str());
                let text: Vec<&str> = rendered.take(5).collect();
                return Err(format!("no mutant is to blame for:\n{}", text.join("\n")));
            }
        }
        Err("mutants that do not compile do not come to an end".to_owned())
    }

    fn weave(&self, choices: &Choices) -> Result<HashMap<String, Woven>, String> {
        let mut all = HashMap::new();
        for source in self.sources {
            let mut woven = weave::weave(source, |id| self.is_live(choices, id), &choices.constant);
            if source.file == "src/lib.rs" {
                woven.text += "\nmod mutant;\n";
            }
            tree::write_one(&self.tree.join(&source.file), woven.text.as_bytes())?;
            all.insert(source.file.clone(), woven);
        }
        let module = weave::module(self.mutants.len());
        tree::write_one(&self.tree.join("src/mutant.rs"), module.as_bytes())?;
        Ok(all)
    }

    /// What cargo made, and the errors of the compiler.
    fn cargo(&self, command: &str, arguments: &str) -> Result<(Vec<Value>, Vec<Value>), String> {
        let output = cargo_in(&self.tree, &self.build)
            .args(command.split(' '))
            .args(["--quiet", "--message-format=json"])
            .args(arguments.split(' '))
            .output()
            .map_err(|error| format!("cargo: {error}"))?;
        let (mut made, mut errors) = (Vec::new(), Vec::new());
        for line in String::from_utf8_lossy(&output.stdout).lines() {
            let Ok(mut message) = serde_json::from_str::<Value>(line) else {
                continue;
            };
            if message["reason"] == "compiler-artifact" {
                made.push(message);
            } else if message["message"]["level"] == "error" {
                errors.push(message["message"].take());
            }
        }
        if !output.status.success() && errors.is_empty() {
            let text = String::from_utf8_lossy(&output.stderr).into_owned();
            return Err(format!("cargo {command} failed:\n{text}"));
        }
        Ok((made, errors))
    }
}

/// Cargo for the copy. What mutants are warned of, or refused for by a lint, is no error there; with
/// less optimisation they are built in less time.
fn cargo_in(tree: &Path, build: &Path) -> Command {
    let mut cargo = Command::new("cargo");
    cargo
        .current_dir(tree)
        .env("CARGO_TARGET_DIR", build)
        .env("CARGO_INCREMENTAL", "0")
        .env("CARGO_PROFILE_TEST_OPT_LEVEL", "1")
        .env("RUSTFLAGS", "--cap-lints=allow")
        .stdin(Stdio::null());
    cargo
}

/// Leaves out what an error is due to.
fn blame(error: &Value, woven: &HashMap<String, Woven>, choices: &mut Choices) {
    let message = error["message"].as_str().unwrap_or("");
    if message.starts_with("cannot call non-const") {
        choices.constant.extend(called(message));
        return;
    }
    let spans = error["spans"].as_array().map_or(&[][..], Vec::as_slice);
    let guilty = |is_primary: bool| -> HashSet<usize> {
        let of = spans.iter().filter(|span| span["is_primary"] == is_primary);
        of.flat_map(|span| in_span(span, woven)).collect()
    };
    let first = guilty(true);
    let first = if first.is_subset(&choices.dropped) {
        guilty(false)
    } else {
        first
    };
    choices.dropped.extend(first);
}

fn in_span(span: &Value, woven: &HashMap<String, Woven>) -> Vec<usize> {
    let number = |name: &str| {
        let number = span[name].as_u64().unwrap_or(0);
        usize::try_from(number).unwrap_or(0)
    };
    let at: Range<usize> = number("byte_start")..number("byte_end");
    let file = span["file_name"].as_str().unwrap_or("");
    woven
        .get(file)
        .map_or(Vec::new(), |woven| woven.guilty(&at))
}

/// The last name of the path between backquotes, without what stands between angle brackets.
fn called(message: &str) -> Option<String> {
    let path = message.split('`').nth(1)?;
    let mut depth = 0;
    let mut plain = String::new();
    for character in path.chars() {
        match character {
            '<' => depth += 1,
            '>' => depth -= 1,
            _ if depth == 0 => plain.push(character),
            _ => {}
        }
    }
    let name = plain.trim_end_matches(':').rsplit("::").next()?;
    Some(name.to_owned())
}

#[cfg(test)]
mod tests {
    use super::called;

    /// Kills: names with types, and the first name of a path instead of the last.
    #[test]
    fn functions_are_found_in_messages() {
        let name = |path: &str| {
            called(&format!(
                "cannot call non-const method `{path}` in constants"
            ))
        };
        assert_eq!(name("num::bits::low").as_deref(), Some("low"));
        assert_eq!(name("Form::<P>::of").as_deref(), Some("of"));
        assert_eq!(name("list::<impl Form<P>>::of::<3>").as_deref(), Some("of"));
        assert_eq!(called("nothing"), None);
    }
}
