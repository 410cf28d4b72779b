//! The copy of the project that is mutated: none of the project's own files is touched.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Contents of files by their path from the root.
pub type Files = BTreeMap<String, Vec<u8>>;

/// What the project has, with what is not committed yet.
///
/// # Errors
/// No repository, and files that cannot be read.
pub fn read(root: &Path) -> Result<Files, String> {
    let listed = Command::new("git")
        .args([
            "ls-files",
            "-z",
            "--cached",
            "--others",
            "--exclude-standard",
        ])
        .current_dir(root)
        .output()
        .map_err(|error| format!("git: {error}"))?;
    if !listed.status.success() {
        return Err(String::from_utf8_lossy(&listed.stderr).into_owned());
    }
    let mut files = Files::new();
    for name in String::from_utf8_lossy(&listed.stdout).split('\0') {
        let path = root.join(name);
        // What is deleted and not committed is still listed.
        if !name.is_empty() && path.is_file() {
            let content = fs::read(&path).map_err(|error| format!("{name}: {error}"))?;
            files.insert(name.to_owned(), content);
        }
    }
    Ok(files)
}

/// Makes `folder` have these files and no others. Files that are the same already keep their time,
/// so that nothing is built twice.
///
/// # Errors
/// Files that cannot be written.
pub fn write(folder: &Path, files: &Files) -> Result<(), String> {
    fs::create_dir_all(folder).map_err(|error| told(folder, &error))?;
    let mut there = Vec::new();
    list(folder, &mut there).map_err(|error| told(folder, &error))?;
    for path in there {
        let name = path.strip_prefix(folder).unwrap_or(&path);
        if !files.contains_key(&*name.to_string_lossy()) {
            fs::remove_file(&path).map_err(|error| told(&path, &error))?;
        }
    }
    for (name, content) in files {
        write_one(&folder.join(name), content)?;
    }
    Ok(())
}

/// Writes a file unless it is so already, which is told.
///
/// # Errors
/// A file that cannot be written.
pub fn write_one(path: &Path, content: &[u8]) -> Result<bool, String> {
    if fs::read(path).is_ok_and(|old| old == content) {
        return Ok(false);
    }
    let parent = path.parent().unwrap_or(path);
    fs::create_dir_all(parent).map_err(|error| told(parent, &error))?;
    fs::write(path, content).map_err(|error| told(path, &error))?;
    Ok(true)
}

fn list(folder: &Path, found: &mut Vec<PathBuf>) -> std::io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        if entry.file_type()?.is_dir() {
            list(&entry.path(), found)?;
        } else {
            found.push(entry.path());
        }
    }
    Ok(())
}

fn told(path: &Path, error: &std::io::Error) -> String {
    format!("{}: {error}", path.display())
}

/// A number for contents, which other contents do not have.
#[must_use]
pub fn hash(files: &Files, is_of: impl Fn(&str) -> bool) -> String {
    let mut sum: u64 = 0xcbf2_9ce4_8422_2325;
    let mut add = |bytes: &[u8]| {
        for byte in bytes {
            sum = (sum ^ u64::from(*byte)).wrapping_mul(0x100_0000_01b3);
        }
    };
    for (name, content) in files.iter().filter(|(name, _)| is_of(name)) {
        add(name.as_bytes());
        add(&content.len().to_le_bytes());
        add(content);
    }
    format!("{sum:016x}")
}
