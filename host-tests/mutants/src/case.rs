//! Tests as programs that are run.

use crate::compile::Programs;
use std::fs;
use std::os::unix::process::CommandExt;
use std::path::PathBuf;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Memory that a program of tests may have, in kilobytes, and the longest file, in blocks of 512 bytes.
const LIMITS: &str = "ulimit -v 6000000; ulimit -f 2000000; exec \"$@\"";

/// Which program a test is in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Program {
    /// Unit tests of the crate.
    Unit,
    /// Proofs.
    Proofs,
}

/// How tests end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// All of them passed.
    Passed,
    /// One of them failed, or the program broke.
    Failed,
    /// Arithmetic went out of its range first, which builds without checks would not notice.
    Overflowed,
    /// They took longer than they may.
    Late,
}

/// Where tests are run.
#[derive(Debug)]
pub struct Bench {
    /// The programs.
    pub programs: Programs,
    /// The copy of the project.
    pub tree: PathBuf,
    /// What is built of it.
    pub build: PathBuf,
    /// Where what programs print is kept.
    pub scratch: PathBuf,
}

/// A run of some tests of one program.
#[derive(Debug)]
pub struct Run<'a> {
    /// The program.
    pub program: Program,
    /// Names of the tests.
    pub tests: &'a [&'a str],
    /// For the environment: the number of a mutant, or `reached`.
    pub mutant: &'a str,
    /// Where what is reached is appended.
    pub reached: PathBuf,
    /// The longest time.
    pub limit: Duration,
    /// Which of those that run at the same time.
    pub worker: usize,
}

impl Bench {
    fn command(&self, program: Program) -> Command {
        let proofs = self.programs.proofs.as_ref();
        let (path, folder) = match program {
            Program::Unit => (&self.programs.unit, self.tree.clone()),
            Program::Proofs => (
                proofs.unwrap_or(&self.programs.unit),
                self.tree.join("host-tests"),
            ),
        };
        let mut command = Command::new("sh");
        command
            .args(["-c", LIMITS, "sh"])
            .arg(path)
            .current_dir(folder)
            .env("CARGO_TARGET_DIR", &self.build)
            .stdin(Stdio::null());
        command
    }

    /// The names of a program's tests, without those that run when asked alone.
    ///
    /// # Errors
    /// A program that cannot be run.
    pub fn list(&self, program: Program) -> Result<Vec<String>, String> {
        let names = |options: &[&str]| -> Result<Vec<String>, String> {
            let output = self
                .command(program)
                .args(["--list", "--format=terse"])
                .args(options)
                .output()
                .map_err(|error| format!("{program:?}: {error}"))?;
            let text = String::from_utf8_lossy(&output.stdout);
            let tests = text.lines().filter_map(|line| line.strip_suffix(": test"));
            Ok(tests.map(str::to_owned).collect())
        };
        let ignored = names(&["--ignored"])?;
        let mut all = names(&[])?;
        // Those of the tool's parts are no proofs of the crate, and some build firmware.
        let is_of_hosts = |name: &str| {
            ["tool::", "support::"]
                .iter()
                .any(|of| name.starts_with(of))
        };
        all.retain(|name| !ignored.contains(name) && !is_of_hosts(name));
        if all.is_empty() {
            return Err(format!("{program:?}: there are no tests"));
        }
        Ok(all)
    }

    /// Runs tests one after the other.
    ///
    /// # Errors
    /// A program that cannot be run.
    pub fn run(&self, run: &Run) -> Result<(End, Duration), String> {
        let told = |error: std::io::Error| format!("{}: {error}", self.scratch.display());
        let printed = self.scratch.join(format!("printed-{}", run.worker));
        let file = fs::File::create(&printed).map_err(told)?;
        let begun = Instant::now();
        let mut command = self.command(run.program);
        command
            .args(["--exact", "--test-threads=1"])
            .args(run.tests)
            .env("SCANBEAM_MUTANT", run.mutant)
            .env("SCANBEAM_REACHED", &run.reached)
            .env("RUST_BACKTRACE", "0")
            .stdout(file.try_clone().map_err(told)?)
            .stderr(file);
        let status = ended(&mut command, run.limit)?;
        let end = match status {
            None => End::Late,
            Some(status) if status.success() => End::Passed,
            Some(_) => {
                let text = fs::read(&printed).map_err(told)?;
                let text = String::from_utf8_lossy(&text);
                let panic = text.lines().find(|line| is_reason(line)).unwrap_or("");
                if panic.ends_with("with overflow") {
                    End::Overflowed
                } else {
                    End::Failed
                }
            }
        };
        Ok((end, begun.elapsed()))
    }
}

/// Whether a line is the first that a panic gives as its reason.
fn is_reason(line: &str) -> bool {
    line.starts_with("attempt to ")
        || line.starts_with("assertion ")
        || line.starts_with("called `")
        || line.starts_with("index out of bounds")
        || line.starts_with("range ")
}

/// How a program ended; `None` when it took longer than `limit`, and it and all that it has started had to be ended.
///
/// # Errors
/// A program that cannot be run.
pub fn ended(command: &mut Command, limit: Duration) -> Result<Option<ExitStatus>, String> {
    let deadline = Instant::now() + limit;
    let mut child = command
        .process_group(0)
        .spawn()
        .map_err(|error| format!("{}: {error}", command.get_program().display()))?;
    wait(&mut child, deadline)
}

fn wait(child: &mut Child, deadline: Instant) -> Result<Option<ExitStatus>, String> {
    let told = |error: std::io::Error| format!("a program of tests: {error}");
    let mut pause = Duration::from_millis(1);
    loop {
        if let Some(status) = child.try_wait().map_err(told)? {
            return Ok(Some(status));
        }
        if Instant::now() >= deadline {
            let group = format!("-{}", child.id());
            let ended = Command::new("kill").args(["-KILL", "--", &group]).status();
            ended.map_err(told)?;
            child.wait().map_err(told)?;
            return Ok(None);
        }
        sleep(pause);
        pause = (pause * 5 / 4).min(Duration::from_millis(50));
    }
}
