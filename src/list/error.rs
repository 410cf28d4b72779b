//! Why a list cannot be read: the block, its offset, the reason (X7).

use super::header::Id;

/// A malformed block. Nothing of it was done; the list stops there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ListError {
    /// Byte offset of the block's header; in a ring, modulo 2^32.
    pub offset: u32,
    /// What the block is, where its header could be read.
    pub block: Option<Id>,
    /// What is wrong.
    pub reason: Reason,
}

/// What is wrong with a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Reason {
    /// The list ends within the block.
    Truncated {
        /// Words that the block needs, its header included.
        need: u32,
        /// Words that are there.
        have: u32,
    },
    /// A block that a ring can never hold whole.
    TooLong {
        /// Words that the block needs.
        need: u32,
        /// Words of the ring.
        room: u32,
    },
    /// An unknown version.
    Version(u8),
    /// A bit is set that this kind of block does not have; the header.
    Reserved(u32),
    /// A FLOW or STATE block of an unknown kind; the kind.
    Kind(u8),
    /// A number that a block cannot have there.
    Value {
        /// Word of the block, the header being 0.
        word: u32,
        /// What stands there.
        value: u32,
    },
    /// A count that the block cannot have.
    Count(u16),
    /// A vertex description names a format that the parameter cannot have, or no place.
    Format {
        /// The parameter.
        parameter: u8,
        /// The format's code.
        format: u8,
    },
    /// NEW is 0 and there is nothing to go on with, or vertices of another form.
    Continue,
    /// INDEXED without a TABLE before it.
    NoTable,
    /// An index that the table does not have.
    Index {
        /// The index.
        index: u16,
        /// Vertices of the table.
        count: u16,
    },
    /// A camera that sees nothing: its eye is where it looks, or a length is out of range.
    Camera,
    /// The bytes are not whole words, or do not begin at a multiple of 4.
    Alignment,
}

impl core::fmt::Display for ListError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "list: offset {:#x}", self.offset)?;
        if let Some(block) = self.block {
            write!(f, ", {block:?}")?;
        }
        write!(f, ": {}", self.reason)
    }
}

impl core::fmt::Display for Reason {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Truncated { need, have } => {
                write!(f, "{need} words are needed, there are {have}")
            }
            Self::TooLong { need, room } => {
                write!(f, "{need} words are needed, the ring has {room}")
            }
            Self::Version(version) => write!(f, "version {version} is unknown"),
            Self::Reserved(word) => write!(f, "header {word:#010x} sets a reserved bit"),
            Self::Kind(kind) => write!(f, "kind {kind} is unknown"),
            Self::Value { word, value } => {
                write!(f, "word {word} cannot be {value:#x}")
            }
            Self::Count(count) => write!(f, "the count cannot be {count}"),
            Self::Format { parameter, format } => {
                write!(f, "parameter {parameter} cannot have the format {format}")
            }
            Self::Continue => f.write_str("there is no strip of this form to go on with"),
            Self::NoTable => f.write_str("there is no table before it"),
            Self::Index { index, count } => {
                write!(f, "index {index} in a table of {count} vertices")
            }
            Self::Camera => f.write_str("the camera is not one that can see"),
            Self::Alignment => f.write_str("not whole words at a multiple of 4 bytes"),
        }
    }
}

impl core::error::Error for ListError {}
