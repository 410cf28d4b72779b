//! What a run writes lies apart from what it reads.

use crate::staged::{behind_links, folder_of};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Refuses an output in the place of a file that is read, and two outputs in one place. Each output has the flag that
/// names it. Places are compared, not names: `./a.obj` and a link to it are `a.obj`.
///
/// # Errors
/// One line, which names the flag.
pub fn apart<'p>(
    outputs: &[(&str, &Path)],
    inputs: impl IntoIterator<Item = &'p Path>,
) -> Result<(), String> {
    let mut taken: BTreeSet<PathBuf> = BTreeSet::new();
    let inputs: BTreeSet<PathBuf> = inputs.into_iter().map(place).collect();
    for (flag, path) in outputs {
        let place = place(path);
        if inputs.contains(&place) {
            return Err(format!(
                "{flag} must not be {}, which is read",
                path.display()
            ));
        }
        if !taken.insert(place) {
            return Err(format!("{flag} must be a file of its own"));
        }
    }
    Ok(())
}

/// Where a file is, behind all links; one that is not there yet is in its folder.
fn place(path: &Path) -> PathBuf {
    let path = behind_links(path).unwrap_or_else(|_| path.to_path_buf());
    let real = path.canonicalize();
    let folder = || folder_of(&path).canonicalize();
    real.unwrap_or_else(|_| match (folder(), path.file_name()) {
        (Ok(folder), Some(name)) => folder.join(name),
        _ => path.clone(),
    })
}
