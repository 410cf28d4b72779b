//! Builds the firmware of `examples/qemu` for Cortex-M, runs it in QEMU and reads what it prints.
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

use object::{Object, ObjectSection};
use std::{
    collections::BTreeMap,
    env, fs,
    io::{self, Read},
    path::{Path, PathBuf},
    process::{Command, ExitStatus, Stdio},
    thread,
    time::{Duration, Instant},
};

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

/// Every board that frames are compared on.
pub const BOARDS: [Board; 2] = [M4, M3];

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
        "no compiler for {} and {}: run `rustup target add {} {}`, or on Debian 12 \
         `apt-get install rustc-web cargo-web rust-web-src lld` ({reasons})",
        M4.target, M3.target, M4.target, M3.target
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
    #[error("the firmware for {target} does not build ({status}):\n{stderr}")]
    Build {
        /// The target that was built for.
        target: &'static str,
        /// How cargo ended.
        status: ExitStatus,
        /// What cargo and the compiler said.
        stderr: String,
    },
    /// QEMU is not installed.
    #[error("{QEMU} is not installed: run `apt-get install qemu-system-arm`")]
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

const QEMU: &str = "qemu-system-arm";

fn io_error(what: impl Into<String>) -> impl FnOnce(io::Error) -> FirmwareError {
    let what = what.into();
    move |source| FirmwareError::Io { what, source }
}

/// Where the compiler for the boards comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// The `rustc` of the path, with `core` installed for both targets.
    Rustup,
    /// Debian's, with `core` built from `rust-web-src` and linked by `ld.lld`.
    Debian,
}

impl Source {
    /// The name in [`TOOLCHAIN_VARIABLE`] and of the target directory.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rustup => "rustup",
            Self::Debian => "debian",
        }
    }
}

/// A compiler that builds for all [`BOARDS`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Toolchain {
    /// Where it comes from.
    pub source: Source,
    /// What `rustc --version` says; instruction counts differ from version to version.
    pub version: String,
}

const DEBIAN_RUSTC: &str = "/usr/bin/rustc";
const DEBIAN_CARGO: &str = "/usr/bin/cargo";
const DEBIAN_LINKER: &str = "ld.lld";
/// The oldest compiler that our packages build with; Debian 12's own `rustc` is 1.63.
const OLDEST_MINOR: u32 = 87;

impl Toolchain {
    /// The toolchain that [`TOOLCHAIN_VARIABLE`] names, or the first complete one.
    ///
    /// # Errors
    ///
    /// [`FirmwareError::NoToolchain`] with the commands that install one, or
    /// [`FirmwareError::UnknownToolchain`].
    pub fn find() -> Result<Self, FirmwareError> {
        let value = env::var(TOOLCHAIN_VARIABLE).unwrap_or_default();
        let sources: &[Source] = match value.as_str() {
            "" => &[Source::Rustup, Source::Debian],
            "rustup" => &[Source::Rustup],
            "debian" => &[Source::Debian],
            _ => return Err(FirmwareError::UnknownToolchain { value }),
        };
        let mut reasons = Vec::new();
        for &source in sources {
            let version = match source {
                Source::Rustup => rustup_version(),
                Source::Debian => debian_version(),
            };
            match version {
                Ok(version) => return Ok(Self { source, version }),
                Err(reason) => reasons.push(format!("{}: {reason}", source.name())),
            }
        }
        Err(FirmwareError::NoToolchain {
            reasons: reasons.join("; "),
        })
    }

    /// `cargo`, set up to compile for `board`, without a subcommand yet.
    fn cargo(&self, board: &Board) -> Command {
        match self.source {
            Source::Rustup => clean_command("cargo"),
            Source::Debian => {
                let target = board.target.replace('-', "_").to_uppercase();
                let mut cargo = clean_command(DEBIAN_CARGO);
                cargo
                    .env("RUSTC", DEBIAN_RUSTC)
                    .env("RUSTC_BOOTSTRAP", "1")
                    .env(format!("CARGO_TARGET_{target}_LINKER"), DEBIAN_LINKER);
                cargo
            }
        }
    }
}

