//! What the tool says, on standard output and on standard error.
//!
//! A reader that has gone away (`scanbeam cache | head`) is no mistake: what comes after is said to
//! nobody, and the command still writes its files and ends with the exit code that it would have.
//! Output that is lost for another reason is an error of the whole command, see [`lost`].

use std::error::Error;
use std::fmt;
use std::io::{self, Write};
use std::sync::Mutex;

/// Why standard output took no more, where that was no closed pipe.
static LOST: Mutex<Option<String>> = Mutex::new(None);

/// Prints a line on standard output, as `println!` does, and never panics.
#[macro_export]
macro_rules! say {
    ($($words:tt)*) => {
        $crate::stdio::out(format_args!("{}\n", format_args!($($words)*)))
    };
}

/// Prints a line on standard error, as `eprintln!` does, and never panics.
#[macro_export]
macro_rules! tell {
    ($($words:tt)*) => {
        $crate::stdio::err(format_args!("{}\n", format_args!($($words)*)))
    };
}

/// Prints on standard output.
pub fn out(text: fmt::Arguments<'_>) {
    let mut out = io::stdout().lock();
    note(out.write_fmt(text).and_then(|()| out.flush()));
}

/// Prints on standard error; where that is lost there is nobody left to tell.
pub fn err(text: fmt::Arguments<'_>) {
    let _ = io::stderr().lock().write_fmt(text);
}

/// Takes in how writing to standard output went.
pub fn note(written: io::Result<()>) {
    match (written, LOST.lock()) {
        (Err(error), Ok(mut lost)) if error.kind() != io::ErrorKind::BrokenPipe => {
            lost.get_or_insert_with(|| reason(&error));
        }
        _ => {}
    }
}

/// Why a part of standard output is lost, if it is.
#[must_use]
pub fn lost() -> Option<String> {
    let reason = LOST.lock().ok()?.clone()?;
    Some(format!("standard output: {reason}"))
}

/// The system's own words for an error, the same wherever it comes from: without its number, and
/// without the name of the temporary file that some errors carry.
#[must_use]
pub fn reason(error: &io::Error) -> String {
    let source = error
        .source()
        .and_then(|source| source.downcast_ref::<io::Error>());
    let text = source.unwrap_or(error).to_string();
    match text.find(" (os error ") {
        Some(at) => text[..at].to_owned(),
        None => text,
    }
}
