//! Mutants: small changes of `src/`, each of which a unit test or a proof must notice.
//!
//! All of them are compiled into one copy of the project, each behind a question that is asked at run
//! time, so that trying one takes no build: `SCANBEAM_MUTANT` holds the number of the one that is on.
//! First each test runs alone and tells which mutants it reaches. Then mutants are tried in a random
//! order, each by the tests that reach it, the fastest first, until one fails.

mod case;
mod change;
mod compile;
mod firmware;
mod known;
mod reach;
mod report;
mod scan;
mod site;
mod tree;
mod trial;
mod weave;
mod work;

use clap::Parser;
use compile::Copy;
use firmware::Shop;
use reach::Case;
use site::{Mutant, Source};
use std::collections::{BTreeSet, HashSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};
use tree::Files;
use trial::{Court, Fate, Tried};
use weave::Choices;

/// Says on the terminal what is being done.
#[macro_export]
macro_rules! say {
    ($($text:tt)*) => { eprintln!($($text)*) };
}

/// Where the table is written.
const TABLE: &str = "host-tests/figures/mutants.md";

/// What is changed when a test is run anew in the copy: what it blesses.
const GUARDED: [&str; 2] = ["host-tests/figures/", "host-tests/pictures/"];

/// Tries small changes of src/ by the unit tests and the proofs.
#[derive(Debug, Parser)]
#[command(name = "mutants")]
struct Args {
    /// Begins no further mutant after so many seconds of trying.
    #[arg(long, default_value_t = 600)]
    seconds: u64,
    /// Tries all mutants, however long it takes.
    #[arg(long)]
    all: bool,
    /// Tries so many, and no more.
    #[arg(long)]
    count: Option<usize>,
    /// Takes no further test for a mutant after so many seconds of tests, as they take without it.
    #[arg(long, default_value_t = 60)]
    patience: u64,
    /// Decides the order.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Mutants that are tried at the same time; as many as there are processors unless said.
    #[arg(long)]
    jobs: Option<usize>,
    /// Tries them by unit tests alone, which are built in a third of the time, and in less where files are named: then no
    /// others are mutated.
    #[arg(long)]
    unit: bool,
    /// Tries those that live by the firmware as well: its frames and what they cost in QEMU, on the M4.
    #[arg(long)]
    firmware: bool,
    /// Passes where at least so many percent are noticed of those that can be, and not only where no other lives than those
    /// that are known.
    #[arg(long, value_name = "PERCENT")]
    least: Option<f64>,
    /// Prints what would be tried, with the number that SCANBEAM_MUTANT takes, and tries nothing.
    #[arg(long)]
    list: bool,
    /// Writes the table to host-tests/figures/mutants.md.
    #[arg(long)]
    markdown: bool,
    /// Files whose mutants are tried, or FILE:LINE, or folders; all of src/ when none is named.
    files: Vec<String>,
}

impl Args {
    /// Whether only mutants of the files that are named are compiled in.
    fn is_part(&self) -> bool {
        self.unit && !self.files.is_empty()
    }

    /// Until when mutants are tried that are begun now.
    fn deadline(&self) -> Instant {
        let seconds = if self.all {
            u32::MAX.into()
        } else {
            self.seconds
        };
        Instant::now() + Duration::from_secs(seconds)
    }
}

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            say!("error: {error}");
            ExitCode::from(2)
        }
    }
}

/// The project's folder.
fn root() -> Result<PathBuf, String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    root.canonicalize()
        .map_err(|error| format!("{}: {error}", root.display()))
}

