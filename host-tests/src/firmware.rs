//! Builds the firmware of `host-tests/firmware` for Cortex-M, runs it in QEMU and reads what it prints.
//!
//! ```text
//! Toolchain::find() -> build() -> ELF -> Sections::read()
//!                                     -> run() -> lines -> Output::parse()
//! ```
//! [`measure`] is all of it. A machine may have rustup's precompiled `core` for the target, or
//! Debian's compiler, which makes `core` from its source package; the firmware is the same. Cargo
//! is run as a child, so it gets target directories of its own (one per toolchain: the outer cargo
//! holds the lock of the usual one, and a changed compiler would rebuild everything) and an
//! environment without what the outer cargo, clippy or a coverage tool has put there.
//!
//! | file | there |
//! |---|---|
//! | `output.rs` | what the firmware prints, read line by line |
//! | `qemu.rs` | a program run in QEMU |
//! | `sections.rs` | what memory its ELF takes |
//! | `symbols.rs` | its functions |
//! | `profile.rs` | where a frame's instructions go |
//! | `toolchain.rs` | which compiler there is |

pub mod output;
pub mod profile;
pub mod qemu;
pub mod sections;
pub mod symbols;
pub mod toolchain;

pub use output::{CountCheck, FrameResult, GrowthRun, KernelRun, LinesRun, Output, UnitRun};
pub use qemu::run;
pub(crate) use qemu::{Handed, finish, run_handed, run_words};
pub use sections::{Section, Sections};
pub use symbols::{Symbol, Symbols};
pub(crate) use toolchain::clean_command;
pub use toolchain::{Source, Toolchain};

use std::env;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{ExitStatus, Stdio};
use std::time::Duration;

/// Names the toolchain to use, `rustup` or `debian`; unset or empty: the first that is complete.
pub const TOOLCHAIN_VARIABLE: &str = "SCANBEAM_TOOLCHAIN";

/// A run that takes longer than this hangs; whole suites take seconds.
pub const DEFAULT_TIMEOUT: Duration = Duration::from_secs(300);

/// A machine in QEMU, and what to build for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Board {
    /// Short name, for reports.
    pub name: &'static str,
    /// Rust's name of the target.
    pub target: &'static str,
    /// QEMU's name of the machine.
    pub machine: &'static str,
    /// QEMU's name of the processor.
    pub cpu: &'static str,
}

/// A Cortex-M4 with a floating point unit.
pub const M4: Board = Board {
    name: "m4",
    target: "thumbv7em-none-eabihf",
    machine: "mps2-an386",
    cpu: "cortex-m4",
};

/// A Cortex-M3, which has none.
pub const M3: Board = Board {
    name: "m3",
    target: "thumbv7m-none-eabi",
    machine: "mps2-an385",
    cpu: "cortex-m3",
};

/// Code for a Cortex-M0+, which has no divide, no multiply to 64 bits and no compare and swap. QEMU
/// has no such machine with that much memory; a Cortex-M3 knows all of its instructions, so the
/// frames and the count of instructions are those of an M0+.
pub const M0_PLUS: Board = Board {
    name: "m0plus",
    target: "thumbv6m-none-eabi",
    machine: "mps2-an385",
    cpu: "cortex-m3",
};

/// Every board that frames are compared on.
pub const BOARDS: [Board; 3] = [M4, M3, M0_PLUS];

/// How the firmware is compiled. Both are optimised alike and give the same frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Profile {
    /// As shipped; what figures are measured on.
    Release,
    /// With overflow checks and debug assertions.
    Checked,
}

impl Profile {
    /// Cargo's name of the profile, and of its directory.
    pub fn name(self) -> &'static str {
        match self {
            Self::Release => "release",
            Self::Checked => "checked",
        }
    }
}

