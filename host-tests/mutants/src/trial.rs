//! Tries mutants by the tests that reach them.

use crate::case::{Bench, End, Program, Run};
use crate::firmware::Shop;
use crate::reach::Case;
use crate::site::Source;
use crate::tree::{self, Files};
use crate::{say, work};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, HashMap};
use std::fs;
use std::io::Write;
use std::path::PathBuf;
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// What became of a mutant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Fate {
    /// A test failed.
    Killed,
    /// A test failed as arithmetic went out of its range, which is checked in tests alone.
    Overflowed,
    /// A test took far too long.
    Late,
    /// All tests passed, but the firmware drew something else, or at a cost that is not recorded.
    Dearer,
    /// All tests that reach it passed.
    Lived,
    /// The fastest tests that reach it passed; there was no time for the others.
    Open,
    /// No test reaches it.
    Unreached,
}

/// A mutant that was tried.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Tried {
    /// Its number.
    pub id: usize,
    /// What became of it.
    pub fate: Fate,
    /// The test that failed; of unit tests, which are run together, `unit`.
    pub by: Option<String>,
    /// How long it took to find out.
    pub seconds: f64,
    /// Seconds of tests that there was time for.
    #[serde(default)]
    pub patience: u64,
    /// Whether it was tried by the firmware as well.
    #[serde(default)]
    pub firmware: bool,
}

impl Tried {
    /// Whether nothing noticed it so far.
    #[must_use]
    pub fn lives(&self) -> bool {
        matches!(self.fate, Fate::Lived | Fate::Open | Fate::Unreached)
    }
}

/// What mutants are tried with.
#[derive(Debug)]
pub struct Court<'a> {
    /// Where tests are run.
    pub bench: &'a Bench,
    /// Those that count, the fastest first.
    pub cases: &'a [Case],
    /// Files that a test may change in the copy: they are put back.
    pub guarded: &'a Files,
    /// Where what became of each mutant is appended.
    pub kept: PathBuf,
    /// Seconds of tests after which no further one is begun, as they take without a mutant.
    pub patience: u64,
    /// Mutants that are tried at the same time.
    pub jobs: usize,
}

impl<'a> Court<'a> {
    /// What became of mutants before, with the same sources.
    #[must_use]
    pub fn before(&self) -> BTreeMap<usize, Tried> {
        let text = fs::read_to_string(&self.kept).unwrap_or_default();
        let all = text.lines().filter_map(|line| {
            let tried: Tried = serde_json::from_str(line).ok()?;
            Some((tried.id, tried))
        });
        all.collect()
    }

    /// Tries mutants in this order, until the deadline.
    ///
    /// # Errors
    /// Programs that cannot be run, and files that cannot be written.
    pub fn hear(&self, ids: &[usize], deadline: Instant) -> Result<Vec<Tried>, String> {
        let mut of: HashMap<usize, Vec<&Case>> = HashMap::new();
        for case in self.cases {
            for id in &case.reached {
                of.entry(*id).or_default().push(case);
            }
        }
        let kept = self.open()?;
        work::share(self.jobs, ids.len(), |worker, at| {
            if Instant::now() >= deadline {
                return Ok(None);
            }
            let id = ids[at];
            let cases = of.get(&id).map_or(&[][..], Vec::as_slice);
            let tried = self.one(id, cases, worker)?;
            self.put_back()?;
            self.keep(&kept, &tried)?;
            Ok(Some(tried))
        })
    }

    fn one(&self, id: usize, cases: &[&Case], worker: usize) -> Result<Tried, String> {
        let begun = Instant::now();
        let mutant = id.to_string();
        let is_unit = |case: &&&Case| case.program == Program::Unit;
        let unit: Vec<&Case> = cases.iter().filter(is_unit).copied().collect();
        let proofs = cases.iter().filter(|case| !is_unit(case));
        let groups = in_steps(&unit).into_iter();
        let groups = groups.chain(proofs.map(|case| vec![*case]));
        let mut found = (Fate::Unreached, None);
        let mut spent = 0.0;
        for group in groups {
            let names: Vec<&str> = group.iter().map(|case| case.name.as_str()).collect();
            let seconds: f64 = group.iter().map(|case| case.seconds).sum();
            if spent > 0.0 && spent + seconds > self.patience as f64 {
                found = (Fate::Open, None);
                break;
            }
            spent += seconds;
            let (end, _) = self.bench.run(&Run {
                program: group[0].program,
                tests: &names,
                mutant: &mutant,
                reached: PathBuf::new(),
                limit: Duration::from_secs_f64(5.0 + 5.0 * seconds),
                worker,
            })?;
            let by = (names.len() == 1).then(|| names[0].to_owned());
            let by = by.or_else(|| Some("unit".to_owned()));
            found = match end {
                End::Passed => (Fate::Lived, None),
                End::Failed => (Fate::Killed, by),
                End::Overflowed => (Fate::Overflowed, by),
                End::Late => (Fate::Late, by),
            };
            if end != End::Passed {
                break;
            }
        }
        Ok(Tried {
            id,
            fate: found.0,
            by: found.1,
            seconds: begun.elapsed().as_secs_f64(),
            patience: self.patience,
            firmware: false,
        })
    }