/// Whether no mutant lives but those that are known.
fn run(args: &Args) -> Result<bool, String> {
    let root = root()?;
    let known = known::read(&root)?;
    let files = tree::read(&root)?;
    let mut mutants = Vec::new();
    let sources = sources(&files, &mut mutants)?;
    check_known(&known, &mutants)?;
    let chosen = chosen(args, &mutants)?;
    let work = work_folder(&root);
    let copy = Copy {
        tree: work.join("tree"),
        build: work.join("build"),
        sources: &sources,
        mutants: &mutants,
        is_unit: args.unit,
        woven: args.is_part().then(|| chosen.iter().copied().collect()),
    };
    let mut others = files.clone();
    others.retain(|name, _| !sources.iter().any(|source| source.file == *name));
    write_others(&copy, &others)?;
    let mut choices = compiled(&copy, &files, &work)?;
    if args.list {
        for id in chosen.iter().filter(|id| copy.is_live(&choices, **id)) {
            println!("{id} {}", mutants[*id].place());
        }
        return Ok(true);
    }
    let bench = case::Bench {
        programs: copy.build(&mut choices)?,
        tree: copy.tree.clone(),
        build: copy.build.clone(),
        scratch: work.clone(),
    };
    others.retain(|name, _| GUARDED.iter().any(|folder| name.starts_with(folder)));
    let live = |id: &usize| copy.is_live(&choices, *id);
    let dead = match &copy.woven {
        Some(woven) => woven.iter().filter(|id| !live(id)).count(),
        None => (0..mutants.len()).filter(|id| !live(id)).count(),
    };
    let chosen: Vec<usize> = chosen.into_iter().filter(live).collect();
    let project = Project {
        files: &files,
        sources: &sources,
        guarded: &others,
        known: &known,
        mutants: &mutants,
    };
    let found = heard(args, &bench, &project, &chosen)?;
    let dropped = choices.dropped.len();
    let constant = dead.saturating_sub(dropped);
    let told = Told {
        mutants: &mutants,
        known: &known,
        found: &found,
        not_tried: format!(
            "{dropped} more do not compile, and {constant} are in functions that constants are made of."
        ),
    };
    let rows = report::rows(&mutants, |id| live(&id), &found.tried, &known);
    let only_known = told.tell(&rows, args.markdown.then(|| root.join(TABLE)).as_deref())?;
    let Some(least) = args.least else {
        return Ok(only_known);
    };
    let rate = rows.last().and_then(|(_, row)| row.rate());
    let percent = rate.ok_or("no mutant was tried")?.percent;
    say!("{percent:.1} % were noticed, and {least} % have to be");
    Ok(percent >= least)
}

/// What was found.
struct Found {
    tried: Vec<Tried>,
    /// Tests that are not used.
    left_out: Vec<Case>,
}

/// What is tried.
struct Project<'a> {
    files: &'a Files,
    sources: &'a [Source],
    /// Files that a test may change.
    guarded: &'a Files,
    known: &'a BTreeSet<String>,
    mutants: &'a [Mutant],
}

/// Tries mutants.
fn heard(
    args: &Args,
    bench: &case::Bench,
    project: &Project,
    chosen: &[usize],
) -> Result<Found, String> {
    // Stands for all that is tested and all tests.
    let key = tree::hash(project.files, is_tested);
    let processors = || std::thread::available_parallelism().map_or(1, usize::from);
    let jobs = args.jobs.unwrap_or_else(processors);
    let by = match args.unit {
        true if args.is_part() => format!("by-unit-of-{}-", args.files.join("-").replace('/', "_")),
        true => "by-unit-".to_owned(),
        false => String::new(),
    };
    let kept = |what: &str| bench.scratch.join(format!("{what}-{by}{key}.json"));
    let cases = reach::all(bench, jobs, &kept("reached"))?;
    let (cases, left_out): (Vec<Case>, Vec<Case>) =
        cases.into_iter().partition(|case| case.left_out.is_none());
    let court = Court {
        bench,
        cases: &cases,
        guarded: project.guarded,
        kept: kept("tried"),
        patience: args.patience,
        jobs,
    };
    let mut tried = tried(args, &court, chosen)?;
    if args.firmware {
        by_firmware(args, &court, project, &mut tried)?;
    }
    Ok(Found { tried, left_out })
}

/// Tries those that live by the firmware, for as long as mutants may be tried.
fn by_firmware(
    args: &Args,
    court: &Court,
    project: &Project,
    tried: &mut [Tried],
) -> Result<(), String> {
    let name = |tried: &Tried| project.mutants[tried.id].name();
    let is_asked = |tried: &&Tried| !tried.firmware && tried.lives();
    let living: Vec<Tried> = (tried.iter().filter(is_asked))
        .filter(|tried| !project.known.contains(&name(tried)))
        .cloned()
        .collect();
    let mut shops = Vec::new();
    for worker in 0..court.jobs.min(living.len()) {
        let folder = court.bench.scratch.join(format!("firmware-{worker}"));
        shops.push(Shop::new(&folder, project.files)?);
    }
    say!("{} are tried by the firmware", living.len());
    let source = |id: usize| {
        let file = &project.mutants[id].file;
        project.sources.iter().find(|source| source.file == *file)
    };
    let heard = court.hear_firmware(&living, &shops, source, args.deadline())?;
    for one in heard {
        if let Some(old) = tried.iter_mut().find(|old| old.id == one.id) {
            *old = one;
        }
    }
    Ok(())
}

