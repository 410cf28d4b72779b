//! This machine.

use crate::Failure;
use std::fmt::Arguments;
use std::time::Instant;

/// A file's bytes.
///
/// # Errors
/// When it cannot be read.
pub fn read(file: &str) -> Result<Vec<u8>, Failure> {
    Ok(std::fs::read(file)?)
}

/// Writes a file.
pub(crate) fn write(file: &str, bytes: &[u8]) -> Result<(), Failure> {
    Ok(std::fs::write(file, bytes)?)
}

/// The clock and the standard output.
pub(crate) struct Machine;

impl Machine {
    pub(crate) fn start() -> Result<Self, Failure> {
        Ok(Self)
    }

    /// The program's words, without its name.
    pub(crate) fn words(&self) -> Result<Vec<String>, Failure> {
        Ok(std::env::args().skip(1).collect())
    }

    /// The milliseconds that `work` takes.
    pub(crate) fn cost(&self, work: impl FnOnce()) -> f64 {
        let start = Instant::now();
        work();
        start.elapsed().as_secs_f64() * 1e3
    }

    pub(crate) fn say(&mut self, text: Arguments<'_>) {
        println!("{text}");
    }
}
