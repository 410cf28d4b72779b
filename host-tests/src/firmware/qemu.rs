//! A program of a board, run in QEMU to its end.

use super::{Board, DEFAULT_TIMEOUT, FirmwareError, io_error};
use std::io::{self, Read};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

pub(super) const QEMU: &str = "qemu-system-arm";

/// Runs an ELF to its end and gives the lines that it printed.
///
/// One instruction is 1 ns of the machine's time (`-icount shift=0`), so a run is the same every
/// time, also in what it counts.
///
/// # Errors
///
/// [`FirmwareError::NoQemu`], [`FirmwareError::Timeout`] and [`FirmwareError::Failed`].
pub fn run(board: &Board, elf: &Path, timeout: Duration) -> Result<Vec<String>, FirmwareError> {
    run_words(board, elf, timeout, &[], Path::new("."))
}

/// As [`run`], with words for a program that asks for them, the first its own name, and the folder
/// in which it finds its files. No word may hold a space or a comma.
///
/// # Errors
///
/// As [`run`].
pub fn run_words(
    board: &Board,
    elf: &Path,
    timeout: Duration,
    words: &[&str],
    folder: &Path,
) -> Result<Vec<String>, FirmwareError> {
    let handed = Handed {
        words,
        folder,
        laid: None,
    };
    run_in(QEMU, board, elf, timeout, &handed)
}

/// What a program is handed.
pub struct Handed<'a> {
    /// Words, the first its own name. None may hold a space or a comma.
    pub words: &'a [&'a str],
    /// Where it finds its files.
    pub folder: &'a Path,
    /// A file there that lies in its memory from the start, and at which address.
    pub laid: Option<(&'a str, u32)>,
}

impl Handed<'_> {
    /// The words, as QEMU is told them.
    pub(super) fn semihosting(&self) -> String {
        let mut text = String::from("enable=on,target=native");
        text.extend(self.words.iter().map(|word| format!(",arg={word}")));
        text
    }

    /// The file that lies in memory, as QEMU is told it.
    pub(super) fn loader(&self) -> impl Iterator<Item = String> {
        let device = |(file, address): (&str, u32)| {
            let device = format!("loader,file={file},addr={address:#x},force-raw=on");
            ["-device".to_owned(), device]
        };
        self.laid.map(device).into_iter().flatten()
    }
}

/// As [`run`], with what it is handed.
///
/// # Errors
/// As [`run`].
pub fn run_handed(
    board: &Board,
    elf: &Path,
    handed: &Handed<'_>,
) -> Result<Vec<String>, FirmwareError> {
    run_in(QEMU, board, elf, DEFAULT_TIMEOUT, handed)
}

/// As [`run_handed`], by a QEMU of another name, for so long.
///
/// # Errors
/// As [`run`].
pub fn run_in(
    qemu: &str,
    board: &Board,
    elf: &Path,
    timeout: Duration,
    handed: &Handed<'_>,
) -> Result<Vec<String>, FirmwareError> {
    let child = Command::new(qemu)
        .current_dir(handed.folder)
        .args(handed.loader())
        .args(["-machine", board.machine, "-cpu", board.cpu])
        .args(["-icount", "shift=0"])
        .args(["-display", "none", "-monitor", "none", "-serial", "none"])
        .args(["-semihosting-config", &handed.semihosting(), "-kernel"])
        .arg(elf)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|error| match error.kind() {
            io::ErrorKind::NotFound => FirmwareError::NoQemu,
            _ => io_error(qemu)(error),
        })?;
    let ended = finish(child, timeout).map_err(io_error(qemu))?;
    match ended.status {
        Some(status) if status.success() => Ok(ended.printed.lines().map(str::to_owned).collect()),
        Some(status) => Err(FirmwareError::Failed {
            machine: board.machine,
            status,
            printed: ended.printed + &ended.said,
        }),
        None => Err(FirmwareError::Timeout {
            machine: board.machine,
            seconds: timeout.as_secs(),
            printed: ended.printed + &ended.said,
        }),
    }
}

/// How a child ended.
pub(crate) struct Ended {
    /// `None`: it was stopped, because it took too long.
    pub(crate) status: Option<ExitStatus>,
    /// What it wrote to stdout.
    pub(crate) printed: String,
    /// What it wrote to stderr.
    pub(crate) said: String,
}

/// Waits for a child whose output is piped, and stops it when it takes longer than `timeout`.
///
/// # Errors
///
/// What the system says.
pub(crate) fn finish(mut child: Child, timeout: Duration) -> io::Result<Ended> {
    let started = Instant::now();
    let stdout = child.stdout.take().map(collect);
    let stderr = child.stderr.take().map(collect);
    let status = loop {
        match child.try_wait()? {
            Some(status) => break Some(status),
            None if started.elapsed() >= timeout => {
                child.kill()?;
                child.wait()?;
                break None;
            }
            None => thread::sleep(Duration::from_millis(5)),
        }
    };
    let text = |pipe: Option<thread::JoinHandle<String>>| {
        pipe.and_then(|pipe| pipe.join().ok()).unwrap_or_default()
    };
    Ok(Ended {
        status,
        printed: text(stdout),
        said: text(stderr),
    })
}

/// Reads a pipe to its end beside the waiting, so that a full pipe never stops the child.
pub(super) fn collect(mut pipe: impl Read + Send + 'static) -> thread::JoinHandle<String> {
    thread::spawn(move || {
        let mut bytes = Vec::new();
        // What came before an error is still worth showing.
        let _ = pipe.read_to_end(&mut bytes);
        String::from_utf8_lossy(&bytes).into_owned()
    })
}