    /// Tries mutants that live by the firmware, until the deadline.
    ///
    /// # Errors
    /// Firmware that does not pass as it is, programs that cannot be run, and files that cannot be written.
    pub fn hear_firmware(
        &self,
        living: &[Tried],
        shops: &[Shop],
        source: impl Fn(usize) -> Option<&'a Source> + Sync,
        deadline: Instant,
    ) -> Result<Vec<Tried>, String> {
        let kept = self.open()?;
        let heard = work::share(shops.len(), living.len(), |worker, at| {
            let mut tried = living[at].clone();
            let Some(source) = source(tried.id).filter(|_| Instant::now() < deadline) else {
                return Ok(None);
            };
            let begun = Instant::now();
            if shops[worker].one(source, tried.id)? != End::Passed {
                tried.fate = Fate::Dearer;
            }
            tried.firmware = true;
            tried.seconds += begun.elapsed().as_secs_f64();
            self.keep(&kept, &tried)?;
            Ok(Some(tried))
        })?;
        // What failed failed by the mutants.
        shops.iter().try_for_each(Shop::passes)?;
        Ok(heard)
    }

    fn open(&self) -> Result<Mutex<fs::File>, String> {
        let kept = fs::OpenOptions::new()
            .create(true)
            .append(true)
            .open(&self.kept);
        kept.map(Mutex::new).map_err(|error| self.told(&error))
    }

    /// Appends what became of a mutant.
    fn keep(&self, kept: &Mutex<fs::File>, tried: &Tried) -> Result<(), String> {
        let line = serde_json::to_string(tried).map_err(|error| error.to_string())?;
        let mut kept = kept.lock().map_err(|error| error.to_string())?;
        writeln!(kept, "{line}").map_err(|error| self.told(&error))
    }

    fn told(&self, error: &std::io::Error) -> String {
        format!("{}: {error}", self.kept.display())
    }

    fn put_back(&self) -> Result<(), String> {
        for (name, content) in self.guarded {
            if tree::write_one(&self.bench.tree.join(name), content)? {
                say!("a test had changed {name} in the copy: it was put back");
            }
        }
        Ok(())
    }
}

/// Unit tests, the fastest first, as the programs that run them: the first has those of a fifth of a second, and each has
/// four times as long as the one before. A mutant that is noticed is so by the first, and one that never ends holds
/// nobody up for as long as the slowest might take.
fn in_steps<'a>(unit: &[&'a Case]) -> Vec<Vec<&'a Case>> {
    let (mut steps, mut seconds, mut most) = (Vec::<Vec<&Case>>::new(), 0.0, 0.2);
    for case in unit {
        match steps.last_mut() {
            Some(step) if seconds + case.seconds <= most => {
                step.push(case);
                seconds += case.seconds;
            }
            last => {
                most *= if last.is_some() { 4.0 } else { 1.0 };
                steps.push(vec![case]);
                seconds = case.seconds;
            }
        }
    }
    steps
}

/// Numbers in a random order, which is the same for the same seed.
pub fn shuffle(numbers: &mut [usize], seed: u64) {
    let mut state = seed;
    for at in (1..numbers.len()).rev() {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = state;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^= mixed >> 31;
        // Far fewer than 2^32 are shuffled, so the remainder is as good as even.
        let other = usize::try_from(mixed % (at as u64 + 1)).unwrap_or(0);
        numbers.swap(at, other);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Kills: a step that never ends, tests that are lost between two, one slow test that has to share.
    #[test]
    fn steps_have_all_tests_in_order_and_grow() {
        let case = |seconds: f64| Case {
            program: Program::Unit,
            name: String::new(),
            seconds,
            left_out: None,
            reached: Vec::new(),
        };
        let cases = [0.05, 0.1, 0.1, 0.2, 0.3, 0.4, 5.0, 6.0].map(case);
        let steps = in_steps(&cases.iter().collect::<Vec<_>>());
        let seconds = |step: &Vec<&Case>| step.iter().map(|case| case.seconds).collect::<Vec<_>>();
        let wanted: [&[f64]; 4] = [&[0.05, 0.1], &[0.1, 0.2, 0.3], &[0.4], &[5.0, 6.0]];
        assert!(steps.iter().map(seconds).eq(wanted));
        assert!(in_steps(&[]).is_empty());
    }
}