/// Whether what a file says may change what becomes of a mutant.
fn is_tested(name: &str) -> bool {
    let aside = [known::FILE, TABLE, "host-tests/mutants/", ".ci/"];
    !aside.iter().any(|folder| name.starts_with(folder))
}

/// The files of `src/` with their mutants.
fn sources(files: &Files, mutants: &mut Vec<Mutant>) -> Result<Vec<Source>, String> {
    let mut texts = Vec::new();
    let mut tests = Vec::new();
    for (name, content) in files {
        if name.starts_with("src/") && name.ends_with(".rs") {
            let text =
                String::from_utf8(content.clone()).map_err(|error| format!("{name}: {error}"))?;
            tests.extend(scan::test_modules(name, &text));
            texts.push((name, text));
        }
    }
    let is_test = |name: &str| {
        let below = |test: &String| {
            let rest = name.strip_prefix(test.as_str());
            rest.is_some_and(|rest| rest.is_empty() || rest == ".rs" || rest.starts_with('/'))
        };
        tests.iter().any(below)
    };
    let sources = texts.into_iter().filter(|(name, _)| !is_test(name));
    sources
        .map(|(name, text)| scan::file(name, text, mutants))
        .collect()
}

fn check_known(known: &BTreeSet<String>, mutants: &[Mutant]) -> Result<(), String> {
    let names: HashSet<String> = mutants.iter().map(Mutant::name).collect();
    let gone: Vec<&str> = (known.iter())
        .filter(|name| !names.contains(*name))
        .map(String::as_str)
        .collect();
    if gone.is_empty() {
        return Ok(());
    }
    Err(format!(
        "{}: there is no such mutant:\n{}",
        known::FILE,
        gone.join("\n")
    ))
}

/// The mutants that are asked for.
fn chosen(args: &Args, mutants: &[Mutant]) -> Result<Vec<usize>, String> {
    let is_of = |mutant: &Mutant, file: &str| {
        let rest = mutant.file.strip_prefix(file.trim_end_matches('/'));
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
            || format!("{}:{}", mutant.file, mutant.line) == file
    };
    for file in &args.files {
        if !mutants.iter().any(|mutant| is_of(mutant, file)) {
            return Err(format!("{file} has no mutants"));
        }
    }
    let is_chosen = |id: &usize| {
        args.files.is_empty() || args.files.iter().any(|file| is_of(&mutants[*id], file))
    };
    Ok((0..mutants.len()).filter(is_chosen).collect())
}

fn work_folder(root: &Path) -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or(root.join("target"), PathBuf::from);
    std::path::absolute(&target)
        .unwrap_or(target)
        .join("mutants")
}

/// Writes what is not mutated, and leaves there what is.
fn write_others(copy: &Copy, others: &Files) -> Result<(), String> {
    let mut all = others.clone();
    let woven = copy.sources.iter().map(|source| source.file.as_str());
    for name in woven.chain(["src/mutant.rs"]) {
        if let Ok(old) = fs::read(copy.tree.join(name)) {
            all.insert(name.to_owned(), old);
        }
    }
    tree::write(&copy.tree, &all)
}

/// Which mutants compile, as found before where the sources are the same.
fn compiled(copy: &Copy, files: &Files, work: &Path) -> Result<Choices, String> {
    let is_source = |name: &str| {
        (name.starts_with("src/") && name.ends_with(".rs")) || name.ends_with("Cargo.toml")
    };
    let kept = work.join(format!("compiled-{}.json", tree::hash(files, is_source)));
    let old = fs::read(&kept).ok();
    let mut choices = Choices::default();
    if let Some((dropped, constant)) = old.and_then(|text| serde_json::from_slice(&text).ok()) {
        choices = Choices { dropped, constant };
    }
    say!("{} mutants: finding those that compile", copy.mutants.len());
    copy.make_compile(&mut choices)?;
    let text = serde_json::to_vec(&(&choices.dropped, &choices.constant));
    let text = text.map_err(|error| error.to_string())?;
    fs::write(&kept, text).map_err(|error| format!("{}: {error}", kept.display()))?;
    Ok(choices)
}