/// What went wrong, with what would mend it where that is known.
#[derive(Debug, thiserror::Error)]
pub enum FirmwareError {
    /// Neither toolchain can build for the boards.
    #[error(
        "no compiler for all boards: run `rustup target add {} {} {}`, or on Debian 12 \
         `apt-get install rustc-web cargo-web rust-web-src lld` ({reasons})",
        M4.target, M3.target, M0_PLUS.target
    )]
    NoToolchain {
        /// Why each toolchain that was tried will not do.
        reasons: String,
    },
    /// The variable holds something else than a toolchain's name.
    #[error("{TOOLCHAIN_VARIABLE} is `{value}`, expected `rustup` or `debian`")]
    UnknownToolchain {
        /// What it holds.
        value: String,
    },
    /// Cargo ran and failed.
    #[error("the firmware for {targets} does not build ({status}):\n{stderr}")]
    Build {
        /// The targets that were built for.
        targets: String,
        /// How cargo ended.
        status: ExitStatus,
        /// What cargo and the compiler said.
        stderr: String,
    },
    /// QEMU is not installed.
    #[error(
        "{} is not installed: run `apt-get install qemu-system-arm`",
        qemu::QEMU
    )]
    NoQemu,
    /// The firmware did not end in time.
    #[error("the firmware on {machine} was stopped after {seconds} s; it had printed:\n{printed}")]
    Timeout {
        /// QEMU's name of the machine.
        machine: &'static str,
        /// Seconds until it was stopped.
        seconds: u64,
        /// Its output so far.
        printed: String,
    },
    /// The firmware, or QEMU itself, ended with another exit code than 0.
    #[error("the firmware on {machine} failed ({status}):\n{printed}")]
    Failed {
        /// QEMU's name of the machine.
        machine: &'static str,
        /// The firmware's own exit code, passed through by QEMU.
        status: ExitStatus,
        /// Its output, then QEMU's.
        printed: String,
    },
    /// A line is not in the format that the firmware documents.
    #[error("line {number} of the firmware's output, `{line}`: {reason}")]
    Output {
        /// Counted from 1.
        number: usize,
        /// The line.
        line: String,
        /// What is wrong with it.
        reason: String,
    },
    /// There cannot be a frame of that name.
    #[error("`{name}` is no frame's name: letters, digits and `_`")]
    NoFrame {
        /// What was asked for.
        name: String,
    },
    /// No function of that name ran.
    #[error("no function ran whose name has `{words}` in it")]
    NoFunction {
        /// What was asked for.
        words: String,
    },
    /// Nothing here writes machine code as text.
    #[error(
        "there is no disassembler: run `apt-get install binutils-arm-none-eabi`, or \
         `rustup component add llvm-tools`"
    )]
    NoDisassembler,
    /// The ELF cannot be read as one.
    #[error("{}: {source}", path.display())]
    Elf {
        /// The file.
        path: PathBuf,
        /// What the reader said.
        source: object::Error,
    },
    /// A file or program cannot be used.
    #[error("{what}: {source}")]
    Io {
        /// The file or program.
        what: String,
        /// What the system said.
        source: io::Error,
    },
}

fn io_error(what: impl Into<String>) -> impl FnOnce(io::Error) -> FirmwareError {
    let what = what.into();
    move |source| FirmwareError::Io { what, source }
}

/// The folder of the whole project.
pub(crate) fn workspace() -> PathBuf {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    package.parent().unwrap_or(package).to_path_buf()
}

/// The usual target directory.
pub(crate) fn usual_target() -> PathBuf {
    match env::var_os("CARGO_TARGET_DIR") {
        Some(directory) => workspace().join(directory),
        None => workspace().join("target"),
    }
}

/// Where this toolchain's builds go: `firmware/` in the usual target directory.
fn target_directory(toolchain: &Toolchain) -> PathBuf {
    usual_target()
        .join("firmware")
        .join(toolchain.source.name())
}

/// The program of `host-tests/firmware` that draws and compares the test scenes.
pub const COMPARER: &str = "qemu-firmware";

/// Builds a program of `host-tests/firmware` and gives the path of its ELF.
///
/// `program` is [`COMPARER`] or another binary there, `features` are its features. What cargo says is kept for the error; a first build
/// takes about half a minute, or a whole one with `core`.
///
/// # Errors
///
/// [`FirmwareError::Build`] with what the compiler said.
pub fn build(
    toolchain: &Toolchain,
    board: &Board,
    profile: Profile,
    program: &str,
    features: &[&str],
) -> Result<PathBuf, FirmwareError> {
    let boards = std::slice::from_ref(board);
    let directory = build_all(toolchain, boards, profile, &[program], features)?;
    Ok(directory
        .join(board.target)
        .join(profile.name())
        .join(program))
}

