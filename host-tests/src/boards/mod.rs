//! `boards`: the examples for boards, run in emulators; what arrives at the panel is judged here.
//!
//! ```text
//! Chip::command() -> emulator -> lines -> wire::parse() -> Panel -> Outcome
//!                                    Expected::drawn() ---------------^
//! ```
//! An emulator knows a chip: its registers, its bus, and what that would not forgive. It prints the
//! bytes that arrive. What they mean is known here alone, and compared with the host's own frames
//! and with the commands that a panel wants.
//!
//! | file | there |
//! |---|---|
//! | `chips.rs` | the boards, and what runs them |
//! | `wire.rs` | what an emulator prints |
//! | `panel.rs` | the virtual panel |
//! | `expected.rs` | the host's frames, the panel's commands |
//! | `outcome.rs` | a run, judged, as JSON and in a table |
//! | `functions.rs` | what each function reads, and what is worth its bytes in RAM |

pub mod chips;
pub mod expected;
pub mod functions;
pub mod outcome;
mod panel;
pub mod wire;

pub use crate::say;
use chips::{Bench, CHIPS, Chip};
pub use expected::Expected;
pub use outcome::{Outcome, table};
pub use panel::Panel;

use crate::args::BoardsArgs;
use crate::firmware::{self, DEFAULT_TIMEOUT, Symbols};
use std::error::Error;
use std::process::Stdio;
use std::time::Duration;

/// What each frame adds to the time in which an emulator has to end.
const A_FRAME: Duration = Duration::from_secs(5);

/// The folders of the examples that are run; one that several chips run comes as often.
pub fn examples() -> impl Iterator<Item = &'static str> {
    CHIPS.iter().map(|chip| chip.program)
}

/// Runs the boards and prints what came. Whether all that ran sent what they should.
///
/// # Errors
/// When an emulator cannot be started, or the host cannot draw the frames.
pub fn run(args: &BoardsArgs) -> Result<bool, Box<dyn Error>> {
    let bench = Bench {
        functions: args.functions,
        ..Bench::new(
            args.built.as_deref(),
            args.packages.as_deref(),
            args.frames,
            args.miss_cycles,
        )
    };
    let drawn = Expected::drawn(bench.frames)?;
    let shown = drawn.without_commands();
    let asked = |chip: &&Chip| args.board.as_deref().is_none_or(|name| name == chip.name);
    let chips: Vec<&'static Chip> = CHIPS.iter().filter(asked).collect();
    if chips.is_empty() {
        let names = CHIPS.map(|chip| chip.name).join(", ");
        return Err(format!("there is no such board: there are {names}").into());
    }
    // Each waits for an emulator that has one thread.
    let runs = std::thread::scope(|scope| {
        let run = |chip: &'static Chip| {
            let expected = if chip.is_memory_mapped {
                &shown
            } else {
                &drawn
            };
            let bench = &bench;
            scope.spawn(move || run_chip(chip, bench, expected))
        };
        let started: Vec<_> = chips.iter().copied().map(run).collect();
        let ended = started.into_iter().map(|thread| thread.join());
        ended.collect::<Vec<_>>()
    });
    let mut outcomes = Vec::new();
    for run in runs {
        outcomes.push(run.map_err(|_| "a board's thread ended early")??);
    }
    if args.json {
        say!("{}", serde_json::to_string_pretty(&outcomes)?);
    } else {
        say!("{}", table(&outcomes));
    }
    for (chip, outcome) in chips.iter().zip(&outcomes) {
        if !outcome.uses.is_empty() {
            let symbols = Symbols::read(&chip.elf(&bench))?;
            let read = functions::of(&outcome.uses, &symbols, bench.frames.into());
            say!("{}, a frame:\n{}", outcome.board, functions::table(&read));
        }
        outcome.explain();
    }
    Ok(outcomes.iter().all(Outcome::is_good))
}

fn run_chip(chip: &Chip, bench: &Bench, expected: &Expected) -> Result<Outcome, String> {
    let mut command = match chip.command(bench) {
        Ok(command) => command,
        Err(missing) => return Ok(Outcome::skipped(chip.name, missing)),
    };
    let failed = |error| format!("{}: {error}", chip.name);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let child = command.spawn().map_err(failed)?;
    let timeout = DEFAULT_TIMEOUT + u32::from(bench.frames) * A_FRAME;
    let ended = firmware::finish(child, timeout).map_err(failed)?;
    let mut outcome = Outcome::of(chip.name, &ended.printed, expected);
    // An emulator that ended by itself says so in its last line.
    if !ended.status.is_some_and(|status| status.success()) && outcome.is_good() {
        outcome.complaints.push("the emulator failed".into());
    }
    outcome.hold(chip.limits);
    outcome.notes.extend(ended.said.lines().map(str::to_owned));
    Ok(outcome)
}