/// The version of the path's compiler, or why it cannot build for the boards.
fn rustup_version() -> Result<String, String> {
    for board in BOARDS {
        let args = ["--print", "target-libdir", "--target", board.target];
        let directory = first_line("rustc", &args)?;
        let has_core = fs::read_dir(&directory).is_ok_and(|mut entries| {
            entries.any(|entry| {
                entry.is_ok_and(|entry| entry.file_name().to_string_lossy().starts_with("libcore-"))
            })
        });
        if !has_core {
            return Err(format!("no `core` for {}", board.target));
        }
    }
    first_line("rustc", &["--version"])
}

/// The version of Debian's compiler, or which of its packages is missing.
fn debian_version() -> Result<String, String> {
    let version = first_line(DEBIAN_RUSTC, &["--version"])?;
    let minor = version
        .strip_prefix("rustc 1.")
        .and_then(|rest| rest.split('.').next()?.parse::<u32>().ok());
    if minor.is_none_or(|minor| minor < OLDEST_MINOR) {
        return Err(format!(
            "{DEBIAN_RUSTC} is {version}, 1.{OLDEST_MINOR} is the oldest that will do (rustc-web)"
        ));
    }
    first_line(DEBIAN_CARGO, &["--version"])?;
    first_line(DEBIAN_LINKER, &["--version"])?;
    let sysroot = first_line(DEBIAN_RUSTC, &["--print", "sysroot"])?;
    let core = Path::new(&sysroot).join("lib/rustlib/src/rust/library/core/src/lib.rs");
    if !core.is_file() {
        return Err(format!("no {} (rust-web-src)", core.display()));
    }
    Ok(version)
}

/// The first line that a program prints, or why there is none.
fn first_line(program: &str, args: &[&str]) -> Result<String, String> {
    let output = clean_command(program)
        .args(args)
        .output()
        .map_err(|error| format!("{program}: {error}"))?;
    if !output.status.success() {
        return Err(format!("{program} {} failed", args.join(" ")));
    }
    let text = String::from_utf8_lossy(&output.stdout);
    text.lines()
        .next()
        .map(str::to_owned)
        .ok_or_else(|| format!("{program} {} says nothing", args.join(" ")))
}

/// A command without the variables that would change what the inner cargo builds.
fn clean_command(program: &str) -> Command {
    let mut command = Command::new(program);
    for (name, _) in env::vars_os() {
        if is_of_outer_build(&name.to_string_lossy()) {
            command.env_remove(&name);
        }
    }
    command
}

/// Whether a variable belongs to the build that this process is part of. Where packages come from,
/// and which toolchain rustup's proxies start, stays.
fn is_of_outer_build(name: &str) -> bool {
    const KEPT: [&str; 5] = [
        "CARGO_HOME",
        "CARGO_HTTP_",
        "CARGO_NET_",
        "CARGO_REGISTRIES_",
        "CARGO_REGISTRY_",
    ];
    const REMOVED: [&str; 6] = [
        "CARGO",
        "RUSTC",
        "RUSTDOC",
        "RUSTFLAGS",
        "LD_LIBRARY_PATH",
        "DYLD_",
    ];
    REMOVED.iter().any(|prefix| name.starts_with(prefix))
        && !KEPT.iter().any(|prefix| name.starts_with(prefix))
}

fn workspace() -> PathBuf {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    package.parent().unwrap_or(package).to_path_buf()
}

/// Where this toolchain's builds go: `firmware/` in the usual target directory.
fn target_directory(toolchain: &Toolchain) -> PathBuf {
    let usual = match env::var_os("CARGO_TARGET_DIR") {
        Some(directory) => workspace().join(directory),
        None => workspace().join("target"),
    };
    usual.join("firmware").join(toolchain.source.name())
}

/// Builds the firmware and gives the path of its ELF.
///
/// `features` are features of `examples/qemu`. What cargo says is kept for the error; a first build
/// takes about half a minute, or a whole one with `core`.
///
/// # Errors
///
/// [`FirmwareError::Build`] with what the compiler said.
pub fn build(
    toolchain: &Toolchain,
    board: &Board,
    profile: Profile,
    features: &[&str],
) -> Result<PathBuf, FirmwareError> {
    let mut directory = target_directory(toolchain);
    if !features.is_empty() {
        // Beside the plain one, which somebody may be running.
        directory.push(features.join("+"));
    }
    let mut cargo = toolchain.cargo(board);
    cargo
        .current_dir(workspace().join("examples/qemu"))
        .args(["build", "--profile", profile.name()])
        .args(["--target", board.target, "--target-dir"])
        .arg(&directory);
    if toolchain.source == Source::Debian {
        cargo.arg("-Zbuild-std=core");
    }
    if !features.is_empty() {
        cargo.args(["--features", &features.join(",")]);
    }
    let output = cargo
        .stdin(Stdio::null())
        .output()
        .map_err(io_error("cargo"))?;
    if !output.status.success() {
        return Err(FirmwareError::Build {
            target: board.target,
            status: output.status,
            stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
        });
    }
    Ok(directory
        .join(board.target)
        .join(profile.name())
        .join("qemu-firmware"))
}