/// Builds programs for boards, as [`build`] does one for one, in as many threads as cargo takes:
/// a program is linked by one alone. Gives the folder of what was built.
///
/// # Errors
///
/// [`FirmwareError::Build`] with what the compiler said.
pub fn build_all(
    toolchain: &Toolchain,
    boards: &[Board],
    profile: Profile,
    programs: &[&str],
    features: &[&str],
) -> Result<PathBuf, FirmwareError> {
    let mut words = vec!["--profile", profile.name()];
    words.extend(programs.iter().flat_map(|program| ["--bin", program]));
    let features = features.join(",");
    if !features.is_empty() {
        words.extend(["--features", &features]);
    }
    let package = Package {
        folder: workspace().join("host-tests/firmware"),
        target: target_directory(toolchain),
        crates: "core",
    };
    let built = package.build(toolchain, boards, &words)?;
    match features.is_empty() {
        true => Ok(built),
        false => set_aside(&built, &features, boards, profile, programs),
    }
}

/// Copies programs into a folder of their features, and gives that: the next ones of the same names are built over them,
/// where all share what they depend on.
fn set_aside(
    built: &Path,
    features: &str,
    boards: &[Board],
    profile: Profile,
    programs: &[&str],
) -> Result<PathBuf, FirmwareError> {
    let aside = built.join("by-features").join(features);
    for board in boards {
        let release = Path::new(board.target).join(profile.name());
        let failed = || io_error(aside.join(&release).display().to_string());
        std::fs::create_dir_all(aside.join(&release)).map_err(failed())?;
        for program in programs {
            let file = release.join(program);
            std::fs::copy(built.join(&file), aside.join(&file)).map_err(failed())?;
        }
    }
    Ok(aside)
}

/// A package of firmware.
pub(crate) struct Package {
    /// Where its manifest is.
    pub(crate) folder: PathBuf,
    /// Its target directory.
    pub(crate) target: PathBuf,
    /// What it takes of Rust's own crates, where they are built from their sources.
    pub(crate) crates: &'static str,
}

impl Package {
    /// Builds it for boards, with more words for cargo, and gives its target directory.
    pub(crate) fn build(
        self,
        toolchain: &Toolchain,
        boards: &[Board],
        words: &[&str],
    ) -> Result<PathBuf, FirmwareError> {
        let mut cargo = toolchain.cargo(boards);
        cargo
            .current_dir(&self.folder)
            .args(["build", "--target-dir"])
            .arg(&self.target)
            .args(words)
            .args(boards.iter().flat_map(|board| ["--target", board.target]));
        if toolchain.source == Source::Debian {
            cargo.arg(format!("-Zbuild-std={}", self.crates));
        }
        let output = cargo
            .stdin(Stdio::null())
            .output()
            .map_err(io_error("cargo"))?;
        if !output.status.success() {
            let targets: Vec<&str> = boards.iter().map(|board| board.target).collect();
            return Err(FirmwareError::Build {
                targets: targets.join(", "),
                status: output.status,
                stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
            });
        }
        Ok(self.target)
    }
}

/// A firmware that was built and run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Measured {
    /// What it ran on.
    pub board: Board,
    /// What memory it takes.
    pub sections: Sections,
    /// What it printed.
    pub output: Output,
}

/// Builds [`COMPARER`] for a board, runs it and reads what it printed: frames, and with `bench` among the words that it
/// is handed also kernels, units, lines and growth.
///
/// # Errors
///
/// Those of [`build`], [`Sections::read`], [`run`] and [`Output::parse`].
pub fn measure(
    toolchain: &Toolchain,
    board: &Board,
    profile: Profile,
    words: &[&str],
) -> Result<Measured, FirmwareError> {
    let elf = build(toolchain, board, profile, COMPARER, &[])?;
    let words: Vec<&str> = [COMPARER]
        .into_iter()
        .chain(words.iter().copied())
        .collect();
    let said = run_words(board, &elf, DEFAULT_TIMEOUT, &words, Path::new("."))?;
    Ok(Measured {
        board: *board,
        sections: Sections::read(&elf)?,
        output: Output::parse(&said)?,
    })
}