/// Tries the mutants that were not tried before. What was found before is told as well.
fn tried(args: &Args, court: &Court, live: &[usize]) -> Result<Vec<Tried>, String> {
    let is_asked: HashSet<usize> = live.iter().copied().collect();
    let mut all = court.before();
    all.retain(|id, _| is_asked.contains(id));
    let mut left = live.to_vec();
    trial::shuffle(&mut left, args.seed);
    // What is still open stays so in the table until it was tried again with more patience.
    let is_left = |tried: &Tried| tried.fate == Fate::Open && tried.patience < args.patience;
    left.retain(|id| all.get(id).is_none_or(is_left));
    left.truncate(args.count.unwrap_or(left.len()));
    say!(
        "{} were tried before; {} are left to try",
        all.len(),
        left.len()
    );
    let heard = court.hear(&left, args.deadline())?;
    all.extend(heard.into_iter().map(|tried| (tried.id, tried)));
    Ok(all.into_values().collect())
}

/// What is told in the end.
struct Told<'a> {
    mutants: &'a [Mutant],
    known: &'a BTreeSet<String>,
    found: &'a Found,
    /// How many could not be tried, and why.
    not_tried: String,
}

impl Told<'_> {
    /// Whether no mutant lives but those that are known.
    fn tell(
        &self,
        rows: &[(String, report::Row)],
        markdown: Option<&Path>,
    ) -> Result<bool, String> {
        let table = format!("{}\n{}\n", report::table(rows), self.not_tried);
        println!("{table}");
        for case in &self.found.left_out {
            let reason = case.left_out.as_deref().unwrap_or("");
            println!("left out: {}: {reason}", case.name);
        }
        for tried in &self.found.tried {
            self.tell_odd(tried);
        }
        if let Some(path) = markdown {
            let text = format!("{HEAD}{table}{}", self.left_out());
            fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()))?;
        }
        Ok(self.found.tried.iter().all(|tried| self.is_right(tried)))
    }

    /// The tests that are not used, as a list.
    fn left_out(&self) -> String {
        let mut text = "\nTests that are left out:\n\n".to_owned();
        for case in &self.found.left_out {
            let reason = case.left_out.as_deref().unwrap_or("");
            text += &format!("- `{}`: {reason}\n", case.name);
        }
        text
    }

    /// Whether it does not live, or is known to. Lines that are equal share a name, so one of them may
    /// be known that is noticed.
    fn is_right(&self, tried: &Tried) -> bool {
        !tried.lives() || self.known.contains(&self.mutants[tried.id].name())
    }

    /// One that lives and is not known.
    fn tell_odd(&self, tried: &Tried) {
        if self.is_right(tried) {
            return;
        }
        let how = match tried.fate {
            Fate::Unreached => "not reached",
            Fate::Open => "lives so far",
            _ => "lives",
        };
        println!("{how}: {}", self.mutants[tried.id].place());
    }
}

/// What stands above the table.
const HEAD: &str = "\
# Mutants

How many small changes of `src/` are noticed by the unit tests and the proofs.
`.ci/mutants` tries more of them, and `cargo run -p host-mutants -- --markdown` writes this file.
It is of the sources of its day: tests that were written for those that lived are not in it until it is measured again.

`failed`: a test failed. `overflow`: arithmetic went out of its range, which is checked in tests alone.
`by time`: a test took more than five times as long. `by firmware`: the firmware in QEMU drew something else, or took more instructions than the record allows, and that is the only thing that noticed. `open`: the fastest tests passed, and it counts as one that lived. `equal`: it lived, and `mutants.txt` says why nothing can notice it.
The last column is of those tried without the equal ones, with the standard error of a random sample.

";

#[cfg(test)]
mod tests {
    use super::{check_known, known, root, sources, tree};

    /// Kills: a line of `src/` that was changed, but not where it is told why a mutant of it lives.
    #[test]
    fn mutants_that_are_known_to_live_are_those_of_the_source() {
        let root = root().unwrap();
        let (known, mut mutants) = (known::read(&root).unwrap(), Vec::new());
        sources(&tree::read(&root).unwrap(), &mut mutants).unwrap();
        assert_eq!(check_known(&known, &mutants), Ok(()));
    }
}