/// Runs an ELF to its end and gives the lines that it printed.
///
/// One instruction is 1 ns of the machine's time (`-icount shift=0`), so a run is the same every
/// time, also in what it counts.
///
/// # Errors
///
/// [`FirmwareError::NoQemu`], [`FirmwareError::Timeout`] and [`FirmwareError::Failed`].
pub fn run(board: &Board, elf: &Path, timeout: Duration) -> Result<Vec<String>, FirmwareError> {
    run_in(QEMU, board, elf, timeout)
}

fn run_in(
    qemu: &str,
    board: &Board,
    elf: &Path,
    timeout: Duration,
) -> Result<Vec<String>, FirmwareError> {
    let started = Instant::now();
    let mut child = Command::new(qemu)
        .args(["-machine", board.machine, "-cpu", board.cpu])
        .args(["-icount", "shift=0"])
        .args(["-display", "none", "-monitor", "none", "-serial", "none"])
        .args(["-semihosting-config", "enable=on,target=native", "-kernel"])
        .arg(elf)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|error| match error.kind() {
            io::ErrorKind::NotFound => FirmwareError::NoQemu,
            _ => io_error(qemu)(error),
        })?;
    let stdout = child.stdout.take().map(collect);
    let stderr = child.stderr.take().map(collect);
    let status = loop {
        match child.try_wait().map_err(io_error(qemu))? {
            Some(status) => break Some(status),
            None if started.elapsed() >= timeout => {
                child.kill().map_err(io_error(qemu))?;
                child.wait().map_err(io_error(qemu))?;
                break None;
            }
            None => thread::sleep(Duration::from_millis(5)),
        }
    };
    let text = |pipe: Option<thread::JoinHandle<String>>| {
        pipe.and_then(|pipe| pipe.join().ok()).unwrap_or_default()
    };
    let (printed, said) = (text(stdout), text(stderr));
    match status {
        Some(status) if status.success() => Ok(printed.lines().map(str::to_owned).collect()),
        Some(status) => Err(FirmwareError::Failed {
            machine: board.machine,
            status,
            printed: printed + &said,
        }),
        None => Err(FirmwareError::Timeout {
            machine: board.machine,
            seconds: timeout.as_secs(),
            printed: printed + &said,
        }),
    }
}

/// Reads a pipe to its end beside the waiting, so that a full pipe never stops the child.
fn collect(mut pipe: impl Read + Send + 'static) -> thread::JoinHandle<String> {
    thread::spawn(move || {
        let mut bytes = Vec::new();
        // What came before an error is still worth showing.
        let _ = pipe.read_to_end(&mut bytes);
        String::from_utf8_lossy(&bytes).into_owned()
    })
}

/// One frame that the firmware drew.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FrameResult {
    /// The scene's name.
    pub scene: String,
    /// CRC-32 (PNG's) of the frame's bytes in scan-out order.
    pub crc: u32,
    /// Instructions to draw it, exact to 40; hashing is not in them.
    pub instructions: u64,
}

/// The firmware's instruction counter, held against a loop of known length.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CountCheck {
    /// Which loop.
    pub name: String,
    /// Instructions that it has.
    pub expected: u64,
    /// Instructions that were counted.
    pub counted: u64,
    /// Whether the firmware finds the difference small enough; if not it also exits with 1.
    pub ok: bool,
}

/// A kernel that drew spans of about one length.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KernelRun {
    /// Which kernel.
    pub name: String,
    /// Pixels that it drew.
    pub pixels: u64,
    /// Spans that they were in.
    pub spans: u64,
    /// Instructions for all of them, exact to 40.
    pub instructions: u64,
}

/// Everything that the firmware prints, in order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Output {
    /// The frames.
    pub frames: Vec<FrameResult>,
    /// The checks of the counter.
    pub counts: Vec<CountCheck>,
    /// The kernels, each once with long and once with short spans; with the feature `bench` only.
    pub kernels: Vec<KernelRun>,
    /// Other figures by name, such as `stack_bytes`.
    pub figures: BTreeMap<String, u64>,
}

