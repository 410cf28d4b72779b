//! Where a frame's instructions go: every one of them, by function, and a function's listing.
//!
//! QEMU steps through the firmware one instruction at a time and logs where each lies. The log of a
//! frame is hundreds of megabytes, so it is read from a pipe as it comes and only counted. What
//! the firmware does before and after the frame lies outside its two marks
//! (`host-tests/firmware/src/profile.rs`).

use super::qemu::{Handed, QEMU, collect};
use super::{Board, COMPARER, FirmwareError, Profile, Symbol, Symbols, Toolchain, build, io_error};
use std::io::{self, BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// A frame takes seconds; one that takes longer hangs.
const TIMEOUT: Duration = Duration::from_secs(600);
/// Names of the marks.
const MARKS: [&str; 2] = ["scanbeam_profile_begin", "scanbeam_profile_end"];

/// How often each instruction ran.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Of every two bytes of flash from address 0 on.
    halves: Vec<u64>,
}

impl Counts {
    /// Adds an instruction that ran at an address.
    pub fn add(&mut self, address: u64) {
        let half = (address / 2) as usize;
        if half >= self.halves.len() {
            self.halves.resize(half + 1, 0);
        }
        self.halves[half] += 1;
    }

    /// Of the instruction at an address.
    #[must_use]
    pub fn at(&self, address: u64) -> u64 {
        let half = self.halves.get((address / 2) as usize);
        half.copied().unwrap_or_default()
    }

    /// Of all instructions.
    #[must_use]
    pub fn all(&self) -> u64 {
        self.halves.iter().sum()
    }

    /// Of the instructions of a function.
    pub fn of(&self, symbol: &Symbol) -> u64 {
        let addresses = (symbol.address..symbol.address + symbol.bytes).step_by(2);
        addresses.map(|address| self.at(address)).sum()
    }
}

/// A function of a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FunctionCost {
    /// The function.
    pub symbol: Symbol,
    /// Instructions that it executed itself.
    pub instructions: u64,
    /// How often its first instruction ran.
    pub calls: u64,
}

/// A frame, stepped through.
#[derive(Clone, Debug)]
pub struct Stepped {
    elf: PathBuf,
    counts: Counts,
    /// The functions that ran, the dearest first.
    pub functions: Vec<FunctionCost>,
}

/// Builds the firmware for a board and steps through a frame of it.
///
/// # Errors
/// When the firmware cannot be built or run, or has no such frame.
pub fn step(toolchain: &Toolchain, board: &Board, frame: &str) -> Result<Stepped, FirmwareError> {
    check_name(frame)?;
    let elf = build(toolchain, board, Profile::Release, COMPARER, &[])?;
    let handed = Handed {
        words: &[COMPARER, "profile", frame],
        folder: Path::new("."),
        laid: None,
    };
    step_handed(board, elf, &handed)
}

/// Steps through what the firmware draws of what it is handed.
///
/// # Errors
/// When it cannot be run, or refuses.
pub fn step_handed(
    board: &Board,
    elf: PathBuf,
    handed: &Handed<'_>,
) -> Result<Stepped, FirmwareError> {
    let symbols = Symbols::read(&elf)?;
    let counts = log(board, &elf, &symbols, handed)?;
    let ran = |symbol: &Symbol| {
        let cost = FunctionCost {
            instructions: counts.of(symbol),
            calls: counts.at(symbol.address),
            symbol: symbol.clone(),
        };
        (cost.instructions > 0).then_some(cost)
    };
    let mut functions: Vec<FunctionCost> = symbols.iter().filter_map(ran).collect();
    functions.sort_by_key(|function| std::cmp::Reverse(function.instructions));
    Ok(Stepped {
        elf,
        counts,
        functions,
    })
}

