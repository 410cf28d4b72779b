//! Files that are written in full beside their places, and come into being together or not at all.

use crate::image_out::{ImageError, cannot};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Writes all bytes or, on error, leaves what was there before.
///
/// # Errors
/// The folder is missing, or anything that the file system refuses.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), ImageError> {
    Staged::new(path, bytes)?.commit()
}

/// A file that is written in full beside its place, but not yet there: so that several files
/// come into being together or not at all. Dropping it leaves nothing.
pub struct Staged<'a> {
    /// As it was named.
    path: &'a Path,
    way: Way,
}

/// How bytes get to their place.
enum Way {
    /// By a file beside its place, and that place.
    Renamed(tempfile::NamedTempFile, PathBuf),
    /// Into the pipe or the device that is there.
    Written(Vec<u8>),
}

impl<'a> Staged<'a> {
    /// Writes the bytes into the folder of `path`, or where `path` is a symbolic link, of what it
    /// leads to: the link stays, and the file behind it is replaced.
    ///
    /// # Errors
    /// The folder is missing, there is a folder or a disk in the file's place, or anything that
    /// the file system refuses.
    pub fn new(path: &'a Path, bytes: &[u8]) -> Result<Self, ImageError> {
        if takes_bytes(path) {
            let way = Way::Written(bytes.to_vec());
            return Ok(Self { path, way });
        }
        let place = behind_links(path)?;
        let file = stage(path, &place, bytes)?;
        match std::fs::metadata(&place) {
            Ok(there) if there.is_dir() => Err(ImageError::new(path, "is a folder")),
            Ok(there) if !there.is_file() => Err(ImageError::new(path, "is no ordinary file")),
            _ => Ok(Self {
                path,
                way: Way::Renamed(file, place),
            }),
        }
    }

    /// Puts the file in its place. A reader of a pipe may go away before it has all.
    ///
    /// # Errors
    /// Anything that the file system refuses.
    pub fn commit(self) -> Result<(), ImageError> {
        let done = match self.way {
            Way::Renamed(file, place) => file.persist(place).map(drop).map_err(|e| e.error),
            Way::Written(bytes) => {
                let opened = std::fs::OpenOptions::new().write(true).open(self.path);
                opened.and_then(|mut there| there.write_all(&bytes))
            }
        };
        match done {
            Err(error) if error.kind() != ErrorKind::BrokenPipe => {
                Err(ImageError::new(self.path, cannot("written", &error)))
            }
            _ => Ok(()),
        }
    }

    /// Puts this file and another in their places: where the other cannot be there, what was in the place of this one
    /// is there again.
    ///
    /// # Errors
    /// Anything that the file system refuses.
    pub fn commit_with(self, other: Staged<'_>) -> Result<(), ImageError> {
        let Way::Renamed(_, place) = &self.way else {
            // What a pipe has is not taken back.
            other.commit()?;
            return self.commit();
        };
        let (path, place) = (self.path, place.clone());
        let refused = |error| ImageError::new(path, cannot("written", &error));
        let old = aside(&place).map_err(refused)?;
        let done = self.commit();
        let is_there = done.is_ok();
        let Err(error) = done.and_then(|()| other.commit()) else {
            return Ok(());
        };
        match old {
            Some(old) => old.persist(&place).map_err(|e| refused(e.error))?,
            None if is_there => std::fs::remove_file(&place).map_err(refused)?,
            None => {}
        }
        Err(error)
    }
}

/// What is in a place, moved aside; dropping it removes it.
fn aside(place: &Path) -> std::io::Result<Option<tempfile::TempPath>> {
    if !place.exists() {
        return Ok(None);
    }
    let mut builder = tempfile::Builder::new();
    let name = builder.prefix(".scanbeam-").tempfile_in(folder_of(place))?;
    let name = name.into_temp_path();
    std::fs::rename(place, &name)?;
    Ok(Some(name))
}

/// Whether there is a pipe or a device that takes bytes one after the other.
fn takes_bytes(path: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        let there = std::fs::metadata(path).map(|there| there.file_type());
        there.is_ok_and(|there| there.is_fifo() || there.is_char_device())
    }
    #[cfg(not(unix))]
    {
        let _ = path;
        false
    }
}

/// The folder of a file.
pub(crate) fn folder_of(place: &Path) -> &Path {
    match place.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Where a file of that name is written: behind all symbolic links, also behind one that leads to
/// nothing yet.
pub(crate) fn behind_links(path: &Path) -> Result<PathBuf, ImageError> {
    /// As many as Linux follows.
    const LINKS: usize = 40;
    let mut place = path.to_path_buf();
    for _ in 0..=LINKS {
        let Ok(target) = std::fs::read_link(&place) else {
            return Ok(place);
        };
        place = place.parent().unwrap_or(Path::new("")).join(target);
    }
    Err(ImageError::new(path, "its symbolic links lead in a circle"))
}

/// A temporary file with the bytes, in the folder of `place`; errors name `path`.
fn stage(path: &Path, place: &Path, bytes: &[u8]) -> Result<tempfile::NamedTempFile, ImageError> {
    let cannot_write = |error: std::io::Error| ImageError::new(path, cannot("written", &error));
    let folder = folder_of(place);
    let mut builder = tempfile::Builder::new();
    builder.prefix(".scanbeam-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // As an ordinary new file: the umask takes away from this.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.tempfile_in(folder).map_err(cannot_write)?;
    file.write_all(bytes).map_err(cannot_write)?;
    Ok(file)
}