impl Output {
    /// Reads the lines that `examples/qemu` documents: `frame`, `count`, `kernel`, `figure`, then one `done`.
    ///
    /// # Errors
    ///
    /// [`FirmwareError::Output`] at the first line that is not one of them, or where frames are
    /// missing at the end.
    pub fn parse(lines: &[String]) -> Result<Self, FirmwareError> {
        let mut output = Self::default();
        let mut done = false;
        for (index, line) in lines.iter().enumerate() {
            let result = if done {
                Err("comes after `done`".to_owned())
            } else {
                output.line(line)
            };
            done = result.map_err(|reason| FirmwareError::Output {
                number: index + 1,
                line: line.clone(),
                reason,
            })?;
        }
        if done {
            return Ok(output);
        }
        Err(FirmwareError::Output {
            number: lines.len() + 1,
            line: String::new(),
            reason: "ends without `done`".to_owned(),
        })
    }

    /// Takes one line in; true if it was the last.
    fn line(&mut self, line: &str) -> Result<bool, String> {
        let mut words = line.split_whitespace();
        let kind = words.next().unwrap_or_default();
        let mut fields = Fields::parse(words)?;
        match kind {
            "frame" => self.frames.push(FrameResult {
                scene: fields.take("scene")?.to_owned(),
                crc: fields.number("crc", 16)?,
                instructions: fields.number("instructions", 10)?,
            }),
            "count" => self.counts.push(CountCheck {
                name: fields.take("name")?.to_owned(),
                expected: fields.number("expected", 10)?,
                counted: fields.number("counted", 10)?,
                ok: fields.number::<u64>("ok", 10)? == 1,
            }),
            "kernel" => self.kernels.push(KernelRun {
                name: fields.take("name")?.to_owned(),
                pixels: fields.number("pixels", 10)?,
                spans: fields.number("spans", 10)?,
                instructions: fields.number("instructions", 10)?,
            }),
            "figure" => {
                let name = fields.take("name")?.to_owned();
                let value = fields.number("value", 10)?;
                if self.figures.insert(name, value).is_some() {
                    return Err("this figure came before".to_owned());
                }
            }
            "done" => {
                let frames: usize = fields.number("frames", 10)?;
                if frames != self.frames.len() {
                    return Err(format!("{} frames came", self.frames.len()));
                }
            }
            _ => return Err("expected `frame`, `count`, `kernel`, `figure` or `done`".to_owned()),
        }
        fields.end()?;
        Ok(kind == "done")
    }
}

/// The `key=value` words of a line, each to be taken once.
struct Fields<'a>(BTreeMap<&'a str, &'a str>);

impl<'a> Fields<'a> {
    fn parse(words: impl Iterator<Item = &'a str>) -> Result<Self, String> {
        let mut fields = BTreeMap::new();
        for word in words {
            let (key, value) = word
                .split_once('=')
                .ok_or_else(|| format!("`{word}` is not key=value"))?;
            if fields.insert(key, value).is_some() {
                return Err(format!("`{key}` is there twice"));
            }
        }
        Ok(Self(fields))
    }

    fn take(&mut self, key: &str) -> Result<&'a str, String> {
        self.0.remove(key).ok_or_else(|| format!("no `{key}`"))
    }

    fn number<N: TryFrom<u64>>(&mut self, key: &str, radix: u32) -> Result<N, String> {
        let text = self.take(key)?;
        u64::from_str_radix(text, radix)
            .ok()
            .and_then(|number| N::try_from(number).ok())
            .ok_or_else(|| format!("`{key}` is not a number in base {radix} that fits"))
    }

    fn end(self) -> Result<(), String> {
        match self.0.keys().next() {
            Some(key) => Err(format!("`{key}` is not expected")),
            None => Ok(()),
        }
    }
}

/// Where a section of the ELF lies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Section {
    /// First address at run time.
    pub address: u64,
    /// Length in bytes.
    pub bytes: u64,
}