/// A frame's name becomes a word of QEMU's command line, where a comma or a space would begin another.
pub fn check_name(frame: &str) -> Result<(), FirmwareError> {
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    if frame.is_empty() || !frame.chars().all(is_word) {
        return Err(FirmwareError::NoFrame {
            name: frame.to_owned(),
        });
    }
    Ok(())
}

/// Runs the firmware step by step and counts between its marks.
fn log(
    board: &Board,
    elf: &Path,
    symbols: &Symbols,
    handed: &Handed<'_>,
) -> Result<Counts, FirmwareError> {
    let mark = |name: &str| symbols.iter().find(|s| s.name == name).map(|s| s.address);
    let [Some(begin), Some(end)] = MARKS.map(mark) else {
        return Err(io_error(elf.display().to_string())(io::Error::other(
            "its marks are missing",
        )));
    };
    let mut child = Command::new(QEMU)
        .current_dir(handed.folder)
        .args(handed.loader())
        .args(["-machine", board.machine, "-cpu", board.cpu])
        .args(["-display", "none", "-monitor", "none", "-serial", "none"])
        .args(single_step()?)
        .args([
            "-d",
            "nochain,exec",
            "-semihosting-config",
            &handed.semihosting(),
            "-kernel",
        ])
        .arg(elf)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(io_error(QEMU))?;
    let started = Instant::now();
    let said = child.stdout.take().map(collect);
    let mut count = Counter {
        begin,
        end,
        counts: Counts::default(),
        is_on: false,
    };
    let mut log = BufReader::new(
        child
            .stderr
            .take()
            .ok_or_else(|| io_error(QEMU)(io::Error::other("it has no standard error")))?,
    );
    let (mut line, mut lines, mut in_time) = (Vec::new(), 0u64, true);
    while in_time && log.read_until(b'\n', &mut line).map_err(io_error(QEMU))? > 0 {
        if let Some(address) = address_of(&line) {
            count.step(address);
        }
        line.clear();
        lines += 1;
        in_time = lines % (1 << 16) != 0 || started.elapsed() < TIMEOUT;
    }
    if !in_time {
        child.kill().map_err(io_error(QEMU))?;
    }
    let status = child.wait().map_err(io_error(QEMU))?;
    let printed = said.and_then(|pipe| pipe.join().ok()).unwrap_or_default();
    match (in_time, status.success()) {
        (true, true) => Ok(count.counts),
        (true, false) => Err(FirmwareError::Failed {
            machine: board.machine,
            status,
            printed,
        }),
        (false, _) => Err(FirmwareError::Timeout {
            machine: board.machine,
            seconds: TIMEOUT.as_secs(),
            printed,
        }),
    }
}

/// Counts between the marks.
pub struct Counter {
    /// Where the first mark is.
    pub begin: u64,
    /// Where the last mark is.
    pub end: u64,
    /// What was counted.
    pub counts: Counts,
    /// Whether the first mark was passed, and the last one not yet.
    pub is_on: bool,
}

impl Counter {
    /// Takes the address of the next instruction.
    pub fn step(&mut self, address: u64) {
        if address == self.end {
            self.is_on = false;
        }
        if self.is_on {
            self.counts.add(address);
        }
        if address == self.begin {
            self.is_on = true;
        }
    }
}

/// The words by which QEMU takes one instruction at a time.
fn single_step() -> Result<&'static [&'static str], FirmwareError> {
    let output = Command::new(QEMU).arg("--version").output();
    let output = output.map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => FirmwareError::NoQemu,
        _ => io_error(QEMU)(error),
    })?;
    let text = String::from_utf8_lossy(&output.stdout);
    let major = text
        .split("version ")
        .nth(1)
        .and_then(|rest| rest.split('.').next());
    // The old word was taken back in favour of the new one, which came with 8.1.
    match major.and_then(|major| major.parse::<u32>().ok()) {
        Some(0..9) | None => Ok(&["-singlestep"]),
        Some(_) => Ok(&["-accel", "tcg,one-insn-per-tb=on"]),
    }
}

