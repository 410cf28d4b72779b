//! Which mutants each test reaches, and how long it takes.

use crate::case::{Bench, End, Program, Run};
use crate::{say, work};
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::Path;
use std::time::Duration;

/// A test that takes longer alone is left out.
pub const LONGEST: Duration = Duration::from_secs(20);

/// A test, tried without a mutant.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Case {
    /// Where it is.
    pub program: Program,
    /// Its name.
    pub name: String,
    /// How long it took.
    pub seconds: f64,
    /// Why it is left out.
    pub left_out: Option<String>,
    /// The mutants that it reaches.
    pub reached: Vec<usize>,
}

/// All tests, with what they reach. What was found for the same sources before is read again.
///
/// # Errors
/// Programs that cannot be run, and files that cannot be written.
pub fn all(bench: &Bench, jobs: usize, kept: &Path) -> Result<Vec<Case>, String> {
    let old = fs::read(kept).ok();
    if let Some(cases) = old.and_then(|text| serde_json::from_slice(&text).ok()) {
        return Ok(cases);
    }
    let mut tests = Vec::new();
    let has_proofs = bench.programs.proofs.is_some();
    let programs = [Some(Program::Unit), has_proofs.then_some(Program::Proofs)];
    for program in programs.into_iter().flatten() {
        let names = bench.list(program)?;
        tests.extend(names.into_iter().map(|name| (program, name)));
    }
    say!(
        "running {} tests one by one, to see what each reaches",
        tests.len()
    );
    let mut cases = work::share(jobs, tests.len(), |worker, at| {
        let (program, name) = &tests[at];
        one(bench, *program, name, worker).map(Some)
    })?;
    cases.sort_by(|one, other| one.seconds.total_cmp(&other.seconds));
    let text = serde_json::to_vec(&cases).map_err(|error| error.to_string())?;
    fs::write(kept, text).map_err(|error| format!("{}: {error}", kept.display()))?;
    Ok(cases)
}

fn one(bench: &Bench, program: Program, name: &str, worker: usize) -> Result<Case, String> {
    let reached = bench.scratch.join(format!("reached-{worker}"));
    let _ = fs::remove_file(&reached);
    let (end, time) = bench.run(&Run {
        program,
        tests: &[name],
        mutant: "reached",
        reached: reached.clone(),
        limit: LONGEST,
        worker,
    })?;
    // Programs that a test starts write what they reach too.
    let text = fs::read_to_string(&reached).unwrap_or_default();
    let mut ids: Vec<usize> = text.lines().filter_map(|line| line.parse().ok()).collect();
    ids.sort_unstable();
    ids.dedup();
    let left_out = match end {
        End::Passed => None,
        End::Late => Some(format!("takes more than {} s", LONGEST.as_secs())),
        End::Failed | End::Overflowed => Some("fails in the copy without a mutant".to_owned()),
    };
    Ok(Case {
        program,
        name: name.to_owned(),
        seconds: time.as_secs_f64(),
        reached: if left_out.is_some() { Vec::new() } else { ids },
        left_out,
    })
}