/// The sections of a firmware that take memory; one that is absent is empty.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sections {
    /// `.text`: code of the whole firmware, with its console and panic messages' formatting.
    pub text: Section,
    /// `.rodata`: constants, models and tables.
    pub rodata: Section,
    /// `.data`: variables with an initial value, in RAM and in flash.
    pub data: Section,
    /// `.bss`: variables that start as zero.
    pub bss: Section,
    /// `.fast`: tightly coupled RAM.
    pub fast: Section,
    /// `.dma`: RAM that a DMA can reach.
    pub dma: Section,
    /// `.slow`: external RAM.
    pub slow: Section,
}

impl Sections {
    /// Reads them from an ELF.
    ///
    /// # Errors
    ///
    /// [`FirmwareError::Io`] or [`FirmwareError::Elf`].
    pub fn read(path: &Path) -> Result<Self, FirmwareError> {
        let bytes = fs::read(path).map_err(io_error(path.display().to_string()))?;
        let elf = object::File::parse(&*bytes).map_err(|source| FirmwareError::Elf {
            path: path.to_owned(),
            source,
        })?;
        let find = |name| {
            elf.section_by_name(name)
                .map_or(Section::default(), |section| Section {
                    address: section.address(),
                    bytes: section.size(),
                })
        };
        Ok(Self {
            text: find(".text"),
            rodata: find(".rodata"),
            data: find(".data"),
            bss: find(".bss"),
            fast: find(".fast"),
            dma: find(".dma"),
            slow: find(".slow"),
        })
    }

    /// Bytes of code.
    pub fn text_bytes(&self) -> u64 {
        self.text.bytes
    }

    /// Bytes of on-chip RAM that the firmware holds all the time: all but [`slow`](Self::slow) and
    /// the stack, whose peak the firmware prints as the figure `stack_bytes`.
    pub fn ram_bytes(&self) -> u64 {
        self.data.bytes + self.bss.bytes + self.fast.bytes + self.dma.bytes
    }