/// Where the instruction of a line of the log lies:
/// `Trace 0: 0x7fd67c000400 [00800408/000c0ed0/00000110/ff000201] name`.
pub fn address_of(line: &[u8]) -> Option<u64> {
    let rest = line.strip_prefix(b"Trace ")?;
    let bracket = rest.iter().position(|byte| *byte == b'[')?;
    let field = rest[bracket..].split(|byte| *byte == b'/').nth(1)?;
    u64::from_str_radix(std::str::from_utf8(field).ok()?, 16).ok()
}

impl Stepped {
    /// Instructions of the whole frame.
    #[must_use]
    pub fn instructions(&self) -> u64 {
        self.counts.all()
    }

    /// The listing of every function whose name has these words in it and that ran: each
    /// instruction with how often it did.
    ///
    /// # Errors
    /// When no such function ran, or there is no disassembler.
    pub fn listing(&self, words: &str) -> Result<String, FirmwareError> {
        let named = |function: &&FunctionCost| function.symbol.name.contains(words);
        let mut text = String::new();
        for function in self.functions.iter().filter(named) {
            let symbol = &function.symbol;
            text.push_str(&format!(
                "{}: {} instructions, {} calls\n",
                symbol.name, function.instructions, function.calls
            ));
            let listing = disassembled(&self.elf, symbol)?;
            text.push_str(&annotated(&listing, &self.counts));
        }
        if text.is_empty() {
            return Err(FirmwareError::NoFunction {
                words: words.to_owned(),
            });
        }
        Ok(text)
    }
}

/// A disassembler's text with how often each instruction ran before it.
pub fn annotated(listing: &str, counts: &Counts) -> String {
    let mut text = String::new();
    for line in listing.lines() {
        let Some((address, rest)) = line.trim_start().split_once(':') else {
            continue;
        };
        let Ok(address) = u64::from_str_radix(address, 16) else {
            continue;
        };
        let count = match counts.at(address) {
            0 => String::new(),
            count => count.to_string(),
        };
        text.push_str(&format!(
            "{count:>9} {address:6x} {}\n",
            rest.trim().replace('\t', " ")
        ));
    }
    text
}

/// Disassemblers that know Thumb, as they are called.
const DISASSEMBLERS: [&str; 2] = ["arm-none-eabi-objdump", "llvm-objdump"];

/// A function's code as text.
fn disassembled(elf: &Path, symbol: &Symbol) -> Result<String, FirmwareError> {
    let names = DISASSEMBLERS.iter().map(PathBuf::from);
    for name in names.chain(of_rustup()) {
        let output = Command::new(&name)
            .args(["-d", "-C", "--no-show-raw-insn"])
            .arg(format!("--start-address={:#x}", symbol.address))
            .arg(format!(
                "--stop-address={:#x}",
                symbol.address + symbol.bytes
            ))
            .arg(elf)
            .output();
        match output {
            Ok(output) if output.status.success() => {
                return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
            }
            Ok(output) => {
                let said = String::from_utf8_lossy(&output.stderr).trim().to_owned();
                return Err(io_error(name.display().to_string())(io::Error::other(said)));
            }
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            Err(error) => return Err(io_error(name.display().to_string())(error)),
        }
    }
    Err(FirmwareError::NoDisassembler)
}

/// The disassembler of rustup's component `llvm-tools`.
fn of_rustup() -> Option<PathBuf> {
    let sysroot = Command::new("rustc")
        .args(["--print", "sysroot"])
        .output()
        .ok()?;
    let sysroot = PathBuf::from(String::from_utf8(sysroot.stdout).ok()?.trim());
    let hosts = std::fs::read_dir(sysroot.join("lib/rustlib")).ok()?;
    let tools = hosts.filter_map(|host| Some(host.ok()?.path().join("bin/llvm-objdump")));
    tools.into_iter().find(|tool| tool.exists())
}
