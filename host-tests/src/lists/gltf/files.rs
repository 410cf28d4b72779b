//! What a glTF file names beside itself: buffers and pictures, in `data:` URIs or in files of its folder.

use crate::stdio;
use base64::Engine as _;
use std::path::{Component, Path, PathBuf};

/// Largest buffer that is read, in bytes.
const MAX_BUFFER: u64 = 1 << 30;

/// Reads what a file names, and keeps which files were read.
pub(super) struct Files<'p> {
    path: &'p Path,
    /// The file itself, and those that were read.
    pub(super) read: Vec<PathBuf>,
}

impl<'p> Files<'p> {
    /// Of the file itself.
    pub(super) fn new(path: &'p Path) -> Self {
        Self {
            path,
            read: vec![path.to_path_buf()],
        }
    }

    /// The bytes of a URI.
    pub(super) fn bytes(&mut self, uri: &str) -> Result<Vec<u8>, String> {
        if let Some(data) = uri.strip_prefix("data:") {
            let (_, text) = data.split_once("base64,").ok_or("data is not in base64")?;
            return base64::engine::general_purpose::STANDARD
                .decode(text)
                .map_err(|e| e.to_string());
        }
        // A name in the folder of the file: nothing above it, and nothing elsewhere.
        let name = decoded(uri);
        let name = Path::new(&name);
        let plain = name.components().all(|c| matches!(c, Component::Normal(_)));
        if !plain || uri.contains(':') {
            return Err(format!("{uri:?} is not a file in the same folder"));
        }
        let file = self.path.parent().unwrap_or(Path::new("")).join(name);
        let unread = |error: std::io::Error| format!("{uri:?}: {}", stdio::reason(&error));
        if std::fs::metadata(&file).map_err(unread)?.len() > MAX_BUFFER {
            return Err(format!("{uri:?} is too large"));
        }
        let bytes = std::fs::read(&file).map_err(unread)?;
        self.read.push(file);
        Ok(bytes)
    }
}

/// A URI's name of a file: `%20` is a space, and so on. What is no text then, or no such code, is as it is written.
fn decoded(uri: &str) -> String {
    let mut bytes = Vec::new();
    let mut rest = uri.as_bytes();
    while let [first, after @ ..] = rest {
        let code = match (first, after) {
            (b'%', [high, low, ..]) => [high, low].map(|c| char::from(*c).to_digit(16)),
            _ => [None; 2],
        };
        (rest, _) = match code {
            [Some(high), Some(low)] => (&after[2..], bytes.push((16 * high + low) as u8)),
            _ => (after, bytes.push(*first)),
        };
    }
    String::from_utf8(bytes).unwrap_or_else(|_| uri.to_owned())
}
