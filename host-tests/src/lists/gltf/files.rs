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
        let name = Path::new(uri);
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
