//! Golden pictures: the checksum of every frame of the firmware and of pictures of the tool, by
//! name, as `host-tests/figures/golden.txt` keeps them.
//!
//! Firmware and host are held against each other in every run of the firmware; where both change
//! alike only this record sees it. A picture that differs, one that is new and one that is gone
//! are each named. With [`BLESS_VARIABLE`] set the record is written anew and that run fails all the
//! same, so that a blessing is never taken for a pass.
//!
//! A picture is added by its name, wherever the others are drawn: a frame in
//! [`host_frames`](crate::frames::host_frames), a picture of the tool in
//! `tests/golden.rs`. Then the record is blessed.

use crate::image_out::write_atomically;
use crate::stdio;
use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;
use std::fmt::{self, Write as _};
use std::path::{Path, PathBuf};

/// Set to anything but nothing it blesses: `SCANBEAM_BLESS=1 cargo test -p host-tests --test proofs golden::`.
pub const BLESS_VARIABLE: &str = "SCANBEAM_BLESS";

/// What stands at the head of the record.
const HEAD: &str = "\
# CRC-32 of every frame of the firmware, and of pictures of the tool, by name.
# Written by: SCANBEAM_BLESS=1 cargo test -p host-tests --test proofs golden::
";

/// Checksums by name.
pub type Pictures = BTreeMap<String, u32>;

/// A picture that is not as recorded.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Difference {
    /// The picture's name.
    pub name: String,
    /// What is recorded; `None` for a picture that is new.
    pub recorded: Option<u32>,
    /// What is drawn; `None` for one that is gone.
    pub drawn: Option<u32>,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = &self.name;
        match (self.recorded, self.drawn) {
            (Some(old), Some(new)) => write!(f, "{name}: {new:08x} where {old:08x} is recorded"),
            (None, _) => write!(f, "{name}: is not recorded"),
            (_, None) => write!(f, "{name}: is recorded and was not drawn"),
        }
    }
}

/// Where the record is.
#[must_use]
pub fn path() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("figures/golden.txt")
}

/// Reads a record.
///
/// # Errors
/// A file that cannot be read, and a line that is not a name and a checksum, or names a picture
/// again.
pub fn read(path: &Path) -> Result<Pictures, Box<dyn Error>> {
    let text = std::fs::read_to_string(path)
        .map_err(|error| format!("{}: {}", path.display(), stdio::reason(&error)))?;
    let mut pictures = Pictures::new();
    for (number, line) in (1..).zip(text.lines()) {
        if line.starts_with('#') {
            continue;
        }
        let picture = line.split_once(' ').and_then(|(crc, name)| {
            let crc = u32::from_str_radix(crc, 16).ok()?;
            Some((name.to_owned(), crc))
        });
        let is_new = picture.is_some_and(|(name, crc)| pictures.insert(name, crc).is_none());
        if !is_new {
            return Err(format!("{}:{number}: no new picture", path.display()).into());
        }
    }
    Ok(pictures)
}

/// Writes a record.
///
/// # Errors
/// When the file cannot be written.
pub fn write(path: &Path, pictures: &Pictures) -> Result<(), Box<dyn Error>> {
    let mut text = HEAD.to_owned();
    for (name, crc) in pictures {
        writeln!(text, "{crc:08x} {name}")?;
    }
    write_atomically(path, text.as_bytes())?;
    Ok(())
}

/// What is not as recorded, by name.
#[must_use]
pub fn differences(recorded: &Pictures, drawn: &Pictures) -> Vec<Difference> {
    let names: BTreeSet<&String> = recorded.keys().chain(drawn.keys()).collect();
    names
        .into_iter()
        .map(|name| Difference {
            name: name.clone(),
            recorded: recorded.get(name).copied(),
            drawn: drawn.get(name).copied(),
        })
        .filter(|difference| difference.recorded != difference.drawn)
        .collect()
}

/// Holds what is drawn against the record, or where `bless` is set writes the record.
///
/// # Errors
/// Every difference by its name; after a blessing, that it was one; and a record that cannot be
/// read or written.
pub fn judge(path: &Path, drawn: &Pictures, bless: bool) -> Result<(), Box<dyn Error>> {
    if bless {
        write(path, drawn)?;
        let path = path.display();
        return Err(format!("{path} is written anew: look at what changed in it").into());
    }
    let differences = differences(&read(path)?, drawn);
    if differences.is_empty() {
        return Ok(());
    }
    let lines: Vec<String> = differences.iter().map(Difference::to_string).collect();
    Err(format!("pictures differ:\n{}", lines.join("\n")).into())
}