    /// Bytes of external RAM.
    pub fn slow_bytes(&self) -> u64 {
        self.slow.bytes
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

/// Builds the firmware for a board, runs it and reads what it printed.
///
/// # Errors
///
/// Those of [`build`], [`Sections::read`], [`run`] and [`Output::parse`].
pub fn measure(
    toolchain: &Toolchain,
    board: &Board,
    profile: Profile,
    features: &[&str],
) -> Result<Measured, FirmwareError> {
    let elf = build(toolchain, board, profile, features)?;
    Ok(Measured {
        board: *board,
        sections: Sections::read(&elf)?,
        output: Output::parse(&run(board, &elf, DEFAULT_TIMEOUT)?)?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Output, String> {
        let lines: Vec<String> = text.lines().map(str::to_owned).collect();
        Output::parse(&lines).map_err(|error| error.to_string())
    }

    #[test]
    fn output_is_read_whole() {
        let output = parse(
            "count name=loop expected=20 counted=21 ok=1\n\
             frame scene=sphere crc=00ab12ff instructions=123456\n\
             kernel name=packed pixels=2016 spans=63 instructions=20000\n\
             figure name=stack_bytes value=704\n\
             done frames=1",
        )
        .expect("as the firmware documents it");
        let frame = FrameResult {
            scene: "sphere".to_owned(),
            crc: 0x00ab_12ff,
            instructions: 123_456,
        };
        assert_eq!(output.frames, [frame]);
        assert_eq!(output.counts[0].counted, 21);
        assert!(output.counts[0].ok);
        assert_eq!(output.figures["stack_bytes"], 704);
        let kernel = KernelRun {
            name: "packed".to_owned(),
            pixels: 2016,
            spans: 63,
            instructions: 20_000,
        };
        assert_eq!(output.kernels, [kernel]);
    }

    #[test]
    fn damaged_output_is_refused_with_its_line() {
        for (text, number, reason) in [
            ("", 1, "ends without `done`"),
            (
                "frame scene=a crc=1 instructions=2",
                2,
                "ends without `done`",
            ),
            ("done frames=1", 1, "0 frames came"),
            ("done frames=0\ndone frames=0", 2, "comes after `done`"),
            ("frame scene=a crc=1", 1, "no `instructions`"),
            ("frame scene=a crc=1 crc=1", 1, "`crc` is there twice"),
            (
                "frame scene=a crc=x instructions=2",
                1,
                "not a number in base 16",
            ),
            ("frame scene=a crc=123456789 instructions=2", 1, "that fits"),
            (
                "frame scene=a crc=1 instructions=2 b=3",
                1,
                "`b` is not expected",
            ),
            ("frame scene", 1, "`scene` is not key=value"),
            (
                "figure name=a value=1\nfigure name=a value=1",
                2,
                "came before",
            ),
            ("panic at", 1, "`at` is not key=value"),
            ("", 1, "ends"),
        ] {
            let error = parse(text).expect_err(text);
            assert!(
                error.starts_with(&format!("line {number} ")),
                "{text}: {error}"
            );
            assert!(error.contains(reason), "{text}: {error}");
        }
    }

    #[test]
    fn outer_build_does_not_leak_into_the_inner_one() {
        for name in [
            "CARGO",
            "CARGO_MANIFEST_DIR",
            "CARGO_TARGET_DIR",
            "CARGO_ENCODED_RUSTFLAGS",
            "RUSTC",
            "RUSTC_BOOTSTRAP",
            "RUSTC_WORKSPACE_WRAPPER",
            "RUSTFLAGS",
            "RUSTDOCFLAGS",
            "LD_LIBRARY_PATH",
        ] {
            assert!(is_of_outer_build(name), "{name}");
        }
        for name in [
            "PATH",
            "HOME",
            "CARGO_HOME",
            "RUSTUP_TOOLCHAIN",
            "CARGO_HTTP_PROXY",
            "CARGO_REGISTRIES_CRATES_IO_PROTOCOL",
            "https_proxy",
        ] {
            assert!(!is_of_outer_build(name), "{name}");
        }
    }

    #[test]
    fn missing_qemu_is_named() {
        let error = run_in("no-such-qemu", &M4, Path::new("none"), Duration::ZERO)
            .expect_err("there is no such program");
        assert!(matches!(error, FirmwareError::NoQemu));
        assert!(
            error
                .to_string()
                .contains("apt-get install qemu-system-arm")
        );
    }

    #[test]
    fn failure_of_qemu_is_passed_on() {
        let error = run(&M4, Path::new("no-such-elf"), DEFAULT_TIMEOUT).expect_err("no such ELF");
        assert!(matches!(&error, FirmwareError::Failed { status, .. } if status.code() == Some(1)));
        assert!(error.to_string().contains("no-such-elf"), "{error}");
    }

    /// On both boards, and with overflow checks on one (each profile costs Debian's compiler a
    /// build of `core`): the counter counts right, every section is where `memory.x` wants it, and
    /// what is printed is complete; a second run prints the same.
    #[test]
    fn firmware_runs_the_same_everywhere() -> Result<(), FirmwareError> {
        let toolchain = Toolchain::find()?;
        let mut frames = Vec::new();
        for (board, profile) in [
            (M4, Profile::Release),
            (M3, Profile::Release),
            (M4, Profile::Checked),
        ] {
            let measured = measure(&toolchain, &board, profile, &[])?;
            assert!(measured.output.counts.len() >= 2);
            assert!(measured.output.counts.iter().all(|count| count.ok));
            assert!(measured.output.figures["stack_bytes"] > 0);
            let sections = measured.sections;
            for (section, origin, length) in [
                (sections.text, 0, 4 << 20),
                (sections.bss, 0x2000_0000, 256 << 10),
                (sections.fast, 0x2004_0000, 64 << 10),
                (sections.dma, 0x2005_0000, 64 << 10),
                (sections.slow, 0x2100_0000, 16 << 20),
            ] {
                assert!(section.bytes > 0, "{sections:?}");
                assert!(section.address >= origin, "{sections:?}");
                assert!(
                    section.address + section.bytes <= origin + length,
                    "{sections:?}"
                );
            }
            assert_eq!(measured, measure(&toolchain, &board, profile, &[])?);
            let output = measured.output.frames.into_iter();
            frames.push(
                output
                    .map(|frame| (frame.scene, frame.crc))
                    .collect::<Vec<_>>(),
            );
        }
        assert!(!frames[0].is_empty());
        assert!(frames.iter().all(|other| *other == frames[0]), "{frames:?}");
        Ok(())
    }

    #[test]
    fn firmware_that_does_not_end_is_stopped() -> Result<(), FirmwareError> {
        let elf = build(&Toolchain::find()?, &M4, Profile::Release, &[])?;
        let error = run(&M4, &elf, Duration::ZERO).expect_err("no time was given");
        assert!(matches!(error, FirmwareError::Timeout { .. }), "{error}");
        Ok(())
    }
}
