//! Why a frame could not be sent, and what was sent.

use super::super::dma::{Error, ErrorKind};
use core::fmt::{self, Display};

/// Why a frame could not be sent. Lines count from 0 at the top of the window, not of the display.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum ScanError<E> {
    /// The sink refused or failed.
    Sink {
        /// The first line of the transfer that failed, or of the lines of the rectangle that did not open or close;
        /// the window's height where the whole window's did not close.
        line: u16,
        /// What the sink said.
        error: E,
    },
    /// The window does not begin at the edge of a cell. Nothing was sent.
    Misaligned {
        /// Columns and lines of a cell.
        cell: (u16, u16),
        /// Left column and top line of the window.
        corner: (u16, u16),
    },
    /// A buffer does not hold the lines of one transfer. Nothing was sent.
    BufferTooShort {
        /// Words that one transfer takes.
        needed: usize,
        /// Words that the buffer holds.
        have: usize,
    },
    /// The window has no pixels, or ends beyond 65,535, or a transfer was to have no lines. Nothing was sent.
    Empty,
    /// A call out of turn: a line before `begin` or after the last one, `line_done` without `line`, `finish`
    /// without `begin`. Nothing has changed.
    OutOfTurn {
        /// The line that would have been next.
        line: u16,
    },
    /// The frame was finished before its last line. What was complete has been sent.
    LinesMissing {
        /// The first line that is missing.
        line: u16,
    },
    /// More than `max_polls` polls found the sink busy, and no buffer home. The next `begin` asks for it again.
    Timeout {
        /// The first line of the transfer that hangs.
        line: u16,
    },
    /// The sink says that it is idle, but has not given a buffer back. The pump cannot go on without it.
    BufferLost {
        /// The first line of the transfer that took the buffer along; 0 when it was lost in an earlier frame.
        line: u16,
    },
}

/// What the sink says of a line.
pub(super) fn sink<E>(line: u16) -> impl FnOnce(E) -> ScanError<E> {
    move |error| ScanError::Sink { line, error }
}

impl<E: Error> ScanError<E> {
    /// The kind of the error, in the terms of the sinks.
    pub fn kind(&self) -> ErrorKind {
        match self {
            Self::Sink { error, .. } => error.kind(),
            Self::BufferTooShort { .. } | Self::Empty | Self::Misaligned { .. } => {
                ErrorKind::Length
            }
            Self::OutOfTurn { .. } | Self::LinesMissing { .. } => ErrorKind::Sequence,
            Self::Timeout { .. } => ErrorKind::Timeout,
            Self::BufferLost { .. } => ErrorKind::Other,
        }
    }
}

impl<E: Error> Display for ScanError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sink { line, error } => write!(f, "scan-out at line {line}: {}", error.kind()),
            Self::BufferTooShort { needed, have } => write!(
                f,
                "a line buffer holds {have} words, one transfer takes {needed}"
            ),
            Self::Misaligned { cell, corner } => write!(
                f,
                "the window begins at {corner:?}, cells are {cell:?} pixels"
            ),
            Self::Empty => f.write_str("the window or the transfer is empty"),
            Self::OutOfTurn { line } => write!(f, "scan-out call out of turn at line {line}"),
            Self::LinesMissing { line } => {
                write!(f, "the frame was finished, but line {line} is missing")
            }
            Self::Timeout { line } => {
                write!(f, "the transfer that starts at line {line} does not end")
            }
            Self::BufferLost { line } => {
                write!(f, "the sink lost the buffer of the transfer at line {line}")
            }
        }
    }
}

impl<E: Error> core::error::Error for ScanError<E> {}

/// What was sent and what it cost, summed up since the pump was made or the figures were taken.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ScanStats {
    /// Bytes of pixels in all transfers that the sink accepted, also in those that failed later.
    pub bytes_sent: u64,
    /// Transfers that the sink accepted. Stays at its maximum when it gets there.
    pub transfers: u32,
    /// Polls that found the sink busy while the pump had to wait. Stays at its maximum when it gets there.
    pub stall_polls: u32,
    /// Lines that were left out, because the display shows them already (X4).
    pub lines_unsent: u32,
    /// Bytes of pixels in these lines.
    pub bytes_unsent: u64,
}
